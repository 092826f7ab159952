/* Bounds of fields: nothing leaves them, and they are as narrow as they can be. */
#include "field/fields.h"

#include <stdlib.h>

#include "base/vector.h"
#include "field/field.h"

static bool is_finite(const iso_field_bound *b) {
    return b->low > -HUGE_VAL && b->high < HUGE_VAL;
}

static bool within(double low, double value, double high) {
    return low <= value && value <= high;
}

static bool holds(const iso_field_bound *b, double value, iso_vec3 gradient) {
    bool has_value = isnan(value) ? !is_finite(b) : within(b->low, value, b->high);
    return has_value &&
           (isnan(value) || (within(b->gradient_low.x, gradient.x, b->gradient_high.x) &&
                             within(b->gradient_low.y, gradient.y, b->gradient_high.y) &&
                             within(b->gradient_low.z, gradient.z, b->gradient_high.z)));
}

/* A box: mostly anywhere, sometimes with an end or all of it at whole numbers, where kinks are. */
static void make_box(iso_vec3 *low, iso_vec3 *high, uint64_t *state) {
    double end[2][3];
    double size = pow(10, between(state, -5, 1.2));
    for (int c = 0; c < 3; c++) {
        end[0][c] = between(state, -20, 20);
        if (random_next(state) % 4 == 0)
            end[0][c] = round(end[0][c] / 4) * 4 + 0.0; /* never -0 */
        end[1][c] = end[0][c] + size * random_unit(state);
        if (random_next(state) % 8 == 0)
            end[1][c] = random_next(state) % 2 ? end[0][c] : ceil(end[1][c]);
    }
    *low = vec3(end[0][0], end[0][1], end[0][2]);
    *high = vec3(end[1][0], end[1][1], end[1][2]);
}

static double pick(uint64_t *state, double low, double high) {
    uint64_t kind = random_next(state) % 8;
    return kind == 0 ? low : kind == 1 ? high : fmin(fmax(between(state, low, high), low), high);
}

enum { BOXES = 700, SAMPLES = 40 };

typedef struct iso_tally {
    int outside, steeper, unknown;
} iso_tally;

/* At most, along one axis; places are known to 1e-13 mm or so. */
static double rise(double way, double low, double high) {
    return way == 0 ? 0 : (fabs(way) * (1 + 1e-9) + 1e-13) * fmax(-low, high);
}

static void try_box(iso_tally *tally, const iso_field *field, uint64_t *state) {
    iso_vec3 low, high, at[SAMPLES], gradient[SAMPLES];
    double value[SAMPLES];
    make_box(&low, &high, state);
    iso_field_bound b;
    iso_field_bound_over(&b, field, low, high);
    tally->unknown += !is_finite(&b);
    for (int i = 0; i < SAMPLES; i++)
        at[i] = vec3(pick(state, low.x, high.x), pick(state, low.y, high.y),
                     pick(state, low.z, high.z));
    iso_field_evaluate(value, gradient, field, at, SAMPLES);
    for (int i = 0; i < SAMPLES; i++)
        tally->outside += !holds(&b, value[i], gradient[i]);
    for (int i = 1; i < SAMPLES; i++) { /* what the slopes say of any two points */
        iso_vec3 way = vec3_minus(at[i], at[i - 1]);
        double most = rise(way.x, b.gradient_low.x, b.gradient_high.x) +
                      rise(way.y, b.gradient_low.y, b.gradient_high.y) +
                      rise(way.z, b.gradient_low.z, b.gradient_high.z);
        tally->steeper += fabs(value[i] - value[i - 1]) > most + 1e-12 * (1 + fabs(value[i]));
    }
}

static void test_nothing_leaves(void) {
    uint64_t state = 1;
    for (int k = 0; k < EVERY_FIELD; k++) {
        iso_field *field = field_of(every_field[k]);
        iso_tally tally = {0};
        for (int i = 0; i < BOXES; i++)
            try_box(&tally, field, &state);
        if (!CHECK(tally.outside == 0 && tally.steeper == 0))
            fprintf(stderr, "%s: %d outside, %d steeper\n", every_field[k], tally.outside,
                    tally.steeper);
        iso_field_free(field);
    }
}

/* ---- expressions made at random ---- */

typedef struct writer {
    char text[2000];
    int length;
    uint64_t *state;
} writer;

static void put(writer *w, const char *text) {
    w->length += snprintf(w->text + w->length, sizeof w->text - (size_t)w->length, "%s", text);
}

static void put_any(writer *w, int depth) {
    static const char *const leaf[] = {"x", "y",   "z", "x", "y", "z",
                                       "2", "0.5", "3", "7", "1", "0"};
    static const char *const one[] = {"-(",   "abs(",   "sqrt(", "sin(",  "cos(",
                                      "tan(", "asin(",  "acos(", "atan(", "exp(",
                                      "log(", "floor(", "ceil(", "round("};
    static const char *const two[] = {"min(", "max(", "mod(", "atan2(", "hypot("};
    static const char *const between_two[] = {"+",  "-", "*", "/",  "^", "<",
                                              ">=", "+", "*", "==", "!="};
    uint64_t r = random_next(w->state) >> 8, kind = r % 16, which = r / 16;
    if (depth == 0 || kind == 0) {
        put(w, leaf[which % 12]);
    } else if (kind < 5) {
        put(w, one[which % 14]);
        put_any(w, depth - 1);
        put(w, ")");
    } else if (kind < 7) {
        put(w, two[which % 5]);
        put_any(w, depth - 1);
        put(w, ",");
        put_any(w, depth - 1);
        put(w, ")");
    } else if (kind < 14) {
        put(w, "(");
        put_any(w, depth - 1);
        put(w, ")");
        put(w, between_two[which % 11]);
        put(w, "(");
        put_any(w, depth - 1);
        put(w, ")");
    } else {
        int operands = which % 3 == 0 ? 5 : 3;
        put(w, which % 3 == 0 ? "ramp(" : which % 3 == 1 ? "clamp(" : "((");
        for (int i = 0; i < operands; i++) {
            put_any(w, depth > 2 ? 1 : depth - 1);
            put(w, i + 1 == operands ? ")" : which % 3 < 2 ? "," : i == 0 ? ")?(" : "):(");
        }
        put(w, which % 3 < 2 ? "" : ")");
    }
}

static void test_nothing_leaves_random_expressions(void) {
    uint64_t state = 11;
    int bad = 0;
    for (int i = 0; i < 12000; i++) {
        writer w = {.state = &state};
        put_any(&w, 1 + i % 4);
        iso_field *field = field_of(w.text);
        iso_tally tally = {0};
        for (int k = 0; k < 6; k++)
            try_box(&tally, field, &state);
        bool good = tally.outside == 0 && tally.steeper == 0;
        if (!good && bad++ < 5)
            fprintf(stderr, "%s: %d outside, %d steeper\n", w.text, tally.outside, tally.steeper);
        iso_field_free(field);
    }
    CHECK_EQUAL(0, bad);
}

static void test_nothing_leaves_blends(void) {
    static const char *const text[] = {"cone:30",        "sphere:0,0,-40",         "wave:1,12",
                                       "fan:y,-40,0,40", "z + 0.05*sqrt(x^2+y^2)", "z + max(x,y)/4",
                                       "sqrt(z - 1)"};
    uint64_t state = 2;
    for (int k = 0; k < 7; k++) {
        iso_field *field;
        CHECK_OK(iso_field_blend(&field, field_of(text[k]), k * 3 - 5, -3, 8));
        iso_tally tally = {0};
        for (int i = 0; i < 2 * BOXES; i++)
            try_box(&tally, field, &state);
        if (!CHECK(tally.outside == 0 && tally.steeper == 0))
            fprintf(stderr, "%s: %d outside, %d steeper\n", text[k], tally.outside, tally.steeper);
        CHECK(k == 6 ? tally.unknown > 0 : tally.unknown == 0);
        iso_field_free(field);
    }
}

/* ---- how narrow ---- */

static const char *const smooth[] = {
    "plane:1,2,3",
    "cone:30",
    "sphere:1,2,-30",
    "cylinder:y,1,30",
    "torus:12,0,0,-30",
    "wave:2,15,20",
    "fan:y,-40,0,15",
    "z + 0.05*sqrt(x^2+y^2)",
    "z + 2*sin(x/5)*cos(y/5)",
    "x*y*z/100",
    "exp(x/10)*y - y*exp(x/10)/2 + log(z*z+1)",
    "(x-y)*(x+y)*(y-z)/100 + x/(z*z+9)",
    "z + max(x,y)/4 + abs(x-y)/10",
    "(x+y+z)^3/1000 - x^3/1000",
};
enum { SMOOTH = sizeof smooth / sizeof *smooth };

/* Mean width of the bounds of boxes of a size, and of what the values in them span. */
static void widths(double mean[2], const iso_field *field, double size, uint64_t seed) {
    enum { MANY = 300, EDGE = 5, CUBE = EDGE * EDGE * EDGE };
    uint64_t state = seed;
    mean[0] = mean[1] = 0;
    for (int i = 0; i < MANY; i++) {
        iso_vec3 low = point_within(&state, 20), high = vec3_plus(low, vec3(size, size, size));
        iso_vec3 at[CUBE];
        double value[CUBE], least = HUGE_VAL, most = -HUGE_VAL;
        for (int k = 0; k < CUBE; k++)
            at[k] = vec3_along(low, size / (EDGE - 1),
                               vec3(k % EDGE, k / EDGE % EDGE, k / EDGE / EDGE));
        iso_field_bound b;
        iso_field_bound_over(&b, field, low, high);
        iso_field_evaluate(value, NULL, field, at, CUBE);
        for (int k = 0; k < CUBE; k++) {
            least = fmin(least, value[k]);
            most = fmax(most, value[k]);
        }
        mean[0] += (b.high - b.low) / MANY;
        mean[1] += (most - least) / MANY;
    }
}

/* It shrinks with the box, and what it has beyond the values shrinks with its square. */
static void test_narrow(void) {
    for (int k = 0; k < SMOOTH; k++) {
        iso_field *field = field_of(smooth[k]);
        double large[2], small[2], least[2];
        widths(large, field, 2, 7);
        widths(small, field, 0.2, 7);
        widths(least, field, 0.002, 7);
        bool narrow = large[0] < 1.2 * large[1] && small[0] < 1.02 * small[1] &&
                      least[0] < 1.001 * least[1] && small[0] < 0.15 * large[0] &&
                      least[0] < 0.011 * small[0];
        if (!CHECK(narrow))
            fprintf(stderr, "%s: %g of %g, %g of %g, %g of %g\n", smooth[k], large[0], large[1],
                    small[0], small[1], least[0], least[1]);
        iso_field_free(field);
    }
}

/* Known by hand. */
static void test_known(void) {
    static const struct {
        const char *text;
        iso_vec3 low, high;
        double least, most;
        iso_vec3 gradient_low, gradient_high;
    } known[] = {
        {"sphere:0,0,0", {3, 0, 0}, {3, 4, 0}, 3, 5, {0.6, 0, 0}, {1, 0.8, 0}},
        {"sphere:0,0,0", {-1, -1, -1}, {1, 1, 1}, 0, sqrt(3), {-1, -1, -1}, {1, 1, 1}},
        {"cylinder:x", {0, 0, 2}, {9, 0, 3}, 2, 3, {0, 0, 1}, {0, 0, 1}},
        {"cylinder:z", {-3, 4, 0}, {3, 4, 9}, 4, 5, {-0.6, 0.8, 0}, {0.6, 1, 0}},
        {"cone:45",
         {3, 4, 0},
         {3, 4, 0},
         sqrt(12.5),
         sqrt(12.5),
         {0.6 * sqrt(.5), 0.8 * sqrt(.5), sqrt(.5)},
         {0.6 * sqrt(.5), 0.8 * sqrt(.5), sqrt(.5)}},
        {"torus:10", {-10, -10, 0}, {10, 10, 0}, 0, 10, {-1, -1, 0}, {1, 1, 0}},
        {"wave:2,4",
         {0, 0, 0},
         {4, 0, 0},
         -2,
         2,
         {-3.141592653589793, 0, 1},
         {3.141592653589793, 0, 1}},
        {"fan:y,0,0,10",
         {1, 0, 1},
         {1, 0, 1},
         10 * 3.141592653589793 / 4,
         10 * 3.141592653589793 / 4,
         {-5, 0, 5},
         {-5, 0, 5}},
        {"abs(x)", {-1, 0, 0}, {2, 0, 0}, 0, 2, {-1, 0, 0}, {1, 0, 0}},
        {"max(x, 2*y)", {0, 0, 0}, {1, 1, 0}, 0, 2, {0, 0, 0}, {1, 2, 0}},
        {"floor(x)", {0.25, 0, 0}, {0.75, 0, 0}, 0, 0, {0, 0, 0}, {0, 0, 0}},
        {"floor(x) + y", {0.5, 0, 0}, {1.5, 1, 0}, 0, 2, {-HUGE_VAL, 1, 0}, {HUGE_VAL, 1, 0}},
        {"x > 1 ? y : z", {0, 0, 0}, {2, 3, 4}, 0, 4, {-HUGE_VAL, 0, 0}, {HUGE_VAL, 1, 1}},
        {"hypot(x, y)", {-1, 0, 0}, {1, 2, 0}, 0, sqrt(5), {-1, 0, 0}, {1, 1, 0}},
        {"ramp(z, 0, 2, 0, 3)", {0, 0, -1}, {0, 0, 1}, 0, 1.5, {0, 0, 0}, {0, 0, 1.5}},
        {"sqrt(x)", {0, 0, 0}, {4, 0, 0}, 0, 2, {0, 0, 0}, {HUGE_VAL, 0, 0}},
    };
    for (int i = 0; i < (int)(sizeof known / sizeof *known); i++) {
        iso_field *field = field_of(known[i].text);
        iso_field_bound b;
        iso_field_bound_over(&b, field, known[i].low, known[i].high);
        const double found[] = {b.low,
                                b.high,
                                b.gradient_low.x,
                                b.gradient_low.y,
                                b.gradient_low.z,
                                b.gradient_high.x,
                                b.gradient_high.y,
                                b.gradient_high.z};
        const double right[] = {known[i].least,           known[i].most,
                                known[i].gradient_low.x,  known[i].gradient_low.y,
                                known[i].gradient_low.z,  known[i].gradient_high.x,
                                known[i].gradient_high.y, known[i].gradient_high.z};
        for (int k = 0; k < 8; k++) {
            bool same = isinf(right[k]) ? found[k] == right[k] : fabs(found[k] - right[k]) < 1e-12;
            if (!CHECK(same))
                fprintf(stderr, "%s: %g is not %g (%d)\n", known[i].text, found[k], right[k], k);
        }
        iso_field_free(field);
    }
}

/* Where there may be no value the bound doesn't claim one. */
static void test_unknown(void) {
    static const char *const text[] = {"sqrt(x)",
                                       "log(x)",
                                       "1/x",
                                       "asin(2*x)",
                                       "x^0.5",
                                       "x^-1",
                                       "tan(x*2)",
                                       "mod(1,x)",
                                       "acos(2*x)",
                                       "0/0",
                                       "min(sqrt(x),1)",
                                       "clamp(log(x),0,1)",
                                       "atan(1/x)",
                                       "exp(-1/x)",
                                       "1/(1/x)",
                                       "cos(1/x)",
                                       "x^y^0.5",
                                       "ramp(sqrt(x),0,1,2,3)",
                                       "sqrt(x)*0 + 1",
                                       "sqrt(x)<1 ? sqrt(x) : 0"};
    for (int i = 0; i < (int)(sizeof text / sizeof *text); i++) {
        iso_field *field = field_of(text[i]);
        iso_field_bound b;
        iso_field_bound_over(&b, field, vec3(-1, -1, -1), vec3(1, 1, 1));
        if (!CHECK(!is_finite(&b)))
            fprintf(stderr, "%s\n", text[i]);
        iso_field_free(field);
    }
}

/* ---- fields of the caller's ---- */

typedef struct ripple {
    double amplitude;
} ripple;

static void ripple_value(double *value, iso_vec3 *gradient, const iso_vec3 *at, int64_t count,
                         void *payload) {
    const ripple *r = payload;
    for (int64_t i = 0; i < count; i++) {
        value[i] = at[i].z + r->amplitude * sin(at[i].x);
        if (gradient)
            gradient[i] = vec3(r->amplitude * cos(at[i].x), 0, 1);
    }
}

static void ripple_bound(iso_field_bound *bound, iso_vec3 low, iso_vec3 high, void *payload) {
    const ripple *r = payload;
    *bound = (iso_field_bound){
        low.z - r->amplitude, high.z + r->amplitude, {-r->amplitude, 0, 1}, {r->amplitude, 0, 1}};
}

static void test_function(void) {
    ripple r = {0.5};
    iso_field *field[2];
    CHECK_OK(iso_field_from_function(&field[0], ripple_value, NULL, sqrt(1.25), &r));
    CHECK_OK(iso_field_from_function(&field[1], ripple_value, ripple_bound, 0, &r));
    uint64_t state = 3;
    for (int k = 0; k < 2; k++) {
        CHECK_EQUAL(ISO_FIELD_FUNCTION, iso_field_kind_of(field[k]));
        CHECK(!iso_field_is_z(field[k]));
        iso_tally tally = {0};
        for (int i = 0; i < BOXES; i++)
            try_box(&tally, field[k], &state);
        CHECK(tally.outside == 0 && tally.steeper == 0 && tally.unknown == 0);
        iso_field_bound b;
        iso_field_bound_over(&b, field[k], vec3(0, 0, 1), vec3(0, 0, 1));
        CHECK(k == 1 || (b.high - b.low < 1e-12 && within(b.low, 1, b.high)));
        iso_field_free(field[k]);
    }
    iso_field *none = field[0];
    CHECK_STATUS(ISO_USAGE, iso_field_from_function(&none, ripple_value, NULL, -1, &r));
    CHECK(none == NULL);
    CHECK_STATUS(ISO_USAGE, iso_field_from_function(&none, ripple_value, NULL, NAN, &r));
}

/* ---- blends ---- */

static double smooth_step(double t) {
    return t <= 0 ? 0 : t >= 1 ? 1 : t * t * (3 - 2 * t);
}

static void test_blend(void) {
    iso_field *curved = field_of("cone:30"), *field;
    iso_field *other = field_of("cone:30");
    CHECK_OK(iso_field_blend(&field, curved, 2.5, 2, 10));
    uint64_t state = 4;
    int wrong = 0, steep = 0, falls = 0;
    for (int i = 0; i < 12000; i++) {
        iso_vec3 p = point_within(&state, 14), g = gradient_at(field, p);
        double s = smooth_step((p.z - 2) / 8), cone = value_at(other, p) - 2.5;
        wrong += fabs(value_at(field, p) - (p.z + s * (cone - p.z))) > 1e-13;
        for (int c = 0; c < 3; c++) {
            iso_vec3 way = vec3(c == 0, c == 1, c == 2);
            double h = 1e-5, d = (value_at(field, vec3_along(p, h, way)) -
                                  value_at(field, vec3_along(p, -h, way))) /
                                 (2 * h);
            steep += fabs(d - vec3_dot(g, way)) > 1e-5 && hypot(p.x, p.y) > 0.01;
        }
        falls += !(g.z > 0);
    }
    CHECK_EQUAL(0, wrong);
    CHECK_EQUAL(0, steep);
    CHECK_EQUAL(0, falls); /* a bend over 8 mm rises everywhere up to 20 mm off the axis */
    iso_field_bound b;
    iso_field_bound_over(&b, field, vec3(-14, -14, -5), vec3(14, 14, 2));
    CHECK(b.low == -5 && b.high == 2 && b.gradient_low.z == 1 && b.gradient_high.x == 0);
    iso_field_bound_over(&b, field, vec3(-9, -9, 3), vec3(9, 9, 9)); /* proven, not only seen */
    iso_field_free(field);
    iso_field_free(other);
}

/* Rising with z is proven by bounds of small boxes where it is true, and where it isn't they don't
 * say so. */
static void test_blend_monotony(void) {
    iso_field *gentle, *sharp;
    CHECK_OK(iso_field_blend(&gentle, field_of("cone:-20"), 0, 1, 11));
    CHECK_OK(iso_field_blend(&sharp, field_of("cone:-20"), 0, 1, 3));
    int unproven = 0, falling = 0, wrong = 0;
    for (int i = 0; i < 15; i++) {
        for (int k = 0; k < 60; k++) {
            iso_vec3 low = {i, 0, k * 0.2}, high = {i + 1, 1, k * 0.2 + 0.2};
            iso_field_bound b;
            iso_field_bound_over(&b, gentle, low, high);
            unproven += !(b.gradient_low.z > 0);
            iso_field_bound_over(&b, sharp, low, high);
            falling += b.gradient_high.z < 0;
            wrong += b.gradient_low.z > 0 && !(gradient_at(sharp, low).z > 0);
        }
    }
    CHECK_EQUAL(0, unproven);
    CHECK(falling > 10);
    CHECK_EQUAL(0, wrong);
    iso_field_free(gentle);
    iso_field_free(sharp);
}

/* Where the curved field has no value the blend has none, but a gradient all the same; the base has
 * both. */
static void test_blend_without_value(void) {
    iso_field *field;
    CHECK_OK(iso_field_blend(&field, field_of("sqrt(z - 10)"), 0, 1, 11));
    iso_vec3 between_both = gradient_at(field, vec3(0, 0, 5));
    CHECK(isnan(value_at(field, vec3(0, 0, 5))) && fabs(between_both.z) < HUGE_VAL);
    CHECK(value_at(field, vec3(0, 0, 0.5)) == 0.5 && gradient_at(field, vec3(0, 0, 0.5)).z == 1);
    CHECK_NEAR(2, value_at(field, vec3(0, 0, 14)), 1e-15);
    iso_field_free(field);
}

static void test_blend_refuses(void) {
    iso_field *field = NULL;
    CHECK_STATUS(ISO_USAGE, iso_field_blend(&field, field_of("cone:30"), 0, 2, 2));
    CHECK_STATUS(ISO_USAGE, iso_field_blend(&field, field_of("cone:30"), 0, 2, NAN));
    CHECK_STATUS(ISO_USAGE, iso_field_blend(&field, field_of("cone:30"), HUGE_VAL, 2, 3));
    CHECK(field == NULL);
}

int main(void) {
    RUN(test_nothing_leaves);
    RUN(test_nothing_leaves_random_expressions);
    RUN(test_nothing_leaves_blends);
    RUN(test_narrow);
    RUN(test_known);
    RUN(test_unknown);
    RUN(test_function);
    RUN(test_blend);
    RUN(test_blend_monotony);
    RUN(test_blend_without_value);
    RUN(test_blend_refuses);
    return check_verdict();
}

/* Values and gradients of fields against formulas in C, differences and each other. */
#include "field/fields.h"

#include <isoslice/geometry.h>

#include "base/memory.h"
#include "base/vector.h"
#include "field/field.h"

/* ---- values of the shapes, by the C library ---- */

static const double degree = 0.017453292519943295;

static double plane(iso_vec3 p) {
    return (2 * p.x - 3 * p.y + 6 * p.z) / 7;
}
static double cylinder_x(iso_vec3 p) {
    return hypot(p.y - 1.5, p.z + 2);
}
static double cylinder_y(iso_vec3 p) {
    return hypot(p.x - 1.5, p.z + 2);
}
static double cylinder_z(iso_vec3 p) {
    return hypot(p.x - 1.5, p.y + 2);
}
static double cylinder_alone(iso_vec3 p) {
    return hypot(p.x, p.z);
}
static double cone(iso_vec3 p) {
    return (p.z + tan(30 * degree) * hypot(p.x, p.y)) * cos(30 * degree);
}
static double cone_upwards(iso_vec3 p) {
    return (p.z - tan(12.5 * degree) * hypot(p.x - 3, p.y - 4)) * cos(12.5 * degree);
}
static double sphere(iso_vec3 p) {
    return hypot(hypot(p.x - 1, p.y - 2), p.z + 30);
}
static double torus(iso_vec3 p) {
    return hypot(hypot(p.x, p.y) - 12, p.z);
}
static double torus_aside(iso_vec3 p) {
    return hypot(hypot(p.x - 1, p.y - 2) - 8, p.z - 3);
}
static double wave(iso_vec3 p) {
    return p.z + 2 * sin(360 * degree * p.x / 15);
}
static double wave_turned(iso_vec3 p) {
    return p.z - 0.5 * sin(360 * degree * (p.x * cos(30 * degree) + p.y * sin(30 * degree)) / 8);
}
static double fan_y(iso_vec3 p) {
    return 15 * atan2(p.z - 2, p.x + 30);
}
static double fan_y_other_side(iso_vec3 p) {
    return 15 * atan2(p.z - 2, 30 - p.x);
}
static double fan_x(iso_vec3 p) {
    return 12 * atan2(p.z, p.y - 1);
}
static double fan_z(iso_vec3 p) {
    return 10 * atan2(p.y + 2, p.x + 40);
}
static double expression(iso_vec3 p) {
    return p.z + 0.05 * sqrt(p.x * p.x + p.y * p.y);
}
static double expression_of_three(iso_vec3 p) {
    return sqrt((p.x - 1) * (p.x - 1) + pow(p.y, 2) + p.z * p.z) +
           sin(p.x * p.y / 9) * exp(-p.z / 9);
}

static const struct {
    const char *text;
    iso_field_kind kind;
    double (*value)(iso_vec3 p);
    bool is_distance; /* |gradient| = 1 */
} shapes[] = {
    {"plane:2,-3,6", ISO_FIELD_PLANE, plane, true},
    {" plane: 2e3 , -3.0e+3, 6000 ", ISO_FIELD_PLANE, plane, true},
    {"cylinder:x,1.5,-2", ISO_FIELD_CYLINDER, cylinder_x, true},
    {"cylinder:y,1.5,-2", ISO_FIELD_CYLINDER, cylinder_y, true},
    {"cylinder:z,1.5,-2", ISO_FIELD_CYLINDER, cylinder_z, true},
    {"cylinder:y", ISO_FIELD_CYLINDER, cylinder_alone, true},
    {"cone:30", ISO_FIELD_CONE, cone, true},
    {"cone:-12.5,3,4", ISO_FIELD_CONE, cone_upwards, true},
    {"sphere:1,2,-30", ISO_FIELD_SPHERE, sphere, true},
    {"torus:12", ISO_FIELD_TORUS, torus, true},
    {"torus:8,1,2,3", ISO_FIELD_TORUS, torus_aside, true},
    {"wave:2,15", ISO_FIELD_WAVE, wave, false},
    {"wave:-.5,8,30", ISO_FIELD_WAVE, wave_turned, false},
    {"fan:y,-30,2,15", ISO_FIELD_FAN, fan_y, false},
    {"fan:y,30,2,-15", ISO_FIELD_FAN, fan_y_other_side, false},
    {"fan:x,1,0,12", ISO_FIELD_FAN, fan_x, false},
    {"fan:z,-40,-2,10", ISO_FIELD_FAN, fan_z, false},
    {"z + 0.05*sqrt(x^2+y^2)", ISO_FIELD_EXPRESSION, expression, false},
    {"sqrt((x-1)*(x-1)+y^2+z*z)+sin(x*y/9)*exp(-z/9)", ISO_FIELD_EXPRESSION, expression_of_three,
     false},
};
enum { SHAPES = sizeof shapes / sizeof *shapes, POINTS = 4000 };

/* By five points, whose error is of fourth order. */
static double difference(double (*value)(iso_vec3 p), iso_vec3 p, iso_vec3 way) {
    const double h = 1e-3;
    return (8 * (value(vec3_along(p, h, way)) - value(vec3_along(p, -h, way))) -
            (value(vec3_along(p, 2 * h, way)) - value(vec3_along(p, -2 * h, way)))) /
           (12 * h);
}

static void test_shapes(void) {
    uint64_t state = 1;
    for (int s = 0; s < SHAPES; s++) {
        iso_field *field = field_of(shapes[s].text);
        int wrong = 0, steep = 0, not_one = 0;
        CHECK_EQUAL(shapes[s].kind, iso_field_kind_of(field));
        for (int i = 0; i < POINTS; i++) {
            iso_vec3 p = point_within(&state, 20), gradient;
            double value, expected = shapes[s].value(p);
            iso_field_evaluate(&value, &gradient, field, &p, 1);
            wrong += !(fabs(value - expected) <= 1e-13 * (1 + fabs(expected)));
            iso_vec3 by = {difference(shapes[s].value, p, vec3(1, 0, 0)),
                           difference(shapes[s].value, p, vec3(0, 1, 0)),
                           difference(shapes[s].value, p, vec3(0, 0, 1))};
            steep += !(vec3_distance(by, gradient) <= 1e-6);
            not_one += !(fabs(vec3_length(gradient) - 1) < 1e-14);
        }
        CHECK_EQUAL(0, wrong);
        if (!CHECK(steep < 10)) /* a point next to an axis, whose differences know nothing */
            fprintf(stderr, "%s: %d gradients\n", shapes[s].text, steep);
        CHECK(!shapes[s].is_distance || not_one == 0);
        iso_field_free(field);
    }
}

/* ---- every field against its own differences ---- */

/* Left and right of the point, so that a kink between shows itself. */
static bool agrees(const iso_field *field, iso_vec3 p, iso_vec3 way, double slope) {
    const double h = 1e-5;
    double here = value_at(field, p);
    double up = (value_at(field, vec3_along(p, h, way)) - here) / h;
    double down = (here - value_at(field, vec3_along(p, -h, way))) / h;
    double tolerance = 1e-3 * (1 + fabs(slope));
    return isnan(up + down) || fabs(up - down) > tolerance ||
           fabs(0.5 * (up + down) - slope) < tolerance;
}

static void test_gradients(void) {
    uint64_t state = 2;
    for (int k = 0; k < EVERY_FIELD; k++) {
        iso_field *field = field_of(every_field[k]);
        int wrong = 0;
        for (int i = 0; i < POINTS; i++) {
            iso_vec3 p = point_within(&state, 20), gradient = gradient_at(field, p);
            wrong += !agrees(field, p, vec3(1, 0, 0), gradient.x);
            wrong += !agrees(field, p, vec3(0, 1, 0), gradient.y);
            wrong += !agrees(field, p, vec3(0, 0, 1), gradient.z);
        }
        if (!CHECK_EQUAL(0, wrong))
            fprintf(stderr, "%s\n", every_field[k]);
        iso_field_free(field);
    }
}

/* What is shared, folded or renamed on the way to a formula doesn't change the value. */
static void test_formulas_are_expressions(void) {
    static const char *const same[][2] = {
        {"sqrt(x^2+y^2)+sqrt(x^2+y^2)*3", "hypot(x,y)+3*hypot(x,y)"},
        {"sqrt(x*x+(y*y+z*z))", "hypot(hypot(x,y),z)"},
        {"(x+y)*(x+y)", "(x+y)^2"},
        {"sqrt((x-y)^2)", "abs(x-y)"},
        {"x^0.5", "sqrt(x)"},
        {"min(z,x,1,1,1)", "min(min(x,1),z)"},
        {"sqrt(x^2+y^2+z^2+1)", "hypot(hypot(x,1),hypot(y,z))"},
        {"((x*y)+(y*x))/2", "x*y"},
    };
    uint64_t state = 3;
    for (int k = 0; k < (int)(sizeof same / sizeof *same); k++) {
        iso_field *a = field_of(same[k][0]), *b = field_of(same[k][1]);
        int wrong = 0;
        for (int i = 0; i < 500; i++) {
            iso_vec3 p = point_within(&state, 20);
            double u = value_at(a, p), v = value_at(b, p);
            wrong += !(fabs(u - v) <= 1e-13 * (1 + fabs(u)) || (isnan(u) && isnan(v)));
            wrong += !(vec3_distance(gradient_at(a, p), gradient_at(b, p)) < 1e-11);
        }
        if (!CHECK_EQUAL(0, wrong))
            fprintf(stderr, "%s\n", same[k][0]);
        iso_field_free(a);
        iso_field_free(b);
    }
}

/* ---- places without a gradient ---- */

static void test_singular_places(void) {
    static const struct {
        const char *text;
        iso_vec3 at, gradient;
    } place[] = {
        {"sphere:1,2,3", {1, 2, 3}, {0, 0, 0}},
        {"cylinder:x,2,3", {7, 2, 3}, {0, 0, 0}},
        {"cylinder:y,2,3", {2, 7, 3}, {0, 0, 0}},
        {"cylinder:z", {0, 0, 5}, {0, 0, 0}},
        {"cone:30", {0, 0, 5}, {0, 0, 0.8660254037844386}},
        {"torus:12", {0, 0, 5}, {0, 0, 0.38461538461538464}},
        {"torus:12", {12, 0, 0}, {0, 0, 0}},
        {"fan:y,1,2,15", {1, 9, 2}, {0, 0, 0}},
        {"sqrt(x^2+y^2)+z", {0, 0, 1}, {0, 0, 1}},
        {"sqrt(x*x+y*y+z*z)", {0, 0, 0}, {0, 0, 0}},
        {"hypot(x,y)+z", {0, 0, 1}, {0, 0, 1}},
        {"abs(x)+z", {0, 0, 1}, {0, 0, 1}},
        {"sqrt(x)+z", {0, 0, 1}, {0, 0, 1}},
        {"asin(x)+z", {1, 0, 1}, {0, 0, 1}},
        {"atan2(y,x)+z", {0, 0, 1}, {0, 0, 1}},
        {"(x^2)^0.3+z", {0, 0, 1}, {0, 0, 1}},
        {"min(x,2*x)+max(y,y)", {0, 0, 1}, {2, 1, 0}},
        {"log(x)*0+z", {-1, 0, 1}, {0, 0, 1}},
        {"z + 0*sqrt(x*z)", {0, 0, 1}, {0, 0, 1}}, /* infinite, but it doesn't matter */
    };
    for (int i = 0; i < (int)(sizeof place / sizeof *place); i++) {
        iso_field *field = field_of(place[i].text);
        iso_vec3 gradient = gradient_at(field, place[i].at);
        if (!CHECK(vec3_distance(gradient, place[i].gradient) < 1e-15))
            fprintf(stderr, "%s: %g, %g, %g\n", place[i].text, gradient.x, gradient.y, gradient.z);
        iso_field_free(field);
    }
}

/* ---- over arrays ---- */

static void test_arrays(void) {
    enum { MANY = 1111 };
    static iso_vec3 at[MANY], gradient[MANY], piece_gradient[MANY];
    static double value[MANY], alone[MANY], piece[MANY];
    uint64_t state = 4;
    for (int i = 0; i < MANY; i++)
        at[i] = point_within(&state, 20);
    for (int k = 0; k < EVERY_FIELD; k++) {
        iso_field *field = field_of(every_field[k]);
        iso_field_evaluate(value, gradient, field, at, MANY);
        iso_field_evaluate(alone, NULL, field, at, MANY);
        for (int first = 0, n; first < MANY; first += n) {
            n = 1 + first * 7 % 300;
            n = n < MANY - first ? n : MANY - first;
            iso_field_evaluate(piece + first, piece_gradient + first, field, at + first, n);
        }
        CHECK(!memcmp(value, alone, sizeof value) && !memcmp(value, piece, sizeof value));
        CHECK(!memcmp(gradient, piece_gradient, sizeof gradient));
        iso_field_evaluate(value, gradient, field, at, 0);
        iso_field_free(field);
    }
}

/* As long as an expression may get: more values at once than registers, if all were shared. */
static void test_long_expressions(void) {
    enum { TERMS = 600 };
    static char text[TERMS * 60];
    char *to = text;
    for (int i = 1; i <= TERMS; i++)
        to += sprintf(to, "sin(x*%d.5)*%d+", i, i % 7);
    to += sprintf(to, "z-(");
    for (int i = 1; i <= TERMS; i++)
        to += sprintf(to, "sin(x*%d.5)*%d+", i, i % 7);
    sprintf(to, "0)");
    iso_field *field = field_of(text);
    iso_vec3 p = {1, 2, 3}, gradient = gradient_at(field, p);
    CHECK_NEAR(3, value_at(field, p), 1e-9);
    CHECK(fabs(gradient.x) < 1e-6 && gradient.z == 1);
    iso_field_bound bound;
    iso_field_bound_over(&bound, field, p, p);
    CHECK(bound.low <= 3 && bound.high >= 3 && bound.high - bound.low < 1e-6);
    iso_field_free(field);
}

/* ---- what a field is ---- */

static void test_is_z(void) {
    static const char *const flat[] = {"z",   " ( z )\n",    "((z))",         "+z",
                                       "z^1", "plane:0,0,1", "plane:0,0,3e-4"};
    static const char *const curved[] = {
        "plane:0,0,-1", "plane:1e-9,0,1", "-z", "z+1", "z*1.0001", "x", "cone:0", "0*x+z"};
    for (int i = 0; i < (int)(sizeof flat / sizeof *flat); i++) {
        iso_field *field = field_of(flat[i]);
        if (!CHECK(iso_field_is_z(field)))
            fprintf(stderr, "%s\n", flat[i]);
        CHECK(value_at(field, vec3(1e5, 3, 0.1)) == 0.1);
        iso_field_free(field);
    }
    for (int i = 0; i < (int)(sizeof curved / sizeof *curved); i++) {
        iso_field *field = field_of(curved[i]);
        CHECK(!iso_field_is_z(field));
        iso_field_free(field);
    }
    iso_field *blended;
    CHECK_OK(iso_field_blend(&blended, field_of("(z)"), 0, 1, 2));
    CHECK(iso_field_is_z(blended) && iso_field_kind_of(blended) == ISO_FIELD_BLEND);
    iso_field_free(blended);
}

static bool equal(iso_vec3 a, iso_vec3 b) {
    return vec3_distance(a, b) < 1e-15;
}

static void test_shape_of(void) {
    iso_field *field = field_of("fan:y,-30,2,15");
    field_shape shape = field_shape_of(field);
    CHECK(equal(shape.center, vec3(-30, 0, 2)) && equal(shape.from, vec3(1, 0, 0)));
    CHECK(equal(vec3_cross(shape.axis, shape.from), vec3(0, 0, 1)) && shape.radius == 15);
    iso_field_free(field);
    field = field_of("fan:x,5,2,-15");
    shape = field_shape_of(field);
    CHECK(equal(shape.center, vec3(0, 5, 2)) && equal(shape.from, vec3(0, -1, 0)));
    CHECK(equal(vec3_cross(shape.axis, shape.from), vec3(0, 0, 1)) && shape.radius == 15);
    iso_field_free(field);
    field = field_of("cylinder:x,5,2");
    shape = field_shape_of(field);
    CHECK(equal(shape.axis, vec3(1, 0, 0)) && equal(shape.from, vec3(0, 0, 1)) &&
          equal(shape.center, vec3(0, 5, 2)));
    iso_field_free(field);
    iso_field *blended;
    CHECK_OK(iso_field_blend(&blended, field_of("cone:-30,1,2"), 0, 1, 2));
    shape = field_shape_of(blended);
    CHECK(equal(shape.center, vec3(1, 2, 0)) && equal(shape.axis, vec3(0, 0, 1)));
    CHECK_NEAR(-tan(30 * degree), shape.slope, 1e-15);
    iso_field_free(blended);
    iso_field_free(NULL);
}

static void test_no_memory(void) {
    static const char *const text[] = {"cone:30", "z + 0.05*sqrt(x^2+y^2)", "z"};
    for (int k = 0; k < 3; k++) {
        iso_field *field = NULL;
        iso_status status = ISO_NO_MEMORY;
        int i = 0;
        for (; i < 100 && status == ISO_NO_MEMORY; i++) {
            iso_fail_allocation_after(i);
            status = iso_field_new(&field, text[k]);
            iso_fail_allocation_after(-1);
            CHECK((field != NULL) == (status == ISO_OK));
        }
        CHECK(status == ISO_OK && i > 1);
        iso_fail_allocation_after(0);
        iso_field *blended = field;
        CHECK_STATUS(ISO_NO_MEMORY, iso_field_blend(&blended, field, 0, 1, 2));
        iso_fail_allocation_after(-1);
        CHECK(blended == NULL);
    }
}

int main(void) {
    RUN(test_shapes);
    RUN(test_gradients);
    RUN(test_formulas_are_expressions);
    RUN(test_singular_places);
    RUN(test_arrays);
    RUN(test_long_expressions);
    RUN(test_is_z);
    RUN(test_shape_of);
    RUN(test_no_memory);
    return check_verdict();
}

/* Layers that merge: at every place blocks follow each other without gaps, no thicker and no
 * thinner than allowed, and hold what there is. */
#include "base/memory.h"
#include "chart/spread.h"
#include "check.h"
#include <math.h>
#include "lift/lift.h"

static const iso_vec3 box[2] = {{-20, -20, 0}, {20, 20, 30}};
static const spread_options usual = {0.2, 40.2, 0.2, 0.1, 0.32};

/* A fan around y, its part from 10 to 42 mm off the axis. */
static const iso_vec3 corners[4] = {{-20, -3, 0.1}, {12, -3, 0.1}, {-20, 3, 0.1}, {12, 3, 0.1}};

typedef struct setting {
    iso_field *field;
    chart *map;
    spread plan;
} setting;

static setting setting_new(const char *text, bool turns, const spread_options *options) {
    setting s = {0};
    CHECK_OK(iso_field_new(&s.field, text));
    CHECK_OK(chart_new(&s.map, s.field, turns, box, (double[2]){options->low, options->high}));
    CHECK_OK(spread_plan(&s.plan, s.map, corners, 4, options));
    return s;
}

static void setting_free(setting *s) {
    chart_free(s->map);
    iso_field_free(s->field);
}

static void test_tops_and_sources(void) {
    spread plan = {.doublings = 3, .count = 32};
    const int32_t most[] = {0, 1, 0, 2, 0, 1, 0, 3, 0, 1, 0, 2, 0, 1, 0, 3};
    for (int32_t top = 1; top <= 16; top++)
        CHECK_EQUAL(most[top - 1], spread_most(&plan, top));
    CHECK_EQUAL(7, spread_source(7, 0));
    CHECK_EQUAL(7, spread_source(8, 1));
    CHECK_EQUAL(6, spread_source(8, 2));
    CHECK_EQUAL(4, spread_source(8, 3));
    /* a step is the source of itself and of one block */
    int32_t of[32] = {0};
    for (int32_t top = 1; top <= 16; top++)
        for (int32_t k = 0; k <= spread_most(&plan, top); k++)
            of[spread_source(top, k)]++;
    for (int32_t i = 1; i < 8; i++)
        CHECK_EQUAL(2, of[i]);
}

static void test_plans(void) {
    spread_options o = usual;
    setting even = setting_new("cone:20", false, &o); /* everywhere as thick */
    CHECK_EQUAL(0, even.plan.doublings);
    CHECK_EQUAL(200, even.plan.count); /* 40 / 0.2 */
    setting_free(&even);
    setting fan = setting_new("fan:y,-30,0,30", true, &o);
    CHECK_EQUAL(2, fan.plan.doublings); /* 42 to 10 */
    CHECK_EQUAL(0, fan.plan.count % 4);
    CHECK(fan.plan.thickest <= 0.32 && fan.plan.thickest >= 0.3 - 1e-9);
    CHECK(42. / 30 * fan.plan.step <= fan.plan.thickest);
    CHECK_NEAR(40, fan.plan.count * fan.plan.step, 1e-9);
    o.most = 0.15; /* less than twice the least */
    CHECK_STATUS(ISO_OUTSIDE, spread_plan(&fan.plan, fan.map, corners, 4, &o));
    CHECK(strstr(iso_error_message(), "x -20.000 y -3.000 z 0.100") != NULL);
    setting_free(&fan);
}

/* Walk up: from each top the one block that holds goes on. */
static void try_place(const setting *s, iso_vec2 flat, const spread_options *o) {
    iso_arena arena = {0};
    int32_t covered = 0;
    double thinnest = 100, thickest = 0;
    for (int32_t top = 1; top <= s->plan.count; top++)
        for (int32_t k = 0; k <= spread_most(&s->plan, top); k++) {
            bool whole;
            chart_point point;
            CHECK_OK(spread_holds(&whole, &s->plan, (int32_t[2]){top, k}, &flat, 1, &arena));
            if (!whole)
                continue;
            CHECK_EQUAL(covered + (1 << k), top); /* right on what is there */
            covered = top;
            double layer[2] = {s->plan.low + top * s->plan.step, (1 << k) * s->plan.step};
            CHECK_OK(chart_layer(&point, s->map, &flat, layer, 1));
            thinnest = fmin(thinnest, point.thickness * layer[1]);
            thickest = fmax(thickest, point.thickness * layer[1]);
        }
    CHECK_EQUAL(s->plan.count, covered);
    CHECK(thinnest >= o->least && thickest <= o->most);
    iso_arena_free(&arena);
}

static void test_blocks_follow_each_other(void) {
    setting fan = setting_new("fan:y,-30,0,30", true, &usual);
    for (double v = 10; v <= 42; v += 0.37)
        try_place(&fan, (iso_vec2){1, v}, &usual);
    setting_free(&fan);
    /* as heights, with a thickness that changes from layer to layer, too */
    spread_options o = {0.1, 40, 0.2, 0.08, 0.32};
    setting bent = setting_new("z*(1 + 0.00004*(x + 20)^2*z)", false, &o);
    CHECK(bent.plan.doublings == 0);
    bent.plan = (spread){
        .chart = bent.map, .low = 0, .step = 0.1, .count = 256, .doublings = 3, .thickest = 0.2};
    o.least = 0.045; /* 0.1 / 2.1, where nothing merges yet */
    for (double x = -20; x <= 20; x += 0.83)
        try_place(&bent, (iso_vec2){x, 0}, &o);
    setting_free(&bent);
}

static double volume_of(const iso_paths *paths) {
    double sum = 0;
    for (int32_t p = 0; p < paths->count; p++) {
        const iso_path *path = &paths->path[p];
        for (int32_t i = 0; i < path->count - !path->closed; i++) {
            const iso_path_vertex *a = &paths->vertex[path->first + i],
                                  *b = &paths->vertex[path->first + (i + 1) % path->count];
            double x = a->at.x - b->at.x, y = a->at.y - b->at.y, z = a->z - b->z;
            sum += sqrt(x * x + y * y + z * z) * a->area / 1e12;
        }
    }
    return sum;
}

/* All steps with the same lines and a loop: together they hold what single steps would. */
static void test_merged_layers_hold_as_much(void) {
    setting fan = setting_new("fan:y,-30,0,30", true, &usual);
    iso_paths flat = {0}, part = {0}, out = {0};
    iso_arena arena = {0};
    iso_bead bead = iso_bead_of(4500, 2000);
    iso_point loop[4] = {{-30000, 110000}, {30000, 110000}, {30000, 410000}, {-30000, 410000}};
    iso_path like = {.role = ISO_ROLE_PERIMETER, .closed = 1, .group = 3};
    double single = 0, merged = 0;
    CHECK_OK(iso_paths_add(&flat, &like, loop, 4, bead.width, bead.area));
    like.closed = 0;
    like.follows = 1;
    for (int k = 0; k < 20; k++) {
        iso_point line[3] = {
            {-20000 + 2000 * k, 120000}, {-19000, 250000 + 1000 * k}, {-20000 + 2000 * k, 400000}};
        CHECK_OK(iso_paths_add(&flat, &like, line, 3, bead.width, bead.area));
    }
    lift_options o = {.tolerance = 0.01, .least = usual.least, .most = usual.most};
    int pieces = 0;
    for (int32_t top = 1; top <= fan.plan.count; top++) {
        o.r = fan.plan.low + top * fan.plan.step;
        for (int32_t k = 0; k <= spread_most(&fan.plan, top); k++) {
            int32_t block[2] = {top, k};
            CHECK_OK(spread_paths(&part, &flat, &fan.plan, block, &arena));
            o.thickness = (1 << k) * fan.plan.step;
            CHECK_OK(lift_paths(&out, &part, fan.map, &o, &arena));
            merged += volume_of(&out);
            pieces += out.count;
        }
        o.thickness = fan.plan.step;
        o.least = o.most = 0;
        CHECK_OK(lift_paths(&out, &flat, fan.map, &o, &arena));
        o.least = usual.least;
        o.most = usual.most;
        single += volume_of(&out);
    }
    CHECK_NEAR(single, merged, 1e-4 * single);
    CHECK(pieces > 0);
    /* cut paths lose what doesn't hold any more */
    CHECK_OK(spread_paths(&part, &flat, &fan.plan, (int32_t[2]){2, 1}, &arena));
    CHECK(part.count >= 21);
    for (int32_t p = 0; p < part.count; p++) {
        CHECK(part.path[p].closed == 0);
        CHECK(part.path[p].group == 0 || part.path[p].group == 3);
        for (int32_t i = 0; i < part.path[p].count; i++) {
            const iso_path_vertex *v = &part.vertex[part.path[p].first + i];
            CHECK_EQUAL(2 * bead.area, v->area);
            CHECK(iso_mm(v->at.y) / 30 * 2 * fan.plan.step <= fan.plan.thickest * 1.001);
        }
    }
    iso_paths_free(&flat);
    iso_paths_free(&part);
    iso_paths_free(&out);
    iso_arena_free(&arena);
    setting_free(&fan);
}

static void test_out_of_memory(void) {
    setting fan = setting_new("fan:y,-30,0,30", true, &usual);
    iso_paths flat = {0};
    iso_point line[2] = {{0, 110000}, {0, 410000}};
    iso_path like = {.role = ISO_ROLE_PERIMETER};
    iso_status status = ISO_NO_MEMORY;
    CHECK_OK(iso_paths_add(&flat, &like, line, 2, 4500, 800000));
    for (int64_t n = 0; status != ISO_OK && n < 50; n++) {
        iso_paths part = {0};
        iso_arena arena = {0};
        iso_fail_allocation_after(n);
        status = spread_paths(&part, &flat, &fan.plan, (int32_t[2]){2, 1}, &arena);
        iso_fail_allocation_after(-1);
        CHECK_EQUAL(status == ISO_OK, part.count);
        iso_paths_free(&part);
        iso_arena_free(&arena);
    }
    CHECK_EQUAL(ISO_OK, status);
    iso_paths_free(&flat);
    setting_free(&fan);
}

int main(void) {
    RUN(test_tops_and_sources);
    RUN(test_plans);
    RUN(test_blocks_follow_each_other);
    RUN(test_merged_layers_hold_as_much);
    RUN(test_out_of_memory);
    return check_verdict();
}

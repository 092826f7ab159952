/* Charts: there and back, by how much they stretch, contours that wrap, and what layers hold. */
#include <stdlib.h>

#include "base/memory.h"
#include "chart/analytic.h"
#include "chart/chart.h"
#include "check.h"

static const double pi = 3.14159265358979323846;
static const iso_vec3 box[2] = {{-20, -20, 0}, {20, 20, 12}};

static uint32_t seed = 1;

static double random_between(double low, double high) {
    seed = seed * 1664525u + 1013904223u;
    return low + (high - low) * (seed >> 8) / (1 << 24);
}

static iso_field *field_of(const char *text) {
    iso_field *field = NULL;
    CHECK_OK(iso_field_new(&field, text));
    return field;
}

static chart *chart_of(const iso_field *field, chart_kind kind, double low, double high) {
    chart *map = NULL;
    CHECK_OK(chart_new(&map, field, true, box, (double[2]){low, high}));
    CHECK_EQUAL(kind, chart_kind_of(map));
    return map;
}

/* ---- points ---- */

/* Lifted points lie on the layer, come down where they came from, and their factors are what
 * differences of lifted points say. */
static void try_round_trip(const char *text, chart_kind kind, double r, const double area[4]) {
    iso_field *field = field_of(text);
    chart *map = chart_of(field, kind, r - 5, r + 5);
    for (int k = 0; k < 200; k++) {
        const double h = 1e-4;
        double u = random_between(area[0], area[1]), v = random_between(area[2], area[3]);
        iso_vec2 flat[5] = {{u, v}, {u + h, v}, {u - h, v}, {u, v + h}, {u, v - h}}, down;
        chart_point point[5], above, below;
        double value;
        iso_vec3 gradient;
        CHECK_OK(chart_lift(point, map, flat, r, 5));
        chart_down(&down, map, &point[0].at, 1);
        CHECK_NEAR(u, down.x, 1e-9);
        CHECK_NEAR(v, down.y, 1e-9);
        iso_field_evaluate(&value, &gradient, field, &point[0].at, 1);
        CHECK_NEAR(r, value, 1e-9);
        CHECK_NEAR(1, vec3_dot(vec3_unit(gradient), point[0].normal), 1e-12);
        CHECK_NEAR(1 / vec3_length(gradient), point[0].thickness, 1e-9);
        CHECK_OK(chart_lift(&above, map, flat, r + h, 1));
        CHECK_OK(chart_lift(&below, map, flat, r - h, 1));
        iso_vec3 du = vec3_times(vec3_minus(point[1].at, point[2].at), 0.5 / h);
        iso_vec3 dv = vec3_times(vec3_minus(point[3].at, point[4].at), 0.5 / h);
        iso_vec3 dr = vec3_times(vec3_minus(above.at, below.at), 0.5 / h);
        CHECK_NEAR(vec3_dot(vec3_cross(du, dv), dr), point[0].volume, 1e-5);
    }
    chart_free(map);
    iso_field_free(field);
}

static void test_points_there_and_back(void) {
    const double square[4] = {-15, 15, -15, 15};
    try_round_trip("cone:0.5", CHART_GRAPH, 8, square);
    try_round_trip("cone:-0.3,2,1", CHART_GRAPH, 8, square);
    try_round_trip("wave:0.5,6,30", CHART_GRAPH, 8, square);
    try_round_trip("z + 0.05*sqrt(x^2+y^2+1) + 0.003*z*z", CHART_GRAPH, 8, square);
    try_round_trip("sphere:1,2,-8", CHART_SPHERE, 14, (double[4]){-15, 15, -15, 15});
    try_round_trip("cylinder:x,0,6", CHART_CYLINDER, 9, (double[4]){-25, 25, -15, 15});
    try_round_trip("cylinder:z,1,2", CHART_CYLINDER, 9, (double[4]){-25, 25, 0, 15});
    try_round_trip("cylinder:y,1,2", CHART_CYLINDER, 9, (double[4]){-25, 25, 0, 15});
    try_round_trip("fan:y,-30,0,30", CHART_FAN, 8, (double[4]){-15, 15, 10, 50});
    try_round_trip("fan:x,-30,0,30", CHART_FAN, 20, (double[4]){-15, 15, 10, 50});
    try_round_trip("fan:x,-30,0,30", CHART_FAN, 30 * 2.5,
                   (double[4]){-15, 15, 10, 50}); /* 143 deg */
}

/* Any points of space come down to where they are lifted from, at their own level. */
static void test_points_of_space_come_down(void) {
    const char *const text[] = {"sphere:1,2,-8", "cylinder:x,0,6", "fan:y,-30,0,30", "cone:0.3"};
    const chart_kind kind[] = {CHART_SPHERE, CHART_CYLINDER, CHART_FAN, CHART_GRAPH};
    for (int k = 0; k < 4; k++) {
        iso_field *field = field_of(text[k]);
        chart *map = chart_of(field, kind[k], 5, 9);
        for (int i = 0; i < 200; i++) {
            iso_vec3 at =
                vec3(random_between(-20, 20), random_between(-20, 20), random_between(0, 12));
            iso_vec2 flat;
            chart_point point;
            double value;
            iso_field_evaluate(&value, NULL, field, &at, 1);
            chart_down(&flat, map, &at, 1);
            CHECK_OK(chart_lift(&point, map, &flat, value, 1));
            CHECK_NEAR(0, vec3_distance(at, point.at), 1e-8);
        }
        chart_free(map);
        iso_field_free(field);
    }
}

/* Which chart: their own for fields that the machine turns the part for, else heights. */
static void test_kinds(void) {
    iso_field *sphere = field_of("sphere:0,0,-30"), *blended = NULL;
    const double range[2] = {30, 42};
    chart *map = NULL;
    CHECK_OK(chart_new(&map, sphere, false, box, range));
    CHECK_EQUAL(CHART_GRAPH, chart_kind_of(map));
    CHECK_EQUAL(0, chart_period(map));
    chart_free(map);
    CHECK_OK(iso_field_blend(&blended, sphere, 30, 1, 5));
    CHECK_OK(chart_new(&map, blended, true, box, range)); /* flat below: no map of a sphere */
    CHECK_EQUAL(CHART_GRAPH, chart_kind_of(map));
    chart_free(map);
    iso_field_free(blended);
    iso_field *cylinder = field_of("cylinder:x,0,0");
    map = chart_of(cylinder, CHART_CYLINDER, 5, 9);
    CHECK_NEAR(14 * pi, chart_period(map), 1e-3);
    CHECK_NEAR(0, fmod(chart_period(map) * ISO_UNITS_PER_MM + 1e-3, 2), 2e-3);
    chart_free(map);
    iso_field_free(cylinder);
    chart_free(NULL);
}

/* Flat layers that bend into cones: where the field is even already a layer is found by one look,
 * and as right as where it isn't. */
static void test_points_of_a_blend(void) {
    iso_field *field = NULL;
    chart *map = NULL;
    chart_point point[400];
    iso_vec2 flat[400];
    CHECK_OK(iso_field_blend(&field, field_of("cone:0.4"), 0, 2, 6));
    CHECK_OK(chart_new(&map, field, false, box, (double[2]){0, 18}));
    CHECK(chart_reach(map) >= 1);
    for (double r = 0.3; r < 18; r += 0.7) {
        for (int i = 0; i < 400; i++)
            flat[i] = (iso_vec2){random_between(-20, 20), random_between(-20, 20)};
        CHECK_OK(chart_layer(point, map, flat, (double[2]){r, 0.2}, 400));
        for (int i = 0; i < 400; i++) {
            double value, below;
            iso_vec3 gradient, low = point[i].at;
            iso_field_evaluate(&value, &gradient, field, &point[i].at, 1);
            CHECK_NEAR(r, value, 1e-9);
            CHECK_NEAR(1, vec3_dot(vec3_unit(gradient), point[i].normal), 1e-9);
            low.z -= 0.2 * point[i].volume;
            iso_field_evaluate(&below, NULL, field, &low, 1);
            CHECK_NEAR(r - 0.2, below, 2e-4);
        }
    }
    chart_free(map);
    iso_field_free(field);
}

/* How far normals tell: the shorter the waves, the less. */
static void test_reach(void) {
    const char *const text[] = {"cone:0.4", "sphere:0,0,-30", "wave:0.3,3", "wave:1,12"};
    const double least[] = {0, 8, 1, 4}, most[] = {0, 16, 2, 12};
    for (int k = 0; k < 4; k++) {
        iso_field *field = field_of(text[k]);
        chart *map = NULL;
        const double low = k == 1 ? 30 : 0;
        CHECK_OK(chart_new(&map, field, false, box, (double[2]){low, low + 12}));
        CHECK(chart_reach(map) >= least[k] && chart_reach(map) <= most[k]);
        chart_free(map);
        iso_field_free(field);
    }
}

/* ---- what can't be ---- */

static void test_layers_that_fold_are_refused(void) {
    iso_field *down = field_of("x - z"), *fold = field_of("z + 0.2*sin(2*z)*x"),
              *sphere = field_of("sphere:0,0,6");
    const double range[2] = {0, 12};
    chart *map = NULL;
    CHECK_STATUS(ISO_OUTSIDE, chart_new(&map, down, false, box, range));
    CHECK(map == NULL);
    CHECK(strstr(iso_error_message(), "doesn't rise with z") != NULL);
    iso_field_free(down);

    /* fine in the middle, but where |x| > 2.5 it falls here and there: only curves tell that the
     * part is there, too */
    iso_vec3 at[4] = {{1, 0, 3}, {1, 1, 3}, {0, 1, 3}, {8, 0, 1.5}};
    int32_t level_first[2] = {0, 1};
    int64_t contour_first[2] = {0, 3};
    iso_curves curves = {1, 1, 3, level_first, contour_first, at};
    iso_slices slices;
    CHECK_OK(chart_new(&map, fold, false, box, range));
    CHECK_OK(chart_slices(&slices, map, &curves, 0));
    CHECK_EQUAL(3, slices.crossing_count);
    iso_slices_free(&slices);
    curves.crossing_count = contour_first[1] = 4;
    CHECK_STATUS(ISO_OUTSIDE, chart_slices(&slices, map, &curves, 0));
    CHECK(strstr(iso_error_message(), "x 8.000 y 0.000 z 1.500") != NULL);
    CHECK(slices.point == NULL);
    chart_free(map);
    iso_field_free(fold);

    /* under the center of a sphere its map tears */
    at[3] = vec3(0.1, 0, 2);
    map = chart_of(sphere, CHART_SPHERE, 1, 5);
    CHECK_STATUS(ISO_OUTSIDE, chart_slices(&slices, map, &curves, 0));
    CHECK(strstr(iso_error_message(), "x 1.000 y 0.000 z 3.000") != NULL);
    chart_free(map);
    iso_field_free(sphere);
}

/* The axis of a fan may be on the part's box, but not on the part. */
static void test_a_fan_beside_its_axis(void) {
    iso_field *fan = field_of("fan:y,-20,0,30");
    chart *map = chart_of(fan, CHART_FAN, 0, 30);
    iso_vec3 at[3] = {{10, 0, 3}, {10, 1, 3}, {0, 1, 3}};
    int32_t level_first[2] = {0, 1};
    int64_t contour_first[2] = {0, 3};
    iso_curves curves = {1, 1, 3, level_first, contour_first, at};
    iso_slices slices;
    CHECK_OK(chart_slices(&slices, map, &curves, 0));
    iso_slices_free(&slices);
    at[2] = vec3(-20, 1, 0.05);
    CHECK_STATUS(ISO_OUTSIDE, chart_slices(&slices, map, &curves, 0));
    CHECK(strstr(iso_error_message(), "x -20.000 y 1.000 z 0.050") != NULL);
    CHECK(slices.point == NULL);
    chart_free(map);
    iso_field_free(fan);
}

static void test_places_without_a_layer(void) {
    iso_field *sphere = field_of("sphere:0,0,-30"), *fan = field_of("fan:y,-30,0,30");
    analytic rooted = analytic_field(ISO_FIELD_EXPRESSION, 25, 0);
    const double range[2] = {30, 42};
    chart *map;
    chart_point point;
    iso_vec2 flat = {36, 0};
    CHECK_OK(chart_new(&map, sphere, false, box, range));
    CHECK_OK(chart_lift(&point, map, &flat, 37, 1)); /* outside the part, as travels may be */
    CHECK_NEAR(sqrt(37 * 37 - 36 * 36.0) - 30, point.at.z, 1e-9);
    flat.x = 38;
    CHECK_STATUS(ISO_OUTSIDE, chart_lift(&point, map, &flat, 37, 1));
    CHECK(strstr(iso_error_message(), "x 38.000 y 0.000") != NULL);
    chart_free(map);
    map = chart_of(sphere, CHART_SPHERE, 30, 42);
    flat.x = 73;
    CHECK_STATUS(ISO_OUTSIDE, chart_lift(&point, map, &flat, 37, 1));
    chart_free(map);
    map = chart_of(fan, CHART_FAN, 0, 20);
    flat.y = -1;
    CHECK_STATUS(ISO_OUTSIDE, chart_lift(&point, map, &flat, 5, 1));
    chart_free(map);
    iso_field_free(sphere);
    iso_field_free(fan);

    /* a search that steps where the field has no value comes back */
    CHECK_OK(chart_new(&map, analytic_use(&rooted), false, box, (double[2]){2, 6}));
    for (int i = -40; i < 100; i++) {
        flat = (iso_vec2){0.3 * i, 0};
        CHECK_OK(chart_lift(&point, map, &flat, 3, 1));
        CHECK_NEAR(9 - 25 + 0.3 * i, point.at.z, 1e-6);
    }
    chart_free(map);
}

/* A ball around the middle of the box without a value: a search that is led into it finds nothing
 * there, whatever the slope beside it. */
static void test_no_layer_where_there_is_no_value(void) {
    iso_field *field = field_of("z + 0.1*sqrt(x^2 + y^2 + (z-6)^2 - 1)");
    chart *map = chart_of(field, CHART_GRAPH, 0, 12);
    chart_point point[2];
    iso_vec2 flat[2] = {{0, 0}, {5, 0}};
    CHECK_OK(chart_lift(point, map, flat, 3, 2));
    CHECK_STATUS(ISO_OUTSIDE, chart_lift(point, map, flat, 6.05, 1));
    CHECK_OK(chart_lift(point, map, flat + 1, 6.05, 1));
    chart_free(map);
    iso_field_free(field);
}

/* A cone's layer takes one look at each place, others few. */
static void test_searches_are_short(void) {
    analytic even = analytic_field(ISO_FIELD_CONE, 0.4, 0),
             ball = analytic_field(ISO_FIELD_SPHERE, 30, 0);
    static iso_vec2 flat[10000];
    static chart_point point[10000];
    chart *map;
    for (int i = 0; i < 10000; i++)
        flat[i] = (iso_vec2){random_between(-20, 20), random_between(-20, 20)};
    CHECK_OK(chart_new(&map, analytic_use(&even), false, box, (double[2]){0, 20}));
    even.points = 0;
    CHECK_OK(chart_layer(point, map, flat, (double[2]){8, 0.2}, 10000));
    CHECK_EQUAL(10000, even.points);
    chart_free(map);
    CHECK_OK(chart_new(&map, analytic_use(&ball), false, box, (double[2]){30, 42}));
    ball.points = 0;
    CHECK_OK(chart_layer(point, map, flat, (double[2]){36, 0.2}, 10000));
    CHECK(ball.points < 60000);
    printf("     %.2f looks at the field for each place\n", ball.points / 10000.0);
    chart_free(map);
}

/* ---- volumes ---- */

/* A contour of one level, in space. */
typedef iso_vec3 curve(double t, double r);

typedef struct ring {
    iso_curves curves;
    int32_t level_first[2];
    int64_t contour_first[5];
    iso_vec3 at[20000];
} ring;

static void ring_begin(ring *of) {
    memset(of, 0, sizeof *of);
    of->curves = (iso_curves){.level_count = 1,
                              .level_first = of->level_first,
                              .contour_first = of->contour_first,
                              .point = of->at};
}

static void ring_add(ring *of, curve *at, double r, int count) {
    for (int i = 0; i < count; i++)
        of->at[of->curves.crossing_count++] = at((double)i / count, r);
    of->level_first[1] = ++of->curves.contour_count;
    of->contour_first[of->curves.contour_count] = of->curves.crossing_count;
}

static double volume_of(const chart *map, const ring *of, double r, double thickness) {
    iso_slices slices;
    iso_arena arena = {0};
    double volume = 0;
    CHECK_OK(chart_slices(&slices, map, &of->curves, 3));
    CHECK_OK(iso_slices_validate(&slices));
    CHECK_OK(chart_volume(&volume, map, &slices, 0, (double[2]){r, thickness}, &arena));
    iso_slices_free(&slices);
    iso_arena_free(&arena);
    return volume;
}

/* The part of a sphere around (0, 0, -8) above the cone of 60 degrees. */
static iso_vec3 cap(double t, double r) {
    return vec3(r * sqrt(0.75) * cos(2 * pi * t), r * sqrt(0.75) * sin(2 * pi * t), r * 0.5 - 8);
}

static void test_volume_of_a_ball_by_spheres(void) {
    static ring of;
    iso_field *field = field_of("sphere:0,0,-8");
    chart *map = chart_of(field, CHART_SPHERE, 4, 20);
    double sum = 0, t = 0.5;
    for (double r = 4 + t; r < 20 + t / 2; r += t) {
        ring_begin(&of);
        ring_add(&of, cap, r - t / 2, 4000);
        sum += volume_of(map, &of, r, t);
    }
    double exact = 2 * pi / 3 * (20 * 20 * 20 - 4 * 4 * 4) * 0.5;
    CHECK_NEAR(exact, sum, 1e-6 * exact);
    chart_free(map);
    iso_field_free(field);
}

/* A tube around x, from x = -7 to 9; its ends are rings, with the tube on their left, seen from
 * outside. */
static iso_vec3 tube_low(double t, double r) {
    return vec3(-7, r * cos(2 * pi * t), r * sin(2 * pi * t));
}

static iso_vec3 tube_high(double t, double r) {
    return vec3(9, r * cos(2 * pi * t), -r * sin(2 * pi * t));
}

/* A hole in it, where the chart ends: clockwise, seen from outside. */
static iso_vec3 hole(double t, double r) {
    double angle = pi - 2 / r * cos(2 * pi * t), x = 2 * sin(2 * pi * t);
    return vec3(x, r * cos(angle), r * sin(angle));
}

static void test_volume_of_a_tube_by_cylinders(void) {
    static ring of;
    iso_field *field = field_of("cylinder:x,0,0");
    chart *map = chart_of(field, CHART_CYLINDER, 5, 8);
    double sum = 0, holes = 0, t = 0.2;
    for (double r = 5 + t; r < 8 + t / 2; r += t) {
        ring_begin(&of);
        ring_add(&of, tube_low, r - t / 2, 500);
        ring_add(&of, tube_high, r - t / 2, 500);
        double whole = volume_of(map, &of, r, t);
        ring_add(&of, hole, r - t / 2, 500);
        sum += whole;
        holes += whole - volume_of(map, &of, r, t);
    }
    double exact = pi * (8 * 8 - 5 * 5) * 16;
    CHECK_NEAR(exact, sum, 1e-5 * exact);
    CHECK_NEAR(pi * 4 * 3, holes, 0.01);
    chart_free(map);
    iso_field_free(field);
}

/* Of a fan around y at x = -30, z = 0: a rectangle, on each of its planes. */
static double fan_angle;
static iso_vec3 rectangle(double t, double r) {
    double y = t < 0.5 ? -3 : 3, d = t < 0.25 || t >= 0.75 ? 25 : 37;
    (void)r;
    return vec3(-30 + d * cos(fan_angle), y, d * sin(fan_angle));
}

static void test_volume_of_an_elbow_by_a_fan(void) {
    static ring of;
    iso_field *field = field_of("fan:y,-30,0,30");
    chart *map = chart_of(field, CHART_FAN, 0, 60);
    double sum = 0;
    for (int i = 0; i < 100; i++) {
        double r = 0.6 * (i + 1);
        fan_angle = (r - 0.3) / 30;
        ring_begin(&of);
        ring_add(&of, rectangle, r, 4);
        sum += volume_of(map, &of, r, 0.6);
    }
    double exact = 0.5 * (37 * 37 - 25 * 25) * 2 * 6;
    CHECK_NEAR(exact, sum, 1e-9 * exact);
    chart_free(map);
    iso_field_free(field);
}

static iso_vec3 triangle(double t, double r) {
    double d = t < 0.3 ? 25 : t < 0.6 ? 31 : 37, y = t < 0.3 ? 3 : t < 0.6 ? -5 : -1;
    (void)r;
    return vec3(-30 + d * cos(fan_angle), y, d * sin(fan_angle));
}

/* What a fan's layer holds goes with the distance from the axis: of a triangle, that of its middle.
 */
static void test_volume_of_a_layer_of_a_fan(void) {
    static ring of;
    iso_field *field = field_of("fan:y,-30,0,30");
    chart *map = chart_of(field, CHART_FAN, 0, 60);
    fan_angle = 0.5;
    ring_begin(&of);
    ring_add(&of, triangle, 15, 3);
    double area = 0.5 * (8 * (37 - 25) - 4 * (31 - 25)), middle = (25 + 31 + 37) / 3.0;
    CHECK_NEAR(area * middle / 30 * 0.6, volume_of(map, &of, 15, 0.6), 1e-9);
    chart_free(map);
    iso_field_free(field);
}

/* A spherical dome's layers as heights: the dome's volume, whatever grid its layers are laid on. */
static iso_vec3 dome_rim(double t, double r) {
    double rim = sqrt(r * r - 30 * 30);
    return vec3(rim * cos(2 * pi * t), rim * sin(2 * pi * t), 0);
}

static void test_volume_of_a_dome_by_heights(void) {
    static ring of;
    iso_field *field = field_of("sphere:0,0,-30");
    const double range[2] = {30, 34};
    const iso_vec3 around[2] = {{-16, -16, 0}, {16, 16, 4}};
    chart *map;
    CHECK_OK(chart_new(&map, field, false, around, range));
    double sum = 0;
    for (int i = 0; i < 20; i++) {
        double r = 30 + 0.2 * (i + 1);
        ring_begin(&of);
        ring_add(&of, dome_rim, r - 0.1, 2000);
        sum += volume_of(map, &of, r, 0.2);
    }
    double h = 4, exact = pi * h * h / 3 * (3 * 34 - h);
    CHECK_NEAR(exact, sum, 1e-3 * exact); /* of steps at its rim */
    /* one layer against its own integral: z(r) - z(r - t) over a disc, in closed form */
    ring_begin(&of);
    ring_add(&of, dome_rim, 33.9, 8000);
    double q = 33.9 * 33.9 - 900, top = 34 * 34.0, low = 33.8 * 33.8;
    double layer =
        2 * pi / 3 * ((pow(top, 1.5) - pow(top - q, 1.5)) - (pow(low, 1.5) - pow(low - q, 1.5)));
    CHECK_NEAR(layer, volume_of(map, &of, 34, 0.2), 3e-5 * layer);
    chart_free(map);
    iso_field_free(field);
}

/* ---- memory ---- */

static void test_out_of_memory(void) {
    static ring of;
    iso_field *cylinder = field_of("cylinder:x,0,0"), *sphere = field_of("sphere:0,0,-30");
    const double range[2] = {30, 34};
    for (int k = 0; k < 2; k++) {
        iso_field *field = k == 0 ? cylinder : sphere;
        ring_begin(&of);
        ring_add(&of, k == 0 ? tube_low : dome_rim, k == 0 ? 6 : 32, 100);
        if (k == 0)
            ring_add(&of, tube_high, 6, 100);
        iso_status status = ISO_NO_MEMORY;
        for (int64_t n = 0; status != ISO_OK && n < 100; n++) {
            chart *map;
            iso_slices slices;
            iso_arena arena = {0};
            double volume;
            iso_fail_allocation_after(n);
            status = chart_new(&map, field, k == 0, box, range);
            if (status == ISO_OK) {
                status = chart_slices(&slices, map, &of.curves, 2);
                if (status == ISO_OK) {
                    status = chart_volume(&volume, map, &slices, 0, (double[2]){6, 0.2}, &arena);
                    if (k == 1 && status == ISO_OUTSIDE)
                        status = ISO_OK;
                    iso_slices_free(&slices);
                }
                chart_free(map);
            }
            iso_fail_allocation_after(-1);
            iso_arena_free(&arena);
            CHECK(status == ISO_OK || status == ISO_NO_MEMORY);
        }
        CHECK_EQUAL(ISO_OK, status);
    }
    iso_field_free(cylinder);
    iso_field_free(sphere);
}

int main(void) {
    RUN(test_points_there_and_back);
    RUN(test_points_of_space_come_down);
    RUN(test_points_of_a_blend);
    RUN(test_reach);
    RUN(test_kinds);
    RUN(test_layers_that_fold_are_refused);
    RUN(test_a_fan_beside_its_axis);
    RUN(test_places_without_a_layer);
    RUN(test_no_layer_where_there_is_no_value);
    RUN(test_searches_are_short);
    RUN(test_volume_of_a_ball_by_spheres);
    RUN(test_volume_of_a_tube_by_cylinders);
    RUN(test_volume_of_an_elbow_by_a_fan);
    RUN(test_volume_of_a_layer_of_a_fan);
    RUN(test_volume_of_a_dome_by_heights);
    RUN(test_out_of_memory);
    return check_verdict();
}

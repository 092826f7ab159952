/* Paths of a chart bent into space: on the layer, as much plastic as there is room for, and travels
 * above it. */
#include <stdlib.h>

#include "base/memory.h"
#include "chart/analytic.h"
#include "check.h"
#include "lift/lift.h"

static const iso_vec3 box[2] = {{-20, -20, 0}, {20, 20, 12}};
static const double range[2] = {0.2, 15};

/* Lines that fill a square from -half to half, mm, 0.4 mm apart, back and forth. */
static void fill_square(iso_paths *paths, double half, double angle) {
    iso_bead bead = iso_bead_of(4400, 2000);
    double c = cos(angle), s = sin(angle), space = iso_mm(bead.spacing);
    iso_path like = {.role = ISO_ROLE_SOLID_INFILL};
    int k = 0;
    for (double y = -half; y <= half; y += space, k++) {
        double ends[2] = {k % 2 ? half : -half, k % 2 ? -half : half};
        iso_point p[2];
        for (int i = 0; i < 2; i++)
            p[i] = (iso_point){iso_units(c * ends[i] - s * y), iso_units(s * ends[i] + c * y)};
        CHECK_OK(iso_paths_add(paths, &like, p, 2, bead.width, bead.area));
    }
}

static lift_options usual(double r) {
    return (lift_options){.r = r,
                          .thickness = 0.2,
                          .z = r,
                          .tolerance = 0.01,
                          .turn = 0.1,
                          .clearance = 0.6,
                          .near = 1};
}

static double length_of(const iso_paths *paths, int32_t a, int32_t b) {
    const iso_path_vertex *p = &paths->vertex[a], *q = &paths->vertex[b];
    double x = p->at.x - q->at.x, y = p->at.y - q->at.y, z = p->z - q->z;
    return sqrt(x * x + y * y + z * z) / ISO_UNITS_PER_MM;
}

/* mm^3 */
static double volume_of(const iso_paths *paths) {
    double sum = 0;
    for (int32_t p = 0; p < paths->count; p++) {
        const iso_path *path = &paths->path[p];
        for (int32_t i = 0; i < path->count - !path->closed; i++) {
            int32_t a = path->first + i, b = path->first + (i + 1) % path->count;
            sum += length_of(paths, a, b) * paths->vertex[a].area;
        }
    }
    return sum / ISO_UNITS_PER_MM / ISO_UNITS_PER_MM;
}

static iso_vec3 place_of(const iso_paths *paths, int32_t i, double z) {
    const iso_path_vertex *v = &paths->vertex[i];
    return vec3(iso_mm(v->at.x), iso_mm(v->at.y), iso_mm(v->z) + z);
}

static double field_at(const iso_field *field, iso_vec3 at, iso_vec3 *gradient) {
    double value;
    iso_field_evaluate(&value, gradient, field, &at, 1);
    return value;
}

/* The greatest distance of all beads from the layer. */
static double worst_of(const iso_paths *paths, const iso_field *field, const lift_options *o) {
    double worst = 0;
    for (int32_t p = 0; p < paths->count; p++) {
        const iso_path *path = &paths->path[p];
        for (int32_t i = 0; i < path->count - !path->closed; i++)
            for (int k = 0; k <= 10; k++) {
                iso_vec3 g, a = place_of(paths, path->first + i, o->z);
                iso_vec3 b = place_of(paths, path->first + (i + 1) % path->count, o->z);
                double off = field_at(field, vec3_between(a, b, k / 10.0), &g) - o->r;
                worst = fmax(worst, fabs(off) / vec3_length(g));
            }
    }
    return worst;
}

/* What the layer holds over the lines, by Simpson's rule along each: z(r) - z(r - t) for their
 * section in the chart. */
typedef double height_of(double x, double y, double r);

static double expected_volume(const iso_paths *flat, height_of *height, const lift_options *o) {
    double sum = 0;
    for (int32_t p = 0; p < flat->count; p++) {
        const iso_path_vertex *v = &flat->vertex[flat->path[p].first];
        double length = length_of(flat, flat->path[p].first, flat->path[p].first + 1), line = 0;
        enum { STEPS = 400 };
        for (int i = 0; i <= STEPS; i++) {
            double t = (double)i / STEPS, weight = i == 0 || i == STEPS ? 1 : i % 2 ? 4 : 2;
            double x = iso_mm(v[0].at.x) + t * iso_mm(v[1].at.x - v[0].at.x);
            double y = iso_mm(v[0].at.y) + t * iso_mm(v[1].at.y - v[0].at.y);
            line += weight * (height(x, y, o->r) - height(x, y, o->r - o->thickness));
        }
        sum += length * line / (3 * STEPS) / o->thickness * iso_mm(v[0].area) / ISO_UNITS_PER_MM;
    }
    return sum;
}

static double sphere_height(double x, double y, double r) {
    return sqrt(r * r - x * x - y * y) - 30;
}

static double cylinder_height(double x, double y, double r) {
    (void)x;
    return sqrt(r * r - y * y) - 30;
}

static double uneven_height(double x, double y, double r) {
    return (r - 0.01 * y * y) / (1 + 0.002 * x * x);
}

static double flat_height(double x, double y, double r) {
    (void)x, (void)y;
    return r;
}

static double tilted_height(double x, double y, double r) {
    (void)y;
    return r * sqrt(1.25) - 0.5 * x;
}

/* The volume within 0.01 %, the lines within the tolerance of the layer, and no more of them than
 * it takes. */
static void try_field(analytic *f, height_of *height, double r, double half) {
    iso_field *field = analytic_use(f);
    iso_paths flat = {0}, out = {0};
    iso_arena arena = {0};
    chart *map;
    lift_options o = usual(r);
    fill_square(&flat, half, 0.3);
    CHECK_OK(chart_new(&map, field, false, box, range));
    CHECK_OK(lift_paths(&out, &flat, map, &o, &arena));
    double expected = expected_volume(&flat, height, &o);
    CHECK_NEAR(expected, volume_of(&out), 1e-4 * expected);
    double worst = worst_of(&out, field, &o);
    CHECK(worst <= o.tolerance * 1.05);
    CHECK_EQUAL(flat.count, out.count);
    for (int32_t i = 0; i < out.vertex_count; i++) {
        iso_vec3 g;
        field_at(field, place_of(&out, i, o.z), &g);
        CHECK_NEAR(1, vec3_dot(vec3_unit(g), out.frame[i].normal), 1e-6);
        CHECK_NEAR(2000 / vec3_length(g), out.frame[i].height, 12);
    }
    printf("     %d lines became %d, %.5f mm off, %ld looks at the field\n", flat.count,
           out.vertex_count - out.count, worst, f->points);
    chart_free(map);
    iso_paths_free(&flat);
    iso_paths_free(&out);
    iso_arena_free(&arena);
}

static void test_volume_and_distance_from_the_layer(void) {
    analytic f = analytic_field(ISO_FIELD_CONE, 0.4, 0);
    try_field(&f, flat_height, 8, 15);
    f = analytic_field(ISO_FIELD_WAVE, 0.8, 2);
    try_field(&f, flat_height, 8, 15);
    f = analytic_field(ISO_FIELD_PLANE, 0.5, 0);
    try_field(&f, tilted_height, 8, 15);
    f = analytic_field(ISO_FIELD_SPHERE, 30, 0);
    try_field(&f, sphere_height, 36, 12);
    f = analytic_field(ISO_FIELD_CYLINDER, 30, 0);
    try_field(&f, cylinder_height, 36, 12);
    f = analytic_field(ISO_FIELD_FUNCTION, 0.002, 0.01);
    try_field(&f, uneven_height, 9, 12);
}

/* ---- other charts ---- */

/* Of a cylinder, sphere and fan: what lines over a patch hold is the layer's volume there. */
static void try_turning(const char *text, double r, double half, const iso_point *middle,
                        double exact_factor) {
    iso_field *field = NULL;
    iso_paths flat = {0}, out = {0};
    iso_arena arena = {0};
    chart *map;
    lift_options o = usual(r);
    o.z = 3;
    CHECK_OK(iso_field_new(&field, text));
    CHECK_OK(chart_new(&map, field, true, box, (double[2]){r - 3, r + 3}));
    fill_square(&flat, half, 0.3);
    for (int32_t i = 0; i < flat.vertex_count; i++) {
        flat.vertex[i].at.x += middle->x;
        flat.vertex[i].at.y += middle->y;
    }
    CHECK_OK(lift_paths(&out, &flat, map, &o, &arena));
    double exact = volume_of(&flat) * exact_factor;
    if (exact_factor == 0) /* of a fan: v / R, which is linear */
        for (int32_t p = 0; p < flat.count; p++) {
            const iso_path_vertex *v = &flat.vertex[flat.path[p].first];
            exact += length_of(&flat, flat.path[p].first, flat.path[p].first + 1) * v->area / 1e8 *
                     iso_mm(v[0].at.y + v[1].at.y) / 2 / 30;
        }
    CHECK_NEAR(exact, volume_of(&out), 1e-4 * exact);
    CHECK(worst_of(&out, field, &o) <= o.tolerance * 1.05);
    /* off the lines they stand for, too: every vertex comes down on its line */
    double swerve = 0;
    for (int32_t p = 0; p < out.count; p++)
        for (int32_t i = 0; i + 1 < out.path[p].count; i++)
            for (int k = 1; k < 8; k++) {
                const iso_path_vertex *a = &flat.vertex[flat.path[p].first];
                iso_vec3 at = vec3_between(place_of(&out, out.path[p].first + i, o.z),
                                           place_of(&out, out.path[p].first + i + 1, o.z), k / 8.0);
                iso_vec2 down, on;
                chart_point point;
                chart_down(&down, map, &at, 1);
                double x = iso_mm(a[1].at.x - a[0].at.x), y = iso_mm(a[1].at.y - a[0].at.y);
                double t = ((down.x - iso_mm(a->at.x)) * x + (down.y - iso_mm(a->at.y)) * y) /
                           (x * x + y * y);
                on = (iso_vec2){iso_mm(a->at.x) + t * x, iso_mm(a->at.y) + t * y};
                CHECK_OK(chart_lift(&point, map, &on, r, 1));
                swerve = fmax(swerve, vec3_distance(point.at, at));
            }
    CHECK(swerve <= 1.05 * o.tolerance);
    printf("     %d lines became %d, %.4f mm off\n", flat.count, out.vertex_count - out.count,
           swerve);
    chart_free(map);
    iso_field_free(field);
    iso_paths_free(&flat);
    iso_paths_free(&out);
    iso_arena_free(&arena);
}

static void test_charts_of_machines_that_turn(void) {
    iso_point middle = {0, 0};
    double r = 14, t = 0.2;
    try_turning("cylinder:x,0,6", r, 8, &middle, (r - t / 2) / r);
    try_turning("sphere:1,2,-8", r, 8, &middle, (r * r * r - pow(r - t, 3)) / (3 * t * r * r));
    middle.x = 60000;
    middle.y = -150000;
    try_turning("sphere:1,2,-8", r, 5, &middle, (r * r * r - pow(r - t, 3)) / (3 * t * r * r));
    middle.y = 300000;
    try_turning("fan:y,-30,0,30", r, 8, &middle, 0);
}

/* A loop around a cylinder, its last segment over the end of the chart. */
static void test_a_loop_around_a_cylinder(void) {
    iso_field *field = NULL;
    iso_paths flat = {0}, out = {0};
    iso_arena arena = {0};
    chart *map;
    lift_options o = usual(10);
    iso_path like = {.role = ISO_ROLE_PERIMETER, .closed = 1};
    o.z = 0;
    CHECK_OK(iso_field_new(&field, "cylinder:z,0,0"));
    CHECK_OK(chart_new(&map, field, true, box, (double[2]){8, 12}));
    int32_t half = iso_units(chart_period(map) / 2);
    iso_point ring[5];
    for (int i = 0; i < 5; i++)
        ring[i] = (iso_point){-half + 2 * half / 5 * i, 30000};
    CHECK_OK(iso_paths_add(&flat, &like, ring, 5, 4400, 800000));
    CHECK_OK(lift_paths(&out, &flat, map, &o, &arena));
    CHECK(worst_of(&out, field, &o) <= o.tolerance * 1.05);
    double length = 0;
    for (int32_t i = 0; i < out.vertex_count; i++)
        length += length_of(&out, i, (i + 1) % out.vertex_count);
    CHECK_NEAR(2 * 3.14159265358979 * 10, length, 0.1);
    double exact = chart_period(map) * 800000 / 1e8 * 9.9 / 10;
    CHECK_NEAR(exact, volume_of(&out), 1e-4 * exact);
    CHECK_EQUAL(1, out.path[0].closed);
    o.arcs = true; /* then vertices are where the layer is */
    CHECK_OK(lift_paths(&out, &flat, map, &o, &arena));
    for (int32_t i = 0; i < out.vertex_count; i++) {
        iso_vec3 at = place_of(&out, i, o.z);
        CHECK_NEAR(10, sqrt(at.x * at.x + at.y * at.y), 1.5e-4);
    }
    chart_free(map);
    iso_field_free(field);
    iso_paths_free(&flat);
    iso_paths_free(&out);
    iso_arena_free(&arena);
}

/* ---- travels ---- */

/* Short lines here and there, with ways between them that turn once. */
static void scatter(iso_paths *paths) {
    uint32_t seed = 3;
    for (int k = 0; k < 60; k++) {
        iso_path like = {.role = ISO_ROLE_SOLID_INFILL};
        iso_point p[2], turn;
        for (int i = 0; i < 3; i++) {
            seed = seed * 1664525u + 1013904223u;
            turn = (iso_point){(int32_t)(seed >> 8) % 200000 - 100000,
                               (int32_t)(seed >> 12) % 200000 - 100000};
            if (i < 2)
                p[i] = turn;
        }
        CHECK_OK(iso_paths_add(paths, &like, p, 2, 4400, 800000));
        if (k % 3 != 1)
            continue;
        CHECK_OK(ISO_GROW(paths->travel, paths->travel_capacity, paths->travel_count + 1));
        paths->path[k].travel_first = paths->travel_count;
        paths->path[k].travel_count = 1;
        paths->travel[paths->travel_count++] = turn;
    }
}

static iso_vec3 turn_of(const iso_paths *paths, int32_t i, double z) {
    return vec3(iso_mm(paths->travel[i].x), iso_mm(paths->travel[i].y),
                iso_mm(paths->travel_frame[i].z) + z);
}

static void try_travels(analytic *f, double r) {
    const iso_field *field = analytic_use(f);
    iso_paths flat = {0}, out = {0};
    iso_arena arena = {0};
    chart *map;
    lift_options o = usual(r);
    iso_point from = {-50000, 30000};
    o.from = &from;
    scatter(&flat);
    CHECK_OK(chart_new(&map, field, false, box, range));
    CHECK_OK(lift_paths(&out, &flat, map, &o, &arena));
    double least = 100, most = 0, least_share = 100;
    for (int32_t p = 0; p < out.count; p++) {
        double length = 0, lowest = 100;
        const iso_path *path = &out.path[p];
        CHECK(path->travel_count >= 2 || (path->travel_count == 1 && p > 0));
        iso_vec3 first = turn_of(&out, path->travel_first, o.z), g;
        iso_vec3 begin = p == 0 ? vec3(-5, 3, first.z) : place_of(&out, path->first - 1, o.z);
        if (path->travel_count > 1) {
            CHECK_NEAR(begin.x, first.x, 2e-4);
            CHECK_NEAR(begin.y, first.y, 2e-4);
            CHECK(p == 0 || first.z > begin.z + 0.03);
        }
        for (int32_t i = 0; i + 1 < path->travel_count; i++)
            length += vec3_distance(turn_of(&out, path->travel_first + i, o.z),
                                    turn_of(&out, path->travel_first + i + 1, o.z));
        iso_vec3 end = place_of(&out, path->first, o.z);
        iso_vec3 last = turn_of(&out, path->travel_first + path->travel_count - 1, o.z);
        CHECK_NEAR(end.x, last.x, 2e-4);
        CHECK_NEAR(end.y, last.y, 2e-4);
        for (int32_t i = 0; i + 1 < path->travel_count; i++)
            for (int k = 0; k <= 10; k++) {
                iso_vec3 at = vec3_between(turn_of(&out, path->travel_first + i, o.z),
                                           turn_of(&out, path->travel_first + i + 1, o.z), k / 10.);
                double above = (field_at(field, at, &g) - r) / vec3_length(g);
                lowest = fmin(lowest, above);
                most = fmax(most, above);
            }
        least = fmin(least, lowest);
        least_share = fmin(least_share, lowest / fmin(o.clearance, length / 4));
    }
    CHECK(least > 0.04);
    CHECK(least_share > 0.9);
    CHECK(most < 2 * o.clearance);
    printf("     travels are %.3f to %.3f mm above the layer, %d points\n", least, most,
           out.travel_count);
    chart_free(map);
    iso_paths_free(&flat);
    iso_paths_free(&out);
    iso_arena_free(&arena);
}

static void test_travels_stay_above_the_layer(void) {
    analytic f = analytic_field(ISO_FIELD_CONE, 0.4, 0);
    try_travels(&f, 12);
    f = analytic_field(ISO_FIELD_CONE, -0.4, 0);
    try_travels(&f, 12);
    f = analytic_field(ISO_FIELD_WAVE, 0.8, 2);
    try_travels(&f, 8);
    f = analytic_field(ISO_FIELD_SPHERE, 30, 0);
    try_travels(&f, 39);
}

/* Where a flat tip stands on a slope its edge is lower than its middle, and clear all the same. */
static void test_travels_keep_the_tip_clear(void) {
    analytic f = analytic_field(ISO_FIELD_PLANE, 0.5, 0);
    iso_paths flat = {0}, out = {0};
    iso_arena arena = {0};
    chart *map;
    lift_options o = usual(12);
    o.tip = 0.4;
    o.clearance = 0.1; /* less than the tip needs on this slope */
    scatter(&flat);
    CHECK_OK(chart_new(&map, analytic_use(&f), false, box, range));
    CHECK_OK(lift_paths(&out, &flat, map, &o, &arena));
    for (int32_t i = out.path[5].travel_first; i < out.travel_count; i++) {
        iso_vec3 at = turn_of(&out, i, o.z), g;
        at.x -= o.tip; /* uphill */
        CHECK(field_at(&f.base, at, &g) > 12);
    }
    chart_free(map);
    iso_paths_free(&flat);
    iso_paths_free(&out);
    iso_arena_free(&arena);
}

/* The nozzle never goes lower than the bed, though the layer does. */
static void test_travels_stay_above_the_bed(void) {
    analytic f = analytic_field(ISO_FIELD_CONE, 0.5, 0);
    iso_paths flat = {0}, out = {0};
    iso_arena arena = {0};
    chart *map;
    lift_options o = usual(2);
    iso_path like = {.role = ISO_ROLE_SOLID_INFILL};
    iso_point left[2] = {{-1000, 0}, {-30000, 0}}, right[2] = {{30000, 0}, {1000, 0}};
    CHECK_OK(chart_new(&map, analytic_use(&f), false, box, range));
    CHECK_OK(iso_paths_add(&flat, &like, left, 2, 4400, 800000));
    CHECK_OK(iso_paths_add(&flat, &like, right, 2, 4400, 800000));
    CHECK_OK(ISO_GROW(flat.travel, flat.travel_capacity, 1));
    flat.travel[flat.travel_count++] = (iso_point){0, 190000};
    flat.path[1].travel_count = 1;
    CHECK_OK(lift_paths(&out, &flat, map, &o, &arena));
    CHECK_EQUAL(0, out.path[0].travel_count); /* nobody knows where the nozzle comes from */
    for (int32_t i = 0; i < out.travel_count; i++)
        CHECK(turn_of(&out, i, o.z).z >= o.clearance);
    chart_free(map);
    iso_paths_free(&flat);
    iso_paths_free(&out);
    iso_arena_free(&arena);
}

/* Where the layer lies flat, short ways go along the beads; on slopes a flat tip would scrape. */
static void test_near_travels(void) {
    analytic f = analytic_field(ISO_FIELD_SPHERE, 30, 0);
    iso_paths flat = {0}, out = {0};
    iso_arena arena = {0};
    chart *map;
    lift_options o = usual(36);
    iso_path like = {.role = ISO_ROLE_SOLID_INFILL};
    iso_point a[2] = {{-3000, 0}, {1000, 0}}, b[2] = {{1000, 2000}, {100000, 0}},
              c[2] = {{100000, 4000}, {90000, 0}};
    CHECK_OK(chart_new(&map, analytic_use(&f), false, box, range));
    CHECK_OK(iso_paths_add(&flat, &like, a, 2, 4400, 800000));
    CHECK_OK(iso_paths_add(&flat, &like, b, 2, 4400, 800000));
    CHECK_OK(iso_paths_add(&flat, &like, c, 2, 4400, 800000));
    CHECK_OK(lift_paths(&out, &flat, map, &o, &arena));
    CHECK_EQUAL(0, out.path[0].travel_count);
    CHECK_EQUAL(1, out.path[1].travel_count);
    int32_t turn = out.path[1].travel_first, vertex = out.path[1].first;
    CHECK_EQUAL(out.vertex[vertex].at.x, out.travel[turn].x);
    CHECK_EQUAL(out.vertex[vertex].z, out.travel_frame[turn].z);
    CHECK(out.path[2].travel_count >= 2);
    o.near = 0;
    CHECK_OK(lift_paths(&out, &flat, map, &o, &arena));
    CHECK(out.path[1].travel_count >= 2);
    chart_free(map);
    iso_paths_free(&flat);
    iso_paths_free(&out);
    iso_arena_free(&arena);
}

/* A way that leads where there is no layer isn't known; the others are. */
static void test_ways_without_a_layer(void) {
    analytic f = analytic_field(ISO_FIELD_SPHERE, 30, 0);
    iso_paths flat = {0}, out = {0};
    iso_arena arena = {0};
    chart *map;
    lift_options o = usual(36);
    CHECK_OK(chart_new(&map, analytic_use(&f), false, box, range));
    scatter(&flat);
    flat.travel[flat.path[4].travel_first] = (iso_point){900000, 0};
    CHECK_OK(lift_paths(&out, &flat, map, &o, &arena));
    for (int32_t p = 1; p < out.count; p++)
        CHECK_EQUAL(p != 4, out.path[p].travel_count > 0);
    chart_free(map);
    iso_paths_free(&flat);
    iso_paths_free(&out);
    iso_arena_free(&arena);
}

/* ---- what stays, and what is refused ---- */

static void test_paths_keep_what_they_are(void) {
    analytic f = analytic_field(ISO_FIELD_PLANE, 0.5, 0);
    iso_paths flat = {0}, out = {0};
    iso_arena arena = {0};
    chart *map;
    lift_options o = usual(8);
    iso_path like = {.role = ISO_ROLE_EXTERNAL_PERIMETER,
                     .closed = 1,
                     .tool = 1,
                     .speed_class = 1,
                     .object = 4,
                     .group = 5,
                     .rank = 6,
                     .retract = ISO_RETRACT_NOT};
    iso_point square[4] = {{0, 0}, {100000, 0}, {100000, 100000}, {0, 100000}};
    iso_bead bead = iso_bead_of(4400, 2000);
    CHECK_OK(chart_new(&map, analytic_use(&f), false, box, range));
    CHECK_OK(iso_paths_add(&flat, &like, square, 0, 0, 0)); /* nothing, and stays that */
    CHECK_OK(iso_paths_add(&flat, &like, square, 4, bead.width, bead.area));
    flat.vertex[2].role = ISO_ROLE_OVERHANG_PERIMETER;
    CHECK_OK(lift_paths(&out, &flat, map, &o, &arena));
    CHECK_EQUAL(2, out.count);
    const iso_path *path = &out.path[1];
    CHECK_EQUAL(4, path->count);
    CHECK(path->role == like.role && path->closed && path->tool == 1 && path->speed_class == 1);
    CHECK(path->object == 4 && path->group == 5 && path->rank == 6);
    CHECK_EQUAL(ISO_RETRACT_NOT, path->retract);
    CHECK_EQUAL(ISO_ROLE_OVERHANG_PERIMETER, out.vertex[path->first + 2].role);
    /* along y nothing rises: the bead's section is that of a plane that the square's shadow is
     * larger on, sqrt(1.25) times as high upright as it is thick */
    CHECK_NEAR(bead.area * sqrt(1.25), out.vertex[path->first + 1].area, 2);
    CHECK_NEAR(bead.area, out.vertex[path->first].area, 100);
    CHECK_EQUAL(2000, out.frame[path->first].height);
    CHECK_NEAR(out.vertex[path->first + 1].area,
               iso_bead_of(out.vertex[path->first + 1].width, 2000).area, 1001);
    CHECK_NEAR(0.5 / sqrt(1.25), out.frame[path->first].normal.x, 1e-9);
    CHECK_EQUAL(-50000 + 80000 * (sqrt(1.25) - 1), out.vertex[path->first + 1].z);
    chart_free(map);
    iso_paths_free(&flat);
    iso_paths_free(&out);
    iso_arena_free(&arena);
}

static void test_limits(void) {
    analytic f = analytic_field(ISO_FIELD_SPHERE, 30, 0),
             g = analytic_field(ISO_FIELD_FUNCTION, 0.002, 0);
    iso_paths flat = {0}, out = {0};
    iso_arena arena = {0};
    chart *map;
    lift_options o = usual(36);
    iso_path like = {.role = ISO_ROLE_SOLID_INFILL};
    iso_point line[2] = {{0, 0}, {180000, 0}};
    CHECK_OK(chart_new(&map, analytic_use(&f), false, box, range));
    CHECK_OK(iso_paths_add(&flat, &like, line, 2, 4400, 800000));
    o.slope = 18 / sqrt(36 * 36 - 18 * 18) + 1e-3;
    CHECK_OK(lift_paths(&out, &flat, map, &o, &arena));
    o.slope -= 4e-3;
    CHECK_STATUS(ISO_OUTSIDE, lift_paths(&out, &flat, map, &o, &arena));
    CHECK_EQUAL(0, out.count);
    CHECK(out.frame == NULL);
    CHECK(strstr(iso_error_message(), "field_slope") != NULL);
    CHECK(strstr(iso_error_message(), "x 18.000 y 0.000 z 1.177") != NULL);
    chart_free(map);
    /* 0.2 mm in the middle, 0.2 / 1.648 at the end, upright */
    CHECK_OK(chart_new(&map, analytic_use(&g), false, box, range));
    o = usual(8);
    o.least = 0.1;
    o.most = 0.2;
    CHECK_OK(lift_paths(&out, &flat, map, &o, &arena));
    o.most = 0.19;
    CHECK_STATUS(ISO_OUTSIDE, lift_paths(&out, &flat, map, &o, &arena));
    CHECK(strstr(iso_error_message(), "x 0.000 y 0.000 z 8.000") != NULL);
    CHECK(strstr(iso_error_message(), "thicker than 0.1900") != NULL);
    o.most = 0;
    o.least = 0.13;
    CHECK_STATUS(ISO_OUTSIDE, lift_paths(&out, &flat, map, &o, &arena));
    CHECK(strstr(iso_error_message(), "thinner than 0.1300") != NULL);
    chart_free(map);
    iso_paths_free(&flat);
    iso_paths_free(&out);
    iso_arena_free(&arena);
}

static void test_out_of_memory(void) {
    analytic f = analytic_field(ISO_FIELD_SPHERE, 30, 0);
    iso_paths flat = {0};
    chart *map;
    lift_options o = usual(36);
    CHECK_OK(chart_new(&map, analytic_use(&f), false, box, range));
    scatter(&flat);
    iso_status status = ISO_NO_MEMORY;
    for (int64_t n = 0; status != ISO_OK && n < 100; n++) {
        iso_paths out = {0};
        iso_arena arena = {0};
        iso_fail_allocation_after(n);
        status = lift_paths(&out, &flat, map, &o, &arena);
        iso_fail_allocation_after(-1);
        CHECK_EQUAL(status == ISO_OK ? 60 : 0, out.count);
        iso_paths_free(&out);
        iso_arena_free(&arena);
    }
    CHECK_EQUAL(ISO_OK, status);
    chart_free(map);
    iso_paths_free(&flat);
}

int main(void) {
    RUN(test_charts_of_machines_that_turn);
    RUN(test_a_loop_around_a_cylinder);
    RUN(test_travels_stay_above_the_layer);
    RUN(test_travels_keep_the_tip_clear);
    RUN(test_travels_stay_above_the_bed);
    RUN(test_near_travels);
    RUN(test_ways_without_a_layer);
    RUN(test_paths_keep_what_they_are);
    RUN(test_limits);
    RUN(test_out_of_memory);
    RUN(test_volume_and_distance_from_the_layer);
    return check_verdict();
}

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

int main(void) {
    RUN(test_volume_and_distance_from_the_layer);
    return check_verdict();
}

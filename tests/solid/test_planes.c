/* Winding numbers in planes against those by rays through a tree, in all six directions. */
#include "solid/planes.h"

#include <stdlib.h>

#include "base/memory.h"
#include "check.h"
#include "solid/shapes.h"

#include <isoslice/solid.h>

enum { LEVELS = 23, POINTS = 400 };

/* Some by chance; some over a corner, whose rays meet corners and edges; some a nanometre off. */
static void make_points(iso_vec3 *point, const test_shape *shape, double z, uint64_t *seed) {
    for (int i = 0; i < POINTS; i++) {
        iso_vec3 a = shape->corner[(int64_t)(shape_random(seed) * 3 * (double)shape->count)];
        iso_vec3 b = shape->corner[(int64_t)(shape_random(seed) * 3 * (double)shape->count)];
        double part = i % 3 ? shape_random(seed) : 0, up = i % 5 ? 0 : i % 2 ? 1e-6 : -1e-6;
        point[i] = (iso_vec3){b.x + part * (a.x - b.x), a.y + part * (b.y - a.y), z + up};
    }
}

/* Levels between corners, and every other one through a corner. Two meshes: half of the triangles
 * each. */
static void check_shape(const test_shape *shape) {
    static iso_vec3 point[POINTS];
    static plane_point scratch[POINTS];
    static int32_t found[POINTS], expected[POINTS];
    test_shape half[2] = {*shape, *shape};
    iso_mesh mesh[3];
    double cut[LEVELS], low = shape->corner[0].z, high = low;
    iso_levels levels = {.count = LEVELS, .cut = cut};
    half[0].count = shape->count / 2;
    half[1].count -= half[0].count;
    half[1].corner += 3 * half[0].count;
    shape_mesh(&mesh[0], &half[0]);
    mesh[1] = (iso_mesh){0};
    shape_mesh(&mesh[2], &half[1]);
    for (int64_t i = 0; i < 3 * shape->count; i++) {
        low = fmin(low, shape->corner[i].z);
        high = fmax(high, shape->corner[i].z);
    }
    uint64_t seed = 3;
    for (int32_t i = 0; i < LEVELS; i++) {
        double next = low + (high - low) * i / (LEVELS - 1), best = high;
        for (int64_t k = 0; k < 3 * shape->count && i % 2; k++)
            if (shape->corner[k].z >= next && shape->corner[k].z < best)
                best = shape->corner[k].z;
        cut[i] = i % 2 ? best : next;
    }
    iso_solid *solid = NULL;
    solid_planes planes = {0};
    iso_winding_options options = {.directions = 6};
    CHECK_OK(iso_solid_new(&solid, mesh, 3));
    if (CHECK_OK(planes_make(&planes, mesh, 3, &levels)))
        for (int32_t i = 0; i < LEVELS; i++) {
            make_points(point, shape, cut[i], &seed);
            planes_winding(found, &planes, i, point, POINTS, scratch);
            CHECK_OK(iso_solid_winding(expected, NULL, solid, point, POINTS, &options));
            if (!CHECK(memcmp(found, expected, sizeof found) == 0))
                fprintf(stderr, "  at level %d, z %g\n", i, cut[i]);
        }
    planes_free(&planes);
    iso_solid_free(solid);
    shape_mesh_free(&mesh[0]);
    shape_mesh_free(&mesh[2]);
}

static void test_torus(void) {
    test_shape shape = {0};
    shape_torus(&shape, (iso_vec3){0.1, 0.2, 0.3}, 20, 6, 60);
    check_shape(&shape);
    shape_free(&shape);
}

/* Corners on few places, so that most points are on triangles, edges or corners. */
static void test_boxes(void) {
    test_shape shape = {0};
    uint64_t seed = 4;
    for (int i = 0; i < 40; i++) {
        iso_vec3 a = {floor(9 * shape_random(&seed)), floor(9 * shape_random(&seed)),
                      floor(9 * shape_random(&seed))};
        iso_vec3 b = {a.x + 1 + floor(4 * shape_random(&seed)),
                      a.y + 1 + floor(4 * shape_random(&seed)),
                      a.z + 1 + floor(4 * shape_random(&seed))};
        shape_box(&shape, a, b, i % 4 != 0);
    }
    check_shape(&shape);
    shape_free(&shape);
}

/* A grid of 16 um: a level meets, rounded, what it doesn't meet in truth. */
static void test_far_away(void) {
    test_shape shape = {0};
    shape_sphere(&shape, (iso_vec3){1.6e10, -1.6e10, 1.6e10}, 30, 16);
    shape_spindle(&shape, (iso_vec3){1.6e10, -1.6e10, 1.6e10}, 40, 50, 17);
    check_shape(&shape);
    shape_free(&shape);
}

static void test_nothing(void) {
    iso_mesh mesh = {0};
    double cut = 1;
    iso_levels levels = {.count = 1, .cut = &cut};
    iso_vec3 point = {0, 0, 1};
    plane_point scratch;
    int32_t winding = 5;
    solid_planes planes;
    if (CHECK_OK(planes_make(&planes, &mesh, 1, &levels))) {
        planes_winding(&winding, &planes, 0, &point, 1, &scratch);
        CHECK_EQUAL(0, winding);
    }
    planes_free(&planes);
    levels.count = 0;
    CHECK_OK(planes_make(&planes, &mesh, 1, &levels));
    planes_free(&planes);
}

int main(void) {
    RUN(test_torus);
    RUN(test_boxes);
    RUN(test_far_away);
    RUN(test_nothing);
    return check_verdict();
}

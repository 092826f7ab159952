/* Rings along surfaces whose lengths are known. */
#include <isoslice/channel.h>

#include <stdlib.h>

#include "channel/tower.h"
#include "check.h"
#include "shapes.h"

enum { LEVELS = 81, SAMPLES = 100 };
static const double pitch = 5;

/* The height F of each level, and where its rings are: against the curve's true length. */
static void check_pitch(const shape *s, double (*way)(double, double)) {
    iso_mesh mesh;
    iso_arena arena = {0};
    contours all;
    tower *t;
    int32_t count = 0;
    tower_options options = {.samples = SAMPLES};
    shape_mesh(&mesh, s);
    CHECK_OK(contours_cut_flat(&all, &mesh, LEVELS, &arena));
    CHECK_OK(towers_build(&t, &count, &all, &options, &arena));
    CHECK_EQUAL(1, count);
    CHECK_EQUAL(LEVELS, t->rings);
    double total = t->f[(LEVELS - 1) * SAMPLES] / way(s->low, s->high) - 1, worst = 0;
    for (int k = 0; pitch * (k + 1) <= t->f[(LEVELS - 1) * SAMPLES]; k++) {
        double from = tower_point(t, 0, pitch * k).z, to = tower_point(t, 0, pitch * (k + 1)).z;
        worst = fmax(worst, fabs(way(from, to) / pitch - 1));
    }
    printf("total %+.5f %%, largest of a pitch %.4f %%\n", 100 * total, 100 * worst);
    CHECK(fabs(total) <= 1e-4);
    CHECK(worst <= 1e-3);
    iso_arena_free(&arena);
    iso_mesh_free(&mesh);
}

static void test_a_cone(void) {
    check_pitch(&(shape){cone_radius, 0, 40, 1, 1, 0, 180, 241}, cone_way);
}
static void test_a_zone_of_a_sphere(void) {
    check_pitch(&(shape){sphere_radius, -25, 25, 1, 1, 0, 180, 241}, sphere_way);
}
static void test_a_paraboloid(void) {
    check_pitch(&(shape){paraboloid_radius, 1, 40, 1, 1, 0, 180, 241}, paraboloid_way);
}

int main(void) {
    RUN(test_a_cone);
    RUN(test_a_zone_of_a_sphere);
    RUN(test_a_paraboloid);
    return check_verdict();
}

/* Rings along surfaces whose lengths are known. */
#include <isoslice/channel.h>

#include <stdlib.h>

#include "channel/tower.h"
#include "check.h"
#include "front.h"
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

/* Where the surface is developable the front itself can be checked: an oblique cone's side unrolls
 * around its apex, and the shortest way from the base is a straight line, to wherever it is
 * shortest. */
static double unrolled_way(iso_vec3 p) {
    enum { BASE = 20000 };
    iso_vec3 apex = {27, 0, 60};
    double best = INFINITY, angle = 0, from = hypot(hypot(p.x - apex.x, p.y), p.z - apex.z);
    iso_vec3 d = {(p.x - apex.x) / from, p.y / from, (p.z - apex.z) / from}, last = d;
    for (int direction = -1; direction <= 1; direction += 2) {
        angle = 0;
        last = d;
        double start = atan2(p.y, p.x - 0.45 * p.z);
        for (int k = 0; k < BASE / 4; k++) {
            double a = start + direction * 2 * 3.14159265358979 * k / BASE;
            iso_vec3 b = {30 * cos(a) - apex.x, 30 * sin(a), -apex.z};
            double length = sqrt(b.x * b.x + b.y * b.y + b.z * b.z);
            iso_vec3 e = {b.x / length, b.y / length, b.z / length};
            angle += sqrt((e.x - last.x) * (e.x - last.x) + (e.y - last.y) * (e.y - last.y) +
                          (e.z - last.z) * (e.z - last.z));
            last = e;
            best = fmin(best, sqrt(length * length + from * from - 2 * length * from * cos(angle)));
        }
    }
    return best;
}

/* Root mean square of what the distance of rings' points is off by, relative to it. */
static double deviation(const shape *s, bool pointwise) {
    enum { MANY = 200 };
    iso_mesh mesh;
    iso_arena arena = {0};
    contours all;
    tower *t;
    int32_t count = 0;
    tower_options options = {.samples = MANY, .pointwise = pointwise};
    double *way = march(s), low, high, sum = 0;
    int n = 0;
    shape_mesh(&mesh, s);
    CHECK_OK(contours_cut_flat(&all, &mesh, LEVELS, &arena));
    CHECK_OK(towers_build(&t, &count, &all, &options, &arena));
    CHECK_EQUAL(1, count);
    tower_range(&low, &high, t);
    for (double f = pitch; f <= high; f += pitch)
        for (int32_t i = 0; i < MANY; i++, n++) {
            double off = way_at(s, way, tower_point(t, i, f)) / f - 1;
            sum += off * off;
        }
    CHECK(n >= 3 * MANY);
    for (int32_t a = 0; a < MANY * (t->rings - 1); a++) /* F never falls along beta */
        CHECK(t->f[a + MANY] >= t->f[a]);
    iso_arena_free(&arena);
    iso_mesh_free(&mesh);
    free(way);
    return sqrt(sum / n);
}

static const shape oblique = {cone_radius, 0, 40, 1, 1, 0.45, 240, 160};
static const shape ellipsoid = {sphere_radius, -25, 25, 1, 0.4, 0, 240, 160};

static void test_the_front_is_true(void) {
    double *way = march(&oblique), worst = 0;
    for (int i = 0; i < oblique.sides; i += 16)
        for (int j = 20; j < oblique.rings; j += 20) {
            double u = unrolled_way(shape_point(&oblique, i, j));
            worst = fmax(worst, fabs(way[i + oblique.sides * j] / u - 1));
        }
    printf("front against the unrolled cone: %.3f %% at most\n", 100 * worst);
    CHECK(worst < 0.01);
    free(way);
}

static void test_pointwise_on_an_oblique_cone(void) {
    double pointwise = deviation(&oblique, true), planar = deviation(&oblique, false);
    printf("pointwise %.2f %% rms, planar %.1f %%\n", 100 * pointwise, 100 * planar);
    CHECK(pointwise <= 0.025);
    CHECK(planar > 0.05); /* level rings can't be everywhere right */
}

static void test_pointwise_on_an_ellipsoid(void) {
    double pointwise = deviation(&ellipsoid, true), planar = deviation(&ellipsoid, false);
    printf("pointwise %.2f %% rms, planar %.1f %%\n", 100 * pointwise, 100 * planar);
    CHECK(pointwise <= 0.025);
    CHECK(planar > 0.03);
}

int main(void) {
    RUN(test_a_cone);
    RUN(test_a_zone_of_a_sphere);
    RUN(test_a_paraboloid);
    RUN(test_the_front_is_true);
    RUN(test_pointwise_on_an_oblique_cone);
    RUN(test_pointwise_on_an_ellipsoid);
    return check_verdict();
}

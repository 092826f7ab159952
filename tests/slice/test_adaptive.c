/* Adaptive layers against closed forms: slopes, spheres, steps. */
#include "check.h"

#include "base/memory.h"
#include "models/shapes.h"

#include <isoslice/slice.h>

static const iso_adaptive_options usual = {.first = 0.2, .min = 0.07, .max = 0.3, .cusp = 0.05};

static int levels_of(iso_levels *levels, shape *s, const iso_adaptive_options *options) {
    iso_mesh mesh;
    int good = CHECK_OK(iso_mesh_from_triangles(&mesh, s->triangle, s->count));
    shape_free(s);
    if (!good)
        return 0;
    double height = mesh.max.z;
    good = CHECK_OK(iso_levels_adaptive(levels, &mesh, 1, options));
    iso_mesh_free(&mesh);
    if (!good)
        return 0;
    double bottom = 0;
    for (int32_t i = 0; i < levels->count; i++) {
        double h = levels->height[i];
        CHECK_NEAR(bottom + h, levels->top[i], 1e-9);
        CHECK_NEAR(bottom + h / 2, levels->cut[i], 1e-9);
        CHECK(levels->cut[i] < height);
        if (i > 0)
            CHECK(h >= options->min - 1e-12 && h <= options->max + 1e-5);
        bottom = levels->top[i];
    }
    CHECK_NEAR(height, bottom, options->min / 2 + 1e-9);
    return 1;
}

static void test_upright_walls(void) {
    shape s = {0};
    iso_levels levels;
    shape_box(&s, 0, 0, 0, 20, 20, 18.2);
    if (!levels_of(&levels, &s, &usual))
        return;
    CHECK_EQUAL(1 + 60, levels.count);
    for (int32_t i = 1; i < levels.count; i++)
        CHECK_NEAR(0.3, levels.height[i], 1e-5);
    CHECK_NEAR((float)18.2, levels.top[levels.count - 1], 1e-9);
    iso_levels_free(&levels);
}

/* A cone whose sides have the slope atan(rise): every layer is as thick as its cusp allows. */
static void test_cone(void) {
    for (int k = 1; k < 8; k++) {
        double r = 10, z = 5.0 * k, n = r / sqrt(r * r + z * z);
        double right = fmin(0.3, fmax(0.07, 0.05 / n));
        shape s = {0};
        iso_levels levels;
        for (int j = 0; j < 256; j++) {
            double a = 2 * SHAPE_PI * j / 256, b = 2 * SHAPE_PI * ((j + 1) % 256) / 256;
            shape_point p = {r * cos(a), r * sin(a), 0}, q = {r * cos(b), r * sin(b), 0};
            shape_add(&s, p, q, (shape_point){0, 0, z});
            shape_add(&s, (shape_point){0, 0, 0}, q, p);
        }
        if (!levels_of(&levels, &s, &usual))
            continue;
        for (int32_t i = 2; i + 8 < levels.count; i++)
            CHECK_NEAR(right, levels.height[i], 1e-4);
        iso_levels_free(&levels);
    }
}

/* At height z over the middle of a sphere the normal's height is z / r. */
static void check_sphere(double r, const iso_adaptive_options *o) {
    shape s = {0};
    iso_levels levels;
    shape_sphere(&s, (shape_point){0, 0, r}, r, 400, 200);
    if (!levels_of(&levels, &s, o))
        return;
    double thickest = 0, step = (o->max - o->min) / 5;
    int32_t wide = 0, jumps = 0, thin = 0;
    for (int32_t i = 1; i < levels.count; i++) {
        double h = levels.height[i], low = levels.top[i] - h - r, high = levels.top[i] - r;
        double n = fmin(1, fmax(fabs(low), fabs(high)) / r);
        /* within the layer the facets' normals differ from the sphere's by half a ring */
        wide += h > o->min + 1e-9 && h * (n - 0.005) > o->cusp;
        jumps += i > 1 && fabs(h - levels.height[i - 1]) > step + 1e-9;
        thin += h < o->min * 1.3 && n < 0.1; /* no thinner than needed at the equator */
        thickest = fmax(thickest, h);
    }
    CHECK_EQUAL(0, wide);
    CHECK_EQUAL(0, jumps);
    CHECK_EQUAL(0, thin);
    CHECK_NEAR(o->max, thickest, 1e-6);
    CHECK(levels.height[1] < 2 * o->min && levels.height[levels.count - 1] < 2 * o->min);
    iso_levels_free(&levels);
}

static void test_sphere(void) {
    check_sphere(20, &usual);
    check_sphere(8, &usual);
    check_sphere(12, &(iso_adaptive_options){.first = 0.3, .min = 0.05, .max = 0.4, .cusp = 0.03});
}

/* Terraces: layers end at each of them. */
static void test_terraces(void) {
    static const double top[] = {3.01, 7.77, 9.5, 13.333};
    shape s = {0};
    iso_levels levels;
    for (int i = 0; i < 4; i++)
        shape_box(&s, 10 * i, 0, 0, 10 * i + 8, 8, top[i]);
    if (!levels_of(&levels, &s, &usual))
        return;
    for (int i = 0; i < 4; i++) {
        double nearest = 1;
        for (int32_t k = 0; k < levels.count; k++)
            nearest = fmin(nearest, fabs(levels.top[k] - (float)top[i]));
        CHECK_NEAR(0, nearest, 1e-9);
    }
    iso_levels_free(&levels);
}

/* Meshes count together, and the height is that of the highest. */
static void test_two_meshes(void) {
    shape s = {0};
    iso_mesh mesh[2];
    iso_levels levels;
    shape_box(&s, 0, 0, 0, 5, 5, 4);
    CHECK_OK(iso_mesh_from_triangles(&mesh[0], s.triangle, s.count));
    shape_free(&s);
    shape_sphere(&s, (shape_point){20, 0, 5}, 5, 40, 40);
    CHECK_OK(iso_mesh_from_triangles(&mesh[1], s.triangle, s.count));
    shape_free(&s);
    if (CHECK_OK(iso_levels_adaptive(&levels, mesh, 2, &usual))) {
        double nearest = 1;
        for (int32_t k = 0; k < levels.count; k++)
            nearest = fmin(nearest, fabs(levels.top[k] - 4));
        CHECK_NEAR(0, nearest, 1e-9);
        CHECK_NEAR(10, levels.top[levels.count - 1], 0.035);
        iso_levels_free(&levels);
    }
    for (int i = 0; i < 2; i++)
        iso_mesh_free(&mesh[i]);
}

static void test_nonsense(void) {
    shape s = {0};
    iso_mesh mesh;
    iso_levels levels;
    shape_box(&s, 0, 0, 0, 5, 5, 4);
    CHECK_OK(iso_mesh_from_triangles(&mesh, s.triangle, s.count));
    shape_free(&s);
    const iso_adaptive_options bad[] = {{0, 0.1, 0.2, 0.1},
                                        {0.2, 0, 0.2, 0.1},
                                        {0.2, 0.3, 0.2, 0.1},
                                        {0.2, 0.1, 0.2, NAN},
                                        {0.2, 1e-9, 0.2, 0.1}};
    for (int i = 0; i < 5; i++)
        CHECK_STATUS(ISO_USAGE, iso_levels_adaptive(&levels, &mesh, 1, &bad[i]));
    CHECK_STATUS(ISO_USAGE, iso_levels_adaptive(&levels, NULL, 0, &usual));
    iso_adaptive_options thick = usual;
    thick.first = 9; /* its middle is above the top */
    if (CHECK_OK(iso_levels_adaptive(&levels, &mesh, 1, &thick))) {
        CHECK_EQUAL(0, levels.count);
        iso_levels_free(&levels);
    }
    for (int n = 0; n < 6; n++) {
        iso_fail_allocation_after(n);
        CHECK_STATUS(ISO_NO_MEMORY, iso_levels_adaptive(&levels, &mesh, 1, &usual));
        iso_fail_allocation_after(-1);
        CHECK(!levels.cut);
    }
    iso_mesh_free(&mesh);
}

int main(void) {
    RUN(test_upright_walls);
    RUN(test_cone);
    RUN(test_sphere);
    RUN(test_terraces);
    RUN(test_two_meshes);
    RUN(test_nonsense);
    return check_verdict();
}

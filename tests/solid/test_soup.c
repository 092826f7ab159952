/* Winding numbers of soups against C's arctangent summed over all triangles, and against what is
 * known of spheres, tori and half spheres. */
#include "solid/soup.h"

#include <stdlib.h>

#include "base/memory.h"
#include "check.h"
#include "solid/shapes.h"

enum { POINTS = 400 };

static double brute(const test_shape *shape, iso_vec3 p) {
    double sum = 0;
    for (int64_t i = 0; i < shape->count; i++) {
        double v[3][3], l[3];
        for (int k = 0; k < 3; k++) {
            iso_vec3 c = shape->corner[3 * i + k];
            v[k][0] = c.x - p.x;
            v[k][1] = c.y - p.y;
            v[k][2] = c.z - p.z;
            l[k] = hypot(hypot(v[k][0], v[k][1]), v[k][2]);
        }
        double det = 0, dots[3] = {0};
        for (int k = 0; k < 3; k++) {
            int m = (k + 1) % 3, n = (k + 2) % 3;
            det += v[0][k] * (v[1][m] * v[2][n] - v[1][n] * v[2][m]);
            for (int j = 0; j < 3; j++)
                dots[k] += v[k][j] * v[m][j];
        }
        sum +=
            2 * atan2(det, l[0] * l[1] * l[2] + dots[0] * l[2] + dots[1] * l[0] + dots[2] * l[1]);
    }
    return sum / (4 * PI);
}

static void random_points(iso_vec3 *point, int64_t count, double size, uint64_t seed) {
    for (int64_t i = 0; i < count; i++)
        point[i] =
            (iso_vec3){(2 * shape_random(&seed) - 1) * size, (2 * shape_random(&seed) - 1) * size,
                       (2 * shape_random(&seed) - 1) * size};
}

static void check_against_brute(const test_shape *shape, double size, double tolerance) {
    static iso_vec3 point[POINTS];
    static double winding[POINTS];
    iso_soup *soup;
    if (!CHECK_OK(soup_new(&soup, shape->corner, shape->count)))
        return;
    random_points(point, POINTS, size, 7);
    soup_winding(winding, soup, point, POINTS);
    double worst = 0;
    for (int i = 0; i < POINTS; i++)
        worst = fmax(worst, fabs(winding[i] - brute(shape, point[i])));
    printf("     off by %.2g\n", worst);
    CHECK(worst <= tolerance);
    soup_free(soup);
}

static void test_closed_sphere(void) {
    test_shape shape = {0};
    shape_sphere(&shape, (iso_vec3){0}, 10, 40);
    check_against_brute(&shape, 15, 0.06);
    shape_free(&shape);
}

/* A sphere with a hole of 60 degrees: neither 0 nor 1. */
static void test_open_sphere(void) {
    test_shape shape = {0}, open = {0};
    shape_sphere(&shape, (iso_vec3){0}, 10, 40);
    for (int64_t i = 0; i < shape.count; i++)
        if (shape.corner[3 * i].z < 5)
            shape_triangle(&open, shape.corner[3 * i], shape.corner[3 * i + 1],
                           shape.corner[3 * i + 2]);
    check_against_brute(&open, 15, 0.06);
    shape_free(&shape);
    shape_free(&open);
}

static void test_random_triangles(void) {
    test_shape shape = {0};
    uint64_t seed = 3;
    for (int i = 0; i < 1000; i++) {
        iso_vec3 c[3];
        random_points(c, 3, 10, seed += 17);
        shape_triangle(&shape, c[0], c[1], c[2]);
    }
    check_against_brute(&shape, 15, 0.02);
    shape_free(&shape);
}

/* Few triangles are all near: no dipoles, nothing but rounding. */
static void test_one_leaf(void) {
    test_shape shape = {0};
    uint64_t seed = 5;
    for (int i = 0; i < 8; i++) {
        iso_vec3 c[3];
        random_points(c, 3, 10, seed += 17);
        shape_triangle(&shape, c[0], c[1], c[2]);
    }
    check_against_brute(&shape, 5, 1e-9);
    shape_free(&shape);
}

/* Within 1 % of the radius on both sides; soup_inside must be right on all. */
static void test_sides_of_a_torus(void) {
    enum { COUNT = 2000 };
    static iso_vec3 point[COUNT];
    static uint8_t inside[COUNT];
    test_shape shape = {0};
    shape_torus(&shape, (iso_vec3){1, 2, 3}, 20, 6, 200);
    uint64_t seed = 11;
    for (int i = 0; i < COUNT; i++) {
        double a = 2 * PI * shape_random(&seed), b = 2 * PI * shape_random(&seed);
        double tube = 6 * (i % 2 ? 0.99 : 1.01), r = 20 + tube * cos(b);
        point[i] = (iso_vec3){1 + r * cos(a), 2 + r * sin(a), 3 + tube * sin(b)};
    }
    iso_soup *soup;
    if (CHECK_OK(soup_new(&soup, shape.corner, shape.count))) {
        CHECK_OK(soup_inside(soup, inside, point, COUNT));
        int wrong = 0;
        for (int i = 0; i < COUNT; i++)
            wrong += inside[i] != i % 2;
        CHECK_EQUAL(0, wrong);
        soup_free(soup);
    }
    shape_free(&shape);
}

static void test_nothing_and_slivers(void) {
    iso_soup *soup;
    iso_vec3 point = {1, 2, 3};
    double winding = 5;
    uint8_t inside = 5;
    if (CHECK_OK(soup_new(&soup, NULL, 0))) {
        soup_winding(&winding, soup, &point, 1);
        CHECK_OK(soup_inside(soup, &inside, &point, 1));
        CHECK_EQUAL(0, inside);
        CHECK_NEAR(0, winding, 0);
        soup_free(soup);
    }
    test_shape shape = {0};
    for (int i = 0; i < 100; i++) /* no area; one corner is where it is asked for */
        shape_triangle(&shape, point, (iso_vec3){i, 0, 0}, (iso_vec3){i, 0, 0});
    if (CHECK_OK(soup_new(&soup, shape.corner, shape.count))) {
        soup_winding(&winding, soup, &point, 1);
        CHECK_NEAR(0, winding, 1e-12);
        soup_free(soup);
    }
    shape_free(&shape);
}

static void test_no_memory(void) {
    test_shape shape = {0};
    shape_sphere(&shape, (iso_vec3){0}, 10, 8);
    iso_status status = ISO_NO_MEMORY;
    int n = 0;
    for (; n < 20 && status == ISO_NO_MEMORY; n++) {
        iso_soup *soup;
        iso_fail_allocation_after(n);
        status = soup_new(&soup, shape.corner, shape.count);
        iso_fail_allocation_after(-1);
        CHECK(status == ISO_OK || soup == NULL);
        if (status == ISO_OK)
            soup_free(soup);
    }
    CHECK_EQUAL(ISO_OK, status);
    CHECK(n > 4);
    shape_free(&shape);
}

int main(void) {
    RUN(test_closed_sphere);
    RUN(test_open_sphere);
    RUN(test_random_triangles);
    RUN(test_one_leaf);
    RUN(test_sides_of_a_torus);
    RUN(test_nothing_and_slivers);
    RUN(test_no_memory);
    return check_verdict();
}

/* Winding numbers against an oracle: crossings along one ray in a direction by chance, counted over
 * all triangles with 128-bit integers; where the ray meets an edge, another direction is taken. No
 * tree, no axes, no perturbation.
 *
 * Corners are on a grid of 2^-16 mm and points on one of 2^-20 mm, which rounding leaves alone.
 * With paths of STL files as arguments, those are tested instead. */
#include <isoslice/solid.h>

#include <pthread.h>
#include <stdlib.h>

#include "base/memory.h"
#include "check.h"
#include "solid/shapes.h"

enum { POINTS = 10000, GRID = 1 << 20, CORNER_GRID = 1 << 16 };

typedef struct place {
    int64_t x, y, z;
} place;

static double snap_number(double value) {
    return floor(value * CORNER_GRID + 0.5) / CORNER_GRID;
}

static void snap(iso_vec3 *p) {
    *p = (iso_vec3){snap_number(p->x), snap_number(p->y), snap_number(p->z)};
}

static place place_of(iso_vec3 p) {
    return (place){llrint(p.x * GRID), llrint(p.y * GRID), llrint(p.z * GRID)};
}

static place minus(place a, place b) {
    return (place){a.x - b.x, a.y - b.y, a.z - b.z};
}

static __int128 triple(place a, place b, place c) {
    return (__int128)a.x * ((__int128)b.y * c.z - (__int128)b.z * c.y) +
           (__int128)a.y * ((__int128)b.z * c.x - (__int128)b.x * c.z) +
           (__int128)a.z * ((__int128)b.x * c.y - (__int128)b.y * c.x);
}

/* p on the flat triangle a b c, all relative to p, with no area: between two of the corners. */
static int between(place a, place b) {
    __int128 along = (__int128)a.x * b.x + (__int128)a.y * b.y + (__int128)a.z * b.z;
    return along <= 0 && a.y * (__int128)b.z == a.z * (__int128)b.y &&
           a.z * (__int128)b.x == a.x * (__int128)b.z && a.x * (__int128)b.y == a.y * (__int128)b.x;
}

static place normal_of(place a, place b, place c) {
    place u = minus(b, a), v = minus(c, a);
    return (place){u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
}

static int flat(place a, place b, place c) {
    place n = normal_of(a, b, c);
    return n.x == 0 && n.y == 0 && n.z == 0;
}

/* p = 0 in the plane of the triangle: whether it is in it. Along its normal, all edges turn one
 * way around p. */
static int in_triangle(place a, place b, place c) {
    if (flat(a, b, c))
        return between(a, b) || between(b, c) || between(c, a);
    place n = normal_of(a, b, c);
    n = (place){(n.x > 0) - (n.x < 0), (n.y > 0) - (n.y < 0), (n.z > 0) - (n.z < 0)};
    return triple(n, a, b) >= 0 && triple(n, b, c) >= 0 && triple(n, c, a) >= 0;
}

/* False: the ray meets an edge. */
static int count_crossings(int *winding, int *on, const place *corner, int64_t count, place p,
                           place way) {
    *winding = *on = 0;
    int good = 1;
    for (int64_t i = 0; i < count; i++) {
        place a = minus(corner[3 * i], p), b = minus(corner[3 * i + 1], p);
        place c = minus(corner[3 * i + 2], p);
        __int128 e = triple(way, a, b), f = triple(way, b, c), g = triple(way, c, a);
        int some_left = e > 0 || f > 0 || g > 0, some_right = e < 0 || f < 0 || g < 0;
        if (some_left && some_right)
            continue;
        __int128 height = triple(a, b, c);
        if (height == 0) {
            *on |= in_triangle(a, b, c);
            good &= flat(a, b, c) || (e != 0 && f != 0 && g != 0);
        } else if (e == 0 || f == 0 || g == 0) {
            good = 0;
        } else if ((height > 0) == some_left) {
            *winding += some_left ? 1 : -1;
        }
    }
    return good;
}

/* On the surface: *on, and the winding numbers next to it are a set, bit w + 16. */
static int oracle(int *on, const place *corner, int64_t count, place p, uint64_t *seed) {
    int winding = 0;
    for (int turn = 0; turn < 50; turn++) {
        place way;
        int64_t *w[3] = {&way.x, &way.y, &way.z};
        for (int k = 0; k < 3; k++)
            *w[k] = (int64_t)((2 * shape_random(seed) - 1) * 0x1p20) | 1;
        if (count_crossings(&winding, on, corner, count, p, way) || *on)
            return winding;
    }
    fprintf(stderr, "no direction that meets no edge\n");
    check_failures++;
    return winding;
}

static void check_beside(int winding, const place *corner, int64_t count, place p, uint64_t *seed) {
    enum { FINER = 64 };
    place *fine = malloc(3 * (size_t)count * sizeof *fine);
    for (int64_t i = 0; i < 3 * count; i++)
        fine[i] = (place){corner[i].x * FINER, corner[i].y * FINER, corner[i].z * FINER};
    int same = 0;
    for (int i = 0; i < 27 && !same; i++) {
        place beside = {p.x * FINER + i % 3 - 1, p.y * FINER + i / 3 % 3 - 1,
                        p.z * FINER + i / 9 - 1};
        int on;
        same = winding == oracle(&on, fine, count, beside, seed) && !on;
    }
    CHECK(same);
    free(fine);
}

static double pick(double a, double b, double t) {
    return a + (b - a) * t;
}

static iso_vec3 any_corner(const test_shape *shape, uint64_t *seed) {
    return shape->corner[(int64_t)(shape_random(seed) * 3 * (double)shape->count)];
}

/* Corner, or middle of an edge. */
static iso_vec3 any_target(const test_shape *shape, uint64_t *seed) {
    int64_t i = (int64_t)(shape_random(seed) * (double)shape->count);
    int k = (int)(shape_random(seed) * 3), edge = shape_random(seed) < 0.5;
    iso_vec3 a = shape->corner[3 * i + k], b = shape->corner[3 * i + (k + edge) % 3];
    return (iso_vec3){(a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2};
}

static iso_vec3 along_axis(iso_vec3 p, double way, uint64_t *seed) {
    int axis = (int)(shape_random(seed) * 3);
    *(axis == 0 ? &p.x : axis == 1 ? &p.y : &p.z) += way;
    return p;
}

static iso_vec3 in_box(const iso_mesh *mesh, uint64_t *seed) {
    return (iso_vec3){pick(mesh->min.x, mesh->max.x, 1.1 * shape_random(seed) - 0.05),
                      pick(mesh->min.y, mesh->max.y, 1.1 * shape_random(seed) - 0.05),
                      pick(mesh->min.z, mesh->max.z, 1.1 * shape_random(seed) - 0.05)};
}

static iso_vec3 near_surface(const test_shape *shape, uint64_t *seed) {
    const iso_vec3 *c = &shape->corner[3 * (int64_t)(shape_random(seed) * (double)shape->count)];
    double s = shape_random(seed), t = shape_random(seed) * (1 - s);
    iso_vec3 p = {c[0].x + s * (c[1].x - c[0].x) + t * (c[2].x - c[0].x),
                  c[0].y + s * (c[1].y - c[0].y) + t * (c[2].y - c[0].y),
                  c[0].z + s * (c[1].z - c[0].z) + t * (c[2].z - c[0].z)};
    double reach = 0.0005 * shape_random(seed);
    return (iso_vec3){p.x + reach * (2 * shape_random(seed) - 1),
                      p.y + reach * (2 * shape_random(seed) - 1),
                      p.z + reach * (2 * shape_random(seed) - 1)};
}

/* Half of them within 1 um of the surface, a third in line with corners and edges. */
static void make_points(iso_vec3 *point, const test_shape *shape, const iso_mesh *mesh) {
    uint64_t seed = 42;
    double size = mesh->max.x - mesh->min.x;
    for (int i = 0; i < POINTS; i++) {
        iso_vec3 *p = &point[i], q;
        switch (i % 20) {
        case 0: /* coordinates of three corners */
            *p = any_corner(shape, &seed);
            p->y = any_corner(shape, &seed).y;
            p->z = any_corner(shape, &seed).z;
            break;
        case 1:
        case 2:
        case 3:
        case 4: /* in line with a corner or an edge */
            *p = along_axis(any_target(shape, &seed), size * (shape_random(&seed) - 0.5), &seed);
            break;
        case 5: /* a corner, an edge */
            *p = any_target(shape, &seed);
            break;
        case 6:
        case 7: /* a corner, and less than 1 um from it */
            *p =
                along_axis(any_target(shape, &seed), 0.0009 * (2 * shape_random(&seed) - 1), &seed);
            break;
        default:
            q = i % 20 < 13 ? in_box(mesh, &seed) : near_surface(shape, &seed);
            *p = q;
        }
        place on_grid = place_of(*p);
        *p = (iso_vec3){(double)on_grid.x / GRID, (double)on_grid.y / GRID,
                        (double)on_grid.z / GRID};
    }
}

typedef struct answers {
    int32_t winding[POINTS], other[POINTS];
    uint8_t on[POINTS];
    iso_vec3 point[POINTS];
} answers;

static void compare(const answers *got, const test_shape *shape, int64_t points) {
    place *corner = malloc(3 * (size_t)shape->count * sizeof *corner);
    for (int64_t i = 0; i < 3 * shape->count; i++)
        corner[i] = place_of(shape->corner[i]);
    uint64_t seed = 99;
    int wrong = 0, wrong_on = 0, on_surface = 0, beside = 0, inside = 0;
    for (int64_t i = 0; i < points; i++) {
        int on, expected = oracle(&on, corner, shape->count, place_of(got->point[i]), &seed);
        on_surface += on;
        inside += expected != 0;
        wrong_on += on != got->on[i];
        if (!on)
            wrong += expected != got->winding[i];
        else if (beside++ < 100)
            check_beside(got->winding[i], corner, shape->count, place_of(got->point[i]), &seed);
    }
    printf("     %lld triangles, %lld points: %d inside, %d on it\n", (long long)shape->count,
           (long long)points, inside, on_surface);
    CHECK_EQUAL(0, wrong);
    CHECK_EQUAL(0, wrong_on);
    free(corner);
}

static void check_shape(test_shape *shape) {
    static answers got;
    iso_mesh mesh;
    for (int64_t i = 0; i < 3 * shape->count; i++)
        snap(&shape->corner[i]);
    shape_mesh(&mesh, shape);
    make_points(got.point, shape, &mesh);
    int64_t points = 2000000000 / shape->count;
    points = points < 1000 ? 1000 : points > POINTS ? POINTS : points;
    iso_solid *solid;
    if (CHECK_OK(iso_solid_new(&solid, &mesh, 1))) {
        iso_winding_options all = {.directions = 6, .seed = 5};
        CHECK_OK(iso_solid_winding(got.other, NULL, solid, got.point, points, &all));
        CHECK_OK(iso_solid_winding(got.winding, got.on, solid, got.point, points, NULL));
        CHECK(memcmp(got.other, got.winding, (size_t)points * sizeof *got.winding) == 0);
        compare(&got, shape, points);
        iso_solid_free(solid);
    }
    shape_mesh_free(&mesh);
    shape_free(shape);
}

static void test_cube(void) {
    test_shape shape = {0};
    shape_box(&shape, (iso_vec3){0}, (iso_vec3){20, 20, 20}, 1);
    check_shape(&shape);
}

static void test_inverted_cube(void) {
    test_shape shape = {0};
    shape_box(&shape, (iso_vec3){-3, -3, -3}, (iso_vec3){20, 5, 20}, 0);
    check_shape(&shape);
}

static void test_sphere(void) {
    test_shape shape = {0};
    shape_sphere(&shape, (iso_vec3){50, 50, 30}, 20, 16);
    check_shape(&shape);
}

static void test_torus(void) {
    test_shape shape = {0};
    shape_torus(&shape, (iso_vec3){1, 2, 3}, 20, 6, 24);
    check_shape(&shape);
}

/* Within each other, both ways around, twice the same, overlapping, with a face, an edge and a
 * corner in common. */
static void test_boxes(void) {
    test_shape shape = {0};
    iso_vec3 zero = {0};
    shape_box(&shape, zero, (iso_vec3){20, 20, 20}, 1);
    shape_box(&shape, (iso_vec3){5, 5, 5}, (iso_vec3){15, 15, 15}, 1);
    shape_box(&shape, (iso_vec3){7, 7, 7}, (iso_vec3){12, 12, 12}, 0);
    shape_box(&shape, zero, (iso_vec3){20, 20, 20}, 1);
    shape_box(&shape, (iso_vec3){10, 10, 10}, (iso_vec3){30, 30, 30}, 1);
    shape_box(&shape, (iso_vec3){20, 0, 0}, (iso_vec3){25, 20, 20}, 1);
    shape_box(&shape, (iso_vec3){20, 20, 0}, (iso_vec3){25, 25, 20}, 1);
    shape_box(&shape, (iso_vec3){-5, -5, -5}, zero, 0);
    shape_sphere(&shape, (iso_vec3){20, 20, 20}, 7, 6);
    check_shape(&shape);
}

/* Needles down to the grid. */
static void test_spindles(void) {
    test_shape shape = {0};
    shape_spindle(&shape, (iso_vec3){0}, 0.5, 100, 150);
    shape_spindle(&shape, (iso_vec3){0, 0, 50}, 40, 0.001, 150);
    shape_spindle(&shape, (iso_vec3){1, 1, 0}, 0x1p-14, 60, 40);
    check_shape(&shape);
}

/* Tetrahedra with corners among a few places: many in one plane, on one line, flat, upside down. */
static void test_lattice_of_tetrahedra(void) {
    test_shape shape = {0};
    uint64_t seed = 8;
    for (int i = 0; i < 150; i++) {
        iso_vec3 p[4];
        double step = i % 3 == 0 ? 1 : i % 3 == 1 ? 0x1p-10 : 0x1p-16;
        for (int k = 0; k < 4; k++)
            p[k] = (iso_vec3){step * floor(5 * shape_random(&seed)),
                              step * floor(5 * shape_random(&seed)),
                              step * floor(5 * shape_random(&seed))};
        for (int k = 0; k < 4; k++)
            shape_triangle(&shape, p[k], p[(k + 1 + k % 2) % 4], p[(k + 2 - k % 2) % 4]);
    }
    check_shape(&shape);
}

/* On the surface it is the side above that counts, then the one behind, then the one to the right:
 * what a slice that takes corners on its level as below has. */
static void test_sides_that_count(void) {
    test_shape shape = {0};
    iso_mesh mesh;
    shape_box(&shape, (iso_vec3){0}, (iso_vec3){8, 8, 8}, 1);
    shape_mesh(&mesh, &shape);
    iso_vec3 point[9] = {{4, 4, 0}, {4, 4, 8}, {4, 0, 4}, {4, 8, 4}, {0, 4, 4},
                         {8, 4, 4}, {0, 0, 0}, {8, 0, 0}, {0, 8, 0}};
    int32_t winding[9];
    uint8_t on[9];
    iso_solid *solid;
    if (CHECK_OK(iso_solid_new(&solid, &mesh, 1))) {
        iso_winding_options options = {.directions = 6};
        CHECK_OK(iso_solid_winding(winding, on, solid, point, 9, &options));
        for (int i = 0; i < 9; i++) {
            CHECK_EQUAL(i < 7 && i % 2 == 0, winding[i]);
            CHECK_EQUAL(1, on[i]);
        }
        iso_solid_free(solid);
    }
    shape_mesh_free(&mesh);
    shape_free(&shape);
}

static void test_analytic(void) {
    enum { COUNT = 4000 };
    static iso_vec3 point[COUNT];
    static int32_t winding[COUNT];
    test_shape shape = {0};
    iso_mesh mesh;
    shape_torus(&shape, (iso_vec3){0.1, 0.2, 0.3}, 20, 6, 500);
    shape_mesh(&mesh, &shape);
    uint64_t seed = 11;
    for (int i = 0; i < COUNT; i++) { /* facets are at most 2 % of 1 mm away from the torus */
        double a = 2 * PI * shape_random(&seed), b = 2 * PI * shape_random(&seed);
        double tube = i % 2 ? 6 * shape_random(&seed) - 0.002 : 6.000001 + shape_random(&seed);
        double r = 20 + (tube > 0 ? tube : 0) * cos(b);
        point[i] =
            (iso_vec3){0.1 + r * cos(a), 0.2 + r * sin(a), 0.3 + (tube > 0 ? tube : 0) * sin(b)};
    }
    iso_solid *solid;
    if (CHECK_OK(iso_solid_new(&solid, &mesh, 1))) {
        CHECK_OK(iso_solid_winding(winding, NULL, solid, point, COUNT, NULL));
        int wrong = 0;
        for (int i = 0; i < COUNT; i++)
            wrong += winding[i] != i % 2;
        CHECK_EQUAL(0, wrong);
        iso_solid_free(solid);
    }
    shape_mesh_free(&mesh);
    shape_free(&shape);
}

/* A nanometre counts in 200 mm, and 100 m away from zero too. */
static void test_fine(void) {
    for (int far = 0; far < 2; far++) {
        double at = far ? 100000.1 : 0.1;
        test_shape shape = {0};
        iso_mesh mesh[2];
        shape_box(&shape, (iso_vec3){at, at, at}, (iso_vec3){at + 200, at + 200, at + 200}, 1);
        shape_mesh(&mesh[0], &shape);
        mesh[1] = mesh[0];
        iso_vec3 point[5] = {{at + 1e-6, at + 1e-6, at + 1e-6},
                             {at - 1e-6, at + 1, at + 1},
                             {at + 200 - 1e-6, at + 70, at + 200 - 1e-6},
                             {at + 50, at + 100, at + 200 + 1e-6},
                             {NAN, INFINITY, at}};
        int32_t winding[5];
        iso_solid *solid;
        if (CHECK_OK(iso_solid_new(&solid, mesh, 2))) {
            CHECK_OK(iso_solid_winding(winding, NULL, solid, point, 5, NULL));
            for (int i = 0; i < 5; i++)
                CHECK_EQUAL(i == 0 || i == 2 ? 2 : 0, winding[i]);
            iso_solid_free(solid);
        }
        shape_mesh_free(&mesh[0]);
        shape_free(&shape);
    }
}

/* The tree's floats are 64 to 128 steps apart here: a border and a point next to it on its inner
 * side become the same number, and the box must be among those that the ray meets all the same. */
static void test_borders_rounded_to_floats(void) {
    enum { BOXES = 40, NEAR = 25 };
    static iso_vec3 point[6 * NEAR];
    static int32_t winding[6 * NEAR];
    const double step = 0x1p-23;
    for (int i = 0; i < BOXES; i++) {
        test_shape shape = {0};
        iso_mesh mesh;
        iso_solid *solid;
        double low = 4 * (i % 2 ? 1 : 46) + 37 * i * step, high = low + 8 - 53 * i * step;
        shape_box(&shape, (iso_vec3){0}, (iso_vec3){200, 200, 200}, 1);
        shape_box(&shape, (iso_vec3){low, low, low}, (iso_vec3){high, high, high}, 1);
        shape_mesh(&mesh, &shape);
        for (int k = 0; k < 6 * NEAR; k++) { /* at two borders within, the third one's middle */
            double off = (1 + k / 6 * (k / 6)) * step, away = off + (k % 4) * step;
            double a = k % 2 ? low + off : high - off, b = k % 4 < 2 ? low + away : high - away;
            double middle = (low + high) / 2 + k * step;
            point[k] = k % 3 == 0   ? (iso_vec3){middle, a, b}
                       : k % 3 == 1 ? (iso_vec3){b, middle, a}
                                    : (iso_vec3){a, b, middle};
        }
        iso_winding_options options = {.directions = 6};
        if (CHECK_OK(iso_solid_new(&solid, &mesh, 1)) &&
            CHECK_OK(iso_solid_winding(winding, NULL, solid, point, 6 * NEAR, &options))) {
            int wrong = 0;
            for (int k = 0; k < 6 * NEAR; k++)
                wrong += winding[k] != 2;
            CHECK_EQUAL(0, wrong);
        }
        iso_solid_free(solid);
        shape_mesh_free(&mesh);
        shape_free(&shape);
    }
}

static void test_nothing(void) {
    iso_mesh mesh = {0};
    iso_vec3 point = {0};
    int32_t winding = 5;
    uint8_t on = 5;
    iso_solid *solid;
    for (int32_t count = 0; count < 2; count++) {
        if (!CHECK_OK(iso_solid_new(&solid, &mesh, count)))
            continue;
        CHECK_OK(iso_solid_winding(&winding, &on, solid, &point, 1, NULL));
        CHECK_EQUAL(0, winding);
        CHECK_EQUAL(0, on);
        iso_winding_options options = {.directions = 7};
        CHECK_STATUS(ISO_USAGE, iso_solid_winding(&winding, &on, solid, &point, 1, &options));
        iso_solid_free(solid);
    }
}

/* An open box is seen to be one. */
static void test_open_box(void) {
    test_shape shape = {0};
    iso_mesh mesh;
    shape_box(&shape, (iso_vec3){0}, (iso_vec3){20, 20, 20}, 1);
    shape.count -= 2;
    shape_mesh(&mesh, &shape);
    iso_vec3 point = {10, 10, 10};
    int32_t winding;
    iso_solid *solid;
    if (CHECK_OK(iso_solid_new(&solid, &mesh, 1))) {
        iso_winding_options options = {.directions = 6};
        CHECK_STATUS(ISO_BUG, iso_solid_winding(&winding, NULL, solid, &point, 1, &options));
        iso_solid_free(solid);
    }
    shape_mesh_free(&mesh);
    shape_free(&shape);
}

/* 6000 boxes in a row: more on a ray than there is room for at first. */
static void test_long_row(void) {
    test_shape shape = {0};
    iso_mesh mesh;
    for (int i = 0; i < 6000; i++)
        shape_box(&shape, (iso_vec3){i * 0.01, 0, 0}, (iso_vec3){i * 0.01 + 0.005, 1, 1}, 1);
    shape_mesh(&mesh, &shape);
    iso_vec3 point[2] = {{0.001, 0.5, 0.5}, {30.0075, 0.5, 0.5}};
    int32_t winding[2];
    iso_solid *solid;
    if (CHECK_OK(iso_solid_new(&solid, &mesh, 1))) {
        iso_winding_options options = {.directions = 6};
        CHECK_OK(iso_solid_winding(winding, NULL, solid, point, 2, &options));
        CHECK_EQUAL(1, winding[0]);
        CHECK_EQUAL(0, winding[1]);
        for (int n = 0; n < 3; n++) {
            iso_fail_allocation_after(n);
            iso_status status = iso_solid_winding(winding, NULL, solid, point, 2, &options);
            iso_fail_allocation_after(-1);
            CHECK(status == ISO_OK || status == ISO_NO_MEMORY);
            CHECK(n > 0 || status == ISO_NO_MEMORY);
        }
        iso_solid_free(solid);
    }
    for (int n = 0; n < 3; n++) { /* solid, corners, boxes */
        iso_fail_allocation_after(n);
        CHECK_STATUS(ISO_NO_MEMORY, iso_solid_new(&solid, &mesh, 1));
        iso_fail_allocation_after(-1);
        CHECK(solid == NULL);
    }
    shape_mesh_free(&mesh);
    shape_free(&shape);
}

typedef struct thread_asker {
    const iso_solid *solid;
    const iso_vec3 *point;
    int32_t winding[2000];
    iso_status status;
} thread_asker;

static void *ask(void *payload) {
    thread_asker *a = payload;
    iso_winding_options options = {.directions = 3, .seed = 1};
    a->status = iso_solid_winding(a->winding, NULL, a->solid, a->point, 2000, &options);
    return NULL;
}

static void test_threads(void) {
    enum { THREADS = 4 };
    static iso_vec3 point[POINTS];
    static thread_asker asker[THREADS];
    test_shape shape = {0};
    iso_mesh mesh;
    shape_sphere(&shape, (iso_vec3){0}, 10, 20);
    shape_mesh(&mesh, &shape);
    make_points(point, &shape, &mesh);
    iso_solid *solid;
    if (CHECK_OK(iso_solid_new(&solid, &mesh, 1))) {
        pthread_t thread[THREADS];
        for (int i = 0; i < THREADS; i++) {
            asker[i].solid = solid;
            asker[i].point = point;
            CHECK_EQUAL(0, pthread_create(&thread[i], NULL, ask, &asker[i]));
        }
        for (int i = 0; i < THREADS; i++) {
            pthread_join(thread[i], NULL);
            CHECK_EQUAL(ISO_OK, asker[i].status);
            CHECK(memcmp(asker[0].winding, asker[i].winding, sizeof asker[i].winding) == 0);
        }
        iso_solid_free(solid);
    }
    shape_mesh_free(&mesh);
    shape_free(&shape);
}

static void check_file(const char *path) {
    iso_mesh mesh;
    test_shape shape = {0};
    if (!CHECK_OK(iso_mesh_read(&mesh, path)))
        return;
    printf("%s\n", path);
    for (int64_t i = 0; i < mesh.triangle_count; i++)
        shape_triangle(&shape, mesh.position[mesh.origin[3 * i]],
                       mesh.position[mesh.origin[3 * i + 1]],
                       mesh.position[mesh.origin[3 * i + 2]]);
    iso_mesh_free(&mesh);
    check_shape(&shape);
}

int main(int count, char **argument) {
    for (int i = 1; i < count; i++)
        check_file(argument[i]);
    if (count > 1)
        return check_verdict();
    RUN(test_cube);
    RUN(test_inverted_cube);
    RUN(test_sphere);
    RUN(test_torus);
    RUN(test_boxes);
    RUN(test_spindles);
    RUN(test_lattice_of_tetrahedra);
    RUN(test_sides_that_count);
    RUN(test_analytic);
    RUN(test_fine);
    RUN(test_borders_rounded_to_floats);
    RUN(test_nothing);
    RUN(test_open_box);
    RUN(test_long_row);
    RUN(test_threads);
    return check_verdict();
}

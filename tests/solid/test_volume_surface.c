/* Distances to triangles, and their sign. */
#include <stdlib.h>

#include "base/memory.h"
#include "check.h"
#include "solid/closest.h"
#include "solid/enclosed.h"
#include "solid/volume.h"

typedef struct soup {
    iso_vec3 *corner;
    int64_t count, capacity;
} soup;

static void add(soup *s, iso_vec3 a, iso_vec3 b, iso_vec3 c) {
    if (s->count == s->capacity) {
        s->capacity = s->capacity ? 2 * s->capacity : 64;
        s->corner = realloc(s->corner, (size_t)s->capacity * 3 * sizeof *s->corner);
    }
    iso_vec3 *t = s->corner + 3 * s->count++;
    t[0] = a;
    t[1] = b;
    t[2] = c;
}

/* sense -1: inside out */
static void add_box(soup *s, iso_vec3 low, iso_vec3 high, int sense) {
    iso_vec3 p[8];
    for (int i = 0; i < 8; i++)
        p[i] = (iso_vec3){i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z};
    static const int quad[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                   {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (int i = 0; i < 6; i++) {
        const int *q = quad[i];
        add(s, p[q[0]], p[q[sense > 0 ? 1 : 2]], p[q[sense > 0 ? 2 : 1]]);
        add(s, p[q[0]], p[q[sense > 0 ? 2 : 3]], p[q[sense > 0 ? 3 : 2]]);
    }
}

/* An octahedron, each face cut into four some times, all corners on the sphere. */
static iso_vec3 between(iso_vec3 a, iso_vec3 b) {
    iso_vec3 m = {a.x + b.x, a.y + b.y, a.z + b.z};
    double length = sqrt(m.x * m.x + m.y * m.y + m.z * m.z);
    return (iso_vec3){m.x / length, m.y / length, m.z / length};
}

static void add_face(soup *s, iso_vec3 a, iso_vec3 b, iso_vec3 c, double radius, int depth) {
    if (depth == 0) {
        add(s, (iso_vec3){radius * a.x, radius * a.y, radius * a.z},
            (iso_vec3){radius * b.x, radius * b.y, radius * b.z},
            (iso_vec3){radius * c.x, radius * c.y, radius * c.z});
        return;
    }
    iso_vec3 ab = between(a, b), bc = between(b, c), ca = between(c, a);
    add_face(s, a, ab, ca, radius, depth - 1);
    add_face(s, ab, b, bc, radius, depth - 1);
    add_face(s, ca, bc, c, radius, depth - 1);
    add_face(s, ab, bc, ca, radius, depth - 1);
}

static void add_sphere(soup *s, double radius, int depth) {
    for (int i = 0; i < 8; i++) {
        iso_vec3 x = {i & 1 ? -1 : 1, 0, 0}, y = {0, i & 2 ? -1 : 1, 0}, z = {0, 0, i & 4 ? -1 : 1};
        int odd = (i & 1) ^ (i >> 1 & 1) ^ (i >> 2);
        add_face(s, x, odd ? z : y, odd ? y : z, radius, depth);
    }
}

static uint64_t seed = 88172645463325252u;

static double next_random(void) {
    seed ^= seed << 13;
    seed ^= seed >> 7;
    seed ^= seed << 17;
    return (double)(seed >> 11) / 9007199254740992.0;
}

static iso_vec3 random_point(double reach) {
    double x = reach * (2 * next_random() - 1), y = reach * (2 * next_random() - 1);
    return (iso_vec3){x, y, reach * (2 * next_random() - 1)};
}

/* The distance as the plane and the sides give it, with no frame and no tree. */
static iso_vec3 minus(iso_vec3 a, iso_vec3 b) {
    return (iso_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static double dot(iso_vec3 a, iso_vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static iso_vec3 cross(iso_vec3 a, iso_vec3 b) {
    return (iso_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* From a point at p (seen from one end) to an edge. */
static double to_edge(iso_vec3 p, iso_vec3 edge) {
    double along = dot(p, edge), length = dot(edge, edge);
    if (along <= 0 || length <= 0)
        return dot(p, p);
    double part = along >= length ? 1 : along / length;
    iso_vec3 rest = {p.x - part * edge.x, p.y - part * edge.y, p.z - part * edge.z};
    return dot(rest, rest);
}

/* A triangle whose height is less than this share of its sides has no plane to speak of; its edges
 * are as near as it is, within that. */
#define THINNEST 1e-11

static double plain_square(iso_vec3 p, const iso_vec3 corner[3]) {
    iso_vec3 ab = minus(corner[1], corner[0]), bc = minus(corner[2], corner[1]);
    iso_vec3 ca = minus(corner[0], corner[2]);
    iso_vec3 pa = minus(p, corner[0]), pb = minus(p, corner[1]), pc = minus(p, corner[2]);
    iso_vec3 normal = cross(bc, ab);
    double square = dot(normal, normal);
    double sides = dot(ab, ab) + dot(bc, bc) + dot(ca, ca);
    if (square > THINNEST * THINNEST * sides * sides && dot(cross(ab, normal), pa) >= 0 &&
        dot(cross(bc, normal), pb) >= 0 && dot(cross(ca, normal), pc) >= 0) {
        double height = dot(normal, pa);
        return height * height / square;
    }
    double least = to_edge(pa, ab), other = to_edge(pb, bc);
    least = other < least ? other : least;
    other = to_edge(pc, ca);
    return other < least ? other : least;
}

static double brute_distance(const soup *s, iso_vec3 p) {
    double least = INFINITY;
    for (int64_t i = 0; i < s->count; i++) {
        double square = plain_square(p, s->corner + 3 * i);
        least = square < least ? square : least;
    }
    return sqrt(least);
}

static double closest_of_one(const iso_vec3 *t, iso_vec3 p) {
    iso_closest *tree;
    int32_t guess = 0;
    if (!CHECK_OK(closest_new(&tree, t, 1)))
        return -1;
    double square = closest_square(tree, p, INFINITY, &guess);
    closest_free(tree);
    return square;
}

/* A triangle as a fine cloud of points: an upper bound that comes close. */
static void test_one_triangle(void) {
    for (int n = 0; n < 300; n++) {
        iso_vec3 t[3] = {random_point(2), random_point(2), random_point(2)};
        if (n % 5 == 0)
            t[2] = t[1];
        if (n % 7 == 0)
            t[1] = (iso_vec3){(t[0].x + t[2].x) / 2, (t[0].y + t[2].y) / 2, (t[0].z + t[2].z) / 2};
        iso_vec3 p = random_point(4);
        double least = INFINITY;
        for (int i = 0; i <= 100; i++)
            for (int j = 0; i + j <= 100; j++) {
                double a = i / 100.0, b = j / 100.0, c = 1 - a - b;
                double x = a * t[0].x + b * t[1].x + c * t[2].x - p.x;
                double y = a * t[0].y + b * t[1].y + c * t[2].y - p.y;
                double z = a * t[0].z + b * t[1].z + c * t[2].z - p.z;
                double square = x * x + y * y + z * z;
                least = square < least ? square : least;
            }
        double found = sqrt(closest_of_one(t, p)), plain = sqrt(plain_square(p, t));
        CHECK_NEAR(plain, found, 1e-7);
        CHECK(found <= sqrt(least) + 1e-9);
        CHECK(found >= sqrt(least) - 0.05);
    }
}

typedef struct counted {
    volume_inside *inside;
    void *payload;
    int64_t calls, points;
} counted;

static iso_status count_inside(void *payload, uint8_t *inside, const iso_vec3 *point,
                               int64_t count) {
    counted *c = payload;
    c->calls++;
    c->points += count;
    return c->inside(c->payload, inside, point, count);
}

static iso_status inside_sphere(void *payload, uint8_t *inside, const iso_vec3 *p, int64_t count) {
    double r = *(double *)payload;
    for (int64_t i = 0; i < count; i++)
        inside[i] = p[i].x * p[i].x + p[i].y * p[i].y + p[i].z * p[i].z < r * r;
    return ISO_OK;
}

static void test_sphere(void) {
    soup s = {0};
    add_sphere(&s, 10, 5);
    double radius = 10;
    for (int way = 0; way < 2; way++) {
        counted c = {inside_sphere, &radius, 0, 0};
        iso_volume_surface surface = {.corner = s.corner,
                                      .count = s.count,
                                      .voxel = 0.5,
                                      .outer = 1.5,
                                      .inner = 4,
                                      .inside = way == 0 ? count_inside : NULL,
                                      .payload = &c};
        iso_volume *volume;
        if (!CHECK_OK(volume_from_surface(&volume, &surface)))
            return;
        iso_volume_info info;
        volume_info(&info, volume);
        CHECK_EQUAL(1, info.is_distance);
        CHECK_NEAR(1.5, info.background, 1e-6);
        /* asked about far fewer voxels than have a value */
        if (way == 0)
            CHECK(c.points < info.active / 10);
        for (int i = 0; i < 5000; i++) {
            /* on a voxel: nothing is interpolated */
            iso_vec3 p = random_point(13);
            p = (iso_vec3){0.5 * floor(2 * p.x), 0.5 * floor(2 * p.y), 0.5 * floor(2 * p.z)};
            double truth = sqrt(p.x * p.x + p.y * p.y + p.z * p.z) - 10, value;
            CHECK_OK(volume_sample(&value, volume, &p, 1));
            /* the mesh lies within 10 (1 - cos(half an edge)) of the sphere, some 0.01 mm */
            if (truth > -4 && truth < 1.5)
                CHECK_NEAR(truth, value, 0.012);
            else
                CHECK_NEAR(truth < 0 ? -4 : 1.5, value, 0.012);
            if (truth > -4 && truth < 1.5 && i % 10 == 0)
                CHECK_NEAR(brute_distance(&s, p), fabs(value), 1e-6);
        }
        volume_free(volume);
    }
    free(s.corner);
}

/* Distance to a box, negative inside. */
static double box_distance(iso_vec3 low, iso_vec3 high, iso_vec3 p) {
    double x = fmax(low.x - p.x, p.x - high.x), y = fmax(low.y - p.y, p.y - high.y);
    double z = fmax(low.z - p.z, p.z - high.z), most = fmax(x, fmax(y, z));
    if (most < 0)
        return most;
    x = fmax(x, 0), y = fmax(y, 0), z = fmax(z, 0);
    return sqrt(x * x + y * y + z * z);
}

/* Check voxel after voxel: |value| is the distance to the nearest triangle, and its sign that of
 * `truth`. */
static void check_everywhere(const soup *s, volume_inside *inside, double (*truth)(iso_vec3 p),
                             double voxel) {
    iso_volume_surface surface = {.corner = s->corner,
                                  .count = s->count,
                                  .voxel = voxel,
                                  .outer = 1.2,
                                  .inner = 2.5,
                                  .inside = inside};
    iso_volume *volume;
    if (!CHECK_OK(volume_from_surface(&volume, &surface)))
        return;
    for (int i = 0; i < 40 * 40 * 40; i++) {
        iso_vec3 p = {voxel * (i % 40 - 20), voxel * (i / 40 % 40 - 20), voxel * (i / 1600 - 20)};
        double value, distance = truth(p), least = brute_distance(s, p);
        CHECK_OK(volume_sample(&value, volume, &p, 1));
        if (least < 1e-9)
            CHECK_NEAR(0, value, 1e-9);
        else
            CHECK_NEAR(distance < 0 ? -fmin(least, 2.5) : fmin(least, 1.2), value, 1e-6);
    }
    volume_free(volume);
}

static const iso_vec3 cube_low = {-5.1, -4.3, -5.7}, cube_high = {4.9, 5.4, 4.6};
static const iso_vec3 core_low = {-2.2, -2, -3.1}, core_high = {1.9, 2.2, 2.3};

static double in_cube(iso_vec3 p) {
    return box_distance(cube_low, cube_high, p);
}

static double in_shell(iso_vec3 p) {
    return fmax(box_distance(cube_low, cube_high, p), -box_distance(core_low, core_high, p));
}

static void test_cube(void) {
    soup s = {0};
    add_box(&s, cube_low, cube_high, 1);
    check_everywhere(&s, NULL, in_cube, 0.41);
    s.count = 0;
    add_box(&s, cube_low, cube_high, -1); /* inside out: as full */
    check_everywhere(&s, NULL, in_cube, 0.41);
    free(s.corner);
}

/* On voxels' middles exactly: faces, edges and corners all meet rays. */
static double in_even_cube(iso_vec3 p) {
    return box_distance((iso_vec3){-4, -4, -4}, (iso_vec3){4, 4, 4}, p);
}

static void test_cube_on_voxels(void) {
    soup s = {0};
    add_box(&s, (iso_vec3){-4, -4, -4}, (iso_vec3){4, 4, 4}, 1);
    check_everywhere(&s, NULL, in_even_cube, 0.5);
    free(s.corner);
}

/* OpenVDB itself takes a cavity for full. */
static void test_nested_shells(void) {
    soup s = {0};
    add_box(&s, cube_low, cube_high, 1);
    add_box(&s, core_low, core_high, -1);
    check_everywhere(&s, NULL, in_shell, 0.41);
    s.count = 0;
    add_box(&s, cube_low, cube_high, 1);
    add_box(&s, core_low, core_high, 1); /* the same sense: full */
    check_everywhere(&s, NULL, in_cube, 0.41);
    free(s.corner);
}

static double in_either(iso_vec3 p) {
    return fmin(box_distance(cube_low, cube_high, p),
                box_distance((iso_vec3){0, 0, 0}, (iso_vec3){7, 7, 7}, p));
}

static iso_status ask_either(void *payload, uint8_t *inside, const iso_vec3 *p, int64_t count) {
    for (int64_t i = 0; i < count; i++)
        inside[i] = in_either(p[i]) < 0;
    return ISO_OK;
}

/* Overlapping, one of them inside out, faces turned or there twice: only the callback knows. */
static void test_sign_from_callback(void) {
    soup s = {0};
    add_box(&s, cube_low, cube_high, 1);
    add_box(&s, (iso_vec3){0, 0, 0}, (iso_vec3){7, 7, 7}, -1);
    for (int64_t i = 0; i < s.count; i += 3) {
        iso_vec3 *t = s.corner + 3 * i, swapped = t[0];
        t[0] = t[1];
        t[1] = swapped;
    }
    add(&s, s.corner[0], s.corner[1], s.corner[2]);
    check_everywhere(&s, ask_either, in_either, 0.41);
    free(s.corner);
}

static double nowhere(iso_vec3 p) {
    return 1;
}

static iso_status ask_nowhere(void *payload, uint8_t *inside, const iso_vec3 *p, int64_t count) {
    memset(inside, 0, (size_t)count);
    return ISO_OK;
}

/* Random triangles that enclose nothing: distances alone. */
static void test_soup(void) {
    soup s = {0};
    for (int i = 0; i < 60; i++) {
        iso_vec3 a = random_point(5), b = random_point(5), c = random_point(5);
        add(&s, a, b, c);
    }
    check_everywhere(&s, ask_nowhere, nowhere, 0.41);
    free(s.corner);
}

static void test_bad_surfaces(void) {
    soup s = {0};
    add_box(&s, cube_low, cube_high, 1);
    iso_volume *volume;
    iso_volume_surface surface = {
        .corner = s.corner, .count = s.count, .voxel = 0, .outer = 1, .inner = 1};
    CHECK_STATUS(ISO_BAD_CONFIG, volume_from_surface(&volume, &surface));
    surface.voxel = 1e-6;
    CHECK_STATUS(ISO_BAD_CONFIG, volume_from_surface(&volume, &surface));
    surface.voxel = 1;
    surface.inner = 0;
    CHECK_STATUS(ISO_BAD_CONFIG, volume_from_surface(&volume, &surface));
    surface.inner = 1;
    surface.count = 0;
    if (CHECK_OK(volume_from_surface(&volume, &surface))) {
        iso_volume_info info;
        volume_info(&info, volume);
        CHECK_EQUAL(0, info.active);
        volume_free(volume);
    }
    s.corner[5].y = NAN;
    surface.count = s.count;
    CHECK_STATUS(ISO_BAD_CONFIG, volume_from_surface(&volume, &surface));
    free(s.corner);
}

static void test_out_of_memory(void) {
    soup s = {0};
    add_box(&s, cube_low, cube_high, 1);
    iso_volume_surface surface = {
        .corner = s.corner, .count = s.count, .voxel = 1, .outer = 2, .inner = 2};
    int64_t n = 0;
    for (; n < 200; n++) {
        iso_volume *volume;
        iso_fail_allocation_after(n);
        iso_status status = volume_from_surface(&volume, &surface);
        iso_fail_allocation_after(-1);
        if (status == ISO_OK) {
            volume_free(volume);
            break;
        }
        CHECK_EQUAL(ISO_NO_MEMORY, status);
        CHECK(volume == NULL);
    }
    CHECK(n > 3 && n < 200);
    free(s.corner);
}

/* How long, and how many questions, on a fine mesh: printed, not judged. */
static void test_questions_are_few(void) {
    soup s = {0};
    add_sphere(&s, 20, 6);
    double radius = 20;
    counted c = {inside_sphere, &radius, 0, 0};
    iso_volume_surface surface = {.corner = s.corner,
                                  .count = s.count,
                                  .voxel = 0.5,
                                  .outer = 1.5,
                                  .inner = 1.5,
                                  .inside = count_inside,
                                  .payload = &c};
    iso_volume *volume;
    if (CHECK_OK(volume_from_surface(&volume, &surface))) {
        iso_volume_info info;
        volume_info(&info, volume);
        printf("     %lld triangles, %lld voxels, %lld questions in %lld calls\n",
               (long long)s.count, (long long)info.active, (long long)c.points, (long long)c.calls);
        CHECK(c.points < info.active / 5);
        volume_free(volume);
    }
    free(s.corner);
}

int main(void) {
    RUN(test_one_triangle);
    RUN(test_sphere);
    RUN(test_cube);
    RUN(test_cube_on_voxels);
    RUN(test_nested_shells);
    RUN(test_sign_from_callback);
    RUN(test_soup);
    RUN(test_bad_surfaces);
    RUN(test_out_of_memory);
    RUN(test_questions_are_few);
    return check_verdict();
}

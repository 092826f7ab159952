/* Distances along surfaces against those that unrolling, great circles and hundreds of random
 * straight walks give. */
#include "height/height.h"

#include <stdlib.h>
#include <time.h>

#include "base/memory.h"
#include "base/vector.h"
#include "check.h"
#include "models/shapes.h"

#define PI SHAPE_PI

typedef struct model {
    iso_mesh mesh;
    double *distance;
} model;

static int model_new(model *m, shape *s) {
    *m = (model){0};
    int made = CHECK_OK(iso_mesh_from_triangles(&m->mesh, s->triangle, s->count));
    shape_free(s);
    m->distance = malloc(sizeof(double) * (size_t)(made ? m->mesh.vertex_count + 1 : 1));
    return made;
}

static void model_free(model *m) {
    iso_mesh_free(&m->mesh);
    free(m->distance);
}

static int32_t vertex_at(const iso_mesh *mesh, iso_vec3 p) {
    int32_t best = 0;
    for (int32_t v = 1; v < mesh->vertex_count; v++)
        if (vec3_distance(p, mesh->position[v]) < vec3_distance(p, mesh->position[best]))
            best = v;
    return best;
}

/* Of a surface around z, rings from z0 to z1 with radius r and middle x0 + lean z, ends closed by
 * fans. */
typedef struct profile {
    double z0, z1, r0, r1, lean;
    double sphere; /* radius; 0: straight from r0 to r1 */
    double flat;   /* y is so many times as wide */
    int rings, sectors;
} profile;

static double radius_at(const profile *p, double z) {
    if (p->sphere > 0)
        return sqrt(fmax(0, p->sphere * p->sphere - z * z));
    return p->r0 + (p->r1 - p->r0) * (z - p->z0) / (p->z1 - p->z0);
}

static shape_point point_of(const profile *p, int ring, int sector) {
    double z = p->z0 + (p->z1 - p->z0) * ring / p->rings, r = radius_at(p, z);
    double u = 2 * PI * (sector % p->sectors) / p->sectors;
    return (shape_point){p->lean * z + r * cos(u), p->flat * r * sin(u), z};
}

static void shape_profile(shape *s, const profile *p) {
    shape_point low = {p->lean * p->z0, 0, p->z0}, high = {p->lean * p->z1, 0, p->z1};
    for (int j = 0; j < p->sectors; j++) {
        shape_add(s, low, point_of(p, 0, j + 1), point_of(p, 0, j));
        shape_add(s, high, point_of(p, p->rings, j), point_of(p, p->rings, j + 1));
        for (int i = 0; i < p->rings; i++)
            shape_quad(s, point_of(p, i, j), point_of(p, i, j + 1), point_of(p, i + 1, j + 1),
                       point_of(p, i + 1, j));
    }
}

static int32_t base_ring(int32_t *source, const iso_mesh *mesh, const profile *p) {
    for (int j = 0; j < p->sectors; j++) {
        shape_point at = point_of(p, 0, j);
        source[j] = vertex_at(mesh, (iso_vec3){at.x, at.y, at.z});
    }
    return p->sectors;
}

/* A flat plate of squares, whose edges and corners light slips by. */
static void test_plate(void) {
    shape s = {0};
    enum { N = 20 };
    for (int side = 0; side < 2; side++)
        for (int i = 0; i < N; i++)
            for (int j = 0; j < N; j++) {
                shape_point p[4] = {
                    {i, j, side}, {i + 1, j, side}, {i + 1, j + 1, side}, {i, j + 1, side}};
                if (side)
                    shape_quad(&s, p[0], p[1], p[2], p[3]);
                else
                    shape_quad(&s, p[0], p[3], p[2], p[1]);
            }
    for (int i = 0; i < N; i++) {
        shape_quad(&s, (shape_point){i, 0, 0}, (shape_point){i + 1, 0, 0},
                   (shape_point){i + 1, 0, 1}, (shape_point){i, 0, 1});
        shape_quad(&s, (shape_point){i + 1, N, 0}, (shape_point){i, N, 0}, (shape_point){i, N, 1},
                   (shape_point){i + 1, N, 1});
        shape_quad(&s, (shape_point){0, i + 1, 0}, (shape_point){0, i, 0}, (shape_point){0, i, 1},
                   (shape_point){0, i + 1, 1});
        shape_quad(&s, (shape_point){N, i, 0}, (shape_point){N, i + 1, 0},
                   (shape_point){N, i + 1, 1}, (shape_point){N, i, 1});
    }
    model m;
    if (!model_new(&m, &s))
        return;
    int32_t source = vertex_at(&m.mesh, (iso_vec3){3, 5, 1});
    CHECK_OK(height_geodesic(m.distance, &m.mesh, &source, 1));
    double worst = 0;
    for (int32_t v = 0; v < m.mesh.vertex_count; v++)
        if (m.mesh.position[v].z > 0.5)
            worst = fmax(worst, fabs(m.distance[v] -
                                     vec3_distance(m.mesh.position[v], (iso_vec3){3, 5, 1})));
    CHECK_NEAR(0, worst, 1e-9);
    /* around the edge x = 0: 3 + 1 + 2 and 7 aside */
    CHECK_NEAR(sqrt(6 * 6 + 7 * 7), m.distance[vertex_at(&m.mesh, (iso_vec3){2, 12, 0})], 1e-9);
    model_free(&m);
}

/* The cube's opposite corner: sqrt(5) edges, over any two of its faces. */
static void test_cube(void) {
    shape s = {0};
    shape_box(&s, 0, 0, 0, 10, 10, 10);
    model m;
    if (!model_new(&m, &s))
        return;
    int32_t source = vertex_at(&m.mesh, (iso_vec3){0, 0, 0});
    CHECK_OK(height_geodesic(m.distance, &m.mesh, &source, 1));
    CHECK_NEAR(10 * sqrt(5), m.distance[vertex_at(&m.mesh, (iso_vec3){10, 10, 10})], 1e-12);
    CHECK_NEAR(10 * sqrt(2), m.distance[vertex_at(&m.mesh, (iso_vec3){10, 10, 0})], 1e-12);
    CHECK_NEAR(10, m.distance[vertex_at(&m.mesh, (iso_vec3){10, 0, 0})], 1e-12);
    CHECK_OK(height_geodesic_rise(m.distance, &m.mesh, -2));
    for (int32_t v = 0; v < m.mesh.vertex_count; v++)
        CHECK_NEAR(m.mesh.position[v].z + 2, m.distance[v], 1e-12);
    source = m.mesh.vertex_count;
    CHECK_STATUS(ISO_USAGE, height_geodesic(m.distance, &m.mesh, &source, 1));
    model_free(&m);
}

/* From a point of the wall of a prism of many sides: unrolled exactly, the prism's own sides. */
static void test_unrolled_prism(void) {
    const profile p = {0, 40, 10, 10, 0, 0, 1, 30, 48};
    shape s = {0};
    shape_profile(&s, &p);
    model m;
    if (!model_new(&m, &s))
        return;
    shape_point from = point_of(&p, 15, 0);
    int32_t source = vertex_at(&m.mesh, (iso_vec3){from.x, from.y, from.z});
    CHECK_OK(height_geodesic(m.distance, &m.mesh, &source, 1));
    double side = 2 * 10 * sin(PI / p.sectors), worst = 0;
    for (int i = 10; i <= 20; i++) /* the ends are no short cut there */
        for (int j = 0; j <= p.sectors; j++) {
            shape_point at = point_of(&p, i, j);
            int steps = j < p.sectors - j ? j : p.sectors - j;
            double exact = sqrt(steps * side * steps * side + (at.z - from.z) * (at.z - from.z));
            double found = m.distance[vertex_at(&m.mesh, (iso_vec3){at.x, at.y, at.z})];
            worst = fmax(worst, fabs(found - exact));
        }
    CHECK_NEAR(0, worst, 2e-5); /* STL's floats */
    model_free(&m);
}

/* A cone from its base ring: its slant, in parallel light; from its tip: the same backwards. */
static void test_cone(void) {
    const profile p = {0, 40, 30, 10, 0, 0, 1, 40, 120};
    shape s = {0};
    shape_profile(&s, &p);
    model m;
    if (!model_new(&m, &s))
        return;
    int32_t source[120];
    CHECK_OK(height_geodesic(m.distance, &m.mesh, source, base_ring(source, &m.mesh, &p)));
    /* of the polygonal cone's sides: flat trapezoids, from edge to edge */
    double inner = cos(PI / p.sectors), rise = sqrt(40 * 40 + 20 * 20 * inner * inner) / 40;
    double worst = 0;
    for (int32_t v = 0; v < m.mesh.vertex_count; v++) {
        iso_vec3 at = m.mesh.position[v];
        if (at.x * at.x + at.y * at.y > 1)
            worst = fmax(worst, fabs(m.distance[v] - at.z * rise));
    }
    CHECK(worst < 0.02); /* corners lie a little farther from the edges than middles do */
    printf("     cone: worst %.5f mm of %.1f\n", worst, 40 * rise);
    model_free(&m);
}

static void great_circles(double *rms, double *worst, int rings) {
    shape s = {0};
    shape_sphere(&s, (shape_point){0, 0, 30}, 30, rings, 2 * rings);
    model m;
    *rms = *worst = 0;
    if (!model_new(&m, &s))
        return;
    int32_t source = vertex_at(&m.mesh, (iso_vec3){30, 0, 30});
    CHECK_OK(height_geodesic(m.distance, &m.mesh, &source, 1));
    iso_vec3 from = vec3_minus(m.mesh.position[source], (iso_vec3){0, 0, 30});
    for (int32_t v = 0; v < m.mesh.vertex_count; v++) {
        iso_vec3 at = vec3_minus(m.mesh.position[v], (iso_vec3){0, 0, 30});
        double exact = 30 * acos(fmax(-1, fmin(1, vec3_dot(at, from) / 900)));
        if (v == source)
            continue;
        double error = fabs(m.distance[v] / exact - 1);
        *rms += error * error / m.mesh.vertex_count;
        *worst = fmax(*worst, error);
    }
    *rms = sqrt(*rms);
    model_free(&m);
}

/* With the square of the edges' length. */
static void test_sphere(void) {
    double rms[2], worst[2];
    great_circles(&rms[0], &worst[0], 24);
    great_circles(&rms[1], &worst[1], 48);
    printf("     sphere: rms %.5f %% worst %.5f %%; %.5f %% and %.5f %% with half the edges\n",
           100 * rms[0], 100 * worst[0], 100 * rms[1], 100 * worst[1]);
    CHECK(rms[0] < 0.004 && worst[0] < 0.01);
    CHECK(rms[1] < 0.3 * rms[0] && worst[1] < 0.3 * worst[0]);
}

/* Distance from the base on a finer surface stands for the truth. */
static void compare_with_finer(const char *name, profile p) {
    shape s = {0};
    model coarse, fine;
    static int32_t source[2000];
    shape_profile(&s, &p);
    if (!model_new(&coarse, &s))
        return;
    CHECK_OK(height_geodesic(coarse.distance, &coarse.mesh, source,
                             base_ring(source, &coarse.mesh, &p)));
    profile finer = p;
    finer.rings *= 3, finer.sectors *= 3;
    shape_profile(&s, &finer);
    if (!model_new(&fine, &s)) {
        model_free(&coarse);
        return;
    }
    CHECK_OK(
        height_geodesic(fine.distance, &fine.mesh, source, base_ring(source, &fine.mesh, &finer)));
    double rms = 0, worst = 0;
    int count = 0;
    for (int i = 1; i <= p.rings; i++)
        for (int j = 0; j < p.sectors; j++, count++) {
            shape_point at = point_of(&p, i, j);
            iso_vec3 q = {at.x, at.y, at.z};
            double found = coarse.distance[vertex_at(&coarse.mesh, q)];
            double error = fabs(found / fine.distance[vertex_at(&fine.mesh, q)] - 1);
            rms += error * error;
            worst = fmax(worst, error);
        }
    rms = sqrt(rms / count);
    printf("     %s: rms %.4f %%, worst %.4f %%\n", name, 100 * rms, 100 * worst);
    CHECK(rms < 0.002);
    model_free(&coarse);
    model_free(&fine);
}

/* An oblique cone unrolls around its tip: the distance from the base is that in the plane. */
static double unrolled_cone(const profile *p, int sector, double z) {
    enum { RAYS = 3600 };
    static double angle[RAYS + 1], reach[RAYS + 1];
    double top = p->z1 + (p->z1 - p->z0) * p->r1 / (p->r0 - p->r1);
    const iso_vec3 tip = {p->lean * top, 0, top};
    iso_vec3 last = {0, 0, 0};
    for (int k = 0; k <= RAYS; k++) {
        double u = 2 * PI * k / RAYS;
        iso_vec3 ray = vec3_minus((iso_vec3){p->r0 * cos(u), p->r0 * sin(u), 0}, tip);
        reach[k] = vec3_length(ray);
        double turn = atan2(vec3_length(vec3_cross(last, ray)), vec3_dot(last, ray));
        angle[k] = k ? angle[k - 1] + turn : 0;
        last = ray;
    }
    int at = sector * RAYS / p->sectors;
    double far = reach[at] * (top - z) / top, best = INFINITY;
    for (int k = 0; k < RAYS; k++) {
        double turn = fabs(angle[k] - angle[at]);
        turn = fmin(turn, angle[RAYS] - turn);
        best = fmin(best, far * far + reach[k] * reach[k] - 2 * far * reach[k] * cos(turn));
    }
    return sqrt(best);
}

static double oblique_cone(int rings, int sectors) {
    const profile p = {0, 40, 30, 10, 0.45, 0, 1, rings, sectors};
    static int32_t source[200];
    shape s = {0};
    model m;
    shape_profile(&s, &p);
    if (!model_new(&m, &s))
        return 1;
    CHECK_OK(height_geodesic(m.distance, &m.mesh, source, base_ring(source, &m.mesh, &p)));
    double rms = 0, worst = 0;
    for (int i = 1; i <= rings; i++)
        for (int j = 0; j < sectors; j += 4) {
            shape_point at = point_of(&p, i, j);
            double found = m.distance[vertex_at(&m.mesh, (iso_vec3){at.x, at.y, at.z})];
            double error = fabs(found / unrolled_cone(&p, j, at.z) - 1);
            rms += error * error * 4 / (rings * sectors);
            worst = fmax(worst, error);
        }
    printf("     oblique cone of %d x %d: rms %.4f %%, worst %.4f %%\n", rings, sectors,
           100 * sqrt(rms), 100 * worst);
    model_free(&m);
    return sqrt(rms);
}

static void test_oblique_cone(void) {
    double coarse = oblique_cone(20, 36), fine = oblique_cone(40, 72);
    CHECK(coarse < 0.005);
    CHECK(fine < 0.4 * coarse);
}

static void test_ellipsoid_zone(void) {
    compare_with_finer("ellipsoid zone", (profile){-25, 25, 0, 0, 0, 30, 0.4, 24, 36});
}

/* Light bends around corners: an L's inner edge, around which a string is drawn tight. */
static void test_saddle(void) {
    shape s = {0};
    uint8_t filled[5 * 5 * 3];
    for (int i = 0; i < 75; i++)
        filled[i] = (i % 5 < 2 || i / 5 % 5 < 2);
    shape_cells(&s, filled, 5, 5, 3);
    model m;
    if (!model_new(&m, &s))
        return;
    int32_t source = vertex_at(&m.mesh, (iso_vec3){1, 5, 3});
    CHECK_OK(height_geodesic(m.distance, &m.mesh, &source, 1));
    CHECK_NEAR(sqrt(1 + 9) + sqrt(9 + 1), m.distance[vertex_at(&m.mesh, (iso_vec3){5, 1, 3})],
               1e-12);
    CHECK_NEAR(sqrt(1 + 9) + 3, m.distance[vertex_at(&m.mesh, (iso_vec3){5, 2, 3})], 1e-12);
    model_free(&m);
}

/* Never longer than along edges; the triangle inequality; never shorter than straight. */
static void test_bumpy(void) {
    shape s = {0};
    shape_sphere(&s, (shape_point){0, 0, 0}, 20, 20, 40);
    for (int64_t i = 0; i < 3 * s.count; i++) {
        float *p = s.triangle + 3 * i;
        float r = 1 + 0.15f * sinf(0.9f * p[0]) * sinf(0.7f * p[1] + 1) * cosf(0.8f * p[2]);
        p[0] *= r, p[1] *= r, p[2] *= r;
    }
    model m;
    if (!model_new(&m, &s))
        return;
    double *other = malloc(sizeof(double) * (size_t)m.mesh.vertex_count);
    int32_t a = 17, b = m.mesh.vertex_count - 100;
    CHECK_OK(height_geodesic(m.distance, &m.mesh, &a, 1));
    CHECK_OK(height_geodesic(other, &m.mesh, &b, 1));
    CHECK_NEAR(m.distance[b], other[a], 1e-9 * other[a]); /* there and back */
    for (int32_t v = 0; v < m.mesh.vertex_count; v++) {
        CHECK(m.distance[v] + other[v] >= other[a] * (1 - 1e-9));
        CHECK(m.distance[v] >= vec3_distance(m.mesh.position[v], m.mesh.position[a]) * (1 - 1e-9));
    }
    int long_way = 0;
    for (int32_t d = 0; d < 3 * m.mesh.triangle_count; d++) {
        int32_t p = m.mesh.origin[d], q = m.mesh.origin[iso_mesh_alpha(d)];
        long_way += m.distance[q] > m.distance[p] * (1 + 1e-12) +
                                        vec3_distance(m.mesh.position[p], m.mesh.position[q]);
    }
    CHECK_EQUAL(0, long_way);
    free(other);
    model_free(&m);
}

/* Shells start each at its own foot; what no source reaches is infinitely far. */
static void test_shells(void) {
    shape s = {0};
    shape_box(&s, 0, 0, 0, 10, 10, 10);
    shape_box(&s, 20, 0, 7, 30, 10, 12);
    model m;
    if (!model_new(&m, &s))
        return;
    CHECK_OK(height_geodesic_rise(m.distance, &m.mesh, 0));
    for (int32_t v = 0; v < m.mesh.vertex_count; v++)
        CHECK_NEAR(m.mesh.position[v].z, m.distance[v], 1e-12);
    int32_t source = vertex_at(&m.mesh, (iso_vec3){0, 0, 0});
    CHECK_OK(height_geodesic(m.distance, &m.mesh, &source, 1));
    CHECK(isinf(m.distance[vertex_at(&m.mesh, (iso_vec3){30, 10, 12})]));
    model_free(&m);
}

static void test_memory(void) {
    shape s = {0};
    shape_sphere(&s, (shape_point){0, 0, 0}, 20, 8, 16);
    model m;
    if (!model_new(&m, &s))
        return;
    iso_status status = ISO_NO_MEMORY;
    int64_t n = 0;
    for (; n < 200 && status != ISO_OK; n++) {
        iso_fail_allocation_after(n);
        status = height_geodesic_rise(m.distance, &m.mesh, 0);
        iso_fail_allocation_after(-1);
        if (status != ISO_OK)
            CHECK_EQUAL(ISO_NO_MEMORY, status);
    }
    CHECK(n > 8 && status == ISO_OK);
    model_free(&m);
}

int main(int count, char **argument) {
    if (count > 1) { /* how long a model takes */
        iso_mesh mesh;
        if (!CHECK_OK(iso_mesh_read(&mesh, argument[1])))
            return 1;
        double *distance = malloc(sizeof(double) * (size_t)mesh.vertex_count);
        clock_t begin = clock();
        CHECK_OK(height_geodesic_rise(distance, &mesh, mesh.min.z));
        double most = 0;
        for (int32_t v = 0; v < mesh.vertex_count; v++)
            most = fmax(most, distance[v]);
        printf("%d triangles, up to %.2f mm, %.2f s\n", mesh.triangle_count, most,
               (double)(clock() - begin) / CLOCKS_PER_SEC);
        free(distance);
        iso_mesh_free(&mesh);
        return check_verdict();
    }
    RUN(test_plate);
    RUN(test_cube);
    RUN(test_unrolled_prism);
    RUN(test_cone);
    RUN(test_sphere);
    RUN(test_oblique_cone);
    RUN(test_ellipsoid_zone);
    RUN(test_saddle);
    RUN(test_bumpy);
    RUN(test_shells);
    RUN(test_memory);
    return check_verdict();
}

/* Surfaces that stay open get a thickness, as docs/models.md says. */
#include "check.h"

#include "base/memory.h"
#include "models/shapes.h"

#include <isoslice/mesh.h>

/* Read with a thickness, check the double-link and its volume; 1 if there is a mesh. */
static int thicken(iso_mesh *mesh, const shape *s, double thickness, double volume,
                   double tolerance) {
    iso_mesh_options options = {.sheet_thickness = thickness};
    if (!CHECK_OK(iso_mesh_from_triangles_with(mesh, s->triangle, s->count, &options)))
        return 0;
    CHECK_OK(iso_mesh_validate(mesh));
    CHECK_NEAR(volume, iso_mesh_volume(mesh), tolerance);
    CHECK_NEAR(thickness, mesh->defects.sheet_thickness, 0);
    return 1;
}

/* A grid of quads on a function's graph. */
static void add_graph(shape *s, int n, double size, double (*height)(double x, double y)) {
    for (int i = 0; i < n; i++)
        for (int k = 0; k < n; k++) {
            shape_point p[4];
            for (int c = 0; c < 4; c++) {
                double x = size * (i + (c == 1 || c == 2)) / n, y = size * (k + c / 2) / n;
                p[c] = (shape_point){x, y, height(x, y)};
            }
            shape_quad(s, p[0], p[1], p[2], p[3]);
        }
}

static double tilted(double x, double y) {
    return 0.5 * x + 0.25 * y;
}

static void test_one_triangle_is_a_prism(void) {
    shape s = {0};
    shape_add(&s, (shape_point){0, 0, 5}, (shape_point){6, 0, 5}, (shape_point){0, 4, 5});
    iso_mesh mesh;
    if (thicken(&mesh, &s, 0.8, 12 * 0.8, 1e-9)) {
        CHECK_EQUAL(8, mesh.triangle_count);
        CHECK_EQUAL(6, mesh.vertex_count);
        CHECK_EQUAL(1, mesh.defects.sheets);
        CHECK_EQUAL(1, mesh.defects.shells);
        CHECK_NEAR(4.6, mesh.min.z, 1e-9);
        CHECK_NEAR(5.4, mesh.max.z, 1e-9);
        CHECK_NEAR(6, mesh.max.x, 1e-9);
        iso_mesh_free(&mesh);
    }
    shape_free(&s);
}

/* Whatever its triangles, a plane sheet is as thick as asked for everywhere. */
static void test_plane_sheet_is_exact(void) {
    shape s = {0};
    add_graph(&s, 9, 18, tilted);
    const double slope = sqrt(1 + 0.5 * 0.5 + 0.25 * 0.25);
    iso_mesh mesh;
    if (thicken(&mesh, &s, 1.2, 18 * 18 * slope * 1.2, 1e-4)) {
        CHECK_EQUAL(2 * 162 + 2 * 36, mesh.triangle_count);
        for (int32_t v = 0; v < mesh.vertex_count; v++) {
            iso_vec3 p = mesh.position[v];
            double off = fabs(p.z - 0.5 * p.x - 0.25 * p.y) / slope;
            CHECK_NEAR(0.6, off, 1e-6);
        }
        iso_mesh_free(&mesh);
    }
    shape_free(&s);
}

/* Two squares at 90 degrees: the mitre keeps each of them between its planes. */
static void test_fold_has_a_mitre(void) {
    shape s = {0};
    shape_quad(&s, (shape_point){0, 0, 0}, (shape_point){10, 0, 0}, (shape_point){10, 10, 0},
               (shape_point){0, 10, 0});
    shape_quad(&s, (shape_point){0, 0, 0}, (shape_point){0, 10, 0}, (shape_point){0, 10, 10},
               (shape_point){0, 0, 10});
    iso_mesh mesh;
    /* an L of two arms 10 long along their middles */
    if (thicken(&mesh, &s, 2, 2 * 10 * 2 * 10, 1e-3)) {
        CHECK_NEAR(-1, mesh.min.x, 1e-4);
        CHECK_NEAR(-1, mesh.min.z, 1e-4);
        CHECK_NEAR(0, mesh.min.y, 1e-4);
        CHECK_EQUAL(1, mesh.defects.sheets);
        iso_mesh_free(&mesh);
    }
    shape_free(&s);
}

/* At an edge of a few degrees the mitre would reach far out. */
static void test_sharp_fold_is_limited(void) {
    shape s = {0};
    shape_quad(&s, (shape_point){0, 0, 0}, (shape_point){10, 0, 0}, (shape_point){10, 10, 0},
               (shape_point){0, 10, 0});
    shape_quad(&s, (shape_point){0, 0, 0}, (shape_point){0, 10, 0}, (shape_point){10, 10, 0.5},
               (shape_point){10, 0, 0.5});
    iso_mesh_options options = {.sheet_thickness = 1};
    iso_mesh mesh;
    if (CHECK_OK(iso_mesh_from_triangles_with(&mesh, s.triangle, s.count, &options))) {
        CHECK_OK(iso_mesh_validate(&mesh));
        CHECK(mesh.min.x >= -1 - 1e-9 && mesh.min.x < -0.9);
        iso_mesh_free(&mesh);
    }
    shape_free(&s);
}

static void test_box_without_lid(void) {
    shape s = {0};
    shape_box(&s, 0, 0, 0, 20, 20, 20);
    shape_remove(&s, 2);
    shape_remove(&s, 2);
    iso_mesh mesh;
    /* outside 21 x 21 x 20.5, inside 19 x 19 x 19.5 */
    if (thicken(&mesh, &s, 1, 21 * 21 * 20.5 - 19 * 19 * 19.5, 2e-2)) {
        CHECK_NEAR(-0.5, mesh.min.x, 1e-4);
        CHECK_NEAR(20.5, mesh.max.y, 1e-4);
        CHECK_NEAR(-0.5, mesh.min.z, 1e-4);
        CHECK_NEAR(20, mesh.max.z, 1e-4);
        CHECK_EQUAL(1, mesh.defects.sheets);
        CHECK_EQUAL(0, mesh.defects.holes_closed);
        CHECK_NEAR(0, mesh.defects.cap_area, 0);
        iso_mesh_free(&mesh);
    }
    shape_free(&s);
}

static void test_hemisphere(void) {
    shape s = {0};
    shape_sphere(&s, (shape_point){0, 0, 0}, 10, 60, 120);
    for (int64_t t = s.count - 1; t >= 0; t--)
        if (s.triangle[9 * t + 2] + s.triangle[9 * t + 5] + s.triangle[9 * t + 8] > 0)
            shape_remove(&s, t);
    double wanted = 2 * SHAPE_PI / 3 * (pow(10.5, 3) - pow(9.5, 3));
    iso_mesh mesh;
    if (thicken(&mesh, &s, 1, wanted, 2e-3 * wanted)) {
        for (int32_t v = 0; v < mesh.vertex_count; v++) {
            iso_vec3 p = mesh.position[v];
            CHECK_NEAR(0.5, fabs(sqrt(p.x * p.x + p.y * p.y + p.z * p.z) - 10), 0.02);
        }
        iso_mesh_free(&mesh);
    }
    shape_free(&s);
}

static double area_of(const shape *s) {
    double sum = 0;
    for (int64_t t = 0; t < s->count; t++) {
        const float *f = s->triangle + 9 * t;
        double a[3], b[3];
        for (int k = 0; k < 3; k++)
            a[k] = (double)f[3 + k] - f[k], b[k] = (double)f[6 + k] - f[k];
        double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2],
               z = a[0] * b[1] - a[1] * b[0];
        sum += 0.5 * sqrt(x * x + y * y + z * z);
    }
    return sum;
}

/* One side, one rim: its cover is a torus with a twist. */
static void test_moebius_strip(void) {
    shape s = {0};
    shape_moebius(&s, 20, 3, 120);
    iso_mesh mesh;
    double wanted = area_of(&s) * 1.5;
    if (thicken(&mesh, &s, 1.5, wanted, 1e-3 * wanted)) {
        CHECK_EQUAL(1, mesh.defects.sheets);
        CHECK_EQUAL(1, mesh.defects.shells);
        CHECK_EQUAL(480 + 480, mesh.triangle_count);
        CHECK_EQUAL(480, mesh.vertex_count); /* V - E + F = 0 */
        iso_mesh_free(&mesh);
    }
    shape_free(&s);
}

/* Three sheets that meet at one edge: the two that lie in a plane go on into each other, whichever
 * comes first in the file, and the third ends in them. */
static void test_three_at_an_edge(void) {
    const shape_point a = {0, 0, 0}, b = {0, 10, 0};
    const shape_point far[3][2] = {
        {{10, 0, 0}, {10, 10, 0}}, {{-10, 0, 0}, {-10, 10, 0}}, {{0, 0, 10}, {0, 10, 10}}};
    static const int order[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                    {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (int k = 0; k < 6; k++) {
        shape s = {0};
        for (int i = 0; i < 3; i++)
            shape_quad(&s, a, far[order[k][i]][0], far[order[k][i]][1], b);
        iso_mesh mesh;
        if (thicken(&mesh, &s, 1, 200 + 100, 1e-3)) {
            CHECK_EQUAL(2, mesh.defects.sheets);
            CHECK_EQUAL(2, mesh.defects.shells);
            for (int32_t v = 0; v < mesh.vertex_count; v++) { /* no mitre between two of them */
                iso_vec3 p = mesh.position[v];
                CHECK(fabs(p.x) < 0.4 || fabs(p.z) < 0.4 || fabs(p.x) > 9 || fabs(p.z) > 9);
            }
            iso_mesh_free(&mesh);
        }
        shape_free(&s);
    }
}

/* Sound parts beside a sheet stay as they are, mended as ever. */
static void test_solids_stay_solid(void) {
    shape s = {0};
    shape_box(&s, 0, 0, 0, 10, 10, 10);
    shape_remove(&s, 3);
    shape_quad(&s, (shape_point){20, 0, 0}, (shape_point){30, 0, 0}, (shape_point){30, 10, 0},
               (shape_point){20, 10, 0});
    int64_t from = s.count;
    shape_box(&s, 40, 0, 0, 50, 10, 10);
    shape_turn(&s, from, s.count);
    iso_mesh mesh;
    if (thicken(&mesh, &s, 0.5, 1000 + 50 + 1000, 1e-4)) {
        CHECK_EQUAL(1, mesh.defects.sheets);
        CHECK_EQUAL(1, mesh.defects.holes_closed);
        CHECK_EQUAL(1, mesh.defects.inverted_shells);
        CHECK_EQUAL(3, mesh.defects.shells);
        iso_mesh_free(&mesh);
    }
    shape_free(&s);
    shape t = {0};
    shape_box(&t, 0, 0, 0, 10, 10, 10);
    iso_mesh_options options = {.sheet_thickness = 3};
    if (CHECK_OK(iso_mesh_from_triangles_with(&mesh, t.triangle, t.count, &options))) {
        CHECK_EQUAL(0, mesh.defects.sheets);
        CHECK_NEAR(0, mesh.defects.sheet_thickness, 0);
        CHECK_NEAR(1000, iso_mesh_volume(&mesh), 1e-9);
        iso_mesh_free(&mesh);
    }
    shape_free(&t);
}

/* Triangles of a sheet that turn against each other make no difference. */
static void test_turned_triangles(void) {
    shape s = {0};
    add_graph(&s, 4, 8, tilted);
    for (int64_t t = 0; t < s.count; t += 3)
        shape_turn(&s, t, t + 1);
    const double slope = sqrt(1 + 0.5 * 0.5 + 0.25 * 0.25);
    iso_mesh mesh;
    if (thicken(&mesh, &s, 1, 64 * slope, 1e-4))
        iso_mesh_free(&mesh);
    shape_free(&s);
}

static uint32_t seed = 7;

static double random_unit(void) {
    seed = seed * 1664525u + 1013904223u;
    return (seed >> 8) / 16777216.0;
}

/* Soups of all kinds: every triangle counts with its thickness, and the link holds. */
static void test_random_soups(void) {
    for (int run = 0; run < 200; run++) {
        shape s = {0};
        int corners = 5 + run % 20, triangles = 1 + run % 37;
        shape_point p[25];
        for (int i = 0; i < corners; i++)
            p[i] = (shape_point){100 * random_unit(), 100 * random_unit(), 100 * random_unit()};
        for (int i = 0; i < triangles; i++) {
            int k[3];
            for (int j = 0; j < 3; j++)
                k[j] = (int)(random_unit() * corners);
            shape_add(&s, p[k[0]], p[k[1]], p[k[2]]);
        }
        iso_mesh_options options = {.sheet_thickness = 0.01};
        iso_mesh mesh;
        iso_status status = iso_mesh_from_triangles_with(&mesh, s.triangle, s.count, &options);
        if (status == ISO_OK) {
            CHECK_OK(iso_mesh_validate(&mesh));
            CHECK(iso_mesh_volume(&mesh) > 0);
            iso_mesh_free(&mesh);
        } else { /* all without area, or back to back */
            CHECK_EQUAL(ISO_UNSLICEABLE, status);
            CHECK(strstr(iso_error_message(), "nothing is left") != NULL);
        }
        shape_free(&s);
    }
}

static void test_no_memory(void) {
    shape s = {0};
    shape_moebius(&s, 20, 3, 12);
    shape_box(&s, 40, 0, 0, 50, 10, 10);
    shape_remove(&s, 30);
    iso_mesh_options options = {.sheet_thickness = 1};
    iso_mesh mesh;
    int64_t n = 0;
    for (;; n++) {
        iso_fail_allocation_after(n);
        iso_status status = iso_mesh_from_triangles_with(&mesh, s.triangle, s.count, &options);
        iso_fail_allocation_after(-1);
        if (status == ISO_OK)
            break;
        CHECK_EQUAL(ISO_NO_MEMORY, status);
    }
    CHECK(n > 20);
    iso_mesh_free(&mesh);
    shape_free(&s);
}

int main(void) {
    RUN(test_one_triangle_is_a_prism);
    RUN(test_plane_sheet_is_exact);
    RUN(test_fold_has_a_mitre);
    RUN(test_sharp_fold_is_limited);
    RUN(test_box_without_lid);
    RUN(test_hemisphere);
    RUN(test_moebius_strip);
    RUN(test_three_at_an_edge);
    RUN(test_solids_stay_solid);
    RUN(test_turned_triangles);
    RUN(test_random_soups);
    RUN(test_no_memory);
    return check_verdict();
}

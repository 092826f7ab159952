/* The slicer of meshes and the slicer of any double-link find the same contours, bit by bit. */
#include "check.h"

#include <math.h>
#include <stdlib.h>

#include <isoslice/link.h>

#include "link/surfaces.h"

enum { LEVELS = 33 };

/* A torus as a mesh; z in steps of `step`, so that vertices and whole edges lie on levels. */
static iso_status read_torus(iso_mesh *mesh, int n, int m, double step) {
    static polyhedron s;
    static float triangle[SURFACE_CORNERS_MAX][3];
    make_torus(&s, n, m);
    int32_t corners = s.first[s.faces.face_count];
    for (int32_t a = 0; a < corners; a++) {
        const double *at = s.position + 3 * s.vertex[a];
        triangle[a][0] = (float)at[0]; /* axis along y: a saddle between two tubes */
        triangle[a][1] = (float)-at[2];
        triangle[a][2] = (float)(floor(at[1] / step + 0.5) * step);
    }
    return iso_mesh_from_triangles(mesh, triangle[0], corners / 3);
}

/* Walk both in canonical order: by level, then by the lowest dart. */
static int compare(const iso_coloured_link *general, const iso_coloured_link *planar) {
    int32_t size = general->link.size, at = 0, contours = 0;
    const iso_map *colour = &general->link.projection[0], *phi = &general->link.map[0];
    char *passed = calloc((size_t)size + 1, 1);
    if (!CHECK_EQUAL(size, planar->link.size))
        at = size;
    for (int32_t level = 0; at < size && level < LEVELS; level++)
        for (int32_t start = 0; start < size; start++) {
            if (iso_map_at(colour, start) != level || passed[start])
                continue;
            int32_t first = at;
            contours++;
            for (int32_t i = start; !passed[i]; i = iso_map_at(phi, i), at++) {
                const double *x = general->link.g + 3 * i, *y = planar->link.g + 3 * at;
                int32_t next = iso_map_at(phi, i) == start ? first : at + 1;
                passed[i] = 1;
                CHECK(x[0] == y[0] && x[1] == y[1]);
                CHECK_NEAR(x[2], y[2], 1e-12); /* on the edge, and the level's own */
                CHECK_EQUAL(level, iso_map_at(&planar->link.projection[0], at));
                CHECK_EQUAL(next, iso_map_at(&planar->link.map[0], at));
            }
        }
    CHECK_EQUAL(size, at);
    free(passed);
    return contours;
}

static void check_torus(int n, int m, double step) {
    double cut[LEVELS], rest[LEVELS];
    iso_levels levels = {LEVELS, cut, rest, rest};
    iso_mesh mesh;
    iso_slices slices;
    iso_double_link surface;
    iso_coloured_link planar, general;
    for (int i = 0; i < LEVELS; i++) {
        cut[i] = -3.2 + 0.2 * i;
        cut[i] = floor(cut[i] * 20 + 0.5) / 20;
        rest[i] = 0.2;
    }
    if (!CHECK_OK(read_torus(&mesh, n, m, step)) ||
        !CHECK_OK(iso_slice_planar(&slices, &mesh, &levels)) ||
        !CHECK_OK(iso_slices_to_link(&planar, &slices, &levels)) ||
        !CHECK_OK(iso_double_link_from_mesh(&surface, &mesh)))
        return;
    double *height = malloc((size_t)surface.link.size * sizeof *height);
    for (int32_t a = 0; a < surface.link.size; a++)
        height[a] = surface.link.g[3 * a + 2];
    CHECK_OK(iso_slice_double_link(&general, &surface, height, cut, LEVELS));
    CHECK_EQUAL(slices.contour_count, compare(&general, &planar));
    CHECK(slices.contour_count > 30);
    free(height);
    iso_multilink_free(&general.link);
    iso_multilink_free(&planar.link);
    iso_multilink_free(&surface.link);
    iso_slices_free(&slices);
    iso_mesh_free(&mesh);
}

static void test_torus(void) {
    check_torus(24, 18, 1e-6);
}

static void test_torus_with_ties(void) {
    check_torus(21, 17, 0.05);
}

int main(void) {
    RUN(test_torus);
    RUN(test_torus_with_ties);
    return check_verdict();
}

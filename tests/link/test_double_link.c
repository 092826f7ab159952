/* Double-links from faces, what is wrong with faces, and slices of any surface. */
#include "check.h"

#include <math.h>
#include <stdlib.h>

#include <isoslice/link.h>

#include "base/memory.h"
#include "link/surfaces.h"

#define PI 3.14159265358979323846

static int says(const char *part) {
    int found = strstr(iso_error_message(), part) != NULL;
    if (!found)
        fprintf(stderr, "  it says: %s\n", iso_error_message());
    return found;
}

static void check_counts(const iso_double_link *surface, int faces, int vertices, int edges,
                         int parts) {
    iso_surface_counts counts;
    if (!CHECK_OK(iso_double_link_count(&counts, surface)))
        return;
    CHECK_EQUAL(faces, counts.faces);
    CHECK_EQUAL(vertices, counts.vertices);
    CHECK_EQUAL(edges, counts.edges);
    CHECK_EQUAL(parts, counts.parts);
    CHECK_EQUAL(vertices - edges + faces, counts.euler);
}

static void check_refused(const polyhedron *s, const char *message) {
    iso_double_link surface;
    CHECK_STATUS(ISO_USAGE, iso_double_link_from_faces(&surface, &s->faces, ISO_BOUNDARY_REFUSED));
    CHECK(says(message));
    CHECK(surface.link.size == 0 && surface.link.map[1].image == NULL);
}

static void test_counts_of_surfaces(void) {
    static polyhedron s;
    iso_double_link surface;
    make_dodecahedron(&s);
    CHECK_OK(iso_double_link_from_faces(&surface, &s.faces, ISO_BOUNDARY_REFUSED));
    check_counts(&surface, 12, 20, 30, 1);
    CHECK(surface.link.map[0].rule == ISO_MAP_CYCLIC); /* all faces alike: nothing is stored */
    iso_multilink_free(&surface.link);
    make_torus(&s, 10, 8);
    CHECK_OK(iso_double_link_from_faces(&surface, &s.faces, ISO_BOUNDARY_REFUSED));
    check_counts(&surface, 160, 80, 240, 1);
    iso_multilink_free(&surface.link);
    make_prism_box(&s);
    CHECK_OK(iso_double_link_from_faces(&surface, &s.faces, ISO_BOUNDARY_REFUSED));
    check_counts(&surface, 8, 12, 18, 1);
    CHECK(surface.link.map[0].rule == ISO_MAP_STORED);
    iso_multilink_free(&surface.link);
}

static void test_triangles_need_no_first(void) {
    static polyhedron s;
    iso_double_link surface, same;
    make_torus(&s, 5, 6);
    CHECK_OK(iso_double_link_from_faces(&surface, &s.faces, ISO_BOUNDARY_REFUSED));
    s.faces.first = NULL;
    CHECK_OK(iso_double_link_from_faces(&same, &s.faces, ISO_BOUNDARY_REFUSED));
    CHECK_EQUAL(surface.link.size, same.link.size);
    for (int32_t a = 0; a < same.link.size; a++)
        CHECK_EQUAL(iso_double_link_beta(&surface, a), iso_double_link_beta(&same, a));
    iso_multilink_free(&surface.link);
    iso_multilink_free(&same.link);
}

static void test_a_mesh_is_a_double_link(void) {
    static polyhedron s;
    iso_double_link expected, surface;
    iso_vec3 position[30];
    int32_t opposite[180];
    make_torus(&s, 5, 6);
    if (!CHECK_OK(iso_double_link_from_faces(&expected, &s.faces, ISO_BOUNDARY_REFUSED)))
        return;
    for (int32_t a = 0; a < 180; a++)
        opposite[a] = iso_double_link_opposite(&expected, a);
    memcpy(position, s.position, sizeof position);
    iso_mesh mesh = {.triangle_count = 60,
                     .vertex_count = 30,
                     .origin = s.vertex,
                     .opposite = opposite,
                     .position = position};
    CHECK_OK(iso_double_link_from_mesh(&surface, &mesh));
    for (int32_t a = 0; a < 180; a++) {
        CHECK_EQUAL(iso_double_link_alpha(&expected, a), iso_double_link_alpha(&surface, a));
        CHECK_EQUAL(iso_double_link_beta(&expected, a), iso_double_link_beta(&surface, a));
        CHECK_EQUAL(iso_double_link_face(&expected, a), iso_double_link_face(&surface, a));
        CHECK_EQUAL(iso_double_link_vertex(&expected, a), iso_double_link_vertex(&surface, a));
    }
    CHECK(memcmp(expected.link.g, surface.link.g, 180 * 24) == 0);
    iso_multilink_free(&surface.link);
    int32_t kept = opposite[7];
    opposite[7] = opposite[8];
    CHECK_STATUS(ISO_NOT_VERIFIED, iso_double_link_from_mesh(&surface, &mesh));
    opposite[7] = kept;
    mesh.triangle_count = 0;
    CHECK_OK(iso_double_link_from_mesh(&surface, &mesh));
    CHECK_EQUAL(0, surface.link.size);
    iso_multilink_free(&surface.link);
    iso_multilink_free(&expected.link);
}

static void test_faces_that_do_not_fit(void) {
    static polyhedron s;
    make_tetrahedron(&s);
    s.vertex[4] = 4;
    check_refused(&s, "face 1 has vertex 4; vertices are 0 .. 3");
    s.vertex[4] = 0;
    check_refused(&s, "face 1 has vertex 0 twice in a row");
    make_tetrahedron(&s);
    drop_face(&s, 2);
    check_refused(&s, "face 0 has no neighbour at its edge from vertex 2 to 1 (3 edges are open)");
    make_tetrahedron(&s);
    int32_t turned[3] = {1, 3, 2};
    memcpy(s.vertex + 6, turned, sizeof turned);
    check_refused(&s, "with the same direction: turn one");
    make_tetrahedron(&s);
    memcpy(s.vertex + 12, s.vertex, 3 * sizeof *s.vertex); /* face 0 once more */
    s.first[5] = 15;
    s.faces.face_count = 5;
    check_refused(&s, "3 faces share the edge from vertex 1 to 0, among them 0 and 1");
    make_tetrahedron(&s);
    s.first[2] = 5;
    check_refused(&s, "face 1 has 2 corners; a polygon has 3 or more");
    s.first[2] = 2;
    check_refused(&s, "face 1 has -1 corners");
    make_tetrahedron(&s);
    s.first[0] = 1;
    check_refused(&s, "the first face begins at corner 1, not at 0");
    s.first[0] = 0;
    s.faces.position = NULL;
    check_refused(&s, "faces in dimension 3 without positions");
    s.faces.dimension = 99;
    check_refused(&s, "in dimension 99");
}

/* A dart on the boundary that is its own opposite satisfies αβαβ = 1 and fα = f, and yet is no
 * answer: β would turn it about a vertex that is not its own. */
static void test_a_boundary_cannot_be_a_fixed_point(void) {
    int32_t alpha[3] = {1, 2, 0}, beta[3], f[3] = {0}, v[3] = {0, 1, 2};
    for (int a = 0; a < 3; a++)
        beta[alpha[a]] = a; /* βα(a) = a */
    iso_multilink view = iso_multilink_view(ISO_KIND_DOUBLE_LINK, 3, 0, 0, NULL);
    iso_map_store(&view.map[0], alpha, 3);
    iso_map_store(&view.map[1], beta, 3);
    iso_map_store(&view.projection[0], f, 1);
    iso_map_store(&view.projection[1], v, 3);
    CHECK_STATUS(ISO_NOT_VERIFIED, iso_multilink_validate(&view));
    CHECK(strcmp(iso_error_message(), "double-link: vβ = v fails at index 0: 2 and 0") == 0);
}

static void test_a_bow_tie_splits_at_its_vertex(void) {
    static polyhedron s; /* two tetrahedra that share vertex 0 */
    static const int32_t face[8][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2},
                                       {0, 5, 4}, {0, 4, 6}, {4, 5, 6}, {0, 6, 5}};
    iso_double_link surface;
    make_tetrahedron(&s);
    memcpy(s.vertex, face, sizeof face);
    for (int i = 0; i <= 8; i++)
        s.first[i] = 3 * i;
    s.faces.face_count = 8;
    s.faces.vertex_count = 7;
    CHECK_OK(iso_double_link_from_faces(&surface, &s.faces, ISO_BOUNDARY_REFUSED));
    check_counts(&surface, 8, 8, 12, 2);
    iso_multilink_free(&surface.link);
    drop_face(&s, 6); /* two holes that meet at no vertex of theirs alone */
    drop_face(&s, 1);
    CHECK_OK(iso_double_link_from_faces(&surface, &s.faces, ISO_BOUNDARY_FANNED));
    check_counts(&surface, 12, 10, 18, 2);
    iso_multilink_free(&surface.link);
}

/* Area of the contours of one colour, seen along `axis`, a unit vector. */
static double area_of(const iso_coloured_link *link, int32_t colour, const double *axis) {
    double sum = 0;
    for (int32_t i = 0; i < link->link.size; i++) {
        if (iso_map_at(&link->link.projection[0], i) != colour)
            continue;
        const double *p = link->link.g + 3 * i;
        const double *q = link->link.g + 3 * iso_map_at(&link->link.map[0], i);
        sum += axis[0] * (p[1] * q[2] - p[2] * q[1]) + axis[1] * (p[2] * q[0] - p[0] * q[2]) +
               axis[2] * (p[0] * q[1] - p[1] * q[0]);
    }
    return sum / 2;
}

static double *heights_along(const iso_double_link *surface, const double *axis) {
    double *height = malloc(((size_t)surface->link.size + 1) * sizeof *height);
    for (int32_t a = 0; a < surface->link.size; a++) {
        const double *at = surface->link.g + 3 * (size_t)a;
        height[a] = axis[0] * at[0] + axis[1] * at[1] + axis[2] * at[2];
    }
    /* exactly equal around a vertex, and rounded so that vertices of one level have one height */
    for (int32_t a = 0; a < surface->link.size; a++)
        height[a] = floor(height[a] * 1e9 + 0.5) / 1e9;
    return height;
}

static int32_t contours_of(const iso_coloured_link *link) {
    int32_t count, *orbit = malloc(((size_t)link->link.size + 1) * sizeof *orbit);
    CHECK_OK(iso_multilink_check_bijective(&link->link, "φ"));
    CHECK_OK(iso_multilink_orbits(orbit, &count, &link->link, "φ"));
    free(orbit);
    return count;
}

/* Between the heights of its vertices the cross-section of a polyhedron is a quadratic function of
 * the height: Simpson's rule gives its volume, and Euclid's is (15 + 7 √5) / 4 edge^3. */
static void test_dodecahedron_sliced(void) {
    static polyhedron s;
    iso_double_link surface;
    iso_coloured_link link;
    make_dodecahedron(&s);
    if (!CHECK_OK(iso_double_link_from_faces(&surface, &s.faces, ISO_BOUNDARY_REFUSED)))
        return;
    double p = (1 + sqrt(5)) / 2, scale = sqrt(1 + p * p), edge = sqrt(5) - 1;
    double axis[3] = {0, p / scale, 1 / scale};
    double *height = heights_along(&surface, axis), level[9], ring[4] = {0};
    int rings = 0;
    for (int32_t a = 0; a < 60; a++) { /* the four heights of its vertices */
        int i = 0;
        while (i < rings && fabs(ring[i] - height[a]) > 1e-6)
            i++;
        if (i < rings || !CHECK(rings < 4))
            continue;
        for (i = rings++; i > 0 && ring[i - 1] > height[a]; i--)
            ring[i] = ring[i - 1];
        ring[i] = height[a];
    }
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++) /* just inside the ends of each slab, and its middle */
            level[3 * k + i] = ring[k] + (ring[k + 1] - ring[k]) * (i == 0   ? 1e-7
                                                                    : i == 1 ? 0.5
                                                                             : 1 - 1e-7);
    if (!CHECK_OK(iso_slice_double_link(&link, &surface, height, level, 9)))
        return;
    CHECK_EQUAL(9, contours_of(&link));
    double volume = 0;
    for (int k = 0; k < 3; k++)
        volume += (ring[k + 1] - ring[k]) / 6 *
                  (area_of(&link, 3 * k, axis) + 4 * area_of(&link, 3 * k + 1, axis) +
                   area_of(&link, 3 * k + 2, axis));
    CHECK_NEAR((15 + 7 * sqrt(5)) / 4 * edge * edge * edge, volume, 1e-5);
    int sides = 0; /* the middle is a regular decagon */
    for (int32_t i = 0; i < link.link.size; i++)
        sides += iso_map_at(&link.link.projection[0], i) == 4;
    CHECK_EQUAL(10, sides);
    double length = 0;
    for (int32_t i = 0; i < link.link.size; i++) {
        const double *x = link.link.g + 3 * i;
        const double *y = link.link.g + 3 * iso_map_at(&link.link.map[0], i);
        if (iso_map_at(&link.link.projection[0], i) != 4)
            continue;
        double d = hypot(hypot(x[0] - y[0], x[1] - y[1]), x[2] - y[2]);
        length = length == 0 ? d : length;
        CHECK_NEAR(length, d, 1e-6);
    }
    CHECK_NEAR(2.5 * length * length / tan(PI / 10), area_of(&link, 4, axis), 1e-6);
    iso_multilink_free(&link.link);
    iso_multilink_free(&surface.link);
    free(height);
}

/* Through vertices, edges and whole faces: the rule <= / < is the slice just above. */
static void test_levels_on_vertices_and_faces(void) {
    static polyhedron s;
    iso_double_link surface;
    iso_coloured_link link;
    const double up[3] = {0, 0, 1}, level[5] = {-0.5, 0, 0.5, 1, 2};
    make_prism_box(&s);
    if (!CHECK_OK(iso_double_link_from_faces(&surface, &s.faces, ISO_BOUNDARY_REFUSED)))
        return;
    double *height = heights_along(&surface, up);
    CHECK_OK(iso_slice_double_link(&link, &surface, height, level, 5));
    CHECK_EQUAL(12, link.link.size); /* the bottom counts, the top does not */
    CHECK_EQUAL(2, contours_of(&link));
    CHECK_NEAR(1.5 * sqrt(3), area_of(&link, 1, up), 1e-12);
    CHECK_NEAR(1.5 * sqrt(3), area_of(&link, 2, up), 1e-12);
    iso_multilink_free(&link.link);
    CHECK_OK(iso_slice_double_link(&link, &surface, height, level, 0));
    CHECK_EQUAL(0, link.link.size);
    iso_multilink_free(&link.link);

    const double falling[2] = {1, 1}, wild[1] = {NAN};
    CHECK_STATUS(ISO_USAGE, iso_slice_double_link(&link, &surface, height, falling, 2));
    CHECK(says("level 1 (1) is not above the one before (1)"));
    CHECK_STATUS(ISO_USAGE, iso_slice_double_link(&link, &surface, height, wild, 1));
    height[20] = 0.25;
    CHECK_STATUS(ISO_USAGE, iso_slice_double_link(&link, &surface, height, level, 5));
    CHECK(says("hβ = h fails at dart "));
    height[20] = INFINITY;
    CHECK_STATUS(ISO_USAGE, iso_slice_double_link(&link, &surface, height, level, 5));
    CHECK(says("the height of dart 20 is not finite"));
    iso_multilink_free(&surface.link);
    free(height);
}

/* Any heights on any faces, ties and saddles within a face included, close up. */
static void test_random_heights_always_close(void) {
    static polyhedron s;
    uint64_t state = 5;
    const double level[6] = {-1, 0, 0.5, 1, 2, 3};
    for (int turn = 0; turn < 300; turn++) {
        iso_double_link surface;
        iso_coloured_link link;
        double at[80], height[512];
        if (turn % 3 == 0)
            make_torus(&s, 10, 8);
        else if (turn % 3 == 1)
            make_dodecahedron(&s);
        else
            make_prism_box(&s);
        s.faces.dimension = 0;
        if (!CHECK_OK(iso_double_link_from_faces(&surface, &s.faces, ISO_BOUNDARY_REFUSED)))
            return;
        for (int32_t v = 0; v < s.faces.vertex_count; v++)
            at[v] = next_random(&state) % 4;
        for (int32_t a = 0; a < surface.link.size; a++)
            height[a] = at[iso_double_link_vertex(&surface, a)];
        CHECK_OK(iso_slice_double_link(&link, &surface, height, level, 6));
        CHECK_OK(iso_multilink_check_bijective(&link.link, "φ"));
        for (int32_t i = 0; i < link.link.size; i++) { /* d φ_r = c of the paper, 5d */
            int32_t dart = iso_map_at(&link.link.projection[1], i);
            int32_t next = iso_map_at(&link.link.projection[1], iso_map_at(&link.link.map[0], i));
            CHECK_EQUAL(iso_double_link_face(&surface, iso_double_link_opposite(&surface, dart)),
                        iso_double_link_face(&surface, next));
        }
        iso_multilink_free(&link.link);
        iso_multilink_free(&surface.link);
    }
}

/* The paper's own way (5b to 5d): the crossings of a level are edges of a digraph whose vertices
 * are the faces. On triangles it can be linked in one way only, so both ways agree. */
static void test_slices_are_linked_digraphs(void) {
    static polyhedron s;
    uint64_t state = 23;
    const double level[4] = {0, 1, 2, 3};
    iso_double_link surface;
    iso_coloured_link link;
    double at[80], height[480];
    int32_t domain[2000], codomain[2000], successor[2000];
    make_torus(&s, 10, 8);
    if (!CHECK_OK(iso_double_link_from_faces(&surface, &s.faces, ISO_BOUNDARY_REFUSED)))
        return;
    for (int turn = 0; turn < 20; turn++) {
        for (int v = 0; v < 80; v++)
            at[v] = next_random(&state) % 5;
        for (int32_t a = 0; a < 480; a++)
            height[a] = at[iso_double_link_vertex(&surface, a)];
        CHECK_OK(iso_slice_double_link(&link, &surface, height, level, 4));
        int32_t size = link.link.size;
        if (!CHECK(size > 100 && size < 2000))
            return;
        for (int32_t i = 0; i < size; i++) { /* a copy of the faces for each level */
            int32_t a = iso_map_at(&link.link.projection[1], i);
            int32_t colour = iso_map_at(&link.link.projection[0], i);
            domain[i] = 160 * colour + iso_double_link_face(&surface, a);
            codomain[i] = 160 * colour +
                          iso_double_link_face(&surface, iso_double_link_opposite(&surface, a));
        }
        CHECK_OK(iso_link_digraph(successor, size, 640, domain, codomain));
        CHECK(memcmp(successor, link.link.map[0].image, (size_t)size * sizeof *successor) == 0);
        iso_multilink_free(&link.link);
    }
    iso_multilink_free(&surface.link);
}

static void test_places_in_four_dimensions(void) {
    static polyhedron s;
    static double position[4 * 80];
    iso_double_link surface;
    iso_coloured_link link;
    make_torus(&s, 10, 8);
    for (int v = 0; v < 80; v++) { /* the fourth is linear in the others: slices keep it so */
        const double *p = s.position + 3 * v;
        memcpy(position + 4 * v, p, 3 * sizeof *p);
        position[4 * v + 3] = 2 * p[0] - 3 * p[1] + p[2];
    }
    s.faces.dimension = 4;
    s.faces.position = position;
    if (!CHECK_OK(iso_double_link_from_faces(&surface, &s.faces, ISO_BOUNDARY_REFUSED)))
        return;
    double height[480], level[3] = {-0.5, 0.1, 0.6};
    for (int32_t a = 0; a < 480; a++)
        height[a] = surface.link.g[4 * a + 2];
    CHECK_OK(iso_slice_double_link(&link, &surface, height, level, 3));
    CHECK_EQUAL(4, link.link.dimension);
    CHECK_EQUAL(6, contours_of(&link)); /* an outer ring and a hole each */
    for (int32_t i = 0; i < link.link.size; i++) {
        const double *p = link.link.g + 4 * i;
        CHECK_NEAR(2 * p[0] - 3 * p[1] + p[2], p[3], 1e-12);
        CHECK_NEAR(level[iso_map_at(&link.link.projection[0], i)], p[2], 1e-12);
    }
    iso_multilink_free(&link.link);
    iso_multilink_free(&surface.link);
}

/* A torus with holes, fanned: a double-link that slices into closed contours whose area stays. */
static void test_fans_over_holes(void) {
    static polyhedron s;
    iso_double_link whole, mended;
    iso_coloured_link link, other;
    const double up[3] = {0, 0, 1}, level[3] = {-0.55, 0.05, 0.65};
    make_torus(&s, 20, 14);
    if (!CHECK_OK(iso_double_link_from_faces(&whole, &s.faces, ISO_BOUNDARY_REFUSED)))
        return;
    for (int32_t face = 545; face > 0; face -= 21)
        drop_face(&s, face);
    CHECK_OK(iso_double_link_from_faces(&mended, &s.faces, ISO_BOUNDARY_FANNED));
    check_counts(&mended, 560 + 2 * 26, 280 + 26, 840 + 3 * 26, 1);
    double *height = heights_along(&whole, up), *again = heights_along(&mended, up);
    CHECK_OK(iso_slice_double_link(&link, &whole, height, level, 3));
    CHECK_OK(iso_slice_double_link(&other, &mended, again, level, 3));
    CHECK_EQUAL(6, contours_of(&link));
    CHECK_EQUAL(6, contours_of(&other));
    for (int i = 0; i < 3; i++) /* the holes are flat triangles: a fan restores them */
        CHECK_NEAR(area_of(&link, i, up), area_of(&other, i, up), 1e-7);
    iso_multilink_free(&link.link);
    iso_multilink_free(&other.link);
    iso_multilink_free(&whole.link);
    iso_multilink_free(&mended.link);
    free(height);
    free(again);
}

static void test_memory_that_runs_out(void) {
    static polyhedron s;
    const double level[2] = {0.25, 0.5};
    double height[48];
    iso_status status = ISO_NO_MEMORY;
    make_prism_box(&s);
    drop_face(&s, 1);
    for (int n = 0; n < 60 && status == ISO_NO_MEMORY; n++) {
        iso_double_link surface = {0};
        iso_coloured_link link = {0};
        iso_fail_allocation_after(n);
        status = iso_double_link_from_faces(&surface, &s.faces, ISO_BOUNDARY_FANNED);
        for (int32_t a = 0; a < surface.link.size; a++)
            height[a] = surface.link.g[3 * a + 2];
        if (status == ISO_OK)
            status = iso_slice_double_link(&link, &surface, height, level, 2);
        iso_fail_allocation_after(-1);
        CHECK(status == ISO_OK || status == ISO_NO_MEMORY);
        iso_multilink_free(&link.link);
        iso_multilink_free(&surface.link);
    }
    CHECK_EQUAL(ISO_OK, status);
}

int main(void) {
    RUN(test_counts_of_surfaces);
    RUN(test_triangles_need_no_first);
    RUN(test_a_mesh_is_a_double_link);
    RUN(test_faces_that_do_not_fit);
    RUN(test_a_boundary_cannot_be_a_fixed_point);
    RUN(test_a_bow_tie_splits_at_its_vertex);
    RUN(test_dodecahedron_sliced);
    RUN(test_levels_on_vertices_and_faces);
    RUN(test_random_heights_always_close);
    RUN(test_slices_are_linked_digraphs);
    RUN(test_places_in_four_dimensions);
    RUN(test_fans_over_holes);
    RUN(test_memory_that_runs_out);
    return check_verdict();
}

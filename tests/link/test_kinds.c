/* The examples of the paper, kind by kind. */
#include "check.h"

#include <stdlib.h>

#include <isoslice/link.h>

#include "base/memory.h"
#include "link/fill_link.h"
#include "link/surfaces.h"

static int says(const char *part) {
    int found = strstr(iso_error_message(), part) != NULL;
    if (!found)
        fprintf(stderr, "  it says: %s\n", iso_error_message());
    return found;
}

static int32_t orbit_count(const iso_multilink *link, const char *words) {
    int32_t count = -1, *orbit = malloc(((size_t)link->size + 1) * sizeof *orbit);
    CHECK_OK(iso_multilink_orbits(orbit, &count, link, words));
    free(orbit);
    return count;
}

static int same_maps(const iso_multilink *x, const iso_multilink *y) {
    if (x->size != y->size || x->map_count != y->map_count)
        return 0;
    for (int i = 0; i < x->map_count; i++)
        for (int32_t a = 0; a < x->size; a++)
            if (iso_map_at(&x->map[i], a) != iso_map_at(&y->map[i], a))
                return 0;
    return 1;
}

static void test_link_of_a_circle(void) {
    int32_t phi[5] = {1, 2, 3, 4, 0};
    double g[10] = {0, 0, 2, 0, 3, 1, 1, 2, -1, 1};
    iso_link link;
    CHECK_OK(iso_link_new(&link, 5, phi, 2, g));
    CHECK_OK(iso_multilink_check_bijective(&link.link, "φ"));
    CHECK(link.link.g != g && link.link.map[0].image != phi);
    CHECK_EQUAL(1, orbit_count(&link.link, "φ"));
    iso_multilink_free(&link.link);
    CHECK(link.link.g == NULL && link.link.size == 0);
    phi[4] = 4; /* an open curve stays at its end: a link, but no closed one */
    CHECK_OK(iso_link_new(&link, 5, phi, 2, g));
    CHECK_STATUS(ISO_NOT_VERIFIED, iso_multilink_check_bijective(&link.link, "φ"));
    iso_multilink_free(&link.link);
    phi[4] = 5;
    CHECK_STATUS(ISO_NOT_VERIFIED, iso_link_new(&link, 5, phi, 2, g));
    CHECK(link.link.size == 0 && link.link.map[0].image == NULL);
}

/* Paper, 4.1.2. β stays on the upper ring, so it is no injection, and the squares of that ring are
 * none: a square patch would have a boundary. */
static void test_cylinder(void) {
    static cylinder c;
    iso_square_link stored, box;
    iso_double_link tube;
    iso_square_patch patch;
    iso_surface_counts counts;
    const iso_axis axis[2] = {{360, 1}, {2, 0}};
    make_cylinder(&c);
    if (!CHECK_OK(iso_square_link_new(&stored, 720, c.alpha, c.beta, 3, c.g)) ||
        !CHECK_OK(iso_square_link_box(&box, axis, 3, c.g)))
        return;
    CHECK(same_maps(&stored.link, &box.link));
    CHECK_EQUAL(2, orbit_count(&stored.link, "α"));
    CHECK_EQUAL(360, orbit_count(&stored.link, "β"));
    CHECK_EQUAL(1, orbit_count(&stored.link, "α β"));
    CHECK_OK(iso_multilink_check_bijective(&stored.link, "α"));
    CHECK_STATUS(ISO_NOT_VERIFIED, iso_multilink_check_bijective(&stored.link, "β"));
    CHECK(says("β is no bijection: it takes 0 and 360 to 360"));
    CHECK_STATUS(ISO_NOT_VERIFIED, iso_square_patch_from_square_link(&patch, &stored));
    CHECK(says("β is no bijection"));
    CHECK_STATUS(ISO_USAGE, iso_double_link_from_square_link(&tube, &stored, ISO_BOUNDARY_REFUSED));
    CHECK(says("(720 edges are open)"));

    CHECK_OK(iso_double_link_from_square_link(&tube, &stored, ISO_BOUNDARY_FANNED));
    CHECK_OK(iso_double_link_count(&counts, &tube));
    CHECK_EQUAL(360 + 720, counts.faces);
    CHECK_EQUAL(722, counts.vertices);
    CHECK_EQUAL(2, counts.euler);
    CHECK_EQUAL(1, counts.parts);
    const double *top = tube.link.g + 3 * (tube.link.size - 1); /* the last fan's centre */
    CHECK_NEAR(0, top[0], 1e-12);
    CHECK_NEAR(0, top[1], 1e-12);
    CHECK_NEAR(1, top[2], 1e-12);
    iso_multilink_free(&tube.link);

    iso_multilink_free(&stored.link);
    c.beta[5] = 366; /* one further round: β(5) = α(β(4)) no longer */
    CHECK_STATUS(ISO_NOT_VERIFIED, iso_square_link_new(&stored, 720, c.alpha, c.beta, 3, c.g));
    CHECK(says("square-link: αβ = βα fails at index 4: 365 and 366"));
    iso_multilink_free(&box.link);
}

/* Paper, 4.1.4: four faces, four vertices, six edges on twelve darts. */
static void test_tetrahedron(void) {
    static polyhedron s;
    iso_double_link surface;
    iso_surface_counts counts;
    make_tetrahedron(&s);
    if (!CHECK_OK(iso_double_link_from_faces(&surface, &s.faces, ISO_BOUNDARY_REFUSED)))
        return;
    CHECK_EQUAL(12, surface.link.size);
    CHECK_OK(iso_double_link_count(&counts, &surface));
    CHECK(counts.faces == 4 && counts.vertices == 4 && counts.edges == 6 && counts.parts == 1);
    CHECK_EQUAL(2, counts.euler);
    for (int32_t a = 0; a < 12; a++) {
        int32_t alpha = iso_double_link_alpha(&surface, a),
                beta = iso_double_link_beta(&surface, a);
        CHECK_EQUAL(a / 3, iso_double_link_face(&surface, a));
        CHECK_EQUAL(s.vertex[a], iso_double_link_vertex(&surface, a));
        CHECK_EQUAL(a / 3 * 3 + (a + 1) % 3, alpha);
        int32_t opposite = iso_double_link_opposite(&surface, a);
        CHECK_EQUAL(s.vertex[a], s.vertex[iso_double_link_alpha(&surface, opposite)]);
        CHECK_EQUAL(s.vertex[alpha], s.vertex[opposite]);
        CHECK(beta != a && s.vertex[beta] == s.vertex[a]);
    }
    iso_multilink_free(&surface.link);
}

static void test_triangulation_and_back(void) {
    static polyhedron s;
    iso_double_link surface, back;
    iso_triangulation triangulation, again;
    iso_square_patch patch;
    make_torus(&s, 9, 7);
    if (!CHECK_OK(iso_double_link_from_faces(&surface, &s.faces, ISO_BOUNDARY_REFUSED)))
        return;
    CHECK_OK(iso_triangulation_from_double_link(&triangulation, &surface));
    CHECK_STATUS(ISO_NOT_VERIFIED, iso_square_patch_from_double_link(&patch, &surface));
    CHECK(says("square patch: θ⁴ = 1 fails at index 0"));

    /* through arrays of its own, without the rules of the maps */
    int32_t size = triangulation.link.size, *theta = malloc((size_t)size * 4),
            *phi = malloc((size_t)size * 4);
    for (int32_t a = 0; a < size; a++) {
        theta[a] = iso_map_at(&triangulation.link.map[0], a);
        phi[a] = iso_map_at(&triangulation.link.map[1], a);
    }
    CHECK_OK(iso_triangulation_new(&again, size, theta, phi, 3, triangulation.link.g));
    CHECK_OK(iso_double_link_from_triangulation(&back, &again));
    CHECK(same_maps(&surface.link, &back.link));
    CHECK(memcmp(surface.link.g, back.link.g, (size_t)size * 24) == 0);
    CHECK_EQUAL(126, back.link.projection[0].range);
    CHECK_EQUAL(63, back.link.projection[1].range);
    for (int32_t a = 0; a < size;
         a++) { /* orbits number in the order of the corners: faces do too */
        CHECK_EQUAL(iso_double_link_face(&surface, a), iso_double_link_face(&back, a));
        CHECK((iso_double_link_vertex(&back, a) == iso_double_link_vertex(&back, 0)) ==
              (s.vertex[a] == s.vertex[0]));
    }
    free(theta);
    free(phi);
    iso_multilink_free(&surface.link);
    iso_multilink_free(&back.link);
    iso_multilink_free(&triangulation.link);
    iso_multilink_free(&again.link);
}

/* 12 by 7 squares; with a shift the second axis closes three squares further on the first. */
static void test_square_patch_of_a_torus(void) {
    for (int shift = 0; shift < 4; shift += 3) {
        int32_t alpha[84], beta[84];
        double g[84];
        iso_square_link torus;
        iso_square_patch patch;
        iso_double_link surface, direct;
        iso_surface_counts counts;
        for (int32_t a = 0; a < 84; a++) {
            alpha[a] = a / 12 * 12 + (a + 1) % 12;
            beta[a] = (a + 12) % 84;
            beta[a] = beta[a] / 12 * 12 + (beta[a] + shift) % 12;
            g[a] = a;
        }
        if (!CHECK_OK(iso_square_link_new(&torus, 84, alpha, beta, 1, g)))
            return;
        CHECK_OK(iso_square_patch_from_square_link(&patch, &torus));
        CHECK_EQUAL(4 * 84, patch.link.size);
        CHECK_EQUAL(84, orbit_count(&patch.link, "θ"));
        CHECK_EQUAL(84, orbit_count(&patch.link, "φ"));
        CHECK_OK(iso_double_link_from_square_patch(&surface, &patch));
        CHECK_OK(iso_double_link_count(&counts, &surface));
        CHECK(counts.faces == 84 && counts.vertices == 84 && counts.edges == 168);
        CHECK_EQUAL(0, counts.euler);
        CHECK_OK(iso_double_link_from_square_link(&direct, &torus, ISO_BOUNDARY_REFUSED));
        CHECK(same_maps(&surface.link, &direct.link)); /* found by the formula and by the edges */
        CHECK(memcmp(surface.link.g, direct.link.g, sizeof(double) * 4 * 84) == 0);
        iso_multilink_free(&torus.link);
        iso_multilink_free(&patch.link);
        iso_multilink_free(&surface.link);
        iso_multilink_free(&direct.link);
    }
}

/* The full box commutes; with voxels left out and steps that stay before a void it does not. */
static void test_cubic_link(void) {
    const iso_axis axis[3] = {{5, 0}, {4, 0}, {3, 0}};
    int32_t material[60];
    uint64_t state = 3;
    iso_cubic_link box;
    for (int i = 0; i < 60; i++)
        material[i] = next_random(&state) % 5 < 3;
    if (!CHECK_OK(iso_cubic_link_box(&box, axis, 0, NULL, material)))
        return;
    CHECK_EQUAL(60, box.link.size);
    CHECK_EQUAL(2, box.link.projection[0].range);
    for (int z = 0; z < 3; z++)
        for (int y = 0; y < 4; y++)
            for (int x = 0; x < 5; x++) {
                int32_t a = x + 5 * (y + 4 * z);
                CHECK_EQUAL(x < 4 ? a + 1 : a, iso_map_at(&box.link.map[0], a));
                CHECK_EQUAL(y < 3 ? a + 5 : a, iso_map_at(&box.link.map[1], a));
                CHECK_EQUAL(z < 2 ? a + 20 : a, iso_map_at(&box.link.map[2], a));
                CHECK_EQUAL(material[a], iso_map_at(&box.link.projection[0], a));
            }
    CHECK_EQUAL(1, orbit_count(&box.link, "α β γ"));
    CHECK_EQUAL(12, orbit_count(&box.link, "α"));

    int32_t sparse[3][60];
    iso_multilink view = iso_multilink_view(ISO_KIND_CUBIC_LINK, 60, 0, 0, NULL);
    for (int i = 0; i < 3; i++) {
        for (int32_t a = 0; a < 60; a++) {
            int32_t next = iso_map_at(&box.link.map[i], a);
            sparse[i][a] = material[a] && material[next] ? next : a;
        }
        iso_map_store(&view.map[i], sparse[i], 60);
    }
    CHECK_STATUS(ISO_NOT_VERIFIED, iso_multilink_validate(&view));
    CHECK(says("cubic-link: αβ = βα fails at index "));
    iso_multilink_free(&box.link);

    material[7] = -1;
    CHECK_STATUS(ISO_USAGE, iso_cubic_link_box(&box, axis, 0, NULL, material));
    CHECK(says("material -1 at index 7"));
    const iso_axis huge[3] = {{2000, 0}, {2000, 0}, {2000, 0}}, flat[3] = {{2, 0}, {0, 0}, {2, 0}};
    CHECK_STATUS(ISO_OUTSIDE, iso_cubic_link_box(&box, huge, 0, NULL, NULL));
    CHECK_STATUS(ISO_USAGE, iso_cubic_link_box(&box, flat, 0, NULL, NULL));
    CHECK(says("axis 1 of the lattice has length 0"));
}

static void test_4_cube_link(void) {
    const iso_axis axis[4] = {{3, 0}, {2, 1}, {4, 0}, {5, 1}};
    double g[120 * 4];
    for (int32_t a = 0, rest = 0; a < 120; a++, rest = a)
        for (int k = 0; k < 4; rest /= axis[k++].length)
            g[4 * a + k] = rest % axis[k].length;
    iso_cube_link link;
    if (!CHECK_OK(iso_cube_link_box(&link, 4, axis, 4, g, NULL)))
        return;
    CHECK_EQUAL(120, link.link.size);
    CHECK_EQUAL(4, link.link.map_count);
    CHECK(strcmp(link.link.map[3].name, "α₄") == 0);
    for (int32_t a = 0; a < 120; a++)
        for (int k = 0; k < 4; k++) { /* a step changes the one coordinate that g says */
            int32_t b = iso_map_at(&link.link.map[k], a);
            for (int i = 0; i < 4; i++) {
                int x = (int)g[4 * a + i], end = axis[i].length - 1;
                int moved = x < end ? x + 1 : axis[i].wraps ? 0 : x;
                CHECK_EQUAL(i == k ? moved : x, (int)link.link.g[4 * b + i]);
            }
        }
    CHECK_EQUAL(1, orbit_count(&link.link, "α₁ α₂ α₃ α₄"));
    CHECK_EQUAL(15, orbit_count(&link.link, "α₂ α₃"));
    CHECK_OK(iso_multilink_check_bijective(&link.link, "α₂α₄"));
    CHECK_STATUS(ISO_NOT_VERIFIED, iso_multilink_check_bijective(&link.link, "α₁α₂"));
    iso_multilink_free(&link.link);
    CHECK_STATUS(ISO_USAGE, iso_cube_link_box(&link, 9, axis, 0, NULL, NULL));
    CHECK_STATUS(ISO_USAGE, iso_cube_link_box(&link, 0, axis, 0, NULL, NULL));
}

/* The fill module's own structure and the general one mean the same. */
static void test_filling_link(void) {
    int32_t arc[8] = {2, 4, 0, 6, 1, 7, 3, 5}, line[4] = {0, 0, 1, 1}, contour[4] = {0};
    iso_fill_link fill = {4, 2, 1, arc, line, contour};
    iso_filling_link link;
    CHECK_OK(iso_fill_link_validate(&fill));
    if (!CHECK_OK(iso_filling_link_new(&link, 4, arc, line, contour)))
        return;
    for (int32_t d = 0; d < 8; d++) {
        CHECK_EQUAL(iso_fill_link_across(d), iso_map_at(&link.link.map[0], d));
        CHECK_EQUAL(iso_fill_link_other_side(d), iso_map_at(&link.link.map[1], d));
        CHECK_EQUAL(arc[d], iso_map_at(&link.link.map[2], d));
        CHECK_EQUAL(line[d / 2], iso_map_at(&link.link.projection[0], d));
    }
    CHECK_EQUAL(3, orbit_count(&link.link, "r g")); /* below, between, above: a square's strips */
    CHECK_EQUAL(1, orbit_count(&link.link, "r s g"));
    iso_multilink_free(&link.link);
    arc[2] = 2;
    CHECK_STATUS(ISO_NOT_VERIFIED, iso_filling_link_new(&link, 4, arc, line, contour));
    CHECK(says("g² = 1 fails at index 0: 2 and 0"));
}

static void test_digraphs(void) {
    int32_t successor[64], domain[64], codomain[64];
    uint64_t state = 11;
    for (int turn = 0; turn < 200; turn++) { /* a permutation of edge ends is balanced */
        int vertices = 1 + (int)(next_random(&state) % 9), edges = (int)(next_random(&state) % 64);
        int seen[64] = {0};
        for (int e = 0; e < edges; e++)
            domain[e] = codomain[e] = (int32_t)(next_random(&state) % (unsigned)vertices);
        for (int e = edges - 1; e > 0; e--) {
            int k = (int)(next_random(&state) % (unsigned)(e + 1));
            int32_t kept = codomain[e];
            codomain[e] = codomain[k];
            codomain[k] = kept;
        }
        if (!CHECK_OK(iso_link_digraph(successor, edges, vertices, domain, codomain)))
            return;
        for (int e = 0; e < edges; e++) {
            CHECK_EQUAL(codomain[e], domain[successor[e]]);
            CHECK_EQUAL(1, ++seen[successor[e]]);
        }
    }
    int32_t from[5] = {0, 1, 2, 2, 3}, to[5] = {1, 2, 0, 3, 2};
    CHECK_OK(iso_link_digraph(successor, 5, 4, from, to));
    to[1] = 3;
    CHECK_STATUS(ISO_USAGE, iso_link_digraph(successor, 5, 4, from, to));
    CHECK(says("1 edges arrive at vertex 2, 2 leave"));
    to[1] = 4;
    CHECK_STATUS(ISO_USAGE, iso_link_digraph(successor, 5, 4, from, to));
    CHECK(says("edge 1 of the digraph runs from 1 to 4; vertices are 0 .. 3"));
}

static void test_slices_to_link(void) {
    int32_t level_first[4] = {0, 1, 1, 3};
    int64_t contour_first[4] = {0, 3, 6, 10};
    double cut[3] = {0.5, 1.5, 2.5};
    iso_vec2 point[10];
    for (int i = 0; i < 10; i++)
        point[i] = (iso_vec2){i, -i};
    iso_slices slices = {3, 3, 10, level_first, contour_first, point};
    iso_levels levels = {3, cut, cut, cut};
    static const int32_t successor[10] = {1, 2, 0, 4, 5, 3, 7, 8, 9, 6};
    iso_coloured_link link;
    for (int deep = 0; deep < 2; deep++) {
        if (!CHECK_OK(iso_slices_to_link(&link, &slices, deep ? &levels : NULL)))
            return;
        CHECK_EQUAL(2 + deep, link.link.dimension);
        CHECK_EQUAL(3, link.link.projection[0].range);
        CHECK_EQUAL(3, orbit_count(&link.link, "φ"));
        for (int i = 0; i < 10; i++) {
            const double *at = link.link.g + i * (2 + deep);
            CHECK_EQUAL(successor[i], iso_map_at(&link.link.map[0], i));
            CHECK_EQUAL(i < 3 ? 0 : 2, iso_map_at(&link.link.projection[0], i));
            CHECK(at[0] == i && at[1] == -i && (!deep || at[2] == (i < 3 ? 0.5 : 2.5)));
        }
        iso_multilink_free(&link.link);
    }
    levels.count = 2;
    CHECK_STATUS(ISO_USAGE, iso_slices_to_link(&link, &slices, &levels));
    iso_slices none = {0};
    CHECK_OK(iso_slices_to_link(&link, &none, NULL));
    CHECK_EQUAL(0, link.link.size);
    iso_multilink_free(&link.link);
}

static void test_nothing_at_all(void) {
    iso_link link;
    iso_square_link squares;
    iso_square_patch patch;
    iso_double_link surface, back;
    iso_triangulation triangulation;
    iso_coloured_link contours;
    iso_filling_link filling;
    iso_surface_counts counts;
    const iso_faces none = {.dimension = 3};
    CHECK_OK(iso_link_digraph(NULL, 0, 0, NULL, NULL));
    CHECK_OK(iso_link_new(&link, 0, NULL, 3, NULL));
    CHECK_OK(iso_multilink_check_bijective(&link.link, "φ"));
    CHECK_OK(iso_square_link_new(&squares, 0, NULL, NULL, 3, NULL));
    CHECK_OK(iso_square_patch_from_square_link(&patch, &squares));
    CHECK_OK(iso_double_link_from_square_link(&surface, &squares, ISO_BOUNDARY_FANNED));
    iso_multilink_free(&surface.link);
    CHECK_OK(iso_double_link_from_faces(&surface, &none, ISO_BOUNDARY_REFUSED));
    CHECK_OK(iso_triangulation_from_double_link(&triangulation, &surface));
    CHECK_OK(iso_double_link_from_triangulation(&back, &triangulation));
    CHECK_OK(iso_double_link_count(&counts, &back));
    CHECK(counts.faces == 0 && counts.parts == 0 && counts.euler == 0);
    CHECK_OK(iso_slice_double_link(&contours, &surface, NULL, NULL, 0));
    CHECK_OK(iso_filling_link_new(&filling, 0, NULL, NULL, NULL));
    iso_multilink_free(&link.link);
    iso_multilink_free(&squares.link);
    iso_multilink_free(&patch.link);
    iso_multilink_free(&surface.link);
    iso_multilink_free(&back.link);
    iso_multilink_free(&triangulation.link);
    iso_multilink_free(&contours.link);
    iso_multilink_free(&filling.link);
}

static void test_memory_that_runs_out(void) {
    int32_t from[5] = {0, 1, 2, 2, 3}, to[5] = {1, 2, 0, 3, 2}, successor[5];
    const iso_axis axis[2] = {{4, 1}, {3, 1}};
    double g[12] = {0};
    iso_status status = ISO_NO_MEMORY;
    for (int n = 0; n < 60 && status == ISO_NO_MEMORY; n++) {
        iso_square_link torus = {0};
        iso_square_patch patch = {0};
        iso_double_link surface = {0}, again = {0};
        iso_surface_counts counts;
        iso_fail_allocation_after(n);
        status = iso_link_digraph(successor, 5, 4, from, to);
        if (status == ISO_OK)
            status = iso_square_link_box(&torus, axis, 1, g);
        if (status == ISO_OK)
            status = iso_square_patch_from_square_link(&patch, &torus);
        if (status == ISO_OK)
            status = iso_double_link_from_square_patch(&surface, &patch);
        if (status == ISO_OK)
            status = iso_double_link_from_square_link(&again, &torus, ISO_BOUNDARY_FANNED);
        if (status == ISO_OK)
            status = iso_double_link_count(&counts, &again);
        iso_fail_allocation_after(-1);
        CHECK(status == ISO_OK || status == ISO_NO_MEMORY);
        iso_multilink_free(&torus.link);
        iso_multilink_free(&patch.link);
        iso_multilink_free(&surface.link);
        iso_multilink_free(&again.link);
    }
    CHECK_EQUAL(ISO_OK, status);
}

int main(void) {
    RUN(test_link_of_a_circle);
    RUN(test_cylinder);
    RUN(test_tetrahedron);
    RUN(test_triangulation_and_back);
    RUN(test_square_patch_of_a_torus);
    RUN(test_cubic_link);
    RUN(test_4_cube_link);
    RUN(test_filling_link);
    RUN(test_digraphs);
    RUN(test_slices_to_link);
    RUN(test_nothing_at_all);
    RUN(test_memory_that_runs_out);
    return check_verdict();
}

/* Break each equation of each kind once, and read what the validator says. */
#include "check.h"

#include <math.h>
#include <stdlib.h>

#include <isoslice/link.h>

#include "link/surfaces.h"

/* ISO_NOT_VERIFIED with exactly this message. */
static void check_says(const iso_multilink *link, const char *message) {
    CHECK_STATUS(ISO_NOT_VERIFIED, iso_multilink_validate(link));
    if (!CHECK(strcmp(iso_error_message(), message) == 0))
        fprintf(stderr, "  it says: %s\n  and not: %s\n", iso_error_message(), message);
}

static void set_image(iso_map *map, const int32_t *image, int32_t range) {
    iso_map_store(map, image, range);
}

static void test_coloured_link(void) {
    int32_t phi[5] = {1, 2, 0, 4, 3}, c[5] = {0, 0, 0, 1, 1};
    iso_multilink view = iso_multilink_view(ISO_KIND_COLOURED_LINK, 5, 0, 0, NULL);
    set_image(&view.map[0], phi, 5);
    set_image(&view.projection[0], c, 2);
    CHECK_OK(iso_multilink_validate(&view));
    c[4] = 0;
    check_says(&view, "coloured link: cφ = c fails at index 3: 0 and 1");
}

/* x and y don't commute: xy(0) = 1, yx(0) = 0. All other maps are the identity, so that the one
 * equation fails and no other. */
static void test_kinds_that_commute(void) {
    static const int32_t one[3] = {0, 1, 2}, x[3] = {1, 2, 2}, y[3] = {0, 0, 2};
    static const struct {
        iso_link_kind kind;
        const char *name, *map[8];
        int maps;
    } row[] = {
        {ISO_KIND_SQUARE_LINK, "square-link", {"α", "β"}, 2},
        {ISO_KIND_CUBIC_LINK, "cubic-link", {"α", "β", "γ"}, 3},
        {ISO_KIND_CUBE_LINK, "n-cube-link", {"α₁", "α₂", "α₃", "α₄"}, 4},
        {ISO_KIND_CUBE_LINK, "n-cube-link", {"α₁", "α₂", "α₃", "α₄", "α₅", "α₆", "α₇", "α₈"}, 8},
    };
    for (size_t k = 0; k < sizeof row / sizeof *row; k++)
        for (int i = 0; i < row[k].maps; i++)
            for (int j = i + 1; j < row[k].maps; j++) {
                iso_multilink view = iso_multilink_view(row[k].kind, 3, row[k].maps, 0, NULL);
                CHECK_EQUAL(row[k].maps, view.map_count);
                for (int m = 0; m < row[k].maps; m++)
                    set_image(&view.map[m], one, 3);
                CHECK_OK(iso_multilink_validate(&view));
                set_image(&view.map[i], x, 3);
                set_image(&view.map[j], y, 3);
                char expected[128];
                const char *p = row[k].map[i], *q = row[k].map[j];
                snprintf(expected, sizeof expected, "%s: %s%s = %s%s fails at index 0: 1 and 0",
                         row[k].name, p, q, q, p);
                check_says(&view, expected);
            }
}

/* One more step of φ than of its inverse: exchange two images, which keeps it a bijection. */
static void exchange(int32_t *map, int32_t a, int32_t b) {
    int32_t kept = map[a];
    map[a] = map[b];
    map[b] = kept;
}

static void test_triangulation(void) {
    int32_t theta[12], phi[12];
    double g[12];
    static polyhedron s;
    iso_double_link tetrahedron;
    make_tetrahedron(&s);
    if (!CHECK_OK(iso_double_link_from_faces(&tetrahedron, &s.faces, ISO_BOUNDARY_REFUSED)))
        return;
    for (int32_t a = 0; a < 12; a++) {
        theta[a] = iso_double_link_alpha(&tetrahedron, a);
        phi[a] = iso_double_link_beta(&tetrahedron, a);
        g[a] = iso_double_link_vertex(&tetrahedron, a);
    }
    iso_multilink_free(&tetrahedron.link);
    iso_multilink view = iso_multilink_view(ISO_KIND_TRIANGULATION, 12, 0, 1, g);
    set_image(&view.map[0], theta, 12);
    set_image(&view.map[1], phi, 12);
    CHECK_OK(iso_multilink_validate(&view));

    exchange(theta, 0, 3); /* one orbit of six */
    check_says(&view, "triangulation: θ³ = 1 fails at index 0: 3 and 0");
    exchange(theta, 0, 3);

    int32_t kept = phi[5];
    phi[5] = 5;
    CHECK_STATUS(ISO_NOT_VERIFIED, iso_multilink_validate(&view));
    CHECK(strstr(iso_error_message(), "triangulation: θ² = φθφ fails at index ") != NULL);
    phi[5] = kept;

    g[7] = 9;
    CHECK_STATUS(ISO_NOT_VERIFIED, iso_multilink_validate(&view));
    CHECK(strstr(iso_error_message(), "triangulation: gφ = g fails at index ") != NULL);
    CHECK(strstr(iso_error_message(), "coordinate 0 is ") != NULL);
    g[7] = NAN;
    check_says(&view, "triangulation: g is not finite at index 7, coordinate 0");
}

/* The torus of one square: all four corners are one point. */
static void test_square_patch(void) {
    int32_t theta[4] = {1, 2, 3, 0}, phi[4] = {1, 2, 3, 0};
    double g[8] = {5, 6, 5, 6, 5, 6, 5, 6};
    iso_multilink view = iso_multilink_view(ISO_KIND_SQUARE_PATCH, 4, 0, 2, g);
    set_image(&view.map[0], theta, 4);
    set_image(&view.map[1], phi, 4);
    CHECK_OK(iso_multilink_validate(&view));
    exchange(theta, 0, 1); /* 0 -> 2 -> 3 -> 0 and 1 fixed */
    check_says(&view, "square patch: θ⁴ = 1 fails at index 0: 2 and 0");
    exchange(theta, 0, 1);
    phi[0] = 0;
    check_says(&view, "square patch: θ³ = φθφ fails at index 0: 3 and 2");
    phi[0] = 1;
    g[5] = 7;
    check_says(&view, "square patch: gφ = g fails at index 1: coordinate 1 is 7 and 6");
}

static void test_double_link(void) {
    int32_t alpha[12], beta[12], f[12], v[12];
    double g[36];
    static polyhedron s;
    iso_double_link from;
    make_tetrahedron(&s);
    if (!CHECK_OK(iso_double_link_from_faces(&from, &s.faces, ISO_BOUNDARY_REFUSED)))
        return;
    for (int32_t a = 0; a < 12; a++) {
        alpha[a] = iso_double_link_alpha(&from, a);
        beta[a] = iso_double_link_beta(&from, a);
        f[a] = iso_double_link_face(&from, a);
        v[a] = iso_double_link_vertex(&from, a);
    }
    memcpy(g, from.link.g, sizeof g);
    iso_multilink_free(&from.link);
    iso_multilink view = iso_multilink_view(ISO_KIND_DOUBLE_LINK, 12, 0, 3, g);
    set_image(&view.map[0], alpha, 12);
    set_image(&view.map[1], beta, 12);
    set_image(&view.projection[0], f, 4);
    set_image(&view.projection[1], v, 4);
    CHECK_OK(iso_multilink_validate(&view));

    for (int32_t a = 0; a < 12; a++) {
        int32_t kept = beta[a];
        beta[a] = (kept + 5) % 12;
        CHECK_STATUS(ISO_NOT_VERIFIED, iso_multilink_validate(&view));
        CHECK(strstr(iso_error_message(), "double-link: αβαβ = 1 fails at index ") != NULL);
        beta[a] = kept;
    }
    f[4] = 3; /* dart 3 comes before it in face 1 */
    check_says(&view, "double-link: fα = f fails at index 3: 3 and 1");
    f[4] = 1;
    v[0] = 2;
    CHECK_STATUS(ISO_NOT_VERIFIED, iso_multilink_validate(&view));
    char expected[128];
    int32_t before = 0; /* the first dart whose turn leads to or from dart 0 */
    while (beta[before] != 0 && before != 0)
        before++;
    snprintf(expected, sizeof expected, "double-link: vβ = v fails at index %d: 0 and 2", before);
    check_says(&view, expected);
    v[0] = 0;
    g[3 * beta[0] + 2] = 8;
    check_says(&view, "double-link: gβ = g fails at index 0: coordinate 2 is 8 and 0");
}

static void test_double_link_fixed_points(void) {
    int32_t one[2] = {0, 1}, other[2] = {1, 0}, zero[2] = {0, 0};
    iso_multilink view = iso_multilink_view(ISO_KIND_DOUBLE_LINK, 2, 0, 0, NULL);
    set_image(&view.map[0], one, 2);
    set_image(&view.map[1], other, 2);
    set_image(&view.projection[0], zero, 1);
    set_image(&view.projection[1], zero, 1);
    check_says(&view, "double-link: α ≠ 1 fails at index 0: 0 and 0");
    set_image(&view.map[0], other, 2);
    check_says(&view, "double-link: βα ≠ 1 fails at index 0: 0 and 0");
    set_image(&view.map[1], one, 2);
    CHECK_OK(iso_multilink_validate(&view)); /* one edge on the sphere, a face either side */
}

/* Two crossings on each of two lines of a square: darts 2 c + side. */
static void test_filling_link(void) {
    int32_t r[8] = {2, 3, 0, 1, 6, 7, 4, 5}, s[8] = {1, 0, 3, 2, 5, 4, 7, 6};
    int32_t g[8] = {2, 4, 0, 6, 1, 7, 3, 5};
    int32_t q[8] = {0, 0, 0, 0, 1, 1, 1, 1}, p[8] = {0};
    iso_multilink view = iso_multilink_view(ISO_KIND_FILLING_LINK, 8, 0, 0, NULL);
    set_image(&view.map[0], r, 8);
    set_image(&view.map[1], s, 8);
    set_image(&view.map[2], g, 8);
    set_image(&view.projection[0], q, 2);
    set_image(&view.projection[1], p, 2);
    CHECK_OK(iso_multilink_validate(&view));
    r[0] = 1;
    check_says(&view, "contour-filling link: r² = 1 fails at index 0: 3 and 0");
    r[0] = 2;
    s[7] = 5;
    check_says(&view, "contour-filling link: s² = 1 fails at index 6: 5 and 6");
    s[7] = 6;
    g[5] = 5;
    check_says(&view, "contour-filling link: g² = 1 fails at index 7: 5 and 7");
    g[5] = 7;
    q[4] = 0;
    check_says(&view, "contour-filling link: qr = q fails at index 4: 1 and 0");
    q[6] = 0; /* now r keeps q, and s does not */
    check_says(&view, "contour-filling link: qs = q fails at index 4: 1 and 0");
    q[4] = q[6] = 1;
    p[3] = 1;
    check_says(&view, "contour-filling link: pg = p fails at index 3: 0 and 1");
}

static void test_shapes(void) {
    int32_t phi[4] = {1, 2, 3, 0};
    double g[4] = {0, 1, 2, INFINITY};
    iso_multilink view = iso_multilink_view(ISO_KIND_LINK, 4, 0, 0, NULL);
    check_says(&view, "link: the range of φ is 0; an endomap's is the size, 4");
    set_image(&view.map[0], NULL, 4);
    check_says(&view, "link: φ is stored but has no image");
    set_image(&view.map[0], phi, 4);
    CHECK_OK(iso_multilink_validate(&view));
    phi[2] = 4;
    check_says(&view, "link: φ takes index 2 to 4, outside 0 .. 3");
    phi[2] = -1;
    check_says(&view, "link: φ takes index 2 to -1, outside 0 .. 3");
    iso_map_step(&view.map[0], ISO_MAP_CYCLIC, 1, 3, 4);
    check_says(&view, "link: the axis of φ (stride 1, length 3) does not fit size 4");
    iso_map_step(&view.map[0], ISO_MAP_COORDINATE, 1, 4, 4);
    check_says(&view, "link: φ has rule 3, stride 1, length 4, which is no step along an axis");
    iso_map_step(&view.map[0], ISO_MAP_CYCLIC, 0, 4, 4);
    CHECK_STATUS(ISO_NOT_VERIFIED, iso_multilink_validate(&view));
    iso_map_step(&view.map[0], ISO_MAP_CYCLIC, 1 << 30, 1 << 30, 4);
    CHECK_STATUS(ISO_NOT_VERIFIED, iso_multilink_validate(&view));
    iso_map_step(&view.map[0], ISO_MAP_CYCLIC, 1, 4, 4);
    CHECK_OK(iso_multilink_validate(&view));
    view.dimension = 1;
    check_says(&view, "link: g of dimension 1 has no array");
    view.g = g;
    check_says(&view, "link: g is not finite at index 3, coordinate 0");
    view.dimension = 0;
    iso_map_step(iso_multilink_add_projection(&view, "row"), ISO_MAP_COORDINATE, 1, 4, 3);
    check_says(&view, "link: row has 4 places on its axis, more than its range 3");
    for (int i = 0; i < 9; i++)
        iso_map_step(iso_multilink_add_projection(&view, "x"), ISO_MAP_COORDINATE, 1, 1, 1);
    check_says(&view, "link: 10 projections; it has 0 to 8");
    view = iso_multilink_view(ISO_KIND_CUBE_LINK, 4, 9, 0, NULL);
    check_says(&view, "n-cube-link: 9 maps; it has 1 to 8");
    view = iso_multilink_view((iso_link_kind)77, 4, 9, 0, NULL);
    check_says(&view, "there is no kind 77 of multi-link");
}

static void test_long_names_end_at_a_character(void) {
    iso_multilink view = iso_multilink_view(ISO_KIND_LINK, 0, 0, 0, NULL);
    const iso_map *map = iso_multilink_add_projection(&view, "ααααααααα");
    CHECK_EQUAL(14, strlen(map->name));
    map = iso_multilink_add_projection(&view, "a name that is too long");
    CHECK_EQUAL(15, strlen(map->name));
}

static void test_words(void) {
    int32_t phi[4] = {1, 2, 2, 0}, orbit[4], count;
    iso_multilink view = iso_multilink_view(ISO_KIND_LINK, 4, 0, 0, NULL);
    set_image(&view.map[0], phi, 4);
    CHECK_STATUS(ISO_USAGE, iso_multilink_orbits(orbit, &count, &view, "β"));
    CHECK(strcmp(iso_error_message(), "\"β\" is no word in the maps of a link") == 0);
    CHECK_STATUS(ISO_USAGE, iso_multilink_orbits(orbit, &count, &view, "φx"));
    CHECK_STATUS(ISO_USAGE, iso_multilink_orbits(orbit, &count, &view, "φ⁴φ⁴φ"));
    CHECK_STATUS(ISO_USAGE, iso_multilink_orbits(orbit, &count, &view, "gφ"));
    CHECK_OK(iso_multilink_orbits(orbit, &count, &view, ""));
    CHECK_EQUAL(4, count);
    CHECK_OK(iso_multilink_orbits(orbit, &count, &view, " 1  1 "));
    CHECK_EQUAL(4, count);
    CHECK_OK(iso_multilink_orbits(orbit, &count, &view, "φ"));
    CHECK_EQUAL(1, count);
    CHECK_STATUS(ISO_NOT_VERIFIED, iso_multilink_check_bijective(&view, "φ"));
    CHECK(strcmp(iso_error_message(), "link: φ is no bijection: it takes 1 and 2 to 2") == 0);
    phi[2] = 3;
    CHECK_OK(iso_multilink_check_bijective(&view, "φ"));
    CHECK_OK(iso_multilink_orbits(orbit, &count, &view, "φ²"));
    CHECK_EQUAL(2, count);
    CHECK(orbit[0] == 0 && orbit[1] == 1 && orbit[2] == 0 && orbit[3] == 1);
}

int main(void) {
    RUN(test_coloured_link);
    RUN(test_kinds_that_commute);
    RUN(test_triangulation);
    RUN(test_square_patch);
    RUN(test_double_link);
    RUN(test_double_link_fixed_points);
    RUN(test_filling_link);
    RUN(test_shapes);
    RUN(test_long_names_end_at_a_character);
    RUN(test_words);
    return check_verdict();
}

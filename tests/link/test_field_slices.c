/* Surfaces of quadrangles and other convex faces, cut by fields. */
#include "check.h"

#include "base/memory.h"
#include "link/surfaces.h"
#include "slice/fields.h"

#include <isoslice/link.h>

#include <stdlib.h>

/* A torus (tube 4, ring 10) or a sphere without its caps turned about z, of n m quadrangles. */
static void make_quads(iso_double_link *surface, int n, int m) {
    int32_t faces = n * m;
    int32_t *first = malloc(((size_t)faces + 1) * sizeof *first);
    int32_t *vertex = malloc((size_t)faces * 4 * sizeof *vertex);
    double *position = malloc((size_t)faces * 3 * sizeof *position);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < m; j++) {
            int32_t at = i * m + j, right = (i + 1) % n * m + j;
            int32_t up = i * m + (j + 1) % m, both = (i + 1) % n * m + (j + 1) % m;
            double u = 2 * SHAPE_PI * i / n, w = 2 * SHAPE_PI * (j + 0.3) / m;
            double far = 10 + 4 * cos(w);
            first[at] = 4 * at;
            vertex[4 * at] = at, vertex[4 * at + 1] = right;
            vertex[4 * at + 2] = both, vertex[4 * at + 3] = up;
            position[3 * at] = far * cos(u), position[3 * at + 1] = far * sin(u);
            position[3 * at + 2] = 4 * sin(w);
        }
    first[faces] = 4 * faces;
    iso_faces f = {faces, faces, first, vertex, 3, position};
    CHECK_OK(iso_double_link_from_faces(surface, &f, ISO_BOUNDARY_REFUSED));
    free(first), free(vertex), free(position);
}

static iso_vec3 point(const iso_multilink *link, int32_t i) {
    return (iso_vec3){link->g[3 * i], link->g[3 * i + 1], link->g[3 * i + 2]};
}

/* Every crossing on its level and its edge; orbits close, by the validator and again here. Returns
 * the area of all contours seen from above. */
static double check_contours(const iso_coloured_link *c, const iso_double_link *surface,
                             const test_field *f, const double *level, int32_t *orbits) {
    const iso_multilink *link = &c->link;
    double area = 0;
    CHECK_OK(iso_multilink_validate(link));
    CHECK_OK(iso_multilink_check_bijective(link, "φ"));
    int32_t *orbit = malloc((size_t)(link->size + 1) * sizeof *orbit);
    CHECK_OK(iso_multilink_orbits(orbit, orbits, link, "φ"));
    free(orbit);
    for (int32_t i = 0; i < link->size; i++) {
        int32_t next = iso_map_at(&link->map[0], i), dart = iso_map_at(&link->projection[1], i);
        int32_t end = iso_double_link_alpha(surface, dart);
        iso_vec3 p = point(link, i), q = point(link, next);
        iso_vec3 a = point(&surface->link, dart), b = point(&surface->link, end);
        double length = sqrt(pow(b.x - a.x, 2) + pow(b.y - a.y, 2) + pow(b.z - a.z, 2));
        double before = sqrt(pow(p.x - a.x, 2) + pow(p.y - a.y, 2) + pow(p.z - a.z, 2));
        double after = sqrt(pow(p.x - b.x, 2) + pow(p.y - b.y, 2) + pow(p.z - b.z, 2));
        CHECK_NEAR(length, before + after, 1e-9);
        CHECK_NEAR(level[iso_map_at(&link->projection[0], i)], test_value(f, p), 1e-6);
        area += (p.x * q.y - p.y * q.x) / 2;
    }
    return area;
}

/* Cylinders across the tube and a cone round the axis. */
static void test_quads(void) {
    double error[3];
    for (int k = 0; k < 3; k++) {
        iso_double_link surface;
        iso_coloured_link c;
        int32_t orbits, n = 32 << k;
        make_quads(&surface, 2 * n, n);
        /* z + rho / 2 = 6: two circles; with rho = 10 + 4 cos w, 4 sin w + 2 cos w = 1 */
        test_field cone = test_cone(0, 0, 0.5);
        double level[] = {6};
        if (CHECK_OK(iso_slice_double_link_field(&c, &surface, &cone.field, level, 1))) {
            double phase = atan2(2, 4), w = asin(1 / sqrt(20.0)), area = 0;
            for (int i = 0; i < 2; i++) {
                double angle = (i ? SHAPE_PI - w : w) - phase, rho = 10 + 4 * cos(angle);
                area += (i ? -1 : 1) * SHAPE_PI * rho * rho;
            }
            double found = check_contours(&c, &surface, &cone, level, &orbits);
            CHECK_EQUAL(2, orbits);
            error[k] = fabs(found - area);
            iso_multilink_free(&c.link);
        }
        iso_multilink_free(&surface.link);
    }
    printf("  errors %.3g %.3g %.3g mm^2\n", error[0], error[1], error[2]);
    CHECK_NEAR(2, log2(error[0] / error[2]) / 2, 0.3);
}

/* By a plane the field's slices are those of its heights. */
static void test_heights_and_field(void) {
    polyhedron s;
    iso_double_link surface;
    iso_coloured_link c[2];
    test_field f = test_plane(0.48, 0.6, 0.64);
    double level[] = {-1.1, -0.3, 0.2, 0.9}, height[60];
    make_dodecahedron(&s);
    CHECK_OK(iso_double_link_from_faces(&surface, &s.faces, ISO_BOUNDARY_REFUSED));
    for (int32_t a = 0; a < 60; a++)
        height[a] = test_value(&f, point(&surface.link, a));
    if (CHECK_OK(iso_slice_double_link(&c[0], &surface, height, level, 4)) &&
        CHECK_OK(iso_slice_double_link_field(&c[1], &surface, &f.field, level, 4))) {
        int32_t orbits;
        check_contours(&c[1], &surface, &f, level, &orbits);
        CHECK_EQUAL(4, orbits);
        CHECK_EQUAL(c[0].link.size, c[1].link.size);
        for (int32_t i = 0; i < c[0].link.size; i++) {
            CHECK_EQUAL(iso_map_at(&c[0].link.map[0], i), iso_map_at(&c[1].link.map[0], i));
            CHECK_NEAR(c[0].link.g[3 * i], c[1].link.g[3 * i], 1e-9);
        }
        iso_multilink_free(&c[0].link);
        iso_multilink_free(&c[1].link);
    }
    /* a ball's level crosses each face's edges twice: where that is so, the face is named */
    test_field ball = test_round(0, 0, 0, (iso_vec3){1, 1, 1});
    double close[] = {1.6};
    CHECK_STATUS(ISO_UNSLICEABLE,
                 iso_slice_double_link_field(&c[0], &surface, &ball.field, close, 1));
    CHECK(strstr(iso_error_message(), "face 0") != NULL);
    double inside[] = {0.2}, beyond[] = {3.5};
    for (int k = 0; k < 2; k++)
        if (CHECK_OK(iso_slice_double_link_field(&c[0], &surface, &ball.field, k ? beyond : inside,
                                                 1))) {
            CHECK_EQUAL(0, c[0].link.size);
            iso_multilink_free(&c[0].link);
        }
    iso_multilink_free(&surface.link);
}

/* A loop inside one face of a cube, which none of its edges tells of. */
static void test_hidden_loop(void) {
    static const int32_t vertex[] = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4,
                                     2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
    int32_t first[7];
    double position[24], level[] = {2};
    iso_double_link surface;
    iso_coloured_link c;
    for (int i = 0; i < 7; i++)
        first[i] = 4 * i;
    for (int i = 0; i < 24; i++)
        position[i] = i / 3 >> i % 3 & 1 ? 10 : -10;
    iso_faces f = {6, 8, first, vertex, 3, position};
    CHECK_OK(iso_double_link_from_faces(&surface, &f, ISO_BOUNDARY_REFUSED));
    test_field rod = test_round(3, -2, 0, (iso_vec3){1, 1, 0});
    CHECK_STATUS(ISO_UNSLICEABLE, iso_slice_double_link_field(&c, &surface, &rod.field, level, 1));
    CHECK(strstr(iso_error_message(), "face 0") != NULL);
    CHECK(!c.link.g);
    iso_multilink_free(&surface.link);
}

static void test_square_link(void) {
    iso_square_link tube;
    iso_double_link surface;
    iso_coloured_link c;
    const iso_axis axis[2] = {{40, 1}, {30, 0}};
    double g[3 * 1200], level[20];
    int32_t orbits;
    for (int i = 0; i < 1200; i++) { /* a horn */
        double u = 2 * SHAPE_PI * (i % 40) / 40, h = i / 40, r = 5 + 0.01 * h * h;
        g[3 * i] = r * cos(u), g[3 * i + 1] = r * sin(u), g[3 * i + 2] = h;
    }
    for (int i = 0; i < 20; i++)
        level[i] = 20.3 + 0.71 * i;
    CHECK_OK(iso_square_link_box(&tube, axis, 3, g));
    CHECK_OK(iso_double_link_from_square_link(&surface, &tube, ISO_BOUNDARY_FANNED));
    test_field ball = test_round(1, 2, -15, (iso_vec3){1, 1, 1});
    if (CHECK_OK(iso_slice_double_link_field(&c, &surface, &ball.field, level, 20))) {
        check_contours(&c, &surface, &ball, level, &orbits);
        CHECK_EQUAL(20, orbits);
        iso_multilink_free(&c.link);
    }
    iso_multilink_free(&surface.link);
    iso_multilink_free(&tube.link);
}

static void test_bad_use(void) {
    iso_double_link surface;
    iso_coloured_link c;
    test_field root = test_root(3), up = test_plane(0, 0, 1);
    double level[] = {1, 1};
    make_quads(&surface, 8, 8);
    CHECK_STATUS(ISO_UNSLICEABLE, iso_slice_double_link_field(&c, &surface, &root.field, level, 1));
    CHECK_STATUS(ISO_USAGE, iso_slice_double_link_field(&c, &surface, &up.field, level, 2));
    for (int64_t n = 0;; n++) {
        iso_fail_allocation_after(n);
        iso_status status = iso_slice_double_link_field(&c, &surface, &up.field, level, 1);
        iso_fail_allocation_after(-1);
        if (status == ISO_OK) {
            CHECK(n >= 6);
            iso_multilink_free(&c.link);
            break;
        }
        CHECK_STATUS(ISO_NO_MEMORY, status);
        CHECK(!c.link.g);
    }
    iso_multilink_free(&surface.link);
}

int main(void) {
    RUN(test_quads);
    RUN(test_heights_and_field);
    RUN(test_hidden_loop);
    RUN(test_square_link);
    RUN(test_bad_use);
    return check_verdict();
}

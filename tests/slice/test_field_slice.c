/* Slices by fields against closed forms. */
#include "check.h"

#include "base/memory.h"
#include "models/shapes.h"
#include "slice/fields.h"

#include <isoslice/slice.h>

static iso_vec3 minus(iso_vec3 a, iso_vec3 b) {
    return (iso_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}
static iso_vec3 cross(iso_vec3 a, iso_vec3 b) {
    return (iso_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static double dot(iso_vec3 a, iso_vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* Half the sum of the cross products: of a flat contour, its area times its normal. */
static iso_vec3 contour_area(const iso_curves *c, int32_t contour) {
    iso_vec3 sum = {0, 0, 0};
    int64_t first = c->contour_first[contour], end = c->contour_first[contour + 1];
    for (int64_t i = first; i < end; i++) {
        iso_vec3 p = minus(c->point[i], c->point[first]);
        iso_vec3 q = minus(c->point[i + 1 < end ? i + 1 : first], c->point[first]);
        iso_vec3 n = cross(p, q);
        sum = (iso_vec3){sum.x + n.x / 2, sum.y + n.y / 2, sum.z + n.z / 2};
    }
    return sum;
}

static void check_structure(const iso_curves *c, int32_t levels) {
    CHECK_EQUAL(levels, c->level_count);
    CHECK_EQUAL(0, c->level_first[0]);
    CHECK_EQUAL(c->contour_count, c->level_first[levels]);
    CHECK_EQUAL(0, c->contour_first[0]);
    CHECK_EQUAL(c->crossing_count, c->contour_first[c->contour_count]);
    for (int32_t i = 0; i < c->contour_count; i++)
        CHECK(c->contour_first[i + 1] >= c->contour_first[i] + 2);
}

/* Worst distance of points from their level, as far as the gradient tells. */
static double worst_level(const iso_curves *c, const test_field *f, const double *level) {
    double worst = 0;
    for (int32_t l = 0; l < c->level_count; l++)
        for (int64_t i = c->contour_first[c->level_first[l]];
             i < c->contour_first[c->level_first[l + 1]]; i++)
            worst = fmax(worst, fabs(test_value(f, c->point[i]) - level[l]));
    return worst;
}

static double distance_to_triangle_plane(const iso_mesh *m, int32_t t, iso_vec3 p) {
    iso_vec3 v[3];
    for (int k = 0; k < 3; k++)
        v[k] = m->position[m->origin[3 * t + k]];
    iso_vec3 n = cross(minus(v[1], v[0]), minus(v[2], v[0]));
    double size = sqrt(dot(n, n)), off = fabs(dot(n, minus(p, v[0]))) / size;
    for (int k = 0; k < 3; k++) { /* outside? then far away, or past an edge by rounding alone */
        iso_vec3 e = minus(v[(k + 1) % 3], v[k]);
        double inside = dot(cross(n, e), minus(p, v[k])) / (size * sqrt(dot(e, e)));
        if (inside < 0)
            off = fmax(off, -inside);
    }
    return off;
}

static double worst_mesh(const iso_curves *c, const iso_mesh *m) {
    double worst = 0;
    int64_t step = c->crossing_count * m->triangle_count / 20000000 + 1;
    for (int64_t i = 0; i < c->crossing_count; i += step) {
        double best = INFINITY;
        for (int32_t t = 0; t < m->triangle_count && best > 1e-12; t++)
            best = fmin(best, distance_to_triangle_plane(m, t, c->point[i]));
        worst = fmax(worst, best);
    }
    return worst;
}

static void make(iso_mesh *mesh, shape *s) {
    CHECK_OK(iso_mesh_from_triangles(mesh, s->triangle, s->count));
    shape_free(s);
}

static void make_cube(iso_mesh *mesh) {
    shape s = {0};
    shape_box(&s, -10, -10, -10, 10, 10, 10);
    make(mesh, &s);
}

/* A cylinder of radius 2 through two triangles of a cube, meeting none of their edges. */
static void test_hidden_loop(void) {
    iso_mesh mesh;
    iso_curves c;
    test_field f = test_round(4, -4, 0, (iso_vec3){1, 1, 0});
    double level[] = {2};
    make_cube(&mesh);
    for (double tolerance = 0.02; tolerance > 0.0005; tolerance /= 2) {
        iso_field_slicing options = {tolerance, 0.002};
        if (!CHECK_OK(iso_slice_field(&c, &mesh, &f.field, level, 1, &options)))
            break;
        check_structure(&c, 1);
        CHECK_EQUAL(2, c.contour_count);
        for (int32_t i = 0; i < c.contour_count; i++) {
            iso_vec3 a = contour_area(&c, i);
            double circle = SHAPE_PI * 4, lost = 2 * SHAPE_PI * 2 * tolerance;
            CHECK_NEAR(circle, fabs(a.z), lost);
            CHECK(fabs(a.z) < circle);
            CHECK_NEAR(0, hypot(a.x, a.y), 1e-9);
        }
        CHECK(worst_level(&c, &f, level) < 1e-6);
        CHECK(worst_mesh(&c, &mesh) < 1e-9);
        printf("%g: %lld points\n", tolerance, (long long)c.crossing_count);
        iso_curves_free(&c);
    }
    iso_mesh_free(&mesh);
}

int main(void) {
    RUN(test_hidden_loop);
    return check_verdict();
}

/* What contours must be, found by brute force: from formulas of the field and the mesh's triangles
 * alone. */
#ifndef TESTS_SLICE_BRUTE_H
#define TESTS_SLICE_BRUTE_H

#include "check.h"

#include <stdlib.h>

#include <isoslice/slice.h>

typedef double formula(const void *field, iso_vec3 at);

static inline iso_vec3 minus(iso_vec3 a, iso_vec3 b) {
    return (iso_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}
static inline iso_vec3 cross(iso_vec3 a, iso_vec3 b) {
    return (iso_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static inline double dot(iso_vec3 a, iso_vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* Half the sum of the cross products: of a flat contour, its area times its normal. */
static inline iso_vec3 contour_area(const iso_curves *c, int32_t contour) {
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

static inline void check_structure(const iso_curves *c, int32_t levels) {
    CHECK_EQUAL(levels, c->level_count);
    CHECK_EQUAL(0, c->level_first[0]);
    CHECK_EQUAL(c->contour_count, c->level_first[levels]);
    CHECK_EQUAL(0, c->contour_first[0]);
    CHECK_EQUAL(c->crossing_count, c->contour_first[c->contour_count]);
    for (int32_t i = 0; i < c->contour_count; i++)
        CHECK(c->contour_first[i + 1] >= c->contour_first[i] + 2);
}

/* Worst distance of points from their level, as far as the gradient tells. */
static inline double worst_level(const iso_curves *c, formula *value_at, const void *field,
                                 const double *level) {
    double worst = 0;
    for (int32_t l = 0; l < c->level_count; l++)
        for (int64_t i = c->contour_first[c->level_first[l]];
             i < c->contour_first[c->level_first[l + 1]]; i++)
            worst = fmax(worst, fabs(value_at(field, c->point[i]) - level[l]));
    return worst;
}

static inline double distance_to_triangle_plane(const iso_mesh *m, int32_t t, iso_vec3 p) {
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

static inline double worst_mesh(const iso_curves *c, const iso_mesh *m) {
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

/* ---- the part of a mesh below a level, found by brute force ---- */

static inline iso_vec3 mix(iso_vec3 a, iso_vec3 b, double t) {
    return (iso_vec3){a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
}

/* Part of a triangle where F > r, F linear on it. */
static inline double part_above(const double f[3], double r) {
    int above = (f[0] > r) + (f[1] > r) + (f[2] > r);
    if (above == 0 || above == 3)
        return above / 3;
    for (int k = 0; k < 3; k++)
        if ((f[k] > r) == (above == 1)) { /* the one that is alone */
            double a = f[k] - r, b = f[k] - f[(k + 1) % 3], c = f[k] - f[(k + 2) % 3];
            double corner = a / b * (a / c);
            return above == 1 ? corner : 1 - corner;
        }
    return NAN;
}

/* Sum of normals times area of all that is above r, of triangles cut in n^2: the boundary of that
 * has the same vector area (Stokes), and is what the contours are. */
static inline iso_vec3 area_above(const iso_mesh *mesh, formula *value_at, const void *field,
                                  double r, int n) {
    iso_vec3 sum = {0, 0, 0};
    double *value = malloc((size_t)(n + 1) * (size_t)(n + 1) * sizeof *value);
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        iso_vec3 p[3];
        double area = 0;
        for (int k = 0; k < 3; k++)
            p[k] = mesh->position[mesh->origin[3 * t + k]];
        for (int i = 0; i <= n; i++)
            for (int j = 0; i + j <= n; j++) {
                iso_vec3 u = minus(p[1], p[0]), v = minus(p[2], p[0]);
                double a = (double)i / n, b = (double)j / n;
                value[i * (n + 1) + j] = value_at(field, (iso_vec3){p[0].x + a * u.x + b * v.x,
                                                                    p[0].y + a * u.y + b * v.y,
                                                                    p[0].z + a * u.z + b * v.z});
            }
        for (int i = 0; i < n; i++)
            for (int j = 0; i + j < n; j++) {
                const double *q = value + i * (n + 1) + j;
                area += part_above((double[]){q[0], q[n + 1], q[1]}, r);
                if (i + j + 1 < n)
                    area += part_above((double[]){q[n + 1], q[n + 2], q[1]}, r);
            }
        iso_vec3 normal = cross(minus(p[1], p[0]), minus(p[2], p[0]));
        double part = 0.5 * area / n / n;
        sum = (iso_vec3){sum.x + part * normal.x, sum.y + part * normal.y, sum.z + part * normal.z};
    }
    free(value);
    return sum;
}

static inline iso_vec3 level_area(const iso_curves *c, int32_t level) {
    iso_vec3 sum = {0, 0, 0};
    for (int32_t i = c->level_first[level]; i < c->level_first[level + 1]; i++) {
        iso_vec3 a = contour_area(c, i);
        sum = (iso_vec3){sum.x + a.x, sum.y + a.y, sum.z + a.z};
    }
    return sum;
}

#endif

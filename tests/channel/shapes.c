#include "shapes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

double cone_radius(double z) {
    return 30 - z / 2;
}
double sphere_radius(double z) {
    return sqrt(900 - z * z);
}
double paraboloid_radius(double z) {
    return sqrt(20 * z);
}
double cylinder_radius(double z) {
    (void)z;
    return 20;
}

double cone_way(double from, double to) {
    return (to - from) * sqrt(1.25);
}
double sphere_way(double from, double to) {
    return 30 * (asin(to / 30) - asin(from / 30));
}
/* The length of z = r^2 / 20 from r = 0: (r sqrt(1 + (r/10)^2) + 10 asinh(r/10)) / 2. */
static double parabola_length(double z) {
    double r = paraboloid_radius(z);
    return (r * sqrt(1 + r * r / 100) + 10 * asinh(r / 10)) / 2;
}
double paraboloid_way(double from, double to) {
    return parabola_length(to) - parabola_length(from);
}

iso_vec3 shape_point(const shape *s, int i, int j) {
    double angle = 2 * 3.14159265358979323846 * (i % s->sides) / s->sides;
    double z = s->low + (s->high - s->low) * j / (s->rings - 1), r = s->radius(z);
    return (iso_vec3){s->stretch_x * r * cos(angle) + s->slant * z, s->stretch_y * r * sin(angle),
                      z};
}

static float *put(float *to, iso_vec3 a, iso_vec3 b, iso_vec3 c) {
    const iso_vec3 corner[3] = {a, b, c};
    for (int k = 0; k < 3; k++) {
        *to++ = (float)corner[k].x;
        *to++ = (float)corner[k].y;
        *to++ = (float)corner[k].z;
    }
    return to;
}

static void take(iso_mesh *mesh, float *triangle, int64_t count) {
    if (iso_mesh_from_triangles(mesh, triangle, count) != ISO_OK) {
        fprintf(stderr, "no mesh: %s\n", iso_error_message());
        exit(1);
    }
    free(triangle);
}

void shape_mesh(iso_mesh *mesh, const shape *s) {
    int64_t count = 2 * (int64_t)s->sides * s->rings;
    float *triangle = malloc((size_t)count * 9 * sizeof *triangle), *at = triangle;
    iso_vec3 below = {s->slant * s->low, 0, s->low}, above = {s->slant * s->high, 0, s->high};
    if (!triangle)
        exit(1);
    for (int i = 0; i < s->sides; i++) {
        at = put(at, below, shape_point(s, i + 1, 0), shape_point(s, i, 0));
        for (int j = 0; j + 1 < s->rings; j++) {
            iso_vec3 a = shape_point(s, i, j), b = shape_point(s, i + 1, j);
            iso_vec3 c = shape_point(s, i + 1, j + 1), d = shape_point(s, i, j + 1);
            at = put(at, a, b, c);
            at = put(at, a, c, d);
        }
        at = put(at, above, shape_point(s, i, s->rings - 1), shape_point(s, i + 1, s->rings - 1));
    }
    take(mesh, triangle, count);
}

void box_mesh(iso_mesh *mesh, iso_vec3 low, iso_vec3 high) {
    static const int quad[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                   {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    float *triangle = malloc(12 * 9 * sizeof *triangle), *at = triangle;
    if (!triangle)
        exit(1);
    for (int q = 0; q < 6; q++) {
        iso_vec3 p[4];
        for (int k = 0; k < 4; k++) {
            int c = quad[q][k];
            p[k] =
                (iso_vec3){c & 1 ? high.x : low.x, c & 2 ? high.y : low.y, c & 4 ? high.z : low.z};
        }
        at = put(at, p[0], p[1], p[2]);
        at = put(at, p[0], p[2], p[3]);
    }
    take(mesh, triangle, 12);
}

/* Vertical walls of a ring of points, counter-clockwise seen from above. */
static float *put_walls(float *at, const double (*ring)[2], int count, double low, double high) {
    for (int i = 0; i < count; i++) {
        const double *p = ring[i], *q = ring[(i + 1) % count];
        iso_vec3 a = {p[0], p[1], low}, b = {q[0], q[1], low};
        iso_vec3 c = {q[0], q[1], high}, d = {p[0], p[1], high};
        at = put(at, a, b, c);
        at = put(at, a, c, d);
    }
    return at;
}

static float *put_flat(float *at, const double p[2], const double q[2], const double r[2], double z,
                       int upwards) {
    iso_vec3 a = {p[0], p[1], z}, b = {q[0], q[1], z}, c = {r[0], r[1], z};
    return upwards ? put(at, a, b, c) : put(at, a, c, b);
}

/* The plate's top is cut into columns between the boxes' edges, which must not overlap in x; all
 * boxes have the same edges in y. */
void plate_mesh(iso_mesh *mesh, const double (*low)[3], const double (*high)[3], int count) {
    float *triangle = malloc(4096 * sizeof *triangle), *at = triangle;
    double x[16], y[4] = {low[0][1], low[1][1], high[1][1], high[0][1]}, top = high[0][2];
    int columns = 0;
    if (!triangle)
        exit(1);
    x[columns++] = low[0][0];
    for (int i = 1; i < count; i++) {
        x[columns++] = low[i][0];
        x[columns++] = high[i][0];
    }
    x[columns] = high[0][0];
    for (int i = 0; i < columns; i++)
        for (int j = 0; j < 3; j++) {
            double p[4][2] = {
                {x[i], y[j]}, {x[i + 1], y[j]}, {x[i + 1], y[j + 1]}, {x[i], y[j + 1]}};
            int post = j == 1 && i % 2 == 1;
            double z = post ? high[(i + 1) / 2][2] : top;
            for (int up = 0; up < 2; up++) {
                at = put_flat(at, p[0], p[1], p[2], up ? z : low[0][2], up);
                at = put_flat(at, p[0], p[2], p[3], up ? z : low[0][2], up);
            }
            if (post)
                at = put_walls(at, (const double(*)[2])p, 4, top, z);
        }
    double ring[64][2];
    int n = 0;
    for (int i = 0; i <= columns; i++)
        ring[n][0] = x[i], ring[n++][1] = y[0];
    for (int j = 1; j < 3; j++)
        ring[n][0] = x[columns], ring[n++][1] = y[j];
    for (int i = columns; i >= 0; i--)
        ring[n][0] = x[i], ring[n++][1] = y[3];
    for (int j = 2; j > 0; j--)
        ring[n][0] = x[0], ring[n++][1] = y[j];
    at = put_walls(at, (const double(*)[2])ring, n, low[0][2], top);
    take(mesh, triangle, (at - triangle) / 9);
}

/* A prism from z = 0 to 60. */
static void upright_mesh(iso_mesh *mesh, const double (*ring)[2], int corners,
                         const int (*lid)[3]) {
    int count = 2 * corners + 2 * (corners - 2);
    float *triangle = malloc((size_t)count * 9 * sizeof *triangle), *at = triangle;
    if (!triangle)
        exit(1);
    at = put_walls(at, ring, corners, 0, 60);
    for (int i = 0; i < corners - 2; i++)
        for (int up = 0; up < 2; up++)
            at = put_flat(at, ring[lid[i][0]], ring[lid[i][1]], ring[lid[i][2]], up ? 60 : 0, up);
    take(mesh, triangle, count);
}

void angle_mesh(iso_mesh *mesh) {
    static const double ring[6][2] = {{0, 0}, {70, 0}, {70, 25}, {25, 25}, {25, 70}, {0, 70}};
    static const int lid[4][3] = {{0, 1, 3}, {1, 2, 3}, {0, 3, 5}, {3, 4, 5}};
    upright_mesh(mesh, ring, 6, lid);
}

void slot_mesh(iso_mesh *mesh) {
    static const double ring[8][2] = {{0, 0},   {70, 0},  {70, 50}, {40, 50},
                                      {40, 15}, {30, 15}, {30, 50}, {0, 50}};
    static const int lid[6][3] = {{0, 5, 6}, {0, 6, 7}, {0, 4, 5}, {0, 1, 4}, {1, 3, 4}, {1, 2, 3}};
    upright_mesh(mesh, ring, 8, lid);
}

void ring_mesh(iso_mesh *mesh, double radius, const shape *hole) {
    int64_t count = 8 * (int64_t)hole->sides;
    float *triangle = malloc((size_t)count * 9 * sizeof *triangle), *at = triangle;
    shape outside = *hole;
    double by = radius / hole->radius(0);
    if (!triangle)
        exit(1);
    outside.stretch_x *= by;
    outside.stretch_y *= by;
    for (int i = 0; i < hole->sides; i++) {
        iso_vec3 p[2][2][2]; /* within or without, side, ring */
        for (int k = 0; k < 8; k++)
            p[k & 1][k >> 1 & 1][k >> 2] = shape_point(k & 1 ? &outside : hole, i + (k >> 1 & 1),
                                                       k >> 2 ? hole->rings - 1 : 0);
        for (int top = 0; top < 2; top++) {
            iso_vec3 a = p[0][0][top], b = p[1][0][top], c = p[1][1][top], d = p[0][1][top];
            at = top ? put(at, a, b, c) : put(at, a, c, b);
            at = top ? put(at, a, c, d) : put(at, a, d, c);
        }
        for (int out = 0; out < 2; out++) {
            iso_vec3 a = p[out][0][0], b = p[out][1][0], c = p[out][1][1], d = p[out][0][1];
            at = out ? put(at, a, b, c) : put(at, a, c, b);
            at = out ? put(at, a, c, d) : put(at, a, d, c);
        }
    }
    take(mesh, triangle, count);
}

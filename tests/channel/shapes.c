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

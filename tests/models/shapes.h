/* Triangle meshes made in memory, for tests: nine floats a triangle, counter-clockwise seen from
 * outside. Start from a zeroed shape, add to it, free it at the end.
 *
 *     shape s = {0};
 *     shape_box(&s, 0, 0, 0, 20, 20, 20);
 *     iso_mesh_from_triangles(&mesh, s.triangle, s.count);
 *     shape_free(&s); */
#ifndef TESTS_MODELS_SHAPES_H
#define TESTS_MODELS_SHAPES_H

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct shape {
    float *triangle; /* [9 count] */
    int64_t count, capacity;
} shape;

typedef struct shape_point {
    double x, y, z;
} shape_point;

#define SHAPE_PI 3.14159265358979323846

static inline void shape_free(shape *s) {
    free(s->triangle);
    *s = (shape){0};
}

static inline void shape_add(shape *s, shape_point a, shape_point b, shape_point c) {
    if (s->count == s->capacity) {
        s->capacity = s->capacity ? 2 * s->capacity : 64;
        s->triangle = realloc(s->triangle, (size_t)s->capacity * 9 * sizeof(float));
    }
    shape_point p[3] = {a, b, c};
    for (int k = 0; k < 3; k++) {
        float *to = s->triangle + 9 * s->count + 3 * k;
        to[0] = (float)p[k].x, to[1] = (float)p[k].y, to[2] = (float)p[k].z;
    }
    s->count++;
}

/* a b c d counter-clockwise. */
static inline void shape_quad(shape *s, shape_point a, shape_point b, shape_point c,
                              shape_point d) {
    shape_add(s, a, b, c);
    shape_add(s, a, c, d);
}

/* 12 triangles: bottom, top, front, back, left, right. */
static inline void shape_box(shape *s, double x0, double y0, double z0, double x1, double y1,
                             double z1) {
    shape_point p[8];
    for (int i = 0; i < 8; i++)
        p[i] = (shape_point){i & 1 ? x1 : x0, i & 2 ? y1 : y0, i & 4 ? z1 : z0};
    shape_quad(s, p[0], p[2], p[3], p[1]);
    shape_quad(s, p[4], p[5], p[7], p[6]);
    shape_quad(s, p[0], p[1], p[5], p[4]);
    shape_quad(s, p[2], p[6], p[7], p[3]);
    shape_quad(s, p[0], p[4], p[6], p[2]);
    shape_quad(s, p[1], p[3], p[7], p[5]);
}

/* Corners at the origin and at `size` on each axis: volume size^3 / 6. */
static inline void shape_tetrahedron(shape *s, double size) {
    shape_point o = {0, 0, 0}, x = {size, 0, 0}, y = {0, size, 0}, z = {0, 0, size};
    shape_add(s, o, y, x);
    shape_add(s, o, x, z);
    shape_add(s, x, y, z);
    shape_add(s, o, z, y);
}

/* Rings of latitude and sectors of longitude: 2 sectors (rings - 1) triangles. */
static inline void shape_sphere(shape *s, shape_point at, double r, int rings, int sectors) {
    for (int i = 0; i < rings; i++)
        for (int j = 0; j < sectors; j++) {
            shape_point p[2][2];
            for (int k = 0; k < 4; k++) {
                double u = SHAPE_PI * (i + k / 2) / rings;
                double w = 2 * SHAPE_PI * ((j + k % 2) % sectors) / sectors;
                double ring = i + k / 2 == rings ? 0 : r * sin(u);
                p[k / 2][k % 2] =
                    (shape_point){at.x + ring * cos(w), at.y + ring * sin(w), at.z - r * cos(u)};
            }
            if (i > 0)
                shape_add(s, p[0][0], p[0][1], p[1][1]);
            if (i + 1 < rings)
                shape_add(s, p[0][0], p[1][1], p[1][0]);
        }
}

/* Axis z, 2 n m triangles; volume tends to 2 pi^2 ring tube^2. */
static inline void shape_torus(shape *s, shape_point at, double ring, double tube, int n, int m) {
    for (int i = 0; i < n; i++)
        for (int j = 0; j < m; j++) {
            shape_point p[2][2];
            for (int k = 0; k < 4; k++) {
                double u = 2 * SHAPE_PI * ((i + k / 2) % n) / n;
                double w = 2 * SHAPE_PI * ((j + k % 2) % m) / m;
                double far = ring + tube * cos(w);
                p[k / 2][k % 2] =
                    (shape_point){at.x + far * cos(u), at.y + far * sin(u), at.z + tube * sin(w)};
            }
            shape_quad(s, p[0][0], p[1][0], p[1][1], p[0][1]);
        }
}

/* The outside of filled cells: cell (i, j, k) of nx ny nz, filled[i + nx (j + ny k)], takes the
 * unit cube at (i, j, k). Cells that touch along an edge alone give that edge four triangles. */
static inline void shape_cells(shape *s, const uint8_t *filled, int nx, int ny, int nz) {
    static const int step[6][3] = {{0, 0, -1}, {0, 0, 1},  {0, -1, 0},
                                   {0, 1, 0},  {-1, 0, 0}, {1, 0, 0}};
    for (int i = 0; i < nx * ny * nz; i++) {
        int at[3] = {i % nx, i / nx % ny, i / nx / ny};
        if (!filled[i])
            continue;
        shape cube = {0};
        shape_box(&cube, at[0], at[1], at[2], at[0] + 1, at[1] + 1, at[2] + 1);
        for (int side = 0; side < 6; side++) {
            int x = at[0] + step[side][0], y = at[1] + step[side][1], z = at[2] + step[side][2];
            int inside = x >= 0 && y >= 0 && z >= 0 && x < nx && y < ny && z < nz;
            if (inside && filled[x + nx * (y + ny * z)])
                continue;
            for (int t = 2 * side; t < 2 * side + 2; t++) {
                const float *f = cube.triangle + 9 * t;
                shape_add(s, (shape_point){f[0], f[1], f[2]}, (shape_point){f[3], f[4], f[5]},
                          (shape_point){f[6], f[7], f[8]});
            }
        }
        shape_free(&cube);
    }
}

/* Turn triangles from..to - 1 the other way round. */
static inline void shape_turn(shape *s, int64_t from, int64_t to) {
    for (int64_t t = from; t < to; t++) {
        float swap[3], *f = s->triangle + 9 * t;
        memcpy(swap, f + 3, sizeof swap);
        memcpy(f + 3, f + 6, sizeof swap);
        memcpy(f + 6, swap, sizeof swap);
    }
}

static inline void shape_remove(shape *s, int64_t triangle) {
    s->count--;
    memmove(s->triangle + 9 * triangle, s->triangle + 9 * (triangle + 1),
            (size_t)(s->count - triangle) * 9 * sizeof(float));
}

static inline void shape_repeat(shape *s, int64_t triangle) {
    float f[9];
    memcpy(f, s->triangle + 9 * triangle, sizeof f);
    shape_add(s, (shape_point){f[0], f[1], f[2]}, (shape_point){f[3], f[4], f[5]},
              (shape_point){f[6], f[7], f[8]});
}

static inline void shape_move(shape *s, int64_t from, int64_t to, double x, double y, double z) {
    for (int64_t i = 3 * from; i < 3 * to; i++) {
        s->triangle[3 * i] += (float)x;
        s->triangle[3 * i + 1] += (float)y;
        s->triangle[3 * i + 2] += (float)z;
    }
}

/* The same numbers on every machine. */
static inline uint32_t shape_random(uint64_t *state) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(*state >> 33);
}

static inline void shape_shuffle(shape *s, uint64_t seed) {
    for (int64_t i = s->count - 1; i > 0; i--) {
        int64_t j = shape_random(&seed) % (i + 1);
        float swap[9];
        memcpy(swap, s->triangle + 9 * i, sizeof swap);
        memmove(s->triangle + 9 * i, s->triangle + 9 * j, sizeof swap);
        memcpy(s->triangle + 9 * j, swap, sizeof swap);
    }
}

/* Bytes of a binary STL file, 84 + 50 count of them; free() them. */
static inline unsigned char *shape_binary(const shape *s, const char *header) {
    unsigned char *bytes = calloc(1, (size_t)(84 + 50 * s->count));
    memcpy(bytes, header, strlen(header) < 80 ? strlen(header) : 80);
    for (int i = 0; i < 4; i++)
        bytes[80 + i] = (unsigned char)(s->count >> 8 * i);
    for (int64_t t = 0; t < s->count; t++)
        memcpy(bytes + 84 + 50 * t + 12, s->triangle + 9 * t, 36);
    return bytes;
}

/* Text of an ASCII STL file with lines that end in `newline`; free() it. */
static inline char *shape_ascii(const shape *s, const char *name, const char *newline) {
    size_t room = 256 + (size_t)s->count * 400, at = 0;
    char *text = malloc(room);
    at += (size_t)snprintf(text + at, room - at, "solid %s%s", name, newline);
    for (int64_t t = 0; t < s->count; t++) {
        const float *f = s->triangle + 9 * t;
        at += (size_t)snprintf(text + at, room - at, "  facet normal 0 0 0%s    outer loop%s",
                               newline, newline);
        for (int k = 0; k < 3; k++)
            at += (size_t)snprintf(text + at, room - at, "      vertex %.9g %.9g %.9g%s", f[3 * k],
                                   f[3 * k + 1], f[3 * k + 2], newline);
        at += (size_t)snprintf(text + at, room - at, "    endloop%s  endfacet%s", newline, newline);
    }
    snprintf(text + at, room - at, "endsolid %s%s", name, newline);
    return text;
}

/* 1 if the file was written. */
static inline int shape_write(const char *path, const void *bytes, int64_t size) {
    FILE *file = fopen(path, "wb");
    if (!file)
        return 0;
    int written = fwrite(bytes, 1, (size_t)size, file) == (size_t)size;
    return fclose(file) == 0 && written;
}

static inline int shape_write_binary(const shape *s, const char *path) {
    unsigned char *bytes = shape_binary(s, "test");
    int written = shape_write(path, bytes, 84 + 50 * s->count);
    free(bytes);
    return written;
}

/* A strip with half a turn in it, of n squares, about the z axis; `half` of its width. One side. */
static inline void shape_moebius(shape *s, double radius, double half, int n) {
    for (int i = 0; i < n; i++) {
        shape_point p[2][2];
        for (int k = 0; k < 4; k++) {
            double u = 2 * SHAPE_PI * ((i + k / 2) % n) / n;
            double across = (k % 2 ? half : -half) * (i + k / 2 == n ? -1 : 1);
            double far = radius + across * cos(u / 2);
            p[k / 2][k % 2] = (shape_point){far * cos(u), far * sin(u), across * sin(u / 2)};
        }
        shape_quad(s, p[0][0], p[1][0], p[1][1], p[0][1]);
    }
}

#endif

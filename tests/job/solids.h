/* The models of the job's tests. */
#ifndef TESTS_JOB_SOLIDS_H
#define TESTS_JOB_SOLIDS_H

#include "models/shapes.h"

typedef struct solid_ring {
    double scale, z;
} solid_ring;

/* Rings of a star with `points` tips, r (1 + depth cos(points w)), scaled and lifted ring by ring
 * and turned by `twist` radians for each mm; closed by fans at both ends. Rings run from the bottom
 * up on the outside; where they come down again they line a cavity. */
static inline void solid_star(shape *s, double r, int points, double depth, double twist,
                              const solid_ring *ring, int rings, int sectors) {
    shape_point end[2] = {{0, 0, ring[0].z}, {0, 0, ring[rings - 1].z}};
    for (int i = 0; i + 1 < rings; i++)
        for (int j = 0; j < sectors; j++) {
            shape_point p[2][2];
            for (int k = 0; k < 4; k++) {
                solid_ring at = ring[i + k / 2];
                double w = 2 * SHAPE_PI * ((j + k % 2) % sectors) / sectors;
                double far = r * at.scale * (1 + depth * cos(points * w));
                double turned = w + twist * at.z;
                p[k / 2][k % 2] = (shape_point){far * cos(turned), far * sin(turned), at.z};
            }
            shape_quad(s, p[0][0], p[0][1], p[1][1], p[1][0]);
            if (i == 0)
                shape_add(s, end[0], p[0][1], p[0][0]);
            if (i + 2 == rings)
                shape_add(s, end[1], p[1][0], p[1][1]);
        }
}

static inline void solid_cube(shape *s) {
    shape_box(s, 0, 0, 0, 20, 20, 20);
}

static inline void solid_small(shape *s) {
    shape_box(s, 0, 0, 0, 10, 10, 3);
}

static inline void solid_torus(shape *s) {
    shape_torus(s, (shape_point){3, -4, 9}, 9, 4, 48, 24);
}

static inline void solid_sphere(shape *s) {
    shape_sphere(s, (shape_point){0, 0, 0}, 7, 24, 48);
}

static inline void solid_cavity(shape *s) {
    shape_box(s, 0, 0, 0, 16, 16, 12);
    int64_t from = s->count;
    shape_box(s, 4, 4, 3, 12, 12, 9);
    shape_turn(s, from, s->count);
}

/* A core that floats in a cavity: islands within holes of islands. */
static inline void solid_nest(shape *s) {
    shape_box(s, 0, 0, 0, 24, 24, 12);
    int64_t from = s->count;
    shape_box(s, 4, 4, 3, 20, 20, 9);
    shape_turn(s, from, s->count);
    shape_box(s, 8, 8, 5.15, 16, 16, 6.95);
}

static inline void solid_two(shape *s) {
    shape_box(s, 0, 0, 0, 8, 8, 5.03);
    shape_box(s, 14, 3, 0, 20, 13, 8);
}

static inline void solid_plate(shape *s) {
    shape_box(s, 0, 0, 0, 30, 24, 0.65);
}

static inline void solid_needle(shape *s) {
    const solid_ring ring[] = {{1, 0}, {1, 30}};
    solid_star(s, 0.9, 1, 0, 0, ring, 2, 24);
}

static inline void solid_vase(shape *s) {
    solid_ring ring[64];
    int n = 0;
    for (int i = 0; i <= 24; i++)
        ring[n++] = (solid_ring){1 + 0.25 * sin(i / 4.0), i * 0.5};
    for (int i = 24; i >= 4; i--)
        ring[n++] = (solid_ring){0.8 + 0.25 * sin(i / 4.0), i * 0.5};
    solid_star(s, 9, 5, 0.2, 0.05, ring, n, 60);
}

/* Square steps of `width` mm less each, `height` mm high. */
static inline void solid_pyramid(shape *s) {
    const solid_ring ring[] = {{1, 0}, {1, 3}, {0.75, 3}, {0.75, 6}, {0.5, 6}, {0.5, 9}};
    solid_star(s, 12, 1, 0, 0, ring, 6, 4);
}

typedef struct solid_model {
    const char *name;
    void (*make)(shape *s);
    int full; /* large enough in every place to be filled between 0.95 and 1.05 */
} solid_model;

static const solid_model all_solids[] = {
    {"cube", solid_cube, 1},       {"small", solid_small, 1},   {"torus", solid_torus, 1},
    {"sphere", solid_sphere, 1},   {"cavity", solid_cavity, 1}, {"two", solid_two, 1},
    {"plate", solid_plate, 1},     {"needle", solid_needle, 0}, {"vase", solid_vase, 1},
    {"pyramid", solid_pyramid, 1}, {"nest", solid_nest, 1},
};

enum { SOLID_COUNT = sizeof all_solids / sizeof *all_solids };

#endif

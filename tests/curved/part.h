/* The part as an STL file has it: its volume, and which voxels lie in it. */
#ifndef TESTS_CURVED_PART_H
#define TESTS_CURVED_PART_H

#include <stdint.h>

#include "space.h"

typedef struct part {
    float (*triangle)[9];
    int64_t count;
    vec low, high;
    double volume; /* mm^3 */
} part;

/* A grid of voxels: rows of bits along x, `words` of 64 each. */
typedef struct grid {
    vec low; /* its lower corner */
    double voxel;
    int nx, ny, nz, words;
} grid;

/* 0 on failure, which it has told of. Binary STL. The middle of its box comes to x, y, its foot to
 * z = 0. */
int part_read(part *p, const char *path, double x, double y);
void part_free(part *p);

/* Voxels of slices z0 to z1 - 1 whose centres the surface winds around: bits[z - z0][y][word]. */
void part_fill(uint64_t *bits, const part *p, const grid *g, int z0, int z1);

/* Set bits of the voxels whose centres x lie in [a, b], mm from the grid's low. */
void grid_span(uint64_t *row, const grid *g, double a, double b);

#endif

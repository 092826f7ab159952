/* Beads as they lie: each in its own frame, on the layer below. */
#ifndef TESTS_CURVED_BEADS_H
#define TESTS_CURVED_BEADS_H

#include <stdint.h>

#include "heights.h"
#include "moves.h"
#include "part.h"

typedef struct bead {
    vec from, to;          /* mm, along the middle of its top */
    vec along, side, up;   /* unit */
    double length, height; /* mm */
    double area;           /* mm^2 of its section */
    double width;          /* of the stadium with that section */
    double volume;         /* mm^3 */
    int32_t layer, line;
} bead;

typedef struct beads {
    bead *at;
    int64_t count;
    double *top;    /* [layers] what the field is at the layers' tops, rising; NULL without one */
    double bottom;  /* and at the part's lowest point */
    int32_t *level; /* [layers] of a move's layer: which of `top`, or -1 */
    int32_t layers;
    vec middle; /* what the field counts from */
} beads;

/* The extruding moves: frame and height from the field; or, without one, from the places of other
 * beads nearby, of the same layer and of those below; or height as ;HEIGHT: says (`told`). */
int beads_make(beads *b, const moves *m, const heights *field, const part *p, int told);
void beads_free(beads *b);

/* The layer, counted from 0 by height, that a place is in; its middle in *middle. */
int32_t beads_layer(vec *middle, const beads *b, const heights *field, vec place);

/* Set the bits (slices z0 to z1 - 1) of voxels in the bead: as wide as `width`, with round ends if
 * `round`, `slack` lower than it is. */
void bead_fill(uint64_t *bits, const grid *g, const bead *b, double width, int round, double slack,
               int z0, int z1);

/* The lowest and highest z that it may reach. */
void bead_range(double range[2], const bead *b, double slack);

#endif

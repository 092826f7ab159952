/* What a G-code file makes the nozzle do, in the frame of the part: its places on the bed while all
 * angles are 0. Knows nothing of the program that wrote it. */
#ifndef TESTS_CURVED_MOVES_H
#define TESTS_CURVED_MOVES_H

#include <stdint.h>

#include "space.h"

typedef struct machine {
    int tilt,
        around;     /* axes (0, 1, 2 for X, Y, Z) of the table: it tilts, and turns on top; or -1 */
    char letter[2]; /* of the words that tell them */
    vec pivot;
    double filament; /* mm */
} machine;

typedef struct move {
    vec from, to;     /* mm, the tip in the part's frame */
    double angle[2];  /* degrees at the end */
    double before[2]; /* and at the start */
    double volume;    /* mm^3 that come out; 0: a travel */
    double height;    /* of the last ;HEIGHT: */
    int32_t layer;    /* counted by ;LAYER_CHANGE, else by Z; from 0 */
    int32_t line;     /* of the file */
} move;

typedef struct moves {
    move *at;
    int64_t count, capacity;
    int32_t layers;
    double lost; /* mm^3 pushed out at rest, beyond what was drawn back */
} moves;

/* cartesian, rotary_a, rotary_b, table_ac, table_bc: 0 if there is no such machine. */
int machine_named(machine *m, const char *kinematics);

/* How the part is turned, by angles as in a move. */
turn machine_turn(const machine *m, const double angle[2]);

/* 0 on failure, which it has told of. */
int moves_read(moves *m, const char *path, const machine *on);

#endif

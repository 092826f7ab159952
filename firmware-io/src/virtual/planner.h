/* The planner: straight blocks with trapezoidal speed, joined at the corners without stopping.
 *
 * A ring of a fixed number of blocks is looked ahead over, as Marlin and grbl do; the oldest
 * block's speeds are settled when it is taken. Squares of speeds are kept, so that looking ahead
 * costs no root. */
#ifndef FIO_VIRTUAL_PLANNER_H
#define FIO_VIRTUAL_PLANNER_H

#include <stdbool.h>
#include <stdint.h>

#include <isoprint/virtual_printer.h>

typedef struct fio_limits {
    double feedrate[4], acceleration[4];
    double print_acceleration, retract_acceleration, travel_acceleration;
    double minimum_feedrate, minimum_travel_feedrate;
    double junction_deviation, jerk[4];
    bool classic_jerk;
} fio_limits;

typedef struct fio_block {
    double length, acceleration, nominal; /* mm, mm/s², mm/s */
    double entry_squared, most_entry_squared;
    double rest_squared; /* speed at which it may start from or stop at rest */
    int64_t sequence;    /* of the line it belongs to */
    fio_activity activity;
    double start[3], end[3]; /* machine coordinates; the planner itself has no use for them */
} fio_block;

typedef struct fio_planner {
    fio_block blocks[FIO_BLOCKS_MOST];
    int capacity, count, oldest;
    int settled;         /* index of the last block whose entry speed no later block can raise */
    bool joined;         /* there is a block before the next one to join to */
    double unit[5];      /* of that block: delta / length */
    double direction[5]; /* and its direction in x, y, z, e and turning, normalised */
    double nominal, rest;
} fio_planner;

static inline bool fio_planner_full(const fio_planner *planner) {
    return planner->count == planner->capacity;
}

/* Add a move of delta (x, y, z, e in mm, turning in degrees); not full. Its length is that of x, y
 * and z; or the degrees, if none of them moves; or that of e. Returns false if it has none. The
 * block's nominal speed, limited by the axes, goes to *nominal. */
bool fio_planner_add(fio_planner *planner, const fio_limits *limits, const double delta[5],
                     double feedrate, double *nominal);

static inline fio_block *fio_planner_newest(fio_planner *planner) {
    int index = planner->oldest + planner->count - 1;
    return &planner->blocks[index < planner->capacity ? index : index - planner->capacity];
}

/* Take the oldest block out; not empty. Returns its duration in s. */
double fio_planner_take(fio_planner *planner, fio_block *taken);

/* The next block starts from rest; empty. */
void fio_planner_rest(fio_planner *planner);

#endif

/* The ground: an upper bound of all beads so far, over cells of x and y.
 *
 * Each cell knows how high beads stand in it, and a plane that none of them is above; heights of
 * 2 x 2 cells are put together, and so on. Most moves of an upright tool are proven free by it: far
 * away because everything is lower than the tool, near the tip because the plane is, whose slope is
 * the layer's. What it can't prove may be free all the same. */
#ifndef ISO_CLEARANCE_GROUND_H
#define ISO_CLEARANCE_GROUND_H

#include "clearance/tool.h"

typedef struct ground_map ground_map;

iso_status ground_new(ground_map **made, const tool_body *tool) ISO_MUST_CHECK;
void ground_free(ground_map *ground);

/* Within ISO_COORDINATE_MAX. */
iso_status ground_add(ground_map *ground, const clearance_move *bead) ISO_MUST_CHECK;

/* A straight piece of the tip's way, and how much the nozzle may be higher there. */
typedef struct ground_step {
    iso_vec3 from, to;
    double raise;
    int32_t move; /* the caller's */
} ground_step;

enum { GROUND_STEPS = 64 };

/* What is left to be decided: parts of the tool, 1 << tool_part each, in a box. */
typedef struct ground_doubt {
    int parts; /* 0: the step is free */
    iso_vec3 low, high;
} ground_doubt;

static inline ground_doubt ground_doubt_none(void) {
    return (ground_doubt){0, {INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
}
static inline void ground_doubt_add(ground_doubt *doubt, const ground_doubt *more) {
    doubt->parts |= more->parts;
    doubt->low.x = least_of(doubt->low.x, more->low.x);
    doubt->low.y = least_of(doubt->low.y, more->low.y);
    doubt->low.z = least_of(doubt->low.z, more->low.z);
    doubt->high.x = most_of(doubt->high.x, more->high.x);
    doubt->high.y = most_of(doubt->high.y, more->high.y);
    doubt->high.z = most_of(doubt->high.z, more->high.z);
}

/* Which of the steps, no more than GROUND_STEPS, are not proven free. They should be close
 * together. */
void ground_check(ground_doubt *doubt, ground_map *ground, const ground_step *step, int count);

int64_t ground_bytes(const ground_map *ground);

#endif

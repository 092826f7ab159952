/* Clearance: does the tool anywhere touch what is already printed?
 *
 * The tool is a body around its tip: the nozzle's flat tip and cone, the heater block, the carriage
 * and the gantry. Every move of the finished G-code is looked at, in order, against all beads that
 * came before it, before anything is written.
 *
 * A bead lies under the way of its move: from the tip's line down by `height`, square to the line
 * and as nearly across the layer as that allows, `width` wide, its sides and ends half-round. Its
 * ends don't rise beyond the tip: on a slope an upper end is level, if the tool is upright.
 *
 * The tool goes along a move in a straight line and turns evenly. Block and carriage are columns
 * without an upper end, the gantry is all that is above gantry_height, along the tool's axis. Where
 * the tool's axis points and how the boxes stand about it is what clearance_turning says.
 *
 * A hit is a point of an earlier bead deeper than CLEARANCE_TOLERANCE inside the tool. Of the
 * nozzle less is asked where it prints: there it may reach into earlier beads as far as it would
 * if it were higher, along its axis, by the `height` of the move. On a slope the flat tip presses
 * by tip_diameter / 2 * tan(slope) into the layer it lies on: beads may lie as steep as that is no
 * more than the layer is thick, and less steep than the cone's side. A run of travels prints where
 * the tip is no more than a tip's diameter from where the run began (height of the bead before it)
 * or will end (height of the bead after it); between it must be clear of everything. */
#ifndef ISO_CLEARANCE_CLEARANCE_H
#define ISO_CLEARANCE_CLEARANCE_H

#include <stdbool.h>
#include <stddef.h>

#include <isoslice/geometry.h>
#include <isoslice/status.h>

/* mm. What the G-code rounds, and what lines are off the surface they stand for, stays below it.
 * What this module answers is exact to less than 0.005 mm. */
#define CLEARANCE_TOLERANCE 0.01

/* How the machine turns the part, or the tool: for the tool it's all the same. */
typedef enum clearance_turning {
    CLEARANCE_UPRIGHT,  /* not at all: the axis is z whatever the normals are; boxes along x, y */
    CLEARANCE_ABOUT_X,  /* a mandrel along X: the axis is the normal; the boxes' x is the part's,
                           seen along the axis */
    CLEARANCE_ABOUT_Y,  /* along Y: their y is the part's */
    CLEARANCE_ABOUT_ALL /* a table that turns: a box is the disc around the axis that it fits in */
} clearance_turning;

/* mm and degrees, as the profile has them. Heights are above the tip. Boxes reach from `low` to
 * `high` around the tip, x and y; a box without extent isn't there. */
typedef struct clearance_tool {
    double tip_diameter;            /* of the flat around the hole */
    double cone_angle;              /* of the cone's side to the tool's axis */
    double cone_height;             /* where the heater block begins */
    iso_vec2 block_low, block_high; /* the heater block, upwards from cone_height */
    double carriage_height;
    iso_vec2 carriage_low, carriage_high;
    double gantry_height; /* above it is nothing but the machine; 0: no limit */
    clearance_turning turning;
} clearance_tool;

typedef struct clearance_move {
    iso_vec3 from, to;               /* mm: the tip, in the frame of the part */
    iso_vec3 from_normal, to_normal; /* unit: across the layer, upwards */
    double width, height;            /* mm of the bead it leaves; 0: a travel */
} clearance_move;

typedef struct clearance clearance;

typedef struct clearance_hit {
    int64_t move;        /* which one, counted from 0 */
    int64_t bead;        /* the move that left what is hit */
    iso_vec3 tip, place; /* mm */
    double depth;        /* mm that the body reaches into the bead, about */
    const char *part;    /* of the tool: "nozzle", "heater block", "carriage", "gantry" */
} clearance_hit;

/* ISO_BAD_CONFIG: a tool that makes no sense. */
iso_status clearance_new(clearance **made, const clearance_tool *tool) ISO_MUST_CHECK;
void clearance_free(clearance *check); /* NULL is allowed */

/* What comes next in the print. ISO_OUTSIDE: a bead beyond ISO_COORDINATE_MAX. Most moves are
 * proven free here; what remains is for Embree. ISO_BAD_CONFIG: its module is needed, and missing.
 */
iso_status clearance_add(clearance *check, const clearance_move *move) ISO_MUST_CHECK;

/* Look at all that was added since. *found: is there a hit? Then *hit is the first, here and in all
 * later calls. Travels at the end wait for where they go, but not if they are the `last` moves.
 * The same answer however many calls there are. */
iso_status clearance_check(clearance_hit *hit, bool *found, clearance *check,
                           bool last) ISO_MUST_CHECK;

/* ISO_NOT_VERIFIED, with a message: which part of the tool would touch what, and what to change. */
iso_status clearance_refuse(const clearance_hit *hit) ISO_MUST_CHECK;

/* What it took: moves added, those that only Embree's candidates could decide, and bytes held. */
typedef struct clearance_cost {
    int64_t moves, beads, doubtful, bytes;
} clearance_cost;
clearance_cost clearance_cost_of(const clearance *check);

#endif

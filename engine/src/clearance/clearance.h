/* Clearance: does the tool anywhere touch what is already printed?
 *
 * The tool is a body around its tip: the nozzle's flat tip and cone, the heater block, the carriage
 * and the gantry. Every move of the finished G-code is looked at, in order, against all beads that
 * came before it. What the flat tip presses into the bead beside it, by no more than the layer is
 * thick there, is printing and no collision. */
#ifndef ISO_CLEARANCE_CLEARANCE_H
#define ISO_CLEARANCE_CLEARANCE_H

#include <isoslice/geometry.h>
#include <isoslice/status.h>

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
} clearance_tool;

typedef struct clearance_move {
    iso_vec3 from, to;               /* mm: the tip, in the frame of the part */
    iso_vec3 from_normal, to_normal; /* unit: where the tool comes from */
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

/* ISO_BAD_CONFIG: the module with Embree is missing. */
iso_status clearance_new(clearance **made, const clearance_tool *tool) ISO_MUST_CHECK;
void clearance_free(clearance *clearance);

/* What comes next in the print. */
iso_status clearance_add(clearance *clearance, const clearance_move *move) ISO_MUST_CHECK;

/* Look at all that was added since. *found: is there a hit? Then *hit is the first. */
iso_status clearance_check(clearance_hit *hit, int *found, clearance *clearance) ISO_MUST_CHECK;

#endif

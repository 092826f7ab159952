/* Does a part of the tool, on a piece of its way, reach into a bead?
 *
 * Both are convex: the part between two poses is their hull, a bead the hull of the flats at its
 * ends with a ball rolled around it. Their distance is found by walking on the difference of the
 * two (Gilbert, Johnson, Keerthi: A fast procedure for computing the distance between complex
 * objects in three-dimensional space, 1988). */
#ifndef ISO_CLEARANCE_TOUCH_H
#define ISO_CLEARANCE_TOUCH_H

#include "clearance/tool.h"

/* The hull of two half discs, and all that is no more than `ball` from it. A half disc is spanned
 * by a diameter along `side` and a radius along `out`; a bead without length, or one that goes
 * straight up, has whole discs. */
typedef struct touch_bead {
    iso_vec3 center[2], normal[2], side[2], out[2];
    double disc, ball; /* radii */
} touch_bead;

/* The tool was upright or not: ends don't rise above what the tip leaves beneath itself. */
touch_bead touch_bead_of(const clearance_move *move, bool upright);

/* Between two poses of the tool. */
typedef struct touch_sweep {
    tool_shape shape;
    tool_pose pose[2];
} touch_sweep;

bool touch_meets(const touch_sweep *sweep, const touch_bead *bead);

/* A point of the bead in or near the sweep: the one that is left if the shape shrinks until it just
 * meets the bead. */
iso_vec3 touch_place(const touch_sweep *sweep, const touch_bead *bead);

/* The farthest points of each in a direction. */
iso_vec3 touch_sweep_support(const touch_sweep *sweep, iso_vec3 direction);
iso_vec3 touch_bead_support(const touch_bead *bead, iso_vec3 direction); /* without its ball */

#endif

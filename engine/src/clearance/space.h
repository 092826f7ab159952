/* The space: where beads are, for tools that turn.
 *
 * A tree of cubes, eight in each, down to cells of 1 mm. A cell knows a plane that nothing in it is
 * above, square to the beads there. Moves are proven free because the tool is farther from a cube's
 * middle than its corners are, or above a cell's plane. */
#ifndef ISO_CLEARANCE_SPACE_H
#define ISO_CLEARANCE_SPACE_H

#include "clearance/ground.h"

typedef struct space_map space_map;

iso_status space_new(space_map **made, const tool_body *tool) ISO_MUST_CHECK;
void space_free(space_map *space); /* NULL is allowed */

/* Within ISO_COORDINATE_MAX. */
iso_status space_add(space_map *space, const clearance_move *bead) ISO_MUST_CHECK;

/* What of the tool, turning evenly from one pose to the other, isn't proven free, and where. Pieces
 * should be short and turn little. */
void space_check(ground_doubt *doubt, const space_map *space, const tool_pose pose[2],
                 double raise);

int64_t space_bytes(const space_map *space);

#endif

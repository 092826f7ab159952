/* The room: where beads are, for tools that turn.
 *
 * A tree of cubes, eight in each, down to cells of 0.7 mm. A cell knows a plane that nothing in it
 * is above, square to the beads there. Moves are proven free because the tool is farther from a
 * cube's middle than its corners are, or above a cell's plane. */
#ifndef ISO_CLEARANCE_ROOM_H
#define ISO_CLEARANCE_ROOM_H

#include "clearance/ground.h"

typedef struct room_map room_map;

iso_status room_new(room_map **made, const tool_body *tool) ISO_MUST_CHECK;
void room_free(room_map *room); /* NULL is allowed */

/* Within ISO_COORDINATE_MAX. */
iso_status room_add(room_map *room, const clearance_move *bead) ISO_MUST_CHECK;

/* What of the tool, turning evenly from one pose to the other, isn't proven free, and where. Pieces
 * should be short and turn little. */
void room_check(ground_doubt *doubt, const room_map *room, const tool_pose pose[2], double raise);

int64_t room_bytes(const room_map *room);

#endif

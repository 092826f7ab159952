/* In which order are a layer's islands to be printed, so that the tool doesn't touch those that are
 * already there?
 *
 * Where layers are curved, islands of one layer lie at different heights, and the tool at a low one
 * may reach a high one beside it. */
#ifndef ISO_CLEARANCE_REACH_H
#define ISO_CLEARANCE_REACH_H

#include "base/memory.h"
#include "clearance/clearance.h"

/* The box of all that the tip does on an island, mm. */
typedef struct reach_group {
    iso_vec3 low, high;
} reach_group;

/* order[count]: which group is first, second and so on. One goes before another if it begins lower
 * and the tool at its lowest place would, by what boxes tell, touch the other's highest; else they
 * stay as they are, but that a group which has to go before one drags those along that have to go
 * before itself. There always is such an order: the relation goes upwards. It is not a proof: two
 * islands may both be in the way of the other, which clearance_check tells. Of tools that turn
 * boxes tell nothing: all stay as they are. ISO_BAD_CONFIG as of clearance_new. */
iso_status reach_order(int32_t *order, const reach_group *group, int32_t count,
                       const clearance_tool *tool, iso_arena *scratch) ISO_MUST_CHECK;

#endif

/* Triangles in the order of a balanced tree: halves by the middles along the longer side, so that a
 * node's triangles follow from its number and nothing points anywhere. */
#ifndef ISO_SOLID_HALVES_H
#define ISO_SOLID_HALVES_H

#include <isoslice/geometry.h>
#include <isoslice/status.h>

/* First of the `number`th node's triangles, from 0, on a level of 2^level nodes. */
static inline int64_t halves_first(int64_t count, int level, int64_t number) {
    return count * number >> level;
}

/* order[count]: which triangle of corner[3 count] comes at each place, for levels 0 to `levels`. */
iso_status halves_order(int32_t *order, const iso_vec3 *corner, int64_t count,
                        int levels) ISO_MUST_CHECK;

#endif

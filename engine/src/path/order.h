/* The order in which a layer's paths are printed. */
#ifndef ISO_PATH_ORDER_H
#define ISO_PATH_ORDER_H

#include <isoslice/path.h>

#include "base/memory.h"

/* Put the paths of a layer in printing order, starting from *position, where the nozzle stands, and
 * leave there where it ends.
 *
 * Groups of one object stay together, the nearest next. Within a group lower ranks go first; within
 * a rank the path that starts nearest is next. A closed path starts at its nearest vertex, an open
 * one at its nearer end (reversed, each bead keeps its width and area). Ties go to the path, then
 * the vertex, that came first in `in`; so the result depends on nothing but the arguments.
 *
 * `out` is cleared first and keeps its capacity; out != in. Paths without vertices are dropped.
 * Scratch is left as it was found. */
iso_status iso_order_layer(iso_paths *out, const iso_paths *in, iso_point *position,
                           iso_arena *scratch) ISO_MUST_CHECK;

#endif

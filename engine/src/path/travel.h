/* How the nozzle comes from path to path: straight or around walls, with the filament drawn back or
 * not. */
#ifndef ISO_PATH_TRAVEL_H
#define ISO_PATH_TRAVEL_H

#include "path/order.h"

/* Fill in retract, travel_first and travel_count of an ordered layer's paths; the nozzle comes from
 * `from`.
 *
 * Inside is what closed external walls enclose, by the middles of their beads and by even and odd.
 * A way is hidden if it is inside all along and crosses no top surface that is already printed.
 * With retract_crossing_only hidden ways don't retract; with avoid_crossing the shortest way inside
 * is taken where the straight one is not, if it is no longer than max_detour allows: it turns at
 * walls' vertices. Ways no longer than cost.retract_before are left alone. Scratch is left as it
 * was found. */
iso_status iso_travel_plan(iso_paths *paths, iso_point from, const iso_order_options *options,
                           iso_arena *scratch) ISO_MUST_CHECK;

#endif

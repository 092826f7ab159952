/* The order in which a layer's paths are printed, where closed ones begin, and how the nozzle comes
 * from one to the next (docs/paths.md). */
#ifndef ISO_PATH_ORDER_H
#define ISO_PATH_ORDER_H

#include <isoslice/path.h>

#include "base/memory.h"
#include "path/seam.h"
#include "path/tour.h"

typedef struct iso_order_options {
    iso_seam seam;             /* of external walls */
    int infill_first;          /* before the walls of its group */
    int retract_crossing_only; /* not on ways inside the part (iso_travel_plan) */
    int avoid_crossing;        /* lead ways around walls */
    double max_detour;         /* units; 0: no limit */
    double max_detour_share;   /* of the straight way; 0: no limit */
    iso_travel_cost cost;
} iso_order_options;

/* Seams where the nozzle is, everything retracts; 150 mm/s, 1000 mm/s^2, 0.18 s, 2 mm. */
iso_order_options iso_order_defaults(void);

/* What goes on from layer to layer. Zero-initialise; iso_order_state_free at the end. */
typedef struct iso_order_state {
    iso_point position; /* of the nozzle */
    iso_seams seams;
} iso_order_state;

void iso_order_state_free(iso_order_state *state);

/* Put the paths of a layer in printing order, starting from state->position, where the nozzle
 * stands, and leave there where it ends.
 *
 * Groups with a skirt go first, then the nearest is next. Within a group go skirt and supports,
 * walls, fill (before the walls if so asked), ironing, the rest. Walls are ordered by rank only
 * where they lie side by side: each external wall follows those that lie within it, or they follow
 * it, and their seams are side by side, too. All fill of a group is one tour, whatever its ranks;
 * the rest goes by rank. Open paths may be reversed, each bead keeps its width, area and role.
 * External walls may get a vertex more, at their seam.
 *
 * The result depends on nothing but the arguments. `out` is cleared first and keeps its capacity;
 * out != in. Paths without vertices are dropped. Scratch is left as it was found. On failure `out`
 * is empty. */
iso_status iso_order_layer(iso_paths *out, const iso_paths *in, iso_order_state *state,
                           const iso_order_options *options, iso_arena *scratch) ISO_MUST_CHECK;

#endif

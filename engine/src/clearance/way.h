/* A move cut where what the nozzle may press into changes. */
#ifndef ISO_CLEARANCE_WAY_H
#define ISO_CLEARANCE_WAY_H

#include "base/vector.h"
#include "clearance/clearance.h"

/* A run of travels, between two beads: where it begins and ends and how far the nozzle may reach
 * into beads there; 0: it comes from, or goes to, nowhere. */
typedef struct way_run {
    iso_vec3 begin, end;
    double begin_height, end_height;
} way_run;

typedef struct way_section {
    double from, to; /* of the move, 0 to 1 */
    double raise;    /* mm that the nozzle may be higher */
} way_section;

enum { WAY_SECTIONS = 5 };

/* How many there are. Beads have one; `run` is of travels only. */
int way_sections(way_section section[WAY_SECTIONS], const clearance_move *move, const way_run *run,
                 double tip_diameter);

/* The bead of a move, with normals that are square to its line: at a sharp ridge the layer's may be
 * of either side, but the nozzle leaves nothing above its own way. */
clearance_move way_bead(const clearance_move *move);

static inline bool is_bead(const clearance_move *move) {
    return move->width > 0 && move->height > 0;
}

#endif

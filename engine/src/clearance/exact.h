/* What the ground can't prove free is decided here, bead by bead. */
#ifndef ISO_CLEARANCE_EXACT_H
#define ISO_CLEARANCE_EXACT_H

#include "clearance/beads.h"
#include "clearance/ground.h"
#include "clearance/tool.h"
#include "clearance/way.h"

typedef struct exact_move {
    clearance_move move;
    way_run run;
    int64_t index;
    ground_doubt doubt; /* only there, and only these parts, may touch something */
} exact_move;

/* The first of the moves that hits a bead before it, and there the bead that is hit deepest. */
iso_status exact_check(clearance_hit *hit, bool *found, const tool_body *tool, bead_store *beads,
                       const exact_move *moves, int64_t count) ISO_MUST_CHECK;

#endif

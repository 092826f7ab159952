/* What the planar operations keep between calls. */
#ifndef ISO_PLANAR_SCRATCH_H
#define ISO_PLANAR_SCRATCH_H

#include "planar/arrangement.h"

struct iso_planar_scratch {
    iso_arena arena;
    iso_edges edges;
    iso_snap_room room;
    iso_region raw; /* contours on their way into an arrangement */
    iso_planar_counts counts;
};

/* Does a face belong to a result, by its winding numbers? */
typedef bool iso_face_rule(const iso_winding *winding, const void *context);

/* A result asked of an arrangement. */
typedef struct iso_choice {
    iso_region *out;
    iso_face_rule *rule;
    const void *context;
} iso_choice;

/* Arrange the edges in scratch->edges and fill each choice's region with the faces its rule
 * chooses. Empties scratch->edges; on failure clears all the regions. */
iso_status planar_resolve(const iso_choice *choice, int count,
                          iso_planar_scratch *scratch) ISO_MUST_CHECK;

#endif

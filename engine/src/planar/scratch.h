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

/* Which faces belong to the result, by their winding numbers. */
typedef bool iso_face_rule(iso_winding winding);

/* Arrange the edges in scratch->edges and fill `out` with the faces that `rule` chooses. Empties
 * scratch->edges; on failure clears `out`. */
iso_status planar_resolve(iso_region *out, iso_face_rule *rule,
                          iso_planar_scratch *scratch) ISO_MUST_CHECK;

#endif

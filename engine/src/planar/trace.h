/* From chosen faces of an arrangement to a region. */
#ifndef ISO_PLANAR_TRACE_H
#define ISO_PLANAR_TRACE_H

#include "planar/region.h"
#include "planar/scratch.h"

/* Append the boundary of the faces that `rule` chooses to the cleared region `out`: simple contours
 * in the order of their lexicographic least points, each starting there, with their parents. */
iso_status trace_region(iso_region *out, const iso_arrangement *arrangement, iso_face_rule *rule,
                        iso_arena *arena) ISO_MUST_CHECK;

#endif

/* From chosen faces of an arrangement to a region. */
#ifndef ISO_PLANAR_TRACE_H
#define ISO_PLANAR_TRACE_H

#include "planar/region.h"
#include "planar/scratch.h"

/* Fill the choice's region, cleared before, with the boundary of the faces it chooses: simple
 * contours in the order of their lexicographic least points, each starting there, with their
 * parents. */
iso_status trace_region(const iso_choice *choice, const iso_arrangement *arrangement,
                        iso_arena *arena) ISO_MUST_CHECK;

#endif

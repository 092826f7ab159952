/* A side of the mould with openings, as triangles. */
#ifndef ISO_CHANNEL_OPENING_H
#define ISO_CHANNEL_OPENING_H

#include <isoslice/planar.h>

/* raw: the side's outline, then its openings, all of which must be within it and apart:
 * ISO_NOT_VERIFIED else. corner[3 count], counter-clockwise, to be released; no corner is new. */
iso_status side_with_openings(iso_point **corner, int64_t *count,
                              const iso_region *raw) ISO_MUST_CHECK;

#endif

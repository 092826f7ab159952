/* Outlines seen from above, and the convex pieces that they are made of. */
#ifndef ISO_OBJECT_OUTLINE_H
#define ISO_OBJECT_OUTLINE_H

#include <isoslice/mesh.h>
#include <isoslice/planar.h>

#include "base/memory.h"

/* What the meshes cover, without its holes; empty if that would take longer than it is worth. */
iso_status outline_of(iso_region *outline, const iso_mesh *mesh, int32_t count,
                      iso_planar_scratch *scratch) ISO_MUST_CHECK;

/* Convex polygons, counter-clockwise, that overlap in their sides alone. */
typedef struct iso_pieces {
    int32_t count;
    int32_t *first;   /* [count + 1] */
    iso_point *point; /* [first[count]] */
} iso_pieces;

/* `pieces` owns its arrays. Holes of the region count as filled. */
iso_status outline_pieces(iso_pieces *pieces, const iso_region *region) ISO_MUST_CHECK;
void outline_pieces_free(iso_pieces *pieces);

#endif

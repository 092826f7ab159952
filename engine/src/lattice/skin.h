/* The distance to a part's surface, sampled. */
#ifndef ISO_LATTICE_SKIN_H
#define ISO_LATTICE_SKIN_H

#include <isoslice/mesh.h>

#include "solid/volume.h"

typedef struct iso_skin_options {
    iso_vec3 origin; /* of the frame that the volume is in, in the meshes' coordinates */
    double voxel;    /* mm */
    double inner;    /* mm; deeper inside, the distance is this */
    double outer;    /* mm; the same outside; 0: 4 voxels */
} iso_skin_options;

/* Distances to the surface of what the meshes enclose, negative inside. */
iso_status skin_make(iso_volume **skin, const iso_mesh *mesh, int32_t count,
                     const iso_skin_options *options) ISO_MUST_CHECK;

#endif

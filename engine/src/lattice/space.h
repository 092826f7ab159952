/* The part's frame, and what is known of any place in it. */
#ifndef ISO_LATTICE_SPACE_H
#define ISO_LATTICE_SPACE_H

#include <isoslice/lattice.h>
#include <isoslice/mesh.h>

#include "lattice/grading.h"
#include "solid/volume.h"

typedef struct iso_space {
    iso_vec3 origin;        /* of the frame, in the meshes' coordinates */
    iso_vec3 min, max;      /* of the part, in the frame */
    double least_r, mean_r; /* mm from the z axis: of the surface, of the volume's mean */
    double mean_radius;     /* mm from the box's middle, of the volume's mean */
    iso_volume *skin;       /* distance to the surface; NULL: not asked for */
    iso_volume *grid;       /* lattice_grid; the same */
} iso_space;

/* Skin and grid as far as `wanted` has the variables' bits. */
iso_status space_make(iso_space *space, const iso_lattice_options *options, uint32_t wanted,
                      const iso_mesh *mesh, int32_t count) ISO_MUST_CHECK;
void space_free(iso_space *space);

/* Up to GRADING_BLOCK places in the frame, and what was asked for of each. */
typedef struct iso_places {
    double value[GRADING_VARIABLES][GRADING_BLOCK];
    const double *variable[GRADING_VARIABLES];
} iso_places;

/* With x, y and z known, the others as far as `wanted` has their bits. */
void space_know(iso_places *places, const iso_space *space, uint32_t wanted, int32_t count);

#endif

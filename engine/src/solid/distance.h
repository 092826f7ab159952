/* Exact distances to triangles, in blocks of 8 x 8 x 8 voxels where they are near enough. */
#ifndef ISO_SOLID_DISTANCE_H
#define ISO_SOLID_DISTANCE_H

#include "solid/volume.h"

typedef struct distance_output {
    /* value[512], x fastest, from -inner to outer mm; `first` is the block's first voxel. */
    iso_status (*block)(void *payload, const int32_t first[3], const float *value);
    iso_status (*full)(void *payload, const int32_t first[3]); /* inside, farther than `inner` */
    void *payload;
} distance_output;

/* Blocks in a fixed order; none where all is outside, farther than `outer`. */
iso_status distance_fill(const iso_volume_surface *surface,
                         const distance_output *output) ISO_MUST_CHECK;

/* The box that blocks are looked for in. */
void distance_box(iso_vec3 *min, iso_vec3 *max, const iso_volume_surface *surface);

#endif

/* Volumes: sparse grids of numbers in space, by OpenVDB, in the module isoslice-volume.so.
 *
 * All lengths are mm, values of distance grids too: negative inside. Nothing of OpenVDB is seen
 * from here; every function fails with ISO_BAD_CONFIG where the module can't be opened. */
#ifndef ISO_SOLID_VOLUME_H
#define ISO_SOLID_VOLUME_H

#include <stdint.h>

#include <isoslice/geometry.h>
#include <isoslice/status.h>

typedef struct iso_volume iso_volume;

void volume_free(iso_volume *volume);

typedef struct iso_volume_info {
    iso_vec3 min, max;   /* box of the active voxels' middles */
    double voxel;        /* edge; grids with other transforms than scale and shift are refused */
    double background;   /* value where nothing is stored */
    int64_t active;      /* voxels */
    int64_t bytes;       /* in memory */
    int32_t is_distance; /* a level set by its own account */
} iso_volume_info;
void volume_info(iso_volume_info *info, const iso_volume *volume);

/* inside[i] != 0 where point[i] is inside. */
typedef iso_status volume_inside(void *payload, uint8_t *inside, const iso_vec3 *point,
                                 int64_t count);

typedef struct iso_volume_surface {
    const iso_vec3 *corner; /* [3 count] of each triangle */
    int64_t count;
    double voxel;
    double outer, inner;   /* mm; distances are known this far outside and inside */
    volume_inside *inside; /* tells the sign, whatever the triangles' sense, and is asked about one
                            * voxel of many that no triangle comes between: where the surface has
                            * holes, take 0 everywhere and find the sign otherwise. NULL: by how
                            * often shells turn around a voxel, which needs closed ones */
    void *payload;
} iso_volume_surface;

/* Distance to triangles that need not fit together: exact, but for the rounding to float, up to
 * `outer` outside and `inner` inside; beyond, `outer` and -`inner`. */
iso_status volume_from_surface(iso_volume **volume,
                               const iso_volume_surface *surface) ISO_MUST_CHECK;

/* What a new grid is made of, block by block. `corner` is the middle of the block's first voxel;
 * value is [ISO_VOLUME_BLOCK^3], z slowest: value[x + 8 (y + 8 z)]. Called by one thread for every
 * block that has a voxel in the plan's box, x fastest, z slowest. */
enum { ISO_VOLUME_BLOCK = 8 };
typedef iso_status volume_fill(void *payload, float *value, iso_vec3 corner);

typedef enum iso_volume_kind {
    ISO_VOLUME_DISTANCE, /* a level set: float, kept within 3 voxels of zero */
    ISO_VOLUME_SOLID     /* a mask: one bit a voxel, where the value is <= 0 */
} iso_volume_kind;

typedef struct iso_volume_plan {
    iso_vec3 min, max; /* voxel 0 has its middle at min; what sticks out of the box is cut off */
    double voxel;
    iso_volume_kind kind;
    const char *name; /* of the grid */
    volume_fill *fill;
    void *payload;
} iso_volume_plan;
iso_status volume_build(iso_volume **volume, const iso_volume_plan *plan) ISO_MUST_CHECK;

/* name NULL: the first grid of numbers or of bits. ISO_UNREADABLE: no file, no .vdb, a damaged one,
 * no such grid. */
iso_status volume_read(iso_volume **volume, const char *path, const char *name) ISO_MUST_CHECK;
/* Whole or not at all, the same bytes for the same grid; ISO_NOT_WRITTEN. */
iso_status volume_write(const iso_volume *volume, const char *path) ISO_MUST_CHECK;

/* Trilinear; the background outside. A mask is 1 where it's on and 0 elsewhere. Any number of
 * threads at once. */
iso_status volume_sample(double *value, const iso_volume *volume, const iso_vec3 *point,
                         int64_t count) ISO_MUST_CHECK;

/* The surface where the value is `level`, outward = to larger values; a mask's goes between on and
 * off, whatever the level. [9 count] floats, as iso_mesh_from_triangles takes them, in an order
 * that is always the same; free with iso_release. */
iso_status volume_surface(float **triangle, int64_t *count, const iso_volume *volume,
                          double level) ISO_MUST_CHECK;

/* Grey pictures of one size, "slice%03d.png" (from 0 or 1 on) or a folder whose *.png are taken by
 * name: value[x + width (y + height z)] from 0 black to 255 white, picture 0 lowest, its last row
 * at y = 0. Free with iso_release. ISO_UNREADABLE names the file. */
iso_status volume_read_pictures(uint8_t **value, int32_t size[3], const char *path) ISO_MUST_CHECK;

#endif

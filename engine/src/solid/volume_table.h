/* The table of isoslice-volume.so: grids of OpenVDB, and libpng's pictures.
 *
 * Whatever returns a status writes what went wrong to message[VOLUME_MESSAGE]. Index space: voxel
 * (i, j, k) has its middle at origin + voxel * (i, j, k). */
#ifndef ISO_SOLID_VOLUME_TABLE_H
#define ISO_SOLID_VOLUME_TABLE_H

#include <stddef.h>
#include <stdint.h>

#include <isoslice/status.h>

#include "solid/module.h"

typedef struct volume_grid volume_grid;

enum { VOLUME_MESSAGE = 400, VOLUME_EDGE = 8, VOLUME_CELLS = 512 };

typedef struct volume_form {
    double origin[3], voxel;
    float outside, inside; /* of a grid of numbers: the background, and what tiles inside have */
    int32_t is_mask;
    int32_t is_distance;
    const char *name;
} volume_form;

typedef struct volume_facts {
    double origin[3], voxel, background;
    int32_t min[3], max[3]; /* of the active voxels; min > max: none */
    int64_t active, bytes;
    int32_t is_mask, is_distance;
} volume_facts;

/* Where a file goes: `size` bytes at `offset`, which is at most what there is already; not 0: it
 * failed and said so itself. */
typedef struct volume_sink {
    int (*write)(void *payload, int64_t offset, const void *bytes, size_t size);
    void *payload;
} volume_sink;

typedef struct volume_triangles {
    void *(*allocate)(size_t size); /* NULL: there is no memory */
    float *corner;                  /* [9 count] */
    int64_t count;
} volume_triangles;

typedef struct volume_picture {
    void *(*allocate)(size_t size);
    void (*release)(void *block);
    uint8_t *value; /* [width height], the top row first */
    int32_t width, height;
} volume_picture;

typedef struct volume_table {
    module_header header;

    iso_status (*grid_new)(volume_grid **grid, const volume_form *form, char *message);
    void (*grid_free)(volume_grid *grid);
    /* value[x + 8 (y + 8 z)] of the block whose first voxel is `first`, a multiple of 8 in x, y and
     * z. Numbers count where they lie between `inside` and `outside`, a mask's where <= 0. */
    iso_status (*grid_block)(volume_grid *grid, const int32_t first[3], const float *value,
                             char *message);
    /* A block that is inside all through. */
    iso_status (*grid_full)(volume_grid *grid, const int32_t first[3], char *message);
    iso_status (*grid_finish)(volume_grid *grid, char *message); /* no more blocks */

    iso_status (*grid_read)(volume_grid **grid, const char *path, const char *name, char *message);
    iso_status (*grid_write)(const volume_grid *grid, const volume_sink *sink, char *message);
    iso_status (*grid_facts)(volume_facts *facts, const volume_grid *grid, char *message);
    iso_status (*grid_sample)(double *value, const volume_grid *grid, const double *point,
                              int64_t count, char *message);
    iso_status (*grid_surface)(volume_triangles *triangles, const volume_grid *grid, double level,
                               char *message);

    iso_status (*picture_read)(volume_picture *picture, const char *path, char *message);
} volume_table;

/* In pictures.c. */
#ifdef __cplusplus
extern "C"
#endif
    iso_status
    volume_picture_read(volume_picture *picture, const char *path, char *message);

#endif

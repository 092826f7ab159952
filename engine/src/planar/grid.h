/* A uniform grid over edges, in CSR form, in layers: the first holds the input, each further one
 * the pieces that a round of snap rounding made. All layers share the same cells. */
#ifndef ISO_PLANAR_GRID_H
#define ISO_PLANAR_GRID_H

#include "planar/edges.h"

enum { GRID_LAYERS_MAX = 40 };

typedef struct iso_grid_layer {
    int32_t *first; /* [cells + 1] */
    int32_t *slot;  /* [first[cells]] */
} iso_grid_layer;

typedef struct iso_grid {
    iso_point origin;
    int shift; /* a cell is 2^shift units wide */
    int32_t columns, rows;
    int32_t layer_count;
    iso_grid_layer layer[GRID_LAYERS_MAX];
} iso_grid;

/* Choose cells for the edges and build the first layer. The edges must not be empty. */
iso_status grid_build(iso_grid *grid, const iso_edges *edges, iso_arena *arena) ISO_MUST_CHECK;

/* Add a layer with the edges from slot `first` on. */
iso_status grid_add_layer(iso_grid *grid, const iso_edges *edges, int32_t first,
                          iso_arena *arena) ISO_MUST_CHECK;

static inline int32_t grid_cell(const iso_grid *grid, iso_point p) {
    return ((p.y - grid->origin.y) >> grid->shift) * grid->columns +
           ((p.x - grid->origin.x) >> grid->shift);
}

#endif

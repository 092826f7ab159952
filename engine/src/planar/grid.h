/* A uniform grid over runs of edges, in CSR form, in layers: the first holds the input, each
 * further one the pieces that a round of snap rounding made. All layers share the same cells.
 *
 * A run is a stretch of consecutive edges that go strictly one way in x or in y, so that within it
 * only neighbours can meet. Dense smooth contours need a fraction of the entries that their edges
 * would. */
#ifndef ISO_PLANAR_GRID_H
#define ISO_PLANAR_GRID_H

#include "planar/edges.h"
#include "planar/predicate.h"

enum { GRID_LAYERS_MAX = 40 };

typedef struct iso_run {
    iso_box box;
    int32_t first, count; /* slots */
} iso_run;

typedef struct iso_grid_layer {
    int32_t run_count;
    iso_run *run;
    int32_t *first; /* [cells + 1] */
    int32_t *entry; /* [first[cells]] runs of each cell */
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

/* Add a layer with the edges from slot `first` on, each a run of its own. */
iso_status grid_add_layer(iso_grid *grid, const iso_edges *edges, int32_t first,
                          iso_arena *arena) ISO_MUST_CHECK;

static inline int32_t grid_cell(const iso_grid *grid, iso_point p) {
    return ((p.y - grid->origin.y) >> grid->shift) * grid->columns +
           ((p.x - grid->origin.x) >> grid->shift);
}

/* Does the run stand only in those cells of its box that it passes? (A single long edge.) Others
 * stand in all of them. */
static inline bool run_is_bent(const iso_grid *grid, const iso_run *run) {
    return run->count == 1 &&
           (run->box.min.x - grid->origin.x) >> grid->shift !=
               (run->box.max.x - grid->origin.x) >> grid->shift &&
           (run->box.min.y - grid->origin.y) >> grid->shift !=
               (run->box.max.y - grid->origin.y) >> grid->shift;
}

#endif

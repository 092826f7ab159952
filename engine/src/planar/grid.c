#include "planar/grid.h"

#include "planar/predicate.h"

/* Cells of about two mean edge lengths hold a handful of edges each; fewer than two cells an edge
 * keep the memory in proportion when a few edges are much longer than the others. */
static void grid_choose_cells(iso_grid *grid, const iso_edges *edges) {
    iso_point min = edges->from[0], max = min;
    int64_t length = 0;
    for (int32_t e = 0; e < edges->count; e++) {
        iso_point a = edges->from[e], b = edges->to[e];
        length += a.x < b.x ? b.x - a.x : a.x - b.x;
        length += a.y < b.y ? b.y - a.y : a.y - b.y;
        min.x = a.x < min.x ? a.x : min.x;
        min.y = a.y < min.y ? a.y : min.y;
        max.x = a.x > max.x ? a.x : max.x;
        max.y = a.y > max.y ? a.y : max.y;
    }
    grid->origin = min;
    int64_t wanted = length / edges->count, cells_max = 2 * (int64_t)edges->count + 16;
    grid->shift = 2;
    while (((int64_t)1 << grid->shift) < wanted)
        grid->shift++;
    for (;; grid->shift++) {
        grid->columns = ((max.x - min.x) >> grid->shift) + 1;
        grid->rows = ((max.y - min.y) >> grid->shift) + 1;
        if ((int64_t)grid->columns * grid->rows <= cells_max)
            break;
    }
}

/* Cells are [k 2^shift - 1/2, (k + 1) 2^shift - 1/2): every hot pixel lies in one. */
typedef struct iso_cell_run {
    int32_t first, last; /* columns */
} iso_cell_run;

/* The columns in which a long edge may pass the rows' strip; one unit is added on both sides. */
static iso_cell_run run_in_row(const iso_grid *grid, iso_point low, iso_point high, int32_t row) {
    int64_t dx = (int64_t)high.x - low.x, dy = (int64_t)high.y - low.y;
    int64_t y0 = ((int64_t)row << grid->shift) - 1, y1 = y0 + ((int64_t)1 << grid->shift) + 1;
    y0 -= (int64_t)low.y - grid->origin.y;
    y1 -= (int64_t)low.y - grid->origin.y;
    y0 = y0 < 0 ? 0 : y0;
    y1 = y1 > dy ? dy : y1;
    int64_t xa = dx * y0 / dy, xb = dx * y1 / dy;
    int64_t x0 = (xa < xb ? xa : xb) - 1, x1 = (xa < xb ? xb : xa) + 1;
    int64_t left = dx < 0 ? dx : 0,
            right = dx < 0 ? 0 : dx; /* stay within the edge's own columns */
    x0 = x0 < left ? left : x0;
    x1 = x1 > right ? right : x1;
    int64_t shift_x = (int64_t)low.x - grid->origin.x;
    return (iso_cell_run){(int32_t)((x0 + shift_x) >> grid->shift),
                          (int32_t)((x1 + shift_x) >> grid->shift)};
}

/* Count pass: entries and the cells' sizes. Fill pass: the slots. One loop serves both, so that
 * they agree. */
static int64_t grid_visit(iso_grid *grid, const iso_edges *edges, int32_t begin, int32_t *position,
                          int32_t *slots) {
    int64_t entries = 0;
    int shift = grid->shift;
    for (int32_t e = begin; e < edges->count; e++) {
        iso_point a = edges->from[e], b = edges->to[e];
        int32_t ca = (a.x - grid->origin.x) >> shift, cb = (b.x - grid->origin.x) >> shift;
        int32_t ra = (a.y - grid->origin.y) >> shift, rb = (b.y - grid->origin.y) >> shift;
        iso_cell_run run = ca < cb ? (iso_cell_run){ca, cb} : (iso_cell_run){cb, ca};
        int32_t row = ra < rb ? ra : rb, row_end = ra < rb ? rb : ra;
        bool bent = row != row_end && run.first != run.last;
        iso_point low = a.y < b.y ? a : b, high = a.y < b.y ? b : a;
        for (; row <= row_end; row++) {
            if (bent)
                run = run_in_row(grid, low, high, row);
            int32_t cell = row * grid->columns;
            for (int32_t c = run.first; c <= run.last; c++, entries++) {
                if (slots)
                    slots[--position[cell + c]] = e;
                else
                    position[cell + c]++;
            }
        }
    }
    return entries;
}

iso_status grid_add_layer(iso_grid *grid, const iso_edges *edges, int32_t begin, iso_arena *arena) {
    if (grid->layer_count == GRID_LAYERS_MAX)
        return iso_fail(ISO_BUG, "snap rounding did not settle in %d rounds", GRID_LAYERS_MAX);
    int32_t cells = grid->columns * grid->rows;
    iso_grid_layer *layer = &grid->layer[grid->layer_count];
    ISO_TRY(ISO_PUSH(layer->first, arena, cells + 1));
    memset(layer->first, 0, (size_t)(cells + 1) * sizeof *layer->first);
    int64_t entries = grid_visit(grid, edges, begin, layer->first, NULL);
    if (entries > INT32_MAX)
        return iso_fail(ISO_OUTSIDE, "too many edges for one arrangement");
    ISO_TRY(ISO_PUSH(layer->slot, arena, entries));
    int32_t sum = 0;
    for (int32_t c = 0; c <= cells; c++)
        layer->first[c] = sum += layer->first[c];
    grid_visit(grid, edges, begin, layer->first, layer->slot); /* leaves first[c] at each start */
    grid->layer_count++;
    return ISO_OK;
}

iso_status grid_build(iso_grid *grid, const iso_edges *edges, iso_arena *arena) {
    grid->layer_count = 0;
    grid_choose_cells(grid, edges);
    return grid_add_layer(grid, edges, 0, arena);
}

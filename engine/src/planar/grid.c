#include "planar/grid.h"

#include "planar/predicate.h"

enum {
    RUN_EDGES =
        12, /* at most: a run's edges are tried one by one against those of its neighbours */
    RUN_LENGTH = 24 /* mean edges that a run may be long, so that its box stays small */
};

static int64_t edge_length(iso_point a, iso_point b) {
    int64_t dx = (int64_t)b.x - a.x, dy = (int64_t)b.y - a.y;
    return (dx < 0 ? -dx : dx) + (dy < 0 ? -dy : dy);
}

/* Which of the four strict ways the edge goes: right, left, up, down. */
static unsigned edge_ways(iso_point a, iso_point b) {
    return (unsigned)(b.x > a.x) | (unsigned)(b.x < a.x) << 1 | (unsigned)(b.y > a.y) << 2 |
           (unsigned)(b.y < a.y) << 3;
}

/* Slots of a contour are consecutive until something is split, so runs are too. Returns the sum of
 * the runs' lengths. */
static int64_t find_runs(iso_grid_layer *layer, const iso_edges *edges, int64_t longest) {
    int64_t total = 0;
    int32_t n = 0;
    for (int32_t e = 0; e < edges->count;) {
        iso_run *run = &layer->run[n++];
        iso_point a = edges->from[e], b = edges->to[e];
        int64_t length = edge_length(a, b);
        unsigned ways = edge_ways(a, b);
        *run = (iso_run){box_of(a, b), e, 1};
        for (e++; e < edges->count && run->count < RUN_EDGES && edges->successor[e - 1] == e; e++) {
            iso_point next = edges->to[e];
            ways &= edge_ways(b, next);
            length += edge_length(b, next);
            if (ways == 0 || length > longest)
                break;
            b = next;
            box_add(&run->box, b);
            run->count++;
        }
        total += edge_length(run->box.min, run->box.max);
    }
    layer->run_count = n;
    return total;
}

/* Cells about as wide as a run is long hold a handful of runs each; fewer than two cells a run keep
 * the memory in proportion when a few edges are much longer than the others. */
static void choose_cells(iso_grid *grid, iso_box box, int64_t wanted, int64_t runs) {
    grid->origin = box.min;
    grid->shift = 2;
    while (((int64_t)1 << grid->shift) < wanted)
        grid->shift++;
    for (;; grid->shift++) {
        grid->columns = ((box.max.x - box.min.x) >> grid->shift) + 1;
        grid->rows = ((box.max.y - box.min.y) >> grid->shift) + 1;
        if ((int64_t)grid->columns * grid->rows <= 2 * runs + 16)
            break;
    }
}

/* Cells are [k 2^shift - 1/2, (k + 1) 2^shift - 1/2): every hot pixel lies in one. */
typedef struct iso_cell_range {
    int32_t first, last; /* columns */
} iso_cell_range;

/* The columns in which a long edge may pass the row's strip; one unit is added on both sides. */
static iso_cell_range range_in_row(const iso_grid *grid, iso_point low, iso_point high,
                                   int32_t row) {
    int64_t dx = (int64_t)high.x - low.x, dy = (int64_t)high.y - low.y;
    int64_t y0 = ((int64_t)row << grid->shift) - 1, y1 = y0 + ((int64_t)1 << grid->shift) + 1;
    y0 -= (int64_t)low.y - grid->origin.y;
    y1 -= (int64_t)low.y - grid->origin.y;
    y0 = y0 < 0 ? 0 : y0;
    y1 = y1 > dy ? dy : y1;
    int64_t xa = dx * y0 / dy, xb = dx * y1 / dy;
    int64_t x0 = (xa < xb ? xa : xb) - 1, x1 = (xa < xb ? xb : xa) + 1;
    int64_t left = dx < 0 ? dx : 0, right = dx < 0 ? 0 : dx; /* stay within the edge's columns */
    x0 = x0 < left ? left : x0;
    x1 = x1 > right ? right : x1;
    int64_t shift_x = (int64_t)low.x - grid->origin.x;
    return (iso_cell_range){(int32_t)((x0 + shift_x) >> grid->shift),
                            (int32_t)((x1 + shift_x) >> grid->shift)};
}

/* Count pass: the cells' sizes. Fill pass: the entries. One loop serves both, so that they agree.
 */
static int64_t visit_cells(const iso_grid *grid, const iso_edges *edges,
                           const iso_grid_layer *layer, int32_t *position, int32_t *entry) {
    int64_t entries = 0;
    int shift = grid->shift;
    for (int32_t r = 0; r < layer->run_count; r++) {
        const iso_run *run = &layer->run[r];
        iso_cell_range range = {(run->box.min.x - grid->origin.x) >> shift,
                                (run->box.max.x - grid->origin.x) >> shift};
        int32_t row = (run->box.min.y - grid->origin.y) >> shift;
        int32_t row_end = (run->box.max.y - grid->origin.y) >> shift;
        bool bent = run_is_bent(grid, run);
        for (; row <= row_end; row++) {
            if (bent) {
                iso_point a = edges->from[run->first], b = edges->to[run->first];
                range = range_in_row(grid, a.y < b.y ? a : b, a.y < b.y ? b : a, row);
            }
            int32_t cell = row * grid->columns;
            for (int32_t c = range.first; c <= range.last; c++, entries++) {
                if (entry)
                    entry[--position[cell + c]] = r;
                else
                    position[cell + c]++;
            }
        }
    }
    return entries;
}

static iso_status fill_cells(iso_grid *grid, const iso_edges *edges, iso_arena *arena) {
    int32_t cells = grid->columns * grid->rows;
    iso_grid_layer *layer = &grid->layer[grid->layer_count];
    ISO_TRY(ISO_PUSH(layer->first, arena, cells + 1));
    memset(layer->first, 0, (size_t)(cells + 1) * sizeof *layer->first);
    int64_t entries = visit_cells(grid, edges, layer, layer->first, NULL);
    if (entries > INT32_MAX)
        return iso_fail(ISO_OUTSIDE, "too many edges for one arrangement");
    ISO_TRY(ISO_PUSH(layer->entry, arena, entries));
    int32_t sum = 0;
    for (int32_t c = 0; c <= cells; c++)
        layer->first[c] = sum += layer->first[c];
    visit_cells(grid, edges, layer, layer->first, layer->entry); /* leaves first[c] at each start */
    grid->layer_count++;
    return ISO_OK;
}

iso_status grid_add_layer(iso_grid *grid, const iso_edges *edges, int32_t begin, iso_arena *arena) {
    if (grid->layer_count == GRID_LAYERS_MAX)
        return iso_fail(ISO_BUG, "snap rounding did not settle in %d rounds", GRID_LAYERS_MAX);
    iso_grid_layer *layer = &grid->layer[grid->layer_count];
    ISO_TRY(ISO_PUSH(layer->run, arena, edges->count - begin));
    layer->run_count = edges->count - begin;
    for (int32_t e = begin; e < edges->count; e++)
        layer->run[e - begin] = (iso_run){box_of(edges->from[e], edges->to[e]), e, 1};
    return fill_cells(grid, edges, arena);
}

iso_status grid_build(iso_grid *grid, const iso_edges *edges, iso_arena *arena) {
    iso_grid_layer *layer = &grid->layer[0];
    iso_box box = {edges->from[0], edges->from[0]};
    int64_t length = 0;
    grid->layer_count = 0;
    for (int32_t e = 0; e < edges->count; e++) {
        length += edge_length(edges->from[e], edges->to[e]);
        box_add(&box, edges->from[e]);
    }
    ISO_TRY(ISO_PUSH(layer->run, arena, edges->count));
    int64_t mean = length / edges->count, runs = find_runs(layer, edges, RUN_LENGTH * mean);
    choose_cells(grid, box, runs / layer->run_count, layer->run_count);
    return fill_cells(grid, edges, arena);
}

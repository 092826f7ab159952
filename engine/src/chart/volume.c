/* How much a layer holds: the chart's volume factor over the layer's region.
 *
 * Where the factor has a formula the sum runs along the contours, exactly. Else the region is laid
 * on a grid: what each cell has of it is exact again, only the factor is that of the cell's middle.
 */
#include <math.h>
#include <string.h>

#include "chart/kind.h"

/* ---- along the contours ---- */

typedef double edge_integral(const chart *map, iso_vec2 a, iso_vec2 b);

static double sum_edges(const chart *map, const iso_slices *slices, int32_t level,
                        edge_integral *integral) {
    double sum = 0;
    for (int32_t c = slices->level_first[level]; c < slices->level_first[level + 1]; c++) {
        int64_t first = slices->contour_first[c], end = slices->contour_first[c + 1];
        iso_vec2 before = end > first ? slices->point[end - 1] : (iso_vec2){0, 0};
        for (int64_t i = first; i < end; i++) {
            sum += integral(map, before, slices->point[i]);
            before = slices->point[i];
        }
    }
    return sum;
}

/* Area: the integral of u dv. */
static double area_of(const chart *map, iso_vec2 a, iso_vec2 b) {
    return 0.5 * (a.x + b.x) * (b.y - a.y);
}

/* Of v, over the area: the integral of u v dv. */
static double moment_of(const chart *map, iso_vec2 a, iso_vec2 b) {
    double u = b.x - a.x, v = b.y - a.y;
    return v * (a.x * a.y + 0.5 * (a.x * v + a.y * u) + u * v / 3);
}

/* The integral of clamp(t) from a to b, times what a unit of it is worth. */
static double clamped(double a, double b, double half, double dv) {
    double low = fmin(a, b), high = fmax(a, b);
    if (low >= half)
        return half * dv;
    if (high <= -half)
        return -half * dv;
    if (high - low < 1e-12)
        return a * dv;
    double from = fmax(low, -half), to = fmin(high, half);
    double sum = -half * (from - low) + 0.5 * (from + to) * (to - from) + half * (high - to);
    return sum * dv / (high - low);
}

/* Area within one period. */
static double period_of(const chart *map, iso_vec2 a, iso_vec2 b) {
    return clamped(a.x, b.x, 0.5 * map->period, b.y - a.y);
}

/* ---- on a grid ---- */

enum { CELLS_MOST = 96 }; /* along the longer side */

typedef struct cells {
    iso_vec2 low;
    double size; /* mm */
    int32_t columns, rows;
    double *share; /* [rows][columns + 1] what a cell has more of the region than the one left of
                    * it, in cells */
} cells;

static void find_box(iso_vec2 box[2], const iso_slices *slices, int64_t first, int64_t end) {
    box[0] = box[1] = slices->point[first];
    for (int64_t i = first; i < end; i++) {
        iso_vec2 p = slices->point[i];
        box[0] = (iso_vec2){fmin(box[0].x, p.x), fmin(box[0].y, p.y)};
        box[1] = (iso_vec2){fmax(box[1].x, p.x), fmax(box[1].y, p.y)};
    }
}

static iso_status lay_cells(cells *g, const iso_slices *slices, int64_t first, int64_t end,
                            iso_arena *scratch) {
    iso_vec2 box[2];
    find_box(box, slices, first, end);
    double width = box[1].x - box[0].x, depth = box[1].y - box[0].y;
    *g = (cells){.low = box[0], .size = fmax(fmax(width, depth) / CELLS_MOST, 1e-6)};
    g->columns = (int32_t)(width / g->size) + 1;
    g->rows = (int32_t)(depth / g->size) + 1;
    ISO_TRY(ISO_PUSH(g->share, scratch, (int64_t)g->rows * (g->columns + 1)));
    memset(g->share, 0, (size_t)g->rows * (size_t)(g->columns + 1) * sizeof *g->share);
    return ISO_OK;
}

static int32_t within(double x, int32_t count) {
    int32_t i = (int32_t)x;
    return i < 0 ? 0 : i < count ? i : count - 1;
}

/* A piece of an edge within one cell: what lies right of it, all the way, is the region's or no
 * more. */
static void add_piece(cells *g, iso_vec2 a, iso_vec2 b) {
    int32_t column = within(0.5 * (a.x + b.x), g->columns);
    int32_t row = within(0.5 * (a.y + b.y), g->rows);
    double *share = g->share + (int64_t)row * (g->columns + 1) + column;
    double height = a.y - b.y, left = 0.5 * (a.x + b.x) - column;
    share[0] += height * (1 - left);
    share[1] += height * left;
}

/* Cut at the lines between cells, of one direction after the other. */
static void add_across(cells *g, iso_vec2 a, iso_vec2 b) {
    double from = fmin(a.x, b.x), to = fmax(a.x, b.x);
    iso_vec2 before = a, p;
    int32_t first = (int32_t)floor(from) + 1, last = (int32_t)ceil(to) - 1;
    for (int32_t k = 0; k <= last - first; k++) {
        int32_t line = b.x > a.x ? first + k : last - k;
        p.x = line;
        p.y = a.y + (b.y - a.y) * ((line - a.x) / (b.x - a.x));
        add_piece(g, before, p);
        before = p;
    }
    add_piece(g, before, b);
}

static void add_edge(cells *g, iso_vec2 a, iso_vec2 b) {
    a = (iso_vec2){(a.x - g->low.x) / g->size, (a.y - g->low.y) / g->size};
    b = (iso_vec2){(b.x - g->low.x) / g->size, (b.y - g->low.y) / g->size};
    double from = fmin(a.y, b.y), to = fmax(a.y, b.y);
    iso_vec2 before = a, p;
    int32_t first = (int32_t)floor(from) + 1, last = (int32_t)ceil(to) - 1;
    for (int32_t k = 0; k <= last - first; k++) {
        int32_t line = b.y > a.y ? first + k : last - k;
        p.y = line;
        p.x = a.x + (b.x - a.x) * ((line - a.y) / (b.y - a.y));
        add_across(g, before, p);
        before = p;
    }
    add_across(g, before, b);
}

/* Cells of one row that have any of the region, and how much. */
static int32_t gather_row(iso_vec2 *middle, double *weight, const cells *g, int32_t row) {
    const double *share = g->share + (int64_t)row * (g->columns + 1);
    double sum = 0;
    int32_t count = 0;
    for (int32_t i = 0; i < g->columns; i++) {
        sum += share[i];
        if (fabs(sum) < 1e-9)
            continue;
        middle[count] =
            (iso_vec2){g->low.x + (i + 0.5) * g->size, g->low.y + (row + 0.5) * g->size};
        weight[count++] = sum;
    }
    return count;
}

static iso_status sum_cells(double *sum, const chart *map, const cells *g, const double layer[2]) {
    iso_vec2 middle[CELLS_MOST + 2];
    double weight[CELLS_MOST + 2];
    chart_point point[CELLS_MOST + 2];
    *sum = 0;
    for (int32_t row = 0; row < g->rows; row++) {
        int32_t count = gather_row(middle, weight, g, row);
        ISO_TRY(chart_layer(point, map, middle, layer, count));
        for (int32_t i = 0; i < count; i++)
            *sum += weight[i] * point[i].volume;
    }
    *sum *= g->size * g->size;
    return ISO_OK;
}

iso_status graph_volume(double *volume, const chart *map, const iso_slices *slices, int32_t level,
                        const double layer[2], iso_arena *scratch) {
    int32_t from = slices->level_first[level], to = slices->level_first[level + 1];
    int64_t first = slices->contour_first[from], end = slices->contour_first[to];
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    cells grid;
    *volume = 0;
    if (first == end)
        return ISO_OK;
    ISO_TRY(lay_cells(&grid, slices, first, end, scratch));
    for (int32_t c = from; c < to; c++) {
        int64_t begin = slices->contour_first[c], stop = slices->contour_first[c + 1];
        for (int64_t i = begin; i < stop; i++)
            add_edge(&grid, slices->point[i], slices->point[i + 1 < stop ? i + 1 : begin]);
    }
    double sum;
    iso_status status = sum_cells(&sum, map, &grid, layer);
    iso_arena_pop(scratch, mark);
    *volume = status == ISO_OK ? sum * layer[1] : 0;
    return status;
}

/* ---- which ---- */

/* The factor of charts that have the same all over a layer. */
static iso_status factor_of(double *factor, const chart *map, const double layer[2]) {
    iso_vec2 flat = {map->middle.x, map->middle.y};
    chart_point point;
    if (map->kind != CHART_GRAPH)
        flat = (iso_vec2){0, 0};
    ISO_TRY(chart_layer(&point, map, &flat, layer, 1));
    *factor = point.volume;
    return ISO_OK;
}

iso_status chart_volume(double *volume, const chart *map, const iso_slices *slices, int32_t level,
                        const double layer[2], iso_arena *scratch) {
    double factor;
    *volume = 0;
    if (slices->level_first[level] == slices->level_first[level + 1])
        return ISO_OK;
    if (map->kind == CHART_FAN) {
        *volume = sum_edges(map, slices, level, moment_of) / map->radius * layer[1];
        return ISO_OK;
    }
    if (map->kind == CHART_GRAPH && map->even_above > -HUGE_VAL)
        return graph_volume(volume, map, slices, level, layer, scratch);
    ISO_TRY(factor_of(&factor, map, layer));
    *volume =
        factor * layer[1] * sum_edges(map, slices, level, map->period > 0 ? period_of : area_of);
    return ISO_OK;
}

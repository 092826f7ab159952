#include "lattice/raster.h"

#include <math.h>

/* The column of a place, kept within the grid. */
static int32_t column_of(const raster *r, double x) {
    double i = floor((x - r->x) / r->step);
    return i < 0 ? 0 : i > r->columns - 2 ? r->columns - 2 : (int32_t)i;
}

static int32_t row_of(const raster *r, double y) {
    double j = floor((y - r->y) / r->step);
    return j < 0 ? 0 : j > r->rows - 2 ? r->rows - 2 : (int32_t)j;
}

/* Squares near the edge a-b, row by row. */
static void mark_edge(raster *r, iso_point a, iso_point b, double reach) {
    iso_point low = a.y <= b.y ? a : b, high = a.y <= b.y ? b : a;
    double slope = high.y > low.y ? ((double)high.x - low.x) / ((double)high.y - low.y) : 0;
    int32_t from = row_of(r, low.y - reach), to = row_of(r, high.y + reach);
    for (int32_t j = from; j <= to; j++) {
        double bottom = r->y + j * r->step - reach, top = bottom + r->step + 2 * reach;
        double p = bottom <= low.y || low.y == high.y ? low.x : low.x + (bottom - low.y) * slope;
        double q = top >= high.y || low.y == high.y ? high.x : low.x + (top - low.y) * slope;
        int32_t i = column_of(r, (p < q ? p : q) - reach);
        int32_t last = column_of(r, (p < q ? q : p) + reach);
        memset(r->square + (int64_t)j * (r->columns - 1) + i, RASTER_BOUNDARY,
               (size_t)(last - i + 1));
    }
}

/* Winding numbers' steps where the edge crosses the middle line of a row of squares, at the first
 * square whose middle is right of it. */
static void add_steps(const raster *r, iso_point a, iso_point b, int8_t *step) {
    iso_point low = a.y <= b.y ? a : b, high = a.y <= b.y ? b : a;
    if (low.y == high.y)
        return;
    double slope = ((double)high.x - low.x) / ((double)high.y - low.y);
    int32_t to = row_of(r, high.y);
    for (int32_t j = row_of(r, low.y); j <= to; j++) {
        double middle = r->y + (j + 0.5) * r->step;
        if (middle < low.y || middle >= high.y)
            continue;
        double x = low.x + (middle - low.y) * slope;
        int32_t i = column_of(r, x + r->step / 2);
        step[(int64_t)j * (r->columns - 1) + i] += a.y < b.y ? -1 : 1;
    }
}

static void mark_inside(raster *r, const int8_t *step) {
    int32_t squares = r->columns - 1;
    for (int32_t j = 0; j < r->rows - 1; j++) {
        int winding = 0;
        for (int32_t i = 0; i < squares; i++) {
            uint8_t *square = &r->square[(int64_t)j * squares + i];
            winding += step[(int64_t)j * squares + i];
            if (*square == RASTER_OUTSIDE && winding != 0)
                *square = RASTER_INSIDE;
        }
    }
}

static iso_status size_up(raster *out, const iso_region *region, const double origin[2],
                          double step) {
    iso_point min = region->point[0], max = min;
    for (int32_t i = 1; i < region->first[region->count]; i++) {
        iso_point p = region->point[i];
        min.x = p.x < min.x ? p.x : min.x;
        min.y = p.y < min.y ? p.y : min.y;
        max.x = p.x > max.x ? p.x : max.x;
        max.y = p.y > max.y ? p.y : max.y;
    }
    double i0 = floor((min.x - origin[0]) / step) - 2, i1 = ceil((max.x - origin[0]) / step) + 2;
    double j0 = floor((min.y - origin[1]) / step) - 2, j1 = ceil((max.y - origin[1]) / step) + 2;
    double columns = i1 - i0 + 1, rows = j1 - j0 + 1;
    if (columns * rows > INT32_MAX / 4)
        return iso_fail(ISO_USAGE,
                        "lattice: cells are too small for a part of %g x %g mm (%.0f x %.0f "
                        "samples a layer): use larger ones",
                        ((double)max.x - min.x) / ISO_UNITS_PER_MM,
                        ((double)max.y - min.y) / ISO_UNITS_PER_MM, columns, rows);
    *out = (raster){origin[0] + i0 * step, origin[1] + j0 * step, step,
                    (int32_t)columns,      (int32_t)rows,         NULL};
    return ISO_OK;
}

iso_status raster_make(raster *out, const iso_region *region, const double origin[2], double step,
                       double reach, iso_arena *scratch) {
    int8_t *steps;
    ISO_TRY(size_up(out, region, origin, step));
    int64_t squares = (int64_t)(out->columns - 1) * (out->rows - 1);
    ISO_TRY(ISO_PUSH(out->square, scratch, squares));
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    ISO_TRY(ISO_PUSH(steps, scratch, squares));
    memset(out->square, RASTER_OUTSIDE, (size_t)squares);
    memset(steps, 0, (size_t)squares);
    for (int32_t m = 0; m < region->count; m++)
        for (int32_t i = region->first[m]; i < region->first[m + 1]; i++) {
            int32_t next = i + 1 < region->first[m + 1] ? i + 1 : region->first[m];
            mark_edge(out, region->point[i], region->point[next], reach);
            add_steps(out, region->point[i], region->point[next], steps);
        }
    mark_inside(out, steps);
    iso_arena_pop(scratch, mark);
    return ISO_OK;
}

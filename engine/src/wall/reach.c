#include "wall/reach.h"

#include <math.h>

#include "planar/predicate.h"

/* Cells, marked up to REACH around each that `reached` passes: at 0.55 radii a cell, all within 1.4
 * radii in x and y, and nothing beyond 3.2. Corners of 80 degrees and more stay within
 * that. */
enum { REACH = 3, CELLS_MAX = 1 << 26, CORNER_CELLS = 5, RUN_CELLS = 4 };

typedef struct iso_marks {
    iso_point origin;
    double cell;
    int32_t run;         /* cells without a mark in a row that count */
    int32_t words, rows; /* 64 cells a word */
    uint64_t *mark;
} iso_marks;

static iso_box box_of_region(const iso_region *region) {
    iso_box box = {region->point[0], region->point[0]};
    for (int32_t i = 1; i < region->first[region->count]; i++)
        box_add(&box, region->point[i]);
    return box;
}

/* A mark stands for the REACH rows below and above it as well. */
static void mark_around(iso_marks *m, int32_t column, int32_t row) {
    const uint64_t run = (1 << (2 * REACH + 1)) - 1;
    int32_t first = column - REACH, bit = first & 63;
    uint64_t *at = m->mark + (int64_t)row * m->words + (first >> 6);
    at[0] |= run << bit;
    if (bit > 64 - (2 * REACH + 1))
        at[1] |= run >> (64 - bit);
}

static bool is_marked(const iso_marks *m, int32_t column, int32_t row) {
    int64_t stride = m->words;
    const uint64_t *at = m->mark + row * stride + (column >> 6);
    uint64_t any = at[0];
    for (int64_t off = stride; off <= REACH * stride; off += stride)
        any |= at[-off] | at[off];
    return any >> (column & 63) & 1;
}

/* Is point i of the contour a sharp corner of the region, but not as sharp as a tip that gets a
 * bead of its own? The next wall turns far from its end, and nothing is missing there. */
static bool is_corner(const iso_point *point, int32_t count, int32_t i) {
    iso_point a = point[i == 0 ? count - 1 : i - 1], b = point[i];
    iso_point c = point[i + 1 == count ? 0 : i + 1];
    double ux = (double)b.x - a.x, uy = (double)b.y - a.y;
    double vx = (double)c.x - b.x, vy = (double)c.y - b.y;
    double along = ux * vx + uy * vy, turn = ux * vy - uy * vx;
    return turn > 0 && along < 0.2 * turn && -along < 1.2 * turn; /* 80 to 40 degrees */
}

/* Go along the contours in steps of a cell: mark, or look for a place without a mark. */
static bool walk(iso_marks *m, const iso_region *region, bool marking) {
    double scale = 1 / m->cell;
    for (int32_t c = 0; c < region->count; c++) {
        const iso_point *point = region->point + region->first[c];
        int32_t count = region->first[c + 1] - region->first[c];
        int32_t run = 0;
        bool corner = !marking && is_corner(point, count, count - 1);
        for (int32_t i = 0, last = count - 1; i < count; last = i++) {
            iso_point a = point[last], b = point[i];
            double x = (a.x - m->origin.x) * scale, y = (a.y - m->origin.y) * scale;
            double dx = (b.x - a.x) * scale, dy = (b.y - a.y) * scale;
            double longer = fabs(dx) > fabs(dy) ? fabs(dx) : fabs(dy);
            int32_t steps = (int32_t)longer + 1, from = 0, to = steps;
            dx /= steps, dy /= steps;
            if (corner)
                from = CORNER_CELLS;
            corner = !marking && is_corner(point, count, i);
            if (corner)
                to -= CORNER_CELLS;
            for (int32_t k = from; k < to; k++) {
                int32_t column = (int32_t)(x + dx * k), row = (int32_t)(y + dy * k);
                if (marking)
                    mark_around(m, column, row);
                else if (is_marked(m, column, row))
                    run = 0;
                else if (++run >= m->run)
                    return true;
            }
        }
    }
    return false;
}

iso_status reach_misses(bool *missed, const iso_region *region, const iso_region *reached,
                        int32_t radius, double shortest, iso_arena *arena) {
    *missed = region->count > 0;
    if (region->count == 0 || reached->count == 0 || radius <= 0)
        return ISO_OK;
    iso_box box = box_of_region(region);
    iso_marks m = {.cell = 0.55 * radius};
    m.run = RUN_CELLS + (int32_t)(shortest / m.cell < 1000 ? shortest / m.cell : 1000);
    int32_t margin = (int32_t)(m.cell * (REACH + 1)) + 1;
    m.origin = (iso_point){box.min.x - margin, box.min.y - margin};
    double columns = ((double)box.max.x - box.min.x + 2.0 * margin) / m.cell + 1;
    double rows = ((double)box.max.y - box.min.y + 2.0 * margin) / m.cell + 1;
    if (columns * rows > CELLS_MAX)
        return ISO_OK;
    m.words = (int32_t)columns / 64 + 2;
    m.rows = (int32_t)rows + 1;
    iso_arena_mark mark = iso_arena_get_mark(arena);
    ISO_TRY(ISO_PUSH(m.mark, arena, (int64_t)m.words * m.rows));
    memset(m.mark, 0, (size_t)m.words * (size_t)m.rows * sizeof *m.mark);
    walk(&m, reached, true);
    *missed = walk(&m, region, false);
    iso_arena_pop(arena, mark);
    return ISO_OK;
}

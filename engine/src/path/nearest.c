#include "path/nearest.h"

#include <math.h>

enum { CANDIDATES_A_CELL = 3, SMALL = 48 /* a plain scan is faster below */ };

static int64_t distance_squared(iso_point a, iso_point b) {
    int64_t dx = (int64_t)a.x - b.x, dy = (int64_t)a.y - b.y;
    return dx * dx + dy * dy;
}

static iso_box box_of(const iso_candidate *candidate, int32_t count) {
    iso_box box = {{INT32_MAX, INT32_MAX}, {INT32_MIN, INT32_MIN}};
    for (int32_t i = 0; i < count; i++) {
        iso_point p = candidate[i].at;
        box.min.x = p.x < box.min.x ? p.x : box.min.x;
        box.min.y = p.y < box.min.y ? p.y : box.min.y;
        box.max.x = p.x > box.max.x ? p.x : box.max.x;
        box.max.y = p.y > box.max.y ? p.y : box.max.y;
    }
    return box;
}

/* Square cells, at most count / 3 + 1 of them, so the first build's memory suffices for all. */
static void choose_cells(iso_nearest *nearest) {
    iso_box box = box_of(nearest->candidate, nearest->count);
    int64_t width = (int64_t)box.max.x - box.min.x + 1, height = (int64_t)box.max.y - box.min.y + 1;
    int64_t wanted = nearest->count <= SMALL ? 1 : nearest->count / CANDIDATES_A_CELL;
    int64_t size = (int64_t)sqrt((double)width * (double)height / (double)wanted) + 1;
    int64_t longest = (width > height ? width : height) / wanted + 1;
    if (nearest->count <= SMALL)
        size = width > height ? width : height;
    else if (size < longest)
        size = longest;
    while ((width / size + 1) * (height / size + 1) > wanted && nearest->count > SMALL)
        size += size / 8 + 1;
    nearest->size = (int32_t)size;
    nearest->columns = nearest->count <= SMALL ? 1 : (int32_t)(width / size + 1);
    nearest->rows = nearest->count <= SMALL ? 1 : (int32_t)(height / size + 1);
    nearest->origin = box.min;
}

static void fill_cells(iso_nearest *nearest) {
    choose_cells(nearest);
    int32_t cells = nearest->columns * nearest->rows;
    memset(nearest->first, 0, ((size_t)cells + 1) * sizeof *nearest->first);
    for (int32_t i = 0; i < nearest->count; i++) {
        iso_point p = nearest->candidate[i].at;
        int32_t column = cells == 1 ? 0 : (p.x - nearest->origin.x) / nearest->size;
        int32_t row = cells == 1 ? 0 : (p.y - nearest->origin.y) / nearest->size;
        nearest->cell_of[i] = row * nearest->columns + column;
        nearest->first[nearest->cell_of[i] + 1]++;
    }
    for (int32_t c = 0; c < cells; c++) {
        nearest->living[c] = 0;
        nearest->first[c + 1] += nearest->first[c];
    }
    for (int32_t i = 0; i < nearest->count; i++) {
        int32_t c = nearest->cell_of[i];
        nearest->spare[nearest->first[c] + nearest->living[c]++] = nearest->candidate[i];
    }
    iso_candidate *filled = nearest->spare;
    nearest->spare = nearest->candidate;
    nearest->candidate = filled;
    nearest->left = nearest->count;
}

iso_status iso_nearest_build(iso_nearest *nearest, iso_candidate *candidate, int32_t count,
                             int32_t owners, iso_arena *scratch) {
    *nearest = (iso_nearest){.candidate = candidate, .count = count, .owners = owners};
    int32_t cells = count / CANDIDATES_A_CELL + 1;
    ISO_TRY(ISO_PUSH(nearest->spare, scratch, count));
    ISO_TRY(ISO_PUSH(nearest->cell_of, scratch, count));
    ISO_TRY(ISO_PUSH(nearest->first, scratch, cells + 1));
    ISO_TRY(ISO_PUSH(nearest->living, scratch, cells));
    ISO_TRY(ISO_PUSH(nearest->taken, scratch, owners));
    ISO_TRY(ISO_PUSH(nearest->share, scratch, owners));
    memset(nearest->taken, 0, (size_t)owners);
    memset(nearest->share, 0, (size_t)owners * sizeof *nearest->share);
    for (int32_t i = 0; i < count; i++)
        nearest->share[candidate[i].owner]++;
    if (count > 0)
        fill_cells(nearest);
    return ISO_OK;
}

/* An emptied grid would be searched far and wide for the last few points. */
static void rebuild(iso_nearest *nearest) {
    int32_t count = 0;
    for (int32_t i = 0; i < nearest->count; i++)
        if (!nearest->taken[nearest->candidate[i].owner])
            nearest->candidate[count++] = nearest->candidate[i];
    nearest->count = count;
    fill_cells(nearest);
}

void iso_nearest_take(iso_nearest *nearest, int32_t owner) {
    if (nearest->taken[owner])
        return;
    nearest->taken[owner] = 1;
    nearest->left -= nearest->share[owner];
    if (nearest->left > 0 && nearest->count > SMALL && nearest->left < nearest->count / 4)
        rebuild(nearest);
}

typedef struct search {
    iso_point from;
    int64_t distance;
    const iso_candidate *best;
} search;

static int precedes(const iso_candidate *a, const iso_candidate *b) {
    return a->owner != b->owner ? a->owner < b->owner : a->name < b->name;
}

/* Taken candidates met on the way are put behind the living ones, once each. */
static void search_cell(search *s, iso_nearest *nearest, int32_t cell) {
    iso_candidate *candidate = nearest->candidate + nearest->first[cell];
    int32_t living = nearest->living[cell];
    for (int32_t i = 0; i < living;) {
        if (nearest->taken[candidate[i].owner]) {
            iso_candidate last = candidate[--living];
            candidate[living] = candidate[i];
            candidate[i] = last;
            /* best may have been that last one only if it was searched, and it was not */
            continue;
        }
        int64_t d = distance_squared(s->from, candidate[i].at);
        if (!s->best || d < s->distance || (d == s->distance && precedes(&candidate[i], s->best))) {
            s->distance = d;
            s->best = &candidate[i];
        }
        i++;
    }
    nearest->living[cell] = living;
}

static int32_t clamp_cell(int64_t offset, int32_t size, int32_t cells) {
    int64_t c = offset < 0 ? 0 : offset / size;
    return (int32_t)(c < cells ? c : cells - 1);
}

/* Whatever lies in cells outside of the square around (column, row) is at least so far away. */
static int64_t bound_beyond(const iso_nearest *nearest, iso_point from, int32_t column, int32_t row,
                            int32_t radius) {
    int64_t size = nearest->size, bound = INT64_MAX;
    int64_t x = (int64_t)from.x - nearest->origin.x, y = (int64_t)from.y - nearest->origin.y;
    int64_t side[4] = {x - (column - radius) * size + 1, (column + radius + 1) * size - x,
                       y - (row - radius) * size + 1, (row + radius + 1) * size - y};
    int there[4] = {column - radius > 0, column + radius + 1 < nearest->columns, row - radius > 0,
                    row + radius + 1 < nearest->rows};
    for (int i = 0; i < 4; i++)
        if (there[i] && side[i] < bound)
            bound = side[i] < 0 ? 0 : side[i];
    return bound;
}

static void search_ring(search *s, iso_nearest *nearest, int32_t column, int32_t row,
                        int32_t radius) {
    int32_t left = column - radius, right = column + radius;
    for (int32_t r = row - radius; r <= row + radius; r++) {
        if (r < 0 || r >= nearest->rows)
            continue;
        int whole = r == row - radius || r == row + radius;
        int32_t step = whole || radius == 0 ? 1 : 2 * radius;
        for (int32_t c = left; c <= right; c += step)
            if (c >= 0 && c < nearest->columns)
                search_cell(s, nearest, r * nearest->columns + c);
    }
}

const iso_candidate *iso_nearest_find(iso_nearest *nearest, iso_point from) {
    search s = {.from = from};
    if (nearest->left <= 0)
        return NULL;
    int32_t column =
        clamp_cell((int64_t)from.x - nearest->origin.x, nearest->size, nearest->columns);
    int32_t row = clamp_cell((int64_t)from.y - nearest->origin.y, nearest->size, nearest->rows);
    for (int32_t radius = 0;; radius++) {
        search_ring(&s, nearest, column, row, radius);
        int64_t bound = bound_beyond(nearest, from, column, row, radius);
        if (bound == INT64_MAX)
            return s.best;
        if (s.best && bound * bound > s.distance)
            return s.best;
    }
}

#include "path/edges.h"

#include <math.h>

enum { EDGES_A_CELL = 2 };

int64_t iso_distance_squared(iso_point a, iso_point b) {
    int64_t dx = (int64_t)a.x - b.x, dy = (int64_t)a.y - b.y;
    return dx * dx + dy * dy;
}

iso_point iso_nearest_on_segment(iso_point p, iso_point a, iso_point b) {
    double dx = (double)b.x - a.x, dy = (double)b.y - a.y;
    double along = ((double)p.x - a.x) * dx + ((double)p.y - a.y) * dy, all = dx * dx + dy * dy;
    if (along <= 0 || all <= 0)
        return a;
    if (along >= all)
        return b;
    double x = a.x + dx * (along / all), y = a.y + dy * (along / all);
    return (iso_point){(int32_t)(x < 0 ? x - 0.5 : x + 0.5), (int32_t)(y < 0 ? y - 0.5 : y + 0.5)};
}

/* The cells of a row that a segment passes, with a margin. */
typedef struct iso_cells {
    int32_t begin, end;
} iso_cells;

static void choose_cells(iso_edge_grid *grid) {
    iso_box box = {{INT32_MAX, INT32_MAX}, {INT32_MIN, INT32_MIN}};
    for (int32_t i = 0; i < grid->count; i++)
        for (int k = 0; k < 2; k++) {
            iso_point p = k ? grid->edge[i].b : grid->edge[i].a;
            box.min.x = p.x < box.min.x ? p.x : box.min.x;
            box.min.y = p.y < box.min.y ? p.y : box.min.y;
            box.max.x = p.x > box.max.x ? p.x : box.max.x;
            box.max.y = p.y > box.max.y ? p.y : box.max.y;
        }
    int64_t width = (int64_t)box.max.x - box.min.x + 1, height = (int64_t)box.max.y - box.min.y + 1;
    int64_t wanted = grid->count / EDGES_A_CELL + 1;
    int64_t size = (int64_t)sqrt((double)width * (double)height / (double)wanted) + 1;
    int64_t longest = (width > height ? width : height) / wanted + 1;
    size = size < longest ? longest : size;
    grid->origin = box.min;
    grid->size = (int32_t)size;
    grid->inverse = 1.0 / (double)size;
    grid->columns = (int32_t)(width / size + 1);
    grid->rows = (int32_t)(height / size + 1);
}

static int32_t cell_at(double offset, double inverse, int32_t cells) {
    double c = offset * inverse;
    return c <= 0 ? 0 : c >= cells ? cells - 1 : (int32_t)c;
}

/* The rows that the segment passes; those beyond the grid fall to its border, which only makes a
 * search longer. */
static void rows_of(int32_t *begin, int32_t *end, const iso_edge_grid *grid, iso_point a,
                    iso_point b) {
    double low = (double)(a.y < b.y ? a.y : b.y) - grid->origin.y - 1;
    double high = (double)(a.y < b.y ? b.y : a.y) - grid->origin.y + 1;
    *begin = cell_at(low, grid->inverse, grid->rows);
    *end = cell_at(high, grid->inverse, grid->rows) + 1;
}

/* The columns it passes in that row, with a unit of margin. */
static iso_cells cells_of(const iso_edge_grid *grid, iso_point a, iso_point b, int32_t row) {
    double x0 = (double)a.x - grid->origin.x, x1 = (double)b.x - grid->origin.x;
    double y0 = (double)a.y - grid->origin.y, y1 = (double)b.y - grid->origin.y;
    double low = (double)row * grid->size - 1, high = low + grid->size + 2;
    double from = 0, to = 1, rise = y1 - y0;
    if (rise != 0) {
        double t0 = (low - y0) / rise, t1 = (high - y0) / rise;
        from = t0 < t1 ? t0 : t1;
        to = t0 < t1 ? t1 : t0;
        if (row == (rise > 0 ? 0 : grid->rows - 1)) /* whatever lies beyond the grid is here, too */
            from = 0;
        if (row == (rise > 0 ? grid->rows - 1 : 0))
            to = 1;
        from = from < 0 ? 0 : from > 1 ? 1 : from;
        to = to < 0 ? 0 : to > 1 ? 1 : to;
    }
    double p = x0 + from * (x1 - x0), q = x0 + to * (x1 - x0);
    double left = p < q ? p : q, right = p < q ? q : p;
    return (iso_cells){cell_at(left - 2, grid->inverse, grid->columns),
                       cell_at(right + 2, grid->inverse, grid->columns) + 1};
}

/* Edges are short: most lie in a cell or two, and where the box of one covers no more than four,
 * all of them will do. */
enum { BOX_CELLS = 4 };

typedef struct visitor {
    const iso_edge_grid *grid;
    int32_t *first, *in; /* in: NULL while counting */
    int32_t *only;       /* the one cell of each edge, as most have, or -1 */
    int64_t entries;
} visitor;

static void visit(visitor *v, int32_t row, int32_t begin, int32_t end, int32_t edge) {
    int32_t cell = row * v->grid->columns;
    for (int32_t c = cell + begin; c < cell + end; c++) {
        if (v->in)
            v->in[v->first[c + 1]++] = edge;
        else
            v->first[c + 2]++;
    }
    v->entries += end - begin;
}

static void visit_cells(visitor *v, const iso_path_edge *e, int32_t edge) {
    const iso_edge_grid *grid = v->grid;
    double x0 = (double)e->a.x - grid->origin.x, x1 = (double)e->b.x - grid->origin.x;
    double inverse = grid->inverse;
    int32_t left = cell_at((x0 < x1 ? x0 : x1) - 2, inverse, grid->columns);
    int32_t right = cell_at((x0 < x1 ? x1 : x0) + 2, inverse, grid->columns) + 1;
    int32_t low, high;
    rows_of(&low, &high, grid, e->a, e->b);
    v->only[edge] = right - left == 1 && high - low == 1 ? low * grid->columns + left : -1;
    int small = (right - left) * (int64_t)(high - low) <= BOX_CELLS;
    for (int32_t row = low; row < high; row++) {
        iso_cells c = small ? (iso_cells){left, right} : cells_of(grid, e->a, e->b, row);
        visit(v, row, c.begin, c.end, edge);
    }
}

iso_status iso_edge_grid_build(iso_edge_grid *grid, const iso_path_edge *edge, int32_t count,
                               iso_arena *scratch) {
    *grid = (iso_edge_grid){.edge = edge, .count = count};
    if (count == 0)
        return ISO_OK;
    choose_cells(grid);
    int32_t cells = grid->columns * grid->rows;
    ISO_TRY(ISO_PUSH(grid->first, scratch, (int64_t)cells + 2));
    memset(grid->first, 0, ((size_t)cells + 2) * sizeof *grid->first);
    visitor v = {.grid = grid, .first = grid->first};
    ISO_TRY(ISO_PUSH(v.only, scratch, count));
    for (int32_t i = 0; i < count; i++)
        visit_cells(&v, &edge[i], i);
    if (v.entries > INT32_MAX)
        return iso_fail(ISO_OUTSIDE, "a layer's walls are too many to look for ways between them");
    ISO_TRY(ISO_PUSH(grid->in, scratch, v.entries));
    for (int32_t c = 0; c < cells; c++)
        grid->first[c + 2] += grid->first[c + 1];
    v.in = grid->in;
    for (int32_t i = 0; i < count; i++) {
        if (v.only[i] >= 0)
            v.in[v.first[v.only[i] + 1]++] = i;
        else
            visit_cells(&v, &edge[i], i);
    }
    return ISO_OK;
}

static int same(iso_point a, iso_point b) {
    return a.x == b.x && a.y == b.y;
}

static int64_t turn(iso_point a, iso_point b, iso_point c) {
    return ((int64_t)b.x - a.x) * ((int64_t)c.y - a.y) -
           ((int64_t)b.y - a.y) * ((int64_t)c.x - a.x);
}

static int between(int32_t a, int32_t x, int32_t b) {
    return a < b ? a <= x && x <= b : b <= x && x <= a;
}

static int holds(iso_point a, iso_point b, iso_point p) {
    return between(a.x, p.x, b.x) && between(a.y, p.y, b.y);
}

static int meet(iso_point a, iso_point b, iso_point c, iso_point d) {
    int64_t p = turn(a, b, c), q = turn(a, b, d), r = turn(c, d, a), s = turn(c, d, b);
    if (((p > 0 && q < 0) || (p < 0 && q > 0)) && ((r > 0 && s < 0) || (r < 0 && s > 0)))
        return 1;
    return (p == 0 && holds(a, b, c)) || (q == 0 && holds(a, b, d)) || (r == 0 && holds(c, d, a)) ||
           (s == 0 && holds(c, d, b));
}

int iso_edge_grid_meets(const iso_edge_grid *grid, iso_point a, iso_point b, int32_t begin,
                        int32_t end) {
    int32_t row, last;
    if (grid->count == 0)
        return 0;
    rows_of(&row, &last, grid, a, b);
    for (; row < last; row++) {
        iso_cells c = cells_of(grid, a, b, row);
        int32_t cell = row * grid->columns;
        for (int32_t k = grid->first[cell + c.begin]; k < grid->first[cell + c.end]; k++) {
            const iso_path_edge *e = &grid->edge[grid->in[k]];
            if (e->owner < begin || e->owner >= end)
                continue;
            if (same(e->a, a) || same(e->a, b) || same(e->b, a) || same(e->b, b))
                continue;
            if (meet(a, b, e->a, e->b))
                return 1;
        }
    }
    return 0;
}

int iso_edge_grid_has(const iso_edge_grid *grid, iso_point a, iso_point b) {
    int32_t row, last;
    if (grid->count == 0)
        return 0;
    rows_of(&row, &last, grid, a, a);
    iso_cells c = cells_of(grid, a, a, row);
    int32_t cell = row * grid->columns + c.begin;
    for (int32_t k = grid->first[cell]; k < grid->first[cell + 1]; k++) {
        const iso_path_edge *e = &grid->edge[grid->in[k]];
        if ((same(e->a, a) && same(e->b, b)) || (same(e->a, b) && same(e->b, a)))
            return 1;
    }
    return 0;
}

/* An edge counts in the one cell in which it crosses the ray to the right of p. */
int iso_edge_grid_contains(const iso_edge_grid *grid, iso_point p, int32_t begin, int32_t end) {
    int odd = 0;
    if (grid->count == 0)
        return 0;
    int32_t row = cell_at((double)p.y - grid->origin.y, grid->inverse, grid->rows);
    int32_t column = cell_at((double)p.x - grid->origin.x, grid->inverse, grid->columns);
    for (; column < grid->columns; column++) {
        int32_t cell = row * grid->columns + column;
        for (int32_t k = grid->first[cell]; k < grid->first[cell + 1]; k++) {
            const iso_path_edge *e = &grid->edge[grid->in[k]];
            if (e->owner < begin || e->owner >= end || (e->a.y <= p.y) == (e->b.y <= p.y))
                continue;
            double t = ((double)p.y - e->a.y) / ((double)e->b.y - e->a.y);
            double x = e->a.x + t * ((double)e->b.x - e->a.x);
            if (x > p.x && cell_at(x - grid->origin.x, grid->inverse, grid->columns) == column)
                odd ^= 1;
        }
    }
    return odd;
}

int32_t iso_edge_grid_nearest(const iso_edge_grid *grid, iso_point p, int32_t reach, int32_t begin,
                              int32_t end) {
    int32_t best = -1;
    int64_t closest = (int64_t)reach * reach + 1;
    if (grid->count == 0)
        return -1;
    double x = (double)p.x - grid->origin.x, y = (double)p.y - grid->origin.y;
    int32_t left = cell_at(x - reach, grid->inverse, grid->columns);
    int32_t right = cell_at(x + reach, grid->inverse, grid->columns);
    int32_t low = cell_at(y - reach, grid->inverse, grid->rows);
    int32_t high = cell_at(y + reach, grid->inverse, grid->rows);
    for (int32_t r = low; r <= high; r++)
        for (int32_t k = grid->first[r * grid->columns + left];
             k < grid->first[r * grid->columns + right + 1]; k++) {
            int32_t i = grid->in[k];
            const iso_path_edge *e = &grid->edge[i];
            if (e->owner < begin || e->owner >= end)
                continue;
            int64_t d = iso_distance_squared(p, iso_nearest_on_segment(p, e->a, e->b));
            if (d < closest || (d == closest && i < best)) {
                closest = d;
                best = i;
            }
        }
    return best;
}

#include "shell/rows.h"

#include "planar/predicate.h"

enum { ROWS_MAX = 1 << 12, EDGES_PER_ROW = 2 };

static int32_t row_at(const iso_rows *rows, int32_t y) {
    int32_t row = y < rows->low ? 0 : (int32_t)(((int64_t)y - rows->low) / rows->height);
    return row < rows->count ? row : rows->count - 1;
}

/* The rows of each edge: counted in the first pass, filled in the second. */
static void put_edges(iso_rows *rows, const iso_region *region, int32_t *end, bool fill) {
    for (int32_t c = 0; c < region->count; c++) {
        int32_t first = region->first[c], last = region->first[c + 1] - 1;
        for (int32_t i = first; i <= last; i++) {
            iso_point a = region->point[i], b = region->point[i < last ? i + 1 : first];
            int32_t low = row_at(rows, a.y < b.y ? a.y : b.y);
            int32_t high = row_at(rows, a.y < b.y ? b.y : a.y);
            for (int32_t r = low; r <= high; r++) {
                if (fill)
                    rows->edge[end[r]] = (iso_row_edge){a, b};
                end[r]++;
            }
        }
    }
}

iso_status rows_of(iso_rows *rows, const iso_region *region, iso_arena *arena) {
    int32_t points = region->count > 0 ? region->first[region->count] : 0, *end;
    *rows = (iso_rows){.count = points / EDGES_PER_ROW + 1, .height = 1};
    if (rows->count > ROWS_MAX)
        rows->count = ROWS_MAX;
    int32_t high = rows->low = points > 0 ? region->point[0].y : 0;
    for (int32_t i = 1; i < points; i++) {
        int32_t y = region->point[i].y;
        rows->low = y < rows->low ? y : rows->low;
        high = y > high ? y : high;
    }
    rows->height = (int32_t)(((int64_t)high - rows->low) / rows->count) + 1;
    ISO_TRY(ISO_PUSH(rows->first, arena, rows->count + 1));
    ISO_TRY(ISO_PUSH(end, arena, rows->count));
    memset(end, 0, (size_t)rows->count * sizeof *end);
    put_edges(rows, region, end, false);
    rows->first[0] = 0;
    for (int32_t r = 0; r < rows->count; r++) {
        rows->first[r + 1] = rows->first[r] + end[r];
        end[r] = rows->first[r];
    }
    ISO_TRY(ISO_PUSH(rows->edge, arena, rows->first[rows->count]));
    put_edges(rows, region, end, true);
    return ISO_OK;
}

static bool rows_hold(const iso_rows *rows, iso_point p) {
    int32_t row = row_at(rows, p.y);
    bool inside = false;
    for (int32_t i = rows->first[row]; i < rows->first[row + 1]; i++) {
        const iso_row_edge *e = &rows->edge[i];
        if ((e->from.y <= p.y) == (e->to.y <= p.y))
            continue;
        bool up = e->from.y < e->to.y;
        if ((orient2d(e->from, e->to, p) > 0) == up)
            inside = !inside;
    }
    return inside;
}

static bool is_near(const iso_row_edge *e, iso_point p, double square) {
    double ux = (double)e->to.x - e->from.x, uy = (double)e->to.y - e->from.y;
    double vx = (double)p.x - e->from.x, vy = (double)p.y - e->from.y;
    double whole = ux * ux + uy * uy, part = ux * vx + uy * vy;
    if (part > 0 && part < whole) {
        double off = ux * vy - uy * vx;
        return off * off <= square * whole;
    }
    double wx = part > 0 ? vx - ux : vx, wy = part > 0 ? vy - uy : vy;
    return wx * wx + wy * wy <= square;
}

bool rows_reach(const iso_rows *rows, iso_point p, int32_t distance) {
    double square = (double)distance * distance;
    for (int32_t r = row_at(rows, p.y - distance), end = row_at(rows, p.y + distance); r <= end;
         r++)
        for (int32_t i = rows->first[r]; i < rows->first[r + 1]; i++)
            if (is_near(&rows->edge[i], p, square))
                return true;
    return rows_hold(rows, p);
}

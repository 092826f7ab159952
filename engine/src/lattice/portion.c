#include "lattice/portion.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#define SQUARES_A_BEAD 4 /* of the grid, across the usual one */
#define REACH 1.5        /* in usual widths: how far off a bead holds anything, at first */
#define REACH_FAR 3      /* times that, where something is left */
#define LEFT_ALLOWED 0.002
#define PIECE 2.0  /* longest piece that is asked about, in usual widths */
#define RUN 1.0    /* at least so long, in usual widths, is drawn at one width */
#define ALIKE 0.06 /* runs whose widths differ by less become one */
#define LEAST 0.12 /* net width, in usual ones */
#define COVER_LEAST 1e-4
enum { BAND = 64 }; /* rows at a time, so that a wide bed takes little memory */

typedef struct piece {
    double x, y, dx, dy, length; /* units; d is of length 1 */
    double share;                /* squares of the grid; then the net width */
    int32_t vertex;              /* that it begins at or after */
} piece;

typedef struct portions {
    iso_paths *paths;
    const iso_region *section;
    const sheet_bead *bead;
    iso_arena *scratch;
    double x, y, step;     /* units: corner of square (0, 0), edge */
    int32_t columns, rows; /* squares */
    float *cover, *near;   /* [BAND columns] part that is section; square of the distance */
    int32_t *owner;        /* [BAND columns] piece; -1: none yet */
    int32_t count;
    piece *piece;
    iso_path_vertex *old; /* of the paths, as they were */
    double all, owned;    /* squares */
} portions;

/* ---- beads to pieces ---- */

static int32_t pieces_of(double length, double usual) {
    double n = ceil(length / (PIECE * usual));
    return n > 1 ? (int32_t)n : 1;
}

static const iso_path_vertex *next_of(const iso_path *path, const iso_path_vertex *v, int32_t i) {
    return &v[i + 1 == path->count ? 0 : i + 1];
}

/* With `out` NULL they are only counted. */
static int32_t cut_path(piece *out, const portions *p, const iso_path *path) {
    const iso_path_vertex *v = p->paths->vertex + path->first;
    int32_t count = 0;
    for (int32_t i = 0; i + 1 < path->count + path->closed; i++) {
        const iso_path_vertex *to = next_of(path, v, i);
        double dx = (double)to->at.x - v[i].at.x, dy = (double)to->at.y - v[i].at.y;
        double length = sqrt(dx * dx + dy * dy);
        int32_t n = length > 0 ? pieces_of(length, p->bead->usual) : 0;
        for (int32_t k = 0; k < n && out; k++)
            out[count + k] = (piece){.x = v[i].at.x + dx * k / n,
                                     .y = v[i].at.y + dy * k / n,
                                     .dx = dx / length,
                                     .dy = dy / length,
                                     .length = length / n,
                                     .vertex = path->first + i};
        count += n;
    }
    return count;
}

/* ---- section to squares ---- */

/* What lies left of t, of a row where an edge runs from low to high: its squares are covered from
 * there on. */
static double covered_to(double t, double low, double high) {
    if (t <= low)
        return 0;
    return t < high ? (t - low) * (t - low) / (2 * (high - low)) : t - (low + high) / 2;
}

/* An edge adds to each square what its cover is more than that of the one before: rows are summed
 * up afterwards. In squares of the band. */
static void add_edge(portions *p, int32_t rows, iso_vec2 a, iso_vec2 b) {
    double sign = 1;
    if (a.y < b.y)
        sign = -1;
    else {
        iso_vec2 swap = a;
        a = b;
        b = swap;
    }
    if (b.y <= 0 || a.y >= rows || a.y == b.y)
        return;
    double slope = (b.x - a.x) / (b.y - a.y);
    for (int32_t j = a.y > 0 ? (int32_t)a.y : 0; j < rows && j < b.y; j++) {
        double y0 = a.y > j ? a.y : j, y1 = b.y < j + 1 ? b.y : j + 1;
        double x0 = a.x + slope * (y0 - a.y), x1 = a.x + slope * (y1 - a.y);
        double low = x0 < x1 ? x0 : x1, high = x0 < x1 ? x1 : x0, before = 0, at = 0;
        float *cover = p->cover + (int64_t)j * p->columns;
        for (int32_t i = (int32_t)low; i < p->columns && i < high + 2; i++) {
            double next = covered_to(i + 1, low, high), here = next - at;
            cover[i] += (float)(sign * (y1 - y0) * (here - before));
            before = here;
            at = next;
        }
    }
}

static void cover_band(portions *p, int32_t first, int32_t rows) {
    const iso_region *r = p->section;
    memset(p->cover, 0, sizeof *p->cover * (size_t)rows * (size_t)p->columns);
    for (int32_t m = 0; m < r->count; m++)
        for (int32_t i = r->first[m]; i < r->first[m + 1]; i++) {
            int32_t next = i + 1 < r->first[m + 1] ? i + 1 : r->first[m];
            iso_vec2 a = {(r->point[i].x - p->x) / p->step,
                          (r->point[i].y - p->y) / p->step - first};
            iso_vec2 b = {(r->point[next].x - p->x) / p->step,
                          (r->point[next].y - p->y) / p->step - first};
            add_edge(p, rows, a, b);
        }
    for (int32_t j = 0; j < rows; j++) {
        float *cover = p->cover + (int64_t)j * p->columns;
        double sum = 0;
        for (int32_t i = 0; i < p->columns; i++) {
            sum += cover[i];
            cover[i] = sum > COVER_LEAST ? (float)sum : 0;
        }
    }
}

/* ---- squares to pieces ---- */

static int32_t limited(double x, int32_t most) {
    return x <= 0 ? 0 : x >= most ? most : (int32_t)x;
}

/* Squares that a piece is nearer to than all before it. */
static void claim(portions *p, int32_t k, int32_t first, int32_t rows, double reach) {
    const piece *at = &p->piece[k];
    double x = (at->x - p->x) / p->step - 0.5, y = (at->y - p->y) / p->step - 0.5 - first;
    double length = at->length / p->step, ex = at->dx * length, ey = at->dy * length;
    int32_t bottom = limited(y + (ey < 0 ? ey : 0) - reach + 1, rows);
    int32_t top = limited(y + (ey > 0 ? ey : 0) + reach + 1, rows);
    int32_t left = limited(x + (ex < 0 ? ex : 0) - reach + 1, p->columns);
    int32_t right = limited(x + (ex > 0 ? ex : 0) + reach + 1, p->columns);
    for (int32_t j = bottom; j < top; j++) {
        int64_t row = (int64_t)j * p->columns;
        for (int32_t i = left; i < right; i++) {
            if (p->cover[row + i] <= 0)
                continue;
            double u = i - x, v = j - y, along = u * at->dx + v * at->dy;
            along = along < 0 ? 0 : along > length ? length : along;
            u -= along * at->dx;
            v -= along * at->dy;
            float square = (float)(u * u + v * v);
            if (square < p->near[row + i]) {
                p->near[row + i] = square;
                p->owner[row + i] = k;
            }
        }
    }
}

static void claim_all(portions *p, int32_t first, int32_t rows, double reach) {
    int64_t squares = (int64_t)rows * p->columns;
    for (int64_t i = 0; i < squares; i++) {
        p->near[i] = (float)(reach * reach);
        p->owner[i] = -1;
    }
    for (int32_t k = 0; k < p->count; k++)
        claim(p, k, first, rows, reach);
}

static void share_band(portions *p, int32_t first, int32_t rows) {
    int64_t squares = (int64_t)rows * p->columns;
    double reach = REACH * p->bead->usual / p->step, all = 0, left = 0;
    cover_band(p, first, rows);
    claim_all(p, first, rows, reach);
    for (int64_t i = 0; i < squares; i++) {
        all += p->cover[i];
        left += p->owner[i] < 0 ? p->cover[i] : 0;
    }
    if (left > LEFT_ALLOWED * all)
        claim_all(p, first, rows, REACH_FAR * reach);
    for (int64_t i = 0; i < squares; i++)
        if (p->owner[i] >= 0) {
            p->piece[p->owner[i]].share += p->cover[i];
            p->owned += p->cover[i];
        }
    p->all += all;
}

static iso_status share_all(portions *p) {
    iso_point low, high;
    low = high = p->section->point[0];
    for (int32_t i = 0; i < p->section->first[p->section->count]; i++) {
        iso_point at = p->section->point[i];
        low.x = at.x < low.x ? at.x : low.x;
        low.y = at.y < low.y ? at.y : low.y;
        high.x = at.x > high.x ? at.x : high.x;
        high.y = at.y > high.y ? at.y : high.y;
    }
    p->step = p->bead->usual / SQUARES_A_BEAD;
    p->x = low.x;
    p->y = low.y;
    p->columns = (int32_t)(((double)high.x - low.x) / p->step) + 2;
    p->rows = (int32_t)(((double)high.y - low.y) / p->step) + 1;
    int32_t band = p->rows < BAND ? p->rows : BAND;
    ISO_TRY(ISO_PUSH(p->cover, p->scratch, (int64_t)band * p->columns));
    ISO_TRY(ISO_PUSH(p->near, p->scratch, (int64_t)band * p->columns));
    ISO_TRY(ISO_PUSH(p->owner, p->scratch, (int64_t)band * p->columns));
    for (int32_t j = 0; j < p->rows; j += band)
        share_band(p, j, p->rows - j < band ? p->rows - j : band);
    return ISO_OK;
}

/* ---- shares to widths ---- */

/* A piece's share to its net width, the same for as many as make a run. */
static void level_runs(portions *p, int32_t begin, int32_t end) {
    double least = RUN * p->bead->usual, scale = p->step * p->step * p->all / p->owned;
    for (int32_t k = begin, next; k < end; k = next) {
        double length = 0, share = 0, rest = 0;
        for (next = k; next < end && length < least; next++) {
            length += p->piece[next].length;
            share += p->piece[next].share;
        }
        for (int32_t i = next; i < end && rest < least; i++)
            rest += p->piece[i].length;
        for (; rest < least && next < end; next++) { /* a path's end too short for a run */
            length += p->piece[next].length;
            share += p->piece[next].share;
        }
        for (int32_t i = k; i < next; i++)
            p->piece[i].share = share * scale / length;
    }
}

/* What a piece can't hold, or would have too little of, is its neighbours'. Returns what is over at
 * the end. */
static double carry(portions *p, int32_t begin, int32_t end, int32_t by, double over) {
    double least = LEAST * p->bead->usual, most = p->bead->most;
    for (int32_t k = begin; k != end; k += by) {
        piece *at = &p->piece[k];
        double volume = at->share * at->length + over, width = volume / at->length;
        at->share = width < least ? least : width < most ? width : most;
        over = volume - at->share * at->length;
    }
    return over;
}

/* Widths that hardly differ become one. */
static void even_out(portions *p, int32_t begin, int32_t end) {
    for (int32_t k = begin, next; k < end; k = next) {
        double length = p->piece[k].length, volume = p->piece[k].share * length;
        for (next = k + 1; next < end; next++) {
            double mean = volume / length, share = p->piece[next].share;
            if (fabs(share - mean) > ALIKE * mean)
                break;
            volume += share * p->piece[next].length;
            length += p->piece[next].length;
        }
        for (int32_t i = k; i < next; i++)
            p->piece[i].share = volume / length;
    }
}

/* The path again, as the pieces begin..end of it say; `count` and `first` of `like` are of what it
 * was. */
static iso_status rewrite(portions *p, const iso_path *like, int32_t begin, int32_t end,
                          iso_point *point, int32_t *which) {
    iso_paths *out = p->paths;
    int32_t count = 0, told = 0;
    for (int32_t k = begin; k < end; k++) {
        const piece *at = &p->piece[k];
        if (k > begin && at->vertex == at[-1].vertex && at->share == at[-1].share)
            continue;
        point[count] = (iso_point){(int32_t)floor(at->x + 0.5), (int32_t)floor(at->y + 0.5)};
        which[count++] = k;
    }
    if (!like->closed) {
        point[count] = p->old[like->count - 1].at;
        which[count++] = end - 1;
    }
    ISO_TRY(iso_paths_add(out, like, point, count, 0, 0));
    iso_path_vertex *v = out->vertex + out->path[out->count - 1].first;
    for (int32_t i = 0; i < count; i++) {
        double net = p->piece[which[i]].share, full = net + p->bead->corners;
        if (fabs(full - told) > p->bead->told)
            told = (int32_t)(full + 0.5);
        v[i].role = like->role;
        v[i].width = told;
        v[i].area = (int32_t)(net * p->bead->height + 0.5);
    }
    return ISO_OK;
}

/* The pieces from `begin` on that are of a path. */
static int32_t end_of(const portions *p, int32_t begin, const iso_path *path) {
    while (begin < p->count && p->piece[begin].vertex < path->first + path->count)
        begin++;
    return begin;
}

/* What a path can't hold is for all to hold. */
static void level_all(portions *p, int32_t first) {
    double want = p->all * p->step * p->step, have = 0;
    for (int32_t n = first, begin = 0, end; n < p->paths->count; n++, begin = end) {
        end = end_of(p, begin, &p->paths->path[n]);
        level_runs(p, begin, end);
        double over = carry(p, begin, end, 1, 0);
        carry(p, end - 1, begin - 1, -1, over);
        even_out(p, begin, end);
    }
    for (int32_t k = 0; k < p->count; k++)
        have += p->piece[k].share * p->piece[k].length;
    for (int32_t k = 0; k < p->count; k++)
        p->piece[k].share *= want / have;
}

static iso_status rewrite_all(portions *p, int32_t first) {
    iso_paths *out = p->paths;
    int32_t paths = out->count - first, vertices = out->vertex_count;
    int32_t from = out->path[first].first, *which;
    iso_path *like;
    iso_path_vertex *old;
    iso_point *point;
    ISO_TRY(ISO_PUSH(like, p->scratch, paths));
    ISO_TRY(ISO_PUSH(old, p->scratch, vertices - from));
    ISO_TRY(ISO_PUSH(point, p->scratch, p->count + 1));
    ISO_TRY(ISO_PUSH(which, p->scratch, p->count + 1));
    memcpy(like, out->path + first, sizeof *like * (size_t)paths);
    memcpy(old, out->vertex + from, sizeof *old * (size_t)(vertices - from));
    out->count = first;
    out->vertex_count = from;
    for (int32_t n = 0, begin = 0, end; n < paths; n++, begin = end) {
        end = end_of(p, begin, &like[n]);
        p->old = old + (like[n].first - from);
        if (end > begin)
            ISO_TRY(rewrite(p, &like[n], begin, end, point, which));
    }
    return ISO_OK;
}

iso_status portion_out(iso_paths *paths, int32_t begin, const iso_region *section,
                       const sheet_bead *bead, iso_arena *scratch) {
    portions p = {.paths = paths, .section = section, .bead = bead, .scratch = scratch};
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    for (int32_t k = begin; k < paths->count; k++)
        p.count += cut_path(NULL, &p, &paths->path[k]);
    if (section->count == 0 || p.count == 0)
        return ISO_OK;
    ISO_TRY(ISO_PUSH(p.piece, scratch, p.count));
    for (int32_t k = begin, count = 0; k < paths->count; k++)
        count += cut_path(p.piece + count, &p, &paths->path[k]);
    iso_status status = share_all(&p);
    if (status == ISO_OK && p.owned > 0) {
        level_all(&p, begin);
        status = rewrite_all(&p, begin);
    }
    iso_arena_pop(scratch, mark);
    return status;
}

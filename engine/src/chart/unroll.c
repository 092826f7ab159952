/* Contours around an axis, laid flat: cut where the chart ends, and closed along the cuts.
 *
 * A contour is unrolled from point to point, the short way each time. One that comes back to where
 * it began is there once for every period in which the window sees some of it; one that has gone
 * around goes on from period to period. What leaves the window ends there; ends and beginnings on
 * the same side are joined along it, from below, first with first: winding numbers within the
 * window are then the same whichever are joined. All of it happens in whole units, so that copies a
 * period apart are alike. */
#include <math.h>

#include "base/sort.h"
#include "chart/kind.h"

enum { LEFT, RIGHT };

typedef struct piece {
    int64_t first, end; /* points */
    int begin_side, end_side;
    int32_t next; /* piece that goes on where this one ends */
    int32_t taken;
} piece;

/* A piece at one of its ends. */
typedef struct cut_end {
    double v;
    int32_t piece;
} cut_end;

typedef struct unroll {
    int64_t period;   /* units */
    double low, high; /* mm: the window */
    int64_t *u;       /* [points] units: a contour unrolled, from its first point on */
    int64_t u_capacity;
    iso_vec2 *point; /* of pieces */
    int64_t points, point_capacity;
    piece *piece;
    int64_t pieces, piece_capacity;
    cut_end *cut; /* [2 pieces] */
    int64_t cut_capacity;
    iso_slices out;
    int64_t contour_capacity, crossing_capacity;
} unroll;

static void unroll_free(unroll *w) {
    iso_release(w->u);
    iso_release(w->point);
    iso_release(w->piece);
    iso_release(w->cut);
    iso_slices_free(&w->out);
}

/* ---- out ---- */

static iso_status begin_contour(unroll *w) {
    if (w->out.contour_count >= INT32_MAX - 1)
        return iso_fail(ISO_UNSLICEABLE, "more than %d contours", INT32_MAX - 1);
    ISO_TRY(ISO_GROW(w->out.contour_first, w->contour_capacity, (int64_t)w->out.contour_count + 2));
    w->out.contour_first[w->out.contour_count++] = w->out.crossing_count;
    return ISO_OK;
}

static iso_status put_crossing(unroll *w, iso_vec2 p) {
    ISO_TRY(ISO_GROW(w->out.point, w->crossing_capacity, w->out.crossing_count + 1));
    w->out.point[w->out.crossing_count++] = p;
    return ISO_OK;
}

/* ---- pieces ---- */

static iso_status put_point(unroll *w, iso_vec2 p) {
    ISO_TRY(ISO_GROW(w->point, w->point_capacity, w->points + 1));
    w->point[w->points++] = p;
    w->piece[w->pieces - 1].end = w->points;
    return ISO_OK;
}

static iso_status begin_piece(unroll *w, int side, iso_vec2 p) {
    ISO_TRY(ISO_GROW(w->piece, w->piece_capacity, w->pieces + 1));
    w->piece[w->pieces++] = (piece){.first = w->points, .begin_side = side};
    return put_point(w, p);
}

static iso_status end_piece(unroll *w, int side, iso_vec2 p) {
    w->piece[w->pieces - 1].end_side = side;
    return put_point(w, p);
}

static bool is_inside(const unroll *w, iso_vec2 p) {
    return p.x > w->low && p.x < w->high;
}

static int side_of(const unroll *w, iso_vec2 outside) {
    return outside.x <= w->low ? LEFT : RIGHT;
}

static iso_vec2 crossing(const unroll *w, iso_vec2 a, iso_vec2 b, int side) {
    double u = side == LEFT ? w->low : w->high;
    return (iso_vec2){u, a.y + (b.y - a.y) * ((u - a.x) / (b.x - a.x))};
}

/* From a point to the next one of a line that begins outside. */
static iso_status clip_edge(unroll *w, iso_vec2 a, iso_vec2 b) {
    bool from = is_inside(w, a), to = is_inside(w, b);
    if (from && to)
        return put_point(w, b);
    if (from)
        return end_piece(w, side_of(w, b), crossing(w, a, b, side_of(w, b)));
    if (to) {
        ISO_TRY(begin_piece(w, side_of(w, a), crossing(w, a, b, side_of(w, a))));
        return put_point(w, b);
    }
    if (side_of(w, a) == side_of(w, b))
        return ISO_OK;
    ISO_TRY(begin_piece(w, side_of(w, a), crossing(w, a, b, side_of(w, a))));
    return end_piece(w, side_of(w, b), crossing(w, a, b, side_of(w, b)));
}

/* ---- contours ---- */

/* A contour and its copy that is `turns` periods on. */
typedef struct copy_of {
    const unroll *w;
    const iso_vec2 *flat; /* its v */
    int64_t count, turns;
} copy_of;

static iso_vec2 point_of(const copy_of *c, int64_t i) {
    return (iso_vec2){iso_mm(c->w->u[i] + c->turns * c->w->period), c->flat[i % c->count].y};
}

/* One that comes back. */
static iso_status clip_closed(unroll *w, const copy_of *c) {
    int64_t start = 0;
    while (start < c->count && is_inside(w, point_of(c, start)))
        start++;
    if (start == c->count) {
        ISO_TRY(begin_contour(w));
        for (int64_t i = 0; i < c->count; i++)
            ISO_TRY(put_crossing(w, point_of(c, i)));
        return ISO_OK;
    }
    for (int64_t i = 0; i < c->count; i++)
        ISO_TRY(clip_edge(w, point_of(c, (start + i) % c->count),
                          point_of(c, (start + i + 1) % c->count)));
    return ISO_OK;
}

static int64_t floor_of(double x) {
    return (int64_t)floor(x);
}

/* u of all points, and how often the contour goes around. */
static iso_status unroll_contour(unroll *w, int64_t *around, const iso_vec2 *flat, int64_t count) {
    ISO_TRY(ISO_GROW(w->u, w->u_capacity, count + 1));
    w->u[0] = iso_units(flat[0].x);
    for (int64_t i = 1; i <= count; i++) {
        int64_t step = iso_units(flat[i % count].x) - w->u[i - 1];
        step %= w->period;
        if (2 * step > w->period)
            step -= w->period;
        else if (2 * step < -w->period)
            step += w->period;
        w->u[i] = w->u[i - 1] + step;
    }
    *around = (w->u[count] - w->u[0]) / w->period;
    return ISO_OK;
}

static iso_status unroll_one(unroll *w, const iso_vec2 *flat, int64_t count) {
    int64_t around, low, high;
    ISO_TRY(unroll_contour(w, &around, flat, count));
    if (around < -1 || around > 1)
        return iso_fail(ISO_UNSLICEABLE, "a contour goes around the axis %lld times",
                        (long long)around);
    low = high = w->u[0];
    for (int64_t i = 1; i <= count; i++) {
        low = w->u[i] < low ? w->u[i] : low;
        high = w->u[i] > high ? w->u[i] : high;
    }
    double period = iso_mm(w->period);
    int64_t first = floor_of((w->low - iso_mm(high)) / period);
    int64_t last = floor_of((w->high - iso_mm(low)) / period) + 1;
    for (int64_t k = 0; k <= last - first; k++) {
        copy_of c = {.w = w, .flat = flat, .count = count};
        c.turns = around < 0 ? last - k : first + k;
        if (iso_mm(high + c.turns * w->period) <= w->low ||
            iso_mm(low + c.turns * w->period) >= w->high)
            continue; /* not to be seen */
        if (around == 0) {
            ISO_TRY(clip_closed(w, &c));
            continue;
        }
        for (int64_t i = 0; i < count; i++)
            ISO_TRY(clip_edge(w, point_of(&c, i), point_of(&c, i + 1)));
    }
    return ISO_OK;
}

/* ---- joining ---- */

static int is_below(const cut_end *a, const cut_end *b) {
    return a->v != b->v ? a->v < b->v : a->piece < b->piece;
}
ISO_SORT(sort_cuts, cut_end, is_below)

/* Ends of pieces on a side go to beginnings on it. */
static iso_status join_side(unroll *w, int side) {
    cut_end *ends = w->cut, *begins = w->cut + w->pieces;
    int32_t end_count = 0, begin_count = 0;
    for (int32_t p = 0; p < w->pieces; p++) {
        const piece *of = &w->piece[p];
        if (of->end_side == side)
            ends[end_count++] = (cut_end){w->point[of->end - 1].y, p};
        if (of->begin_side == side)
            begins[begin_count++] = (cut_end){w->point[of->first].y, p};
    }
    if (end_count != begin_count)
        return iso_fail(ISO_UNSLICEABLE,
                        "a layer isn't closed around the axis: at one place it "
                        "begins %d times and ends %d times",
                        begin_count, end_count);
    sort_cuts(ends, end_count);
    sort_cuts(begins, begin_count);
    for (int32_t i = 0; i < end_count; i++)
        w->piece[ends[i].piece].next = begins[i].piece;
    return ISO_OK;
}

static iso_status put_joined(unroll *w, int32_t first) {
    ISO_TRY(begin_contour(w));
    for (int32_t p = first; !w->piece[p].taken; p = w->piece[p].next) {
        w->piece[p].taken = 1;
        for (int64_t i = w->piece[p].first; i < w->piece[p].end; i++)
            ISO_TRY(put_crossing(w, w->point[i]));
    }
    return ISO_OK;
}

static iso_status join_pieces(unroll *w) {
    if (w->pieces > INT32_MAX)
        return iso_fail(ISO_UNSLICEABLE, "more than %d pieces of contours", INT32_MAX);
    ISO_TRY(ISO_GROW(w->cut, w->cut_capacity, 2 * w->pieces));
    ISO_TRY(join_side(w, LEFT));
    ISO_TRY(join_side(w, RIGHT));
    for (int32_t p = 0; p < w->pieces; p++)
        if (!w->piece[p].taken)
            ISO_TRY(put_joined(w, p));
    return ISO_OK;
}

static iso_status unroll_level(unroll *w, const iso_curves *curves, const iso_vec2 *flat,
                               int32_t level) {
    w->points = w->pieces = 0;
    w->out.level_first[level] = w->out.contour_count;
    for (int32_t c = curves->level_first[level]; c < curves->level_first[level + 1]; c++) {
        int64_t first = curves->contour_first[c], count = curves->contour_first[c + 1] - first;
        if (count > 0)
            ISO_TRY(unroll_one(w, flat + first, count));
    }
    return join_pieces(w);
}

static iso_status unroll_all(unroll *w, const iso_curves *curves, const iso_vec2 *flat) {
    w->out.level_count = curves->level_count;
    ISO_TRY(ISO_ALLOCATE(w->out.level_first, (int64_t)curves->level_count + 1));
    ISO_TRY(ISO_GROW(w->out.contour_first, w->contour_capacity, 1));
    ISO_TRY(ISO_GROW(w->out.point, w->crossing_capacity, 1));
    for (int32_t level = 0; level < curves->level_count; level++)
        ISO_TRY(unroll_level(w, curves, flat, level));
    w->out.level_first[curves->level_count] = w->out.contour_count;
    w->out.contour_first[w->out.contour_count] = w->out.crossing_count;
    return ISO_OK;
}

iso_status unroll_slices(iso_slices *slices, const chart *map, const iso_curves *curves,
                         double margin) {
    unroll w = {.period = 2 * (int64_t)iso_units(0.5 * map->period)};
    iso_vec2 *flat;
    w.high = iso_mm(w.period / 2 + iso_units(margin));
    w.low = -w.high;
    ISO_TRY(ISO_ALLOCATE(flat, curves->crossing_count));
    chart_down(flat, map, curves->point, curves->crossing_count);
    iso_status status = unroll_all(&w, curves, flat);
    iso_release(flat);
    if (status == ISO_OK) {
        *slices = w.out;
        w.out = (iso_slices){0};
    }
    unroll_free(&w);
    return status;
}

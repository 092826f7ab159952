#include "fill/clip.h"

#include <math.h>

#include "base/angle.h"
#include "base/sort.h"
#include "planar/predicate.h"

/* ---- grid ---- */

typedef struct span {
    int32_t low, high;
} span;

static int32_t cell_of(int32_t at, int32_t origin, int shift, int32_t count) {
    int32_t cell = (at - origin) >> shift;
    return cell < 0 ? 0 : cell < count ? cell : count - 1;
}

/* Columns that a-b passes within a row; a unit or two more for rounding. */
static span columns_in(const iso_clip *clip, iso_point a, iso_point b, int32_t row) {
    int32_t low = a.x < b.x ? a.x : b.x, high = a.x < b.x ? b.x : a.x;
    if (a.y != b.y && (high - low) >> clip->shift > 1) {
        double slope = ((double)b.x - a.x) / ((double)b.y - a.y);
        double bottom = clip->box.min.y + (double)((int64_t)row << clip->shift);
        double x0 = a.x + (bottom - a.y) * slope;
        double x1 = x0 + slope * (double)((int64_t)1 << clip->shift);
        double left = floor(x0 < x1 ? x0 : x1) - 2, right = ceil(x0 < x1 ? x1 : x0) + 2;
        low = left > low ? (int32_t)left : low;
        high = right < high ? (int32_t)right : high;
    }
    return (span){cell_of(low, clip->box.min.x, clip->shift, clip->columns),
                  cell_of(high, clip->box.min.x, clip->shift, clip->columns)};
}

static span rows_of(const iso_clip *clip, iso_point a, iso_point b) {
    return (span){
        cell_of(a.y < b.y ? a.y : b.y, clip->box.min.y, clip->shift, clip->rows),
        cell_of(a.y < b.y ? b.y : a.y, clip->box.min.y, clip->shift, clip->rows),
    };
}

/* Count the edges of each cell (entry NULL), or write them where clip->first says. */
static void enter_edges(const iso_clip *clip, int32_t *entry) {
    const iso_point *point = clip->region->point;
    int32_t edges = clip->region->first[clip->region->count];
    for (int32_t i = 0; i < edges; i++) {
        span rows = rows_of(clip, point[i], point[clip->next[i]]);
        for (int32_t row = rows.low; row <= rows.high; row++) {
            span columns = columns_in(clip, point[i], point[clip->next[i]], row);
            for (int32_t k = columns.low; k <= columns.high; k++) {
                int32_t *first = &clip->first[row * clip->columns + k];
                if (entry)
                    entry[*first] = i;
                ++*first;
            }
        }
    }
}

/* About as many cells as edges, and some more where there are few. */
static void choose_cells(iso_clip *clip, int32_t edges) {
    int64_t width = (int64_t)clip->box.max.x - clip->box.min.x + 1;
    int64_t height = (int64_t)clip->box.max.y - clip->box.min.y + 1;
    int64_t most = 256 + 2 * (int64_t)edges;
    clip->shift = 0;
    while (((width >> clip->shift) + 1) * ((height >> clip->shift) + 1) > most)
        clip->shift++;
    clip->columns = (int32_t)(width >> clip->shift) + 1;
    clip->rows = (int32_t)(height >> clip->shift) + 1;
}

static iso_status build_grid(iso_clip *clip, int32_t edges) {
    choose_cells(clip, edges);
    int64_t cells = (int64_t)clip->columns * clip->rows;
    ISO_TRY(ISO_PUSH(clip->first, clip->scratch, cells + 1));
    memset(clip->first, 0, ((size_t)cells + 1) * sizeof *clip->first);
    enter_edges(clip, NULL);
    int32_t sum = 0;
    for (int64_t k = 0; k <= cells; k++) {
        int32_t size = clip->first[k];
        clip->first[k] = sum;
        sum += size;
    }
    ISO_TRY(ISO_PUSH(clip->entry, clip->scratch, sum));
    enter_edges(clip, clip->entry);
    for (int64_t k = cells; k > 0; k--)
        clip->first[k] = clip->first[k - 1];
    clip->first[0] = 0;
    return ISO_OK;
}

static iso_status add_block(iso_clip *clip) {
    iso_clip_block *block = iso_arena_push(clip->scratch, sizeof *block);
    if (!block)
        return iso_no_memory(sizeof *block);
    block->next = NULL;
    block->count = 0;
    if (clip->block)
        clip->block->next = block;
    else
        clip->head = block;
    clip->block = block;
    return ISO_OK;
}

iso_status iso_clip_begin(iso_clip *clip, const iso_region *region, double angle, iso_point origin,
                          iso_arena *scratch) {
    *clip = (iso_clip){.region = region, .scratch = scratch, .frame.origin = origin};
    int32_t edges = region->first[region->count];
    iso_sine_cosine(&clip->frame.sine, &clip->frame.cosine, angle);
    clip->box = (iso_box){region->point[0], region->point[0]};
    for (int32_t i = 1; i < edges; i++)
        box_add(&clip->box, region->point[i]);
    ISO_TRY(ISO_PUSH(clip->next, scratch, edges));
    ISO_TRY(ISO_PUSH(clip->seen, scratch, edges));
    ISO_TRY(ISO_PUSH(clip->crossed, scratch, edges));
    memset(clip->seen, 0, (size_t)edges * sizeof *clip->seen);
    for (int32_t m = 0; m < region->count; m++)
        for (int32_t i = region->first[m]; i < region->first[m + 1]; i++)
            clip->next[i] = i + 1 < region->first[m + 1] ? i + 1 : region->first[m];
    ISO_TRY(build_grid(clip, edges));
    return add_block(clip);
}

void iso_clip_extent(double min[2], double max[2], const iso_clip *clip) {
    const iso_region *region = clip->region;
    min[0] = min[1] = INFINITY;
    max[0] = max[1] = -INFINITY;
    for (int32_t i = 0; i < region->first[region->count]; i++) {
        double x = (double)region->point[i].x - clip->frame.origin.x;
        double y = (double)region->point[i].y - clip->frame.origin.y;
        double u = x * clip->frame.cosine + y * clip->frame.sine;
        double v = y * clip->frame.cosine - x * clip->frame.sine;
        min[0] = u < min[0] ? u : min[0];
        max[0] = u > max[0] ? u : max[0];
        min[1] = v < min[1] ? v : min[1];
        max[1] = v > max[1] ? v : max[1];
    }
}

/* ---- crossings ---- */

/* Of p moved by (e, e^2): left of c -> d? *size = |orient2d|. */
static int is_left(int64_t *size, iso_point c, iso_point d, iso_point p) {
    int64_t turn = orient2d(c, d, p);
    *size = turn < 0 ? -turn : turn;
    return turn != 0 ? turn > 0 : d.y != c.y ? d.y < c.y : d.x > c.x;
}

/* Of a and b moved so: is c left of a -> b? */
static int has_left(iso_point a, iso_point b, iso_point c) {
    int64_t turn = orient2d(a, b, c);
    return turn != 0 ? turn > 0 : b.y != a.y ? b.y > a.y : b.x < a.x;
}

static int does_cross(iso_clip_edge *found, const iso_clip *clip, iso_point b, int32_t i) {
    iso_point a = clip->at, c = clip->region->point[i], d = clip->region->point[clip->next[i]];
    iso_box step = box_of(a, b), edge = box_of(c, d);
    if (!boxes_meet(&step, &edge) || has_left(a, b, c) == has_left(a, b, d))
        return 0;
    int from = is_left(&found->before, c, d, a), to = is_left(&found->after, c, d, b);
    found->edge = 2 * i + from; /* the region is left of its edges */
    return from != to;
}

static int comes_before(const iso_clip_edge *p, const iso_clip_edge *q) {
    iso_int128 left = (iso_int128)p->before * (q->before + q->after);
    iso_int128 right = (iso_int128)q->before * (p->before + p->after);
    return left != right ? left < right : p->edge < q->edge;
}

static inline int crossed_less(const iso_clip_edge *p, const iso_clip_edge *q) {
    return comes_before(p, q);
}
ISO_SORT(sort_crossed, iso_clip_edge, crossed_less)

/* The edges that the step to b crosses, in order. Those crossed at the same place, a corner that
 * the step grazes, take turns in entering and leaving. */
static int32_t find_crossed(iso_clip *clip, iso_point b, int inside) {
    iso_clip_edge *crossed = clip->crossed;
    int32_t count = 0;
    span rows = rows_of(clip, clip->at, b);
    clip->step++;
    for (int32_t row = rows.low; row <= rows.high; row++) {
        span columns = columns_in(clip, clip->at, b, row);
        int32_t cell = row * clip->columns;
        for (int32_t k = clip->first[cell + columns.low]; k < clip->first[cell + columns.high + 1];
             k++) {
            int32_t i = clip->entry[k];
            if (clip->seen[i] == clip->step)
                continue;
            clip->seen[i] = clip->step;
            count += does_cross(&crossed[count], clip, b, i);
        }
    }
    if (count > 1)
        sort_crossed(crossed, count);
    for (int32_t i = 0; i < count; i++, inside = !inside)
        for (int32_t j = i; j < count; j++)
            if ((crossed[j].edge & 1) == inside) {
                iso_clip_edge swap = crossed[i];
                crossed[i] = crossed[j];
                crossed[j] = swap;
                break;
            }
    return count;
}

static iso_point crossing_at(const iso_clip *clip, iso_point b, int32_t i) {
    iso_point c = clip->region->point[i], d = clip->region->point[clip->next[i]];
    double before = (double)orient2d(clip->at, b, c), after = (double)orient2d(clip->at, b, d);
    double t = before / (before - after);
    return (iso_point){(int32_t)floor(c.x + ((double)d.x - c.x) * t + 0.5),
                       (int32_t)floor(c.y + ((double)d.y - c.y) * t + 0.5)};
}

/* ---- curves ---- */

static void note(iso_clip *clip, iso_point at, int32_t edge) {
    if (clip->block->count == ISO_CLIP_BLOCK && (clip->status = add_block(clip)) != ISO_OK)
        return;
    clip->block->event[clip->block->count++] = (iso_clip_event){at, edge, clip->bead};
}

static int is_beyond(const iso_clip *clip, iso_point a, iso_point b) {
    const iso_box *box = &clip->box;
    return (a.x < box->min.x && b.x < box->min.x) || (a.x > box->max.x && b.x > box->max.x) ||
           (a.y < box->min.y && b.y < box->min.y) || (a.y > box->max.y && b.y > box->max.y);
}

static int32_t to_nearest(double x) {
    const int32_t offset = 1 << 27; /* makes it positive, so that truncation rounds down */
    return (int32_t)(x + (offset + 0.5)) - offset;
}

static iso_point place(const iso_clip *clip, double x, double y) {
    const iso_clip_frame *frame = &clip->frame;
    return (iso_point){to_nearest(frame->origin.x + x * frame->cosine - y * frame->sine),
                       to_nearest(frame->origin.y + y * frame->cosine + x * frame->sine)};
}

static void finish_curve(iso_clip *clip) {
    iso_clip_event *last = clip->block->event + clip->block->count - 1;
    if (clip->started && clip->inside && clip->block->count && last->edge == ISO_CLIP_INNER)
        last->edge = -1; /* the point that the curve ends in */
    else if (clip->started && clip->inside)
        note(clip, clip->at, -1);
    clip->started = clip->inside = 0;
}

int iso_clip_holds(iso_clip *clip, iso_point at) {
    iso_point was = clip->at;
    if (is_beyond(clip, at, at))
        return 0;
    clip->at = (iso_point){clip->box.min.x - 2, at.y}; /* step in from the left */
    int inside = find_crossed(clip, at, 0) & 1;
    clip->at = was;
    return inside;
}

static void start_at(iso_clip *clip, iso_point to, int inside) {
    clip->inside = inside;
    if (inside)
        note(clip, to, -2);
    clip->at = to;
    clip->started = 1;
}

void iso_clip_move_to(iso_clip *clip, iso_point to) {
    if (clip->status != ISO_OK)
        return;
    finish_curve(clip);
    start_at(clip, to, iso_clip_holds(clip, to));
}

void iso_clip_move_within(iso_clip *clip, iso_point to) {
    if (clip->status != ISO_OK)
        return;
    finish_curve(clip);
    start_at(clip, to, 1);
}

void iso_clip_draw_to(iso_clip *clip, iso_point to) {
    if (clip->status != ISO_OK || point_equal(to, clip->at))
        return;
    int32_t count = is_beyond(clip, clip->at, to) ? 0 : find_crossed(clip, to, clip->inside);
    for (int32_t k = 0; k < count && clip->status == ISO_OK; k++) {
        int32_t edge = clip->crossed[k].edge;
        if ((edge & 1) != clip->inside) /* no region has such edges */
            continue;
        note(clip, crossing_at(clip, to, edge >> 1), edge);
        clip->inside = !clip->inside;
    }
    if (clip->inside && clip->status == ISO_OK)
        note(clip, to, ISO_CLIP_INNER);
    clip->at = to;
}

void iso_clip_draw_within(iso_clip *clip, iso_point to) {
    if (clip->status != ISO_OK || point_equal(to, clip->at))
        return;
    note(clip, to, ISO_CLIP_INNER);
    clip->at = to;
}

void iso_clip_move(iso_clip *clip, double x, double y) {
    iso_clip_move_to(clip, place(clip, x, y));
}

void iso_clip_draw(iso_clip *clip, double x, double y) {
    iso_clip_draw_to(clip, place(clip, x, y));
}

iso_status iso_clip_end(iso_weave *weave, iso_clip *clip) {
    int64_t crossings = 0, inner = 0;
    if (clip->status == ISO_OK)
        finish_curve(clip);
    ISO_TRY(clip->status);
    for (const iso_clip_block *block = clip->head; block; block = block->next)
        for (int32_t k = 0; k < block->count; k++)
            block->event[k].edge == ISO_CLIP_INNER ? inner++ : crossings++;
    if (crossings > INT32_MAX / 4 || inner > INT32_MAX / 4)
        return iso_fail(ISO_USAGE, "fill: %lld pieces of curves are too many: use a lower density",
                        (long long)crossings);
    *weave = (iso_weave){.region = clip->region, .count = (int32_t)crossings};
    ISO_TRY(ISO_PUSH(weave->crossing, clip->scratch, crossings));
    ISO_TRY(ISO_PUSH(weave->inner, clip->scratch, inner));
    ISO_TRY(ISO_PUSH(weave->inner_first, clip->scratch, crossings / 2 + 1));
    if (clip->has_beads)
        ISO_TRY(ISO_PUSH(weave->bead, clip->scratch, crossings + inner));
    int32_t c = 0, i = 0;
    for (const iso_clip_block *block = clip->head; block; block = block->next)
        for (int32_t k = 0; k < block->count; k++) {
            const iso_clip_event *event = &block->event[k];
            if (weave->bead)
                weave->bead[event->edge == ISO_CLIP_INNER ? weave->count + i : c] = event->bead;
            if (event->edge == ISO_CLIP_INNER) {
                weave->inner[i++] = event->at;
                continue;
            }
            if (c % 2 == 0)
                weave->inner_first[c / 2] = i;
            weave->crossing[c++] = (iso_crossing){event->at, event->edge, 0};
        }
    weave->inner_first[c / 2] = i;
    return iso_weave_link(weave, clip->scratch);
}

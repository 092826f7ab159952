#include "fill/hatch.h"

#include <math.h>

/* The length of contour within a few units, what rounding makes of an edge, of an end of v. */
static void find_flats(iso_extent *extent, const iso_fill_part *part, const iso_sweep *sweep,
                       double flat) {
    const iso_point *point = part->region->point;
    int32_t from = part->region->first[part->member[0]];
    int32_t to = part->region->first[part->member[0] + 1], last = to - 1;
    int64_t near_low = extent->low + 3 * ISO_SWEEP_ONE,
            near_high = extent->high - 3 * ISO_SWEEP_ONE;
    int64_t before = iso_sweep_v(sweep, point[last]);
    double low = 0, high = 0;
    for (int32_t i = from; i < to; last = i++) {
        int64_t v = iso_sweep_v(sweep, point[i]);
        if (v <= near_low && before <= near_low)
            low += iso_hatch_distance(point[last], point[i]);
        if (v >= near_high && before >= near_high)
            high += iso_hatch_distance(point[last], point[i]);
        before = v;
    }
    extent->low_flat = low > flat;
    extent->high_flat = high > flat;
}

void iso_hatch_extent(iso_extent *extent, const iso_fill_part *part, const iso_sweep *sweep,
                      double flat) {
    const iso_region *region = part->region;
    int32_t outer = part->member[0];
    *extent = (iso_extent){.low = INT64_MAX, .high = INT64_MIN};
    for (int32_t i = region->first[outer]; i < region->first[outer + 1]; i++) {
        int64_t v = iso_sweep_v(sweep, region->point[i]);
        extent->low = v < extent->low ? v : extent->low;
        extent->high = v > extent->high ? v : extent->high;
    }
    if (flat > 0 && extent->low < extent->high)
        find_flats(extent, part, sweep, flat);
}

/* How many lines lie below v. The quotient is at most one off before its correction. */
static inline int32_t level_of(const iso_sweep *sweep, double per_step, int64_t v) {
    int64_t above = v - sweep->first;
    if (above < 0)
        return 0;
    int64_t line = (int64_t)((double)above * per_step), rest = above - line * sweep->step;
    int64_t level = line + 1 - (rest < 0) + (rest >= sweep->step);
    return level < sweep->count ? (int32_t)level : sweep->count;
}

/* The edges that cross any line. Most edges of a fine contour don't, and which do is anybody's
 * guess: so each is written, and every second one is written over. */
static int32_t find_cuts(iso_cut *cut, int32_t *contour_first, const iso_fill_part *part,
                         const iso_sweep *sweep) {
    const iso_region *region = part->region;
    double per_step = 1.0 / (double)sweep->step;
    int32_t count = 0;
    for (int32_t m = 0; m < part->count; m++) {
        int32_t from = region->first[part->member[m]], to = region->first[part->member[m] + 1];
        contour_first[m] = count;
        if (from == to)
            continue;
        iso_cut next = {.from = to - 1};
        next.level_from = level_of(sweep, per_step, iso_sweep_v(sweep, region->point[to - 1]));
        for (int32_t i = from; i < to; i++) {
            next.to = i;
            next.level_to = level_of(sweep, per_step, iso_sweep_v(sweep, region->point[i]));
            cut[count] = next;
            count += next.level_from != next.level_to;
            next.from = i;
            next.level_from = next.level_to;
        }
    }
    contour_first[part->count] = count;
    return count;
}

/* Where the crossings of each line begin. A cut adds one to a run of lines, so the ends of the runs
 * are enough. Returns the number of crossings. */
static int64_t count_crossings(int32_t *begin, const iso_cut *cut, int32_t cut_count,
                               int32_t line_count) {
    memset(begin, 0, ((size_t)line_count + 1) * sizeof *begin);
    for (int32_t k = 0; k < cut_count; k++) {
        int32_t a = cut[k].level_from, b = cut[k].level_to;
        begin[a < b ? a : b]++;
        begin[a < b ? b : a]--;
    }
    int64_t total = 0, here = 0;
    for (int32_t l = 0; l < line_count; l++) {
        here += begin[l];
        begin[l] = (int32_t)(total < INT32_MAX ? total : INT32_MAX);
        total += here;
    }
    return total;
}

static int32_t to_nearest(double x) {
    /* x + offset is positive, so truncation rounds down */
    const int32_t offset = 1 << 26;
    return (int32_t)(x + (offset + 0.5)) - offset;
}

typedef struct hatch_writer {
    iso_hatch *hatch;
    const iso_sweep *sweep;
    int32_t *cursor; /* of each line, where its next crossing goes */
    int32_t order;
} hatch_writer;

/* The crossings of one edge, in the order of the contour. */
static void cross_edge(hatch_writer *writer, const iso_cut *cut) {
    const iso_sweep *sweep = writer->sweep;
    const iso_point *point = writer->hatch->part.region->point;
    iso_point a = point[cut->from], b = point[cut->to];
    int up = cut->level_to > cut->level_from, down = !up;
    int64_t va = iso_sweep_v(sweep, a);
    double scale = 1.0 / (double)(iso_sweep_v(sweep, b) - va);
    double dx = (double)(b.x - a.x) * scale, dy = (double)(b.y - a.y) * scale;
    int32_t line = cut->level_from - down, end = cut->level_to - down;
    for (; line != end; line += up - down) {
        double v = (double)(sweep->first + line * sweep->step - va);
        iso_point at = {to_nearest(a.x + v * dx), to_nearest(a.y + v * dy)};
        writer->hatch->crossing[writer->cursor[line]++] =
            (iso_crossing){at, 2 * cut->from + up, writer->order++};
    }
}

/* contour_first: of each contour its first cut, and on return its first crossing. */
static void cross_contours(hatch_writer *writer, int32_t *contour_first, const iso_cut *cut) {
    int32_t count = writer->hatch->part.count, k = 0;
    for (int32_t m = 0; m < count; m++) {
        contour_first[m] = writer->order;
        for (; k < contour_first[m + 1]; k++)
            cross_edge(writer, &cut[k]);
    }
    contour_first[count] = writer->order;
}

/* B joins neighbours along a contour: it leaves an upward crossing above the line and reaches the
 * next one below it, or above if that one goes down. `dart` holds the leaving darts by order. */
static void link_arcs(iso_fill_link *link, const int32_t *contour_first, const int32_t *dart) {
    for (int32_t m = 0; m < link->contour_count; m++) {
        int32_t from = contour_first[m], to = contour_first[m + 1];
        for (int32_t k = from, before = to - 1; k < to; before = k++) {
            int32_t leave = dart[before], reach = iso_fill_link_other_side(dart[k]);
            link->arc[leave] = reach;
            link->arc[reach] = leave;
            link->contour[dart[k] >> 1] = m;
        }
    }
}

/* `end[l]` is where the crossings of line l end: writing them moved it there. */
static void sort_lines(iso_hatch *hatch, const iso_sweep *sweep, const int32_t *end,
                       iso_crossing *spare) {
    for (int32_t l = 0, from = 0; l < sweep->count; from = end[l++]) {
        iso_crossing_sort(hatch->crossing + from, end[l] - from, spare, hatch->part.region, sweep);
        for (int32_t c = from; c < end[l]; c++)
            hatch->link.line[c] = l;
    }
}

static iso_status push_hatch(iso_hatch *hatch, int64_t total, iso_arena *scratch) {
    if (total > INT32_MAX / 2)
        return iso_fail(ISO_USAGE,
                        "fill: lines cross the contours %lld times, too often: use a "
                        "wider spacing",
                        (long long)total);
    hatch->link.count = (int32_t)total;
    ISO_TRY(ISO_PUSH(hatch->crossing, scratch, total));
    ISO_TRY(ISO_PUSH(hatch->link.arc, scratch, 2 * total));
    ISO_TRY(ISO_PUSH(hatch->link.line, scratch, total));
    return ISO_PUSH(hatch->link.contour, scratch, total);
}

iso_status iso_hatch_build(iso_hatch *hatch, const iso_fill_part *part, const iso_sweep *sweep,
                           iso_cut *room, iso_arena *scratch) {
    *hatch = (iso_hatch){.part = *part};
    hatch->link.line_count = sweep->count;
    hatch->link.contour_count = part->count;
    int32_t *cursor, *contour_first, *dart;
    iso_crossing *spare;
    ISO_TRY(ISO_PUSH(cursor, scratch, (int64_t)sweep->count + 1));
    ISO_TRY(ISO_PUSH(contour_first, scratch, (int64_t)part->count + 1));
    int32_t cuts = find_cuts(room, contour_first, part, sweep);
    int64_t total = count_crossings(cursor, room, cuts, sweep->count);
    ISO_TRY(push_hatch(hatch, total, scratch));
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    ISO_TRY(ISO_PUSH(dart, scratch, total));
    ISO_TRY(ISO_PUSH(spare, scratch, total));
    hatch_writer writer = {hatch, sweep, cursor, 0};
    cross_contours(&writer, contour_first, room);
    sort_lines(hatch, sweep, cursor, spare);
    for (int32_t c = 0; c < hatch->link.count; c++)
        dart[hatch->crossing[c].order] = 2 * c + (hatch->crossing[c].edge & 1);
    link_arcs(&hatch->link, contour_first, dart);
    iso_arena_pop(scratch, mark);
    return ISO_OK;
}

/* On the way along an arc, edge by edge. */
typedef struct arc_walk {
    const iso_region *region;
    int32_t from, to; /* of the contour */
    int32_t edge, last;
    int forward;
    iso_point end;
} arc_walk;

static arc_walk walk_from(const iso_hatch *hatch, int32_t dart) {
    int32_t c = dart >> 1, d = hatch->link.arc[dart] >> 1;
    const iso_region *region = hatch->part.region;
    int32_t contour = hatch->part.member[hatch->link.contour[c]];
    return (arc_walk){.region = region,
                      .from = region->first[contour],
                      .to = region->first[contour + 1],
                      .edge = hatch->crossing[c].edge >> 1,
                      .last = hatch->crossing[d].edge >> 1,
                      .forward = (dart & 1) == (hatch->crossing[c].edge & 1),
                      .end = hatch->crossing[d].at};
}

/* The next point: a corner, returns 1; or the end of the arc, returns 0. */
static int walk_on(arc_walk *walk, iso_point *passed) {
    if (walk->edge == walk->last) {
        *passed = walk->end;
        return 0;
    }
    int32_t i = walk->edge, next;
    if (walk->forward)
        next = i + 1 < walk->to ? i + 1 : walk->from;
    else
        next = (i > walk->from ? i : walk->to) - 1;
    /* edge i begins at point i, so backward its own point comes first */
    *passed = walk->region->point[walk->forward ? next : i];
    walk->edge = next;
    return 1;
}

int32_t iso_hatch_follow(iso_point *point, const iso_hatch *hatch, int32_t dart, double longest) {
    arc_walk walk = walk_from(hatch, dart);
    iso_point here = hatch->crossing[dart >> 1].at, passed;
    if (iso_hatch_distance(here, walk.end) > longest)
        return -1;
    int32_t count = 0;
    double length = 0;
    for (int more = 1; more; here = passed) {
        more = walk_on(&walk, &passed);
        length += iso_hatch_distance(here, passed);
        if (length > longest)
            return -1;
        if (more)
            point[count++] = passed;
    }
    return count;
}

int32_t iso_hatch_follow_for(iso_point *point, const iso_hatch *hatch, int32_t dart,
                             double *length) {
    arc_walk walk = walk_from(hatch, dart);
    iso_point here = hatch->crossing[dart >> 1].at, passed;
    int32_t count = 0;
    double followed = 0;
    for (int more = 1; more && followed < *length; here = passed) {
        more = walk_on(&walk, &passed);
        double step = iso_hatch_distance(here, passed), left = *length - followed;
        if (step > left) {
            passed.x = here.x + to_nearest((passed.x - here.x) * (left / step));
            passed.y = here.y + to_nearest((passed.y - here.y) * (left / step));
            step = left;
        }
        followed += step;
        point[count++] = passed;
    }
    *length = followed;
    return count;
}

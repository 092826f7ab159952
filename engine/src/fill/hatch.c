#include "fill/hatch.h"

#include <math.h>

void iso_hatch_extent(int64_t *low, int64_t *high, const iso_fill_part *part,
                      const iso_sweep *sweep) {
    const iso_region *region = part->region;
    int32_t outer = part->member[0];
    *low = INT64_MAX;
    *high = INT64_MIN;
    for (int32_t i = region->first[outer]; i < region->first[outer + 1]; i++) {
        int64_t v = iso_sweep_v(sweep, region->point[i]);
        *low = v < *low ? v : *low;
        *high = v > *high ? v : *high;
    }
}

/* How many lines lie below v. The quotient is at most one off before its correction. */
static int32_t level_of(const iso_sweep *sweep, double per_step, int64_t v) {
    int64_t above = v - sweep->first;
    if (above < 0)
        return 0;
    int64_t level = (int64_t)((double)above * per_step);
    if (level > sweep->count)
        level = sweep->count;
    while (level > 0 && (level - 1) * sweep->step > above)
        level--;
    while (level < sweep->count && level * sweep->step <= above)
        level++;
    return (int32_t)level;
}

/* Levels of the points, and where the crossings of each line begin. An edge adds one to a run of
 * lines, so the ends of the runs are enough. */
static int64_t count_crossings(int32_t *begin, int32_t *level, const iso_fill_part *part,
                               const iso_sweep *sweep) {
    const iso_region *region = part->region;
    double per_step = 1.0 / (double)sweep->step;
    memset(begin, 0, ((size_t)sweep->count + 1) * sizeof *begin);
    for (int32_t m = 0; m < part->count; m++) {
        int32_t from = region->first[part->member[m]], to = region->first[part->member[m] + 1];
        for (int32_t i = from; i < to; i++)
            level[i] = level_of(sweep, per_step, iso_sweep_v(sweep, region->point[i]));
        for (int32_t i = from, last = to - 1; i < to; last = i++) {
            int32_t a = level[last], b = level[i];
            if (a != b) { /* most edges of a fine contour cross no line */
                begin[a < b ? a : b]++;
                begin[a < b ? b : a]--;
            }
        }
    }
    int64_t total = 0, here = 0;
    for (int32_t l = 0; l < sweep->count; l++) {
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
    const int32_t *level;
    int32_t *cursor; /* of each line, where its next crossing goes */
    int32_t order;
} hatch_writer;

/* The crossings of the edge from point i to point j, in the order of the contour. */
static void cross_edge(hatch_writer *writer, int32_t i, int32_t j) {
    const iso_sweep *sweep = writer->sweep;
    const iso_point *point = writer->hatch->part.region->point;
    iso_point a = point[i], b = point[j];
    int32_t from = writer->level[i], to = writer->level[j];
    int up = to > from;
    int64_t va = iso_sweep_v(sweep, a);
    double scale = 1.0 / (double)(iso_sweep_v(sweep, b) - va);
    double dx = (double)(b.x - a.x) * scale, dy = (double)(b.y - a.y) * scale;
    int32_t turn = up ? 1 : -1, line = up ? from : from - 1, last = up ? to : to - 1;
    for (; line != last; line += turn) {
        double v = (double)(sweep->first + line * sweep->step - va);
        iso_point at = {to_nearest(a.x + v * dx), to_nearest(a.y + v * dy)};
        writer->hatch->crossing[writer->cursor[line]++] =
            (iso_crossing){at, 2 * i + up, writer->order++};
    }
}

static void cross_contours(hatch_writer *writer, int32_t *contour_first) {
    const iso_fill_part *part = &writer->hatch->part;
    for (int32_t m = 0; m < part->count; m++) {
        int32_t from = part->region->first[part->member[m]];
        int32_t to = part->region->first[part->member[m] + 1];
        contour_first[m] = writer->order;
        for (int32_t i = from; i < to; i++) {
            int32_t j = i + 1 < to ? i + 1 : from;
            if (writer->level[i] != writer->level[j])
                cross_edge(writer, i, j);
        }
    }
    contour_first[part->count] = writer->order;
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
                           int32_t *level, iso_arena *scratch) {
    *hatch = (iso_hatch){.part = *part};
    hatch->link.line_count = sweep->count;
    hatch->link.contour_count = part->count;
    int32_t *cursor, *contour_first, *dart;
    iso_crossing *spare;
    ISO_TRY(ISO_PUSH(cursor, scratch, (int64_t)sweep->count + 1));
    int64_t total = count_crossings(cursor, level, part, sweep);
    ISO_TRY(push_hatch(hatch, total, scratch));
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    ISO_TRY(ISO_PUSH(contour_first, scratch, (int64_t)part->count + 1));
    ISO_TRY(ISO_PUSH(dart, scratch, total));
    ISO_TRY(ISO_PUSH(spare, scratch, total));
    hatch_writer writer = {hatch, sweep, level, cursor, 0};
    cross_contours(&writer, contour_first);
    sort_lines(hatch, sweep, cursor, spare);
    for (int32_t c = 0; c < hatch->link.count; c++)
        dart[hatch->crossing[c].order] = 2 * c + (hatch->crossing[c].edge & 1);
    link_arcs(&hatch->link, contour_first, dart);
    iso_arena_pop(scratch, mark);
    return ISO_OK;
}

static double distance(iso_point a, iso_point b) {
    double dx = (double)b.x - a.x, dy = (double)b.y - a.y;
    return sqrt(dx * dx + dy * dy);
}

int32_t iso_hatch_follow(iso_point *point, const iso_hatch *hatch, int32_t dart, double longest) {
    int32_t c = dart >> 1, d = hatch->link.arc[dart] >> 1;
    iso_point here = hatch->crossing[c].at, end = hatch->crossing[d].at;
    if (distance(here, end) > longest)
        return -1;
    const iso_region *region = hatch->part.region;
    int32_t contour = hatch->part.member[hatch->link.contour[c]];
    int32_t from = region->first[contour], to = region->first[contour + 1];
    int32_t i = hatch->crossing[c].edge >> 1, last = hatch->crossing[d].edge >> 1, count = 0;
    int forward = (dart & 1) == (hatch->crossing[c].edge & 1);
    double length = 0;
    while (i != last) { /* edge i begins at point i, so backward its own point comes first */
        int32_t next = forward ? (i + 1 < to ? i + 1 : from) : (i > from ? i : to) - 1;
        iso_point passed = region->point[forward ? next : i];
        length += distance(here, passed);
        if (length > longest)
            return -1;
        here = point[count++] = passed;
        i = next;
    }
    return length + distance(here, end) > longest ? -1 : count;
}

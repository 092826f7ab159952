#include <isoslice/fill.h>

#include <math.h>

#include "fill/hatch.h"
#include "planar/predicate.h"

/* A run of the zigzag while it grows. */
typedef struct zigzag {
    const iso_hatch *hatch;
    const iso_fill_options *options;
    uint8_t *drawn; /* of each segment */
    iso_point *point;
    int32_t count;
} zigzag;

static void draw_to(zigzag *run, iso_point to) {
    iso_point last = run->count ? run->point[run->count - 1] : (iso_point){0};
    if (!run->count || last.x != to.x || last.y != to.y)
        run->point[run->count++] = to;
}

/* Is every point within `deviation` of the line a-b? (The points of a short arc: so no spike can
 * hide beyond the ends for longer than the link itself.) */
static int is_straight(iso_point a, iso_point b, const iso_point *point, int32_t count,
                       double deviation) {
    double dx = (double)b.x - a.x, dy = (double)b.y - a.y, length = iso_hatch_distance(a, b);
    for (int32_t i = 0; i < count; i++) {
        double px = (double)point[i].x - a.x, py = (double)point[i].y - a.y;
        double off = dx * py - dy * px, along = dx * px + dy * py;
        if (fabs(off) > deviation * length || along < 0 || along > length * length)
            return 0;
    }
    return 1;
}

/* Draw the link that leaves the run's end by `dart`. Returns the dart by which the next segment
 * starts, or -1 if there is no such link. */
static int32_t draw_link(zigzag *run, int32_t dart) {
    const iso_hatch *hatch = run->hatch;
    int32_t reach = hatch->link.arc[dart];
    if (run->drawn[reach >> 2])
        return -1;
    iso_point *arc = run->point + run->count;
    int32_t count = iso_hatch_follow(arc, hatch, dart, run->options->link_max);
    if (count < 0)
        return -1;
    iso_point end = hatch->crossing[reach >> 1].at;
    if (!is_straight(arc[-1], end, arc, count, run->options->deviation))
        for (int32_t i = 0; i < count; i++)
            draw_to(run, arc[i]);
    return iso_fill_link_other_side(reach);
}

/* From the run's end at `dart`, its segment drawn: first on this side of the line (z = SBF), then
 * on the other; neighbouring lines before a piece of the same line. */
static int32_t draw_next(zigzag *run, int32_t dart) {
    const int32_t *arc = run->hatch->link.arc;
    if (run->options->link_max <= 0)
        return -1;
    for (int same_line = 0; same_line < 2; same_line++)
        for (int other = 0; other < 2; other++) {
            int32_t leave = dart ^ other;
            if (((arc[leave] ^ leave) & 1) == same_line)
                continue;
            int32_t next = draw_link(run, leave);
            if (next >= 0)
                return next;
        }
    return -1;
}

static iso_point place(const zigzag *run, int32_t dart) {
    return run->hatch->crossing[dart >> 1].at;
}

/* The run's end is at `dart`, from where its segment is still to be drawn. */
static void draw_on(zigzag *run, int32_t dart) {
    while (dart >= 0) {
        run->drawn[dart >> 2] = 1;
        draw_to(run, place(run, dart));
        dart = iso_fill_link_across(dart);
        draw_to(run, place(run, dart));
        dart = draw_next(run, dart);
    }
}

static void turn_round(zigzag *run) {
    for (int32_t i = 0, j = run->count - 1; i < j; i++, j--) {
        iso_point swap = run->point[i];
        run->point[i] = run->point[j];
        run->point[j] = swap;
    }
}

static int is_short(const zigzag *run) {
    double length = 0;
    for (int32_t i = 1; i < run->count && length <= run->options->shortest; i++)
        length += iso_hatch_distance(run->point[i - 1], run->point[i]);
    return run->count < 2 || length <= run->options->shortest;
}

/* Segments in the order of the lines: what is left lowest has nothing left below, so that a run
 * that starts there does not cut a column in two. */
static iso_status draw_part(iso_paths *out, zigzag *run, int32_t width, int32_t area) {
    iso_path like = run->options->like;
    like.closed = 0;
    int32_t segments = run->hatch->link.count / 2;
    iso_point at = segments ? run->hatch->crossing[0].at : (iso_point){0};
    for (int32_t s = 0; s < segments; s++) {
        if (run->drawn[s])
            continue;
        int32_t left = 4 * s + 1, right = 4 * s + 3; /* darts that go on upward */
        int32_t start =
            iso_hatch_distance(at, place(run, right)) < iso_hatch_distance(at, place(run, left))
                ? right
                : left;
        run->count = 0;
        draw_on(run, start);
        at = run->point[run->count - 1];
        turn_round(run); /* and on from the other end, if it leads anywhere */
        int32_t back = draw_next(run, start);
        draw_on(run, back);
        if (back < 0)
            turn_round(run);
        else
            at = run->point[run->count - 1];
        if (!is_short(run))
            ISO_TRY(iso_paths_add(out, &like, run->point, run->count, width, area));
    }
    return ISO_OK;
}

#ifndef NDEBUG
static iso_status check_hatch(const iso_hatch *hatch, iso_arena *scratch) {
    ISO_TRY(iso_fill_link_validate(&hatch->link));
    iso_fill_census census;
    ISO_TRY(iso_fill_link_count(&census, &hatch->link, scratch));
    if (!iso_fill_census_is_plane(&census))
        return iso_fail(ISO_BUG,
                        "fill: contour %d and its holes are no region: %d cells, %d "
                        "segments, %d parts, %d contours",
                        hatch->part.member[0], census.cells, census.segments, census.parts,
                        census.contours);
    return ISO_OK;
}
#endif

static int is_counter_clockwise(const iso_fill_part *part) {
    const iso_point *point = part->region->point;
    int32_t from = part->region->first[part->member[0]];
    int32_t to = part->region->first[part->member[0] + 1];
    int64_t twice = 0; /* no contour within the range of coordinates is larger than 2^53 */
    for (int32_t i = from + 1; i + 1 < to; i++)
        twice += orient2d(point[from], point[i], point[i + 1]);
    return twice >= 0;
}

static iso_status fill_part(iso_paths *out, const iso_fill_part *part, iso_sweep sweep,
                            const iso_fill_options *options, iso_cut *room, iso_arena *scratch) {
    iso_extent extent;
    iso_hatch_extent(&extent, part, &sweep, options->fit ? options->spacing : 0);
    if (extent.low >= extent.high)
        return ISO_OK;
    double share = iso_sweep_place(&sweep, options, &extent);
    if (sweep.count <= 0)
        return ISO_OK;
    iso_hatch hatch;
    ISO_TRY(iso_hatch_build(&hatch, part, &sweep, room, scratch));
    if (hatch.link.count && (hatch.crossing[0].edge & 1) && !is_counter_clockwise(part))
        return iso_fail(ISO_USAGE,
                        "fill: contour %d runs clockwise but lies in no other; clean the region "
                        "first",
                        part->member[0]);
#ifndef NDEBUG
    ISO_TRY(check_hatch(&hatch, scratch));
#endif
    zigzag run = {.hatch = &hatch, .options = options};
    int64_t points = 2 + hatch.link.count;
    for (int32_t m = 0; m < part->count; m++)
        points += part->region->first[part->member[m] + 1] - part->region->first[part->member[m]];
    ISO_TRY(ISO_PUSH(run.point, scratch, points));
    ISO_TRY(ISO_PUSH(run.drawn, scratch, hatch.link.count / 2));
    memset(run.drawn, 0, (size_t)hatch.link.count / 2);
    double widened = options->width + (share - 1) * options->spacing;
    return draw_part(out, &run, (int32_t)(widened + 0.5), (int32_t)(options->area * share + 0.5));
}

/* part[i] = the outer contour whose part contour i belongs to. */
static void find_parts(int32_t *part, const iso_region *region) {
    for (int32_t i = 0; i < region->count; i++) {
        int32_t parent = region->parent[i];
        part[i] = parent >= 0 && part[parent] == parent ? parent : i;
    }
}

/* Contours sorted by part, each part's outer one first: parents come before their children. */
static void sort_members(int32_t *member, int32_t *first, const int32_t *part, int32_t count) {
    memset(first, 0, ((size_t)count + 1) * sizeof *first);
    for (int32_t i = 0; i < count; i++)
        first[part[i]]++;
    for (int32_t i = 0, sum = 0; i <= count; i++) {
        int32_t size = first[i];
        first[i] = sum;
        sum += size;
    }
    for (int32_t i = 0; i < count; i++)
        member[first[part[i]]++] = i;
    for (int32_t i = count; i > 0; i--)
        first[i] = first[i - 1];
    first[0] = 0;
}

static iso_status fill_region(iso_paths *out, const iso_region *region,
                              const iso_fill_options *options, iso_arena *scratch) {
    int32_t *outer, *member, *first, count = region->count;
    iso_cut *room;
    ISO_TRY(ISO_PUSH(outer, scratch, count));
    ISO_TRY(ISO_PUSH(member, scratch, count));
    ISO_TRY(ISO_PUSH(first, scratch, (int64_t)count + 1));
    ISO_TRY(ISO_PUSH(room, scratch, region->first[count]));
    find_parts(outer, region);
    sort_members(member, first, outer, count);
    iso_sweep sweep = iso_sweep_of(options->angle);
    for (int32_t i = 0; i < count; i++) {
        iso_fill_part part = {region, member + first[i], first[i + 1] - first[i]};
        if (part.count == 0)
            continue;
        iso_arena_mark mark = iso_arena_get_mark(scratch);
        ISO_TRY(fill_part(out, &part, sweep, options, room, scratch));
        iso_arena_pop(scratch, mark);
    }
    return ISO_OK;
}

iso_status iso_fill_rectilinear(iso_paths *out, const iso_region *region,
                                const iso_fill_options *options, iso_arena *scratch) {
    ISO_TRY(iso_fill_options_validate(options));
    if (region->count == 0)
        return ISO_OK;
    iso_arena own = {0};
    scratch = scratch ? scratch : &own;
    int32_t count = out->count, vertex_count = out->vertex_count;
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    iso_status status = fill_region(out, region, options, scratch);
    iso_arena_pop(scratch, mark);
    iso_arena_free(&own);
    if (status != ISO_OK) {
        out->count = count;
        out->vertex_count = vertex_count;
    }
    return status;
}

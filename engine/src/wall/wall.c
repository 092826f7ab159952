#include <isoslice/wall.h>

#include <math.h>
#include <stdbool.h>

#include "base/memory.h"
#include "planar/region.h"
#include "planar/scratch.h"
#include "wall/gap.h"
#include "wall/reach.h"

/* Sides of narrow places are looked at in pieces no longer than this, units; beads shorter than so
 * many of their widths are not worth the travel. */
enum { THIN_STEP = 1500 };
#define THIN_SHORTEST 1.0

static iso_status inset(iso_region *out, const iso_region *in, int32_t distance,
                        int32_t arc_tolerance, iso_planar_scratch *scratch) {
    iso_offset_options offset = iso_offset_defaults(-distance);
    offset.join =
        ISO_JOIN_ROUND; /* around a corner the bead's edge touches it, not a mitre's tip */
    offset.arc_tolerance = arc_tolerance;
    return iso_offset(out, in, &offset, scratch);
}

static bool is_shorter(const iso_point *point, int32_t count, int32_t limit) {
    double length = 0;
    for (int32_t i = 0; i < count && length <= limit; i++) {
        iso_point a = point[i], b = point[i + 1 == count ? 0 : i + 1];
        double dx = (double)b.x - a.x, dy = (double)b.y - a.y;
        length += sqrt(dx * dx + dy * dy);
    }
    return length <= limit;
}

static iso_status add_loops(iso_paths *paths, const iso_region *loops, int32_t wall,
                            const iso_wall_options *options) {
    const iso_bead *bead = wall == 0 ? &options->external : &options->inner;
    iso_path like = options->like;
    like.closed = 1;
    like.role = wall == 0 ? ISO_ROLE_EXTERNAL_PERIMETER : ISO_ROLE_PERIMETER;
    like.rank = options->external_first ? wall : options->count - 1 - wall;
    for (int32_t c = 0; c < loops->count; c++) {
        const iso_point *point = loops->point + loops->first[c];
        int32_t count = loops->first[c + 1] - loops->first[c];
        if (is_shorter(point, count, bead->width))
            continue; /* a dot */
        like.speed_class = is_shorter(point, count, options->small_length);
        ISO_TRY(iso_paths_add(paths, &like, point, count, bead->width, bead->area));
    }
    return ISO_OK;
}

/* From the middle of wall - 1, or the outline, to the middle of `wall`. */
static int32_t wall_distance(int32_t wall, const iso_wall_options *options) {
    if (wall == 0)
        return options->external.width / 2;
    int32_t before = wall == 1 ? options->external.spacing : options->inner.spacing;
    return (before + options->inner.spacing) / 2;
}

enum { SEAM = 80 }; /* units by which parted loops end before the place that one bead fills */

typedef struct iso_walling {
    iso_paths *paths;
    const iso_wall_options *options;
    iso_planar_scratch *scratch;
    iso_region turn[2]; /* take turns as the walls' middles */
    iso_region left;
    bool drawn, ahead; /* the second wall is drawn already; nothing is narrow there */
} iso_walling;

/* Shrink `from` by `distance`, and look whether it is wide everywhere: surely so if the operation
 * was free of collisions and every contour stayed. */
static iso_status shrink(iso_walling *w, iso_region *to, const iso_region *from, int32_t distance,
                         bool *wide) {
    int64_t untouched = iso_planar_get_counts(w->scratch).untouched;
    bool missed = false;
    ISO_TRY(inset(to, from, distance, w->options->arc_tolerance, w->scratch));
    if (iso_planar_get_counts(w->scratch).untouched == untouched || from->count != to->count)
        ISO_TRY(reach_misses(&missed, from, to, distance, 0, &w->scratch->arena));
    *wide = !missed;
    return ISO_OK;
}

static iso_status fill_gaps(iso_walling *w, const iso_region *at, const iso_region *next,
                            int32_t wall) {
    const iso_wall_options *options = w->options;
    const iso_bead *before = wall == 1 ? &options->external : &options->inner;
    iso_gap_options gap = iso_gap_defaults(&options->inner, options->gap_least);
    gap.like = options->like;
    gap.like.role = ISO_ROLE_GAP_FILL;
    gap.like.rank = options->count;
    return iso_gap_fill_left(w->paths, at, next,
                             &(iso_gap_reach){wall_distance(wall, options), before->spacing / 2},
                             &gap, w->scratch);
}

/* Take from the outermost loops those stretches whose two sides come closer than 0.6 spacings to
 * each other: one wider bead will do there. */
static iso_status part_loops(iso_walling *w, iso_region *loops, int32_t close, bool *parted) {
    iso_region kept = {0}, narrow = {0};
    iso_offset_options grow = iso_offset_defaults(SEAM);
    iso_status status = inset(&kept, loops, close, 50, w->scratch);
    bool missed = false;
    iso_region_clear(&w->left);
    if (status == ISO_OK)
        status = reach_misses(&missed, loops, &kept, close, 0, &w->scratch->arena);
    if (status == ISO_OK && missed)
        status = iso_gap_left(&w->left, loops, &kept, close, w->scratch);
    if (status == ISO_OK)
        gap_drop_small(&w->left, 2 * close);
    *parted = status == ISO_OK && w->left.count > 0;
    if (*parted) {
        status = iso_region_clean(&narrow, &w->left, ISO_FILL_POSITIVE, w->scratch);
        if (status == ISO_OK)
            status = iso_offset(&w->left, &narrow, &grow, w->scratch);
        if (status == ISO_OK)
            status = iso_boolean(&kept, ISO_DIFFERENCE, loops, &w->left, w->scratch);
        if (status == ISO_OK) {
            iso_region swap = *loops;
            *loops = kept;
            kept = swap;
        }
    }
    iso_region_free(&kept);
    iso_region_free(&narrow);
    return status;
}

static iso_status draw_thin(iso_walling *w, const iso_region *island, iso_region *loops) {
    const iso_wall_options *options = w->options;
    const iso_bead *bead = &options->external;
    int32_t close = bead->spacing * 3 / 10;
    int32_t least = options->thin_least > bead->height ? options->thin_least : bead->height;
    iso_gap_options thin = {.height = bead->height,
                            .least = least,
                            .most = bead->width + 2 * close,
                            .outline = 1,
                            .step = THIN_STEP,
                            .shortest = THIN_SHORTEST,
                            .like = options->like};
    thin.like.role = ISO_ROLE_EXTERNAL_PERIMETER;
    thin.like.rank = options->external_first ? 0 : options->count - 1;
    ISO_TRY(iso_gap_left(&w->left, island, loops, bead->width / 2, w->scratch));
    gap_drop_small(&w->left, least);
    return iso_gap_fill(w->paths, &w->left, &thin, w->scratch);
}

/* Whether the outline is too narrow somewhere shows when loops are shrunk: the outermost, or the
 * next, which keep further apart than the thinnest pair of loops. */
static iso_status draw_outermost(iso_walling *w, const iso_region *island) {
    const iso_wall_options *options = w->options;
    iso_region *loops = &w->turn[0], *next = &w->turn[1];
    bool wide, parted = false;
    ISO_TRY(shrink(w, loops, island, wall_distance(0, options), &wide));
    if (options->thin_least <= 0)
        return ISO_OK;
    if (wide && options->count > 1) {
        ISO_TRY(shrink(w, next, loops, wall_distance(1, options), &w->ahead));
        w->drawn = true;
        if (w->ahead)
            return ISO_OK;
    }
    ISO_TRY(part_loops(w, loops, options->external.spacing * 3 / 10, &parted));
    w->drawn = w->drawn && !parted;
    if (!parted && wide)
        return ISO_OK;
    return draw_thin(w, island, loops);
}

static iso_status draw_inner(iso_walling *w, const iso_region *at, iso_region *next, int32_t wall) {
    const iso_wall_options *options = w->options;
    bool wide = w->ahead;
    if (wall > 1 || !w->drawn)
        ISO_TRY(shrink(w, next, at, wall_distance(wall, options), &wide));
    if (options->gap_least > 0 && !wide)
        ISO_TRY(fill_gaps(w, at, next, wall));
    return ISO_OK;
}

static iso_status draw_walls(iso_walling *w, iso_region *inside, const iso_region *island) {
    const iso_wall_options *options = w->options;
    const iso_region *at = island;
    int32_t reached = 0; /* from the middle of the last wall to its inner edge */
    for (int32_t wall = 0; wall < options->count && at->count > 0; wall++) {
        iso_region *next = &w->turn[wall & 1];
        ISO_TRY(wall == 0 ? draw_outermost(w, island) : draw_inner(w, at, next, wall));
        ISO_TRY(add_loops(w->paths, next, wall, options));
        reached = (wall == 0 ? options->external.spacing : options->inner.spacing) / 2;
        at = next;
    }
    /* no path runs along `inside`: the usual arcs will do */
    int32_t usual = iso_offset_defaults(0).arc_tolerance;
    int32_t tolerance = options->arc_tolerance > usual ? options->arc_tolerance : usual;
    return inset(inside, at, reached + options->fill_inset, tolerance, w->scratch);
}

iso_status iso_walls(iso_paths *paths, iso_region *inside, const iso_region *island,
                     const iso_wall_options *options, iso_planar_scratch *scratch) {
    iso_walling w = {.paths = paths, .options = options, .scratch = scratch};
    int32_t count = paths->count, vertices = paths->vertex_count;
    iso_status status = draw_walls(&w, inside, island);
    if (status != ISO_OK) {
        paths->count = count;
        paths->vertex_count = vertices;
        iso_region_clear(inside);
    }
    iso_region_free(&w.turn[0]);
    iso_region_free(&w.turn[1]);
    iso_region_free(&w.left);
    return status;
}

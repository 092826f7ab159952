#include <isoslice/wall.h>

#include <math.h>
#include <stdbool.h>

#include "base/memory.h"

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

/* `at` and `next` are two regions that take turns. */
static iso_status draw_walls(iso_paths *paths, iso_region *inside, iso_region *turn,
                             const iso_region *island, const iso_wall_options *options,
                             iso_planar_scratch *scratch) {
    const iso_region *at = island;
    int32_t reached = 0; /* from the middle of the last wall to its inner edge */
    for (int32_t wall = 0; wall < options->count && at->count > 0; wall++) {
        iso_region *next = &turn[wall & 1];
        ISO_TRY(inset(next, at, wall_distance(wall, options), options->arc_tolerance, scratch));
        ISO_TRY(add_loops(paths, next, wall, options));
        reached = (wall == 0 ? options->external.spacing : options->inner.spacing) / 2;
        at = next;
    }
    /* no path runs along `inside`: the usual arcs will do */
    int32_t usual = iso_offset_defaults(0).arc_tolerance;
    int32_t tolerance = options->arc_tolerance > usual ? options->arc_tolerance : usual;
    return inset(inside, at, reached + options->fill_inset, tolerance, scratch);
}

iso_status iso_walls(iso_paths *paths, iso_region *inside, const iso_region *island,
                     const iso_wall_options *options, iso_planar_scratch *scratch) {
    iso_region turn[2] = {0};
    int32_t count = paths->count, vertices = paths->vertex_count;
    iso_status status = draw_walls(paths, inside, turn, island, options, scratch);
    if (status != ISO_OK) {
        paths->count = count;
        paths->vertex_count = vertices;
        iso_region_clear(inside);
    }
    iso_region_free(&turn[0]);
    iso_region_free(&turn[1]);
    return status;
}

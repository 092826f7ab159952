#include <isoslice/skirt.h>

#include <math.h>

#include "base/memory.h"
#include "planar/hull.h"

static iso_status gather_hull(iso_region *out, const iso_region *region) {
    int32_t count = region->first[region->count];
    iso_point *point;
    ISO_TRY(ISO_ALLOCATE(point, 2 * (int64_t)count + 1));
    memcpy(point, region->point, (size_t)count * sizeof *point);
    int32_t n = hull_of(point + count, point, count);
    iso_status status = iso_region_add(out, point + count, n);
    iso_release(point);
    return status;
}

static double length_of(const iso_region *loop) {
    double sum = 0;
    for (int32_t c = 0; c < loop->count; c++)
        for (int32_t i = loop->first[c], last = loop->first[c + 1] - 1, j = last; i <= last;
             j = i++) {
            double dx = (double)loop->point[i].x - loop->point[j].x;
            double dy = (double)loop->point[i].y - loop->point[j].y;
            sum += sqrt(dx * dx + dy * dy);
        }
    return sum;
}

enum { LOOPS_MAX = 1000 };

/* From the innermost out; their number is known only then, and with it the ranks. */
static iso_status draw_skirt(iso_paths *paths, const iso_region *hull, iso_region *loop,
                             const iso_skirt_options *options, iso_planar_scratch *scratch) {
    iso_path like = {.role = ISO_ROLE_SKIRT, .closed = 1, .object = -1, .group = -1};
    int32_t before = paths->count;
    double length = 0;
    for (int32_t i = 0; i < options->loops || (length < options->min_length && i < LOOPS_MAX);
         i++) {
        iso_offset_options grown =
            iso_offset_defaults(options->distance + i * options->bead.spacing);
        grown.join = ISO_JOIN_ROUND;
        ISO_TRY(iso_offset(loop, hull, &grown, scratch));
        length += length_of(loop);
        for (int32_t c = 0; c < loop->count; c++)
            ISO_TRY(iso_paths_add(paths, &like, loop->point + loop->first[c],
                                  loop->first[c + 1] - loop->first[c], options->bead.width,
                                  options->bead.area));
    }
    for (int32_t i = before; i < paths->count; i++)
        paths->path[i].rank = paths->count - 1 - i;
    return ISO_OK;
}

iso_status iso_skirt(iso_paths *paths, const iso_region *region, const iso_skirt_options *options,
                     iso_planar_scratch *scratch) {
    if ((options->loops <= 0 && options->min_length <= 0) || region->count == 0)
        return ISO_OK;
    iso_region hull = {0}, loop = {0};
    int32_t count = paths->count, vertices = paths->vertex_count;
    iso_status status = gather_hull(&hull, region);
    if (status == ISO_OK)
        status = draw_skirt(paths, &hull, &loop, options, scratch);
    if (status != ISO_OK) {
        paths->count = count;
        paths->vertex_count = vertices;
    }
    iso_region_free(&hull);
    iso_region_free(&loop);
    return status;
}

#include "wall/fuzzy.h"

#include <math.h>

#include "base/memory.h"
#include "base/random.h"

static double length_of(const iso_path_vertex *vertex, int32_t count) {
    double sum = 0;
    for (int32_t i = 0, j = count - 1; i < count; j = i++) {
        double dx = (double)vertex[i].at.x - vertex[j].at.x;
        double dy = (double)vertex[i].at.y - vertex[j].at.y;
        sum += sqrt(dx * dx + dy * dy);
    }
    return sum;
}

static double double_area(const iso_path_vertex *vertex, int32_t count) {
    double sum = 0;
    for (int32_t i = 0, j = count - 1; i < count; j = i++)
        sum += (double)vertex[j].at.x * vertex[i].at.y - (double)vertex[i].at.x * vertex[j].at.y;
    return sum;
}

/* Points at random distances along the loop, each moved across it. Returns how many, at most
 * `room`. */
static int32_t draw(iso_point *point, int32_t room, const iso_path_vertex *vertex, int32_t count,
                    const iso_fuzzy_options *options, uint64_t *random) {
    int32_t n = 0;
    double rest = random_unit(random) * options->distance / 2;
    for (int32_t i = 0; i < count; i++) {
        iso_point a = vertex[i].at, b = vertex[i + 1 < count ? i + 1 : 0].at;
        double dx = (double)b.x - a.x, dy = (double)b.y - a.y, length = sqrt(dx * dx + dy * dy);
        for (; rest < length && n < room; n++) {
            double by = (2 * random_unit(random) - 1) * options->thickness;
            point[n] = (iso_point){(int32_t)floor(a.x + (rest * dx - by * dy) / length + 0.5),
                                   (int32_t)floor(a.y + (rest * dy + by * dx) / length + 0.5)};
            rest += (0.75 + 0.5 * random_unit(random)) * options->distance;
        }
        rest -= length;
    }
    return n;
}

static bool is_skin(const iso_path *path, const iso_path_vertex *vertex,
                    const iso_fuzzy_options *options) {
    if (path->role != ISO_ROLE_EXTERNAL_PERIMETER || !path->closed || path->count < 3)
        return false;
    return options->holes || double_area(vertex, path->count) > 0;
}

static iso_status redraw(iso_paths *out, const iso_path *path, const iso_path_vertex *vertex,
                         const iso_fuzzy_options *options, uint64_t *random) {
    double points = length_of(vertex, path->count) / (0.75 * options->distance) + 2;
    if (points > INT32_MAX / 4)
        return iso_fail(ISO_OUTSIDE, "fuzzy_skin_point_dist is too small for so long a wall");
    iso_point *point;
    ISO_TRY(ISO_ALLOCATE(point, (int64_t)points));
    int32_t count = draw(point, (int32_t)points, vertex, path->count, options, random);
    iso_status status = ISO_OK;
    if (count >= 3)
        status = iso_paths_add(out, path, point, count, vertex->width, vertex->area);
    iso_release(point);
    return status;
}

static iso_status copy(iso_paths *out, const iso_path *path, const iso_path_vertex *vertex) {
    ISO_TRY(ISO_GROW(out->path, out->path_capacity, (int64_t)out->count + 1));
    ISO_TRY(ISO_GROW(out->vertex, out->vertex_capacity, (int64_t)out->vertex_count + path->count));
    out->path[out->count] = *path;
    out->path[out->count++].first = out->vertex_count;
    memcpy(out->vertex + out->vertex_count, vertex, (size_t)path->count * sizeof *vertex);
    out->vertex_count += path->count;
    return ISO_OK;
}

iso_status fuzzy_skin(iso_paths *paths, iso_paths *spare, int32_t begin,
                      const iso_fuzzy_options *options, uint64_t seed) {
    uint64_t random = seed;
    iso_paths_clear(spare);
    for (int32_t i = 0; i < paths->count; i++) {
        const iso_path *path = &paths->path[i];
        const iso_path_vertex *vertex = paths->vertex + path->first;
        if (i >= begin && is_skin(path, vertex, options))
            ISO_TRY(redraw(spare, path, vertex, options, &random));
        else
            ISO_TRY(copy(spare, path, vertex));
    }
    iso_paths swap = *paths;
    *paths = *spare;
    *spare = swap;
    return ISO_OK;
}

#include "path/spiral.h"

#include <math.h>

#include "base/memory.h"

static double distance(iso_point a, iso_point b) {
    double dx = (double)b.x - a.x, dy = (double)b.y - a.y;
    return sqrt(dx * dx + dy * dy);
}

static double length_of(const iso_path_vertex *vertex, int32_t count) {
    double sum = 0;
    for (int32_t i = 0; i + 1 < count; i++)
        sum += distance(vertex[i].at, vertex[i + 1].at);
    return sum;
}

static bool is_loop(const iso_paths *paths) {
    return paths->count == 1 && paths->path[0].closed && paths->path[0].count > 2 &&
           paths->path[0].role == ISO_ROLE_EXTERNAL_PERIMETER;
}

iso_status path_spiral(bool *done, iso_paths *paths, const iso_point *from, int32_t height,
                       bool starts) {
    *done = is_loop(paths);
    if (!*done)
        return ISO_OK;
    iso_path *path = &paths->path[0];
    int32_t count = path->count + 1;
    ISO_TRY(ISO_GROW(paths->vertex, paths->vertex_capacity, (int64_t)path->first + count));
    iso_path_vertex *vertex = paths->vertex + path->first;
    vertex[count - 1] = vertex[0];
    if (from)
        vertex[0].at = *from;
    path->closed = 0;
    path->count = count;
    path->travel_count = 0;
    paths->vertex_count = path->first + count;
    double whole = length_of(vertex, count), reached = 0;
    for (int32_t i = 0; i < count; i++) {
        double next = i + 1 < count ? reached + distance(vertex[i].at, vertex[i + 1].at) : whole;
        vertex[i].z = (int32_t)floor(height * (reached / whole - 1) + 0.5);
        if (starts) /* as high as the middle of this piece is above what is flat */
            vertex[i].area = (int32_t)(vertex[i].area * (reached + next) / (2 * whole) + 0.5);
        reached = next;
    }
    vertex[count - 1].z = 0;
    return ISO_OK;
}

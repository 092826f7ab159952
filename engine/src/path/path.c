#include <isoslice/path.h>

#include "base/memory.h"

static const double pi = 3.14159265358979323846;

const char *iso_role_name(iso_role role) {
    static const char *const name[ISO_ROLE_COUNT] = {
        [ISO_ROLE_EXTERNAL_PERIMETER] = "External perimeter",
        [ISO_ROLE_PERIMETER] = "Perimeter",
        [ISO_ROLE_OVERHANG_PERIMETER] = "Overhang perimeter",
        [ISO_ROLE_INTERNAL_INFILL] = "Internal infill",
        [ISO_ROLE_SOLID_INFILL] = "Solid infill",
        [ISO_ROLE_TOP_SOLID_INFILL] = "Top solid infill",
        [ISO_ROLE_IRONING] = "Ironing",
        [ISO_ROLE_BRIDGE_INFILL] = "Bridge infill",
        [ISO_ROLE_GAP_FILL] = "Gap fill",
        [ISO_ROLE_SKIRT] = "Skirt/Brim",
        [ISO_ROLE_SUPPORT] = "Support material",
        [ISO_ROLE_SUPPORT_INTERFACE] = "Support material interface",
        [ISO_ROLE_CUSTOM] = "Custom",
    };
    return (unsigned)role < ISO_ROLE_COUNT ? name[role] : name[ISO_ROLE_CUSTOM];
}

void iso_paths_free(iso_paths *paths) {
    iso_release(paths->path);
    iso_release(paths->vertex);
    iso_release(paths->travel);
    *paths = (iso_paths){0};
}

void iso_paths_clear(iso_paths *paths) {
    paths->count = paths->vertex_count = paths->travel_count = 0;
}

static iso_status too_many(void) {
    return iso_fail(ISO_OUTSIDE, "a layer with more than 2^31 path vertices is too much");
}

iso_status iso_paths_add(iso_paths *paths, const iso_path *like, const iso_point *point,
                         int32_t count, int32_t width, int32_t area) {
    int64_t vertices = (int64_t)paths->vertex_count + count;
    if (count < 0 || vertices > INT32_MAX || paths->count == INT32_MAX)
        return too_many();
    ISO_TRY(ISO_GROW(paths->path, paths->path_capacity, (int64_t)paths->count + 1));
    ISO_TRY(ISO_GROW(paths->vertex, paths->vertex_capacity, vertices));
    iso_path *path = &paths->path[paths->count++];
    *path = *like;
    path->first = paths->vertex_count;
    path->count = count;
    iso_path_vertex *vertex = paths->vertex + path->first;
    for (int32_t i = 0; i < count; i++)
        vertex[i] =
            (iso_path_vertex){.at = point[i], .width = width, .area = area, .role = like->role};
    paths->vertex_count = (int32_t)vertices;
    return ISO_OK;
}

static iso_point moved(iso_point p, iso_point by) {
    return (iso_point){p.x + by.x, p.y + by.y};
}

iso_status iso_paths_append(iso_paths *paths, const iso_paths *more, iso_point by, int32_t object) {
    int64_t count = (int64_t)paths->count + more->count;
    int64_t vertices = (int64_t)paths->vertex_count + more->vertex_count;
    int64_t travels = (int64_t)paths->travel_count + more->travel_count;
    if (vertices > INT32_MAX || count > INT32_MAX || travels > INT32_MAX)
        return too_many();
    ISO_TRY(ISO_GROW(paths->travel, paths->travel_capacity, travels));
    ISO_TRY(ISO_GROW(paths->path, paths->path_capacity, count));
    ISO_TRY(ISO_GROW(paths->vertex, paths->vertex_capacity, vertices));
    for (int32_t i = 0; i < more->count; i++) {
        iso_path *path = &paths->path[paths->count + i];
        *path = more->path[i];
        path->first += paths->vertex_count;
        path->travel_first += paths->travel_count;
        path->object = object;
    }
    for (int32_t i = 0; i < more->vertex_count; i++) {
        iso_path_vertex *vertex = &paths->vertex[paths->vertex_count + i];
        *vertex = more->vertex[i];
        vertex->at = moved(vertex->at, by);
    }
    for (int32_t i = 0; i < more->travel_count; i++)
        paths->travel[paths->travel_count + i] = moved(more->travel[i], by);
    paths->count = (int32_t)count;
    paths->vertex_count = (int32_t)vertices;
    paths->travel_count = (int32_t)travels;
    return ISO_OK;
}

static int32_t to_nearest(double x) {
    return (int32_t)(x < 0 ? x - 0.5 : x + 0.5);
}

iso_bead iso_bead_of(int32_t width, int32_t height) {
    double h = height;
    double area = (double)(width - height) * h + pi / 4 * h * h;
    return (iso_bead){.width = width,
                      .height = height,
                      .area = to_nearest(area),
                      .spacing = height == 0 ? width : to_nearest(area / h)};
}

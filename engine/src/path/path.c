#include <isoslice/path.h>

#include <math.h>
#include <stdbool.h>

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
    iso_release(paths->frame);
    iso_release(paths->travel_frame);
    *paths = (iso_paths){0};
}

/* Frames go, since having them is what makes a layer a curved one. */
void iso_paths_clear(iso_paths *paths) {
    iso_release(paths->frame);
    iso_release(paths->travel_frame);
    paths->frame = paths->travel_frame = NULL;
    paths->frame_capacity = paths->travel_frame_capacity = 0;
    paths->count = paths->vertex_count = paths->travel_count = 0;
}

static iso_status too_many(void) {
    return iso_fail(ISO_OUTSIDE, "a layer with more than 2^31 path vertices is too much");
}

static void lie_flat(iso_frame *frame, int64_t from, int64_t to) {
    for (int64_t i = from; i < to; i++)
        frame[i] = (iso_frame){.normal = {0, 0, 1}};
}

/* Frames for so many vertices and points of travels in all: those that are there become curved if
 * they weren't. On failure the paths are as they were, but for room. */
static iso_status make_frames(iso_paths *paths, int64_t vertices, int64_t travels) {
    bool flat = !paths->frame;
    iso_status status = ISO_GROW(paths->frame, paths->frame_capacity, vertices + 1);
    if (status == ISO_OK)
        status = ISO_GROW(paths->travel_frame, paths->travel_frame_capacity, travels + 1);
    if (status != ISO_OK && flat) {
        iso_release(paths->frame);
        paths->frame = NULL;
        paths->frame_capacity = 0;
    }
    if (status == ISO_OK && flat) {
        lie_flat(paths->frame, 0, paths->vertex_count);
        lie_flat(paths->travel_frame, 0, paths->travel_count);
    }
    return status;
}

iso_status iso_paths_add(iso_paths *paths, const iso_path *like, const iso_point *point,
                         int32_t count, int32_t width, int32_t area) {
    int64_t vertices = (int64_t)paths->vertex_count + count;
    if (count < 0 || vertices > INT32_MAX || paths->count == INT32_MAX)
        return too_many();
    ISO_TRY(ISO_GROW(paths->path, paths->path_capacity, (int64_t)paths->count + 1));
    ISO_TRY(ISO_GROW(paths->vertex, paths->vertex_capacity, vertices));
    if (paths->frame) {
        ISO_TRY(make_frames(paths, vertices, paths->travel_count));
        lie_flat(paths->frame, paths->vertex_count, vertices);
    }
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

/* Those of the paths that are about to be appended. */
static void append_frames(iso_paths *paths, const iso_paths *more) {
    int32_t vertices = paths->vertex_count, travels = paths->travel_count;
    if (!more->frame) {
        lie_flat(paths->frame, vertices, (int64_t)vertices + more->vertex_count);
        lie_flat(paths->travel_frame, travels, (int64_t)travels + more->travel_count);
        return;
    }
    memcpy(paths->frame + vertices, more->frame, (size_t)more->vertex_count * sizeof *more->frame);
    if (more->travel_count > 0)
        memcpy(paths->travel_frame + travels, more->travel_frame,
               (size_t)more->travel_count * sizeof *more->travel_frame);
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
    if (paths->frame || more->frame) {
        ISO_TRY(make_frames(paths, vertices, travels));
        append_frames(paths, more);
    }
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

double iso_bead_height(double width, double area) {
    const double corners = 1 - pi / 4;
    double rest = width * width - 4 * corners * area;
    return rest < 0 ? width : (width - sqrt(rest)) / (2 * corners);
}

/* How a layer's paths are copied out: rotated, reversed, with a vertex more at the seam. */
#include "path/edges.h"
#include "path/ordering.h"

static void copy_rotated(iso_path_vertex *to, const iso_path_vertex *from, int32_t count,
                         int32_t start) {
    memcpy(to, from + start, (size_t)(count - start) * sizeof *to);
    memcpy(to + count - start, from, (size_t)start * sizeof *to);
}

/* The bead of vertex i ran from i to i + 1; backwards it runs from i + 1 to i. The end of the path
 * keeps its own, which is never drawn: so reversing twice changes nothing. */
static void copy_reversed(iso_path_vertex *to, const iso_path_vertex *from, int32_t count) {
    for (int32_t i = 0; i < count; i++) {
        to[i] = from[i + 1 < count ? count - 2 - i : count - 1];
        to[i].at = from[count - 1 - i].at;
        to[i].z = from[count - 1 - i].z;
    }
}

static iso_path_vertex *begin_copy(iso_ordering *o, int32_t k) {
    iso_path *copy = &o->out->path[o->out->count++];
    *copy = *ordering_path(o, k);
    copy->first = o->out->vertex_count;
    return o->out->vertex + copy->first;
}

static void end_copy(iso_ordering *o) {
    const iso_path *copy = &o->out->path[o->out->count - 1];
    o->out->vertex_count += copy->count;
    o->position = o->out->vertex[copy->first + (copy->closed ? 0 : copy->count - 1)].at;
}

void ordering_emit(iso_ordering *o, int32_t k, int32_t start) {
    const iso_path *path = ordering_path(o, k);
    const iso_path_vertex *from = ordering_vertex(o, k);
    iso_path_vertex *to = begin_copy(o, k);
    if (path->closed)
        copy_rotated(to, from, path->count, start);
    else if (start > 0)
        copy_reversed(to, from, path->count);
    else
        memcpy(to, from, (size_t)path->count * sizeof *to);
    end_copy(o);
}

/* A seam nearer to a vertex than this begins there: 10 um. */
enum { AT_VERTEX = 100 };

void ordering_emit_from(iso_ordering *o, int32_t k, iso_seam_place seam) {
    const int64_t near = (int64_t)AT_VERTEX * AT_VERTEX;
    const iso_path_vertex *from = ordering_vertex(o, k);
    int32_t count = ordering_path(o, k)->count, i = seam.vertex;
    int32_t next = i + 1 < count ? i + 1 : 0;
    if (iso_distance_squared(from[i].at, seam.at) <= near) {
        ordering_emit(o, k, i);
        return;
    }
    if (iso_distance_squared(from[next].at, seam.at) <= near) {
        ordering_emit(o, k, next);
        return;
    }
    iso_path_vertex *to = begin_copy(o, k);
    to[0] = from[i];
    to[0].at = seam.at;
    copy_rotated(to + 1, from, count, next);
    o->out->path[o->out->count - 1].count++;
    end_copy(o);
}

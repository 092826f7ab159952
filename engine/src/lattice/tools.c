#include "lattice/tools.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "lattice/grading.h"

enum {
    PER_WIDTH = 2, /* samples in a bead's width: what is shorter would not be kept */
    HALVINGS = 20  /* from a sample's distance to less than a unit */
};

/* A place on a path: so far from vertex `segment` to the next one, 0 to 1. */
typedef struct place {
    int32_t segment;
    double t;
} place;

/* What is of one tool, up to the next piece, or the path's end. */
typedef struct piece {
    place from;
    double length; /* units */
    uint8_t tool;
} piece;

typedef struct work {
    iso_paths *paths;
    const iso_lattice_slice *slice;
    int32_t path, first, count, segments; /* of the path: number, vertices */
    piece *piece;                         /* [piece_count] */
    int32_t piece_count;
    int32_t chain; /* the tool that the path before ended with; -1: none */
} work;

static const iso_path_vertex *vertex_of(const work *w, int32_t i) {
    return &w->paths->vertex[w->first + (i < w->count ? i : i % w->count)];
}

static double length_of(const work *w, int32_t segment) {
    const iso_path_vertex *a = vertex_of(w, segment), *b = vertex_of(w, segment + 1);
    double x = (double)b->at.x - a->at.x, y = (double)b->at.y - a->at.y;
    return sqrt(x * x + y * y);
}

static iso_vec3 place_in_mesh(const work *w, int32_t segment, double t) {
    const iso_lattice_slice *slice = w->slice;
    const iso_path_vertex *a = vertex_of(w, segment), *b = vertex_of(w, segment + 1);
    double x = a->at.x + t * ((double)b->at.x - a->at.x) - slice->shift.x;
    double y = a->at.y + t * ((double)b->at.y - a->at.y) - slice->shift.y;
    return (iso_vec3){x / ISO_UNITS_PER_MM, y / ISO_UNITS_PER_MM, slice->z};
}

static uint8_t tool_at(const work *w, int32_t segment, double t) {
    uint8_t tool;
    iso_vec3 at = place_in_mesh(w, segment, t);
    lattice_tools(&tool, w->slice->lattice, &at, 1);
    return tool;
}

/* ---- where the material changes ---- */

/* Between two places of different tools. */
static double find_border(const work *w, int32_t segment, double low, double high, uint8_t tool) {
    for (int i = 0; i < HALVINGS; i++) {
        double middle = (low + high) / 2;
        *(tool_at(w, segment, middle) == tool ? &low : &high) = middle;
    }
    return high;
}

/* Samples of a segment, its end but not its beginning among them. */
static int32_t samples_of(const work *w, int32_t segment, double length) {
    double n = ceil(length * PER_WIDTH / fmax(1, vertex_of(w, segment)->width));
    return n > 1 ? n < 1 << 20 ? (int32_t)n : 1 << 20 : 1;
}

static int64_t count_samples(const work *w) {
    int64_t sum = 1;
    for (int32_t s = 0; s < w->segments; s++)
        sum += samples_of(w, s, length_of(w, s));
    return sum;
}

static void begin_piece(work *w, int32_t segment, double t, uint8_t tool) {
    w->piece[w->piece_count++] = (piece){{segment, t}, 0, tool};
}

/* Pieces as they are, however short. */
static void find_pieces(work *w) {
    uint8_t tool = tool_at(w, 0, 0), sampled[GRADING_BLOCK];
    iso_vec3 at[GRADING_BLOCK];
    w->piece_count = 0;
    begin_piece(w, 0, 0, tool);
    for (int32_t s = 0; s < w->segments; s++) {
        double length = length_of(w, s), begun = 0;
        int32_t count = samples_of(w, s, length);
        for (int32_t done = 0, n; done < count; done += n) {
            n = count - done < GRADING_BLOCK ? count - done : GRADING_BLOCK;
            for (int32_t i = 0; i < n; i++)
                at[i] = place_in_mesh(w, s, (done + i + 1.0) / count);
            lattice_tools(sampled, w->slice->lattice, at, n);
            for (int32_t i = 0; i < n; i++) {
                if (sampled[i] == tool)
                    continue;
                double t =
                    find_border(w, s, (double)(done + i) / count, (done + i + 1.0) / count, tool);
                w->piece[w->piece_count - 1].length += (t - begun) * length;
                begun = t;
                tool = sampled[i];
                begin_piece(w, s, t, tool);
            }
        }
        w->piece[w->piece_count - 1].length += (1 - begun) * length;
    }
}

/* The last piece of a closed path goes on where its first one begins. */
static void close_pieces(work *w) {
    piece *first = w->piece, *last = &w->piece[w->piece_count - 1];
    if (w->piece_count < 2 || first->tool != last->tool)
        return;
    first->from = last->from;
    first->length += last->length;
    w->piece_count--;
}

static void merge_short(work *w, double least) {
    piece *p = w->piece;
    int32_t n = 1;
    for (int32_t i = 1; i < w->piece_count; i++)
        if (p[i].length < least || p[i].tool == p[n - 1].tool)
            p[n - 1].length += p[i].length;
        else
            p[n++] = p[i];
    if (n > 1 && p[0].length < least) {
        p[1].from = p[0].from;
        p[1].length += p[0].length;
        memmove(p, p + 1, (size_t)--n * sizeof *p);
    }
    w->piece_count = n;
}

/* ---- cutting ---- */

static iso_path_vertex vertex_at(const work *w, place at) {
    iso_path_vertex v = *vertex_of(w, at.segment);
    if (at.t > 0) {
        const iso_path_vertex *to = vertex_of(w, at.segment + 1);
        v.at.x += (int32_t)floor(at.t * ((double)to->at.x - v.at.x) + 0.5);
        v.at.y += (int32_t)floor(at.t * ((double)to->at.y - v.at.y) + 0.5);
        v.z += (int32_t)floor(at.t * ((double)to->z - v.z) + 0.5);
    }
    return v;
}

/* One where another is already takes its place: what is drawn is from there on. */
static void put_vertex(iso_paths *paths, iso_path *to, iso_path_vertex v, bool last) {
    iso_path_vertex *end = paths->vertex + to->first + to->count - 1;
    if (to->count > 0 && end->at.x == v.at.x && end->at.y == v.at.y && end->z == v.z) {
        if (!last)
            *end = v;
        return;
    }
    end[1] = v;
    to->count++;
    paths->vertex_count++;
}

/* From `from` to `to`; the room is there. */
static void put_piece(work *w, place from, place to, uint8_t tool) {
    iso_paths *paths = w->paths;
    iso_path *path = &paths->path[paths->count++];
    *path = paths->path[w->path];
    path->first = paths->vertex_count;
    path->count = 0;
    path->closed = 0;
    path->tool = tool;
    path->follows = path->follows && w->chain == tool;
    w->chain = tool;
    put_vertex(paths, path, vertex_at(w, from), false);
    for (int32_t i = from.segment + 1; i <= to.segment; i++)
        put_vertex(paths, path, *vertex_of(w, i), i == to.segment && to.t == 0);
    put_vertex(paths, path, vertex_at(w, to), true);
}

static void put_whole(work *w, uint8_t tool) {
    iso_paths *paths = w->paths;
    iso_path *path = &paths->path[paths->count++];
    *path = paths->path[w->path];
    path->first = paths->vertex_count;
    path->tool = tool;
    path->follows = path->follows && w->chain == tool;
    w->chain = tool;
    memcpy(paths->vertex + path->first, paths->vertex + w->first,
           (size_t)w->count * sizeof *paths->vertex);
    paths->vertex_count += w->count;
}

/* Only the first piece can follow what the path did. */
static void put_pieces(work *w, bool closed) {
    for (int32_t i = 0; i < w->piece_count; i++) {
        bool ends = i + 1 == w->piece_count;
        place from = w->piece[i].from, to = {w->segments, 0};
        if (!ends || closed)
            to = w->piece[ends ? 0 : i + 1].from;
        if (closed && (to.segment < from.segment || (to.segment == from.segment && to.t < from.t)))
            to.segment += w->segments;
        if (i > 0)
            w->chain = -1;
        put_piece(w, from, to, w->piece[i].tool);
    }
}

static iso_status choose(work *w, iso_arena *scratch) {
    iso_paths *paths = w->paths;
    iso_path path = paths->path[w->path];
    w->first = path.first;
    w->count = path.count;
    w->segments = path.closed ? path.count : path.count - 1;
    if (path.count < 2)
        return ISO_OK;
    ISO_TRY(ISO_PUSH(w->piece, scratch, count_samples(w) + 1));
    find_pieces(w);
    if (path.closed)
        close_pieces(w);
    merge_short(w, vertex_of(w, 0)->width);
    if (path.closed)
        close_pieces(w);
    int64_t vertices = (int64_t)paths->vertex_count + path.count + 3 * (int64_t)w->piece_count;
    if (vertices > INT32_MAX || (int64_t)paths->count + w->piece_count > INT32_MAX)
        return iso_fail(ISO_OUTSIDE, "a layer with more than 2^31 path vertices is too much");
    ISO_TRY(ISO_GROW(paths->path, paths->path_capacity, (int64_t)paths->count + w->piece_count));
    ISO_TRY(ISO_GROW(paths->vertex, paths->vertex_capacity, vertices));
    if (w->piece_count > 1)
        put_pieces(w, path.closed);
    else
        put_whole(w, w->piece[0].tool);
    return ISO_OK;
}

/* The new ones where the old ones were. */
static void close_gap(iso_paths *paths, int32_t begin, int32_t end, int32_t vertex_begin,
                      int32_t vertex_end) {
    for (int32_t i = end; i < paths->count; i++)
        paths->path[i].first -= vertex_end - vertex_begin;
    memmove(paths->path + begin, paths->path + end,
            (size_t)(paths->count - end) * sizeof *paths->path);
    memmove(paths->vertex + vertex_begin, paths->vertex + vertex_end,
            (size_t)(paths->vertex_count - vertex_end) * sizeof *paths->vertex);
    paths->count -= end - begin;
    paths->vertex_count -= vertex_end - vertex_begin;
}

iso_status tools_choose(iso_paths *paths, int32_t begin, int32_t vertex_begin,
                        const iso_lattice_slice *slice, iso_arena *scratch) {
    int32_t end = paths->count, vertex_end = paths->vertex_count;
    work w = {.paths = paths, .slice = slice, .chain = -1};
    if (!lattice_material(slice->lattice))
        return ISO_OK;
    for (w.path = begin; w.path < end; w.path++) {
        iso_arena_mark mark = iso_arena_get_mark(scratch);
        iso_status status = choose(&w, scratch);
        iso_arena_pop(scratch, mark);
        ISO_TRY(status);
    }
    close_gap(paths, begin, end, vertex_begin, vertex_end);
    return ISO_OK;
}

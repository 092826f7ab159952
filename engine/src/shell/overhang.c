/* Walls over air: pieces whose middle lies further out than `reach` from the layer below are told
 * apart. */
#include <math.h>
#include <stdbool.h>

#include <isoslice/shell.h>

#include "planar/predicate.h"
#include "planar/scratch.h"
#include "shell/mask.h"
#include "shell/rows.h"

/* A place in a cell that, grown, is of the support lies within 1.6 cells of it. */
#define CELLS_OF_REACH 1.6

static bool is_wall(const iso_path *path) {
    return (path->role == ISO_ROLE_EXTERNAL_PERIMETER || path->role == ISO_ROLE_PERIMETER) &&
           path->count > 1;
}

static bool walls_box(iso_box *box, const iso_paths *paths) {
    bool any = false;
    for (int32_t i = 0; i < paths->count; i++) {
        const iso_path *path = &paths->path[i];
        for (int32_t v = 0; is_wall(path) && v < path->count; v++) {
            iso_point at = paths->vertex[path->first + v].at;
            if (!any)
                *box = (iso_box){at, at};
            any = true;
            box_add(box, at);
        }
    }
    return any;
}

static iso_point between(iso_point a, iso_point b, double t) {
    return (iso_point){(int32_t)floor(a.x + t * ((double)b.x - a.x) + 0.5),
                       (int32_t)floor(a.y + t * ((double)b.y - a.y) + 0.5)};
}

/* Places no further apart than a cell along x and y. What is between two of them is too short to
 * matter. */
static int32_t count_steps(iso_point a, iso_point b, int32_t cell) {
    double dx = fabs((double)b.x - a.x), dy = fabs((double)b.y - a.y);
    return (int32_t)((dx > dy ? dx : dy) / cell) + 1;
}

/* The end but its own; it begins the next edge. */
static bool edge_in_mask(const iso_mask *mask, iso_point a, iso_point b) {
    if (!mask_has(mask, a))
        return false;
    int32_t steps = count_steps(a, b, mask->cell);
    for (int32_t k = 1; k < steps; k++)
        if (!mask_has(mask, between(a, b, (double)k / steps)))
            return false;
    return true;
}

static bool path_in_mask(const iso_mask *mask, const iso_paths *paths, const iso_path *path) {
    const iso_path_vertex *v = paths->vertex + path->first;
    for (int32_t i = 0; i + !path->closed < path->count; i++)
        if (!edge_in_mask(mask, v[i].at, v[i + 1 < path->count ? i + 1 : 0].at))
            return false;
    return true;
}

/* ---- one path ---- */

/* A piece of a path, from `at` to the next one's. */
typedef struct iso_piece {
    iso_point at;
    int32_t vertex; /* that it starts at or behind */
    bool over;      /* air */
    double length;
} iso_piece;

typedef struct iso_overhanging {
    const iso_overhang_options *options;
    iso_mask mask;
    iso_rows rows;
    iso_piece *piece;
    int64_t count, capacity;
} iso_overhanging;

static double distance(iso_point a, iso_point b) {
    double dx = (double)b.x - a.x, dy = (double)b.y - a.y;
    return sqrt(dx * dx + dy * dy);
}

static bool is_over_air(const iso_overhanging *o, iso_point p) {
    return !rows_reach(&o->rows, p, o->options->reach);
}

static iso_status add_piece(iso_overhanging *o, iso_point from, iso_point to, int32_t vertex,
                            bool over) {
    if (point_equal(from, to))
        return ISO_OK;
    ISO_TRY(ISO_GROW(o->piece, o->capacity, o->count + 1));
    o->piece[o->count++] = (iso_piece){from, vertex, over, distance(from, to)};
    return ISO_OK;
}

/* Where between two shares of an edge the air begins or ends. */
static iso_point find_change(const iso_overhanging *o, const iso_point edge[2], double low,
                             double high, bool over) {
    enum { HALVINGS = 10 };
    for (int i = 0; i < HALVINGS; i++) {
        double middle = (low + high) / 2;
        *(is_over_air(o, between(edge[0], edge[1], middle)) == over ? &low : &high) = middle;
    }
    return between(edge[0], edge[1], low);
}

static iso_status cut_edge(iso_overhanging *o, const iso_point edge[2], int32_t vertex) {
    int32_t steps = count_steps(edge[0], edge[1], o->mask.cell);
    iso_point from = edge[0];
    bool over = is_over_air(o, from);
    for (int32_t k = 1; k <= steps; k++) {
        double t = (double)k / steps;
        if (is_over_air(o, between(edge[0], edge[1], t)) == over)
            continue;
        iso_point change = find_change(o, edge, (double)(k - 1) / steps, t, over);
        ISO_TRY(add_piece(o, from, change, vertex, over));
        from = change;
        over = !over;
    }
    return add_piece(o, from, edge[1], vertex, over);
}

static iso_status cut_path(iso_overhanging *o, const iso_paths *paths, const iso_path *path) {
    const iso_path_vertex *v = paths->vertex + path->first;
    o->count = 0;
    for (int32_t i = 0; i + !path->closed < path->count; i++) {
        iso_point edge[] = {v[i].at, v[i + 1 < path->count ? i + 1 : 0].at};
        ISO_TRY(edge_in_mask(&o->mask, edge[0], edge[1]) ? add_piece(o, edge[0], edge[1], i, false)
                                                         : cut_edge(o, edge, i));
    }
    return ISO_OK;
}

/* Turn runs of pieces over air, or of others, that are shorter than what is told apart. On a closed
 * path a run may go over the start. */
static void turn_short_runs(iso_overhanging *o, bool over, bool closed) {
    int64_t start = 0, count = o->count;
    while (closed && start < count && o->piece[start].over == o->piece[count - 1].over)
        start++;
    if (start == count)
        return; /* all alike */
    for (int64_t i = 0; i < count;) {
        double length = 0;
        int64_t end = i;
        bool of_run = o->piece[(start + i) % count].over;
        for (; end < count && o->piece[(start + end) % count].over == of_run; end++)
            length += o->piece[(start + end) % count].length;
        bool at_end = !closed && (i == 0 || end == count);
        if (of_run == over && length < o->options->shortest && (over || !at_end))
            for (int64_t k = i; k < end; k++)
                o->piece[(start + k) % count].over = !over;
        i = end;
    }
}

static bool starts_change(const iso_overhanging *o, int64_t i) {
    return i == 0 || o->piece[i].vertex != o->piece[i - 1].vertex ||
           o->piece[i].over != o->piece[i - 1].over;
}

/* Write the path anew behind the last vertex. */
static iso_status replace_path(iso_paths *paths, iso_path *path, const iso_overhanging *o) {
    const iso_overhang_options *options = o->options;
    int32_t first = paths->vertex_count, count = 0;
    ISO_TRY(ISO_GROW(paths->vertex, paths->vertex_capacity, first + o->count + 1));
    for (int64_t i = 0; i < o->count; i++) {
        const iso_piece *piece = &o->piece[i];
        if (!starts_change(o, i))
            continue;
        iso_path_vertex v = paths->vertex[path->first + piece->vertex];
        v.at = piece->at;
        if (piece->over) {
            v.role = ISO_ROLE_OVERHANG_PERIMETER;
            v.width = options->width;
            v.area = options->area;
        }
        paths->vertex[first + count++] = v;
    }
    if (!path->closed) {
        iso_path_vertex last = paths->vertex[path->first + path->count - 1];
        paths->vertex[first + count++] = last;
    }
    path->first = first;
    path->count = count;
    paths->vertex_count = first + count;
    return ISO_OK;
}

static iso_status find_overhang(iso_paths *paths, int32_t number, iso_overhanging *o) {
    iso_path *path = &paths->path[number];
    bool any = false;
    ISO_TRY(cut_path(o, paths, path));
    turn_short_runs(o, true, path->closed);
    turn_short_runs(o, false, path->closed);
    for (int64_t i = 0; i < o->count; i++)
        any = any || o->piece[i].over;
    return any ? replace_path(paths, path, o) : ISO_OK;
}

/* ---- all of them ---- */

static iso_status find_overhangs(iso_paths *paths, const iso_region *support, iso_overhanging *o,
                                 iso_arena *arena) {
    iso_box box;
    int32_t cell = (int32_t)(o->options->reach / CELLS_OF_REACH);
    bool indexed = false;
    if (!walls_box(&box, paths))
        return ISO_OK;
    ISO_TRY(mask_of(&o->mask, support, &box, cell > 1 ? cell : 1, arena));
    if (o->mask.cell <= cell)
        ISO_TRY(mask_grow(&o->mask, arena));
    for (int32_t i = 0; i < paths->count; i++) {
        if (!is_wall(&paths->path[i]) || path_in_mask(&o->mask, paths, &paths->path[i]))
            continue;
        if (!indexed)
            ISO_TRY(rows_of(&o->rows, support, arena));
        indexed = true;
        ISO_TRY(find_overhang(paths, i, o));
    }
    return ISO_OK;
}

iso_status iso_walls_find_overhangs(iso_paths *paths, const iso_region *support,
                                    const iso_overhang_options *options,
                                    iso_planar_scratch *scratch) {
    iso_overhanging o = {.options = options};
    iso_arena_mark mark = iso_arena_get_mark(&scratch->arena);
    iso_status status = find_overhangs(paths, support, &o, &scratch->arena);
    iso_arena_pop(&scratch->arena, mark);
    iso_release(o.piece);
    return status;
}

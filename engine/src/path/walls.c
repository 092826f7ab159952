/* The walls of a group. Each wall knows those that lie beside it on its inner side; an external one
 * and what hangs on it are printed together, with their seams side by side. */
#include "path/edges.h"
#include "path/nearest.h"
#include "path/ordering.h"

enum {
    SAMPLES = 12, /* points of a wall that look for the walls outside of it */
    SIDES = 4,    /* at most so many of them */
    FEW_INNER = 64
};

typedef struct walls {
    iso_ordering *o;
    iso_run run;
    int32_t count;
    int32_t external_rank;
    int outward;          /* inner walls are printed first */
    int32_t *beside;      /* [count][SIDES] walls next outside of each, -1: no more */
    int32_t *inner_first; /* [count + 2] of each wall in inner[] */
    int32_t *inner;       /* walls next inside of it */
    int32_t *waiting;     /* [count] walls outside of it that are not yet printed */
    uint8_t *printed;     /* [count] */
} walls;

static const iso_path *wall(const walls *w, int32_t i) {
    return ordering_path(w->o, w->run.begin + i);
}

static const iso_path_vertex *vertex_of(const walls *w, int32_t i) {
    return ordering_vertex(w->o, w->run.begin + i);
}

static int32_t path_of(const walls *w, int32_t i) {
    return w->o->key[w->run.begin + i].path;
}

static int is_external(const iso_path *path) {
    return path->role == ISO_ROLE_EXTERNAL_PERIMETER && path->closed;
}

/* ---- which lies beside which ---- */

typedef struct rank_run {
    int32_t begin, end; /* walls of one rank */
} rank_run;

/* Keys are sorted by rank. */
static rank_run next_outside(const walls *w, rank_run r) {
    int32_t rank = wall(w, r.begin)->rank + (w->outward ? 1 : -1);
    rank_run found = {0, 0};
    if (w->outward) {
        found.begin = found.end = r.end;
        while (found.end < w->count && wall(w, found.end)->rank == rank)
            found.end++;
    } else {
        found.begin = found.end = r.begin;
        while (found.begin > 0 && wall(w, found.begin - 1)->rank == rank)
            found.begin--;
    }
    return found;
}

static void note_beside(walls *w, int32_t i, int32_t outer) {
    int32_t *beside = w->beside + (int64_t)SIDES * i;
    for (int n = 0; n < SIDES; n++) {
        if (beside[n] == outer)
            return;
        if (beside[n] < 0) {
            beside[n] = outer;
            return;
        }
    }
}

static void look_outside(walls *w, const iso_edge_grid *grid, int32_t i, rank_run outside) {
    const iso_path *path = wall(w, i);
    const iso_path_vertex *vertex = vertex_of(w, i);
    int32_t samples = path->count < SAMPLES ? path->count : SAMPLES;
    if (outside.end - outside.begin == 1) {
        note_beside(w, i, outside.begin);
        return;
    }
    for (int32_t s = 0; s < samples; s++) {
        const iso_path_vertex *v = &vertex[(int64_t)s * path->count / samples];
        int32_t e = iso_edge_grid_nearest(grid, v->at, 2 * v->width, outside.begin, outside.end);
        if (e >= 0)
            note_beside(w, i, grid->edge[e].owner);
    }
}

static iso_status build_grid(iso_edge_grid *grid, const walls *w, rank_run run) {
    int32_t n = 0;
    iso_path_edge *edge;
    for (int32_t i = run.begin; i < run.end; i++)
        n += wall(w, i)->count;
    ISO_TRY(ISO_PUSH(edge, w->o->scratch, n));
    n = 0;
    for (int32_t i = run.begin; i < run.end; i++) {
        const iso_path *path = wall(w, i);
        const iso_path_vertex *v = vertex_of(w, i);
        for (int32_t k = 0; k < path->count - !path->closed; k++)
            edge[n++] = (iso_path_edge){v[k].at, v[k + 1 < path->count ? k + 1 : 0].at, i};
    }
    return iso_edge_grid_build(grid, edge, n, w->o->scratch);
}

static iso_status find_beside(walls *w) {
    iso_edge_grid grid = {0};
    int32_t built = -1; /* the grid is of the run that begins there */
    for (int32_t i = 0; i < w->count * SIDES; i++)
        w->beside[i] = -1;
    for (rank_run r = {0, 0}; r.begin < w->count; r.begin = r.end) {
        for (r.end = r.begin + 1;
             r.end < w->count && wall(w, r.end)->rank == wall(w, r.begin)->rank;)
            r.end++;
        if (wall(w, r.begin)->rank == w->external_rank)
            continue;
        rank_run outside = next_outside(w, r);
        if (outside.end - outside.begin > 1 && built != outside.begin) {
            ISO_TRY(build_grid(&grid, w, outside));
            built = outside.begin;
        }
        for (int32_t i = r.begin; i < r.end && outside.end > outside.begin; i++)
            if (wall(w, i)->closed)
                look_outside(w, &grid, i, outside);
    }
    return ISO_OK;
}

/* The same from outside in. */
static iso_status turn_inward(walls *w) {
    ISO_TRY(ISO_PUSH(w->inner_first, w->o->scratch, (int64_t)w->count + 2));
    ISO_TRY(ISO_PUSH(w->inner, w->o->scratch, (int64_t)w->count * SIDES));
    memset(w->inner_first, 0, ((size_t)w->count + 2) * sizeof *w->inner_first);
    memset(w->waiting, 0, (size_t)w->count * sizeof *w->waiting);
    for (int32_t i = 0; i < w->count * SIDES; i++)
        if (w->beside[i] >= 0)
            w->inner_first[w->beside[i] + 2]++;
    for (int32_t i = 0; i < w->count; i++)
        w->inner_first[i + 2] += w->inner_first[i + 1];
    for (int32_t i = 0; i < w->count * SIDES; i++)
        if (w->beside[i] >= 0) {
            w->inner[w->inner_first[w->beside[i] + 1]++] = i / SIDES;
            w->waiting[i / SIDES]++;
        }
    return ISO_OK;
}

/* ---- printing ---- */

/* The seam of a wall as near as can be to that of the one beside it. */
static void place_beside(walls *w, int32_t i, iso_point seam) {
    int32_t p = path_of(w, i);
    if (w->o->placed[p])
        return;
    w->o->seam[p] = iso_seam_beside(wall(w, i), vertex_of(w, i), seam);
    w->o->placed[p] = 1;
}

static void print(walls *w, int32_t i) {
    ordering_emit_from(w->o, w->run.begin + i, w->o->seam[path_of(w, i)]);
    w->printed[i] = 1;
}

/* Of the walls within wall i, the one whose seam is nearest; -1 if none is left that may be printed
 * now. */
static int32_t next_inner(walls *w, int32_t i) {
    int64_t closest = INT64_MAX;
    int32_t best = -1, begin = w->inner_first[i], end = w->inner_first[i + 1];
    for (int32_t k = begin; k < end; k++) {
        int32_t j = w->inner[k];
        if (w->printed[j] || (!w->outward && w->waiting[j] > 0))
            continue;
        place_beside(w, j, w->o->seam[path_of(w, i)].at);
        int64_t d = iso_distance_squared(w->o->seam[path_of(w, j)].at, w->o->position);
        if (d < closest) {
            closest = d;
            best = j;
        }
        if (end - begin > FEW_INNER)
            return best;
    }
    return best;
}

/* With all that hangs on it. It goes down a rank each time, so it is no deeper than walls are
 * many. */
static void print_with_inner(walls *w, int32_t i) {
    int32_t j;
    if (w->printed[i])
        return;
    w->printed[i] = 1; /* none comes back to it */
    if (!w->outward) {
        print(w, i);
        for (int32_t k = w->inner_first[i]; k < w->inner_first[i + 1]; k++)
            w->waiting[w->inner[k]]--;
    }
    while ((j = next_inner(w, i)) >= 0)
        print_with_inner(w, j);
    if (w->outward)
        print(w, i);
}

static iso_status print_root(walls *w, int32_t i, int32_t start) {
    int32_t p = path_of(w, i);
    if (!wall(w, i)->closed) {
        ordering_emit(w->o, w->run.begin + i, start);
        w->printed[i] = 1;
        return ISO_OK;
    }
    if (!w->o->placed[p] && is_external(wall(w, i))) {
        ISO_TRY(iso_seam_choose(&w->o->seam[p], w->o->seams, wall(w, i), vertex_of(w, i), p,
                                ISO_SEAM_NEAREST, w->o->position));
        w->o->placed[p] = 1;
    }
    place_beside(w, i, w->o->position);
    print_with_inner(w, i);
    return ISO_OK;
}

/* Does nothing lie outside of it, as far as its rank tells? */
static int is_root(const walls *w, int32_t i) {
    return w->beside[(int64_t)SIDES * i] < 0;
}

/* Where seams are decided, external walls are points of a tour. */
static iso_status print_placed(walls *w, const int32_t *root, int32_t roots) {
    iso_stop *stop;
    int32_t *tour;
    ISO_TRY(ISO_PUSH(stop, w->o->scratch, roots));
    ISO_TRY(ISO_PUSH(tour, w->o->scratch, roots));
    for (int32_t r = 0; r < roots; r++) {
        const iso_path *path = wall(w, root[r]);
        const iso_path_vertex *v = vertex_of(w, root[r]);
        iso_point seam = w->o->seam[path_of(w, root[r])].at;
        stop[r] =
            path->closed ? (iso_stop){seam, seam} : (iso_stop){v[0].at, v[path->count - 1].at};
    }
    ISO_TRY(iso_tour_nearest(tour, stop, roots, w->o->position, w->o->scratch));
    iso_tour_frame frame = {.from = w->o->position};
    ISO_TRY(iso_tour_improve(tour, stop, roots, &frame, &w->o->cost, w->o->scratch));
    for (int32_t k = 0; k < roots; k++) {
        int32_t i = root[tour[k] >> 1];
        ISO_TRY(print_root(w, i, tour[k] & 1 ? wall(w, i)->count - 1 : 0));
    }
    return ISO_OK;
}

/* Otherwise the nearest is next, and has its seam near there. */
static iso_status print_nearest(walls *w, const int32_t *root, int32_t roots) {
    iso_candidate *candidate;
    iso_nearest nearest;
    int64_t starts = 0;
    for (int32_t r = 0; r < roots; r++)
        starts += wall(w, root[r])->count;
    ISO_TRY(ISO_PUSH(candidate, w->o->scratch, starts));
    int32_t n = 0;
    for (int32_t r = 0; r < roots; r++) {
        const iso_path *path = wall(w, root[r]);
        const iso_path_vertex *v = vertex_of(w, root[r]);
        int32_t step = path->closed || path->count < 2 ? 1 : path->count - 1;
        for (int32_t i = 0; i < path->count; i += step)
            candidate[n++] = (iso_candidate){v[i].at, r, i};
    }
    ISO_TRY(iso_nearest_build(&nearest, candidate, n, roots, w->o->scratch));
    const iso_candidate *best;
    while ((best = iso_nearest_find(&nearest, w->o->position))) {
        int32_t r = best->owner, start = best->name;
        iso_nearest_take(&nearest, r);
        ISO_TRY(print_root(w, root[r], start));
    }
    return ISO_OK;
}

static iso_status print_all(walls *w) {
    int32_t *root, roots = 0;
    int placed = 1;
    ISO_TRY(ISO_PUSH(root, w->o->scratch, w->count));
    for (int32_t i = 0; i < w->count; i++)
        if (is_root(w, i)) {
            root[roots++] = i;
            if (w->o->options->seam != ISO_SEAM_NEAREST && wall(w, i)->closed)
                place_beside(w, i, w->o->position);
            placed &= !wall(w, i)->closed || w->o->placed[path_of(w, i)];
        }
    ISO_TRY(placed ? print_placed(w, root, roots) : print_nearest(w, root, roots));
    for (int32_t i = 0; i < w->count; i++)
        if (!w->printed[i])
            ISO_TRY(print_root(w, i, 0));
    return ISO_OK;
}

static iso_status order_walls(iso_ordering *o, iso_run run, int32_t external) {
    walls w = {.o = o, .run = run, .count = run.end - run.begin};
    w.external_rank = ordering_path(o, external)->rank;
    w.outward = w.external_rank > ordering_path(o, run.begin)->rank;
    if (w.count > INT32_MAX / SIDES)
        return iso_fail(ISO_OUTSIDE, "a layer with more than 2^29 walls is too much");
    ISO_TRY(ISO_PUSH(w.beside, o->scratch, (int64_t)w.count * SIDES));
    ISO_TRY(ISO_PUSH(w.waiting, o->scratch, w.count));
    ISO_TRY(ISO_PUSH(w.printed, o->scratch, w.count));
    memset(w.printed, 0, (size_t)w.count);
    ISO_TRY(find_beside(&w));
    ISO_TRY(turn_inward(&w));
    return print_all(&w);
}

iso_status ordering_walls(iso_ordering *o, iso_run run) {
    int32_t external = run.begin;
    while (external < run.end && !is_external(ordering_path(o, external)))
        external++;
    if (external == run.end)
        return ordering_nearest(o, run);
    iso_arena_mark mark = iso_arena_get_mark(o->scratch);
    ISO_TRY(order_walls(o, run, external));
    iso_arena_pop(o->scratch, mark);
    return ISO_OK;
}

iso_status ordering_choose_seams(iso_ordering *o) {
    if (o->options->seam == ISO_SEAM_NEAREST)
        return ISO_OK;
    if (o->options->seam == ISO_SEAM_ALIGNED)
        ISO_TRY(iso_seams_index(o->seams, o->scratch));
    for (int32_t k = 0; k < o->count; k++) {
        int32_t p = o->key[k].path;
        const iso_path *path = &o->in->path[p];
        if (o->key[k].phase != PHASE_WALLS || !is_external(path) || path->count < 2)
            continue;
        ISO_TRY(iso_seam_choose(&o->seam[p], o->seams, path, o->in->vertex + path->first, p,
                                o->options->seam, o->position));
        o->placed[p] = 1;
    }
    return ISO_OK;
}

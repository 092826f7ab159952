/* Paths of a group, the nearest next, or by a tour. */
#include "path/edges.h"
#include "path/nearest.h"
#include "path/ordering.h"

iso_status ordering_too_many(void) {
    return iso_fail(ISO_OUTSIDE, "a layer with more than 2^31 path vertices is too much");
}

/* A path may begin at every so many of its vertices; one whose seam is decided, there only. */
static int32_t step_of(const iso_path *path) {
    return path->closed || path->count < 2 ? 1 : path->count - 1;
}

int64_t ordering_count_starts(const iso_ordering *o, iso_run r) {
    int64_t starts = 0;
    for (int32_t k = r.begin; k < r.end; k++) {
        const iso_path *path = ordering_path(o, k);
        starts += o->placed[o->key[k].path] ? 1 : path->closed ? path->count : 2;
    }
    return starts;
}

int32_t ordering_list_starts(iso_candidate *candidate, const iso_ordering *o, int32_t k,
                             int32_t owner) {
    const iso_path *path = ordering_path(o, k);
    const iso_path_vertex *vertex = ordering_vertex(o, k);
    int32_t n = 0, p = o->key[k].path;
    if (o->placed[p]) {
        candidate[0] = (iso_candidate){o->seam[p].at, owner, 0};
        return 1;
    }
    for (int32_t i = 0; i < path->count; i += step_of(path))
        candidate[n++] = (iso_candidate){vertex[i].at, owner, i};
    return n;
}

static void look_at(iso_start *best, const iso_ordering *o, int32_t k, iso_point at,
                    int32_t vertex) {
    int64_t distance = iso_distance_squared(at, o->position);
    if (distance < best->distance)
        *best = (iso_start){distance, k, vertex};
}

void ordering_look_at_starts(iso_start *best, const iso_ordering *o, int32_t k) {
    const iso_path *path = ordering_path(o, k);
    const iso_path_vertex *vertex = ordering_vertex(o, k);
    int32_t p = o->key[k].path;
    if (o->placed[p]) {
        look_at(best, o, k, o->seam[p].at, 0);
        return;
    }
    for (int32_t i = 0; i < path->count; i += step_of(path))
        look_at(best, o, k, vertex[i].at, i);
}

static void order_few(iso_ordering *o, iso_run r) {
    unsigned done = 0;
    for (int32_t n = r.begin; n < r.end; n++) {
        iso_start best = {INT64_MAX, r.begin, 0};
        for (int32_t k = r.begin; k < r.end; k++)
            if (!(done >> (k - r.begin) & 1))
                ordering_look_at_starts(&best, o, k);
        done |= 1u << (best.key - r.begin);
        ordering_emit(o, best.key, best.vertex);
    }
}

iso_status ordering_nearest(iso_ordering *o, iso_run r) {
    if (r.end - r.begin <= ORDERING_FEW) {
        order_few(o, r);
        return ISO_OK;
    }
    iso_arena_mark mark = iso_arena_get_mark(o->scratch);
    int64_t starts = ordering_count_starts(o, r);
    iso_candidate *candidate;
    iso_nearest nearest;
    if (starts > INT32_MAX)
        return ordering_too_many();
    ISO_TRY(ISO_PUSH(candidate, o->scratch, starts));
    int32_t n = 0;
    for (int32_t k = r.begin; k < r.end; k++)
        n += ordering_list_starts(candidate + n, o, k, k - r.begin);
    ISO_TRY(iso_nearest_build(&nearest, candidate, n, r.end - r.begin, o->scratch));
    const iso_candidate *best;
    while ((best = iso_nearest_find(&nearest, o->position))) {
        int32_t owner = best->owner;
        ordering_emit(o, r.begin + owner, best->name);
        iso_nearest_take(&nearest, owner);
    }
    iso_arena_pop(o->scratch, mark);
    return ISO_OK;
}

static int32_t nearest_vertex(const iso_ordering *o, int32_t k) {
    iso_start best = {INT64_MAX, k, 0};
    ordering_look_at_starts(&best, o, k);
    return best.vertex;
}

static iso_point first_of(const iso_ordering *o, int32_t k) {
    return ordering_vertex(o, k)[0].at;
}

static iso_point last_of(const iso_ordering *o, int32_t k) {
    const iso_path *path = ordering_path(o, k);
    return ordering_vertex(o, k)[path->closed ? 0 : path->count - 1].at;
}

/* The paths from key `begin` to `end`, which follow each other; `back` is from the last one's end.
 */
static void emit_chain(iso_ordering *o, int32_t begin, int32_t end, int back) {
    for (int32_t n = 0; n < end - begin; n++) {
        int32_t k = back ? end - 1 - n : begin + n;
        const iso_path *path = ordering_path(o, k);
        ordering_emit(o, k, path->closed ? nearest_vertex(o, k) : back ? path->count - 1 : 0);
    }
}

iso_status ordering_tour(iso_ordering *o, iso_run r) {
    iso_arena_mark mark = iso_arena_get_mark(o->scratch);
    int32_t count = 0, *tour, *chain;
    iso_stop *stop;
    ISO_TRY(ISO_PUSH(stop, o->scratch, r.end - r.begin));
    ISO_TRY(ISO_PUSH(tour, o->scratch, r.end - r.begin));
    ISO_TRY(ISO_PUSH(chain, o->scratch, (int64_t)r.end - r.begin + 1));
    for (int32_t k = r.begin; k < r.end; k++) {
        if (count == 0 || !ordering_path(o, k)->follows) {
            chain[count] = k;
            stop[count++].a = first_of(o, k);
        }
        stop[count - 1].b = last_of(o, k);
    }
    chain[count] = r.end;
    iso_tour_frame frame = {o->position, o->end, o->ends};
    ISO_TRY(iso_tour_nearest(tour, stop, count, o->position, o->scratch));
    ISO_TRY(iso_tour_improve(tour, stop, count, &frame, &o->cost, o->scratch));
    for (int32_t n = 0; n < count; n++)
        emit_chain(o, chain[tour[n] >> 1], chain[(tour[n] >> 1) + 1], tour[n] & 1);
    iso_arena_pop(o->scratch, mark);
    return ISO_OK;
}

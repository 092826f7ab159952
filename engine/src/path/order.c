#include "path/order.h"

#include "path/edges.h"
#include "path/nearest.h"
#include "path/ordering.h"
#include "path/travel.h"

static int key_less(const iso_order_key *a, const iso_order_key *b) {
    if (a->object != b->object)
        return a->object < b->object;
    if (a->group != b->group)
        return a->group < b->group;
    if (a->phase != b->phase)
        return a->phase < b->phase;
    if (a->rank != b->rank)
        return a->rank < b->rank;
    return a->path < b->path;
}

static void merge(iso_order_key *to, const iso_order_key *a, int32_t a_count,
                  const iso_order_key *b, int32_t b_count) {
    int32_t i = 0, j = 0, k = 0;
    while (i < a_count && j < b_count)
        to[k++] = key_less(&b[j], &a[i]) ? b[j++] : a[i++];
    while (i < a_count)
        to[k++] = a[i++];
    while (j < b_count)
        to[k++] = b[j++];
}

/* Merge sort, since layers usually come sorted, which one look shows. */
static iso_status sort_keys(iso_order_key *keys, int32_t count, iso_arena *scratch) {
    int sorted = 1;
    for (int32_t i = 1; i < count && sorted; i++)
        sorted = key_less(&keys[i - 1], &keys[i]);
    if (sorted)
        return ISO_OK;
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    iso_order_key *other;
    ISO_TRY(ISO_PUSH(other, scratch, count));
    iso_order_key *from = keys, *to = other;
    for (int64_t width = 1; width < count; width *= 2) {
        for (int64_t i = 0; i < count; i += 2 * width) {
            int32_t a = (int32_t)(count - i < width ? count - i : width);
            int32_t b = (int32_t)(count - i - a < width ? count - i - a : width);
            merge(to + i, from + i, a, from + i + a, b);
        }
        iso_order_key *swap = from;
        from = to;
        to = swap;
    }
    if (from != keys)
        memcpy(keys, from, (size_t)count * sizeof *keys);
    iso_arena_pop(scratch, mark);
    return ISO_OK;
}

static int same_group(const iso_order_key *a, const iso_order_key *b) {
    return a->object == b->object && a->group == b->group;
}

static int32_t end_of_group(const iso_ordering *o, int32_t begin) {
    int32_t end = begin + 1;
    while (end < o->count && same_group(&o->key[end], &o->key[begin]))
        end++;
    return end;
}

static int32_t end_of_phase(const iso_ordering *o, int32_t begin, int32_t group_end) {
    int32_t end = begin + 1;
    while (end < group_end && o->key[end].phase == o->key[begin].phase)
        end++;
    return end;
}

static int32_t end_of_rank(const iso_ordering *o, int32_t begin, int32_t phase_end) {
    int32_t end = begin + 1;
    while (end < phase_end && o->key[end].rank == o->key[begin].rank)
        end++;
    return end;
}

/* ---- copying ---- */

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

/* ---- the nearest next ---- */

static iso_status too_many(void) {
    return iso_fail(ISO_OUTSIDE, "a layer with more than 2^31 path vertices is too much");
}

/* Few paths, or groups, are looked through start by start; a grid would cost more to fill. */
enum { FEW = 8 };

/* A path may begin at every so many of its vertices; one whose seam is decided, there only. */
static int32_t step_of(const iso_path *path) {
    return path->closed || path->count < 2 ? 1 : path->count - 1;
}

static int64_t count_starts(const iso_ordering *o, iso_run r) {
    int64_t starts = 0;
    for (int32_t k = r.begin; k < r.end; k++) {
        const iso_path *path = ordering_path(o, k);
        starts += o->placed[o->key[k].path] ? 1 : path->closed ? path->count : 2;
    }
    return starts;
}

static int32_t list_starts(iso_candidate *candidate, const iso_ordering *o, int32_t k,
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

typedef struct start {
    int64_t distance;
    int32_t key, vertex;
} start;

static void look_at(start *best, const iso_ordering *o, int32_t k, iso_point at, int32_t vertex) {
    int64_t distance = iso_distance_squared(at, o->position);
    if (distance < best->distance)
        *best = (start){distance, k, vertex};
}

static void look_at_starts(start *best, const iso_ordering *o, int32_t k) {
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
        start best = {INT64_MAX, r.begin, 0};
        for (int32_t k = r.begin; k < r.end; k++)
            if (!(done >> (k - r.begin) & 1))
                look_at_starts(&best, o, k);
        done |= 1u << (best.key - r.begin);
        ordering_emit(o, best.key, best.vertex);
    }
}

iso_status ordering_nearest(iso_ordering *o, iso_run r) {
    if (r.end - r.begin <= FEW) {
        order_few(o, r);
        return ISO_OK;
    }
    iso_arena_mark mark = iso_arena_get_mark(o->scratch);
    int64_t starts = count_starts(o, r);
    iso_candidate *candidate;
    iso_nearest nearest;
    if (starts > INT32_MAX)
        return too_many();
    ISO_TRY(ISO_PUSH(candidate, o->scratch, starts));
    int32_t n = 0;
    for (int32_t k = r.begin; k < r.end; k++)
        n += list_starts(candidate + n, o, k, k - r.begin);
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
    start best = {INT64_MAX, k, 0};
    look_at_starts(&best, o, k);
    return best.vertex;
}

iso_status ordering_tour(iso_ordering *o, iso_run r) {
    iso_arena_mark mark = iso_arena_get_mark(o->scratch);
    int32_t count = r.end - r.begin, *tour;
    iso_stop *stop;
    ISO_TRY(ISO_PUSH(stop, o->scratch, count));
    ISO_TRY(ISO_PUSH(tour, o->scratch, count));
    for (int32_t k = 0; k < count; k++) {
        const iso_path *path = ordering_path(o, r.begin + k);
        const iso_path_vertex *vertex = ordering_vertex(o, r.begin + k);
        stop[k] = (iso_stop){vertex[0].at, vertex[path->closed ? 0 : path->count - 1].at};
    }
    iso_tour_frame frame = {o->position, o->end, o->ends};
    ISO_TRY(iso_tour_nearest(tour, stop, count, o->position, o->scratch));
    ISO_TRY(iso_tour_improve(tour, stop, count, &frame, &o->cost, o->scratch));
    for (int32_t n = 0; n < count; n++) {
        int32_t k = r.begin + (tour[n] >> 1);
        const iso_path *path = ordering_path(o, k);
        ordering_emit(o, k,
                      path->closed  ? nearest_vertex(o, k)
                      : tour[n] & 1 ? path->count - 1
                                    : 0);
    }
    iso_arena_pop(o->scratch, mark);
    return ISO_OK;
}

/* ---- groups ---- */

static iso_status order_ranks(iso_ordering *o, iso_run phase) {
    for (int32_t begin = phase.begin; begin < phase.end;) {
        int32_t end = end_of_rank(o, begin, phase.end);
        ISO_TRY(ordering_nearest(o, (iso_run){begin, end}));
        begin = end;
    }
    return ISO_OK;
}

/* Where a closed path of the fill begins depends on where the nozzle comes from, so a tour can plan
 * with a few of them at most. */
static iso_status order_fill(iso_ordering *o, iso_run fill) {
    int32_t closed = 0;
    for (int32_t k = fill.begin; k < fill.end; k++)
        closed += ordering_path(o, k)->closed;
    return closed > (fill.end - fill.begin) / 4 ? ordering_nearest(o, fill)
                                                : ordering_tour(o, fill);
}

static iso_status order_phase(iso_ordering *o, iso_run phase) {
    switch (o->key[phase.begin].phase) {
    case PHASE_WALLS:
        return ordering_walls(o, phase);
    case PHASE_EARLY_FILL:
    case PHASE_FILL:
        return order_fill(o, phase);
    default:
        return order_ranks(o, phase);
    }
}

static iso_status order_group(iso_ordering *o, iso_run group) {
    for (int32_t begin = group.begin; begin < group.end;) {
        int32_t end = end_of_phase(o, begin, group.end);
        ISO_TRY(order_phase(o, (iso_run){begin, end}));
        begin = end;
    }
    return ISO_OK;
}

/* What of a group may come first. Of walls that is any, as far as can be told from here. */
static iso_run entries(const iso_ordering *o, iso_run group) {
    int32_t end = end_of_phase(o, group.begin, group.end);
    int all = o->key[group.begin].phase == PHASE_FILL || o->key[group.begin].phase == PHASE_WALLS;
    return (iso_run){group.begin, all ? end : end_of_rank(o, group.begin, end)};
}

/* Seams that are decided are where the nozzle goes next, to those of other groups or of the layer
 * above. */
static void add_ends(iso_ordering *o, iso_run group) {
    for (int32_t k = group.begin; k < group.end && o->ends < ORDERING_ENDS; k++)
        if (o->placed[o->key[k].path] && ordering_path(o, k)->role == ISO_ROLE_EXTERNAL_PERIMETER)
            o->end[o->ends++] = o->seam[o->key[k].path].at;
}

static iso_status order_few_groups(iso_ordering *o, const iso_run *group, int32_t groups) {
    unsigned done = 0;
    for (int32_t n = 0; n < groups; n++) {
        start best = {INT64_MAX, 0, 0};
        int32_t chosen = -1;
        for (int32_t g = 0; g < groups; g++) {
            if (done >> g & 1)
                continue;
            iso_run r = entries(o, group[g]);
            int64_t before = best.distance;
            for (int32_t k = r.begin; k < r.end && groups - n > 1; k++)
                look_at_starts(&best, o, k);
            if (chosen < 0 || best.distance < before)
                chosen = g;
        }
        done |= 1u << chosen;
        o->ends = 0;
        for (int32_t g = 0; g < groups; g++)
            if (o->options->infill_first ? g == chosen : !(done >> g & 1) || n + 1 == groups)
                add_ends(o, group[g]);
        ISO_TRY(order_group(o, group[chosen]));
    }
    return ISO_OK;
}

/* A group is as near as the nearest start of what may come first in it. */
static iso_status order_many_groups(iso_ordering *o, const iso_run *group, int32_t groups) {
    int64_t starts = 0;
    int32_t n = 0;
    for (int32_t g = 0; g < groups; g++)
        starts += count_starts(o, entries(o, group[g]));
    if (starts > INT32_MAX)
        return too_many();
    iso_candidate *candidate;
    iso_nearest nearest;
    ISO_TRY(ISO_PUSH(candidate, o->scratch, starts));
    for (int32_t g = 0; g < groups; g++) {
        iso_run r = entries(o, group[g]);
        for (int32_t k = r.begin; k < r.end; k++)
            n += list_starts(candidate + n, o, k, g);
    }
    ISO_TRY(iso_nearest_build(&nearest, candidate, n, groups, o->scratch));
    const iso_candidate *best;
    while ((best = iso_nearest_find(&nearest, o->position))) {
        int32_t g = best->owner;
        iso_nearest_take(&nearest, g);
        ISO_TRY(order_group(o, group[g]));
    }
    return ISO_OK;
}

/* Where a group begins, if that is decided: at the seam of an external wall. */
static int begins_at(iso_point *at, const iso_ordering *o, iso_run group) {
    for (int32_t k = group.begin; k < group.end && o->key[k].phase <= PHASE_WALLS; k++) {
        if (o->key[k].phase < PHASE_WALLS)
            return 0;
        if (o->placed[o->key[k].path]) {
            *at = o->seam[o->key[k].path].at;
            return 1;
        }
    }
    return 0;
}

/* Many groups are small ones, which end near where they begin: points of a tour. `stop` has room
 * for all of them; its count is 0 if one has no such point. */
static int32_t list_beginnings(iso_stop *stop, const iso_ordering *o, const iso_run *group,
                               int32_t groups) {
    for (int32_t g = 0; g < groups; g++) {
        if (!begins_at(&stop[g].a, o, group[g]))
            return 0;
        stop[g].b = stop[g].a;
    }
    return groups;
}

static iso_status order_many(iso_ordering *o, const iso_run *group, int32_t groups) {
    iso_tour_frame frame = {.from = o->position};
    iso_stop *stop;
    int32_t *tour;
    ISO_TRY(ISO_PUSH(stop, o->scratch, groups));
    if (list_beginnings(stop, o, group, groups) == 0)
        return order_many_groups(o, group, groups);
    ISO_TRY(ISO_PUSH(tour, o->scratch, groups));
    ISO_TRY(iso_tour_nearest(tour, stop, groups, o->position, o->scratch));
    ISO_TRY(iso_tour_improve(tour, stop, groups, &frame, &o->options->cost, o->scratch));
    for (int32_t n = 0; n < groups; n++) {
        o->ends = 0;
        if (n + 1 < groups)
            o->end[o->ends++] = stop[tour[n + 1] >> 1].a;
        else
            add_ends(o, group[tour[n] >> 1]);
        ISO_TRY(order_group(o, group[tour[n] >> 1]));
    }
    return ISO_OK;
}

/* Skirts before all else: they are there to get the nozzle going. */
static iso_status order_groups(iso_ordering *o) {
    iso_run *group;
    int32_t groups = 0;
    ISO_TRY(ISO_PUSH(group, o->scratch, o->count));
    for (int32_t begin = 0, end; begin < o->count; begin = end) {
        iso_run whole = {begin, end = end_of_group(o, begin)};
        if (o->key[begin].phase == PHASE_SKIRT)
            ISO_TRY(order_group(o, whole));
        else
            group[groups++] = whole;
    }
    return groups <= FEW ? order_few_groups(o, group, groups) : order_many(o, group, groups);
}

/* ---- the layer ---- */

static int32_t phase_of(iso_role role, int infill_first) {
    switch (role) {
    case ISO_ROLE_SKIRT:
        return PHASE_SKIRT;
    case ISO_ROLE_SUPPORT:
        return PHASE_SUPPORT;
    case ISO_ROLE_SUPPORT_INTERFACE:
        return PHASE_INTERFACE;
    case ISO_ROLE_EXTERNAL_PERIMETER:
    case ISO_ROLE_PERIMETER:
    case ISO_ROLE_OVERHANG_PERIMETER:
        return PHASE_WALLS;
    case ISO_ROLE_INTERNAL_INFILL:
    case ISO_ROLE_SOLID_INFILL:
    case ISO_ROLE_TOP_SOLID_INFILL:
    case ISO_ROLE_BRIDGE_INFILL:
    case ISO_ROLE_GAP_FILL:
        return infill_first ? PHASE_EARLY_FILL : PHASE_FILL;
    case ISO_ROLE_IRONING:
        return PHASE_IRONING;
    default:
        return PHASE_REST;
    }
}

static iso_status order(iso_ordering *o) {
    iso_paths *out = o->out;
    int32_t count = o->in->count;
    ISO_TRY(ISO_PUSH(o->key, o->scratch, count));
    ISO_TRY(ISO_PUSH(o->seam, o->scratch, count));
    ISO_TRY(ISO_PUSH(o->placed, o->scratch, count));
    memset(o->placed, 0, (size_t)count);
    for (int32_t i = 0; i < count; i++) {
        const iso_path *path = &o->in->path[i];
        int32_t phase = phase_of((iso_role)path->role, o->options->infill_first);
        if (path->count > 0)
            o->key[o->count++] = (iso_order_key){path->object, path->group, phase, path->rank, i};
    }
    if (o->count == 0)
        return ISO_OK;
    if ((int64_t)o->in->vertex_count + count > INT32_MAX)
        return too_many();
    ISO_TRY(ISO_GROW(out->path, out->path_capacity, count));
    ISO_TRY(ISO_GROW(out->vertex, out->vertex_capacity, (int64_t)o->in->vertex_count + count));
    ISO_TRY(sort_keys(o->key, o->count, o->scratch));
    ISO_TRY(ordering_choose_seams(o));
    return order_groups(o);
}

iso_order_options iso_order_defaults(void) {
    return (iso_order_options){.seam = ISO_SEAM_NEAREST,
                               .cost = {.speed = 150.0 * ISO_UNITS_PER_MM,
                                        .acceleration = 1000.0 * ISO_UNITS_PER_MM,
                                        .retraction = 0.18,
                                        .retract_before = 2.0 * ISO_UNITS_PER_MM,
                                        .junction_deviation = 0.013 * ISO_UNITS_PER_MM}};
}

void iso_order_state_free(iso_order_state *state) {
    iso_seams_free(&state->seams);
    *state = (iso_order_state){0};
}

iso_status iso_order_layer(iso_paths *out, const iso_paths *in, iso_order_state *state,
                           const iso_order_options *options, iso_arena *scratch) {
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    iso_ordering o = {.in = in,
                      .out = out,
                      .scratch = scratch,
                      .options = options,
                      .seams = &state->seams,
                      .cost = options->cost,
                      .position = state->position};
    if (options->retract_crossing_only)
        o.cost.retraction = 0; /* most of them are hidden */
    iso_paths_clear(out);
    iso_seams_next_layer(&state->seams);
    iso_status status = order(&o);
    if (status == ISO_OK)
        status = iso_travel_plan(out, state->position, options, scratch);
    iso_arena_pop(scratch, mark);
    if (status == ISO_OK)
        state->position = o.position;
    else
        iso_paths_clear(out);
    return status;
}

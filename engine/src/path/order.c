#include "path/order.h"

#include "path/nearest.h"

typedef struct key {
    int32_t object, group, rank, path;
} key;

/* A run of keys; one level of the hierarchy group > rank > path. */
typedef struct run {
    int32_t begin, end;
} run;

typedef struct ordering {
    const iso_paths *in;
    iso_paths *out;
    iso_arena *scratch;
    iso_point position;
    key *key;
    int32_t count;
} ordering;

static int key_less(const key *a, const key *b) {
    if (a->object != b->object)
        return a->object < b->object;
    if (a->group != b->group)
        return a->group < b->group;
    if (a->rank != b->rank)
        return a->rank < b->rank;
    return a->path < b->path;
}

static void merge(key *to, const key *a, int32_t a_count, const key *b, int32_t b_count) {
    int32_t i = 0, j = 0, k = 0;
    while (i < a_count && j < b_count)
        to[k++] = key_less(&b[j], &a[i]) ? b[j++] : a[i++];
    while (i < a_count)
        to[k++] = a[i++];
    while (j < b_count)
        to[k++] = b[j++];
}

/* Merge sort, since layers usually come sorted, which one look shows. */
static iso_status sort_keys(key *keys, int32_t count, iso_arena *scratch) {
    int sorted = 1;
    for (int32_t i = 1; i < count && sorted; i++)
        sorted = key_less(&keys[i - 1], &keys[i]);
    if (sorted)
        return ISO_OK;
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    key *other;
    ISO_TRY(ISO_PUSH(other, scratch, count));
    key *from = keys, *to = other;
    for (int64_t width = 1; width < count; width *= 2) {
        for (int64_t i = 0; i < count; i += 2 * width) {
            int32_t a = (int32_t)(count - i < width ? count - i : width);
            int32_t b = (int32_t)(count - i - a < width ? count - i - a : width);
            merge(to + i, from + i, a, from + i + a, b);
        }
        key *swap = from;
        from = to;
        to = swap;
    }
    if (from != keys)
        memcpy(keys, from, (size_t)count * sizeof *keys);
    iso_arena_pop(scratch, mark);
    return ISO_OK;
}

static int32_t end_of_group(const ordering *o, int32_t begin) {
    int32_t end = begin + 1;
    while (end < o->count && o->key[end].object == o->key[begin].object &&
           o->key[end].group == o->key[begin].group)
        end++;
    return end;
}

static int32_t end_of_rank(const ordering *o, int32_t begin, int32_t group_end) {
    int32_t end = begin + 1;
    while (end < group_end && o->key[end].rank == o->key[begin].rank)
        end++;
    return end;
}

static int64_t count_starts(const ordering *o, run r) {
    int64_t starts = 0;
    for (int32_t i = r.begin; i < r.end; i++) {
        const iso_path *path = &o->in->path[o->key[i].path];
        starts += path->closed ? path->count : path->count > 1 ? 2 : 1;
    }
    return starts;
}

/* The vertices at which path `key` may begin. */
static int32_t list_starts(iso_candidate *candidate, const ordering *o, int32_t k, int32_t owner) {
    const iso_path *path = &o->in->path[o->key[k].path];
    const iso_path_vertex *vertex = o->in->vertex + path->first;
    int32_t step = path->closed || path->count < 2 ? 1 : path->count - 1, n = 0;
    for (int32_t i = 0; i < path->count; i += step)
        candidate[n++] = (iso_candidate){vertex[i].at, owner, i};
    return n;
}

static void copy_rotated(iso_path_vertex *to, const iso_path_vertex *from, int32_t count,
                         int32_t start) {
    memcpy(to, from + start, (size_t)(count - start) * sizeof *to);
    memcpy(to + count - start, from, (size_t)start * sizeof *to);
}

/* The bead of vertex i ran from i to i + 1; backwards it runs from i + 1 to i. The end of the path
 * keeps its own, which is never drawn: so reversing twice changes nothing. */
static void copy_reversed(iso_path_vertex *to, const iso_path_vertex *from, int32_t count) {
    for (int32_t i = 0; i < count; i++) {
        to[i] = from[count - 1 - i];
        int32_t bead = i + 1 < count ? count - 2 - i : count - 1;
        to[i].width = from[bead].width;
        to[i].area = from[bead].area;
        to[i].role = from[bead].role;
    }
}

static void emit(ordering *o, int32_t k, int32_t start) {
    const iso_path *path = &o->in->path[o->key[k].path];
    const iso_path_vertex *from = o->in->vertex + path->first;
    iso_path_vertex *to = o->out->vertex + o->out->vertex_count;
    iso_path *copy = &o->out->path[o->out->count++];
    *copy = *path;
    copy->first = o->out->vertex_count;
    if (path->closed)
        copy_rotated(to, from, path->count, start);
    else if (start > 0)
        copy_reversed(to, from, path->count);
    else
        memcpy(to, from, (size_t)path->count * sizeof *to);
    o->out->vertex_count += path->count;
    o->position = path->closed ? to[0].at : to[path->count - 1].at;
}

static iso_status too_many(void) {
    return iso_fail(ISO_OUTSIDE, "a layer with more than 2^31 path vertices is too much");
}

/* Few paths, or groups, are looked through start by start; a grid would cost more to fill. */
enum { FEW = 8 };

typedef struct start {
    int64_t distance;
    int32_t key, vertex;
} start;

static void look_at_starts(start *best, const ordering *o, int32_t k) {
    const iso_path *path = &o->in->path[o->key[k].path];
    const iso_path_vertex *vertex = o->in->vertex + path->first;
    int32_t step = path->closed || path->count < 2 ? 1 : path->count - 1;
    for (int32_t i = 0; i < path->count; i += step) {
        int64_t dx = (int64_t)vertex[i].at.x - o->position.x;
        int64_t dy = (int64_t)vertex[i].at.y - o->position.y;
        int64_t distance = dx * dx + dy * dy;
        if (distance < best->distance)
            *best = (start){distance, k, i};
    }
}

static void order_few(ordering *o, run r) {
    unsigned done = 0;
    for (int32_t n = r.begin; n < r.end; n++) {
        start best = {INT64_MAX, r.begin, 0};
        for (int32_t k = r.begin; k < r.end; k++)
            if (!(done >> (k - r.begin) & 1))
                look_at_starts(&best, o, k);
        done |= 1u << (best.key - r.begin);
        emit(o, best.key, best.vertex);
    }
}

static iso_status order_rank(ordering *o, run r) {
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
        emit(o, r.begin + owner, best->name);
        iso_nearest_take(&nearest, owner);
    }
    iso_arena_pop(o->scratch, mark);
    return ISO_OK;
}

static iso_status order_group(ordering *o, run group) {
    for (int32_t begin = group.begin; begin < group.end;) {
        int32_t end = end_of_rank(o, begin, group.end);
        ISO_TRY(order_rank(o, (run){begin, end}));
        begin = end;
    }
    return ISO_OK;
}

static run lowest_rank(const ordering *o, run group) {
    return (run){group.begin, end_of_rank(o, group.begin, group.end)};
}

static iso_status order_few_groups(ordering *o, const run *group, int32_t groups) {
    unsigned done = 0;
    for (int32_t n = 0; n < groups; n++) {
        start best = {INT64_MAX, 0, 0};
        int32_t chosen = -1;
        for (int32_t g = 0; g < groups; g++) {
            if (done >> g & 1)
                continue;
            run r = lowest_rank(o, group[g]);
            int64_t before = best.distance;
            for (int32_t k = r.begin; k < r.end && groups - n > 1; k++)
                look_at_starts(&best, o, k);
            if (chosen < 0 || best.distance < before)
                chosen = g;
        }
        done |= 1u << chosen;
        ISO_TRY(order_group(o, group[chosen]));
    }
    return ISO_OK;
}

/* A group is as near as the nearest start of its lowest rank. */
static iso_status order_many_groups(ordering *o, const run *group, int32_t groups) {
    int64_t starts = 0;
    int32_t n = 0;
    for (int32_t g = 0; g < groups; g++)
        starts += count_starts(o, lowest_rank(o, group[g]));
    if (starts > INT32_MAX)
        return too_many();
    iso_candidate *candidate;
    iso_nearest nearest;
    ISO_TRY(ISO_PUSH(candidate, o->scratch, starts));
    for (int32_t g = 0; g < groups; g++) {
        run r = lowest_rank(o, group[g]);
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

static iso_status order_groups(ordering *o) {
    run *group;
    int32_t groups = 0;
    ISO_TRY(ISO_PUSH(group, o->scratch, o->count));
    for (int32_t begin = 0; begin < o->count; begin = group[groups++].end)
        group[groups] = (run){begin, end_of_group(o, begin)};
    return groups <= FEW ? order_few_groups(o, group, groups) : order_many_groups(o, group, groups);
}

static iso_status order(ordering *o) {
    iso_paths *out = o->out;
    ISO_TRY(ISO_PUSH(o->key, o->scratch, o->in->count));
    for (int32_t i = 0; i < o->in->count; i++) {
        const iso_path *path = &o->in->path[i];
        if (path->count > 0)
            o->key[o->count++] = (key){path->object, path->group, path->rank, i};
    }
    if (o->count == 0)
        return ISO_OK;
    ISO_TRY(ISO_GROW(out->path, out->path_capacity, o->in->count));
    ISO_TRY(ISO_GROW(out->vertex, out->vertex_capacity, o->in->vertex_count));
    ISO_TRY(sort_keys(o->key, o->count, o->scratch));
    return order_groups(o);
}

iso_status iso_order_layer(iso_paths *out, const iso_paths *in, iso_point *position,
                           iso_arena *scratch) {
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    ordering o = {.in = in, .out = out, .scratch = scratch, .position = *position};
    iso_paths_clear(out);
    iso_status status = order(&o);
    iso_arena_pop(scratch, mark);
    if (status == ISO_OK)
        *position = o.position;
    else
        iso_paths_clear(out);
    return status;
}

#include "path/order.h"

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
        int fill = phase == PHASE_FILL || phase == PHASE_EARLY_FILL;
        if (path->count > 0)
            o->key[o->count++] =
                (iso_order_key){path->object, path->group, phase, fill ? 0 : path->rank, i};
    }
    if (o->count == 0)
        return ISO_OK;
    if ((int64_t)o->in->vertex_count + count > INT32_MAX)
        return ordering_too_many();
    ISO_TRY(ISO_GROW(out->path, out->path_capacity, count));
    ISO_TRY(ISO_GROW(out->vertex, out->vertex_capacity, (int64_t)o->in->vertex_count + count));
    ISO_TRY(sort_keys(o->key, o->count, o->scratch));
    ISO_TRY(ordering_choose_seams(o));
    return ordering_groups(o);
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

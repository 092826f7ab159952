#include <isoslice/planar.h>

#include "planar/region.h"
#include "planar/trace.h"

iso_status iso_planar_scratch_new(iso_planar_scratch **scratch) {
    *scratch = iso_allocate(sizeof **scratch);
    if (!*scratch)
        return iso_no_memory(sizeof **scratch);
    **scratch = (iso_planar_scratch){0};
    return ISO_OK;
}

void iso_planar_scratch_free(iso_planar_scratch *scratch) {
    if (!scratch)
        return;
    iso_arena_free(&scratch->arena);
    edges_free(&scratch->edges);
    snap_room_free(&scratch->room);
    iso_region_free(&scratch->raw);
    iso_release(scratch);
}

iso_planar_counts iso_planar_get_counts(const iso_planar_scratch *scratch) {
    return scratch->counts;
}

static void clear_all(const iso_choice *choice, int count) {
    for (int i = 0; i < count; i++)
        iso_region_clear(choice[i].out);
}

static iso_status resolve(const iso_choice *choice, int count, iso_planar_scratch *scratch) {
    iso_arrangement arrangement;
    int64_t collisions;
    scratch->counts.operations++;
    scratch->counts.edges += scratch->edges.count;
    ISO_TRY(arrange(&arrangement, &scratch->edges, &collisions, &scratch->room, &scratch->arena));
    scratch->counts.collisions += collisions;
    scratch->counts.untouched += collisions == 0;
    scratch->counts.arranged += collisions > 0;
#ifndef NDEBUG
    ISO_TRY(arrangement_validate(&arrangement));
#endif
    for (int i = 0; i < count; i++)
        ISO_TRY(trace_region(&choice[i], &arrangement, &scratch->arena));
    return ISO_OK;
}

iso_status planar_resolve(const iso_choice *choice, int count, iso_planar_scratch *scratch) {
    iso_arena_mark mark = iso_arena_get_mark(&scratch->arena);
    clear_all(choice, count);
    iso_status status = resolve(choice, count, scratch);
    if (status != ISO_OK)
        clear_all(choice, count);
    iso_arena_pop(&scratch->arena, mark);
    scratch->edges.count = 0;
    return status;
}

static bool is_positive(const iso_winding *w, const void *context) {
    return w->of[0] > 0;
}
static bool is_nonzero(const iso_winding *w, const void *context) {
    return w->of[0] != 0;
}
static bool is_odd(const iso_winding *w, const void *context) {
    return w->of[0] & 1;
}
static bool in_union(const iso_winding *w, const void *context) {
    return w->of[0] != 0 || w->of[1] != 0;
}
static bool in_both(const iso_winding *w, const void *context) {
    return w->of[0] != 0 && w->of[1] != 0;
}
static bool in_difference(const iso_winding *w, const void *context) {
    return w->of[0] != 0 && w->of[1] == 0;
}
static bool in_one(const iso_winding *w, const void *context) {
    return (w->of[0] != 0) != (w->of[1] != 0);
}

/* Load the operands into scratch->edges, or fail with an empty `out`. */
static iso_status load(iso_region *out, const iso_region *a, const iso_region *b,
                       iso_planar_scratch *scratch) {
    scratch->edges.count = 0;
    iso_status status = edges_add(&scratch->edges, a, 0);
    if (status == ISO_OK && b)
        status = edges_add(&scratch->edges, b, 1);
    if (status != ISO_OK)
        iso_region_clear(out);
    return status;
}

iso_status iso_region_clean(iso_region *out, const iso_region *in, iso_fill_rule rule,
                            iso_planar_scratch *scratch) {
    static iso_face_rule *const face_rule[] = {is_positive, is_nonzero, is_odd};
    if ((unsigned)rule > ISO_FILL_EVEN_ODD)
        return iso_fail(ISO_USAGE, "no fill rule has the number %d", (int)rule);
    ISO_TRY(load(out, in, NULL, scratch));
    return planar_resolve(&(iso_choice){out, face_rule[rule], NULL}, 1, scratch);
}

iso_status iso_boolean(iso_region *out, iso_boolean_kind kind, const iso_region *a,
                       const iso_region *b, iso_planar_scratch *scratch) {
    static iso_face_rule *const face_rule[] = {in_union, in_both, in_difference, in_one};
    if ((unsigned)kind > ISO_EXCLUSIVE)
        return iso_fail(ISO_USAGE, "no boolean has the number %d", (int)kind);
    ISO_TRY(load(out, a, b, scratch));
    return planar_resolve(&(iso_choice){out, face_rule[kind], NULL}, 1, scratch);
}

/* Groups one after the other, and what of a group is printed before what. */
#include "path/ordering.h"

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
    int32_t closed = 0, chained = 0;
    for (int32_t k = fill.begin; k < fill.end; k++) {
        closed += ordering_path(o, k)->closed;
        chained += ordering_path(o, k)->follows;
    }
    return closed > (fill.end - fill.begin) / 4 && !chained ? ordering_nearest(o, fill)
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
        iso_start best = {INT64_MAX, 0, 0};
        int32_t chosen = -1;
        for (int32_t g = 0; g < groups; g++) {
            if (done >> g & 1)
                continue;
            iso_run r = entries(o, group[g]);
            int64_t before = best.distance;
            for (int32_t k = r.begin; k < r.end && groups - n > 1; k++)
                ordering_look_at_starts(&best, o, k);
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
        starts += ordering_count_starts(o, entries(o, group[g]));
    if (starts > INT32_MAX)
        return ordering_too_many();
    iso_candidate *candidate;
    iso_nearest nearest;
    ISO_TRY(ISO_PUSH(candidate, o->scratch, starts));
    for (int32_t g = 0; g < groups; g++) {
        iso_run r = entries(o, group[g]);
        for (int32_t k = r.begin; k < r.end; k++)
            n += ordering_list_starts(candidate + n, o, k, g);
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
iso_status ordering_groups(iso_ordering *o) {
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
    return groups <= ORDERING_FEW ? order_few_groups(o, group, groups)
                                  : order_many(o, group, groups);
}

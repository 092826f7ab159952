/* Inside of the ordering: a layer's paths by group and phase, and how they are copied out. */
#ifndef ISO_PATH_ORDERING_H
#define ISO_PATH_ORDERING_H

#include "path/nearest.h"
#include "path/order.h"

/* What of a group is printed before what. */
typedef enum iso_phase {
    PHASE_SKIRT,
    PHASE_SUPPORT,
    PHASE_INTERFACE,
    PHASE_EARLY_FILL,
    PHASE_WALLS,
    PHASE_FILL,
    PHASE_IRONING,
    PHASE_REST
} iso_phase;

typedef struct iso_order_key {
    int32_t object, group, phase, rank, path;
} iso_order_key;

enum {
    ORDERING_ENDS = 16,
    ORDERING_FEW = 8 /* paths, or groups, are looked through one by one; a grid would cost more to
                        fill */
};

/* A run of keys; one level of the hierarchy group > phase > rank > path. */
typedef struct iso_run {
    int32_t begin, end;
} iso_run;

typedef struct iso_ordering {
    const iso_paths *in;
    iso_paths *out;
    iso_arena *scratch;
    const iso_order_options *options;
    iso_seams *seams;
    iso_travel_cost cost;         /* of travels within a group */
    iso_point end[ORDERING_ENDS]; /* where the fill of a group had best end, if that matters */
    int32_t ends;
    iso_point position;
    iso_order_key *key;
    int32_t count;
    iso_seam_place *seam; /* [in->count] where each path begins, if that is decided */
    uint8_t *placed;      /* [in->count] is it? */
} iso_ordering;

static inline const iso_path *ordering_path(const iso_ordering *o, int32_t k) {
    return &o->in->path[o->key[k].path];
}

static inline const iso_path_vertex *ordering_vertex(const iso_ordering *o, int32_t k) {
    return o->in->vertex + ordering_path(o, k)->first;
}

/* Copy path `k` out, from vertex `start` on: an open one is reversed if that is its end. */
void ordering_emit(iso_ordering *o, int32_t k, int32_t start);

/* Copy a closed path out, from its seam on, which becomes a vertex. */
void ordering_emit_from(iso_ordering *o, int32_t k, iso_seam_place seam);

/* Paths of any kind, the one that begins nearest next; ties go to the path, then the vertex, that
 * came first. */
iso_status ordering_nearest(iso_ordering *o, iso_run r) ISO_MUST_CHECK;

/* Paths by a tour, in which closed ones stand where their first vertex is, and chains of paths that
 * follow each other count as one. */
iso_status ordering_tour(iso_ordering *o, iso_run r) ISO_MUST_CHECK;

/* A vertex at which a path may begin: of open ones both ends, of those whose seam is decided that
 * alone. Candidates' owners are the caller's, their names are vertices. */
typedef struct iso_start {
    int64_t distance;
    int32_t key, vertex;
} iso_start;

int64_t ordering_count_starts(const iso_ordering *o, iso_run r);
int32_t ordering_list_starts(iso_candidate *candidate, const iso_ordering *o, int32_t k,
                             int32_t owner);
void ordering_look_at_starts(iso_start *best, const iso_ordering *o, int32_t k);

iso_status ordering_too_many(void);

/* All of the layer, group by group. */
iso_status ordering_groups(iso_ordering *o) ISO_MUST_CHECK;

/* The walls of one group: walls.c. */
iso_status ordering_walls(iso_ordering *o, iso_run walls) ISO_MUST_CHECK;

/* Choose the seams of all external walls that don't depend on where the nozzle comes from. */
iso_status ordering_choose_seams(iso_ordering *o) ISO_MUST_CHECK;

#endif

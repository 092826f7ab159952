/* What all slicing has in common: crossings of all levels at once, and their orbits. */
#ifndef ISO_SLICE_ORBITS_H
#define ISO_SLICE_ORBITS_H

#include "base/memory.h"

/* lb(v) is the first level at or above vertex v; a dart crosses the levels lb(org) .. lb(dst) - 1
 * upwards. */
typedef struct orbits {
    int32_t triangle_count, level_count;
    const int32_t *origin;  /* [3 triangle_count] */
    const int32_t *lb;      /* [vertex]; no longer needed behind orbits_prepare */
    int64_t *first;         /* [level + 1] crossings of each level */
    int32_t *dart;          /* [crossing] level by level, ascending within one */
    uint64_t *passed;       /* a bit a dart: walked already, on the level at hand */
    int32_t *level_first;   /* [level + 1] contours of each level: the caller's from here on */
    int64_t *contour_first; /* [contour + 1] crossings of each contour */
    int32_t contour_count;
    int64_t contour_capacity, crossing_count;
} orbits;

/* Count the crossings of every level and deal their darts out to them. */
iso_status orbits_prepare(orbits *o) ISO_MUST_CHECK;
/* Room to walk; may come later, for there is less to keep by then. */
iso_status orbits_prepare_walk(orbits *o) ISO_MUST_CHECK;
/* Begin a contour at crossing `at`. */
iso_status orbits_add_contour(orbits *o, int64_t at) ISO_MUST_CHECK;
/* All but the contours. */
void orbits_release(orbits *o);

static inline void orbits_pass(orbits *o, int32_t dart) {
    o->passed[dart >> 6] |= 1ull << (dart & 63);
}

/* Walk an orbit of a level from dart `start`: pass its darts, note its crossings from number `at`
 * on and return the number behind them. */
typedef int64_t orbit_walk(void *payload, orbits *o, int32_t start, int32_t level, int64_t at);

/* Walk every orbit of a level. */
static inline iso_status orbits_walk_level(orbits *o, int32_t level, orbit_walk *walk,
                                           void *payload) {
    int64_t begin = o->first[level], end = o->first[level + 1], at = begin;
    for (int64_t q = begin; q < end && at < end; q++) {
        int32_t a = o->dart[q];
        if (o->passed[a >> 6] >> (a & 63) & 1)
            continue;
        at = walk(payload, o, a, level, at);
        ISO_TRY(orbits_add_contour(o, at));
    }
    for (int64_t q = begin; q < end; q++)
        o->passed[o->dart[q] >> 6] = 0;
    o->level_first[level + 1] = o->contour_count;
    return ISO_OK;
}

#endif

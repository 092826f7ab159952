/* An arrangement: a planar map as a double-link whose faces carry winding numbers (paper, 4.1.4).
 *
 * Edges are chains: polylines from junction to junction, so that a contour nothing touches is a
 * single one, closed at its lowest leftmost point. Dart 2 c runs along chain c, dart 2 c + 1
 * against it.
 *
 *     beta(d)      counter-clockwise next dart around the junction d starts from      ccw[d]
 *     opposite(d)  the same chain from its other end                                  d ^ 1
 *     alpha(d)     next dart along the face on the left                               cw[d ^ 1]
 *
 * alpha beta alpha beta = 1; face, a projection, is constant along alpha; origin along beta.
 * winding, a projection of the faces, has one entry for each operand. */
#ifndef ISO_PLANAR_ARRANGEMENT_H
#define ISO_PLANAR_ARRANGEMENT_H

#include "planar/edges.h"
#include "planar/snap.h"

typedef struct iso_winding {
    int32_t of[OPERANDS_MAX]; /* by operand */
} iso_winding;

typedef struct iso_arrangement {
    int32_t chain_count;
    int32_t *chain_first; /* [chain_count + 1] chain c: point[chain_first[c]] to [chain_first[c + 1]
                             - 1], both junctions included */
    iso_point *point;
    iso_winding *multiplicity; /* [chain_count] left less right; all zero: the chain is dead */
    int32_t *lowest;           /* [chain_count] index into point of its lexicographic least */

    int32_t junction_count;
    iso_point *junction;

    int32_t *origin; /* [2 chain_count] junction of each dart; -1 if its chain is dead */
    int32_t *ccw, *cw;
    int32_t *face;         /* [2 chain_count] */
    int32_t *around_first; /* [junction_count + 1] */
    int32_t *around;       /* living darts of each junction, counter-clockwise from straight down */

    int32_t face_count;   /* face 0 is the unbounded one */
    iso_winding *winding; /* [face_count] */
} iso_arrangement;

/* Snap-round the edges and build it all in the arena. *collisions as of snap_round. */
iso_status arrange(iso_arrangement *arrangement, iso_edges *edges, int64_t *collisions,
                   iso_snap_room *room, iso_arena *arena) ISO_MUST_CHECK;

/* Every equation of the double-link, and left less right = multiplicity across each chain. */
iso_status arrangement_validate(const iso_arrangement *arrangement) ISO_MUST_CHECK;

static inline iso_point dart_start(const iso_arrangement *a, int32_t dart) {
    int32_t chain = dart >> 1;
    return a->point[dart & 1 ? a->chain_first[chain + 1] - 1 : a->chain_first[chain]];
}

/* The point after the start, which gives the dart its direction. */
static inline iso_point dart_second(const iso_arrangement *a, int32_t dart) {
    int32_t chain = dart >> 1;
    return a->point[dart & 1 ? a->chain_first[chain + 1] - 2 : a->chain_first[chain] + 1];
}

static inline int32_t dart_alpha(const iso_arrangement *a, int32_t dart) {
    return a->cw[dart ^ 1];
}

#endif

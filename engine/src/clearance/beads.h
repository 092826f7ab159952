/* All beads so far, and which of them lie in a box.
 *
 * A bead takes 40 bytes. Runs of neighbours share a box; of the boxes Embree makes trees, each at
 * least twice as large as the next, so that a box goes into few of them while beads come in. Trees
 * are made when somebody asks: a print in which nothing is doubtful has none. */
#ifndef ISO_CLEARANCE_BEADS_H
#define ISO_CLEARANCE_BEADS_H

#include "clearance/clearance.h"
#include "solid/tree.h"

enum { BEADS_TREES = 32, BEADS_BLOCK = 2048 };

/* Places in iso_units, width and height in micrometres; of normals x and y in 32767ths, and whether
 * z is below 0 as the highest bit of width, at `from`, or height. */
typedef struct bead_packed {
    int32_t from[3], to[3];
    int16_t from_normal[2], to_normal[2];
    uint16_t width, height;
    uint32_t move;
} bead_packed;

/* A box of beads and a box that was asked for. */
typedef struct beads_pair {
    int32_t box, query;
} beads_pair;

typedef struct bead_store {
    int64_t count, block_capacity;
    bead_packed **block; /* of BEADS_BLOCK each, so that none is moved or kept in vain */
    int32_t box_count;   /* of runs of beads; the last run may still grow */
    int64_t box_capacity, first_capacity;
    float *box;             /* [6 box_count] least x y z, largest x y z */
    int64_t *first;         /* [box_count + 1] beads of each run */
    double low[3], high[3]; /* of all */

    const solid_table *table; /* NULL until asked for */
    int tree_count;
    solid_tree *tree[BEADS_TREES];
    int32_t tree_first[BEADS_TREES + 1]; /* boxes of each */
    beads_pair *pair;
    int64_t pair_capacity;
} bead_store;

void beads_free(bead_store *beads);
int64_t beads_bytes(const bead_store *beads); /* without Embree's */

/* ISO_OUTSIDE: beyond ISO_COORDINATE_MAX. */
iso_status beads_add(bead_store *beads, const clearance_move *move, int64_t index) ISO_MUST_CHECK;
clearance_move beads_get(const bead_store *beads, int64_t i);
int64_t beads_move(const bead_store *beads, int64_t i); /* that left it */

/* May bead i meet a box? For sure not, if not: without unpacking it. */
bool beads_near(const bead_store *beads, int64_t i, const float box[6]);

/* The box around a bead. */
void beads_box(double low[3], double high[3], const clearance_move *bead);

/* Boxes of beads that meet those of box[6 count], by query, then by box. The array is the beads'
 * own, until the next call. */
iso_status beads_find(const beads_pair **pair, int64_t *pair_count, bead_store *beads,
                      const float *box, int32_t count) ISO_MUST_CHECK;

#endif

/* Contours of samples in a plane, by the up-crossing rule on squares (theta^4 = 1).
 *
 * Nodes have values; four nodes around are a square with corners 0 to 3, counter-clockwise, and a
 * dart goes from each corner to the next. Crossings are the darts { a : h(a) <= 0 < h(theta a) }.
 * A curve comes into a square by such a dart and leaves it by one that falls, whose opposite in the
 * neighbouring square rises: so the successor is found without a search, and each edge of the grid
 * is crossed by one curve at most. Where two darts of a square rise the mean of its corners tells
 * which of the two that fall comes next. What is at most 0 lies left of the curves. Zero counts as
 * below: no corner is ever met. */
#ifndef ISO_LATTICE_CONTOUR_H
#define ISO_LATTICE_CONTOUR_H

#include <stdint.h>

#include "base/memory.h"

typedef struct contour_row {
    const double *value; /* [columns] finite */
    const double *extra; /* [columns] something to be had at the crossings as well, or NULL */
} contour_row;

typedef struct contour_grid {
    int32_t columns, rows; /* of nodes, at least 1 */
    const uint8_t *square; /* [(columns - 1) (rows - 1)] 0: not to be looked at, so that curves end
                            * at its sides; NULL: all are */
    void (*row)(contour_row *row, void *context, int32_t j); /* rows in turn; the one before is
                                                              * still wanted */
    void *context;
} contour_grid;

typedef struct contour_crossing {
    double x, y, extra; /* x, y in steps of the grid */
    int32_t square;     /* that the curve comes into here */
    int32_t next;       /* crossing where it leaves that; -1: the curve ends here */
    uint8_t entered, walked;
} contour_crossing;

enum { CONTOUR_BLOCK = 4096 };

typedef struct contour {
    contour_crossing **block; /* of CONTOUR_BLOCK crossings each */
    int32_t count;
    int32_t cursor, pass; /* of contour_start */
} contour;

static inline contour_crossing *contour_at(const contour *c, int32_t i) {
    return &c->block[i / CONTOUR_BLOCK][i % CONTOUR_BLOCK];
}

/* All in `scratch`. */
iso_status contour_trace(contour *out, const contour_grid *grid, iso_arena *scratch) ISO_MUST_CHECK;

/* Curve after curve, open ones first: the crossing that it starts with, or -1 after the last. Each
 * has to be walked before the next is asked for. */
int32_t contour_start(contour *c, int *closed);

/* The crossing *i, and on to the next; NULL after the curve's last. */
static inline const contour_crossing *contour_step(const contour *c, int32_t *i) {
    contour_crossing *at = *i >= 0 ? contour_at(c, *i) : NULL;
    if (!at || at->walked)
        return NULL;
    at->walked = 1;
    *i = at->next;
    return at;
}

#endif

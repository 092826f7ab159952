/* The edges of an arrangement while it is snap-rounded.
 *
 * Slot s is the directed edge from[s] -> to[s]; successor[s] follows it on its contour. An edge
 * that is split dies and names the first of its pieces as its replacement; its pieces get new
 * slots, so that a grid built earlier stays right about all edges that still live. A vertex is
 * named by the slot that starts there. */
#ifndef ISO_PLANAR_EDGES_H
#define ISO_PLANAR_EDGES_H

#include <stdbool.h>

#include <isoslice/planar.h>

#include "base/memory.h"

enum {
    EDGE_DEAD = 1,
    EDGE_SHARED_START = 2, /* other edges meet the vertex that starts this one */
    EDGE_VISITED = 4,
    EDGE_OPERAND_SHIFT = 4,
    EDGE_OPERAND = 3 << EDGE_OPERAND_SHIFT /* which operand it belongs to */
};

enum { OPERANDS_MAX = 4 };

typedef struct iso_edges {
    int32_t count;
    iso_point *from, *to;
    int32_t *successor; /* of a dead edge: its replacement */
    uint8_t *flags;
    int64_t capacity;
} iso_edges;

void edges_free(iso_edges *edges);

/* Append the contours of a region, without points repeated in a row. ISO_OUTSIDE if a coordinate
 * exceeds ISO_COORDINATE_MAX. */
iso_status edges_add(iso_edges *edges, const iso_region *region, int operand) ISO_MUST_CHECK;

/* The same for the raw contours of an offset, which may swing out beyond the range of what comes of
 * them: up to twice ISO_COORDINATE_MAX, for which the predicates have bits to spare. */
iso_status edges_add_raw(iso_edges *edges, const iso_region *raw) ISO_MUST_CHECK;

/* Append an unlinked edge. */
iso_status edges_push(iso_edges *edges, iso_point from, iso_point to, uint8_t flags) ISO_MUST_CHECK;

/* The living edge that starts where `slot` starts. */
static inline int32_t edges_living(const iso_edges *edges, int32_t slot) {
    while (edges->flags[slot] & EDGE_DEAD)
        slot = edges->successor[slot];
    return slot;
}

static inline int32_t edges_next(const iso_edges *edges, int32_t slot) {
    return edges_living(edges, edges->successor[slot]);
}

#endif

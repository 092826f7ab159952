/* The nearest of a set of points of which more and more are taken away: a uniform grid, rebuilt
 * coarser as it empties. */
#ifndef ISO_PATH_NEAREST_H
#define ISO_PATH_NEAREST_H

#include <isoslice/geometry.h>

#include "base/memory.h"

typedef struct iso_candidate {
    iso_point at;
    int32_t owner; /* points are taken away by owner */
    int32_t name;  /* whatever the caller wants to know it by */
} iso_candidate;

typedef struct iso_nearest {
    iso_candidate *candidate; /* [count], sorted by cell; the living ones first in each */
    iso_candidate *spare;     /* [count], for the sort */
    int32_t *cell_of;         /* [count], for the sort */
    int32_t *first;           /* [columns * rows + 1] */
    int32_t *living;          /* [columns * rows] candidates not yet known to be taken */
    uint8_t *taken;           /* [owners] */
    int32_t count, owners;
    int32_t left;   /* living candidates, those of taken owners excepted */
    int32_t *share; /* [owners] candidates an owner has */
    int32_t columns, rows, size;
    iso_point origin;
} iso_nearest;

/* Take over `candidate`, which stays the caller's memory; everything is pushed on scratch. Owners
 * are numbered 0 .. owners - 1. */
iso_status iso_nearest_build(iso_nearest *nearest, iso_candidate *candidate, int32_t count,
                             int32_t owners, iso_arena *scratch) ISO_MUST_CHECK;

/* NULL if none is left. Of equally near ones the lowest owner, then the lowest name. */
const iso_candidate *iso_nearest_find(iso_nearest *nearest, iso_point from);

/* Take all points of an owner away. */
void iso_nearest_take(iso_nearest *nearest, int32_t owner);

#endif

/* The edges of a region by the rows that they pass, to see what is inside or near. */
#ifndef ISO_SHELL_ROWS_H
#define ISO_SHELL_ROWS_H

#include <stdbool.h>

#include <isoslice/planar.h>

#include "base/memory.h"

typedef struct iso_row_edge {
    iso_point from, to;
} iso_row_edge;

typedef struct iso_rows {
    int32_t low, height, count; /* row i: from low + i height on */
    int32_t *first;             /* [count + 1] */
    iso_row_edge *edge;         /* [first[count]] those of each row; long ones are in several */
} iso_rows;

/* In the arena. */
iso_status rows_of(iso_rows *rows, const iso_region *region, iso_arena *arena) ISO_MUST_CHECK;

/* Is the point inside, or no further than that from an edge? */
bool rows_reach(const iso_rows *rows, iso_point p, int32_t distance);

#endif

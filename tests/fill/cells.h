/* Random regions made of cells of a grid: horizontal edges, collinear points, contours that touch
 * in corners, islands in holes. All of it exact, and made without the planar kernel. */
#ifndef TESTS_FILL_CELLS_H
#define TESTS_FILL_CELLS_H

#include <isoslice/planar.h>

enum { CELLS = 12 };

typedef struct cells {
    char full[CELLS + 2][CELLS + 2]; /* [y][x], a frame of empty cells around */
} cells;

cells cells_random(unsigned seed, int percent);

/* Cell corners (x, y) go to (a x - b y, b x + a y), a turn with a scale. Append to `region`. */
void cells_region(iso_region *region, const cells *grid, int a, int b);

#endif

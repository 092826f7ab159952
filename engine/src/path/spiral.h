/* A spiral: a layer's only loop, rising from the layer below to its own height, so that there is no
 * seam. */
#ifndef ISO_PATH_SPIRAL_H
#define ISO_PATH_SPIRAL_H

#include <stdbool.h>

#include <isoslice/path.h>

/* Make the loop an open path that rises by `height` units to z = 0 and ends where it began. With
 * `from` it begins there instead of at its first vertex: where the loop below ended. `starts`: what
 * is below is flat, so that the bead grows from nothing. Unless the paths are one closed external
 * perimeter they stay as they are, and *done is false. */
iso_status path_spiral(bool *done, iso_paths *paths, const iso_point *from, int32_t height,
                       bool starts) ISO_MUST_CHECK;

#endif

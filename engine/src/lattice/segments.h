/* Distance from line segments on the samples of a cube that repeats. Lengths are steps of the grid.
 */
#ifndef ISO_LATTICE_SEGMENTS_H
#define ISO_LATTICE_SEGMENTS_H

#include <stdint.h>

#include <isoslice/status.h>

typedef struct iso_segment {
    float from[3], way[3]; /* from one end to the other; not both ends in one point */
} iso_segment;

/* distance: [size^3]; `size` a power of two, 16 or more. The segments are those of one period; one
 * that leaves it on one side isn't given again on the other. At least one; none longer than
 * `size`. */
iso_status distance_from_segments(float *distance, int32_t size, const iso_segment *segment,
                                  int32_t count) ISO_MUST_CHECK;

#endif

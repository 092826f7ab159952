/* Distances on the samples of a cube that repeats. Lengths are steps of the grid. */
#ifndef ISO_LATTICE_DISTANCE_H
#define ISO_LATTICE_DISTANCE_H

#include <stdint.h>

#include <isoslice/status.h>

/* What a field is known to satisfy, so that less needs to be computed. */
typedef enum iso_field_symmetry {
    ISO_FIELD_ANY,
    ISO_FIELD_EVEN, /* f(y, z, x) = f(x, y, z), and f = f half a period on along x, y and z */
    ISO_FIELD_ODD   /* the same, but -f half a period on */
} iso_field_symmetry;

/* In place: from a smooth field to the signed distance from the surface where it is 0. `size` a
 * side, a power of two from 16 to 256; waves of the field should be 16 steps long or more.
 * ISO_BAD_CONFIG: there is no such surface. */
iso_status distance_from_field(float *field, int32_t size,
                               iso_field_symmetry symmetry) ISO_MUST_CHECK;

#endif

/* Where a field takes a value on an edge. */
#ifndef ISO_SLICE_ROOTS_H
#define ISO_SLICE_ROOTS_H

#include <isoslice/field.h>

/* An edge that crosses a level: value[0] <= level < value[1]. */
typedef struct root_edge {
    iso_vec3 end[2];
    double value[2], slope[2]; /* slope: of F from end to end, at each of them */
    double level;
} root_edge;

enum { ROOTS_BLOCK = 256 };

/* point[count], no more than ROOTS_BLOCK of them. F is within 1e-7 mm of the level there, or jumps
 * across it. */
void roots_find(iso_vec3 *point, const iso_field *field, const root_edge *edge, int32_t count);

#endif

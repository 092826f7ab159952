/* How often closed shells turn around a point, by rays through a grid of columns. The fast and
 * simple way, for points that need not be told truly when they lie within rounding of the surface;
 * iso_solid_winding is the exact one. */
#ifndef ISO_SOLID_ENCLOSED_H
#define ISO_SOLID_ENCLOSED_H

#include "base/memory.h"
#include "solid/volume.h"

typedef struct enclosed_columns {
    const iso_vec3 *corner; /* of the triangles; not copied */
    double y, z, pitch_y, pitch_z;
    int32_t wide, high;
    int32_t *first, *triangle; /* triangle[first[c]] .. of column c = y + wide z */
} enclosed_columns;

iso_status enclosed_new(enclosed_columns *columns, const iso_vec3 *corner,
                        int64_t count) ISO_MUST_CHECK;
void enclosed_free(enclosed_columns *columns);

/* A volume_inside: payload is an enclosed_columns. Inside: the shells' turns don't cancel. */
iso_status enclosed_inside(void *payload, uint8_t *inside, const iso_vec3 *point, int64_t count);

#endif

/* Exact distances on a surface of triangles, which is known by the lengths of its edges alone. */
#ifndef ISO_HEIGHT_WAVES_H
#define ISO_HEIGHT_WAVES_H

#include <stdint.h>

#include <isoslice/status.h>

typedef struct wave_surface {
    int32_t triangle_count, vertex_count;
    const int32_t *origin;   /* [3 triangle_count] as an iso_mesh has them */
    const int32_t *opposite; /* [3 triangle_count] or -1 at a border */
    const double *length;    /* [3 triangle_count] of a dart's edge; the same for its opposite */
} wave_surface;

/* distance[vertex_count]: given where finite, found where infinite; those given may be lowered. On
 * an edge with two ends that are given distances are given as well, linear between them, and so
 * they are in a triangle with three. Where no given vertex is connected they stay infinite. */
iso_status waves_spread(double *distance, const wave_surface *surface) ISO_MUST_CHECK;

#endif

/* The Voronoi partition of points in a cube that repeats. */
#ifndef ISO_LATTICE_VORONOI_H
#define ISO_LATTICE_VORONOI_H

#include <stdint.h>

#include <isoslice/geometry.h>
#include <isoslice/status.h>

#include "lattice/segments.h"

/* How far a point next to the site is within the face: offset - normal . (point - site). */
typedef struct iso_voronoi_face {
    double normal[3], offset;
} iso_voronoi_face;

typedef struct iso_voronoi {
    int32_t count;          /* sites */
    double (*site)[3];      /* [count] in steps, 0 to the period */
    int32_t *first;         /* [count + 1] faces of a site */
    iso_voronoi_face *face; /* [first[count]] */
    iso_segment *edge;      /* [edge_count] each once */
    int32_t edge_count;
} iso_voronoi;

/* One site in each of the cells, cells along a side, 4 or more: at its middle, moved by up to half
 * of `jitter` cells each way. The period is `size`. */
iso_status voronoi_make(iso_voronoi *out, int32_t cells, double size, double jitter,
                        uint64_t seed) ISO_MUST_CHECK;
void voronoi_free(iso_voronoi *voronoi);

#endif

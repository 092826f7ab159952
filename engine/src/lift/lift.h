/* Lift: ordered paths of a layer's chart become paths in space.
 *
 * Each segment is cut up until it lies on the layer within a tolerance, and until neither normal
 * nor thickness turn much; a bead's cross-section becomes what keeps the volume it stands for: the
 * planar area times how much space the chart has there, over the length in space. Travels follow
 * the layer a clearance above it. */
#ifndef ISO_LIFT_LIFT_H
#define ISO_LIFT_LIFT_H

#include <isoslice/path.h>

#include "base/memory.h"
#include "chart/chart.h"

typedef struct lift_options {
    double r;           /* the field at the top of the layer: where the nozzle is */
    double thickness;   /* of the layer, in r */
    double z;           /* mm: the layer's nominal top, which z of vertices counts from */
    double tolerance;   /* mm */
    double turn;        /* radians: the normal turns by no more between vertices */
    double clearance;   /* mm above the layer, of travels */
    double slope;       /* tangent: the steepest that a layer may lie; 0: any */
    double least, most; /* mm: thickness of a bead; 0: any */
} lift_options;

/* Replaces what `out` held. ISO_OUTSIDE, naming the place: steeper, thinner or thicker than
 * allowed.
 */
iso_status lift_paths(iso_paths *out, const iso_paths *flat, const chart *chart,
                      const lift_options *options, iso_arena *scratch) ISO_MUST_CHECK;

#endif

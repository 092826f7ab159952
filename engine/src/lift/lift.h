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
    double thickness;   /* of the layer, in r: what beads of the flat paths are as high as */
    double z;           /* mm: the layer's nominal top, which z of vertices counts from */
    double tolerance;   /* mm that a line may be off the one it stands for */
    double turn;        /* radians: the normal turns by no more between vertices; 0: any */
    double clearance;   /* mm above the layer, of travels; of short ones less */
    double tip;         /* mm: half the nozzle's flat tip if it doesn't tilt with the layer: uphill
                         * it is lower than the layer, so travels are higher by that; 0: it does */
    bool arcs;          /* around a cylinder the machine draws arcs: lines lie on the layer */
    double near;        /* mm: shorter travels within a layer go straight, along the beads */
    double slope;       /* tangent: the steepest that a layer may lie; 0: any */
    double least, most; /* mm: thickness of a bead; 0: any */
    const iso_point *from; /* in the chart: where the nozzle comes from; NULL: unknown */
} lift_options;

/* Replaces what `out` held. Roles, tools, groups and order stay. Every travel, straight ones too,
 * gets its points, from one above where it begins to one above where the path begins; a near one
 * has the path's first vertex alone. travel_count 0: the way isn't known, or leads where the layer
 * doesn't reach. Scratch is left as it was found.
 *
 * ISO_OUTSIDE, naming the place: steeper, thinner or thicker than allowed. */
iso_status lift_paths(iso_paths *out, const iso_paths *flat, const chart *chart,
                      const lift_options *options, iso_arena *scratch) ISO_MUST_CHECK;

#endif

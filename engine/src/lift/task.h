/* A layer that is being lifted. */
#ifndef ISO_LIFT_TASK_H
#define ISO_LIFT_TASK_H

#include "lift/lift.h"
#include "lift/sample.h"

typedef struct lift_task {
    const iso_paths *flat;
    const chart *chart;
    const lift_options *options;
    sample_limits limits; /* of beads */
    bool arcs;            /* are drawn from vertex to vertex */
    samples samples;      /* of beads: path by path, those without vertices have none */
    double *length;       /* [samples] mm in the chart of the piece that begins there */
    int64_t *chosen;      /* [samples] those of a path that become its vertices */
    double *rise;         /* [samples] mm that the layer is above the line from each of those */
    iso_arena *arena;
} lift_task;

/* `height` mm above a point of the layer: along z where layers are heights, so that x and y stay
 * what they are, else across the layer. */
iso_vec3 lift_above(const lift_task *task, const chart_point *on, double height);

/* Points of all travels between the paths that `out` has. */
iso_status lift_travels(iso_paths *out, lift_task *task) ISO_MUST_CHECK;

#endif

/* The inside of an iso_porous: a part that is a lattice, known at every point by its distances. */
#ifndef ISO_LATTICE_PART_H
#define ISO_LATTICE_PART_H

#include <isoslice/porous.h>

#include "lattice/analysis.h"
#include "lattice/lattice.h"
#include "lattice/sizes.h"
#include "solid/volume.h"

/* A thread's rows. */
typedef struct iso_part_scratch {
    double *distance, *half, *depth;
    iso_vec3 *point;
    int64_t distance_capacity, half_capacity, depth_capacity, point_capacity;
} iso_part_scratch;

struct iso_porous {
    iso_porous_options options;
    iso_lattice *lattice;
    int32_t has_sides;
    iso_volume *surface; /* distance to the part's surface */
    double known;        /* mm; so deep, and deeper, it is this */
    iso_vec3 min, max;   /* of the part */
    double part_volume, part_area;
    double *drain_top; /* [drain_count] mm; holes end there */
    iso_pool *pool;
    iso_part_scratch *scratch; /* [threads of the pool] */
    double cell;
    iso_sizes sizes;
    iso_porous_kind kind;
    iso_body body;
    iso_lattice_run *run; /* loose pieces */
    int64_t run_count;
    double stage_from, stage_to; /* of the progress, 0 to 1 */
    const char *stage;
};

/* body_sample; payload is the iso_porous. */
iso_status part_sample(void *payload, float *material, float *part, const iso_body_row *row,
                       int worker);

/* The grid's own steps decide how deep the distance to the surface must be known. */
iso_status part_find_surface(iso_porous *porous, const iso_mesh *mesh, int32_t count,
                             double step) ISO_MUST_CHECK;
iso_status part_find_drains(iso_porous *porous) ISO_MUST_CHECK;

void part_progress(void *porous, double done);

#endif

/* A body of voxels, counted and measured plane by plane: how much there is of it, how large its
 * surface is, of how many pieces it and its pores are. */
#ifndef ISO_LATTICE_ANALYSIS_H
#define ISO_LATTICE_ANALYSIS_H

#include <isoslice/geometry.h>
#include <isoslice/lattice.h>
#include <isoslice/status.h>

#include "base/parallel.h"
#include "lattice/label.h"

/* Points along x: first, first + step, ... */
typedef struct iso_body_row {
    iso_vec3 first;
    double step;
    int32_t count;
    int32_t j, k;  /* of the body's grid; -1: not of it */
    int32_t exact; /* distances deep inside and far outside count too, not their signs alone */
} iso_body_row;

/* Distances in mm, negative inside: to the surface of the material, and to that of the part that
 * it fills; both known to about 3 steps at least;
 * there is no material outside the part. Any number of threads at once; worker is below
 * the number of the pool's threads. */
typedef iso_status body_sample(void *payload, float *material, float *part, const iso_body_row *row,
                               int worker);

typedef struct iso_body {
    iso_vec3 min; /* middle of voxel 0 */
    double voxel;
    int32_t size[3]; /* voxels; those of the border must be outside the part */
    double skin;     /* mm; what is deeper in the part is its core */
    double swell; /* mm; to tell what is connected, material is so much thicker on all sides: walls
                   * thinner than a voxel have holes in a grid, though not in truth */
    body_sample *sample;
    void *payload;
} iso_body;

typedef struct iso_body_counts {
    int64_t part, material, core, core_material; /* voxels */
    double part_share;            /* voxels: those of the part's border count by what is within */
    double surface, pore_surface; /* mm^2; the second within the part */
    int64_t pieces, closed_pores, closed_voxels;
    int64_t kept;     /* pieces: the largest of each connected body of the part */
    iso_piece *loose; /* [loose_count] the others, in a fixed order; free with iso_release */
    int64_t loose_count;
    int64_t unlisted, unlisted_voxels; /* loose ones that are too many to be listed */
} iso_body_counts;

typedef void body_progress(void *payload, double done);

iso_status body_count(iso_body_counts *counts, const iso_body *body, iso_pool *pool,
                      body_progress *progress, void *payload) ISO_MUST_CHECK;

/* The voxels of loose pieces, found again from their seeds, as runs in order. Pieces whose boxes
 * have more than `most` voxels together are left out and counted. */
iso_status body_loose_runs(iso_lattice_run **run, int64_t *count, int64_t *left,
                           const iso_body *body, const iso_body_counts *counts,
                           int64_t most) ISO_MUST_CHECK;

#endif

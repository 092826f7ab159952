/* The lattice's samples on one layer's grid, where the region is. */
#ifndef ISO_LATTICE_SAMPLES_H
#define ISO_LATTICE_SAMPLES_H

#include "lattice/raster.h"
#include "lattice/slice.h"

typedef struct samples {
    raster raster;      /* against the region */
    int32_t period;     /* rows that are kept: the grid's repeats after so many, or all */
    int32_t has_sides;  /* a sheet */
    float *distance;    /* [period columns] mm, sides' sign kept; far away outside the region */
    float *half;        /* [period columns] mm; finite */
    double thin, thick; /* least and greatest half where the region is and there is material */
    const iso_lattice *lattice;
    iso_lattice_plane plane;
    int32_t repeats; /* along rows too: the lattice is the same in every period */
} samples;

/* Mm for what is void or solid altogether, and for what isn't asked. */
#define SAMPLES_FAR 1e6

/* mm between samples, if the slice doesn't say: for the lines in the middle of sheets, or for the
 * sections of whatever there is. */
double samples_line_step(const iso_lattice_slice *slice);
double samples_section_step(const iso_lattice_slice *slice);

/* Everything is in `scratch`. `step` mm or a little less, `reach` as in raster_make. */
iso_status samples_take(samples *out, const iso_region *region, const iso_lattice_slice *slice,
                        double step, double reach, iso_arena *scratch) ISO_MUST_CHECK;

static inline const float *samples_distance(const samples *s, int32_t j) {
    return s->distance + (int64_t)(j % s->period) * s->raster.columns;
}

static inline const float *samples_half(const samples *s, int32_t j) {
    return s->half + (int64_t)(j % s->period) * s->raster.columns;
}

/* What part of a square of the grid is material, 0 to 1. */
double samples_share(const samples *s, int32_t i, int32_t j);

/* Of one period, sampled more finely than the lines need it; `repeats` must be so. */
iso_status samples_period_share(double *share, const samples *s, iso_arena *scratch) ISO_MUST_CHECK;

#endif

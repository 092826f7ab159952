/* A model on its way through the stages, with what each of them made kept for the next. */
#ifndef TESTS_BENCH_PART_H
#define TESTS_BENCH_PART_H

#include <isoslice/config.h>

#include "layer.h"

typedef struct bench_part {
    const char *path;
    const iso_options *options;
    iso_mesh mesh; /* in its place on the bed */
    iso_levels levels;
    iso_slices slices;
    int32_t top, bottom; /* neighbours that the shells look at */
    iso_layer *layer;    /* [levels.count] outlined; filled too once part_fill was there */
    iso_hand hand;
} bench_part;

/* Options that slicers are compared with: 0.2 mm layers, two walls, 0.45 mm beads, rectilinear fill
 * of `density` percent, on a bed large enough for every model. */
void part_options(iso_options *options, double density);

/* Read, place, slice and outline. */
void part_load(bench_part *part, const char *path, const iso_options *options);

/* Outlines around a layer, as its shells need them; `region` has room for all of them. */
iso_shell_neighbours part_around(const bench_part *part, int32_t index, const iso_region **region);

/* Fill a layer, once. */
void part_fill(bench_part *part, int32_t index);

void part_free(bench_part *part);

#endif

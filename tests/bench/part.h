/* A model on its way through the stages, with what each of them made kept for the next. */
#ifndef TESTS_BENCH_PART_H
#define TESTS_BENCH_PART_H

#include <isoslice/config.h>

#include "window.h"

typedef struct bench_part {
    const char *path;
    const iso_options *options;
    iso_mesh mesh; /* in its place on the bed */
    iso_levels levels;
    iso_slices slices;
    iso_window window; /* of all layers: outlined; filled too once part_fill was there */
    iso_hand hand;
} bench_part;

/* Options that slicers are compared with: 0.2 mm layers, two walls, 0.45 mm beads, rectilinear fill
 * of `density` percent, on a bed large enough for every model. */
void part_options(iso_options *options, double density);

/* Read, place, slice and outline. */
void part_load(bench_part *part, const char *path, const iso_options *options);

/* Fill a layer, once. */
void part_fill(bench_part *part, int32_t index);

void part_free(bench_part *part);

#endif

/* The curved layers of one object: the field whose levels they are, and the chart that lays them
 * flat. Flat layers have neither. */
#ifndef ISO_CURVED_H
#define ISO_CURVED_H

#include <isoslice/config.h>
#include <isoslice/object.h>
#include <isoslice/report.h>
#include <isoslice/slice.h>

#include "chart/chart.h"
#include "chart/spread.h"
#include "lift/lift.h"

/* Zero-initialise. */
typedef struct iso_curved {
    iso_field *field; /* NULL: layers are flat */
    chart *chart;
    spread spread;    /* whether layers merge where the field crowds them */
    double low, high; /* of the field on the object's meshes; heights of levels count from `low` */
    iso_vec3 box[2];  /* of the object, and of beads that stand out of it */
    double thinnest;  /* of the layers, in F */
    double margin;    /* mm that a chart which wraps shows beyond its ends */
} iso_curved;

/* By the options; stays zeroed if layers are flat. Warnings go into the report. ISO_BAD_CONFIG: no
 * such field, or not for printing; ISO_OUTSIDE: the machine can't print it. */
iso_status curved_new(iso_curved *curved, iso_report *report, const iso_options *options,
                      const iso_object *object) ISO_MUST_CHECK;
void curved_free(iso_curved *curved);

/* degrees that fields made to measure keep to: field_slope, and what the nozzle can do. */
double curved_steepest(const iso_options *options);

static inline bool curved_is_flat(const iso_curved *curved) {
    return !curved->field;
}

/* Levels from the lowest value to the highest, the last one ending there: all but a first one on
 * the bed are made a little thicker or thinner for it. */
iso_status curved_levels(iso_levels *levels, iso_curved *curved,
                         const iso_options *options) ISO_MUST_CHECK;

/* A mesh's slices, in the chart. */
iso_status curved_slice(iso_slices *slices, const iso_curved *curved, const iso_mesh *mesh,
                        const iso_levels *levels) ISO_MUST_CHECK;

/* mm^3 of a level. */
iso_status curved_volume(double *volume, const iso_curved *curved, const iso_slices *slices,
                         const iso_levels *levels, int32_t level,
                         iso_arena *scratch) ISO_MUST_CHECK;

/* Paths of a level, unordered, cut to what the chart shows once; `spare` is room for them. */
iso_status curved_clip(iso_paths *paths, iso_paths *spare, const iso_curved *curved,
                       iso_arena *scratch) ISO_MUST_CHECK;

/* As many layers of different thickness may end at a level: 1 unless layers merge. */
int32_t curved_merges(const iso_curved *curved, int32_t level);

/* Level whose paths the k-th of them has, from 0: at most curved_behind() levels below. */
int32_t curved_source(const iso_curved *curved, int32_t level, int32_t k);
int32_t curved_behind(const iso_curved *curved);

/* Those of its paths, unordered, that are printed as the k-th of them; *part may be `paths`. */
iso_status curved_part(const iso_paths **part, iso_paths *room, const iso_curved *curved,
                       const iso_paths *paths, const int32_t level_k[2],
                       iso_arena *scratch) ISO_MUST_CHECK;

/* Ordered paths of a level into space; `from` as lift_options has it. */
iso_status curved_lift(iso_paths *out, const iso_curved *curved, const iso_paths *flat,
                       const lift_options *options, iso_arena *scratch) ISO_MUST_CHECK;
lift_options curved_lift_options(const iso_curved *curved, const iso_options *options,
                                 const iso_levels *levels, int32_t level, int32_t k);

#endif

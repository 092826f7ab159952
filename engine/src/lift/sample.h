/* Samples of lines on a layer: as many as it takes for straight pieces between them. */
#ifndef ISO_LIFT_SAMPLE_H
#define ISO_LIFT_SAMPLE_H

#include "base/memory.h"
#include "chart/chart.h"

/* What a piece between two samples may be like. */
typedef struct sample_limits {
    double layer[2];  /* r and thickness (chart_layer) */
    double tolerance; /* mm off the line on the layer, sideways */
    double bump;      /* mm that the layer may stand above or below the piece */
    double turn;      /* radians between the normals; 0: any */
    double share;     /* by which thickness and volume may differ, of themselves; 0: any */
} sample_limits;

/* Lines one after the other, each from sample to sample up to one that has `last`. */
typedef struct samples {
    int64_t count;
    iso_vec2 *flat;     /* [count] in the chart; across its ends not brought back */
    chart_point *point; /* [count] */
    int32_t *owner;     /* [count] what the piece that begins here belongs to; ~ that: none does */
    uint8_t *keep;      /* [count] is this where a piece may well begin or end? (sample_spread) */
} samples;

static inline bool sample_is_last(const samples *s, int64_t i) {
    return s->owner[i] < 0;
}

/* b - a the short way, where the chart wraps. */
iso_vec2 sample_step(const chart *map, iso_vec2 a, iso_vec2 b);

/* Is the straight line from sample i to j, on the same line, good enough? */
bool sample_fits(const samples *s, int64_t i, int64_t j, const chart *map,
                 const sample_limits *limits);

/* Points of all samples, and more samples until every piece keeps to the limits. flat and owner are
 * given; all arrays end up in the arena. */
iso_status sample_refine(samples *s, const chart *map, const sample_limits *limits,
                         iso_arena *arena) ISO_MUST_CHECK;

/* From samples that are close enough to those that are no closer than they need be: between the
 * ends of each owner's line they are put where each piece takes as much of what is allowed as every
 * other one. All samples stay; those and the ends are marked in `keep`. */
iso_status sample_spread(samples *s, const chart *chart, const sample_limits *limits,
                         iso_arena *arena) ISO_MUST_CHECK;

#endif

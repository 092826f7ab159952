/* What charts are made of inside chart/. */
#ifndef ISO_CHART_KIND_H
#define ISO_CHART_KIND_H

#include "chart/chart.h"
#include "field/field.h"

struct chart {
    chart_kind kind;
    const iso_field *field;

    /* graph */
    iso_vec3 middle; /* of the part */
    double value;    /* of the field there, and how fast it rises with z */
    double rise;
    double stride;     /* mm: no step of a search for z is longer */
    bool rises;        /* with z, everywhere in and around the part, for certain */
    double even_above; /* mm: from this z on it rises at the same rate at all places: there z
                        * follows without a search; infinite, if nowhere */
    double reach;      /* mm (chart_reach) */

    /* the others */
    iso_vec3 center, axis, from, across; /* axis, from and across are a right-handed frame */
    double radius;                       /* mm: where the chart doesn't stretch */
    double period;                       /* mm of u; 0: none */
};

/* Points of F = r, and with `thickness` above 0 the layer's means (chart_layer). */
iso_status graph_lift(chart_point *point, const chart *map, const iso_vec2 *flat,
                      const double layer[2], int64_t count) ISO_MUST_CHECK;
/* ISO_OUTSIDE: the field falls with z at one of these points. */
iso_status graph_check(const chart *map, const iso_vec3 *at, int64_t count) ISO_MUST_CHECK;
iso_status graph_volume(double *volume, const chart *map, const iso_slices *slices, int32_t level,
                        const double layer[2], iso_arena *scratch) ISO_MUST_CHECK;

/* chart_reach of a field that nothing is known of: by looking at layers between `range`. */
iso_status graph_reach(double *reach, const chart *chart, const iso_vec3 box[2],
                       const double range[2]) ISO_MUST_CHECK;

/* Of charts with formulas of their own. */
void round_down(iso_vec2 *flat, const chart *map, const iso_vec3 *at, int64_t count);
iso_status round_lift(chart_point *point, const chart *map, const iso_vec2 *flat,
                      const double layer[2], int64_t count) ISO_MUST_CHECK;

/* Contours of a level around the axis, cut open (chart_slices). */
iso_status unroll_slices(iso_slices *slices, const chart *map, const iso_curves *curves,
                         double margin) ISO_MUST_CHECK;

#endif

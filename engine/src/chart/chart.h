/* Charts: every layer F = r laid out flat, so that walls, shells and fill are planned as if it
 * were.
 *
 *     (x, y, z)  --chart_down-->  (u, v), r = F        --chart_lift-->  (x, y, z)
 *
 * One chart serves all layers, so that what lies above what is seen by u and v alone. A chart
 * stretches; chart_point says by how much, and the volume it keeps exactly: a patch du dv of the
 * layer from r to r + dr holds `volume` du dv dr mm^3.
 *
 *     graph       u, v = x, y; z is where F(x, y, z) = r: any field that rises with z
 *     cylinder    unrolled around the axis at one radius: u around, v along; u wraps
 *     sphere      the equal-area map around the direction straight up
 *     fan         u along the axis, v the distance from it */
#ifndef ISO_CHART_CHART_H
#define ISO_CHART_CHART_H

#include <stdbool.h>

#include <isoslice/field.h>
#include <isoslice/slice.h>

typedef enum chart_kind { CHART_GRAPH, CHART_CYLINDER, CHART_SPHERE, CHART_FAN } chart_kind;

typedef struct chart chart;

typedef struct chart_point {
    iso_vec3 at;      /* mm */
    iso_vec3 normal;  /* unit, along the gradient */
    double thickness; /* mm across the layer for each mm of r: 1 / |gradient| */
    double volume;    /* mm^3 for each mm^2 of u, v and mm of r */
} chart_point;

/* The kind that suits the field: its own for cylinder, sphere and fan if the machine turns the part
 * (`turns`), else the graph. `low`, `high` bound the part, mm; levels run from r_low to r_high. The
 * field must outlive the chart. ISO_OUTSIDE, naming a place: the field doesn't rise with z there,
 * and no other chart will do. */
iso_status chart_new(chart **made, const iso_field *field, bool turns, const iso_vec3 box[2],
                     const double range[2]) ISO_MUST_CHECK;
void chart_free(chart *chart);

chart_kind chart_kind_of(const chart *chart);

/* mm: u and u + chart_period(chart) are the same place; 0: none is. u runs from -period / 2. */
double chart_period(const chart *chart);

/* u, v of points anywhere; r is the field's value there and isn't asked. */
void chart_down(iso_vec2 *flat, const chart *chart, const iso_vec3 *at, int64_t count);

/* Points of the layer F = r. ISO_OUTSIDE: it has none at some (u, v), which the message names. */
iso_status chart_lift(chart_point *point, const chart *chart, const iso_vec2 *flat, double r,
                      int64_t count) ISO_MUST_CHECK;

/* The contours of all levels in the chart. Where it wraps they are cut at its ends, and closed
 * along them, so that each level is a set of closed contours; `margin` mm beyond each end is there
 * twice. Level i of `curves` lies on F = level[i]. */
iso_status chart_slices(iso_slices *slices, const chart *chart, const iso_curves *curves,
                        double margin) ISO_MUST_CHECK;

/* mm^3 between r - below and r + above of the layer's region, contours summed by winding: its area
 * times thickness where the chart is flat. */
iso_status chart_volume(double *volume, const chart *chart, const iso_slices *slices, int32_t level,
                        double r, double thickness) ISO_MUST_CHECK;

#endif

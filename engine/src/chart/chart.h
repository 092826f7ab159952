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
#include <isoslice/path.h>
#include <isoslice/slice.h>

#include "base/memory.h"

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
const iso_field *chart_field(const chart *chart);

/* mm: u and u + chart_period(chart) are the same place; 0: none is. u runs from -period / 2. */
double chart_period(const chart *chart);

/* mm: of a straight line in the chart no longer than this, the normals at its ends tell for certain
 * enough how it runs on the layer; 0: of any line. */
double chart_reach(const chart *chart);

/* mm that the layer is off the straight line from a to b, as the normals there tell: above it if
 * positive. */
double chart_rise(const chart_point *a, const chart_point *b);

/* How much farther a straight line in the chart may swerve sideways on the layer, near `point`,
 * than it bends with it: a factor on that, 0 where straight lines stay straight. */
double chart_swerve(const chart *chart, const chart_point *point);

/* u, v of points anywhere; r is the field's value there and isn't asked. */
void chart_down(iso_vec2 *flat, const chart *chart, const iso_vec3 *at, int64_t count);

/* Points of the layer F = r. ISO_OUTSIDE: it has none at some (u, v), which the message names. */
iso_status chart_lift(chart_point *point, const chart *chart, const iso_vec2 *flat, double r,
                      int64_t count) ISO_MUST_CHECK;

/* The same points, but thickness and volume are those of the whole layer, from F = r - thickness to
 * F = r: its means. */
iso_status chart_layer(chart_point *point, const chart *chart, const iso_vec2 *flat,
                       const double layer[2], int64_t count) ISO_MUST_CHECK;

/* The contours of all levels in the chart. Where it wraps they are cut at its ends, and closed
 * along them, so that each level is a set of closed contours; `margin` mm beyond each end is there
 * twice. The slices own their arrays. ISO_OUTSIDE, naming the place: layers fold over there. */
iso_status chart_slices(iso_slices *slices, const chart *chart, const iso_curves *curves,
                        double margin) ISO_MUST_CHECK;

/* mm^3 of the layer from F = r - thickness to F = r, with the region that this level has: contours
 * summed by winding, and what is there twice counted once. `layer` is r and the thickness. */
iso_status chart_volume(double *volume, const chart *chart, const iso_slices *slices, int32_t level,
                        const double layer[2], iso_arena *scratch) ISO_MUST_CHECK;

/* Paths of a layer that wraps, cut to one period: what lies beyond is dropped, what crosses an end
 * is split there exactly, and what goes on at the other end is joined with it, so that a loop
 * around everything is a closed path again (from its last vertex to its first u jumps by a period).
 * Groups that are joined become one. Where the chart doesn't wrap it is a copy. For paths that
 * aren't ordered yet. Replaces what `out` held. */
iso_status chart_clip_paths(iso_paths *out, const iso_paths *paths, const chart *chart,
                            iso_arena *scratch) ISO_MUST_CHECK;

#endif

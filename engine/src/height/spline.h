/* A height over the plane: a uniform bicubic B-spline, so smooth that its slope bends nowhere
 * sharply. Beyond the grid it goes on as it is at the border. */
#ifndef ISO_HEIGHT_SPLINE_H
#define ISO_HEIGHT_SPLINE_H

#include <stdint.h>

#include <isoslice/geometry.h>

#include "field/interval.h"

typedef struct spline {
    int32_t columns, rows; /* of control points; point (0, 0) is at `corner` */
    double step;           /* mm between them */
    iso_vec2 corner;
    double *control; /* [columns rows] row by row, mm */
} spline;

/* What the spline's value and slopes at a point are sums of. */
typedef struct spline_terms {
    int32_t point[16];
    double value[16], x[16], y[16];
} spline_terms;
void spline_terms_at(spline_terms *terms, const spline *s, double x, double y);

typedef struct spline_sample {
    double value, x, y;
} spline_sample;
spline_sample spline_at(const spline *s, double x, double y);

/* Value, slope along x and along y over a closed box: within what control points and their
 * differences span, which they never leave. Of very large boxes, over all of the grid. */
void spline_bound(interval bound[3], const spline *s, iso_vec2 low, iso_vec2 high);

#endif

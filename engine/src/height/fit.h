/* A spline h of which layers z - ramp(z) h(x, y) = constant lie as tops do. */
#ifndef ISO_HEIGHT_FIT_H
#define ISO_HEIGHT_FIT_H

#include "height/ramp.h"
#include "height/spline.h"
#include "height/tops.h"

typedef struct fit_limits {
    double slope;     /* tangent: of no layer in the model more */
    double low, high; /* of the derivative by z: between 0.3 and 1, more than 1 */
    double floor;     /* z of the model's foot */
} fit_limits;

/* Least squares alone: no limits, no doubts. */
iso_status fit_freely(spline *s, const tops *t, const ramp *r) ISO_MUST_CHECK;

/* As far as the limits allow; tops that can't be followed are given up, for the others' sake. */
iso_status fit_within(spline *s, const tops *t, const ramp *r,
                      const fit_limits *limits) ISO_MUST_CHECK;

#endif

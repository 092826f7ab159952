/* How much of a curve layers have at a height: nothing up to `from`, all of it `length` above, and
 * between evenly more but for a soft start and end. */
#ifndef ISO_HEIGHT_RAMP_H
#define ISO_HEIGHT_RAMP_H

#include <math.h>

#include "field/interval.h"

typedef struct ramp {
    double from, length; /* mm */
} ramp;

/* Share of the length that is soft at either end. */
#define RAMP_SOFT 0.15
/* Times 1 / length: as steep as it gets. */
#define RAMP_STEEPEST (1 / (1 - RAMP_SOFT))

static inline double ramp_at(const ramp *r, double z) {
    double s = fmin(fmax((z - r->from) / r->length, 0), 1);
    if (s < RAMP_SOFT)
        return RAMP_STEEPEST * s * s / (2 * RAMP_SOFT);
    if (s > 1 - RAMP_SOFT)
        return 1 - RAMP_STEEPEST * (1 - s) * (1 - s) / (2 * RAMP_SOFT);
    return RAMP_STEEPEST * (s - RAMP_SOFT / 2);
}

static inline double ramp_slope(const ramp *r, double z) {
    double s = fmin(fmax((z - r->from) / r->length, 0), 1);
    return RAMP_STEEPEST / r->length * fmin(1, fmin(s, 1 - s) / RAMP_SOFT);
}

static inline interval ramp_over(const ramp *r, double low, double high) {
    return (interval){ramp_at(r, low), ramp_at(r, high)};
}

/* It rises, stays and falls. */
static inline interval ramp_slope_over(const ramp *r, double low, double high) {
    double a = ramp_slope(r, low), b = ramp_slope(r, high), middle = r->from + r->length / 2;
    double most = low < middle && middle < high ? RAMP_STEEPEST / r->length : fmax(a, b);
    return (interval){fmin(a, b), most};
}

#endif

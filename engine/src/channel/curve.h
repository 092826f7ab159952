/* Polylines in space, open or closed. */
#ifndef ISO_CHANNEL_CURVE_H
#define ISO_CHANNEL_CURVE_H

#include <stdbool.h>

#include "base/memory.h"
#include "base/vector.h"

typedef struct curve {
    iso_vec3 *point; /* [count] */
    int64_t capacity;
    int32_t count;
    bool closed;
} curve;

void curve_free(curve *c);
iso_status curve_add(curve *c, iso_vec3 p) ISO_MUST_CHECK;

double curve_length(const curve *c);
/* length[i] from point 0 to point i; [count], and one more, the whole, if it is closed. */
void curve_measure(double *length, const curve *c);

/* Points at equal steps along it, `step` apart or a little less; the ends of an open one stay. */
iso_status curve_resample(curve *out, const curve *c, double step) ISO_MUST_CHECK;

/* The radius of the circle through a point and its neighbours; infinite where it is straight. */
double curve_radius(const curve *c, int32_t i);
/* The least of all. *at is its point. */
double curve_least_radius(int32_t *at, const curve *c);

/* Make no bend narrower than `radius`, points about `step` apart: points of narrower ones are drawn
 * between their neighbours until it is so, or as far as it goes; a closed curve that can't be made
 * so stays as it is but for its points. The first and the last `fixed` points of an open one stay.
 */
iso_status curve_relax(curve *c, double radius, double step, int32_t fixed) ISO_MUST_CHECK;

#endif

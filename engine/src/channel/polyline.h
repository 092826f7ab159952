/* A closed contour that is asked for its nearest place again and again. */
#ifndef ISO_CHANNEL_POLYLINE_H
#define ISO_CHANNEL_POLYLINE_H

#include "base/memory.h"
#include "base/vector.h"

typedef struct polyline {
    const iso_vec3 *point; /* [count], borrowed */
    double *length;        /* [count + 1] from point 0 on */
    int32_t count;
} polyline;

/* Lengths are put into the arena. */
iso_status polyline_new(polyline *line, const iso_vec3 *point, int32_t count,
                        iso_arena *arena) ISO_MUST_CHECK;

static inline double polyline_whole(const polyline *line) {
    return line->length[line->count];
}

/* The point at a length, taken modulo the whole. */
iso_vec3 polyline_at(const polyline *line, double length);

/* Distance from p to the nearest place; *length is where that is. *guess is the edge it was on the
 * last time, or 0. Exact: along an edge of the line no distance falls by more than the edge's
 * length, so that most edges are passed over unseen. */
double polyline_nearest(double *length, const polyline *line, iso_vec3 p, int32_t *guess);

#endif

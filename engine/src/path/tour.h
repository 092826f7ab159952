/* A short tour through things that are entered at one end and left at the other. */
#ifndef ISO_PATH_TOUR_H
#define ISO_PATH_TOUR_H

#include <isoslice/geometry.h>

#include "base/memory.h"

/* What a travel costs, in seconds: from standing to standing, and the filament back and forth if it
 * is long. */
typedef struct iso_travel_cost {
    double speed, acceleration; /* units/s, units/s^2 */
    double retraction;          /* s; 0 if such travels don't retract */
    double retract_before;      /* units */
    double junction_deviation;  /* units: how fast bends are taken; 0: at a stand */
} iso_travel_cost;

double iso_travel_seconds(const iso_travel_cost *cost, iso_point a, iso_point b);

typedef struct iso_stop {
    iso_point a, b; /* the same for closed paths */
} iso_stop;

/* tour[k] = 2 * stop + 1 if it is entered at b, else 2 * stop; the k-th to be visited. */

/* Where a tour comes from, and where it would like to end: near one of some places, or anywhere. */
typedef struct iso_tour_frame {
    iso_point from;
    const iso_point *end; /* [ends] */
    int32_t ends;
} iso_tour_frame;

/* The nearest end of those left is next. */
iso_status iso_tour_nearest(int32_t *tour, const iso_stop *stop, int32_t count, iso_point from,
                            iso_arena *scratch) ISO_MUST_CHECK;

/* Make a tour cheaper by 2-opt and Or-opt moves between ends that are near each other (Bentley,
 * "Fast algorithms for geometric traveling salesman problems", 1992), until none is left or about
 * 100 count + 10000 steps are done. Never makes it dearer. */
iso_status iso_tour_improve(int32_t *tour, const iso_stop *stop, int32_t count,
                            const iso_tour_frame *frame, const iso_travel_cost *cost,
                            iso_arena *scratch) ISO_MUST_CHECK;

double iso_tour_seconds(const int32_t *tour, const iso_stop *stop, int32_t count,
                        const iso_tour_frame *frame, const iso_travel_cost *cost);

#endif

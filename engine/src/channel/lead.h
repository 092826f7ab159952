/* Rings become channels. */
#ifndef ISO_CHANNEL_LEAD_H
#define ISO_CHANNEL_LEAD_H

#include "channel/body.h"

enum { LEVELS_MOST = 2000 };

/* Points of a channel a radius of its bends: a circle then has 31 and is 0.2 % too short. */
#define STEPS_A_BEND 5

/* Rings that are joined into one channel. */
typedef struct series {
    curve way;
    int32_t rings;
    double last;   /* height of the last ring */
    double middle; /* between its ends, along the side */
} series;

/* Push a ring off the part; out closes. */
iso_status lead_off(curve *out, iso_channels *c, const ring *outline) ISO_MUST_CHECK;
/* Keep a ring of the channel that comes next, for the figures. */
iso_status lead_note(iso_channels *c, int32_t tower_index, double f,
                     const ring *outline) ISO_MUST_CHECK;
/* A channel of a ring, closed or with its own ports. */
iso_status lead_ring(iso_channels *c, curve *pushed) ISO_MUST_CHECK;
/* Another ring of a series, there and back: each begins at the end where the one below ends. t is
 * NULL where there is no square-link: the way from ring to ring is straight then. */
iso_status lead_on(iso_channels *c, series *s, const tower *t, double f,
                   const curve *pushed) ISO_MUST_CHECK;
/* A channel between two ports. */
iso_status lead_to_ports(iso_channels *c, const curve *way) ISO_MUST_CHECK;

/* The channels of a tower. */
iso_status lead_tower(iso_channels *c, int32_t index) ISO_MUST_CHECK;
/* All channels of the distance on the triangles. */
iso_status lead_geodesics(iso_channels *c) ISO_MUST_CHECK;

#endif

/* A section swept along a curve. */
#ifndef ISO_CHANNEL_SWEEP_H
#define ISO_CHANNEL_SWEEP_H

#include <isoslice/channel.h>

#include "channel/curve.h"

/* A square-link: index k + sides row, alpha around the section, counter-clockwise seen against the
 * channel's direction, beta along the channel. */
typedef struct skin {
    iso_vec3 *point; /* [sides rows] */
    double *at;      /* [rows] mm along the channel */
    int32_t sides, rows;
    bool closed;
    double twist; /* radians that a closed one's frame came back turned by; spread out */
} skin;

/* x of the section points to `off` at the row `middle`. `end` is the direction that an open curve
 * begins against and ends in: its outermost sections are perpendicular to it, to the bit where it
 * is an axis. In the arena. */
iso_status sweep(skin *out, const curve *line, const iso_channel_section *section, int32_t middle,
                 iso_vec3 off, iso_vec3 end, iso_arena *arena) ISO_MUST_CHECK;

#endif

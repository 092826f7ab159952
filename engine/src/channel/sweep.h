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

/* Rows that have a next one. */
static inline int32_t skin_steps(const skin *s) {
    return s->closed ? s->rows : s->rows - 1;
}

/* The two triangles, outward, between corners k and k + 1 of a row and the next. Squares are cut
 * along the one diagonal and the other in turns: where a channel twists they aren't flat, and the
 * one would always take something away. */
static inline void skin_square(iso_vec3 corner[6], const skin *s, int32_t row, int32_t k) {
    const iso_vec3 *a = s->point + (int64_t)s->sides * row;
    const iso_vec3 *b = s->point + (int64_t)s->sides * (row + 1 < s->rows ? row + 1 : 0);
    int32_t m = k + 1 < s->sides ? k + 1 : 0;
    bool other = row % 2 == 1;
    corner[0] = a[k];
    corner[1] = a[m];
    corner[2] = other ? b[k] : b[m];
    corner[3] = other ? a[m] : a[k];
    corner[4] = b[m];
    corner[5] = b[k];
}

/* x of the section points to `off` at the row `middle`. `end` is the direction that an open curve
 * begins against and ends in: its outermost sections are perpendicular to it, to the bit where it
 * is an axis. In the arena. */
iso_status sweep(skin *out, const curve *line, const iso_channel_section *section, int32_t middle,
                 iso_vec3 off, iso_vec3 end, iso_arena *arena) ISO_MUST_CHECK;

#endif

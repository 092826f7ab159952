/* The channels while they are made, and when they are. */
#ifndef ISO_CHANNEL_BODY_H
#define ISO_CHANNEL_BODY_H

#include <isoslice/channel.h>

#include "channel/keep.h"
#include "channel/ring.h"
#include "channel/route.h"
#include "channel/sweep.h"

typedef struct channel {
    curve line;
    skin skin;
    double leg[2]; /* mm to the mould's side, of an open one */
} channel;

struct iso_channels {
    iso_channel_options options;
    const iso_mesh *mesh;
    iso_mesh fine;   /* the same with short edges, for geodesics */
    iso_arena arena; /* towers, rings, skins */
    part_space part;
    tower *tower;
    int32_t tower_count;
    double start, bend, reach; /* as used; reach of the section */
    port_side side;
    channel *channel; /* [figures.channel_count] */
    int64_t channel_capacity;
    iso_channel_ring *ring;
    int64_t ring_capacity;
    ring *outline; /* [figures.ring_count] on the surface */
    int64_t outline_capacity;
    iso_channel_figures figures;
};

void channels_report(const iso_channels *c, double done, const char *stage);

/* How far apart rings are on the surface: figures.pitch_*, spread_rms, and mean, least, most of the
 * rings. */
iso_status channels_measure_pitch(iso_channels *c) ISO_MUST_CHECK;
/* figures.to_part, between, outside and bend. */
iso_status channels_measure_walls(iso_channels *c) ISO_MUST_CHECK;

/* Triangles of channel skins, or of a mould, and the volume that they enclose by their making. */
iso_status channels_mesh(float **triangle, int64_t *count, double *volume, const iso_channels *c,
                         iso_channel_output output) ISO_MUST_CHECK;

#endif

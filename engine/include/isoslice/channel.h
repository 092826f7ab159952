/* Cooling channels of a mould: they go around a part at one distance from its surface, and are one
 * pitch apart along it (paper, 6).
 *
 *     mesh -> iso_channels_new -> iso_channels_check -> iso_channels_write_stl
 *
 * The part is cut at many heights. Between two branchings the contours are a tower: a square-link
 * whose rings are contours, alpha around a ring, beta from a point to the nearest place of the ring
 * above. The distance along beta is the height F that the square-link is cut by once more: its
 * levels are the channels, one pitch apart. They are pushed off into the mould, led to its side,
 * and swept with a section; a channel that closes is a square patch. */
#ifndef ISOSLICE_CHANNEL_H
#define ISOSLICE_CHANNEL_H

#include <isoslice/geometry.h>
#include <isoslice/link.h>
#include <isoslice/mesh.h>
#include <isoslice/status.h>

/* What the distance along the surface is. */
typedef enum iso_channel_mode {
    ISO_CHANNEL_PLANAR,    /* a ring's mean: channels are level */
    ISO_CHANNEL_POINTWISE, /* each point's own: channels keep their distance on slanted parts too */
    ISO_CHANNEL_GEODESIC,  /* the shortest way on the triangles from the part's lowest points */
    ISO_CHANNEL_MODE_COUNT
} iso_channel_mode;

typedef enum iso_channel_ports {
    ISO_CHANNEL_CLOSED,   /* rings without any */
    ISO_CHANNEL_PARALLEL, /* each ring has an inlet and an outlet */
    ISO_CHANNEL_SERIES,   /* rings are joined, one inlet and one outlet for all of a tower */
    ISO_CHANNEL_PORTS_COUNT
} iso_channel_ports;

typedef enum iso_channel_side {
    ISO_CHANNEL_LEFT,  /* -x */
    ISO_CHANNEL_RIGHT, /* +x */
    ISO_CHANNEL_FRONT, /* -y */
    ISO_CHANNEL_BACK,  /* +y */
    ISO_CHANNEL_SIDE_COUNT
} iso_channel_side;

enum { ISO_SECTION_SIDES_MAX = 256 };

/* A convex polygon around its centroid, counter-clockwise. x runs off the part, y along it. */
typedef struct iso_channel_section {
    int32_t sides;
    iso_vec2 corner[ISO_SECTION_SIDES_MAX]; /* mm */
} iso_channel_section;

/* "round:8" by diameter, "square:8", "rect:8x5", "oval:8x5" (along the part, off it), "polygon:6:8"
 * (sides, diameter around), with `sides` corners where the shape has no number of its own.
 * ISO_USAGE: another text; sizes out of 0.1 to 1000 mm. */
ISO_API iso_status iso_channel_section_parse(iso_channel_section *section, const char *text,
                                             int32_t sides) ISO_MUST_CHECK;
ISO_API double iso_channel_section_area(const iso_channel_section *section); /* mm^2 */
/* The largest distance of a corner from the middle. */
ISO_API double iso_channel_section_reach(const iso_channel_section *section);

typedef struct iso_channel_options {
    double pitch; /* mm along the surface, from channel to channel */
    double depth; /* mm from the surface to the middle of a channel */
    double start; /* mm from the lowest contour to the first channel; below 0: half the pitch */
    iso_channel_section section;
    iso_channel_mode mode;
    int32_t levels;  /* heights that the part is cut at; 0: by the pitch */
    int32_t samples; /* points of a ring; 0: by the depth */
    int32_t holes;   /* not 0: channels go around within the part's upright holes too */
    iso_channel_ports ports;
    iso_channel_side side; /* of the mould, where inlets and outlets are */
    double margin;         /* mm of mould around the part; below 0: as the channels ask for */
    double wall;           /* mm of mould that is to stay around channels */
    double bend; /* mm, least radius of a channel's bends; below 0: 1.5 times the section's reach */
    /* Called now and then, done from 0 to 1; may be NULL. */
    void (*progress)(void *payload, double done, const char *stage);
    void *payload;
} iso_channel_options;

/* Pitch 20, depth 10, round:8 with 32 sides, planar, parallel, at the front, wall 2. */
ISO_API iso_channel_options iso_channel_defaults(void);

/* One ring: a level of one tower. Its distances along the surface are measured anew, on a
 * square-link three times as fine; but for rings over the part's top, which no tower
 * has. */
typedef struct iso_channel_ring {
    int32_t tower, channel;
    int32_t measured;         /* 0: mean, least and most are the height */
    double height;            /* mm along the surface that were asked for */
    double mean, least, most; /* mm that were measured */
    double z;                 /* mean, of the ring on the surface */
    double length;            /* mm, of the ring on the surface */
} iso_channel_ring;

typedef struct iso_channel_wall {
    double thickness; /* mm; infinite if there is none */
    iso_vec3 at;
    int32_t channel, other; /* other is -1 but between channels */
} iso_channel_wall;

typedef struct iso_channel_figures {
    int32_t tower_count, ring_count, channel_count;
    const iso_channel_ring *ring; /* [ring_count] tower by tower, upwards */
    double pitch_total;           /* 0.01: all of the pitches together are 1 % too long */
    double pitch_rms, pitch_max;  /* of the same for each pitch */
    double spread_rms; /* of a ring's points from their height, relative to it; 0.01 is 1 % */
    double length;     /* mm, of all channels */
    double volume;     /* mm^3, of all channels */
    double part_volume, mould_volume; /* mm^3; the mould's without part and channels */
    iso_vec3 box_min, box_max;        /* of the mould */
    double bend;                      /* mm, least radius; infinite if all is straight */
    iso_vec3 bend_at;
    int32_t bend_channel;
    iso_channel_wall to_part, between, outside;
    int32_t folds;      /* places where the offset met itself and was cut short */
    int32_t narrow;     /* geodesic rings around a top that were too narrow to bend: left out */
    int32_t incomplete; /* levels that leave the surface at a tower's end: no channel was made */
} iso_channel_figures;

typedef struct iso_channels iso_channels;

/* The mesh is only read, and must outlive the channels. ISO_BAD_CONFIG: an option out of its range,
 * which the message names. ISO_UNSLICEABLE: nowhere a channel. ISO_NOT_VERIFIED: a ring can't be
 * pushed off so far, or has no room for its ports; the message says where. */
ISO_API iso_status iso_channels_new(iso_channels **channels, const iso_mesh *mesh,
                                    const iso_channel_options *options) ISO_MUST_CHECK;
ISO_API void iso_channels_free(iso_channels *channels);
ISO_API const iso_channel_figures *iso_channels_figures(const iso_channels *channels);

/* Are walls and bends what was asked for? ISO_NOT_VERIFIED says which isn't, and where. */
ISO_API iso_status iso_channels_check(const iso_channels *channels) ISO_MUST_CHECK;

/* The middles of the channels as a link, colour = channel; of an open one the last index is its own
 * successor. */
ISO_API iso_status iso_channels_centrelines(iso_coloured_link *out,
                                            const iso_channels *channels) ISO_MUST_CHECK;
/* A channel's skin as a square-link: alpha around the section, beta along the channel. It wraps
 * both ways if the channel is closed, and makes a square patch then. */
ISO_API iso_status iso_channels_skin(iso_square_link *out, const iso_channels *channels,
                                     int32_t number) ISO_MUST_CHECK;
/* A tower's square-link, index i + samples j, and its heights F ([size], to be released by
 * iso_channels_release); NULL if they aren't wanted. */
ISO_API iso_status iso_channels_tower(iso_square_link *out, double **height,
                                      const iso_channels *channels, int32_t number) ISO_MUST_CHECK;
ISO_API void iso_channels_release(void *block);

typedef enum iso_channel_output {
    ISO_CHANNEL_SKINS, /* each channel as a closed body */
    ISO_CHANNEL_MOULD  /* a block without the part and the channels; those with ports are open */
} iso_channel_output;

/* Triangles as STL has them: 9 floats each, outward; to be released by iso_channels_release. They
 * have been read back: ISO_NOT_VERIFIED if they aren't closed, or of another volume than told. */
ISO_API iso_status iso_channels_triangles(float **triangle, int64_t *count,
                                          const iso_channels *channels,
                                          iso_channel_output output) ISO_MUST_CHECK;
ISO_API iso_status iso_channels_write_stl(int64_t *triangles, const iso_channels *channels,
                                          iso_channel_output output,
                                          const char *path) ISO_MUST_CHECK;

#endif

/* A clipper: curves drawn point by point, cut down to what lies within a region.
 *
 * The curves are meant to be moved by (e, e^2) with e as small as need be, so no point of theirs is
 * ever on the boundary and no corner of it on them: every crossing is a proper one, decided by
 * exact orientations, and inside and outside take turns (Edelsbrunner and Muecke 1990). Edges stand
 * in the cells of a uniform grid; a step of a curve looks at those cells alone that it passes. */
#ifndef ISO_FILL_CLIP_H
#define ISO_FILL_CLIP_H

#include "fill/weave.h"

/* A frame of one's own to draw in: turned by `angle` about `origin`. In units. */
typedef struct iso_clip_frame {
    double cosine, sine;
    iso_point origin;
} iso_clip_frame;

typedef struct iso_clip_edge { /* an edge that the present step crosses */
    int64_t before, after;     /* |orient2d| of the step's ends with the edge */
    int32_t edge;              /* 2 i + leaves */
} iso_clip_edge;

typedef struct iso_clip_event { /* inner points and crossings, in the order of the curves */
    iso_point at;
    int32_t edge; /* as in iso_crossing; ISO_CLIP_INNER: a point of the curve */
    iso_weave_bead bead;
} iso_clip_event;

enum { ISO_CLIP_INNER = INT32_MIN, ISO_CLIP_BLOCK = 1000 };

typedef struct iso_clip_block {
    struct iso_clip_block *next;
    int32_t count;
    iso_clip_event event[ISO_CLIP_BLOCK];
} iso_clip_block;

typedef struct iso_clip {
    const iso_region *region;
    iso_arena *scratch;
    iso_clip_frame frame;
    iso_box box; /* of the region */
    int shift;   /* cells are 2^shift units wide */
    int32_t columns, rows;
    int32_t *first, *entry; /* edges of each cell */
    int32_t *next;          /* [edges] the point where each edge ends */
    int32_t *seen;          /* [edges] the last step that looked at it */
    int32_t step;
    iso_clip_edge *crossed; /* [edges] room */
    iso_point at;           /* where the curve has got to */
    int started, inside;
    int has_beads;       /* do the curves' beads differ? */
    iso_weave_bead bead; /* then that of what is drawn from now on */
    iso_clip_block *block, *head;
    iso_status status; /* the first failure; then nothing more is drawn */
} iso_clip;

/* The region must be clean, with at least a point, and outlive the clip, as must what this pushes
 * to `scratch`. */
iso_status iso_clip_begin(iso_clip *clip, const iso_region *region, double angle, iso_point origin,
                          iso_arena *scratch) ISO_MUST_CHECK;

/* The region's box in the frame. */
void iso_clip_extent(double min[2], double max[2], const iso_clip *clip);

/* Begin a curve; go on with it. In the frame, rounded to units; at most 2^25 from the bed's origin.
 */
void iso_clip_move(iso_clip *clip, double x, double y);
void iso_clip_draw(iso_clip *clip, double x, double y);

/* The same in units, rounded already, whatever the frame. */
void iso_clip_move_to(iso_clip *clip, iso_point to);
void iso_clip_draw_to(iso_clip *clip, iso_point to);
/* What the caller knows to lie within the region altogether. */
void iso_clip_move_within(iso_clip *clip, iso_point to);
void iso_clip_draw_within(iso_clip *clip, iso_point to);

/* Is a point in the region, moved as curves are? */
int iso_clip_holds(iso_clip *clip, iso_point at);

/* All pieces, linked. Pushed to `scratch`. */
iso_status iso_clip_end(iso_weave *weave, iso_clip *clip) ISO_MUST_CHECK;

#endif

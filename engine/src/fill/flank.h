/* Flanks: where a line runs beside the boundary, what is left between them is rarely just the half
 * spacing that it fills on that side. There the line's bead is made wider or narrower, piece by
 * piece, and its middle moved by half of that.
 *
 * Such places are the arcs that come back to the line that they leave. Either the line is the last
 * one before the boundary (a cap), or the boundary comes up to it from a neighbouring line (a
 * valley). Arcs between two lines are met by beads' ends instead, unless they run along the lines
 * for long (a slope). */
#ifndef ISO_FILL_FLANK_H
#define ISO_FILL_FLANK_H

#include "fill/hatch.h"

/* A piece of a line between two of its points, or all of it. */
typedef struct iso_flank_piece {
    iso_point to;        /* in the direction of the line; the last one ends it */
    int32_t width, area; /* of the bead */
} iso_flank_piece;

enum { ISO_FLANK_PIECES = 64 }; /* a line's most */

typedef struct iso_flank {
    int32_t segment; /* the one that gives way */
    int32_t dart;    /* the arc, where it leaves its line */
    int32_t above;   /* does it lie above the segment? */
} iso_flank;

typedef struct iso_flanks {
    const iso_hatch *hatch;
    const iso_sweep *sweep;
    iso_bead usual;  /* of the lines: width, area, and their spacing; height unused */
    int32_t nominal; /* width in units from which pieces keep within 0.6 and 1.4 */
    int32_t margin;  /* from the region's edge to that of what is to be full */
    int32_t count;
    iso_flank *flank; /* by segment */
    iso_point *point; /* room for an arc */
    int32_t pieces;   /* all segments' pieces together are no more */
} iso_flanks;

/* All of the hatch's, by segment. Cells that go round more than a few neighbours are passed over:
 * so it takes O(crossings). */
iso_status iso_flanks_find(iso_flanks *flanks, iso_arena *scratch) ISO_MUST_CHECK;

/* Does the arc between two lines run along them for long? Then it is filled by one of them, and no
 * link is needed there. */
int iso_flanks_run_along(const iso_flanks *flanks, int32_t dart);

/* Has the segment any? Where they begin, or -1. Asked in any order: O(log count). */
int32_t iso_flanks_of(const iso_flanks *flanks, int32_t segment);

/* The pieces of a segment whose flanks begin at `first`; returns how many. */
int32_t iso_flanks_pieces(iso_flank_piece piece[ISO_FLANK_PIECES], iso_flanks *flanks,
                          int32_t first);

#endif

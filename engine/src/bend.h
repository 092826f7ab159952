/* What a job does besides where layers are curved: paths leave their chart for space, machines that
 * turn the part get poses, and the tool must not touch what is printed. Of flat layers nothing of
 * it is ever used. */
#ifndef ISO_BEND_H
#define ISO_BEND_H

#include "clearance/clearance.h"
#include "curved.h"
#include "gcode/writer.h"
#include "pose/pose.h"

/* Zero-initialise. */
typedef struct iso_bend {
    bool on;
    const iso_options *options;
    iso_paths part, lifted;
    pose_machine machine;
    iso_pose last, *vertex, *travel;
    int64_t vertex_capacity, travel_capacity;
    clearance_tool tool;
    clearance *clearance; /* or NULL: nobody asks */
    int32_t copy;         /* whose layer the nozzle is on; -1: none */
} iso_bend;

/* Before anything is printed; `gcode` gets what the writer has to know. `curved` is the first
 * copy's, which stands at `by`; `alone`: there is no other. */
iso_status bend_begin(iso_bend *bend, iso_gcode_options *gcode, const iso_options *options,
                      const iso_curved *curved, iso_point by, bool alone) ISO_MUST_CHECK;
void bend_free(iso_bend *bend);

/* What must not touch the print; NULL: nobody asks. */
static inline const clearance_tool *bend_tool(const iso_bend *bend) {
    return bend->clearance ? &bend->tool : NULL;
}

/* A layer of a copy, or of what is around all copies. */
typedef struct iso_bend_layer {
    const iso_curved *curved; /* NULL, or flat: as are its layers */
    const iso_levels *levels;
    int32_t level;
    int32_t merged; /* it is 2^merged levels thick */
    int32_t height; /* units */
    int32_t copy;   /* -1: around */
    iso_point from; /* where the nozzle is on the copy's chart, if it is that copy's */
} iso_bend_layer;

/* Its ordered paths in space: the paths themselves if nothing is curved; *made stays valid until
 * the next call. */
iso_status bend_lift(iso_paths **made, iso_bend *bend, iso_paths *flat, const iso_bend_layer *layer,
                     iso_arena *scratch) ISO_MUST_CHECK;

/* Add to a layer what the machine's axes are to do. */
iso_status bend_pose(iso_gcode_layer_info *info, iso_bend *bend) ISO_MUST_CHECK;

/* Has the tool touched anything in what was written so far, or at all, if that was the last of it?
 * ISO_NOT_VERIFIED, saying where. */
iso_status bend_check(iso_bend *bend, bool last) ISO_MUST_CHECK;

#endif

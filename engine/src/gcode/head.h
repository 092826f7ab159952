/* The print head as the G-code has it so far: where it is, how much filament it has drawn, what was
 * last said. It writes every move. */
#ifndef ISO_GCODE_HEAD_H
#define ISO_GCODE_HEAD_H

#include <isoslice/arc.h>
#include <isoslice/gcode.h>
#include <isoslice/path.h>

#include "gcode/cooling.h"
#include "gcode/lines.h"
#include "gcode/modes.h"
#include "gcode/planner.h"
#include "gcode/wipe.h"
#include "pose/pose.h"

enum { ISO_HEAD_UNKNOWN = INT32_MIN };

typedef struct iso_head {
    iso_lines *lines;
    const iso_gcode_options *options;
    iso_modes modes;
    int relative_e;
    double e_unit;  /* mm of filament that one E is */
    double e_scale; /* E in fractions of its last digit for a bead of one unit^3 */
    int32_t travel_feed, travel_feed_z, retract_feed, deretract_feed; /* mm/min */
    int32_t lift;                                                     /* units */
    int64_t retract_e, deretract_e;                                   /* last digits */
    int32_t travel_acceleration;                                      /* to tell; 0: nothing */

    int32_t x, y;    /* um */
    int32_t z;       /* units */
    int32_t layer_z; /* units */
    int32_t above;   /* units: height of the next travel, over all that stands; or UNKNOWN */
    int32_t feed;    /* mm/min */
    double speed;    /* mm/s: the same */
    int64_t e;       /* last digits since E was reset */
    int64_t drawn;   /* E to have been extruded by now, with fraction */
    int64_t emitted; /* E that was, in last digits */
    int32_t role, width, height; /* last said in comments */
    int32_t area;                /* of the bead last drawn */
    int32_t layer_height;        /* units */
    int retracted;
    int doubtful;                       /* the place is to be said even if nothing changes */
    int retracted_tool[ISO_TOOLS_MOST]; /* of those that aren't in use */
    const iso_arc *arc, *arc_end;       /* of the layer, those to come */
    iso_wipe wipe;                      /* of the path last drawn, if it is asked for */
    double wipe_length;                 /* units: of a whole wipe; 0: none */

    const pose_machine *machine;        /* NULL: it never turns the part */
    const iso_pose *pose, *travel_pose; /* of the layer, if it does */
    int64_t angle[2];                   /* in POSE_ANGLE */
    iso_vec3 normal;                    /* of the layer where the nozzle is */
    int32_t z_offset;                   /* units */
    int32_t highest;                    /* units: of beads on layers that aren't flat; or UNKNOWN */
    double reach;                       /* mm: of beads from the pivot; below 0: none */
    int64_t fine_feed;                  /* in 1e-4: F where it has decimals; 0: unknown */
    int inverse;                        /* G93 holds */
    int space;                          /* the layer isn't flat, or the part turns */
    iso_status watched;                 /* what the watch said */

    double bead_mm, travel_mm;
    int64_t moves, retractions;
    iso_planner planner;
} iso_head;

/* The lines and options are the caller's and must outlive the head. */
void iso_head_start(iso_head *head, iso_lines *lines, const iso_gcode_options *options);

/* E begins at 0 again; role and width are to be said anew, the height, in units, has just been.
 * `space`: it isn't flat, or the machine turns the part. */
void iso_head_begin_layer(iso_head *head, int32_t z, int32_t height, int space);

/* Somebody else moved it. */
void iso_head_forget_place(iso_head *head);

/* Straight up to the layer; lifted as long as the filament is drawn back. */
void iso_head_reach_layer(iso_head *head);

void iso_head_retract(iso_head *head);

/* The tool in use is another, its filament as it was left. The nozzle ought to be where the last
 * one was, but where it is will be said anew. Absolute E begins at 0 again. */
void iso_head_take_tool(iso_head *head, int32_t from, int32_t to);

/* F counts mm a minute again. */
void iso_head_end_inverse_time(iso_head *head);

/* Up to a height over all that stands; the next travel stays there until it is where it goes. */
void iso_head_rise_above(iso_head *head, int32_t z);

/* To the path's beginning, by way of the points where its travel turns, and along it, each bead at
 * its role's speed. length[i] in units from the path's vertex i to the next one. Nothing happens on
 * paths of less than two vertices. Fails only where the machine turns the part. */
iso_status iso_head_draw(iso_head *head, const iso_paths *paths, const iso_path *path,
                         const double *length, const iso_layer_pace *pace) ISO_MUST_CHECK;

/* s to pull the filament back and to bring it forth again, acceleration left out. */
double iso_head_retraction_time(const iso_head *head);

/* mm of filament that beads took. */
double iso_head_filament(const iso_head *head);

int32_t iso_head_feed(double speed); /* mm/s to mm/min, at least 1 */

#endif

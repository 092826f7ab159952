/* How long the printer will take: a look-ahead planner like the firmware's, with trapezoidal speeds
 * and, at corners, junction deviation or the axes' jerk.
 *
 * Moves stream through a window. When it is full, entry speeds are planned backwards from a stop at
 * its end and the older part is timed; a stop pretended so far ahead is felt only by runs that need
 * more than the rest to brake. */
#ifndef ISO_GCODE_PLANNER_H
#define ISO_GCODE_PLANNER_H

#include <stdint.h>

#include <isoslice/gcode.h>

enum {
    ISO_PLANNER_WINDOW = 512,
    ISO_PLANNER_AHEAD = 160 /* kept in sight: 8 mm of 50 um chords, where 5 mm brake 100 mm/s */
};

typedef struct iso_planner_block {
    double speed;        /* mm/s it would like */
    double acceleration; /* mm/s^2 */
    double gain;         /* 2 acceleration length: what a full run adds to the square of a speed */
    double limit;        /* mm^2/s^2: entry by the junction and both speeds */
    double entry;        /* mm^2/s^2: entry by the plan, too */
    double rest;         /* mm^2/s^2: from which it can stop at once */
    int32_t extrudes;
} iso_planner_block;

typedef struct iso_planner {
    iso_machine_limits limits;
    double axes_speed, axes_acceleration; /* which no axis of x and y objects to */
    int classic_jerk;                     /* else junction deviation */
    double x, y, z;                       /* direction of the last move; 0 if it moved no axis */
    double filament;                      /* 1 if it moved the filament alone */
    double entry;                         /* mm^2/s^2: of block 0 */
    double time, idle_time;               /* s, of what left the window */
    double mark_time;                     /* s, at the mark */
    int32_t mark; /* the block that begins at the mark; -1 if it has left the window */
    int32_t count;
    iso_planner_block block[ISO_PLANNER_WINDOW];
} iso_planner;

typedef struct iso_planner_move {
    double dx, dy, dz;   /* mm */
    double length;       /* mm: of (dx, dy, dz), or of filament if those are 0 */
    double speed;        /* mm/s */
    double acceleration; /* mm/s^2 */
    int extrudes;
} iso_planner_move;

/* Without a junction deviation the axes' jerk holds. */
void iso_planner_start(iso_planner *planner, const iso_machine_limits *limits);

/* Speed and acceleration are lowered to what the axes can do. */
void iso_planner_add(iso_planner *planner, const iso_planner_move *move);

/* About the time of all moves so far; those in the window at their full speed. */
double iso_planner_elapsed(const iso_planner *planner);

/* From the next move on; its time is in mark_time once all is planned. */
void iso_planner_set_mark(iso_planner *planner);

/* The machine stands still here. */
void iso_planner_stop(iso_planner *planner);

#endif

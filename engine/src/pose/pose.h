/* Poses: where the machine's axes stand for the nozzle to be at a place, square to the layer.
 *
 *     cartesian   x, y, z; the nozzle always points down
 *     rotary_a    the part turns around a mandrel along X by A; rotary_b: along Y by B
 *     table_bc    the part's table turns by C around Z, and tilts by B around Y with all that
 *     table_ac    it turns by C, and tilts by A around X
 *
 * A table turns about a pivot; places of the part are what they are with all angles 0. Positive
 * angles turn the part right-handed around the machine's axes:
 *
 *     X, Y, Z = pivot + tilt(turn(place - pivot)),   up = tilt(turn(normal)) */
#ifndef ISO_POSE_POSE_H
#define ISO_POSE_POSE_H

#include <stdbool.h>

#include <isoslice/gcode.h>
#include <isoslice/path.h>

#include "base/memory.h"

typedef struct pose_machine {
    iso_kinematics kinematics;
    iso_vec3 pivot; /* mm on the bed: a point of the first turning axis, and of the table's */
    double low[2], high[2]; /* degrees that the tilting and the turning axis may go to */
    double fastest[2];      /* degrees/s */
} pose_machine;

typedef struct iso_pose {
    iso_vec3 at;     /* mm: X, Y, Z of the machine */
    double angle[2]; /* degrees, of the tilting and the turning axis; a turning axis doesn't jump.
                      * Whole multiples of POSE_ANGLE, which X, Y, Z then are exact for */
} iso_pose;

/* degrees: 0.17 um at 100 mm from the axis */
#define POSE_ANGLE 1e-4

/* degrees that the layer may be off square to the tool where it lies nearly square to the turning
 * axis. There the axis is left as it stands, or each pass over the top of a dome would turn it half
 * around. The tip's edge then lifts by 9 um a mm. */
#define POSE_POLE 0.5

/* degrees that a bead's layer may lean along a mandrel's axis, which no turning brings upright:
 * farther, and the nozzle would draw with its side. */
#define POSE_LEAN 45.0

/* Poses of all vertices and travel points of a layer's ordered paths, in printing order, from where
 * the one before ended (last: in and out). `z` is the layer's nominal top, units. ISO_OUTSIDE,
 * naming the place and the axis: beyond its limits, or leaning along it. */
iso_status pose_paths(iso_pose *vertex, iso_pose *travel, iso_pose *last, const iso_paths *paths,
                      int32_t z, const pose_machine *machine) ISO_MUST_CHECK;

/* The pose for one place and normal that is nearest to `last`, by the time it takes to turn there.
 * A mandrel can turn a normal up only as far as it lies across its axis. */
iso_status pose_at(iso_pose *pose, const iso_pose *last, iso_vec3 at, iso_vec3 normal,
                   const pose_machine *machine) ISO_MUST_CHECK;

/* X, Y, Z for a place of the part while the axes stand at these angles. */
iso_vec3 pose_turn(iso_vec3 at, const double angle[2], const pose_machine *machine);

/* Does it turn the part at all? NULL: no. */
bool pose_turns(const pose_machine *machine);

/* The other way: the place that the tip is at, and where the tool comes from. */
void pose_place(iso_vec3 *at, iso_vec3 *normal, const iso_pose *pose, const pose_machine *machine);

/* The letters of the two angles in G-code, "" for none. */
const char *pose_letter(const pose_machine *machine, int axis);

#endif

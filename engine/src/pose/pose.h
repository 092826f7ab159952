/* Poses: where the machine's axes stand for the nozzle to be at a place, square to the layer.
 *
 *     cartesian   x, y, z; the nozzle always points down
 *     rotary      the part turns around a mandrel along X (axis A), or along Y (axis B)
 *     table_bc    the part's table tilts by B around Y and turns by C on top of that
 *     table_ac    it tilts by A around X and turns by C
 *
 * A table turns about a pivot; places of the part are what they are with all angles 0. */
#ifndef ISO_POSE_POSE_H
#define ISO_POSE_POSE_H

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
    double angle[2]; /* degrees, of the tilting and the turning axis; a turning axis doesn't jump */
} iso_pose;

/* Poses of all vertices and travel points of a layer's ordered paths, in printing order, from where
 * the one before ended (last: in and out). `z` is the layer's nominal top, units. ISO_OUTSIDE,
 * naming the place and the axis: beyond its limits. */
iso_status pose_paths(iso_pose *vertex, iso_pose *travel, iso_pose *last, const iso_paths *paths,
                      int32_t z, const pose_machine *machine) ISO_MUST_CHECK;

/* The other way, for tests and pictures. */
void pose_place(iso_vec3 *at, iso_vec3 *normal, const iso_pose *pose, const pose_machine *machine);

/* The letters of the two angles in G-code, "" for none. */
const char *pose_letter(const pose_machine *machine, int axis);

#endif

/* What the paths of a layer ask for, before it is decided how fast they are drawn. */
#ifndef ISO_GCODE_WORK_H
#define ISO_GCODE_WORK_H

#include "gcode/cooling.h"
#include "gcode/head.h"

/* Lengths and stops by speed at the usual pace, and the time of all else; length[vertex_count]
 * takes each segment's length in units, by its first vertex. */
void iso_work_measure(iso_layer_work *work, double *length, const iso_paths *paths,
                      const iso_layer_pace *pace, const iso_head *head);

#endif

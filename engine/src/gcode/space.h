/* Moves where layers aren't flat, and on machines that turn the part.
 *
 * Beads and travels go straight in space from point to point; where a table turns the part, in as
 * many straight moves of the axes as keep the tip within SPACE_TOLERANCE of that. A path that
 * nobody knows a way to is reached over all that is printed, or around it if the part turns. */
#ifndef ISO_GCODE_SPACE_H
#define ISO_GCODE_SPACE_H

#include "gcode/head.h"

#define SPACE_TOLERANCE 0.02 /* mm that the tip may be off its straight way while a table turns */
#define SPACE_STILL 5        /* um by which X, Y and Z may be off while a mandrel turns */
#define SPACE_SAID 0.05      /* share by which width or height change before it is said again */
#define SPACE_CLEARANCE 1.0  /* mm over all that is printed */
#define SPACE_TURN 0.966     /* cosine: a travel that turns the part by more goes around it */

iso_status iso_space_draw(iso_head *head, const iso_paths *paths, const iso_path *path,
                          const double *length, const iso_layer_pace *pace) ISO_MUST_CHECK;

/* Units. */
int32_t iso_space_height_above_all(const iso_head *head);

/* Up, until the part may be turned at will. */
void iso_space_rise(iso_head *head);

#endif

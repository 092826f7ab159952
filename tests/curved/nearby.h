/* Frames of beads from the places of other beads alone. */
#ifndef TESTS_CURVED_NEARBY_H
#define TESTS_CURVED_NEARBY_H

#include "beads.h"

/* `up` and, unless it is told, `height` of all beads. */
void nearby_frames(beads *b, int told);

#endif

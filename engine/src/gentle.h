/* Gentle fields: layers that lie so flat that no tool of that shape can touch what is printed,
 * wherever it goes.
 *
 * All that is printed before a layer F = r lies on it or below it. If no such surface is steeper
 * than s anywhere around the part, nothing that is printed is more than s d above the tip at a
 * distance of d: so it's enough that the tool is. That is one look at the field's bounds instead of
 * one at each move. */
#ifndef ISO_GENTLE_H
#define ISO_GENTLE_H

#include "clearance/clearance.h"
#include "curved.h"

/* Is a print of one object, with nothing tall around it, free for certain? `bare`: there's nothing
 * at all around it. mm of `tolerance`: what lines may be off their layer. */
bool gentle_is_free(const iso_curved *curved, const clearance_tool *tool, double tolerance,
                    bool bare);

#endif

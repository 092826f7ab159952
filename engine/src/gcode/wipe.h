/* Where the nozzle has just been, to wipe it there while the filament is drawn back. */
#ifndef ISO_GCODE_WIPE_H
#define ISO_GCODE_WIPE_H

#include <isoslice/path.h>

enum { ISO_WIPE_POINTS = 64 };

typedef struct iso_wipe {
    int32_t count;
    iso_point point[ISO_WIPE_POINTS]; /* in the order of the wipe */
} iso_wipe;

/* The points to pass when `path` has just been printed: a closed one over its beginning, an open
 * one back along itself; about as many as `length` units hold. */
void iso_wipe_remember(iso_wipe *wipe, const iso_path *path, const iso_path_vertex *vertex,
                       double length);

#endif

#include "gcode/wipe.h"

#include <math.h>

void iso_wipe_remember(iso_wipe *wipe, const iso_path *path, const iso_path_vertex *vertex,
                       double length) {
    iso_point at = vertex[path->closed ? 0 : path->count - 1].at;
    double reached = 0;
    wipe->count = 0;
    for (int32_t i = 1; i < path->count && i <= ISO_WIPE_POINTS && reached < length; i++) {
        iso_point next = vertex[path->closed ? i : path->count - 1 - i].at;
        double dx = (double)next.x - at.x, dy = (double)next.y - at.y;
        reached += sqrt(dx * dx + dy * dy);
        at = wipe->point[wipe->count++] = next;
    }
}

#include "fill/inside.h"

#include <math.h>

int is_inside(const iso_region *region, double x, double y, double tolerance) {
    int winding = 0;
    for (int i = 0; i < region->count; i++) {
        int from = region->first[i], to = region->first[i + 1];
        for (int j = from, last = to - 1; j < to; last = j++) {
            double ax = region->point[last].x - x, ay = region->point[last].y - y;
            double bx = region->point[j].x - x, by = region->point[j].y - y;
            double dx = bx - ax, dy = by - ay, square = dx * dx + dy * dy;
            double t = square > 0 ? -(ax * dx + ay * dy) / square : 0;
            t = t < 0 ? 0 : t > 1 ? 1 : t;
            if (hypot(ax + t * dx, ay + t * dy) <= tolerance)
                return 1;
            double turn = ax * by - ay * bx;
            if (ay <= 0 && by > 0 && turn > 0)
                winding++;
            if (ay > 0 && by <= 0 && turn < 0)
                winding--;
        }
    }
    return winding > 0;
}

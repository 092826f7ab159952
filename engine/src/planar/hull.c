#include "planar/hull.h"

#include <math.h>

#include "base/sort.h"
#include "planar/predicate.h"
#include "planar/region.h"

#define IS_LEFT(a, b) point_less(*(a), *(b))

ISO_SORT(sort_points, iso_point, IS_LEFT)

/* Andrew's monotone chains, 1979. */
static int32_t add_chain(iso_point *out, int32_t base, const iso_point *point, int32_t count,
                         int32_t step) {
    int32_t made = base;
    for (int32_t i = 0; i < count; i++, point += step) {
        while (made - base >= 2 && orient2d(out[made - 2], out[made - 1], *point) <= 0)
            made--;
        out[made++] = *point;
    }
    return made - 1; /* the last one starts the other chain */
}

int32_t hull_of(iso_point *out, iso_point *point, int32_t count) {
    int32_t kept = 0;
    sort_points(point, count);
    for (int32_t i = 0; i < count; i++)
        if (kept == 0 || !point_equal(point[i], point[kept - 1]))
            point[kept++] = point[i];
    if (kept < 3) {
        for (int32_t i = 0; i < kept; i++) /* none at all may have no place in memory */
            out[i] = point[i];
        return kept;
    }
    int32_t made = add_chain(out, 0, point, kept, 1);
    return add_chain(out, made, point + kept - 1, kept, -1);
}

/* The edges of both, merged by direction (de Berg et al., Computational Geometry, 13.3). The point
 * of b that is subtracted first is its highest rightmost one. */
int32_t hull_difference(iso_point *out, const iso_point *a, int32_t a_count, const iso_point *b,
                        int32_t b_count) {
    int32_t start = 0, made = 0;
    for (int32_t i = 1; i < b_count; i++)
        start = point_less(b[start], b[i]) ? i : start;
    for (int32_t i = 0, j = 0; i < a_count || j < b_count;) {
        iso_point p = a[i % a_count], p1 = a[(i + 1) % a_count];
        iso_point q = b[(start + j) % b_count], q1 = b[(start + j + 1) % b_count];
        int64_t side = cross((int64_t)p1.x - p.x, (int64_t)p1.y - p.y, (int64_t)q.x - q1.x,
                             (int64_t)q.y - q1.y);
        out[made++] = (iso_point){p.x - q.x, p.y - q.y};
        bool take_a = j == b_count || (i < a_count && side >= 0);
        bool take_b = i == a_count || (j < b_count && side <= 0);
        i += take_a;
        j += take_b;
    }
    return made;
}

/* Where the edge before a and the edge behind b meet, if that is at most `tolerance` beyond ab. */
static bool tip_of(iso_point *tip, iso_point before, iso_point a, iso_point b, iso_point behind,
                   int32_t tolerance) {
    double ux = (double)a.x - before.x, uy = (double)a.y - before.y;
    double vx = (double)b.x - behind.x, vy = (double)b.y - behind.y;
    double wx = (double)b.x - a.x, wy = (double)b.y - a.y;
    double turn = uy * vx - ux * vy;
    if (!(turn > 0)) /* they turn by half a circle or more */
        return false;
    double along = (wy * vx - wx * vy) / turn;
    double x = along * ux, y = along * uy, side = wy * x - wx * y;
    if (!(side * side <= (double)tolerance * tolerance * (wx * wx + wy * wy)))
        return false;
    *tip = (iso_point){a.x + (int32_t)(x < 0 ? x - 0.5 : x + 0.5),
                       a.y + (int32_t)(y < 0 ? y - 0.5 : y + 0.5)};
    return true;
}

/* Every other edge at most goes in a pass, so that what a tip stands on is still there. Two passes:
 * tips of tips would reach too far. */
int32_t hull_thin(iso_point *point, int32_t count, int32_t tolerance, iso_point *room) {
    for (int pass = 0; pass < 2; pass++) {
        int32_t made = 0;
        for (int32_t i = 0; i < count; i++) {
            iso_point tip;
            bool whole = i > 0 && i + 2 < count && count >= 5;
            if (whole &&
                tip_of(&tip, point[i - 1], point[i], point[i + 1], point[i + 2], tolerance / 2)) {
                room[made++] = tip;
                i++;
                if (i + 1 < count)
                    room[made++] = point[++i];
            } else {
                room[made++] = point[i];
            }
        }
        count = hull_of(point, room, made);
    }
    return count;
}

int64_t hull_double_area(const iso_point *point, int32_t count) {
    return contour_double_area(point, count);
}

static double square_to_edge(iso_point p, iso_point a, iso_point b) {
    double dx = (double)b.x - a.x, dy = (double)b.y - a.y;
    double px = (double)p.x - a.x, py = (double)p.y - a.y;
    double length = dx * dx + dy * dy, along = dx * px + dy * py;
    along = length > 0 ? fmin(fmax(along / length, 0), 1) : 0;
    px -= along * dx;
    py -= along * dy;
    return px * px + py * py;
}

/* Are all corners of b to the right of some edge of a? */
static bool separates(const iso_point *a, int32_t a_count, const iso_point *b, int32_t b_count) {
    for (int32_t i = 0; i < a_count; i++) {
        int32_t j = 0;
        while (j < b_count && orient2d(a[i], a[i + 1 == a_count ? 0 : i + 1], b[j]) < 0)
            j++;
        if (j == b_count)
            return true;
    }
    return false;
}

/* Hulls have a few dozen corners: every corner is held against every edge. */
double hull_distance(const iso_point *a, int32_t a_count, const iso_point *b, int32_t b_count) {
    if (!separates(a, a_count, b, b_count) && !separates(b, b_count, a, a_count))
        return 0;
    double nearest = INFINITY;
    for (int32_t i = 0; i < a_count; i++)
        for (int32_t j = 0; j < b_count; j++) {
            iso_point a1 = a[i + 1 == a_count ? 0 : i + 1], b1 = b[j + 1 == b_count ? 0 : j + 1];
            nearest = fmin(nearest, square_to_edge(b[j], a[i], a1));
            nearest = fmin(nearest, square_to_edge(a[i], b[j], b1));
        }
    return sqrt(nearest) / ISO_UNITS_PER_MM;
}

/* The offset of a region, united from its pieces: the region, a rectangle an edge, a join a corner.
 *
 * Distances to edges are compared exactly; the joins, whose directions are irrational, in doubles
 * with the slack of two units, far more than their rounding. */
#include "oracle.h"

#include <math.h>
#include <stddef.h>

enum { SLACK = 2 };

typedef struct arm { /* of a corner, from the vertex: unit vectors along the edge and out of it */
    double tx, ty, nx, ny;
} arm;

static arm arm_of(iso_point a, iso_point b, int flip) {
    double dx = (double)b.x - a.x, dy = (double)b.y - a.y, length = sqrt(dx * dx + dy * dy);
    arm m = {dx / length, dy / length, dy / length, -dx / length};
    if (flip)
        m = (arm){m.tx, m.ty, -m.nx, -m.ny};
    return m;
}

/* How far p is outside of the join at v, negative inside; the joins are convex. What `limit` is
 * exceeded by, or not, within a thousandth, counts as the larger join if `generous`. */
static double join_gap(iso_point v, arm in, arm out, const iso_offset_options *options, iso_point p,
                       int generous) {
    double distance = fabs((double)options->distance);
    double qx = (double)p.x - v.x, qy = (double)p.y - v.y;
    double cosine = in.nx * out.nx + in.ny * out.ny;
    double gap = fmax(in.nx * qx + in.ny * qy, out.nx * qx + out.ny * qy) - distance;
    gap = fmax(gap, fmax(-(in.tx * qx + in.ty * qy), out.tx * qx + out.ty * qy));
    /* bisector of the join: the sum of the normals, or of the tangents where that vanishes */
    double bx = cosine > -0.5 ? in.nx + out.nx : in.tx - out.tx;
    double by = cosine > -0.5 ? in.ny + out.ny : in.ty - out.ty;
    double length = sqrt(bx * bx + by * by), ahead = (bx * qx + by * qy) / length;
    double half = sqrt(fmax(0, (1 + cosine) / 2)); /* cosine of half the turn: 1 / mitre */
    int mitred = options->join == ISO_JOIN_MITRE &&
                 half * options->mitre_limit >= (generous ? 1 - 1e-3 : 1 + 1e-3);
    return mitred ? gap : fmax(gap, ahead - distance);
}

/* An island that shrinks away may take its joins with it, and so may a hole that is grown over:
 * what their mitres cut from the parts behind them is no one's wish. */
static int may_vanish(const iso_region *region, int32_t i, double distance) {
    double x0 = INFINITY, x1 = -INFINITY, y0 = INFINITY, y1 = -INFINITY, area = 0;
    for (int32_t k = 0; k < corners(region, i); k++) {
        iso_point p = corner(region, i, k), q = corner(region, i, k + 1);
        x0 = fmin(x0, p.x), x1 = fmax(x1, p.x);
        y0 = fmin(y0, p.y), y1 = fmax(y1, p.y);
        area += (double)p.x * q.y - (double)p.y * q.x;
    }
    return (area > 0) == (distance < 0) && fmin(x1 - x0, y1 - y0) <= 2 * fabs(distance);
}

static int in_a_join(const iso_region *region, const iso_offset_options *options, iso_point p,
                     double allowed, int generous) {
    int grows = options->distance > 0;
    double reach = fabs((double)options->distance) * fmax(options->mitre_limit, 1.5) + 10;
    for (int32_t i = 0; i < region->count; i++) {
        if (!generous && may_vanish(region, i, options->distance))
            continue;
        for (int32_t k = 0; k < corners(region, i); k++) {
            iso_point v = corner(region, i, k);
            if (fabs((double)p.x - v.x) > reach || fabs((double)p.y - v.y) > reach)
                continue;
            iso_point before = corner(region, i, k - 1), after = corner(region, i, k + 1);
            int64_t bend = turn(before, v, after);
            if (grows ? bend < 0 : bend > 0)
                continue;
            arm in = arm_of(before, v, !grows), out = arm_of(v, after, !grows);
            if (join_gap(v, in, out, options, p, generous) <= allowed)
                return 1;
        }
    }
    return 0;
}

int oracle_offset(const iso_region *region, const iso_offset_options *options, iso_point p) {
    int grows = options->distance > 0, round = options->join == ISO_JOIN_ROUND;
    int64_t distance = grows ? options->distance : -(int64_t)options->distance;
    int64_t beyond = SLACK + (round ? options->arc_tolerance : 0); /* arcs are drawn by tangents */
    int in = oracle_winding(region, p, NULL) != 0;
    if (grows ? in : !in) /* the side that spreads */
        return oracle_near(region, p, SLACK) ? 0 : grows ? 1 : -1;
    if (oracle_near(region, p, distance - SLACK))
        return grows ? 1 : -1;
    if (oracle_near(region, p, distance + beyond))
        return 0;
    if (round || !in_a_join(region, options, p, SLACK, 1))
        return grows ? -1 : 1;
    if (in_a_join(region, options, p, -SLACK, 0))
        return grows ? 1 : -1;
    return 0;
}

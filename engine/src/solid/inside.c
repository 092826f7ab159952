/* The point p that is asked for is moved by (e^3, e^2, e) with e > 0 below any bound: the point
 * p' next to it lies on no triangle's plane, and a ray along an axis from it meets no edge and no
 * corner (Edelsbrunner and Muecke, Simulation of Simplicity, 1990). Orientations are polynomials
 * of e whose first coefficient that is not zero has the sign. They are linear in the point, so
 * that a tie takes only coordinates of the triangle to break. What all triangles add up to is then
 * the winding number of p' itself: no vote, and the same along all six directions. Where p is not
 * on the surface, that is p's. */
#include "solid/inside.h"

static int sign(int64_t value) {
    return (value > 0) - (value < 0);
}

/* Which side of the line from a to b (relative to p) p' is on in the plane of axes u and v; 0 only
 * if a and b coincide there. */
static inline int side(int64_t au, int64_t av, int64_t bu, int64_t bv, int u_first) {
    int64_t left = au * bv, right = av * bu;
    if (left != right)
        return left > right ? 1 : -1;
    int by_u = sign(av - bv), by_v = sign(bu - au);
    return u_first ? (by_u ? by_u : by_v) : (by_v ? by_v : by_u);
}

/* Normal of a triangle, not of unit length. */
static void normal_of(int64_t normal[3], const int32_t *corner) {
    int64_t d[3], e[3];
    for (int k = 0; k < 3; k++) {
        d[k] = (int64_t)corner[3 + k] - corner[k];
        e[k] = (int64_t)corner[6 + k] - corner[k];
    }
    for (int k = 0; k < 3; k++)
        normal[k] = d[(k + 1) % 3] * e[(k + 2) % 3] - d[(k + 2) % 3] * e[(k + 1) % 3];
}

/* Sign of det(a - p, b - p, c - p): positive if p is behind the triangle. Doubles decide where they
 * can: differences are exact in them, and the bound of what the rest may be off is Shewchuk's
 * (Adaptive Precision Floating-Point Arithmetic, 1997, orient3d, A), which holds for any order of
 * the sums, and a little more. */
static int height_sign(const int32_t *corner, const int32_t *point) {
    static const double bound = 0x1p-50; /* (7 + 56 u) u, u = 2^-53, is less */
    double d[9], sum = 0, size = 0;
    for (int k = 0; k < 9; k++)
        d[k] = (double)corner[k] - (double)point[k % 3];
    for (int k = 0; k < 3; k++) {
        double left = d[3 + (k + 1) % 3] * d[6 + (k + 2) % 3];
        double right = d[3 + (k + 2) % 3] * d[6 + (k + 1) % 3];
        sum += d[k] * (left - right);
        size +=
            (d[k] < 0 ? -d[k] : d[k]) * ((left < 0 ? -left : left) + (right < 0 ? -right : right));
    }
    if (sum > bound * size)
        return 1;
    if (sum < -bound * size)
        return -1;
    int64_t normal[3];
    normal_of(normal, corner);
    __int128 exact = 0;
    for (int k = 0; k < 3; k++)
        exact += (__int128)normal[k] * ((int64_t)corner[k] - point[k]);
    return (exact > 0) - (exact < 0);
}

/* The same of p', which is in front of or behind every triangle that has an area. */
static int height_sign_moved(const int32_t *corner, const int32_t *point) {
    int height = height_sign(corner, point);
    if (height)
        return height;
    int64_t normal[3];
    normal_of(normal, corner);
    for (int k = 2; k >= 0; k--)
        if (normal[k])
            return -sign(normal[k]);
    return 0;
}

int inside_crossing(const int32_t corner[9], const int32_t point[3], int direction) {
    int axis = direction >> 1, backward = direction & 1;
    int64_t p = point[axis], a = corner[axis], b = corner[3 + axis], c = corner[6 + axis];
    int64_t least = a < b ? a : b, most = a < b ? b : a;
    least = c < least ? c : least;
    most = c > most ? c : most;
    if (backward ? least > p : most < p)
        return 0;

    int u = axis == 2 ? 0 : axis + 1, v = axis == 0 ? 2 : axis - 1, u_first = u > v;
    int64_t au = (int64_t)corner[u] - point[u], av = (int64_t)corner[v] - point[v];
    int64_t bu = (int64_t)corner[3 + u] - point[u], bv = (int64_t)corner[3 + v] - point[v];
    int ab = side(au, av, bu, bv, u_first);
    int64_t cu = (int64_t)corner[6 + u] - point[u], cv = (int64_t)corner[6 + v] - point[v];
    if (ab == 0 || ab != side(bu, bv, cu, cv, u_first) || ab != side(cu, cv, au, av, u_first))
        return 0;

    int ahead = backward ? most < p : least > p;
    if (!ahead)
        ahead = height_sign_moved(corner, point) == (backward ? -ab : ab);
    return ahead ? (backward ? -ab : ab) : 0;
}

/* p on the segment from a to b. */
static int on_segment(const int32_t *a, const int32_t *b, const int32_t *p) {
    for (int k = 0; k < 3; k++) {
        int l = (k + 1) % 3;
        if (p[k] < (a[k] < b[k] ? a[k] : b[k]) || p[k] > (a[k] < b[k] ? b[k] : a[k]) ||
            ((int64_t)b[k] - a[k]) * ((int64_t)p[l] - a[l]) !=
                ((int64_t)b[l] - a[l]) * ((int64_t)p[k] - a[k]))
            return 0;
    }
    return 1;
}

int inside_touches(const int32_t corner[9], const int32_t point[3]) {
    for (int k = 0; k < 3; k++) {
        int32_t p = point[k], a = corner[k], b = corner[3 + k], c = corner[6 + k];
        if ((p < a && p < b && p < c) || (p > a && p > b && p > c))
            return 0;
    }
    if (height_sign(corner, point))
        return 0;
    int64_t normal[3];
    normal_of(normal, corner);
    int axis = normal[0] ? 0 : normal[1] ? 1 : 2;
    if (!normal[axis])
        return on_segment(corner, corner + 3, point) || on_segment(corner + 3, corner + 6, point) ||
               on_segment(corner + 6, corner, point);
    int u = (axis + 1) % 3, v = (axis + 2) % 3, left = 0, right = 0;
    for (int k = 0; k < 3; k++) {
        const int32_t *a = corner + 3 * k, *b = corner + 3 * ((k + 1) % 3);
        int64_t x = ((int64_t)a[u] - point[u]) * ((int64_t)b[v] - point[v]);
        int64_t y = ((int64_t)a[v] - point[v]) * ((int64_t)b[u] - point[u]);
        left |= x > y;
        right |= x < y;
    }
    return !(left && right);
}

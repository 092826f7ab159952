/* Exact predicates on iso_points: int64 throughout, int128 at true crossings alone (|x|, |y| <=
 * 2^24). */
#ifndef ISO_PLANAR_PREDICATE_H
#define ISO_PLANAR_PREDICATE_H

#include <stdbool.h>
#include <stdint.h>

#include <isoslice/geometry.h>

__extension__ typedef __int128 iso_int128;

static inline bool point_equal(iso_point a, iso_point b) {
    return a.x == b.x && a.y == b.y;
}

/* Lexicographic: left to right, then bottom to top. */
static inline bool point_less(iso_point a, iso_point b) {
    return a.x != b.x ? a.x < b.x : a.y < b.y;
}

static inline int64_t cross(int64_t ux, int64_t uy, int64_t vx, int64_t vy) {
    return ux * vy - uy * vx;
}

/* Twice the signed area of abc: > 0 if c is left of a -> b. At most 2^51. */
static inline int64_t orient2d(iso_point a, iso_point b, iso_point c) {
    return cross((int64_t)b.x - a.x, (int64_t)b.y - a.y, (int64_t)c.x - a.x, (int64_t)c.y - a.y);
}

static inline bool box_holds(iso_point a, iso_point b, iso_point c) {
    return (a.x < b.x ? a.x <= c.x && c.x <= b.x : b.x <= c.x && c.x <= a.x) &&
           (a.y < b.y ? a.y <= c.y && c.y <= b.y : b.y <= c.y && c.y <= a.y);
}

static inline iso_box box_of(iso_point a, iso_point b) {
    return (iso_box){{a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y},
                     {a.x < b.x ? b.x : a.x, a.y < b.y ? b.y : a.y}};
}

static inline bool boxes_meet(const iso_box *a, const iso_box *b) {
    return (a->min.x <= b->max.x) & (b->min.x <= a->max.x) & (a->min.y <= b->max.y) &
           (b->min.y <= a->max.y);
}

static inline bool box_has(const iso_box *box, iso_point p) {
    return (box->min.x <= p.x) & (p.x <= box->max.x) & (box->min.y <= p.y) & (p.y <= box->max.y);
}

static inline void box_add(iso_box *box, iso_point p) {
    box->min.x = p.x < box->min.x ? p.x : box->min.x;
    box->min.y = p.y < box->min.y ? p.y : box->min.y;
    box->max.x = p.x > box->max.x ? p.x : box->max.x;
    box->max.y = p.y > box->max.y ? p.y : box->max.y;
}

/* Does the segment ab meet the hot pixel of c, the half-open unit square around it? (Hobby 1999.)
 * The line does if it comes within (|dx| + |dy|) / 2 of c in the measure of orient2d; on a tie it
 * touches one corner, and only the lower left one belongs to the pixel. Within the box of ab the
 * line is the segment. */
static inline bool meets_pixel(iso_point a, iso_point b, iso_point c, int64_t orientation) {
    int64_t dx = (int64_t)b.x - a.x, dy = (int64_t)b.y - a.y;
    int64_t reach = (dx < 0 ? -dx : dx) + (dy < 0 ? -dy : dy);
    int64_t twice = 2 * orientation, size = twice < 0 ? -twice : twice;
    if (size > reach || !box_holds(a, b, c))
        return false;
    return size < reach || twice == dx - dy;
}

/* Do the directions u and v compare u before v, counter-clockwise from just past straight down? */
static inline int direction_half(int64_t x, int64_t y) {
    return x > 0 || (x == 0 && y > 0) ? 0 : 1;
}

static inline bool direction_less(int64_t ux, int64_t uy, int64_t vx, int64_t vy) {
    int hu = direction_half(ux, uy), hv = direction_half(vx, vy);
    return hu != hv ? hu < hv : cross(ux, uy, vx, vy) > 0;
}

/* floor(n / d), d > 0 */
static inline int64_t floor_divide(iso_int128 n, iso_int128 d) {
    iso_int128 q = n / d;
    return (int64_t)(q - (n % d < 0));
}

/* Where the lines ab and cd cross, rounded to the nearest point (halves up). They must cross
 * properly; oa and ob are orient2d of c, d with a and with b, of opposite signs. */
static inline iso_point crossing_point(iso_point a, iso_point b, int64_t oa, int64_t ob) {
    int64_t n = oa, m = oa - ob; /* a + (b - a) n / m */
    if (m < 0)
        n = -n, m = -m;
    int64_t dx = (int64_t)b.x - a.x, dy = (int64_t)b.y - a.y;
    int64_t x = floor_divide((iso_int128)dx * n * 2 + m, (iso_int128)m * 2);
    int64_t y = floor_divide((iso_int128)dy * n * 2 + m, (iso_int128)m * 2);
    return (iso_point){(int32_t)(a.x + x), (int32_t)(a.y + y)};
}

/* Of two segments that both span height y (low end at or below y, high end above it): is a's
 * crossing with that height left of b's? Equal crossings compare just above. Ends given low first.
 */
static inline bool crosses_left_of(iso_point a0, iso_point a1, iso_point b0, iso_point b1,
                                   int32_t y) {
    int64_t adx = (int64_t)a1.x - a0.x, ady = (int64_t)a1.y - a0.y;
    int64_t bdx = (int64_t)b1.x - b0.x, bdy = (int64_t)b1.y - b0.y;
    int64_t an = (int64_t)a0.x * ady + adx * ((int64_t)y - a0.y);
    int64_t bn = (int64_t)b0.x * bdy + bdx * ((int64_t)y - b0.y);
    iso_int128 left = (iso_int128)an * bdy, right = (iso_int128)bn * ady;
    if (left != right)
        return left < right;
    return adx * bdy < bdx * ady;
}

#endif

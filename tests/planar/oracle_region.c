/* Is it a region? Every pair of edges, every corner, every contour. */
#include "oracle.h"

#include <stdlib.h>

typedef struct visit { /* of a vertex by a contour */
    iso_point before, at, after;
} visit;

static int by_place(const void *left, const void *right) {
    const visit *a = left, *b = right;
    if (a->at.x != b->at.x)
        return a->at.x < b->at.x ? -1 : 1;
    return (a->at.y > b->at.y) - (a->at.y < b->at.y);
}

static int strictly_between(int64_t a, int64_t p, int64_t b) {
    return (a < p && p < b) || (b < p && p < a);
}

static int overlap(int64_t a, int64_t b, int64_t c, int64_t d) {
    int64_t low = (a < b ? a : b) > (c < d ? c : d) ? (a < b ? a : b) : (c < d ? c : d);
    int64_t high = (a > b ? a : b) < (c > d ? c : d) ? (a > b ? a : b) : (c > d ? c : d);
    return low < high;
}

static const char *edge_pair_fault(iso_point a, iso_point b, iso_point c, iso_point d) {
    if ((a.x < c.x && a.x < d.x && b.x < c.x && b.x < d.x) ||
        (a.x > c.x && a.x > d.x && b.x > c.x && b.x > d.x) ||
        (a.y < c.y && a.y < d.y && b.y < c.y && b.y < d.y) ||
        (a.y > c.y && a.y > d.y && b.y > c.y && b.y > d.y))
        return NULL;
    int to_c = sign_of(turn(a, b, c)), to_d = sign_of(turn(a, b, d));
    int to_a = sign_of(turn(c, d, a)), to_b = sign_of(turn(c, d, b));
    if (to_c * to_d < 0 && to_a * to_b < 0)
        return "edges cross";
    if (!to_c && !to_d && (overlap(a.x, b.x, c.x, d.x) || overlap(a.y, b.y, c.y, d.y)))
        return "edges overlap";
    return NULL;
}

/* A vertex inside an edge may touch it, not pass through it. */
static const char *touch_fault(iso_point a, iso_point b, const visit *v) {
    if (turn(a, b, v->at) != 0 ||
        !(strictly_between(a.x, v->at.x, b.x) || strictly_between(a.y, v->at.y, b.y)))
        return NULL;
    int before = sign_of(turn(a, b, v->before)), after = sign_of(turn(a, b, v->after));
    return before * after < 0 ? "a contour crosses an edge at a vertex" : NULL;
}

/* Does d lie in the turn that goes counter-clockwise from a to b around the origin? */
static int in_turn(iso_point o, iso_point a, iso_point b, iso_point d) {
    if (turn(o, a, b) > 0)
        return turn(o, a, d) > 0 && turn(o, d, b) > 0;
    return !(turn(o, b, d) >= 0 && turn(o, d, a) >= 0);
}

static const char *crossing_fault(const visit *u, const visit *v) {
    int before = in_turn(u->at, u->before, u->after, v->before);
    int after = in_turn(u->at, u->before, u->after, v->after);
    return before != after ? "contours cross at a shared vertex" : NULL;
}

static const char *visits_fault(visit *list, int32_t count) {
    qsort(list, (size_t)count, sizeof *list, by_place);
    for (int32_t i = 0; i < count; i++)
        for (int32_t j = i + 1; j < count && same_point(list[i].at, list[j].at); j++) {
            const char *fault = crossing_fault(&list[i], &list[j]);
            if (fault)
                return fault;
        }
    return NULL;
}

static const char *pairs_fault(const iso_region *region, visit *list) {
    int32_t n = 0;
    for (int32_t i = 0; i < region->count; i++)
        for (int32_t k = 0; k < corners(region, i); k++)
            list[n++] =
                (visit){corner(region, i, k - 1), corner(region, i, k), corner(region, i, k + 1)};
    for (int32_t i = 0; i < n; i++)
        for (int32_t j = 0; j < n; j++) {
            const char *fault = NULL;
            if (j < i)
                fault = edge_pair_fault(list[i].at, list[i].after, list[j].at, list[j].after);
            if (!fault)
                fault = touch_fault(list[i].at, list[i].after, &list[j]);
            if (fault)
                return fault;
        }
    return visits_fault(list, n);
}

/* Twice the coordinates, so that middles are whole; turned by a right angle if `turned`. */
static iso_point doubled(iso_point p, int turned) {
    return turned ? (iso_point){-2 * p.y, 2 * p.x} : (iso_point){2 * p.x, 2 * p.y};
}

/* Crossings of contour `only` (or all: -1) with the ray from m to the right, m itself left out.
 * *through counts the edges through m. */
static int ray_winding(const iso_region *region, int32_t only, iso_point m, int turned,
                       int *through) {
    int winding = 0;
    *through = 0;
    for (int32_t i = only < 0 ? 0 : only; i < (only < 0 ? region->count : only + 1); i++)
        for (int32_t k = 0; k < corners(region, i); k++) {
            iso_point a = doubled(corner(region, i, k), turned);
            iso_point b = doubled(corner(region, i, k + 1), turned);
            int64_t side = turn(a, b, m);
            int reaches = (a.y <= m.y && m.y <= b.y) || (b.y <= m.y && m.y <= a.y);
            int spans = (a.x <= m.x && m.x <= b.x) || (b.x <= m.x && m.x <= a.x);
            if (reaches && spans && side == 0)
                ++*through;
            else if (a.y <= m.y && b.y > m.y)
                winding += side > 0;
            else if (a.y > m.y && b.y <= m.y)
                winding -= side < 0;
        }
    return winding;
}

static iso_point middle(iso_point a, iso_point b, int turned) {
    return turned ? (iso_point){-(a.y + b.y), a.x + b.x} : (iso_point){a.x + b.x, a.y + b.y};
}

/* Winding 1 just left of every edge and 0 just right of it. */
static const char *sides_fault(const iso_region *region) {
    for (int32_t i = 0; i < region->count; i++)
        for (int32_t k = 0; k < corners(region, i); k++) {
            iso_point a = corner(region, i, k), b = corner(region, i, k + 1);
            int turned = a.y == b.y, through;
            iso_point m = middle(a, b, turned);
            int winding = ray_winding(region, -1, m, turned, &through);
            int up = doubled(b, turned).y > doubled(a, turned).y;
            if (through == 1 && winding != (up ? 0 : 1))
                return "winding is not 1 left and 0 right of an edge";
        }
    return NULL;
}

static wide double_area(const iso_region *region, int32_t i) {
    wide sum = 0;
    for (int32_t k = 0; k < corners(region, i); k++) {
        iso_point a = corner(region, i, k), b = corner(region, i, k + 1);
        sum += (wide)a.x * b.y - (wide)a.y * b.x;
    }
    return sum;
}

static int contains(const iso_region *region, int32_t outer, int32_t inner) {
    for (int32_t k = 0; k < corners(region, inner); k++) {
        int through;
        iso_point m = middle(corner(region, inner, k), corner(region, inner, k + 1), 0);
        int winding = ray_winding(region, outer, m, 0, &through);
        if (!through)
            return winding != 0;
    }
    return 0;
}

static const char *nesting_fault(const iso_region *region, const wide *area) {
    for (int32_t i = 0; i < region->count; i++) {
        int32_t parent = -1, depth = 0;
        wide least = 0;
        for (int32_t j = 0; j < region->count; j++) {
            wide size = area[j] < 0 ? -area[j] : area[j];
            if (j == i || !contains(region, j, i))
                continue;
            depth++;
            if (parent < 0 || size < least) {
                parent = j;
                least = size;
            }
        }
        if (area[i] == 0 || (area[i] > 0) != (depth % 2 == 0))
            return "a contour is turned the wrong way";
        if (region->parent[i] != parent)
            return "a parent is wrong";
        if (region->parent[i] >= i)
            return "a parent comes after its child";
    }
    return NULL;
}

static const char *shape_fault(const iso_region *region) {
    if (region->first[0] != 0)
        return "the first contour does not start at 0";
    for (int32_t i = 0; i < region->count; i++) {
        if (corners(region, i) < 3)
            return "a contour has less than three points";
        for (int32_t k = 0; k < corners(region, i); k++) {
            iso_point p = corner(region, i, k);
            if (p.x > ISO_COORDINATE_MAX || p.x < -ISO_COORDINATE_MAX || p.y > ISO_COORDINATE_MAX ||
                p.y < -ISO_COORDINATE_MAX)
                return "a point is out of range";
            if (same_point(p, corner(region, i, k + 1)))
                return "an edge has no length";
        }
    }
    return NULL;
}

const char *oracle_region_fault(const iso_region *region) {
    if (region->count == 0)
        return NULL;
    const char *fault = shape_fault(region);
    if (fault)
        return fault;
    visit *list = malloc((size_t)point_count(region) * sizeof *list);
    fault = pairs_fault(region, list);
    free(list);
    if (!fault)
        fault = sides_fault(region);
    if (fault)
        return fault;
    wide *area = malloc((size_t)region->count * sizeof *area);
    for (int32_t i = 0; i < region->count; i++)
        area[i] = double_area(region, i);
    fault = nesting_fault(region, area);
    free(area);
    return fault;
}

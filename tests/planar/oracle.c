#include "oracle.h"

#include <math.h>
#include <stdlib.h>

static int on_segment(iso_point a, iso_point b, iso_point p) {
    if ((p.x < a.x && p.x < b.x) || (p.x > a.x && p.x > b.x))
        return 0;
    if ((p.y < a.y && p.y < b.y) || (p.y > a.y && p.y > b.y))
        return 0;
    return turn(a, b, p) == 0;
}

int oracle_winding(const iso_region *contours, iso_point p, int *on_edge) {
    int winding = 0;
    if (on_edge)
        *on_edge = 0;
    for (int32_t i = 0; i < contours->count; i++) {
        int32_t begin = contours->first[i], end = contours->first[i + 1];
        for (int32_t k = begin, before = end - 1; k < end; before = k++) {
            iso_point a = contours->point[before], b = contours->point[k];
            if ((a.y < p.y && b.y < p.y) || (a.y > p.y && b.y > p.y))
                continue;
            if (on_edge && on_segment(a, b, p))
                *on_edge = 1;
            if (a.y <= p.y && b.y > p.y)
                winding += turn(a, b, p) > 0;
            else if (a.y > p.y && b.y <= p.y)
                winding -= turn(a, b, p) < 0;
        }
    }
    return winding;
}

static int segment_near(iso_point a, iso_point b, iso_point p, int64_t radius) {
    int64_t dx = (int64_t)b.x - a.x, dy = (int64_t)b.y - a.y;
    int64_t ax = (int64_t)p.x - a.x, ay = (int64_t)p.y - a.y;
    int64_t bx = (int64_t)p.x - b.x, by = (int64_t)p.y - b.y;
    int64_t along = dx * ax + dy * ay, length2 = dx * dx + dy * dy;
    if (along <= 0)
        return ax * ax + ay * ay <= radius * radius;
    if (along >= length2)
        return bx * bx + by * by <= radius * radius;
    wide across = turn(a, b, p);
    return across * across <= (wide)(radius * radius) * length2;
}

int oracle_near(const iso_region *contours, iso_point p, int64_t radius) {
    if (radius < 0)
        return 0;
    for (int32_t i = 0; i < contours->count; i++) {
        int32_t begin = contours->first[i], end = contours->first[i + 1];
        for (int32_t k = begin, before = end - 1; k < end; before = k++) {
            iso_point a = contours->point[before], b = contours->point[k];
            int64_t low = a.y < b.y ? a.y : b.y, high = a.y < b.y ? b.y : a.y;
            if (p.y + radius < low || p.y - radius > high)
                continue;
            int64_t left = a.x < b.x ? a.x : b.x, right = a.x < b.x ? b.x : a.x;
            if (p.x + radius < left || p.x - radius > right)
                continue;
            if (segment_near(a, b, p, radius))
                return 1;
        }
    }
    return 0;
}

int oracle_filled(iso_fill_rule rule, int winding) {
    switch (rule) {
    case ISO_FILL_POSITIVE:
        return winding >= 1;
    case ISO_FILL_NONZERO:
        return winding != 0;
    case ISO_FILL_EVEN_ODD:
        return winding & 1;
    }
    return -1;
}

int oracle_boolean(iso_boolean_kind kind, int in_a, int in_b) {
    switch (kind) {
    case ISO_UNION:
        return in_a | in_b;
    case ISO_INTERSECTION:
        return in_a & in_b;
    case ISO_DIFFERENCE:
        return in_a & !in_b;
    case ISO_EXCLUSIVE:
        return in_a ^ in_b;
    }
    return -1;
}

long double oracle_perimeter(const iso_region *contours) {
    long double sum = 0;
    for (int32_t i = 0; i < contours->count; i++)
        for (int32_t k = 0; k < corners(contours, i); k++) {
            iso_point a = corner(contours, i, k), b = corner(contours, i, k + 1);
            sum += hypotl((long double)b.x - a.x, (long double)b.y - a.y);
        }
    return sum;
}

/* --- area by slabs --- */

typedef struct slab_edge {
    iso_point low, high; /* low.y < high.y */
    int up, operand;
    long double x; /* where it crosses the middle of the slab at hand */
} slab_edge;

static int by_value(const void *left, const void *right) {
    long double a = *(const long double *)left, b = *(const long double *)right;
    return (a > b) - (a < b);
}

static int by_crossing(const void *left, const void *right) {
    long double a = ((const slab_edge *)left)->x, b = ((const slab_edge *)right)->x;
    return (a > b) - (a < b);
}

static int32_t slab_edges(slab_edge *edge, const iso_region *contours, int operand) {
    int32_t n = 0;
    for (int32_t i = 0; i < contours->count; i++)
        for (int32_t k = 0; k < corners(contours, i); k++) {
            iso_point a = corner(contours, i, k), b = corner(contours, i, k + 1);
            if (a.y < b.y)
                edge[n++] = (slab_edge){.low = a, .high = b, .up = 1, .operand = operand};
            else if (a.y > b.y)
                edge[n++] = (slab_edge){.low = b, .high = a, .up = -1, .operand = operand};
        }
    return n;
}

/* Heights of all vertices and crossings, sorted. Crossings of collinear edges end at vertices. */
static int64_t slab_heights(long double *height, const slab_edge *edge, int32_t n) {
    int64_t count = 0;
    for (int32_t i = 0; i < n; i++) {
        height[count++] = edge[i].low.y;
        height[count++] = edge[i].high.y;
        for (int32_t j = 0; j < i; j++) {
            int64_t c = turn(edge[i].low, edge[i].high, edge[j].low);
            int64_t d = turn(edge[i].low, edge[i].high, edge[j].high);
            int64_t e = turn(edge[j].low, edge[j].high, edge[i].low);
            int64_t f = turn(edge[j].low, edge[j].high, edge[i].high);
            if (sign_of(c) * sign_of(d) < 0 && sign_of(e) * sign_of(f) < 0)
                height[count++] = edge[j].low.y + ((long double)edge[j].high.y - edge[j].low.y) *
                                                      ((long double)c / ((long double)c - d));
        }
    }
    qsort(height, (size_t)count, sizeof *height, by_value);
    return count;
}

static long double edge_x(const slab_edge *edge, long double y) {
    long double t = (y - edge->low.y) / ((long double)edge->high.y - edge->low.y);
    return edge->low.x + t * ((long double)edge->high.x - edge->low.x);
}

static long double slab_area(slab_edge *here, int32_t n, long double height, oracle_inside *inside,
                             const void *context) {
    long double area = 0;
    int winding[2] = {0, 0};
    qsort(here, (size_t)n, sizeof *here, by_crossing);
    for (int32_t i = 0; i + 1 < n; i++) {
        winding[here[i].operand] -= here[i].up; /* right of an edge that runs up is one less */
        if (inside(context, winding[0], winding[1]))
            area += height * (here[i + 1].x - here[i].x);
    }
    return area;
}

long double oracle_area(const iso_region *a, const iso_region *b, oracle_inside *inside,
                        const void *context) {
    int64_t most = point_count(a) + (b ? point_count(b) : 0) + 1;
    slab_edge *edge = malloc((size_t)most * sizeof *edge);
    slab_edge *here = malloc((size_t)most * sizeof *here);
    long double *height = malloc((size_t)(2 * most + most * most / 2) * sizeof *height);
    int32_t n = slab_edges(edge, a, 0);
    if (b)
        n += slab_edges(edge + n, b, 1);
    int64_t heights = slab_heights(height, edge, n);
    long double area = 0;
    for (int64_t s = 0; s + 1 < heights; s++) {
        long double middle = (height[s] + height[s + 1]) / 2;
        if (!(height[s] < height[s + 1]))
            continue;
        int32_t crossing = 0;
        for (int32_t i = 0; i < n; i++)
            if (edge[i].low.y < middle && middle < edge[i].high.y) {
                here[crossing] = edge[i];
                here[crossing++].x = edge_x(&edge[i], middle);
            }
        area += slab_area(here, crossing, height[s + 1] - height[s], inside, context);
    }
    free(edge);
    free(here);
    free(height);
    return area;
}

/* --- sameness --- */

static int compare_points(iso_point a, iso_point b) {
    if (a.y != b.y)
        return a.y < b.y ? -1 : 1;
    return (a.x > b.x) - (a.x < b.x);
}

typedef struct ring {
    const iso_point *point;
    int32_t count, start;
} ring;

static int compare_rings(const void *left, const void *right) {
    const ring *a = left, *b = right;
    for (int32_t k = 0; k < a->count && k < b->count; k++) {
        int order = compare_points(a->point[(a->start + k) % a->count],
                                   b->point[(b->start + k) % b->count]);
        if (order)
            return order;
    }
    return (a->count > b->count) - (a->count < b->count);
}

/* Every contour from its lowest vertex (a vertex visited twice: the lesser of the two readings). */
static ring *sorted_rings(const iso_region *region) {
    ring *rings = malloc(((size_t)region->count + 1) * sizeof *rings);
    for (int32_t i = 0; i < region->count; i++) {
        ring best = {region->point + region->first[i], corners(region, i), 0};
        for (int32_t k = 1; k < best.count; k++) {
            ring other = {best.point, best.count, k};
            if (compare_points(other.point[k], best.point[best.start]) <= 0 &&
                compare_rings(&other, &best) < 0)
                best = other;
        }
        rings[i] = best;
    }
    qsort(rings, (size_t)region->count, sizeof *rings, compare_rings);
    return rings;
}

int oracle_same(const iso_region *a, const iso_region *b) {
    if (a->count != b->count || point_count(a) != point_count(b))
        return 0;
    ring *in_a = sorted_rings(a), *in_b = sorted_rings(b);
    int same = 1;
    for (int32_t i = 0; i < a->count && same; i++)
        same = compare_rings(&in_a[i], &in_b[i]) == 0;
    free(in_a);
    free(in_b);
    return same;
}

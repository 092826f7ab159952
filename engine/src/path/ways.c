#include "path/ways.h"

#include <math.h>

enum { STEPS_MAX = 1 << 20, LOOK = 64 /* steps that a look along a way costs, about */ };

iso_status iso_ways_new(iso_ways *ways, const iso_edge_grid *grid, int32_t vertices,
                        iso_arena *scratch) {
    *ways = (iso_ways){.grid = grid};
    ISO_TRY(ISO_PUSH(ways->bend, scratch, vertices));
    ISO_TRY(ISO_PUSH(ways->length, scratch, (int64_t)vertices + 1));
    ISO_TRY(ISO_PUSH(ways->back, scratch, (int64_t)vertices + 1));
    ISO_TRY(ISO_PUSH(ways->settled, scratch, (int64_t)vertices + 1));
    return ISO_PUSH(ways->point, scratch, (int64_t)vertices + 1);
}

static int64_t turn(iso_point a, iso_point b, iso_point c) {
    return ((int64_t)b.x - a.x) * ((int64_t)c.y - a.y) -
           ((int64_t)b.y - a.y) * ((int64_t)c.x - a.x);
}

void iso_ways_add(iso_ways *ways, iso_point before, iso_point at, iso_point after) {
    if (turn(before, at, after) < 0)
        ways->bend[ways->count++] = (iso_bend){at, before, after};
}

static int sees(const iso_ways *ways, iso_point a, iso_point b) {
    return !iso_edge_grid_meets(ways->grid, a, b, ways->begin, ways->end);
}

int iso_ways_is_inside(const iso_ways *ways, iso_point from, iso_point to) {
    if (!sees(ways, from, to))
        return 0;
    iso_point middle = {from.x + (to.x - from.x) / 2, from.y + (to.y - from.y) / 2};
    return iso_edge_grid_contains(ways->grid, middle, ways->begin, ways->end) ||
           iso_edge_grid_has(ways->grid, from, to);
}

static double distance(iso_point a, iso_point b) {
    return sqrt((double)iso_distance_squared(a, b));
}

/* Does the line from p through the bend leave both its edges on one side? */
static int is_tangent(const iso_bend *bend, iso_point p) {
    int64_t a = turn(p, bend->at, bend->before), b = turn(p, bend->at, bend->after);
    return (a >= 0 && b >= 0) || (a <= 0 && b <= 0);
}

/* From node u, `count` standing for where the way begins, to bend v or, if v = count, its end. */
static int leads(const iso_ways *ways, int32_t u, int32_t v, iso_point from, iso_point to) {
    const iso_bend *a = u < ways->count ? &ways->bend[u] : NULL;
    const iso_bend *b = v < ways->count ? &ways->bend[v] : NULL;
    iso_point p = a ? a->at : from, q = b ? b->at : to;
    if (a && b)
        return sees(ways, p, q);
    return iso_ways_is_inside(ways, p, q);
}

static void unwind(iso_ways *ways) {
    int32_t n = 0;
    for (int32_t v = ways->back[ways->count]; v >= 0; v = ways->back[v])
        n++;
    ways->points = n;
    for (int32_t v = ways->back[ways->count]; v >= 0; v = ways->back[v])
        ways->point[--n] = ways->bend[v].at;
}

static void relax(iso_ways *ways, int32_t u, iso_point from, iso_point to, double longest) {
    const iso_bend *a = u < ways->count ? &ways->bend[u] : NULL;
    double so_far = a ? ways->length[u] : 0;
    iso_point p = a ? a->at : from;
    for (int32_t v = 0; v <= ways->count; v++) {
        const iso_bend *b = v < ways->count ? &ways->bend[v] : NULL;
        if (ways->settled[v] || (a && !is_tangent(a, b ? b->at : to)) || (b && !is_tangent(b, p)))
            continue;
        double length = so_far + distance(p, b ? b->at : to);
        if (length >= ways->length[v] || length + (b ? distance(b->at, to) : 0) > longest)
            continue;
        if (!leads(ways, u, v, from, to))
            continue;
        ways->length[v] = length;
        ways->back[v] = a ? u : -1;
    }
}

int iso_ways_find(iso_ways *ways, iso_point from, iso_point to, double longest) {
    int32_t n = ways->count;
    for (int32_t v = 0; v <= n; v++) {
        ways->length[v] = INFINITY;
        ways->settled[v] = 0;
    }
    int64_t steps = STEPS_MAX;
    for (int32_t u = n; steps > 0; steps -= 2 * (int64_t)n + LOOK) {
        relax(ways, u, from, to, longest);
        double least = INFINITY;
        u = -1;
        for (int32_t v = 0; v <= n; v++) {
            double f = ways->length[v] + (v < n ? distance(ways->bend[v].at, to) : 0);
            if (!ways->settled[v] && f < least) {
                least = f;
                u = v;
            }
        }
        if (u < 0)
            return 0;
        if (u == n) {
            unwind(ways);
            return 1;
        }
        ways->settled[u] = 1;
    }
    return 0;
}

#include "path/ways.h"

#include <math.h>

enum { STEPS_MAX = 1 << 20, LOOK = 64 /* steps that a look along a way costs, about */ };

iso_status iso_ways_new(iso_ways *ways, const iso_edge_grid *grid, int32_t vertices,
                        iso_arena *scratch) {
    *ways = (iso_ways){.grid = grid, .patience = STEPS_MAX};
    ISO_TRY(ISO_PUSH(ways->bend, scratch, vertices));
    ISO_TRY(ISO_PUSH(ways->near, scratch, vertices));
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

/* The bend of node u, or NULL for the ends of the way. */
static const iso_bend *bend_of(const iso_ways *ways, int32_t u) {
    return u >= 0 && u < ways->nears ? &ways->bend[ways->near[u]] : NULL;
}

static int leads(const iso_ways *ways, const iso_bend *a, const iso_bend *b, iso_point from,
                 iso_point to) {
    return a && b ? sees(ways, a->at, b->at)
                  : iso_ways_is_inside(ways, a ? a->at : from, b ? b->at : to);
}

static void unwind(iso_ways *ways) {
    int32_t n = 0;
    for (int32_t v = ways->back[ways->nears]; v >= 0; v = ways->back[v])
        n++;
    ways->points = n;
    for (int32_t v = ways->back[ways->nears]; v >= 0; v = ways->back[v])
        ways->point[--n] = bend_of(ways, v)->at;
}

static void relax(iso_ways *ways, int32_t u, iso_point from, iso_point to, double longest) {
    const iso_bend *a = bend_of(ways, u);
    double so_far = a ? ways->length[u] : 0;
    iso_point p = a ? a->at : from;
    for (int32_t v = 0; v <= ways->nears; v++) {
        const iso_bend *b = bend_of(ways, v);
        iso_point q = b ? b->at : to;
        if (ways->settled[v] || (a && !is_tangent(a, q)) || (b && !is_tangent(b, p)))
            continue;
        double length = so_far + distance(p, q);
        if (length >= ways->length[v] || length + (b ? distance(q, to) : 0) > longest)
            continue;
        if (!leads(ways, a, b, from, to))
            continue;
        ways->length[v] = length;
        ways->back[v] = u;
    }
}

/* Those in the ellipse of the allowed length; a box around it sorts out most of the others. */
static void find_near(iso_ways *ways, iso_point from, iso_point to, double longest) {
    double x = ((double)from.x + to.x) / 2, y = ((double)from.y + to.y) / 2, reach = longest / 2;
    ways->nears = 0;
    for (int32_t i = 0; i < ways->count; i++) {
        iso_point p = ways->bend[i].at;
        if (p.x < x - reach || p.x > x + reach || p.y < y - reach || p.y > y + reach)
            continue;
        if (distance(from, p) + distance(p, to) <= longest)
            ways->near[ways->nears++] = i;
    }
}

/* The unsettled node with the shortest way through it, if it went on straight; -1: none. */
static int32_t next_node(const iso_ways *ways, iso_point to) {
    double least = INFINITY;
    int32_t best = -1;
    for (int32_t v = 0; v <= ways->nears; v++) {
        const iso_bend *b = bend_of(ways, v);
        if (ways->settled[v] || ways->length[v] == INFINITY)
            continue;
        double through = ways->length[v] + (b ? distance(b->at, to) : 0);
        if (through < least) {
            least = through;
            best = v;
        }
    }
    return best;
}

int iso_ways_find(iso_ways *ways, iso_point from, iso_point to, double longest) {
    find_near(ways, from, to, longest);
    int32_t n = ways->nears, u = -1;
    for (int32_t v = 0; v <= n; v++) {
        ways->length[v] = INFINITY;
        ways->settled[v] = 0;
    }
    for (int64_t steps = ways->patience; steps > 0; steps -= 2 * (int64_t)n + LOOK) {
        relax(ways, u, from, to, longest);
        u = next_node(ways, to);
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

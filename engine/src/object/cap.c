#include "object/cap.h"

#include "base/sort.h"
#include "planar/predicate.h"

/* Ear clipping (Meisters, 1975) of loops with their holes bridged in (Eberly, Triangulation by ear
 * clipping, 2002). Quadratic in the corners of one cap, which are the crossings of one level; what
 * it must be instead of fast is unable to fail: if rounding leaves no ear, the next corner is cut
 * off all the same. A cap is flat, so that this changes neither volume nor any slice.
 *
 * A node is a corner and the side that leaves it. What lies across a side is a dart, or, for the
 * two sides of a bridge, each other. */
typedef struct node {
    iso_point at;
    int32_t vertex, next, before;
    int32_t dart; /* across; -1: that of the mate, not made yet */
    int32_t mate; /* node, where there is no dart */
    bool reflex;
} node;

typedef struct hole {
    int32_t right; /* node, its rightmost corner */
    iso_point at;
} hole;

typedef struct capper {
    iso_growing_mesh *to;
    node *node;
    int32_t nodes;
    int32_t *start; /* [loops] a node of each, -1 once it is gone */
    int32_t loops;
    hole *hole;
    int32_t holes;
} capper;

/* ---- sides ---- */

/* A dart now lies across the side of a node. */
static void meet(capper *c, int32_t n, int32_t dart) {
    const node *side = &c->node[n];
    if (side->dart < 0) {
        c->node[side->mate].dart = dart;
        return;
    }
    c->to->mesh.opposite[side->dart] = dart;
    c->to->mesh.opposite[dart] = side->dart;
}

/* The sides of two nodes lie on each other. */
static void fold(capper *c, int32_t a, int32_t b) {
    node *one = &c->node[a], *other = &c->node[b];
    if (one->dart >= 0) {
        meet(c, b, one->dart);
    } else if (other->dart >= 0) {
        meet(c, a, other->dart);
    } else if (one->mate != b) {
        c->node[one->mate].mate = other->mate;
        c->node[other->mate].mate = one->mate;
    }
}

/* `to` takes the side of `from` over, which goes. */
static void take_side(capper *c, int32_t to, int32_t from) {
    node *into = &c->node[to], *gone = &c->node[from];
    into->dart = gone->dart;
    into->mate = gone->mate;
    into->next = gone->next;
    c->node[gone->next].before = to;
    if (gone->dart < 0)
        c->node[gone->mate].mate = to;
}

/* Drop sides that run to and fro from `n` on; returns a node that is left, -1 if none is. */
static int32_t drop_spikes(capper *c, int32_t n) {
    int32_t stop = n;
    for (int32_t a = n;;) {
        int32_t b = c->node[a].next, next = c->node[b].next;
        if (b == a) /* a single corner: nothing around it */
            return -1;
        if (c->node[next].vertex != c->node[a].vertex) {
            a = b;
            if (a == stop)
                return a;
            continue;
        }
        fold(c, a, b);
        if (next == a)
            return -1;
        take_side(c, a, next);
        a = stop = c->node[a].before;
    }
}

/* ---- triangles ---- */

/* Cut off the corner behind `a`. */
static iso_status clip(capper *c, int32_t a) {
    iso_growing_mesh *to = c->to;
    int32_t b = c->node[a].next, next = c->node[b].next, dart = 3 * to->mesh.triangle_count;
    ISO_TRY(ISO_GROW(to->mesh.origin, to->origin_capacity, (int64_t)dart + 3));
    ISO_TRY(ISO_GROW(to->mesh.opposite, to->opposite_capacity, (int64_t)dart + 3));
    to->mesh.origin[dart] = c->node[a].vertex;
    to->mesh.origin[dart + 1] = c->node[b].vertex;
    to->mesh.origin[dart + 2] = c->node[next].vertex;
    to->mesh.triangle_count++;
    meet(c, a, dart);
    meet(c, b, dart + 1);
    c->node[a].dart = dart + 2;
    c->node[a].next = next;
    c->node[next].before = a;
    return ISO_OK;
}

static int64_t turn_at(const capper *c, int32_t n) {
    const node *at = &c->node[n];
    return orient2d(c->node[at->before].at, at->at, c->node[at->next].at);
}

static bool in_triangle(iso_point p, iso_point a, iso_point b, iso_point c) {
    return orient2d(a, b, p) >= 0 && orient2d(b, c, p) >= 0 && orient2d(c, a, p) >= 0 &&
           !point_equal(p, a) && !point_equal(p, b) && !point_equal(p, c);
}

static bool is_ear(const capper *c, int32_t n) {
    const node *at = &c->node[n];
    iso_point a = c->node[at->before].at, b = at->at, d = c->node[at->next].at;
    if (at->reflex)
        return false;
    iso_box box = box_of(a, b);
    box_add(&box, d);
    for (int32_t i = c->node[at->next].next; i != at->before; i = c->node[i].next)
        if (c->node[i].reflex && box_has(&box, c->node[i].at) &&
            in_triangle(c->node[i].at, a, b, d))
            return false;
    return true;
}

static iso_status clip_loop(capper *c, int32_t n) {
    int32_t missed = 0, left = 1;
    for (int32_t i = c->node[n].next; i != n; i = c->node[i].next)
        left++;
    for (int32_t i = 0; i < left; i++, n = c->node[n].next)
        c->node[n].reflex = turn_at(c, n) <= 0;
    while (left > 3) {
        int32_t a = c->node[n].before, after = c->node[n].next;
        bool folded = c->node[a].vertex == c->node[after].vertex;
        if (!folded && missed <= left && !is_ear(c, n)) {
            n = after;
            missed++;
            continue;
        }
        if (folded) {
            fold(c, a, n);
            take_side(c, a, after);
            left -= 2;
            n = a;
        } else {
            ISO_TRY(clip(c, a));
            left--;
            n = after;
        }
        missed = 0;
        c->node[a].reflex = turn_at(c, a) <= 0;
        c->node[c->node[a].next].reflex = turn_at(c, c->node[a].next) <= 0;
    }
    n = drop_spikes(c, n);
    if (n < 0)
        return ISO_OK;
    int32_t third = c->node[c->node[n].next].next;
    ISO_TRY(clip(c, n));
    fold(c, n, third);
    return ISO_OK;
}

/* ---- holes ---- */

static int64_t double_area(const capper *c, int32_t n) {
    int64_t area = 0;
    iso_point base = c->node[n].at;
    for (int32_t i = c->node[n].next; i != n; i = c->node[i].next)
        area += orient2d(base, c->node[i].at, c->node[c->node[i].next].at);
    return area;
}

#define IS_FARTHER(a, b) ((a)->at.x != (b)->at.x ? (a)->at.x > (b)->at.x : (a)->right < (b)->right)

ISO_SORT(sort_holes, hole, IS_FARTHER)

static void find_holes(capper *c) {
    for (int32_t i = 0; i < c->loops; i++) {
        int32_t n = c->start[i], right = n;
        if (n < 0 || double_area(c, n) >= 0)
            continue;
        for (int32_t k = c->node[n].next; k != n; k = c->node[k].next)
            if (point_less(c->node[right].at, c->node[k].at))
                right = k;
        c->hole[c->holes++] = (hole){right, c->node[right].at};
        c->start[i] = -1;
    }
    sort_holes(c->hole, c->holes);
}

/* Does the side ab, running up, cross the height of p to the right of it, nearer than the side
 * that was best? */
static bool is_nearer(const capper *c, iso_point p, int32_t n, int32_t best) {
    iso_point a = c->node[n].at, b = c->node[c->node[n].next].at;
    if (!(a.y <= p.y && b.y > p.y) || orient2d(a, b, p) < 0)
        return false;
    if (best < 0)
        return true;
    iso_point a1 = c->node[best].at, b1 = c->node[c->node[best].next].at;
    return crosses_left_of(a, b, a1, b1, p.y);
}

/* A corner that is seen from p, given the side that the ray to the right hits first: the higher end
 * of that side, or a reflex corner that stands before it, the one at the smallest angle. */
static int32_t seen_from(const capper *c, iso_point p, int32_t hit) {
    int32_t best = c->node[hit].next;
    for (int32_t i = c->node[best].next; i != best; i = c->node[i].next) {
        iso_point at = c->node[i].at, tip = c->node[best].at;
        bool right = at.x > p.x || (at.x == p.x && at.y > p.y);
        if (at.y < p.y || !right || point_equal(at, tip))
            continue;
        int64_t side = orient2d(p, tip, at);
        bool nearer = side == 0 && at.y <= tip.y && at.x <= tip.x;
        iso_point low = c->node[hit].at, high = c->node[c->node[hit].next].at;
        if ((side < 0 || nearer) && orient2d(low, high, at) >= 0)
            best = i;
    }
    return best;
}

static int32_t find_side(const capper *c, iso_point p) {
    int32_t best = -1;
    for (int32_t i = 0; i < c->loops; i++) {
        int32_t n = c->start[i], first = n;
        if (n < 0)
            continue;
        do {
            if (is_nearer(c, p, n, best))
                best = n;
            n = c->node[n].next;
        } while (n != first);
    }
    return best;
}

/* Two sides between the corner a of a loop and h of a hole, which becomes part of the loop:
 * before a, a, h, ... around the hole ..., h1, a1, after a. */
static void bridge(capper *c, int32_t a, int32_t h) {
    int32_t a1 = c->nodes++, h1 = c->nodes++, last = c->node[h].before;
    c->node[a1] = c->node[a];
    take_side(c, a1, a);
    c->node[h1] = c->node[h];
    c->node[h1].before = last;
    c->node[last].next = h1;
    c->node[h1].next = a1;
    c->node[a1].before = h1;
    c->node[a].next = h;
    c->node[h].before = a;
    c->node[a].dart = c->node[h1].dart = -1;
    c->node[a].mate = h1;
    c->node[h1].mate = a;
}

/* From right to left, so that what a hole sees to its right is part of a loop already. */
static iso_status bridge_holes(capper *c) {
    for (int32_t i = 0; i < c->holes; i++) {
        int32_t h = c->hole[i].right, hit = find_side(c, c->node[h].at);
        if (hit < 0) /* rounded away from what is around it */
            ISO_TRY(clip_loop(c, h));
        else
            bridge(c, seen_from(c, c->node[h].at, hit), h);
    }
    return ISO_OK;
}

static void make_nodes(capper *c, const iso_cap_side *side, const int32_t *first) {
    for (int32_t i = 0; i < c->loops; i++) {
        for (int32_t n = first[i]; n < first[i + 1]; n++)
            c->node[n] = (node){.at = side[n].at,
                                .vertex = side[n].vertex,
                                .next = n + 1 == first[i + 1] ? first[i] : n + 1,
                                .before = n == first[i] ? first[i + 1] - 1 : n - 1,
                                .dart = side[n].dart};
        c->start[i] = first[i] == first[i + 1] ? -1 : drop_spikes(c, first[i]);
    }
    c->nodes = first[c->loops];
}

static iso_status cap_all(capper *c, const iso_cap_side *side, const int32_t *first) {
    ISO_TRY(ISO_ALLOCATE(c->node, first[c->loops] + 2 * (int64_t)c->loops));
    ISO_TRY(ISO_ALLOCATE(c->start, c->loops));
    ISO_TRY(ISO_ALLOCATE(c->hole, c->loops));
    make_nodes(c, side, first);
    find_holes(c);
    ISO_TRY(bridge_holes(c));
    for (int32_t i = 0; i < c->loops; i++)
        if (c->start[i] >= 0)
            ISO_TRY(clip_loop(c, c->start[i]));
    return ISO_OK;
}

iso_status cap_loops(iso_growing_mesh *to, const iso_cap_side *side, const int32_t *first,
                     int32_t loops) {
    capper c = {.to = to, .loops = loops};
    iso_status status = cap_all(&c, side, first);
    iso_release(c.node);
    iso_release(c.start);
    iso_release(c.hole);
    return status;
}

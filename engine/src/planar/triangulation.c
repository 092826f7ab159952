#include "planar/triangulation.h"

#include "base/sort.h"
#include "planar/predicate.h"

typedef struct iso_placed {
    uint64_t key;
    int32_t index;
} iso_placed;

static bool placed_less(const iso_placed *a, const iso_placed *b) {
    return a->key != b->key ? a->key < b->key : a->index < b->index;
}
ISO_SORT(sort_placed, iso_placed, placed_less)

typedef struct iso_mesher {
    iso_triangulation *out;
    int32_t *dart_of; /* [vertex_count + 1] a dart that starts there */
    int32_t *name;    /* [points] vertex of each point of the region */
    int32_t *stack;   /* room for triangles and darts */
    int32_t *rim;     /* darts around a cavity */
    int64_t stack_capacity, rim_capacity;
    int32_t *seen; /* [triangles] the last point whose cavity was asked to hold it */
    int32_t last;  /* a triangle near the last point */
} iso_mesher;

/* ---- predicates ---- */

/* > 0: d lies in the circle through a, b, c, counter-clockwise. Below 2^105. */
static iso_int128 in_circle(iso_point a, iso_point b, iso_point c, iso_point d) {
    int64_t ax = (int64_t)a.x - d.x, ay = (int64_t)a.y - d.y;
    int64_t bx = (int64_t)b.x - d.x, by = (int64_t)b.y - d.y;
    int64_t cx = (int64_t)c.x - d.x, cy = (int64_t)c.y - d.y;
    return (iso_int128)(ax * ax + ay * ay) * (bx * cy - by * cx) +
           (iso_int128)(bx * bx + by * by) * (cx * ay - cy * ax) +
           (iso_int128)(cx * cx + cy * cy) * (ax * by - ay * bx);
}

/* The corner at infinity, or -1. */
static int32_t far_corner(const iso_triangulation *t, int32_t triangle) {
    for (int32_t d = 3 * triangle; d < 3 * triangle + 3; d++)
        if (t->origin[d] == t->vertex_count)
            return d;
    return -1;
}

static iso_point place(const iso_triangulation *t, int32_t dart) {
    return t->vertex[t->origin[dart]];
}

/* Does the triangle's circle hold p? That of a triangle at infinity is the half plane beyond its
 * edge, and the edge itself. */
static bool circle_holds(const iso_triangulation *t, int32_t triangle, iso_point p) {
    int32_t far = far_corner(t, triangle), d = 3 * triangle;
    if (far < 0)
        return in_circle(place(t, d), place(t, d + 1), place(t, d + 2), p) > 0;
    iso_point a = place(t, corner_next(far)), b = place(t, corner_back(far));
    int64_t side = orient2d(a, b, p);
    return side > 0 || (side == 0 && box_holds(a, b, p));
}

/* ---- links ---- */

static void join(iso_triangulation *t, int32_t a, int32_t b, uint8_t fence) {
    t->opposite[a] = b;
    t->opposite[b] = a;
    t->fence[a] = t->fence[b] = fence;
}

/* Turn the edge within its two triangles. */
static void flip(iso_mesher *m, int32_t d) {
    iso_triangulation *t = m->out;
    int32_t e = t->opposite[d], dn = corner_next(d), dp = corner_back(d);
    int32_t en = corner_next(e), ep = corner_back(e);
    int32_t a = t->origin[d], b = t->origin[e], c = t->origin[dp], x = t->origin[ep];
    int32_t bc = t->opposite[dn], ca = t->opposite[dp];
    int32_t ax = t->opposite[en], xb = t->opposite[ep];
    uint8_t fbc = t->fence[dn], fca = t->fence[dp], fax = t->fence[en], fxb = t->fence[ep];
    t->origin[d] = c, t->origin[dn] = x, t->origin[dp] = b;
    t->origin[e] = x, t->origin[en] = c, t->origin[ep] = a;
    join(t, d, e, 0);
    join(t, dn, xb, fxb);
    join(t, dp, bc, fbc);
    join(t, en, ca, fca);
    join(t, ep, ax, fax);
    m->dart_of[a] = ep, m->dart_of[b] = dp, m->dart_of[c] = d, m->dart_of[x] = e;
}

/* ---- points ---- */

static uint64_t spread(uint32_t x) { /* bits of a 25-bit number, every second place */
    uint64_t v = x;
    v = (v | v << 16) & 0x0000FFFF0000FFFFull;
    v = (v | v << 8) & 0x00FF00FF00FF00FFull;
    v = (v | v << 4) & 0x0F0F0F0F0F0F0F0Full;
    v = (v | v << 2) & 0x3333333333333333ull;
    return (v | v << 1) & 0x5555555555555555ull;
}

/* Rounds that double: half of all points come in the last. Which, is a hash of the point's number.
 */
static uint64_t key_of(iso_point p, int32_t index) {
    enum { ROUNDS = 12 };
    uint64_t hash = ((uint64_t)index + 1) * 0x9E3779B97F4A7C15ull;
    uint64_t round = 0;
    hash ^= hash >> 31;
    while (round < ROUNDS && (hash >> round & 1))
        round++;
    uint32_t x = (uint32_t)(p.x + ISO_COORDINATE_MAX), y = (uint32_t)(p.y + ISO_COORDINATE_MAX);
    return (uint64_t)(ROUNDS - round) << 52 | spread(x) | spread(y) << 1;
}

/* Name the places of the region's points, each once, in the order of their insertion. */
static iso_status name_places(iso_mesher *m, const iso_region *region, iso_placed *placed) {
    iso_triangulation *t = m->out;
    int32_t points = region->first[region->count], count = 0;
    for (int32_t i = 0; i < points; i++) {
        iso_point p = region->point[i];
        placed[i].key = spread((uint32_t)(p.x + ISO_COORDINATE_MAX)) |
                        spread((uint32_t)(p.y + ISO_COORDINATE_MAX)) << 1;
        placed[i].index = i;
    }
    sort_placed(placed, points);
    for (int32_t i = 0; i < points; i++) {
        if (i == 0 || placed[i].key != placed[i - 1].key) {
            t->vertex[count] = region->point[placed[i].index];
            count++;
        }
        m->name[placed[i].index] = count - 1;
    }
    t->vertex_count = count;
    for (int32_t i = 0; i < count; i++)
        placed[i] = (iso_placed){key_of(t->vertex[i], i), i};
    sort_placed(placed, count);
    return ISO_OK;
}

/* The first three places that span a triangle, put in front; false if all lie on a line. */
static bool find_first(const iso_triangulation *t, iso_placed *placed) {
    for (int32_t i = 2; i < t->vertex_count; i++) {
        const iso_point *v = t->vertex;
        int64_t side = orient2d(v[placed[0].index], v[placed[1].index], v[placed[i].index]);
        if (side == 0)
            continue;
        iso_placed third = placed[i];
        memmove(placed + 3, placed + 2, (size_t)(i - 2) * sizeof *placed);
        placed[2] = third;
        if (side < 0) {
            iso_placed swap = placed[0];
            placed[0] = placed[1];
            placed[1] = swap;
        }
        return true;
    }
    return false;
}

/* One triangle and its three neighbours at infinity. */
static void start(iso_mesher *m, const iso_placed *placed) {
    iso_triangulation *t = m->out;
    int32_t far = t->vertex_count;
    for (int32_t k = 0; k < 3; k++) {
        int32_t a = placed[k].index, b = placed[(k + 1) % 3].index, ghost = 3 * (k + 1);
        t->origin[k] = a;
        t->origin[ghost] = b, t->origin[ghost + 1] = a, t->origin[ghost + 2] = far;
        join(t, k, ghost, 0);
        join(t, ghost + 1, 3 * ((k + 2) % 3 + 1) + 2, 0);
    }
    t->triangle_count = 4;
    for (int32_t k = 0; k < 4; k++)
        m->seen[k] = -1;
}

/* A triangle whose circle holds p: walk towards it. */
static int32_t locate(const iso_mesher *m, iso_point p) {
    const iso_triangulation *t = m->out;
    int32_t at = m->last, far = far_corner(t, at);
    if (far >= 0)
        at = t->opposite[corner_next(far)] / 3;
    for (;;) {
        int32_t d = 3 * at, end = d + 3;
        while (d < end && orient2d(place(t, d), place(t, corner_next(d)), p) >= 0)
            d++;
        if (d == end)
            return at;
        at = t->opposite[d] / 3;
        if (far_corner(t, at) >= 0)
            return at;
    }
}

/* Every triangle whose circle holds vertex v; their rim; and in their place the fan from v. */
static iso_status insert(iso_mesher *m, int32_t v) {
    iso_triangulation *t = m->out;
    iso_point p = t->vertex[v];
    int32_t count = 0, done = 0, rim = 0;
    ISO_TRY(ISO_GROW(m->stack, m->stack_capacity, 64));
    m->stack[count++] = locate(m, p);
    m->seen[m->stack[0]] = v;
    for (; done < count; done++) {
        int32_t first = 3 * m->stack[done];
        ISO_TRY(ISO_GROW(m->stack, m->stack_capacity, count + 5));
        ISO_TRY(ISO_GROW(m->rim, m->rim_capacity, 3 * (rim + 3)));
        for (int32_t d = first; d < first + 3; d++) {
            int32_t next = t->opposite[d] / 3;
            if (m->seen[next] == v)
                continue;
            if (circle_holds(t, next, p)) {
                m->seen[next] = v;
                m->stack[count++] = next;
            }
        }
    }
    for (int32_t i = 0; i < count; i++)
        for (int32_t d = 3 * m->stack[i]; d < 3 * m->stack[i] + 3; d++)
            if (m->seen[t->opposite[d] / 3] != v) {
                ISO_TRY(ISO_GROW(m->rim, m->rim_capacity, 3 * (rim + 1)));
                m->rim[3 * rim] = t->opposite[d];
                m->rim[3 * rim + 1] = t->origin[d];
                m->rim[3 * rim + 2] = t->origin[corner_next(d)];
                rim++;
            }
    m->stack[count] = t->triangle_count;
    m->stack[count + 1] = t->triangle_count + 1;
    t->triangle_count += 2;
    for (int32_t i = 0; i < rim; i++) {
        int32_t d = 3 * m->stack[i], a = m->rim[3 * i + 1];
        m->seen[m->stack[i]] = -1;
        t->origin[d] = a, t->origin[d + 1] = m->rim[3 * i + 2], t->origin[d + 2] = v;
        join(t, d, m->rim[3 * i], 0);
        m->dart_of[a] = d;
    }
    for (int32_t i = 0; i < rim; i++) {
        int32_t d = 3 * m->stack[i];
        join(t, d + 1, m->dart_of[t->origin[d + 1]] + 2, 0);
    }
    m->last = m->stack[0];
    return ISO_OK;
}

/* ---- contours ---- */

/* The dart from vertex a to vertex b, or -1. */
static int32_t find_dart(const iso_mesher *m, int32_t a, int32_t b) {
    const iso_triangulation *t = m->out;
    int32_t d = m->dart_of[a], begun = d;
    do {
        if (t->origin[corner_next(d)] == b)
            return d;
        d = t->opposite[corner_back(d)];
    } while (d != begun);
    return -1;
}

/* Where does the way from u to v begin: at the dart of an edge across it, or at a vertex on it (as
 * -1 - dart)? */
static int32_t find_way(const iso_mesher *m, int32_t u, int32_t v) {
    const iso_triangulation *t = m->out;
    iso_point from = t->vertex[u], to = t->vertex[v];
    int32_t d = m->dart_of[u], begun = d;
    do {
        int32_t a = t->origin[corner_next(d)], b = t->origin[corner_back(d)];
        if (a != t->vertex_count) {
            int64_t side = orient2d(from, to, t->vertex[a]);
            if (side == 0 && box_holds(from, to, t->vertex[a]))
                return -1 - d;
            if (side < 0 && b != t->vertex_count && orient2d(from, to, t->vertex[b]) > 0)
                return corner_next(d);
        }
        d = t->opposite[corner_back(d)];
    } while (d != begun);
    return INT32_MIN;
}

/* Push the edges across the way from u to v, as pairs of vertices; returns their number, *end
 * becomes the vertex where the way first meets one. */
static iso_status push_crossed(iso_mesher *m, int32_t u, int32_t v, int32_t *end, int32_t *count) {
    const iso_triangulation *t = m->out;
    iso_point from = t->vertex[u], to = t->vertex[v];
    int32_t d = find_way(m, u, v);
    *count = 0;
    if (d == INT32_MIN)
        return iso_fail(ISO_BUG, "triangulation: no way from (%d, %d)", from.x, from.y);
    if (d < 0) {
        *end = t->origin[corner_next(-1 - d)];
        return ISO_OK;
    }
    for (;;) {
        ISO_TRY(ISO_GROW(m->stack, m->stack_capacity, 2 * (*count + 2)));
        m->stack[2 * *count] = t->origin[d];
        m->stack[2 * *count + 1] = t->origin[corner_next(d)];
        ++*count;
        int32_t e = t->opposite[d], x = t->origin[corner_back(e)];
        int64_t side = orient2d(from, to, t->vertex[x]);
        if (side == 0) {
            *end = x;
            return ISO_OK;
        }
        d = side > 0 ? corner_next(e) : corner_back(e); /* from the right of the way to its left */
    }
}

/* Flip edges until the way from u to `end` is one: those of convex quadrilaterals, the others wait
 * at the back of the ring. */
static void flip_in(iso_mesher *m, int32_t u, int32_t end, int32_t count) {
    const iso_triangulation *t = m->out;
    iso_point from = t->vertex[u], to = t->vertex[end];
    int32_t size = count;
    for (int32_t head = 0; count > 0; head = head + 1 == size ? 0 : head + 1) {
        int32_t *pair = m->stack + 2 * head;
        int32_t tail = head + count;
        int32_t *back = m->stack + 2 * (tail >= size ? tail - size : tail);
        int32_t a = pair[0], b = pair[1], d = find_dart(m, a, b);
        int32_t c = t->origin[corner_back(d)], x = t->origin[corner_back(t->opposite[d])];
        iso_point pa = t->vertex[a], pb = t->vertex[b], pc = t->vertex[c], px = t->vertex[x];
        count--;
        if (orient2d(px, pc, pb) < 0 && orient2d(px, pc, pa) > 0) {
            flip(m, d);
            a = c, b = x;
        }
        int64_t sa = orient2d(from, to, t->vertex[a]), sb = orient2d(from, to, t->vertex[b]);
        if ((sa > 0 && sb < 0) || (sa < 0 && sb > 0)) {
            back[0] = a, back[1] = b;
            count++;
        }
    }
}

static iso_status add_fence(iso_mesher *m, int32_t u, int32_t v, bool *flipped) {
    iso_triangulation *t = m->out;
    while (u != v) {
        int32_t end = v, count = 0, d = find_dart(m, u, v);
        if (d < 0) {
            ISO_TRY(push_crossed(m, u, v, &end, &count));
            flip_in(m, u, end, count);
            *flipped = *flipped || count > 0;
            d = find_dart(m, u, end);
            if (d < 0)
                return iso_fail(ISO_BUG, "triangulation: no edge from (%d, %d) to (%d, %d)",
                                t->vertex[u].x, t->vertex[u].y, t->vertex[end].x, t->vertex[end].y);
        }
        t->fence[d] ^= 1;
        t->fence[t->opposite[d]] ^= 1;
        u = end;
    }
    return ISO_OK;
}

static bool is_legal(const iso_triangulation *t, int32_t d) {
    int32_t e = t->opposite[d];
    if (t->fence[d] || far_corner(t, d / 3) >= 0 || far_corner(t, e / 3) >= 0)
        return true;
    return in_circle(place(t, d), place(t, corner_next(d)), place(t, corner_back(d)),
                     place(t, corner_back(e))) <= 0;
}

/* Lawson's flips, from all edges on. */
static iso_status make_legal(iso_mesher *m) {
    const iso_triangulation *t = m->out;
    for (int32_t first = 0; first < 3 * t->triangle_count; first++) {
        int32_t count = 1;
        ISO_TRY(ISO_GROW(m->stack, m->stack_capacity, 64));
        m->stack[0] = first;
        while (count > 0) {
            int32_t d = m->stack[--count], e = t->opposite[d];
            if (is_legal(t, d))
                continue;
            flip(m, d);
            ISO_TRY(ISO_GROW(m->stack, m->stack_capacity, count + 4));
            m->stack[count++] = corner_next(d);
            m->stack[count++] = corner_back(d);
            m->stack[count++] = corner_next(e);
            m->stack[count++] = corner_back(e);
        }
    }
    return ISO_OK;
}

static iso_status add_fences(iso_mesher *m, const iso_region *region) {
    iso_triangulation *t = m->out;
    bool flipped = false;
    for (int32_t d = 0; d < 3 * t->triangle_count; d++)
        m->dart_of[t->origin[d]] = d;
    for (int32_t c = 0; c < region->count; c++) {
        int32_t last = region->first[c + 1] - 1;
        for (int32_t i = region->first[c], before = last; i <= last; before = i++)
            ISO_TRY(add_fence(m, m->name[before], m->name[i], &flipped));
    }
    return flipped ? make_legal(m) : ISO_OK;
}

/* From infinity on: inside changes at fences. */
static iso_status mark_inside(iso_mesher *m) {
    iso_triangulation *t = m->out;
    int32_t count = 0;
    memset(t->inside, 2, (size_t)t->triangle_count);
    ISO_TRY(ISO_GROW(m->stack, m->stack_capacity, t->triangle_count));
    m->stack[count++] = m->dart_of[t->vertex_count] / 3;
    t->inside[m->stack[0]] = 0;
    while (count > 0) {
        int32_t at = m->stack[--count];
        for (int32_t d = 3 * at; d < 3 * at + 3; d++) {
            int32_t next = t->opposite[d] / 3;
            if (t->inside[next] != 2)
                continue;
            t->inside[next] = t->inside[at] ^ t->fence[d];
            m->stack[count++] = next;
        }
    }
    return ISO_OK;
}

static iso_status build(iso_mesher *m, const iso_region *region, iso_placed *placed) {
    ISO_TRY(name_places(m, region, placed));
    if (!find_first(m->out, placed)) {
        m->out->vertex_count = 0;
        return ISO_OK;
    }
    start(m, placed);
    for (int32_t i = 3; i < m->out->vertex_count; i++)
        ISO_TRY(insert(m, placed[i].index));
    ISO_TRY(add_fences(m, region));
    return mark_inside(m);
}

iso_status triangulate(iso_triangulation *out, const iso_region *region, iso_arena *arena) {
    int64_t points = region->count ? region->first[region->count] : 0;
    iso_mesher m = {.out = out};
    iso_placed *placed;
    *out = (iso_triangulation){0};
    if (points < 3)
        return ISO_OK;
    if (points > INT32_MAX / 12)
        return iso_fail(ISO_OUTSIDE, "%lld points are more than one triangulation can hold",
                        (long long)points);
    ISO_TRY(ISO_PUSH(out->vertex, arena, points));
    ISO_TRY(ISO_PUSH(out->origin, arena, 6 * points));
    ISO_TRY(ISO_PUSH(out->opposite, arena, 6 * points));
    ISO_TRY(ISO_PUSH(out->fence, arena, 6 * points));
    ISO_TRY(ISO_PUSH(out->inside, arena, 2 * points));
    iso_arena_mark mark = iso_arena_get_mark(arena);
    ISO_TRY(ISO_PUSH(m.seen, arena, 2 * points));
    ISO_TRY(ISO_PUSH(m.dart_of, arena, points + 1));
    ISO_TRY(ISO_PUSH(m.name, arena, points));
    ISO_TRY(ISO_PUSH(placed, arena, points));
    iso_status status = build(&m, region, placed);
    iso_release(m.stack);
    iso_release(m.rim);
    iso_arena_pop(arena, mark);
    return status;
}

static bool is_triangle(const iso_triangulation *t, int32_t triangle) {
    int32_t d = 3 * triangle;
    return far_corner(t, triangle) >= 0 ||
           orient2d(place(t, d), place(t, d + 1), place(t, d + 2)) > 0;
}

iso_status triangulation_validate(const iso_triangulation *t) {
    if (t->triangle_count > 0 && t->triangle_count != 2 * t->vertex_count - 2)
        return iso_fail(ISO_BUG, "triangulation: %d triangles of %d vertices", t->triangle_count,
                        t->vertex_count);
    for (int32_t d = 0; d < 3 * t->triangle_count; d++) {
        int32_t e = t->opposite[d];
        if (e < 0 || e >= 3 * t->triangle_count || e == d || t->opposite[e] != d)
            return iso_fail(ISO_BUG, "triangulation: opposite of dart %d is no involution", d);
        if (t->origin[e] != t->origin[corner_next(d)])
            return iso_fail(ISO_BUG, "triangulation: dart %d ends elsewhere than it should", d);
        if (t->fence[e] != t->fence[d] || (t->inside[d / 3] != t->inside[e / 3]) != t->fence[d])
            return iso_fail(ISO_BUG, "triangulation: inside and fence differ at dart %d", d);
        if (t->inside[d / 3] > 1 || (t->inside[d / 3] && far_corner(t, d / 3) >= 0))
            return iso_fail(ISO_BUG, "triangulation: triangle %d cannot be inside", d / 3);
        if (!is_triangle(t, d / 3))
            return iso_fail(ISO_BUG, "triangulation: triangle %d is turned over", d / 3);
        if (!is_legal(t, d))
            return iso_fail(ISO_BUG, "triangulation: the circle at dart %d is not empty", d);
    }
    return ISO_OK;
}

/* Windows of light on edges: J. Chen and Y. Han, Shortest paths on a polyhedron, 1990, with the
 * queue and the filter of S.-Q. Xin and G.-J. Wang, Improving Chen and Han's algorithm on the
 * discrete geodesic problem, 2009. Light comes from a point, a vertex that is given or that paths
 * may bend at, or, from edges that are given, in parallel rays.
 *
 * The heat method (Crane, Weischedel, Wardetzky, 2013) was the alternative: it takes two linear
 * systems, and its error is of the size of an edge. This one is exact, and needs no module. */
#include "height/waves.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/memory.h"

/* Of the length of an edge: a ray that misses a vertex by no more reaches it. Vertices of flat
 * grids would slip through between two windows by rounding; the path, which bends by as much, is
 * longer by half the square of it. */
#define NEAR_VERTEX 1e-3
/* Sine of how much more than a full turn a vertex must have for paths to bend there. */
#define SADDLE 1e-5
/* Of an edge: narrower windows carry no light. */
#define NARROWEST 1e-9
/* Relative: what is longer by no more is not longer. */
#define LONGER (1 + 1e-9)

/* Light that enters a triangle through the piece [low, high] of its dart. In the frame of the dart,
 * which runs along x from its origin, the triangle lies at y >= 0. */
typedef struct window {
    double low, high;
    double x, y;   /* the point that light comes from, y < 0; or its direction, y > 0 */
    double offset; /* distance at that point, or at the dart's origin */
    int32_t dart;
    bool parallel;
} window;

typedef struct event {
    double distance;
    int32_t what; /* a window, or ~vertex */
} event;

typedef struct waves {
    const wave_surface *surface;
    double *distance;
    uint8_t *emits;      /* [vertex_count] light starts anew there */
    uint8_t *given;      /* [vertex_count] and not nearer than that */
    int32_t *first;      /* [vertex_count + 1] into around */
    int32_t *around;     /* [3 triangle_count] darts by their origin */
    double *best;        /* [3 triangle_count] least distance of the apex through this dart ... */
    double *where;       /* ... and at which x it came in */
    window *window;      /* free ones are chained by `dart` */
    event *heap;         /* least on top */
    int64_t window_room; /* of both arrays */
    int64_t heap_room, heap_count;
    int32_t window_count, free; /* -1: none is free */
} waves;

static int32_t next_dart(int32_t a) {
    return a % 3 == 2 ? a - 2 : a + 1;
}

static int32_t last_dart(int32_t a) {
    return a % 3 == 0 ? a + 2 : a - 1;
}

// The queue

static bool comes_before(event a, event b) {
    return a.distance < b.distance || (a.distance == b.distance && a.what < b.what);
}

static iso_status push_event(waves *w, event e) {
    ISO_TRY(ISO_GROW(w->heap, w->heap_room, w->heap_count + 1));
    int64_t at = w->heap_count++;
    while (at > 0 && comes_before(e, w->heap[(at - 1) / 2])) {
        w->heap[at] = w->heap[(at - 1) / 2];
        at = (at - 1) / 2;
    }
    w->heap[at] = e;
    return ISO_OK;
}

static event pop_event(waves *w) {
    event top = w->heap[0], last = w->heap[--w->heap_count];
    int64_t at = 0;
    for (int64_t child; (child = 2 * at + 1) < w->heap_count; at = child) {
        if (child + 1 < w->heap_count && comes_before(w->heap[child + 1], w->heap[child]))
            child++;
        if (!comes_before(w->heap[child], last))
            break;
        w->heap[at] = w->heap[child];
    }
    w->heap[at] = last;
    return top;
}

static iso_status reach_vertex(waves *w, int32_t vertex, double distance) {
    if (!(distance < w->distance[vertex]))
        return ISO_OK;
    w->distance[vertex] = distance;
    w->given[vertex] = 0; /* its edges may come nearer, too */
    return push_event(w, (event){distance, ~vertex});
}

// Windows

static double distance_at(const window *v, double x) {
    if (v->parallel)
        return v->offset + v->x * x;
    return v->offset + sqrt((x - v->x) * (x - v->x) + v->y * v->y);
}

static double least_distance(const window *v) {
    if (v->parallel)
        return fmin(distance_at(v, v->low), distance_at(v, v->high));
    return distance_at(v, fmin(fmax(v->x, v->low), v->high));
}

static int32_t from_of(const waves *w, int32_t dart) {
    return w->surface->origin[dart];
}

static int32_t to_of(const waves *w, int32_t dart) {
    return w->surface->origin[next_dart(dart)];
}

/* Does a path by way of one of the edge's ends go to all that the window lights, and no farther?
 * Such a path along the edge passes all of it, and what lies on a shortest path is reached by the
 * same source. */
static bool ends_are_nearer(const waves *w, const window *v) {
    double length = w->surface->length[v->dart];
    int32_t from = from_of(w, v->dart), to = to_of(w, v->dart);
    if (w->given[from] && w->given[to] &&
        least_distance(v) >= fmax(w->distance[from], w->distance[to]))
        return true;
    return (w->distance[from] + v->high) * LONGER < distance_at(v, v->high) ||
           (w->distance[to] + length - v->low) * LONGER < distance_at(v, v->low);
}

static iso_status add_window(waves *w, const window *v) {
    double length = w->surface->length[v->dart];
    bool lit = v->high - v->low > NARROWEST * length &&
               (v->parallel ? v->y > 0 : v->y < -NARROWEST * length);
    if (!lit || ends_are_nearer(w, v))
        return ISO_OK;
    int32_t number = w->free;
    if (number >= 0) {
        w->free = w->window[number].dart;
    } else {
        if (w->window_count == INT32_MAX)
            return iso_fail(ISO_UNSLICEABLE, "this surface is too rough to measure along it");
        ISO_TRY(ISO_GROW(w->window, w->window_room, (int64_t)w->window_count + 1));
        number = w->window_count++;
    }
    w->window[number] = *v;
    return push_event(w, (event){least_distance(v), number});
}

/* A triangle in the frame of the dart that light comes in by. */
typedef struct triangle {
    double length, x, y; /* of the dart; where the apex is */
    double left, right;  /* edges from the apex to the dart's ends */
} triangle;

static triangle triangle_of(const waves *w, int32_t dart) {
    const double *length = w->surface->length;
    triangle t = {
        .length = length[dart], .left = length[last_dart(dart)], .right = length[next_dart(dart)]};
    t.x = (t.length * t.length + t.left * t.left - t.right * t.right) / (2 * t.length);
    t.y = sqrt(fmax(0, t.left * t.left - t.x * t.x));
    return t;
}

/* Where the ray through (x, 0) meets the line from (from_x, from_y) in direction u; within [0, end]
 * as rounding has it. */
static double ray_meets(const window *v, double x, double from_x, double from_y, const double u[2],
                        double end) {
    double dx = v->parallel ? v->x : x - v->x, dy = v->parallel ? v->y : -v->y;
    double t = ((x - from_x) * dy + from_y * dx) / (u[0] * dy - u[1] * dx);
    return t > 0 ? fmin(t, end) : 0; /* 0 of NaN, too */
}

/* The window in the frame of another dart, from (x, y) in direction u. */
static window seen_from(const window *v, int32_t dart, double x, double y, const double u[2]) {
    window seen = {.dart = dart, .parallel = v->parallel, .offset = v->offset};
    double dx = v->parallel ? v->x : v->x - x, dy = v->parallel ? v->y : v->y - y;
    seen.x = dx * u[0] + dy * u[1];
    seen.y = u[0] * dy - u[1] * dx;
    if (v->parallel)
        seen.offset += v->x * x + v->y * y;
    return seen;
}

/* Through the edge from the dart's origin to the apex. */
static iso_status pass_left(waves *w, const window *v, const triangle *t, double middle) {
    int32_t dart = w->surface->opposite[last_dart(v->dart)];
    if (dart < 0)
        return ISO_OK;
    const double u[2] = {t->x / t->left, t->y / t->left};
    window child = seen_from(v, dart, 0, 0, u);
    child.low = v->low > 0 ? ray_meets(v, v->low, 0, 0, u, t->left) : 0;
    child.high = v->high < middle ? ray_meets(v, v->high, 0, 0, u, t->left) : t->left;
    /* from the dart's other end past the low end: all of the window's light crosses that way */
    double x = t->length * u[0] - child.low, y = t->length * u[1];
    double around = w->distance[to_of(w, v->dart)] + sqrt(x * x + y * y);
    return around * LONGER < distance_at(&child, child.low) ? ISO_OK : add_window(w, &child);
}

/* Through the edge from the apex to the dart's end. */
static iso_status pass_right(waves *w, const window *v, const triangle *t, double middle) {
    int32_t dart = w->surface->opposite[next_dart(v->dart)];
    if (dart < 0)
        return ISO_OK;
    const double u[2] = {(t->length - t->x) / t->right, -t->y / t->right};
    window child = seen_from(v, dart, t->x, t->y, u);
    child.low = v->low > middle ? ray_meets(v, v->low, t->x, t->y, u, t->right) : 0;
    child.high = v->high < t->length ? ray_meets(v, v->high, t->x, t->y, u, t->right) : t->right;
    double x = -t->x * u[0] - t->y * u[1] - child.high, y = t->x * u[1] - t->y * u[0];
    double around = w->distance[from_of(w, v->dart)] + sqrt(x * x + y * y);
    return around * LONGER < distance_at(&child, child.high) ? ISO_OK : add_window(w, &child);
}

/* Of all windows that light an apex through the same dart only the one from nearest by lights both
 * edges beyond: of any other, what passes on the near one's side of the apex comes late. */
static iso_status pass(waves *w, const window *v) {
    triangle t = triangle_of(w, v->dart);
    double dx = v->parallel ? v->x : t.x - v->x, dy = v->parallel ? v->y : t.y - v->y;
    double middle = t.x - t.y * dx / dy, near = NEAR_VERTEX * t.length;
    bool left = v->low<middle, right = v->high> middle;
    if (v->low - near <= middle && middle <= v->high + near) {
        double distance =
            v->parallel ? v->offset + v->x * t.x + v->y * t.y : v->offset + sqrt(dx * dx + dy * dy);
        ISO_TRY(reach_vertex(w, from_of(w, last_dart(v->dart)), distance));
        /* two windows side by side both reach an apex between them, as rounding has it */
        if (v->low + near < middle && middle < v->high - near) {
            if (distance < w->best[v->dart]) {
                w->best[v->dart] = distance;
                w->where[v->dart] = middle;
            } else {
                left = middle < w->where[v->dart];
                right = !left;
            }
        }
    }
    if (left)
        ISO_TRY(pass_left(w, v, &t, middle));
    return right ? pass_right(w, v, &t, middle) : ISO_OK;
}

// Where light starts

/* From a vertex, across the triangle of a dart that starts there, and along its edges. */
static iso_status shine(waves *w, int32_t dart) {
    const double *length = w->surface->length;
    double start = w->distance[from_of(w, dart)];
    int32_t across = next_dart(dart), back = last_dart(dart);
    ISO_TRY(reach_vertex(w, from_of(w, across), start + length[dart]));
    ISO_TRY(reach_vertex(w, from_of(w, back), start + length[back]));
    int32_t beyond = w->surface->opposite[across];
    if (beyond < 0 || !w->emits[from_of(w, dart)])
        return ISO_OK;
    window v = {.dart = beyond, .high = length[across], .offset = start};
    v.x = (v.high * v.high + length[back] * length[back] - length[dart] * length[dart]) /
          (2 * v.high);
    v.y = -sqrt(fmax(0, length[back] * length[back] - v.x * v.x));
    return add_window(w, &v);
}

/* From an edge with both ends given, into the triangle of the dart. */
static iso_status shine_from_edge(waves *w, int32_t dart) {
    int32_t from = from_of(w, dart), to = to_of(w, dart);
    if (!w->given[from] || !w->given[to] || w->given[from_of(w, last_dart(dart))])
        return ISO_OK;
    double length = w->surface->length[dart];
    double rise = (w->distance[to] - w->distance[from]) / length;
    if (!(rise > -1 && rise < 1))
        return ISO_OK;
    window v = {.dart = dart,
                .high = length,
                .x = rise,
                .y = sqrt(1 - rise * rise),
                .offset = w->distance[from],
                .parallel = true};
    /* not by add_window, which leaves to such edges what they light */
    ISO_TRY(ISO_GROW(w->window, w->window_room, (int64_t)w->window_count + 1));
    w->window[w->window_count] = v;
    return push_event(w, (event){least_distance(&v), w->window_count++});
}

/* Cosine and sine of the angle between a dart and the last one of its triangle. */
static void angle_of(double turn[2], const waves *w, int32_t dart) {
    triangle t = triangle_of(w, dart);
    turn[0] = t.x / t.left;
    turn[1] = t.y / t.left;
}

/* Do paths bend at a vertex: has it more than a full turn around it, or is it on a border? */
static bool may_bend(const waves *w, int32_t vertex) {
    double c = 1, s = 0;
    bool around = false;
    for (int32_t i = w->first[vertex]; i < w->first[vertex + 1]; i++) {
        double turn[2];
        int32_t dart = w->around[i];
        if (w->surface->opposite[dart] < 0 || w->surface->opposite[last_dart(dart)] < 0)
            return true;
        angle_of(turn, w, dart);
        double turned = s * turn[0] + c * turn[1];
        c = c * turn[0] - s * turn[1];
        if (s < 0 && turned >= 0) {
            if (around)
                return true;
            around = true;
        }
        s = turned;
        /* halfway around again, or clearly beyond the turn */
        if (around && (s < 0 || (s > SADDLE && i + 1 == w->first[vertex + 1])))
            return true;
    }
    return around && c < 0;
}

static void find_around(waves *w) {
    const wave_surface *surface = w->surface;
    int32_t darts = 3 * surface->triangle_count;
    memset(w->first, 0, ((size_t)surface->vertex_count + 2) * sizeof *w->first);
    for (int32_t a = 0; a < darts; a++)
        w->first[surface->origin[a] + 2]++;
    for (int32_t v = 0; v < surface->vertex_count; v++)
        w->first[v + 2] += w->first[v + 1];
    for (int32_t a = 0; a < darts; a++)
        w->around[w->first[surface->origin[a] + 1]++] = a;
}

static iso_status start(waves *w) {
    int32_t darts = 3 * w->surface->triangle_count;
    find_around(w);
    for (int32_t v = 0; v < w->surface->vertex_count; v++) {
        w->given[v] = isfinite(w->distance[v]);
        w->emits[v] = w->given[v] || may_bend(w, v);
        if (w->given[v])
            ISO_TRY(push_event(w, (event){w->distance[v], ~v}));
    }
    for (int32_t a = 0; a < darts; a++)
        w->best[a] = INFINITY;
    for (int32_t a = 0; a < darts; a++)
        ISO_TRY(shine_from_edge(w, a));
    return ISO_OK;
}

static iso_status spread(waves *w) {
    ISO_TRY(start(w));
    while (w->heap_count > 0) {
        event e = pop_event(w);
        if (e.what >= 0) {
            window v = w->window[e.what];
            w->window[e.what].dart = w->free;
            w->free = e.what;
            /* its ends may have come nearer since */
            if (!ends_are_nearer(w, &v) || (w->given[from_of(w, v.dart)] && v.parallel))
                ISO_TRY(pass(w, &v));
            continue;
        }
        int32_t vertex = ~e.what;
        if (e.distance > w->distance[vertex])
            continue;
        for (int32_t i = w->first[vertex]; i < w->first[vertex + 1]; i++)
            ISO_TRY(shine(w, w->around[i]));
    }
    return ISO_OK;
}

iso_status waves_spread(double *distance, const wave_surface *surface) {
    waves w = {.surface = surface, .distance = distance, .free = -1};
    int64_t darts = 3 * (int64_t)surface->triangle_count;
    iso_status status = ISO_ALLOCATE(w.first, (int64_t)surface->vertex_count + 2);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(w.around, darts);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(w.best, darts);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(w.where, darts);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(w.emits, surface->vertex_count);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(w.given, surface->vertex_count);
    if (status == ISO_OK)
        status = spread(&w);
    iso_release(w.first);
    iso_release(w.around);
    iso_release(w.best);
    iso_release(w.where);
    iso_release(w.emits);
    iso_release(w.given);
    iso_release(w.window);
    iso_release(w.heap);
    return status;
}

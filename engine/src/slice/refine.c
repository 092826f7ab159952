/* A face is left alone when each of these holds for certain, by bounds of the field's value and
 * gradient over its box:
 *
 *   - no level comes near it; or
 *   - along every edge that a level comes near F rises all the way, or falls all the way: so a
 *     level crosses an edge once at most, where F at its ends says so; and along some line in the
 *     face's plane F rises all the way, all over the face: so no level closes a loop inside it.
 *
 * Then a level is one line from edge to edge, or none (paper, 5: cyclically unimodal). Else edges
 * are split that are in the way. Edges are split for both their faces, which keeps the mesh a
 * double-link by construction; what is left of a face is asked again.
 *
 * F along an edge of length e is between the values at its ends but for half the spread of its
 * slope e . dF, and on a face but for two thirds of the largest spread of its edges: so bounds come
 * close as the square of the length where faces lie along a level, unlike those of the value alone.
 */
#include "slice/refine.h"

#include <math.h>
#include <stdbool.h>

#include "base/vector.h"
#include "slice/search.h"

/* mm: F on a face differs by no more. Its lines may be anywhere then: all of it is on the level. */
#define FLAT 1e-6
/* What is unknown, so large that it wins and so small that sums of it are finite. */
#define UNKNOWN 1e150
/* A chord may be off by this multiple of the tolerance as far as bounds tell, which exaggerate;
 * by the gradients at the corners it is within the tolerance. */
#define DOUBT 8
/* Edges as long as this part of the longest are split with it. */
#define LONG 0.6

typedef struct refiner {
    refined *r;
    const double *level;
    int32_t count;
    double scale;
    const iso_field_slicing *options;
} refiner;

/* The gradient over a box: within `spread` of `middle`, by component. */
typedef struct gradients {
    iso_vec3 middle, spread;
    double low, high; /* of the value */
} gradients;

typedef struct face {
    int32_t dart; /* the first */
    iso_vec3 corner[3], edge[3];
    double value[3];
    gradients bound;
    double slope[3], spread[3]; /* of F along the edges, from end to end */
} face;

/* ---- bounds ---- */

static double middle_of(double low, double high) {
    double middle = 0.5 * (low + high);
    return fabs(middle) < UNKNOWN ? middle : 0;
}

/* Rounding is covered by a little more. */
static double spread_of(double low, double high) {
    double spread = 0.5 * (high - low) + 1e-14 * (fabs(low) + fabs(high));
    return spread < UNKNOWN ? spread : UNKNOWN;
}

static gradients bound_over(const refiner *s, iso_vec3 low, iso_vec3 high) {
    iso_field_bound b;
    iso_field_bound_over(&b, s->r->field, low, high);
    iso_vec3 l = b.gradient_low, h = b.gradient_high;
    return (gradients){
        {middle_of(l.x, h.x), middle_of(l.y, h.y), middle_of(l.z, h.z)},
        {spread_of(l.x, h.x), spread_of(l.y, h.y), spread_of(l.z, h.z)},
        b.low > -UNKNOWN ? b.low : -UNKNOWN,
        b.high < UNKNOWN ? b.high : UNKNOWN,
    };
}

static double spread_along(const gradients *g, iso_vec3 way) {
    return g->spread.x * fabs(way.x) + g->spread.y * fabs(way.y) + g->spread.z * fabs(way.z);
}

static bool meets_level(const refiner *s, double low, double high) {
    int32_t i = levels_first_at(s->level, s->count, s->scale, low);
    return i < s->count && s->level[i] < high;
}

static double least(const double *x, int count) {
    double result = x[0];
    for (int i = 1; i < count; i++)
        result = x[i] < result ? x[i] : result;
    return result;
}

static double most(const double *x, int count) {
    double result = x[0];
    for (int i = 1; i < count; i++)
        result = x[i] > result ? x[i] : result;
    return result;
}

static iso_vec3 lower(iso_vec3 a, iso_vec3 b) {
    return vec3(a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z);
}

static iso_vec3 upper(iso_vec3 a, iso_vec3 b) {
    return vec3(a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z);
}

/* ---- a face ---- */

static void read_face(face *f, const refiner *s, int32_t number) {
    const refined *r = s->r;
    f->dart = 3 * number;
    for (int k = 0; k < 3; k++) {
        int32_t v = r->origin[f->dart + k];
        f->corner[k] = r->position[v];
        f->value[k] = r->value[v];
    }
    const iso_vec3 *p = f->corner;
    f->bound = bound_over(s, lower(lower(p[0], p[1]), p[2]), upper(upper(p[0], p[1]), p[2]));
    for (int k = 0; k < 3; k++) {
        f->edge[k] = vec3_minus(p[(k + 1) % 3], p[k]);
        f->slope[k] = vec3_dot(f->bound.middle, f->edge[k]);
        f->spread[k] = spread_along(&f->bound, f->edge[k]);
    }
}

static bool is_out_of_reach(const face *f, const refiner *s) {
    double margin = most(f->spread, 3) * (2.0 / 3);
    double low = fmax(least(f->value, 3) - margin, f->bound.low);
    double high = fmin(most(f->value, 3) + margin, f->bound.high);
    return high - low < FLAT || !meets_level(s, low, high);
}

static bool is_steady(const face *f, int k) {
    return fabs(f->slope[k]) > f->spread[k];
}

/* The edge by itself: its box is smaller than the face's. */
static bool is_edge_settled(const face *f, const refiner *s, int k) {
    if (is_steady(f, k))
        return true;
    iso_vec3 p = f->corner[k], q = f->corner[(k + 1) % 3];
    gradients bound = bound_over(s, lower(p, q), upper(p, q));
    double spread = spread_along(&bound, f->edge[k]);
    if (fabs(vec3_dot(bound.middle, f->edge[k])) > spread)
        return true;
    double ends[2] = {f->value[k], f->value[(k + 1) % 3]};
    double low = fmax(least(ends, 2) - 0.5 * spread, bound.low);
    double high = fmin(most(ends, 2) + 0.5 * spread, bound.high);
    return high - low < FLAT || !meets_level(s, low, high);
}

/* F rises along some line in the plane all over the face: an edge, or the middle gradient's. */
static bool has_no_loop(const face *f) {
    if (is_steady(f, 0) || is_steady(f, 1) || is_steady(f, 2))
        return true;
    iso_vec3 n = vec3_cross(f->edge[0], f->edge[1]), g = f->bound.middle;
    double n2 = vec3_dot(n, n);
    if (!(n2 > 0))
        return true; /* no inside at all */
    iso_vec3 way = vec3_along(g, -vec3_dot(g, n) / n2, n);
    return vec3_dot(g, way) > spread_along(&f->bound, way);
}

static iso_status mark(const refiner *s, const face *f, int k, bool *marked) {
    if (vec3_length(f->edge[k]) <= s->options->resolution)
        return ISO_OK;
    *marked = true;
    return refined_mark(s->r, f->dart + k);
}

static iso_status mark_long(const refiner *s, const face *f, const double length[3], bool *marked) {
    double bound = LONG * most(length, 3);
    for (int k = 0; k < 3; k++)
        if (length[k] >= bound)
            ISO_TRY(mark(s, f, k, marked));
    return ISO_OK;
}

/* The longest line of a level on a face with linear F runs along w = sum of F(corner) * (opposite
 * edge), from the middle corner to the edge across, and is w / (greatest F - least F). A curve with
 * the second derivative Q along its chord c leaves it by Q(c, c) / 8 over the slope; Q follows from
 * how the gradient changes along the three edges. */
static iso_status mark_chord(const refiner *s, const face *f, bool *marked) {
    const iso_vec3 *gradient = s->r->gradient;
    const int32_t *origin = s->r->origin + f->dart;
    double low = least(f->value, 3), range = most(f->value, 3) - low, q[3], v[3], length[3];
    double area = vec3_length(vec3_cross(f->edge[0], f->edge[1]));
    iso_vec3 w = vec3(0, 0, 0);
    for (int k = 0; k < 3; k++) {
        iso_vec3 change = vec3_minus(gradient[origin[(k + 1) % 3]], gradient[origin[k]]);
        q[k] = vec3_dot(change, f->edge[k]);
        v[k] = (f->value[(k + 2) % 3] - low) / range; /* at the corner across edge k */
        w = vec3_along(w, v[k], f->edge[k]);
    }
    double chord = vec3_length(w), steep = chord * range / area, bend = 0;
    for (int k = 0; k < 3; k++) {
        int l = (k + 1) % 3, m = (k + 2) % 3;
        bend += v[k] * v[k] * q[k] + v[k] * v[l] * (q[m] - q[k] - q[l]);
    }
    double allowed = 8 * s->options->tolerance * steep;
    if (!(fabs(bend) > allowed) && !(2 * spread_along(&f->bound, w) > DOUBT * allowed))
        return ISO_OK;
    for (int k = 0; k < 3; k++)
        length[k] = fabs(vec3_dot(f->edge[k], w));
    return mark_long(s, f, length, marked);
}

static bool is_crossed(const face *f, const refiner *s) {
    return meets_level(s, least(f->value, 3), most(f->value, 3));
}

static iso_status ask_face(refiner *s, int32_t number) {
    face f;
    bool marked = false;
    read_face(&f, s, number);
    if (is_out_of_reach(&f, s)) {
        s->r->settled[number] = 1;
        return ISO_OK;
    }
    for (int k = 0; k < 3; k++)
        if (!is_edge_settled(&f, s, k))
            ISO_TRY(mark(s, &f, k, &marked));
    if (marked)
        return ISO_OK;
    if (!has_no_loop(&f)) {
        double length[3];
        for (int k = 0; k < 3; k++)
            length[k] = vec3_length(f.edge[k]);
        return mark_long(s, &f, length, &marked);
    }
    if (s->options->tolerance > 0 && is_crossed(&f, s))
        return mark_chord(s, &f, &marked);
    return ISO_OK;
}

iso_status refine(refined *r, const double *level, int32_t count,
                  const iso_field_slicing *options) {
    refiner s = {r, level, count, levels_scale(level, count), options};
    refined_queue queue[2] = {{0}, {0}};
    iso_status status = ISO_OK;
    for (int32_t t = 0; t < r->mesh->triangle_count && status == ISO_OK; t++)
        status = ask_face(&s, t);
    for (int turn = 0; status == ISO_OK && r->parent_count > 0; turn ^= 1) {
        refined_queue *next = &queue[turn];
        next->count = 0;
        status = refined_split(r, next);
        for (int64_t i = 0; i < next->count && status == ISO_OK; i++)
            status = ask_face(&s, next->face[i]);
    }
    iso_release(queue[0].face);
    iso_release(queue[1].face);
    return status;
}

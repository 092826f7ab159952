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
#include "slice/bounds.h"
#include "slice/search.h"

/* mm: F on a face differs by no more. Its lines may be anywhere then: all of it is on the level. */
#define FLAT 1e-6
/* A chord may be off by this multiple of the tolerance as far as bounds tell, which exaggerate;
 * by the gradients at the corners it is within the tolerance. */
#define DOUBT 8
/* mm, and mm a mm: what rises more across an edge that isn't to be split is no layer's shape. */
#define JUMP 0.5
#define STEEP 100
/* mm a mm: what rises more may jump. */
#define SUSPECT 4
/* Edges as long as this part of the longest are split with it. */
#define LONG 0.6

typedef struct refiner {
    refined *r;
    const double *level;
    int32_t count;
    double scale;
    const iso_field_slicing *options;
    bounds_cells cells;
} refiner;

typedef struct face {
    int32_t dart; /* the first */
    iso_vec3 corner[3], edge[3];
    iso_vec3 low, high; /* its box */
    double value[3];
    bounds bound;
    double slope[3], spread[3]; /* of F along the edges, from end to end, by `bound` */
} face;

/* ---- bounds ---- */

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

static void read_face(face *f, const refined *r, int32_t number) {
    f->dart = 3 * number;
    for (int k = 0; k < 3; k++) {
        int32_t v = r->origin[f->dart + k];
        f->corner[k] = r->position[v];
        f->value[k] = r->value[v];
    }
    const iso_vec3 *p = f->corner;
    f->low = lower(lower(p[0], p[1]), p[2]);
    f->high = upper(upper(p[0], p[1]), p[2]);
    for (int k = 0; k < 3; k++)
        f->edge[k] = vec3_minus(p[(k + 1) % 3], p[k]);
}

static void bound_face(face *f, const bounds *bound) {
    f->bound = *bound;
    for (int k = 0; k < 3; k++) {
        f->slope[k] = vec3_dot(f->bound.middle, f->edge[k]);
        f->spread[k] = bounds_spread(&f->bound, f->edge[k]);
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

static bool is_edge_settled(const face *f, const refiner *s, int k, const bounds *bound) {
    double spread = bounds_spread(bound, f->edge[k]);
    if (fabs(vec3_dot(bound->middle, f->edge[k])) > spread)
        return true;
    double ends[2] = {f->value[k], f->value[(k + 1) % 3]};
    double low = fmax(least(ends, 2) - 0.5 * spread, bound->low);
    double high = fmin(most(ends, 2) + 0.5 * spread, bound->high);
    return high - low < FLAT || !meets_level(s, low, high);
}

/* By its own box, which is smaller than the face's. */
static bool is_edge_settled_by_itself(const face *f, const refiner *s, int k) {
    if (is_steady(f, k))
        return true;
    iso_vec3 p = f->corner[k], q = f->corner[(k + 1) % 3];
    bounds bound = bounds_over(s->r->field, lower(p, q), upper(p, q));
    return is_edge_settled(f, s, k, &bound);
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
    return vec3_dot(g, way) > bounds_spread(&f->bound, way);
}

/* What no splitting settles: F jumps across the edge, or as good as. */
static iso_status check_jump(iso_vec3 p, double rise, double length) {
    if (rise < JUMP || rise < STEEP * length)
        return ISO_OK;
    return iso_fail(ISO_UNSLICEABLE,
                    "the field jumps by %.3g mm at (%.3f, %.3f, %.3f) mm of the model", rise, p.x,
                    p.y, p.z);
}

/* Halve a steep edge towards where it rises most: a jump shows at once, before all faces that it
 * crosses are split until they are tiny. */
static iso_status look_for_jump(const refiner *s, const face *f, int k, double length) {
    iso_vec3 p = f->corner[k], q = f->corner[(k + 1) % 3];
    double from = f->value[k], to = f->value[(k + 1) % 3], middle;
    while (fabs(to - from) >= JUMP && fabs(to - from) >= SUSPECT * length) {
        if (length <= s->options->resolution)
            return check_jump(p, fabs(to - from), length);
        iso_vec3 half = vec3_between(p, q, 0.5);
        iso_field_evaluate(&middle, NULL, s->r->field, &half, 1);
        length /= 2;
        if (fabs(middle - from) >= fabs(to - middle)) {
            q = half;
            to = middle;
        } else {
            p = half;
            from = middle;
        }
    }
    return ISO_OK;
}

static iso_status mark(const refiner *s, const face *f, int k, bool *marked) {
    double length = vec3_length(f->edge[k]);
    if (length <= s->options->resolution)
        return check_jump(f->corner[k], fabs(f->value[(k + 1) % 3] - f->value[k]), length);
    ISO_TRY(look_for_jump(s, f, k, length));
    *marked = true;
    return refined_mark(s->r, f->dart + k);
}

static iso_status mark_long(const refiner *s, const face *f, const double length[3]) {
    double bound = LONG * most(length, 3);
    bool marked;
    for (int k = 0; k < 3; k++)
        if (length[k] >= bound)
            ISO_TRY(mark(s, f, k, &marked));
    return ISO_OK;
}

/* The longest line of a level on a face with linear F runs along w = sum of F(corner) * (opposite
 * edge), from the middle corner to the edge across, and is w / (greatest F - least F). A curve with
 * the second derivative Q along its chord c leaves it by Q(c, c) / 8 over the slope; Q follows from
 * how the gradient changes along the three edges. */
static bool is_bent(const face *f, const refiner *s, iso_vec3 *chord) {
    const iso_vec3 *gradient = s->r->gradient;
    const int32_t *origin = s->r->origin + f->dart;
    double low = least(f->value, 3), range = most(f->value, 3) - low, q[3], v[3], bend = 0;
    double area = vec3_length(vec3_cross(f->edge[0], f->edge[1]));
    iso_vec3 w = vec3(0, 0, 0);
    for (int k = 0; k < 3; k++) {
        iso_vec3 change = vec3_minus(gradient[origin[(k + 1) % 3]], gradient[origin[k]]);
        q[k] = vec3_dot(change, f->edge[k]);
        v[k] = (f->value[(k + 2) % 3] - low) / range; /* at the corner across edge k */
        w = vec3_along(w, v[k], f->edge[k]);
    }
    for (int k = 0; k < 3; k++) {
        int l = (k + 1) % 3, m = (k + 2) % 3;
        bend += v[k] * v[k] * q[k] + v[k] * v[l] * (q[m] - q[k] - q[l]);
    }
    double steep = vec3_length(w) * range / area, allowed = 8 * s->options->tolerance * steep;
    *chord = w;
    return fabs(bend) > allowed || 2 * bounds_spread(&f->bound, w) > DOUBT * allowed;
}

static bool is_crossed(const face *f, const refiner *s) {
    return meets_level(s, least(f->value, 3), most(f->value, 3));
}

static bool needs_straight_lines(const face *f, const refiner *s) {
    return s->options->tolerance > 0 && is_crossed(f, s);
}

/* All is well already by the bound of the cell that the face lies in. */
static bool is_fine_by_cell(face *f, refiner *s) {
    iso_vec3 chord;
    const bounds *bound = bounds_cells_around(&s->cells, s->r->field, f->low, f->high);
    if (!bound)
        return false;
    bound_face(f, bound);
    if (is_out_of_reach(f, s)) {
        s->r->settled[f->dart / 3] = 1;
        return true;
    }
    for (int k = 0; k < 3; k++)
        if (!is_edge_settled(f, s, k, bound))
            return false;
    return has_no_loop(f) && !(needs_straight_lines(f, s) && is_bent(f, s, &chord));
}

static iso_status ask_face(refiner *s, int32_t number) {
    face f;
    iso_vec3 chord;
    double length[3];
    bool marked = false;
    read_face(&f, s->r, number);
    if (is_fine_by_cell(&f, s))
        return ISO_OK;
    bounds bound = bounds_over(s->r->field, f.low, f.high);
    bound_face(&f, &bound);
    if (is_out_of_reach(&f, s)) {
        s->r->settled[number] = 1;
        return ISO_OK;
    }
    for (int k = 0; k < 3; k++)
        if (!is_edge_settled_by_itself(&f, s, k))
            ISO_TRY(mark(s, &f, k, &marked));
    if (marked)
        return ISO_OK;
    if (!has_no_loop(&f))
        for (int k = 0; k < 3; k++)
            length[k] = vec3_length(f.edge[k]);
    else if (needs_straight_lines(&f, s) && is_bent(&f, s, &chord))
        for (int k = 0; k < 3; k++)
            length[k] = fabs(vec3_dot(f.edge[k], chord));
    else
        return ISO_OK;
    return mark_long(s, &f, length);
}

static iso_status ask_all(refiner *s, refined_queue queue[2]) {
    refined *r = s->r;
    ISO_TRY(bounds_cells_begin(&s->cells, r->mesh));
    for (int32_t t = 0; t < r->mesh->triangle_count; t++)
        ISO_TRY(ask_face(s, t));
    bounds_cells_free(&s->cells); /* faces are of all sizes from here on */
    for (int turn = 0; r->parent_count > 0; turn ^= 1) {
        refined_queue *next = &queue[turn];
        next->count = 0;
        ISO_TRY(refined_split(r, next));
        for (int64_t i = 0; i < next->count; i++)
            ISO_TRY(ask_face(s, next->face[i]));
    }
    return ISO_OK;
}

iso_status refine(refined *r, const double *level, int32_t count,
                  const iso_field_slicing *options) {
    refiner s = {r, level, count, levels_scale(level, count), options, {0, NULL}};
    refined_queue queue[2] = {{0}, {0}};
    iso_status status = ask_all(&s, queue);
    bounds_cells_free(&s.cells);
    iso_release(queue[0].face);
    iso_release(queue[1].face);
    return status;
}

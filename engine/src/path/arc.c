/* Greedy: from each vertex on the longest run of beads that one circle fits. The length is found by
 * doubling and halving, so that a run of n beads is looked at about 2 log n times. */
#include <isoslice/arc.h>

#include <math.h>
#include <stdbool.h>

#include "base/memory.h"

enum { LEAST = 3 /* beads; fewer aren't worth it */ };

iso_arc_options iso_arc_defaults(void) {
    return (iso_arc_options){.tolerance = 125, .radius_min = 2000, .radius_max = 10000000};
}

/* A path with its vertices numbered on behind the last one, if it is closed. */
typedef struct track {
    const iso_path_vertex *vertex;
    int32_t count; /* vertices */
    int32_t beads;
} track;

static const iso_path_vertex *vertex_at(const track *t, int32_t i) {
    return &t->vertex[i < t->count ? i : i - t->count];
}

static iso_vec2 place_of(const track *t, int32_t i) {
    iso_point p = vertex_at(t, i)->at;
    return (iso_vec2){p.x, p.y};
}

static bool same_bead(const iso_path_vertex *a, const iso_path_vertex *b) {
    return a->width == b->width && a->area == b->area && a->role == b->role;
}

/* Beads from `first` on that may share an arc with the one before. */
static int32_t uniform_run(const track *t, int32_t first) {
    int32_t n = first;
    while (n < t->beads && same_bead(vertex_at(t, first), vertex_at(t, n)) &&
           vertex_at(t, n)->z == 0 && vertex_at(t, n + 1)->z == 0)
        n++;
    return n - first;
}

static double cross(iso_vec2 a, iso_vec2 b) {
    return a.x * b.y - a.y * b.x;
}

static iso_vec2 between(iso_vec2 a, iso_vec2 b) {
    return (iso_vec2){b.x - a.x, b.y - a.y};
}

/* The circle through three points, its centre relative to `a` for accuracy's sake. */
static bool circle(iso_vec2 *center, double *radius, iso_vec2 a, iso_vec2 b, iso_vec2 c) {
    iso_vec2 ab = between(a, b), ac = between(a, c);
    double d = 2 * cross(ab, ac);
    double bb = ab.x * ab.x + ab.y * ab.y, cc = ac.x * ac.x + ac.y * ac.y;
    if (fabs(d) < 1e-9 * (bb + cc))
        return false;
    iso_vec2 u = {(ac.y * bb - ab.y * cc) / d, (ab.x * cc - ac.x * bb) / d};
    *radius = sqrt(u.x * u.x + u.y * u.y);
    *center = (iso_vec2){a.x + u.x, a.y + u.y};
    return true;
}

/* Is the bead from a to b within the tolerance of the arc, and does it turn the arc's way? */
static bool bead_fits(const iso_arc *arc, const iso_arc_options *options, iso_vec2 a, iso_vec2 b) {
    iso_vec2 ra = between(arc->center, a), rb = between(arc->center, b);
    iso_vec2 middle = {(ra.x + rb.x) / 2, (ra.y + rb.y) / 2};
    double turn = cross(ra, rb);
    double off = sqrt(rb.x * rb.x + rb.y * rb.y) - arc->radius;
    double sagitta = sqrt(middle.x * middle.x + middle.y * middle.y) - arc->radius;
    return (turn > 0) == !arc->clockwise && turn != 0 && fabs(off) <= options->tolerance &&
           fabs(sagitta) <= options->tolerance && ra.x * rb.x + ra.y * rb.y > 0;
}

/* One whole turn would end where it begins, and less than a quarter of a turn a bead is asked for,
 * so the signed angle is summed by quadrants crossed: exact without an arc tangent. */
static bool turns_too_far(const iso_arc *arc, const track *t) {
    iso_vec2 start = between(arc->center, place_of(t, arc->first));
    bool passed_half = false;
    for (int32_t i = 1; i <= arc->count; i++) {
        iso_vec2 here = between(arc->center, place_of(t, arc->first + i));
        double side = arc->clockwise ? cross(here, start) : cross(start, here);
        if (side < 0)
            passed_half = true;
        else if (passed_half)
            return true;
    }
    return false;
}

static bool fit(iso_arc *arc, const track *t, int32_t first, int32_t count,
                const iso_arc_options *options) {
    iso_vec2 a = place_of(t, first), b = place_of(t, first + count / 2);
    iso_vec2 c = place_of(t, first + count);
    arc->first = first;
    arc->count = count;
    if (!circle(&arc->center, &arc->radius, a, b, c) || arc->radius < options->radius_min ||
        arc->radius > options->radius_max)
        return false;
    arc->clockwise = cross(between(a, b), between(b, c)) < 0;
    for (int32_t i = 0; i < count; i++)
        if (!bead_fits(arc, options, place_of(t, first + i), place_of(t, first + i + 1)))
            return false;
    return !turns_too_far(arc, t);
}

/* The longest arc from `first` on of at most `most` beads; false if there is none. */
static bool longest(iso_arc *arc, const track *t, int32_t first, int32_t most,
                    const iso_arc_options *options) {
    iso_arc candidate = *arc;
    int32_t good = 0, bad = most + 1;
    for (int32_t n = LEAST; n <= most && n < bad;) {
        if (fit(&candidate, t, first, n, options)) {
            *arc = candidate;
            good = n;
            n = n == most ? most + 1 : n < most / 2 ? 2 * n : most;
        } else {
            bad = n;
        }
    }
    while (good > 0 && good + 1 < bad) {
        int32_t n = good + (bad - good) / 2;
        if (fit(&candidate, t, first, n, options)) {
            *arc = candidate;
            good = n;
        } else {
            bad = n;
        }
    }
    return good > 0;
}

static int32_t find(iso_arc *arc, const track *t, int32_t path, const iso_arc_options *options) {
    int32_t found = 0;
    for (int32_t i = 0; i + LEAST <= t->beads;) {
        int32_t run = uniform_run(t, i), end = i + run;
        while (i + LEAST <= end) {
            arc[found].path = path;
            if (longest(&arc[found], t, i, end - i, options))
                i += arc[found++].count;
            else
                i++;
        }
        i = run > 0 ? end : i + 1;
    }
    return found;
}

iso_status iso_paths_find_arcs(iso_arc **arc, int32_t *count, const iso_paths *paths,
                               const iso_arc_options *options, iso_arena *scratch) {
    *count = 0;
    ISO_TRY(ISO_PUSH(*arc, scratch, (int64_t)paths->vertex_count / LEAST + 1));
    for (int32_t p = 0; p < paths->count; p++) {
        const iso_path *path = &paths->path[p];
        track t = {.vertex = paths->vertex + path->first,
                   .count = path->count,
                   .beads = path->closed ? path->count : path->count - 1};
        *count += find(*arc + *count, &t, p, options);
    }
    return ISO_OK;
}

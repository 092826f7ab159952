#include "object/lattice.h"

#include "base/sort.h"
#include "planar/predicate.h"

/* The densest lattice of a convex outline touches it in six directions: u, v and v - u lie on the
 * border of what two copies may not differ by (Minkowski, Diophantische Approximationen, 1907). So
 * for each of its corners and the middles between them as u, v is sought where the border crosses
 * the border moved by u. Dense isn't all: few rows have to fit into the bed as well, so that the
 * densest lattices and those along the axes are tried, from a number of origins each. */

enum {
    DENSEST = 12, /* lattices tried, next to the two along the axes */
    PHASES = 6    /* origins tried along each side of a cell, next to the corners of the space */
};

typedef struct lattice {
    iso_point u, v;
    int64_t area; /* of a cell; 0: none was found */
    bool along_axis;
} lattice;

typedef struct found {
    int64_t distance; /* squared, from the target */
    iso_point at;
} found;

typedef struct search {
    const iso_lattice_space *space;
    iso_box box; /* of the space */
    lattice *lattice;
    int32_t lattices;
    found *place, *best;
    int64_t count, best_count;
    int64_t place_capacity, best_capacity;
} search;

#define IS_NEARER(a, b)                                                                            \
    ((a)->distance != (b)->distance ? (a)->distance < (b)->distance : point_less((a)->at, (b)->at))

ISO_SORT(sort_found, found, IS_NEARER)

#define IS_DENSER(a, b)                                                                            \
    ((a)->along_axis != (b)->along_axis ? (a)->along_axis                                          \
     : (a)->area != (b)->area           ? (a)->area < (b)->area                                    \
     : !point_equal((a)->u, (b)->u)     ? point_less((a)->u, (b)->u)                               \
                                        : point_less((a)->v, (b)->v))

ISO_SORT(sort_lattices, lattice, IS_DENSER)

static iso_point plus(iso_point a, iso_point b) {
    return (iso_point){a.x + b.x, a.y + b.y};
}

static iso_point minus(iso_point a, iso_point b) {
    return (iso_point){a.x - b.x, a.y - b.y};
}

/* ---- lattices ---- */

/* A unit or so within the border counts as on it: that is how far rounding moves things. */
static bool too_near(const iso_lattice_space *space, iso_point d) {
    for (int32_t i = 0; i < space->corners; i++) {
        iso_point a = space->apart[i], b = space->apart[i + 1 == space->corners ? 0 : i + 1];
        int64_t dx = (int64_t)b.x - a.x, dy = (int64_t)b.y - a.y;
        int64_t reach = (dx < 0 ? -dx : dx) + (dy < 0 ? -dy : dy);
        if (orient2d(a, b, d) <= reach)
            return false;
    }
    return true;
}

static void consider(lattice *best, const iso_lattice_space *space, iso_point u, iso_point v) {
    int64_t area = cross(u.x, u.y, v.x, v.y);
    if (area <= 0 || (best->area > 0 && area >= best->area))
        return;
    iso_point w = minus(v, u);
    if (too_near(space, v) || too_near(space, w) || too_near(space, plus(u, v)) ||
        too_near(space, minus(w, u)) || too_near(space, plus(v, w)))
        return;
    best->area = area;
    best->v = v;
}

/* The v that makes the smallest cell with u. */
static lattice lattice_along(const iso_lattice_space *space, iso_point u) {
    lattice best = {.u = u};
    for (int32_t i = 0; i < space->corners; i++) {
        iso_point a = space->apart[i], b = space->apart[i + 1 == space->corners ? 0 : i + 1];
        if (cross(u.x, u.y, a.x, a.y) <= 0 && cross(u.x, u.y, b.x, b.y) <= 0)
            continue;
        consider(&best, space, u, a);
        consider(&best, space, u, plus(a, u));
        for (int32_t j = 0; j < space->corners; j++) {
            iso_point c = plus(space->apart[j], u);
            iso_point d = plus(space->apart[j + 1 == space->corners ? 0 : j + 1], u);
            int64_t oa = orient2d(c, d, a), ob = orient2d(c, d, b);
            int64_t oc = orient2d(a, b, c), od = orient2d(a, b, d);
            if ((oa > 0) != (ob > 0) && (oc > 0) != (od > 0) && oa != 0 && ob != 0)
                consider(&best, space, u, crossing_point(a, b, oa, ob));
        }
    }
    return best;
}

/* Where the border crosses an axis. */
static iso_point on_axis(const iso_lattice_space *space, bool along_x) {
    iso_point from = {0, 0}, to = along_x ? (iso_point){ISO_COORDINATE_MAX, 0}
                                          : (iso_point){0, ISO_COORDINATE_MAX};
    for (int32_t i = 0; i < space->corners; i++) {
        iso_point a = space->apart[i], b = space->apart[i + 1 == space->corners ? 0 : i + 1];
        int64_t oa = orient2d(from, to, a), ob = orient2d(from, to, b);
        if (oa <= 0 && ob > 0)
            return crossing_point(a, b, oa, ob);
    }
    return from;
}

static iso_status find_lattices(search *s) {
    const iso_lattice_space *space = s->space;
    ISO_TRY(ISO_ALLOCATE(s->lattice, 2 * (int64_t)space->corners + 2));
    for (int axis = 0; axis < 2; axis++) {
        lattice l = lattice_along(space, on_axis(space, axis == 0));
        l.along_axis = true;
        if (l.area > 0)
            s->lattice[s->lattices++] = l;
    }
    int32_t along = s->lattices;
    for (int32_t i = 0; i < space->corners; i++) {
        iso_point a = space->apart[i], b = space->apart[i + 1 == space->corners ? 0 : i + 1];
        iso_point u[2] = {a, {a.x + (b.x - a.x) / 2, a.y + (b.y - a.y) / 2}};
        for (int k = 0; k < 2; k++) {
            if (point_less(u[k], (iso_point){0, 0})) /* the same as from its mirror image */
                continue;
            lattice l = lattice_along(space, u[k]);
            if (l.area > 0)
                s->lattice[s->lattices++] = l;
        }
    }
    sort_lattices(s->lattice, s->lattices);
    if (s->lattices > along + DENSEST)
        s->lattices = along + DENSEST;
    return ISO_OK;
}

/* ---- places ---- */

static int64_t floor_of(int64_t n, int64_t d) {
    return (int64_t)floor_divide(n, d);
}

static iso_status add_place(search *s, int64_t x, int64_t y) {
    iso_point at = {(int32_t)x, (int32_t)y};
    if (iso_region_locate(s->space->inside, at) < 0)
        return ISO_OK;
    int64_t dx = x - s->space->target.x, dy = y - s->space->target.y;
    ISO_TRY(ISO_GROW(s->place, s->place_capacity, s->count + 1));
    s->place[s->count++] = (found){dx * dx + dy * dy, at};
    return ISO_OK;
}

/* All points origin + i u + j v in the space. The rows along u that meet its box are counted by
 * their distance from the origin, and within a row the points by the box again. */
static iso_status fill(search *s, const lattice *l, iso_point origin) {
    const iso_box *box = &s->box;
    const iso_point corner[4] = {
        box->min, {box->max.x, box->min.y}, box->max, {box->min.x, box->max.y}};
    int64_t first = INT64_MAX, last = INT64_MIN;
    s->count = 0;
    for (int k = 0; k < 4; k++) {
        int64_t row = floor_of(
            cross(l->u.x, l->u.y, (int64_t)corner[k].x - origin.x, (int64_t)corner[k].y - origin.y),
            l->area);
        first = row < first ? row : first;
        last = row > last ? row : last;
    }
    for (int64_t j = first; j <= last + 1; j++) {
        int64_t x = origin.x + j * l->v.x, y = origin.y + j * l->v.y;
        bool by_x = l->u.x * (int64_t)l->u.x >= l->u.y * (int64_t)l->u.y;
        int64_t step = by_x ? l->u.x : l->u.y, at = by_x ? x : y;
        int64_t low = by_x ? box->min.x : box->min.y, high = by_x ? box->max.x : box->max.y;
        int64_t a = step > 0 ? low : -high, b = step > 0 ? high : -low, c = step > 0 ? at : -at;
        int64_t size = step > 0 ? step : -step;
        for (int64_t i = floor_of(a - c, size); i <= floor_of(b - c, size); i++)
            ISO_TRY(add_place(s, x + i * l->u.x, y + i * l->u.y));
    }
    return ISO_OK;
}

/* More is better; of as many, those that are closer together. */
static void keep_if_better(search *s, int32_t most) {
    if (s->count > most) {
        sort_found(s->place, s->count);
        s->count = most;
    }
    if (s->count < s->best_count || s->count == 0)
        return;
    if (s->count == s->best_count) {
        int64_t sum = 0;
        for (int64_t i = 0; i < s->count; i++)
            sum += s->place[i].distance / s->count - s->best[i].distance / s->count;
        if (sum >= 0)
            return;
    }
    found *swap = s->best;
    int64_t capacity = s->best_capacity;
    s->best = s->place, s->best_capacity = s->place_capacity, s->best_count = s->count;
    s->place = swap, s->place_capacity = capacity;
}

static iso_status try_lattice(search *s, const lattice *l, int32_t most) {
    const iso_region *inside = s->space->inside;
    for (int32_t i = 0; i < inside->first[inside->count]; i++) {
        ISO_TRY(fill(s, l, inside->point[i]));
        keep_if_better(s, most);
    }
    for (int k = 0; k < PHASES * PHASES; k++) {
        int64_t i = k % PHASES, j = k / PHASES;
        iso_point origin = {(int32_t)(s->space->target.x + (l->u.x * i + l->v.x * j) / PHASES),
                            (int32_t)(s->space->target.y + (l->u.y * i + l->v.y * j) / PHASES)};
        ISO_TRY(fill(s, l, origin));
        keep_if_better(s, most);
    }
    return ISO_OK;
}

static iso_status find_places(search *s, int32_t most) {
    const iso_region *inside = s->space->inside;
    if (inside->count == 0)
        return ISO_OK;
    s->box = (iso_box){inside->point[0], inside->point[0]};
    for (int32_t i = 0; i < inside->first[inside->count]; i++)
        box_add(&s->box, inside->point[i]);
    ISO_TRY(find_lattices(s));
    for (int32_t i = 0; i < s->lattices; i++)
        ISO_TRY(try_lattice(s, &s->lattice[i], most));
    return ISO_OK;
}

iso_status lattice_places(iso_point *place, int32_t *count, int32_t most,
                          const iso_lattice_space *space) {
    search s = {.space = space};
    *count = 0;
    iso_status status = find_places(&s, most);
    if (status == ISO_OK) {
        *count = (int32_t)s.best_count;
        for (int32_t i = 0; i < *count; i++)
            place[i] = s.best[i].at;
    }
    iso_release(s.lattice);
    iso_release(s.place);
    iso_release(s.best);
    return status;
}

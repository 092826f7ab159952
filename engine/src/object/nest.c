#include "object/nest.h"

#include "base/sort.h"
#include "object/hull.h"
#include "object/lattice.h"
#include "planar/predicate.h"
#include "planar/region.h"

/* No-fit polygons (Adamowicz and Albano, 1976; a survey is Bennell and Oliveira, The geometry of
 * nesting problems, 2008). Where B may not stand because of A is the convex polygon A - B; where it
 * may stand on the bed is the bed less what its edges forbid. One difference of regions for each
 * outline placed keeps the free places, and the best of their corners is taken, largest outlines
 * first.
 *
 * What is best decides how much fits, and nothing is best for all shapes: first around the middle,
 * which leaves the bed's edge free; if that doesn't do, towards each corner of the bed, by rows, by
 * columns and diagonally, and in a lattice. */

enum {
    SLACK = 6,    /* units that outlines may be too near, so that a place that just fits is one */
    THIN = 300,   /* units by which outlines may be thickened to have fewer corners */
    MARGINS = 500 /* units a round join may reach too far */
};

typedef enum direction { AROUND, ROWS, COLUMNS, DIAGONAL, LATTICE } direction;

typedef struct plan {
    direction direction;
    int sign_x, sign_y;
} plan;

static const plan plans[] = {
    {AROUND, 0, 0},   {ROWS, 1, 1},      {COLUMNS, 1, 1},   {LATTICE, 1, 1},   {ROWS, -1, 1},
    {ROWS, 1, -1},    {ROWS, -1, -1},    {COLUMNS, -1, 1},  {COLUMNS, 1, -1},  {COLUMNS, -1, -1},
    {DIAGONAL, 1, 1}, {DIAGONAL, -1, 1}, {DIAGONAL, 1, -1}, {DIAGONAL, -1, -1}};

enum { PLANS = sizeof plans / sizeof *plans };

typedef struct kind {
    iso_point *thin, *wide; /* the outline with fewer corners; the same grown by the distance */
    int32_t thin_count, wide_count;
    iso_point middle;  /* of its box */
    iso_region inside; /* where it may stand on the bed */
} kind;

typedef struct nester {
    const iso_nest *nest;
    iso_planar_scratch *scratch;
    kind *kind;      /* [shapes] */
    int32_t *turn;   /* [shapes] largest first */
    int32_t *first;  /* [shapes + 1] into by and best */
    iso_point *by;   /* [all copies] of the plan at hand */
    iso_point *best; /* [all copies] of the plan that got farthest */
    iso_point *sum;  /* room for a no-fit polygon */
    iso_region free, next, obstacles;
} nester;

/* ---- outlines ---- */

static iso_status copy_points(iso_point **to, const iso_point *point, int32_t count) {
    ISO_TRY(ISO_ALLOCATE(*to, (int64_t)count + 1));
    memcpy(*to, point, (size_t)count * sizeof **to);
    return ISO_OK;
}

/* The outline grown by the distance, with few corners. */
static iso_status widen(kind *k, nester *n, const iso_nest_shape *shape) {
    iso_region *raw = &n->obstacles, *grown = &n->next;
    iso_offset_options options = iso_offset_defaults(n->nest->distance - SLACK);
    options.join = ISO_JOIN_ROUND;
    options.arc_tolerance = MARGINS;
    iso_region_clear(raw);
    ISO_TRY(iso_region_add(raw, k->thin, k->thin_count));
    ISO_TRY(iso_region_clean(&n->free, raw, ISO_FILL_NONZERO, n->scratch));
    ISO_TRY(iso_offset(grown, &n->free, &options, n->scratch));
    if (grown->count == 0)
        return iso_fail(ISO_OUTSIDE, "an object is too thin to be arranged");
    int32_t count = grown->first[1];
    ISO_TRY(ISO_ALLOCATE(k->wide, 2 * (int64_t)count + 1));
    k->wide_count = hull_of(k->wide, grown->point, count);
    k->wide_count = hull_thin(k->wide, k->wide_count, THIN, k->wide + count + 1);
    return ISO_OK;
}

static iso_status make_kind(kind *k, nester *n, const iso_nest_shape *shape) {
    iso_box box = {shape->hull[0], shape->hull[0]};
    for (int32_t i = 1; i < shape->corners; i++)
        box_add(&box, shape->hull[i]);
    k->middle = (iso_point){box.min.x + (box.max.x - box.min.x) / 2,
                            box.min.y + (box.max.y - box.min.y) / 2};
    ISO_TRY(copy_points(&k->thin, shape->hull, shape->corners));
    iso_point *room;
    ISO_TRY(ISO_ALLOCATE(room, shape->corners));
    k->thin_count = hull_thin(k->thin, shape->corners, THIN, room);
    iso_release(room);
    return widen(k, n, shape);
}

/* A stretch of the bed's edge takes the places where the outline would meet it: the hull of what
 * its two ends take. */
static iso_status add_edge(nester *n, const iso_nest_shape *shape, iso_point a, iso_point b) {
    int32_t count = shape->corners;
    iso_point *all = n->sum, *hull = n->sum + 2 * (int64_t)count;
    for (int32_t i = 0; i < count; i++) {
        iso_point q = shape->hull[i];
        all[i] = (iso_point){a.x - q.x, a.y - q.y};
        all[count + i] = (iso_point){b.x - q.x, b.y - q.y};
    }
    return iso_region_add(&n->obstacles, hull, hull_of(hull, all, 2 * count));
}

/* Places with the first corner on the bed, less those where the bed's edge is in the way. */
static iso_status find_inside(kind *k, nester *n, const iso_nest_shape *shape) {
    const iso_region *bed = n->nest->bed;
    iso_region_clear(&n->next);
    iso_region_clear(&n->obstacles);
    for (int32_t c = 0; c < bed->count; c++) {
        int32_t from = bed->first[c], end = bed->first[c + 1];
        for (int32_t i = from; i < end; i++)
            ISO_TRY(add_edge(n, shape, bed->point[i], bed->point[i + 1 < end ? i + 1 : from]));
        ISO_TRY(iso_region_add(&n->next, bed->point + from, end - from));
        for (int32_t i = n->next.first[c]; i < n->next.first[c + 1]; i++) {
            n->next.point[i].x -= shape->hull[0].x;
            n->next.point[i].y -= shape->hull[0].y;
        }
    }
    return iso_boolean(&k->inside, ISO_DIFFERENCE, &n->next, &n->obstacles, n->scratch);
}

/* ---- the best of the free places ---- */

typedef struct choice {
    bool found;
    int64_t major, minor; /* the less the better */
    iso_point at;
} choice;

static void consider(choice *best, const plan *p, iso_point target, iso_point at) {
    int64_t major, minor;
    if (p->direction == AROUND) {
        int64_t dx = (int64_t)at.x - target.x, dy = (int64_t)at.y - target.y;
        major = dx * dx + dy * dy;
        minor = 0;
    } else {
        int64_t x = (int64_t)at.x * p->sign_x, y = (int64_t)at.y * p->sign_y;
        major = p->direction == COLUMNS ? x : p->direction == DIAGONAL ? x + y : y;
        minor = p->direction == COLUMNS ? y : x;
    }
    bool better = major != best->major   ? major < best->major
                  : minor != best->minor ? minor < best->minor
                                         : point_less(at, best->at);
    if (!best->found || better)
        *best = (choice){true, major, minor, at};
}

/* The point of the edge ab next to the target, if it isn't an end. */
static bool foot_on(iso_point *foot, iso_point a, iso_point b, iso_point target) {
    int64_t dx = (int64_t)b.x - a.x, dy = (int64_t)b.y - a.y;
    int64_t along = dx * ((int64_t)target.x - a.x) + dy * ((int64_t)target.y - a.y);
    int64_t length = dx * dx + dy * dy;
    if (along <= 0 || along >= length)
        return false;
    *foot = (iso_point){
        (int32_t)(a.x + floor_divide((iso_int128)dx * along * 2 + length, (iso_int128)2 * length)),
        (int32_t)(a.y + floor_divide((iso_int128)dy * along * 2 + length, (iso_int128)2 * length))};
    return true;
}

static choice choose(const nester *n, const plan *p, iso_point target) {
    choice best = {0};
    const iso_region *free = &n->free;
    if (p->direction == AROUND && iso_region_locate(free, target) >= 0)
        return (choice){true, 0, 0, target};
    for (int32_t c = 0; c < free->count; c++) {
        int32_t from = free->first[c], end = free->first[c + 1];
        for (int32_t i = from; i < end; i++) {
            iso_point a = free->point[i], b = free->point[i + 1 < end ? i + 1 : from], foot;
            consider(&best, p, target, a);
            if (p->direction == AROUND && foot_on(&foot, a, b, target))
                consider(&best, p, target, foot);
        }
    }
    return best;
}

/* ---- placing ---- */

static iso_status add_obstacle(nester *n, const kind *placed, iso_point at, const kind *next) {
    int32_t count =
        hull_difference(n->sum, placed->wide, placed->wide_count, next->thin, next->thin_count);
    for (int32_t i = 0; i < count; i++) {
        n->sum[i].x += at.x;
        n->sum[i].y += at.y;
    }
    return iso_region_add(&n->obstacles, n->sum, count);
}

static iso_status subtract(nester *n) {
    ISO_TRY(iso_boolean(&n->next, ISO_DIFFERENCE, &n->free, &n->obstacles, n->scratch));
    iso_region swap = n->free;
    n->free = n->next;
    n->next = swap;
    return ISO_OK;
}

/* Where the shape may stand among all that are placed already: those before it in turn, and `own`
 * copies of its own. */
static iso_status find_free(nester *n, int32_t turn, int32_t own) {
    const kind *k = &n->kind[n->turn[turn]];
    iso_region_clear(&n->free);
    for (int32_t c = 0; c < k->inside.count; c++) {
        int32_t from = k->inside.first[c];
        ISO_TRY(iso_region_add(&n->free, k->inside.point + from, k->inside.first[c + 1] - from));
    }
    iso_region_clear(&n->obstacles);
    for (int32_t t = 0; t < turn; t++) {
        int32_t other = n->turn[t];
        for (int32_t i = n->first[other]; i < n->first[other + 1]; i++)
            ISO_TRY(add_obstacle(n, &n->kind[other], n->by[i], k));
    }
    for (int32_t i = 0; i < own; i++)
        ISO_TRY(add_obstacle(n, k, n->by[n->first[n->turn[turn]] + i], k));
    return subtract(n);
}

/* The largest shape in even rows, among nothing else. */
static iso_status place_rows(int32_t *placed, nester *n, iso_point target) {
    int32_t s = n->turn[0];
    const kind *k = &n->kind[s];
    iso_lattice_space space = {.apart = n->sum, .inside = &k->inside, .target = target};
    space.corners = hull_difference(n->sum, k->wide, k->wide_count, k->thin, k->thin_count);
    return lattice_places(n->by + n->first[s], placed, n->first[s + 1] - n->first[s], &space);
}

static iso_status follow(int32_t *placed, int32_t *left, nester *n, const plan *p) {
    *placed = 0;
    for (int32_t t = 0; t < n->nest->shapes; t++) {
        int32_t s = *left = n->turn[t];
        const kind *k = &n->kind[s];
        iso_point target = {n->nest->target.x - k->middle.x, n->nest->target.y - k->middle.y};
        int32_t done = 0;
        if (t == 0 && p->direction == LATTICE)
            ISO_TRY(place_rows(&done, n, target));
        ISO_TRY(find_free(n, t, done));
        *placed += done;
        for (int32_t i = n->first[s] + done; i < n->first[s + 1]; i++, ++*placed) {
            choice best = choose(n, p, target);
            if (!best.found)
                return ISO_OK;
            n->by[i] = best.at;
            if (i + 1 == n->first[s + 1])
                continue;
            iso_region_clear(&n->obstacles);
            ISO_TRY(add_obstacle(n, k, best.at, k));
            ISO_TRY(subtract(n));
        }
    }
    *left = -1;
    return ISO_OK;
}

/* ---- the middle of it all ---- */

static bool all_fit(const nester *n, int64_t dx, int64_t dy) {
    for (int32_t s = 0; s < n->nest->shapes; s++)
        for (int32_t i = n->first[s]; i < n->first[s + 1]; i++) {
            iso_point at = {(int32_t)(n->best[i].x + dx), (int32_t)(n->best[i].y + dy)};
            if (iso_region_locate(&n->kind[s].inside, at) < 0)
                return false;
        }
    return true;
}

/* Move everything so that its box is centred, or at least one of its sides. */
static void centre(nester *n) {
    iso_box box = {{INT32_MAX, INT32_MAX}, {INT32_MIN, INT32_MIN}};
    for (int32_t s = 0; s < n->nest->shapes; s++)
        for (int32_t i = n->first[s]; i < n->first[s + 1]; i++)
            for (int32_t k = 0; k < n->nest->shape[s].corners; k++) {
                iso_point p = n->nest->shape[s].hull[k];
                box_add(&box, (iso_point){p.x + n->best[i].x, p.y + n->best[i].y});
            }
    int64_t dx = n->nest->target.x - ((int64_t)box.min.x + box.max.x) / 2;
    int64_t dy = n->nest->target.y - ((int64_t)box.min.y + box.max.y) / 2;
    for (int turn = 0; turn < 3; turn++) {
        int64_t x = turn == 2 ? 0 : dx, y = turn == 1 ? 0 : dy;
        if (!all_fit(n, x, y))
            continue;
        for (int32_t i = 0; i < n->first[n->nest->shapes]; i++) {
            n->best[i].x += (int32_t)x;
            n->best[i].y += (int32_t)y;
        }
        return;
    }
}

/* ---- all of it ---- */

typedef struct ranked {
    int64_t area;
    int32_t shape;
} ranked;

#define IS_LARGER(a, b) ((a)->area != (b)->area ? (a)->area > (b)->area : (a)->shape < (b)->shape)

ISO_SORT(sort_ranked, ranked, IS_LARGER)

static iso_status prepare(nester *n) {
    const iso_nest *nest = n->nest;
    int32_t most = 0;
    ranked *rank;
    ISO_TRY(ISO_ALLOCATE(n->kind, nest->shapes));
    memset(n->kind, 0, (size_t)nest->shapes * sizeof *n->kind);
    ISO_TRY(ISO_ALLOCATE(n->turn, nest->shapes));
    ISO_TRY(ISO_ALLOCATE(n->first, (int64_t)nest->shapes + 1));
    ISO_TRY(ISO_ALLOCATE(rank, nest->shapes));
    n->first[0] = 0;
    for (int32_t s = 0; s < nest->shapes; s++) {
        const iso_nest_shape *shape = &nest->shape[s];
        rank[s] = (ranked){hull_double_area(shape->hull, shape->corners), s};
        n->first[s + 1] = n->first[s] + shape->copies;
        most = shape->corners > most ? shape->corners : most;
    }
    sort_ranked(rank, nest->shapes);
    for (int32_t s = 0; s < nest->shapes; s++)
        n->turn[s] = rank[s].shape;
    iso_release(rank);
    ISO_TRY(ISO_ALLOCATE(n->by, n->first[nest->shapes]));
    ISO_TRY(ISO_ALLOCATE(n->best, n->first[nest->shapes]));
    for (int32_t s = 0; s < nest->shapes; s++) {
        ISO_TRY(make_kind(&n->kind[s], n, &nest->shape[s]));
        most = n->kind[s].wide_count > most ? n->kind[s].wide_count : most;
    }
    ISO_TRY(ISO_ALLOCATE(n->sum, 4 * (int64_t)most + 1));
    for (int32_t s = 0; s < nest->shapes; s++)
        ISO_TRY(find_inside(&n->kind[s], n, &nest->shape[s]));
    return ISO_OK;
}

static iso_status run(iso_point *by, int32_t *placed, int32_t *left, nester *n) {
    ISO_TRY(prepare(n));
    int32_t all = n->first[n->nest->shapes];
    *placed = -1;
    for (int i = 0; i < PLANS && *placed < all; i++) {
        int32_t count, stopped;
        ISO_TRY(follow(&count, &stopped, n, &plans[i]));
        if (count <= *placed)
            continue;
        *placed = count;
        *left = stopped;
        memcpy(n->best, n->by, (size_t)all * sizeof *n->by);
    }
    if (*placed < all)
        return ISO_OK;
    centre(n);
    memcpy(by, n->best, (size_t)all * sizeof *by);
    return ISO_OK;
}

iso_status nest_shapes(iso_point *by, int32_t *placed, int32_t *left, const iso_nest *nest,
                       iso_planar_scratch *scratch) {
    nester n = {.nest = nest, .scratch = scratch};
    iso_status status = run(by, placed, left, &n);
    for (int32_t s = 0; n.kind && s < nest->shapes; s++) {
        iso_release(n.kind[s].thin);
        iso_release(n.kind[s].wide);
        iso_region_free(&n.kind[s].inside);
    }
    iso_release(n.kind);
    iso_release(n.turn);
    iso_release(n.first);
    iso_release(n.by);
    iso_release(n.best);
    iso_release(n.sum);
    iso_region_free(&n.free);
    iso_region_free(&n.next);
    iso_region_free(&n.obstacles);
    return status;
}

#include "object/nest.h"

#include "base/sort.h"
#include "planar/hull.h"
#include "object/lattice.h"
#include "object/outline.h"
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
    SLACK = 6,     /* units that outlines may be too near, so that a place that just fits is one */
    THIN = 300,    /* units by which outlines may be thickened to have fewer corners */
    MARGINS = 500, /* units a round join may reach too far */
    COARSE = 1500, /* units by which outlines that aren't convex may be thickened */
    PIECES = 6     /* convex ones of an outline, beyond which its hull is taken */
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
    iso_pieces thin, wide;      /* the outline with fewer corners; the same grown by the distance */
    iso_pieces hull, wide_hull; /* the same of its hull */
    iso_point middle;           /* of its box */
    iso_region inside;          /* where it may stand on the bed */
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
    iso_region free, next, obstacles, pair;
} nester;

/* ---- outlines ---- */

/* One piece: the hull of the points. */
static iso_status one_piece(iso_pieces *piece, const iso_point *point, int32_t count) {
    iso_point *room;
    ISO_TRY(ISO_ALLOCATE(piece->first, 2));
    ISO_TRY(ISO_ALLOCATE(piece->point, (int64_t)count + 1));
    ISO_TRY(ISO_ALLOCATE(room, count));
    memcpy(room, point, (size_t)count * sizeof *point);
    count = hull_of(piece->point, room, count);
    piece->first[0] = 0;
    piece->first[1] = hull_thin(piece->point, count, THIN, room);
    piece->count = 1;
    iso_release(room);
    return ISO_OK;
}

/* The region grown by a distance, into n->next. */
static iso_status grow(nester *n, const iso_region *region, int32_t distance) {
    iso_offset_options options = iso_offset_defaults(distance);
    options.join = ISO_JOIN_ROUND;
    options.arc_tolerance = MARGINS;
    ISO_TRY(iso_offset(&n->next, region, &options, n->scratch));
    if (n->next.count == 0)
        return iso_fail(ISO_OUTSIDE, "an object is too thin to be arranged");
    return ISO_OK;
}

/* The hull grown by the distance. */
static iso_status widen_hull(kind *k, nester *n) {
    iso_region_clear(&n->obstacles);
    ISO_TRY(iso_region_add(&n->obstacles, k->hull.point, k->hull.first[1]));
    ISO_TRY(iso_region_clean(&n->free, &n->obstacles, ISO_FILL_NONZERO, n->scratch));
    ISO_TRY(grow(n, &n->free, n->nest->distance - SLACK));
    return one_piece(&k->wide_hull, n->next.point, n->next.first[1]);
}

/* Pieces of an outline that isn't convex, grown by a distance: first by what thinning may take. */
static iso_status cut_up(iso_pieces *pieces, nester *n, const iso_region *outline,
                         int32_t distance) {
    ISO_TRY(grow(n, outline, distance + COARSE));
    ISO_TRY(iso_region_simplify(&n->free, &n->next, COARSE, n->scratch));
    return outline_pieces(pieces, &n->free);
}

static iso_status make_kind(kind *k, nester *n, const iso_nest_shape *shape) {
    iso_box box = {shape->hull[0], shape->hull[0]};
    for (int32_t i = 1; i < shape->corners; i++)
        box_add(&box, shape->hull[i]);
    k->middle = (iso_point){box.min.x + (box.max.x - box.min.x) / 2,
                            box.min.y + (box.max.y - box.min.y) / 2};
    ISO_TRY(one_piece(&k->hull, shape->hull, shape->corners));
    ISO_TRY(widen_hull(k, n));
    if (!shape->outline)
        return ISO_OK;
    ISO_TRY(cut_up(&k->thin, n, shape->outline, 0));
    ISO_TRY(cut_up(&k->wide, n, shape->outline, n->nest->distance - SLACK));
    if (k->thin.count <= PIECES && k->wide.count <= PIECES)
        return ISO_OK;
    outline_pieces_free(&k->thin);
    outline_pieces_free(&k->wide);
    return ISO_OK;
}

static const iso_pieces *thin_of(const kind *k) {
    return k->thin.count > 0 ? &k->thin : &k->hull;
}

static const iso_pieces *wide_of(const kind *k) {
    return k->wide.count > 0 ? &k->wide : &k->wide_hull;
}

static int32_t most_corners(const iso_pieces *pieces) {
    int32_t most = 0;
    for (int32_t i = 0; i < pieces->count; i++) {
        int32_t corners = pieces->first[i + 1] - pieces->first[i];
        most = corners > most ? corners : most;
    }
    return most;
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

/* n->pair: where one of `next` may not stand because one of `placed` stands at (0, 0): the union of
 * what their pieces forbid each other. */
static iso_status find_pair(nester *n, const kind *placed, const kind *next) {
    const iso_pieces *a = wide_of(placed), *b = thin_of(next);
    iso_region *sums = &n->next;
    iso_region_clear(sums);
    for (int32_t i = 0; i < a->count; i++)
        for (int32_t j = 0; j < b->count; j++) {
            int32_t count =
                hull_difference(n->sum, a->point + a->first[i], a->first[i + 1] - a->first[i],
                                b->point + b->first[j], b->first[j + 1] - b->first[j]);
            ISO_TRY(iso_region_add(sums, n->sum, count));
        }
    return iso_region_clean(&n->pair, sums, ISO_FILL_NONZERO, n->scratch);
}

static iso_status add_obstacle(nester *n, iso_point at) {
    iso_region *all = &n->obstacles;
    for (int32_t c = 0; c < n->pair.count; c++) {
        int32_t from = n->pair.first[c], count = n->pair.first[c + 1] - from;
        ISO_TRY(iso_region_add(all, n->pair.point + from, count));
        for (int32_t i = all->first[all->count - 1]; i < all->first[all->count]; i++) {
            all->point[i].x += at.x;
            all->point[i].y += at.y;
        }
    }
    return ISO_OK;
}

static iso_status subtract(nester *n) {
    ISO_TRY(iso_boolean(&n->next, ISO_DIFFERENCE, &n->free, &n->obstacles, n->scratch));
    iso_region swap = n->free;
    n->free = n->next;
    n->next = swap;
    return ISO_OK;
}

/* Where the shape may stand among all that are placed already: those before it in turn, and `own`
 * copies of its own. Leaves the pair of two of its own. */
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
        ISO_TRY(find_pair(n, &n->kind[other], k));
        for (int32_t i = n->first[other]; i < n->first[other + 1]; i++)
            ISO_TRY(add_obstacle(n, n->by[i]));
    }
    ISO_TRY(find_pair(n, k, k));
    for (int32_t i = 0; i < own; i++)
        ISO_TRY(add_obstacle(n, n->by[n->first[n->turn[turn]] + i]));
    return subtract(n);
}

/* The largest shape in even rows, among nothing else. */
static iso_status place_rows(int32_t *placed, nester *n, iso_point target) {
    int32_t s = n->turn[0];
    const kind *k = &n->kind[s];
    iso_lattice_space space = {.apart = n->sum, .inside = &k->inside, .target = target};
    space.corners = hull_difference(n->sum, k->wide_hull.point, k->wide_hull.first[1],
                                    k->hull.point, k->hull.first[1]);
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
            ISO_TRY(add_obstacle(n, best.at));
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
        int32_t corners = most_corners(wide_of(&n->kind[s]));
        most = corners > most ? corners : most;
        corners = most_corners(thin_of(&n->kind[s]));
        most = corners > most ? corners : most;
        corners = most_corners(&n->kind[s].wide_hull);
        most = corners > most ? corners : most;
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
        outline_pieces_free(&n.kind[s].thin);
        outline_pieces_free(&n.kind[s].wide);
        outline_pieces_free(&n.kind[s].hull);
        outline_pieces_free(&n.kind[s].wide_hull);
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
    iso_region_free(&n.pair);
    return status;
}

#include "planar/snap.h"

#include "base/sort.h"
#include "planar/predicate.h"

void snap_room_free(iso_snap_room *room) {
    iso_release(room->split);
    iso_release(room->crossing);
    *room = (iso_snap_room){0};
}

typedef struct iso_snap {
    iso_edges *edges;
    iso_grid grid;
    iso_snap_room *room;
    int64_t collisions;
} iso_snap;

static void share_start(iso_snap *snap, int32_t slot) {
    snap->edges->flags[slot] |= EDGE_SHARED_START;
}

static void share_end(iso_snap *snap, int32_t slot) {
    share_start(snap, edges_next(snap->edges, slot));
}

/* The edge passes through `at`: a split, or at one of its ends a meeting. */
static iso_status bend_through(iso_snap *snap, int32_t slot, iso_point at) {
    if (point_equal(at, snap->edges->from[slot])) {
        share_start(snap, slot);
        return ISO_OK;
    }
    if (point_equal(at, snap->edges->to[slot])) {
        share_end(snap, slot);
        return ISO_OK;
    }
    iso_snap_room *room = snap->room;
    ISO_TRY(ISO_GROW(room->split, room->split_capacity, room->split_count + 1));
    room->split[room->split_count++] = (iso_split){slot, at};
    return ISO_OK;
}

/* Does edge e (a -> b) meet the hot pixel of c, an end of edge f? `orientation` is orient2d(a, b,
 * c). */
static inline bool end_meets(iso_point a, iso_point b, iso_point c, int64_t orientation) {
    return point_equal(c, a) || point_equal(c, b) || meets_pixel(a, b, c, orientation);
}

static iso_status keep_crossing(iso_snap *snap, int32_t e, int32_t f, iso_point at) {
    iso_snap_room *room = snap->room;
    ISO_TRY(ISO_GROW(room->crossing, room->crossing_capacity, room->crossing_count + 1));
    room->crossing[room->crossing_count++] = at;
    ISO_TRY(bend_through(snap, e, at));
    return bend_through(snap, f, at);
}

/* Both ends of the other edge, and so all of it, lie on one side of the line ab, out of reach of
 * the pixels of points on it. */
static inline bool clear_of_line(iso_point a, iso_point b, int64_t oc, int64_t od) {
    int64_t dx = (int64_t)b.x - a.x, dy = (int64_t)b.y - a.y;
    int64_t reach = (dx < 0 ? -dx : dx) + (dy < 0 ? -dy : dy);
    return (2 * oc > reach && 2 * od > reach) || (2 * oc < -reach && 2 * od < -reach);
}

static inline bool opposite_signs(int64_t a, int64_t b) {
    return (a > 0 && b < 0) || (a < 0 && b > 0);
}

/* Two edges that are no neighbours and whose boxes meet. */
static iso_status collide_strangers(iso_snap *snap, int32_t e, int32_t f) {
    const iso_edges *edges = snap->edges;
    iso_point a = edges->from[e], b = edges->to[e], c = edges->from[f], d = edges->to[f];
    int64_t oc = orient2d(a, b, c), od = orient2d(a, b, d);
    if (clear_of_line(a, b, oc, od))
        return ISO_OK;
    int64_t oa = orient2d(c, d, a), ob = orient2d(c, d, b);
    if (clear_of_line(c, d, oa, ob))
        return ISO_OK;
    bool meet_a = end_meets(c, d, a, oa), meet_b = end_meets(c, d, b, ob);
    bool meet_c = end_meets(a, b, c, oc), meet_d = end_meets(a, b, d, od);
    bool crossing = opposite_signs(oa, ob) && opposite_signs(oc, od);
    if (!(meet_a | meet_b | meet_c | meet_d | crossing))
        return ISO_OK;
    snap->collisions++;
    if (crossing)
        ISO_TRY(keep_crossing(snap, e, f, crossing_point(a, b, oa, ob)));
    if (meet_a) {
        share_start(snap, e);
        ISO_TRY(bend_through(snap, f, a));
    }
    if (meet_b) {
        share_end(snap, e);
        ISO_TRY(bend_through(snap, f, b));
    }
    if (meet_c) {
        share_start(snap, f);
        ISO_TRY(bend_through(snap, e, c));
    }
    if (meet_d) {
        share_end(snap, f);
        ISO_TRY(bend_through(snap, e, d));
    }
    return ISO_OK;
}

/* f follows e. They meet at b by nature; what matters is whether one folds back onto the other. A
 * turn of less than a right angle can't: a pixel of the far end d, at least a unit ahead of b,
 * stays clear of e. */
static iso_status collide_neighbours(iso_snap *snap, int32_t e, int32_t f) {
    const iso_edges *edges = snap->edges;
    iso_point a = edges->from[e], b = edges->to[e], d = edges->to[f];
    int64_t ahead =
        ((int64_t)b.x - a.x) * ((int64_t)d.x - b.x) + ((int64_t)b.y - a.y) * ((int64_t)d.y - b.y);
    if (ahead > 0)
        return ISO_OK;
    bool meet_d = end_meets(a, b, d, orient2d(a, b, d));
    bool meet_a = end_meets(b, d, a, orient2d(b, d, a));
    if (!meet_a && !meet_d)
        return ISO_OK;
    snap->collisions++;
    share_start(snap, f);
    if (meet_a) {
        share_start(snap, e);
        ISO_TRY(bend_through(snap, f, a));
    }
    if (meet_d) {
        share_end(snap, f);
        ISO_TRY(bend_through(snap, e, d));
    }
    return ISO_OK;
}

static iso_status collide(iso_snap *snap, int32_t e, int32_t f) {
    const iso_edges *edges = snap->edges;
    bool e_first = edges_next(edges, e) == f, f_first = edges_next(edges, f) == e;
    if (!e_first && !f_first)
        return collide_strangers(snap, e, f);
    if (e_first)
        ISO_TRY(collide_neighbours(snap, e, f));
    return f_first ? collide_neighbours(snap, f, e) : ISO_OK;
}

/* Try the edges of two runs whose boxes meet. */
static iso_status collide_runs(iso_snap *snap, const iso_run *a, const iso_run *b) {
    const iso_edges *edges = snap->edges;
    for (int32_t e = a->first; e < a->first + a->count; e++) {
        iso_box box = box_of(edges->from[e], edges->to[e]);
        if (edges->flags[e] & EDGE_DEAD || !boxes_meet(&box, &b->box))
            continue;
        for (int32_t f = b->first; f < b->first + b->count; f++) {
            iso_box other = box_of(edges->from[f], edges->to[f]);
            if (boxes_meet(&box, &other) && !(edges->flags[f] & EDGE_DEAD))
                ISO_TRY(collide(snap, e, f));
        }
    }
    return ISO_OK;
}

/* Neighbours within runs are tried here, once; all other pairs meet in some cell. */
static iso_status collide_inside_runs(iso_snap *snap, const iso_grid_layer *layer) {
    for (int32_t r = 0; r < layer->run_count; r++) {
        const iso_run *run = &layer->run[r];
        for (int32_t e = run->first; e + 1 < run->first + run->count; e++)
            ISO_TRY(collide_neighbours(snap, e, e + 1));
    }
    return ISO_OK;
}

/* A run in a cell. The box is the run's: most looks at a resident end there. */
typedef struct iso_resident {
    iso_box box;
    const iso_run *run;
    bool bent;
} iso_resident;

static bool resident_less(const iso_resident *a, const iso_resident *b) {
    return a->box.min.x != b->box.min.x ? a->box.min.x < b->box.min.x
                                        : a->run->first < b->run->first;
}
ISO_SORT(sort_residents, iso_resident, resident_less)

static int32_t fetch_residents(iso_resident *out, const iso_snap *snap, int32_t layer,
                               int32_t cell) {
    const iso_grid_layer *l = &snap->grid.layer[layer];
    int32_t n = 0;
    for (int32_t i = l->first[cell]; i < l->first[cell + 1]; i++) {
        const iso_run *run = &l->run[l->entry[i]];
        if (run->count == 1 && snap->edges->flags[run->first] & EDGE_DEAD)
            continue;
        out[n++] = (iso_resident){run->box, run, run_is_bent(&snap->grid, run)};
    }
    return n;
}

/* Runs that stand in all cells of their boxes are tried in one of those they share: that of the
 * least corner of what the boxes share. */
static inline bool is_tried_here(const iso_snap *snap, const iso_resident *a, const iso_resident *b,
                                 int32_t cell) {
    const iso_box *p = &a->box, *q = &b->box;
    if (!boxes_meet(p, q))
        return false;
    iso_point corner = {p->min.x > q->min.x ? p->min.x : q->min.x,
                        p->min.y > q->min.y ? p->min.y : q->min.y};
    return a->bent || b->bent || grid_cell(&snap->grid, corner) == cell;
}

static inline iso_status collide_residents(iso_snap *snap, const iso_resident *a,
                                           const iso_resident *b, int32_t cell) {
    return is_tried_here(snap, a, b, cell) ? collide_runs(snap, a->run, b->run) : ISO_OK;
}

enum { CROWD = 24 }; /* residents from which sorting pays */

static iso_status collide_within(iso_snap *snap, iso_resident *resident, int32_t count,
                                 int32_t cell) {
    bool sorted = count > CROWD;
    if (sorted)
        sort_residents(resident, count);
    for (int32_t i = 0; i < count; i++) {
        for (int32_t j = i + 1; j < count; j++) {
            if (sorted && resident[j].box.min.x > resident[i].box.max.x)
                break;
            ISO_TRY(collide_residents(snap, &resident[i], &resident[j], cell));
        }
    }
    return ISO_OK;
}

typedef struct iso_crowd {
    iso_resident *resident;
    int32_t count;
} iso_crowd;

/* The first of the residents, sorted, that starts at x or further right. */
static int32_t first_from(const iso_crowd *crowd, int64_t x) {
    int32_t low = 0, end = crowd->count;
    while (low < end) {
        int32_t middle = low + (end - low) / 2;
        if (crowd->resident[middle].box.min.x < x)
            low = middle + 1;
        else
            end = middle;
    }
    return low;
}

/* Each of a with those of b that start within it, `from` units behind its own start or later. */
static iso_status collide_starts(iso_snap *snap, const iso_crowd *a, const iso_crowd *b,
                                 int32_t cell, int from) {
    for (int32_t i = 0; i < a->count; i++) {
        const iso_resident *r = &a->resident[i];
        for (int32_t j = first_from(b, (int64_t)r->box.min.x + from);
             j < b->count && b->resident[j].box.min.x <= r->box.max.x; j++)
            ISO_TRY(collide_residents(snap, r, &b->resident[j], cell));
    }
    return ISO_OK;
}

/* Fresh runs with old ones. In a crowd, of two that share some x one starts within the other. */
static iso_status collide_between(iso_snap *snap, iso_crowd fresh, iso_crowd old, int32_t cell) {
    if ((int64_t)fresh.count * old.count <= CROWD * CROWD) {
        for (int32_t i = 0; i < fresh.count; i++)
            for (int32_t j = 0; j < old.count; j++)
                ISO_TRY(collide_residents(snap, &fresh.resident[i], &old.resident[j], cell));
        return ISO_OK;
    }
    sort_residents(fresh.resident, fresh.count);
    sort_residents(old.resident, old.count);
    ISO_TRY(collide_starts(snap, &fresh, &old, cell, 0));
    return collide_starts(snap, &old, &fresh, cell, 1);
}

static int32_t largest_cell(const iso_grid *grid) {
    int32_t largest = 0, cells = grid->columns * grid->rows;
    for (int32_t l = 0; l < grid->layer_count; l++) {
        const int32_t *first = grid->layer[l].first;
        for (int32_t c = 0; c < cells; c++)
            largest = first[c + 1] - first[c] > largest ? first[c + 1] - first[c] : largest;
    }
    return largest;
}

/* Collide the runs of the newest layer with each other and with all older ones. */
static iso_status find_collisions(iso_snap *snap, iso_arena *arena) {
    const iso_grid *grid = &snap->grid;
    int32_t newest = grid->layer_count - 1, cells = grid->columns * grid->rows;
    int32_t room = largest_cell(grid);
    iso_resident *fresh, *old;
    ISO_TRY(ISO_PUSH(fresh, arena, room));
    ISO_TRY(ISO_PUSH(old, arena, room));
    ISO_TRY(collide_inside_runs(snap, &grid->layer[newest]));
    const int32_t *first = grid->layer[newest].first;
    for (int32_t cell = 0; cell < cells; cell++) {
        if (first[cell] == first[cell + 1])
            continue;
        int32_t count = fetch_residents(fresh, snap, newest, cell);
        ISO_TRY(collide_within(snap, fresh, count, cell));
        for (int32_t l = 0; l < newest; l++) {
            iso_crowd before = {old, fetch_residents(old, snap, l, cell)};
            ISO_TRY(collide_between(snap, (iso_crowd){fresh, count}, before, cell));
        }
    }
    return ISO_OK;
}

static bool point_before(const iso_point *a, const iso_point *b) {
    return point_less(*a, *b);
}
ISO_SORT(sort_points, iso_point, point_before)

/* The edges of a run that pass the hot pixel. */
static iso_status heat_run(iso_snap *snap, const iso_run *run, iso_point at) {
    const iso_edges *edges = snap->edges;
    for (int32_t slot = run->first; slot < run->first + run->count; slot++) {
        iso_point a = edges->from[slot], b = edges->to[slot];
        if (!(edges->flags[slot] & EDGE_DEAD) && box_holds(a, b, at) &&
            end_meets(a, b, at, orient2d(a, b, at)))
            ISO_TRY(bend_through(snap, slot, at));
    }
    return ISO_OK;
}

/* A crossing is a hot pixel for every edge near it, not just for the two that cross. */
static iso_status heat_crossings(iso_snap *snap) {
    iso_snap_room *room = snap->room;
    const iso_grid *grid = &snap->grid;
    sort_points(room->crossing, room->crossing_count);
    for (int64_t i = 0; i < room->crossing_count; i++) {
        iso_point at = room->crossing[i];
        if (i > 0 && point_equal(at, room->crossing[i - 1]))
            continue;
        int32_t cell = grid_cell(grid, at);
        for (int32_t l = 0; l < grid->layer_count; l++) {
            const iso_grid_layer *layer = &grid->layer[l];
            for (int32_t k = layer->first[cell]; k < layer->first[cell + 1]; k++) {
                const iso_run *run = &layer->run[layer->entry[k]];
                if (box_has(&run->box, at))
                    ISO_TRY(heat_run(snap, run, at));
            }
        }
    }
    return ISO_OK;
}

static bool split_less(const iso_split *a, const iso_split *b) {
    return a->slot != b->slot ? a->slot < b->slot : point_less(a->at, b->at);
}
ISO_SORT(sort_splits, iso_split, split_less)

/* `split` holds the edge's new vertices, each possibly more than once, in its order or the reverse
 * of it. */
static iso_status split_edge(iso_edges *edges, const iso_split *split, int64_t count) {
    int32_t slot = split[0].slot;
    iso_point from = edges->from[slot], to = edges->to[slot];
    uint8_t operand = edges->flags[slot] & EDGE_OPERAND;
    uint8_t start_flags = edges->flags[slot];
    bool forward = from.x != to.x ? from.x < to.x : from.y < to.y;
    int32_t first = edges->count;
    for (int64_t i = 0; i <= count; i++) {
        iso_point at = to;
        if (i < count) {
            at = split[forward ? i : count - 1 - i].at;
            if (point_equal(at, from))
                continue; /* found more than once */
        }
        ISO_TRY(edges_push(edges, from, at, i == 0 ? start_flags : operand | EDGE_SHARED_START));
        edges->successor[edges->count - 1] = edges->count;
        from = at;
    }
    edges->successor[edges->count - 1] = edges->successor[slot];
    edges->successor[slot] = first;
    edges->flags[slot] |= EDGE_DEAD;
    return ISO_OK;
}

/* The pixels an edge meets lie along it in a staircase, so lexicographic order is the edge's own or
 * its reverse if it rises; if it falls, the steps within one x run the other way. */
static void order_falling(iso_split *split, int64_t count) {
    for (int64_t i = 0, end; i < count; i = end) {
        for (end = i + 1; end < count && split[end].at.x == split[i].at.x;)
            end++;
        for (int64_t l = i, r = end - 1; l < r; l++, r--) {
            iso_split t = split[l];
            split[l] = split[r];
            split[r] = t;
        }
    }
}

static iso_status apply_splits(iso_snap *snap) {
    iso_snap_room *room = snap->room;
    iso_edges *edges = snap->edges;
    sort_splits(room->split, room->split_count);
    for (int64_t i = 0, end; i < room->split_count; i = end) {
        int32_t slot = room->split[i].slot;
        for (end = i + 1; end < room->split_count && room->split[end].slot == slot;)
            end++;
        iso_point a = edges->from[slot], b = edges->to[slot];
        if ((a.x < b.x && a.y > b.y) || (a.x > b.x && a.y < b.y))
            order_falling(room->split + i, end - i);
        ISO_TRY(split_edge(edges, room->split + i, end - i));
    }
    return ISO_OK;
}

iso_status snap_round(iso_edges *edges, int64_t *collisions, iso_snap_room *room,
                      iso_arena *arena) {
    *collisions = 0;
    if (edges->count == 0)
        return ISO_OK;
    iso_snap snap = {.edges = edges, .room = room};
    ISO_TRY(grid_build(&snap.grid, edges, arena));
    for (;;) {
        room->split_count = room->crossing_count = 0;
        ISO_TRY(find_collisions(&snap, arena));
        ISO_TRY(heat_crossings(&snap));
        if (room->split_count == 0)
            break;
        int32_t fresh = edges->count;
        ISO_TRY(apply_splits(&snap));
        ISO_TRY(grid_add_layer(&snap.grid, edges, fresh, arena));
    }
    *collisions = snap.collisions;
    return ISO_OK;
}

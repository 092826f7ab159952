#include "path/tour.h"

#include <math.h>

#include "path/edges.h"
#include "path/nearest.h"

enum {
    FEW = 8,        /* are looked through one by one; a grid would cost more to fill */
    NEIGHBOURS = 7, /* ends looked at from each end */
    LONGEST = 3     /* stops that an Or-opt move takes along */
};

double iso_travel_seconds(const iso_travel_cost *cost, iso_point a, iso_point b) {
    double d = sqrt((double)iso_distance_squared(a, b));
    double ramps = cost->speed * cost->speed / cost->acceleration;
    double time = d < ramps ? 2 * sqrt(d / cost->acceleration)
                            : d / cost->speed + cost->speed / cost->acceleration;
    return d > cost->retract_before ? time + cost->retraction : time;
}

static iso_point entry_of(const iso_stop *stop, int32_t visit) {
    return visit & 1 ? stop[visit >> 1].b : stop[visit >> 1].a;
}

static iso_point exit_of(const iso_stop *stop, int32_t visit) {
    return visit & 1 ? stop[visit >> 1].a : stop[visit >> 1].b;
}

/* From there to the nearest of the places where the tour would like to end. */
static double seconds_to_end(const iso_tour_frame *frame, const iso_travel_cost *cost,
                             iso_point from) {
    int64_t closest = INT64_MAX;
    int32_t best = 0;
    for (int32_t i = 0; i < frame->ends; i++) {
        int64_t d = iso_distance_squared(from, frame->end[i]);
        if (d < closest) {
            closest = d;
            best = i;
        }
    }
    return frame->ends > 0 ? iso_travel_seconds(cost, from, frame->end[best]) : 0;
}

double iso_tour_seconds(const int32_t *tour, const iso_stop *stop, int32_t count,
                        const iso_tour_frame *frame, const iso_travel_cost *cost) {
    iso_point from = frame->from;
    double sum = 0;
    for (int32_t k = 0; k < count; k++) {
        sum += iso_travel_seconds(cost, from, entry_of(stop, tour[k]));
        from = exit_of(stop, tour[k]);
    }
    return sum + seconds_to_end(frame, cost, from);
}

static void visit_few(int32_t *tour, const iso_stop *stop, int32_t count, iso_point from) {
    unsigned done = 0;
    for (int32_t k = 0; k < count; k++) {
        int64_t closest = INT64_MAX;
        for (int32_t v = 0; v < 2 * count; v++) {
            int64_t d = iso_distance_squared(from, entry_of(stop, v));
            if (!(done >> (v >> 1) & 1) && d < closest) {
                closest = d;
                tour[k] = v;
            }
        }
        done |= 1u << (tour[k] >> 1);
        from = exit_of(stop, tour[k]);
    }
}

iso_status iso_tour_nearest(int32_t *tour, const iso_stop *stop, int32_t count, iso_point from,
                            iso_arena *scratch) {
    if (count <= FEW) {
        visit_few(tour, stop, count, from);
        return ISO_OK;
    }
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    iso_candidate *candidate;
    iso_nearest nearest;
    ISO_TRY(ISO_PUSH(candidate, scratch, 2 * (int64_t)count));
    for (int32_t v = 0; v < 2 * count; v++)
        candidate[v] = (iso_candidate){entry_of(stop, v), v >> 1, v};
    ISO_TRY(iso_nearest_build(&nearest, candidate, 2 * count, count, scratch));
    for (int32_t k = 0; k < count; k++) {
        tour[k] = iso_nearest_find(&nearest, from)->name;
        iso_nearest_take(&nearest, tour[k] >> 1);
        from = exit_of(stop, tour[k]);
    }
    iso_arena_pop(scratch, mark);
    return ISO_OK;
}

/* ---- neighbours ---- */

typedef struct improving {
    const iso_stop *stop;
    const iso_travel_cost *cost;
    const iso_tour_frame *frame;
    int32_t count;
    int32_t *tour, *place; /* place[stop]: where in the tour it is */
    int32_t *neighbour;    /* [2 count][NEIGHBOURS] ends by name, the nearest first; -1: no more */
    int64_t steps;
} improving;

static iso_point end_at(const improving *t, int32_t name) {
    return entry_of(t->stop, name);
}

typedef struct near_end {
    int64_t distance;
    int32_t name;
} near_end;

/* Into the list of the nearest so far. */
static void note(near_end *list, int32_t *have, near_end e) {
    if (*have == NEIGHBOURS && list[NEIGHBOURS - 1].distance <= e.distance)
        return;
    int32_t i = *have < NEIGHBOURS ? (*have)++ : NEIGHBOURS - 1;
    for (; i > 0 && list[i - 1].distance > e.distance; i--)
        list[i] = list[i - 1];
    list[i] = e;
}

typedef struct end_grid {
    int32_t *first, *in;
    int32_t columns, rows, size;
    iso_point origin;
} end_grid;

static int32_t cell_of(const end_grid *g, iso_point p) {
    int32_t column = (int32_t)(((int64_t)p.x - g->origin.x) / g->size);
    int32_t row = (int32_t)(((int64_t)p.y - g->origin.y) / g->size);
    return row * g->columns + column;
}

static iso_status fill_grid(end_grid *g, const improving *t, iso_arena *scratch) {
    iso_point low = end_at(t, 0), high = low;
    int32_t ends = 2 * t->count;
    for (int32_t v = 1; v < ends; v++) {
        iso_point p = end_at(t, v);
        low.x = p.x < low.x ? p.x : low.x;
        low.y = p.y < low.y ? p.y : low.y;
        high.x = p.x > high.x ? p.x : high.x;
        high.y = p.y > high.y ? p.y : high.y;
    }
    int64_t width = (int64_t)high.x - low.x + 1, height = (int64_t)high.y - low.y + 1;
    int64_t wanted = ends / 3 + 1;
    int64_t size = (int64_t)sqrt((double)width * (double)height / (double)wanted) + 1;
    int64_t longest = (width > height ? width : height) / wanted + 1;
    size = size < longest ? longest : size;
    *g = (end_grid){.size = (int32_t)size, .origin = low};
    g->columns = (int32_t)(width / size + 1);
    g->rows = (int32_t)(height / size + 1);
    int32_t cells = g->columns * g->rows;
    ISO_TRY(ISO_PUSH(g->first, scratch, (int64_t)cells + 2));
    ISO_TRY(ISO_PUSH(g->in, scratch, ends));
    memset(g->first, 0, ((size_t)cells + 2) * sizeof *g->first);
    for (int32_t v = 0; v < ends; v++)
        g->first[cell_of(g, end_at(t, v)) + 2]++;
    for (int32_t c = 0; c < cells; c++)
        g->first[c + 2] += g->first[c + 1];
    for (int32_t v = 0; v < ends; v++)
        g->in[g->first[cell_of(g, end_at(t, v)) + 1]++] = v;
    return ISO_OK;
}

/* Of the nine cells around, at most a few dozen ends: crowds are neighbours enough. */
enum { MOST_LOOKED_AT = 96 };

static void look_around(improving *t, const end_grid *g, int32_t name) {
    near_end list[NEIGHBOURS];
    iso_point p = end_at(t, name);
    int32_t have = 0, looked = 0, cell = cell_of(g, p);
    int32_t column = cell % g->columns, row = cell / g->columns;
    int32_t left = column > 0 ? column - 1 : 0;
    int32_t right = column + 1 < g->columns ? column + 1 : column;
    for (int32_t r = row > 0 ? row - 1 : 0; r <= row + 1 && r < g->rows; r++)
        for (int32_t k = g->first[r * g->columns + left];
             k < g->first[r * g->columns + right + 1] && looked < MOST_LOOKED_AT; k++, looked++) {
            int32_t other = g->in[k];
            if (other >> 1 != name >> 1)
                note(list, &have, (near_end){iso_distance_squared(p, end_at(t, other)), other});
        }
    for (int32_t i = 0; i < NEIGHBOURS; i++)
        t->neighbour[(int64_t)name * NEIGHBOURS + i] = i < have ? list[i].name : -1;
}

static iso_status find_neighbours(improving *t, iso_arena *scratch) {
    end_grid grid;
    ISO_TRY(ISO_PUSH(t->neighbour, scratch, 2 * (int64_t)t->count * NEIGHBOURS));
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    ISO_TRY(fill_grid(&grid, t, scratch));
    for (int32_t v = 0; v < 2 * t->count; v++)
        look_around(t, &grid, v);
    iso_arena_pop(scratch, mark);
    return ISO_OK;
}

/* ---- moves ---- */

static double cost_between(const improving *t, iso_point a, iso_point b) {
    return iso_travel_seconds(t->cost, a, b);
}

/* Where the nozzle comes from before place i. */
static iso_point left_at(const improving *t, int32_t i) {
    return i == 0 ? t->frame->from : exit_of(t->stop, t->tour[i - 1]);
}

static iso_point entered_at(const improving *t, int32_t i) {
    return entry_of(t->stop, t->tour[i]);
}

/* From p to place i; behind the last one to where the tour would like to end. */
static double cost_from(const improving *t, iso_point p, int32_t i) {
    return i == t->count ? seconds_to_end(t->frame, t->cost, p)
                         : cost_between(t, p, entered_at(t, i));
}

static double cost_to(const improving *t, int32_t i) {
    return cost_from(t, left_at(t, i), i);
}

static void reverse(improving *t, int32_t i, int32_t j) {
    t->steps -= j - i + 1;
    for (; i < j; i++, j--) {
        int32_t visit = t->tour[i] ^ 1;
        t->tour[i] = t->tour[j] ^ 1;
        t->tour[j] = visit;
        t->place[t->tour[i] >> 1] = i;
        t->place[t->tour[j] >> 1] = j;
    }
    if (i == j)
        t->tour[i] ^= 1;
}

/* Gains below are rounding. */
#define LEAST_GAIN 1e-9

/* Visit places i .. j the other way round. */
static int try_reversal(improving *t, int32_t i, int32_t j) {
    if (i > j)
        return 0;
    double before = cost_to(t, i) + cost_to(t, j + 1);
    double after = cost_between(t, left_at(t, i), exit_of(t->stop, t->tour[j])) +
                   cost_from(t, entered_at(t, i), j + 1);
    if (after >= before - LEAST_GAIN)
        return 0;
    reverse(t, i, j);
    return 1;
}

/* Take places i .. j out and put them in before place k (k < i or k > j + 1), the other way round
 * if so asked. */
static int try_move(improving *t, int32_t i, int32_t j, int32_t k, int flip) {
    if (i < 0 || j >= t->count || (k >= i && k <= j + 1))
        return 0;
    iso_point in = entered_at(t, i), out = exit_of(t->stop, t->tour[j]);
    double before = cost_to(t, i) + cost_to(t, j + 1) + cost_to(t, k);
    double after =
        cost_between(t, left_at(t, k), flip ? out : in) + cost_from(t, flip ? in : out, k);
    if (k != j + 1)
        after += cost_from(t, left_at(t, i), j + 1);
    if (after >= before - LEAST_GAIN)
        return 0;
    int32_t n = j - i + 1;
    if (flip)
        reverse(t, i, j);
    /* a rotation is three reversals, each of which turns its stops, too */
    if (k < i) {
        reverse(t, k, i - 1);
        reverse(t, i, j);
        reverse(t, k, j);
    } else {
        reverse(t, i, j);
        reverse(t, j + 1, k - 1);
        reverse(t, i, k - 1);
    }
    t->steps -= n;
    return 1;
}

/* The travel from place i - 1 to place i, looked at from either end. */
static int improve_at(improving *t, int32_t i) {
    double now = cost_to(t, i);
    for (int side = 0; side < 2; side++) {
        if (side == 0 && i == 0)
            continue; /* where all begins has no list of neighbours */
        int32_t name = side ? t->tour[i] : t->tour[i - 1] ^ 1;
        for (int32_t n = 0; n < NEIGHBOURS; n++) {
            int32_t other = t->neighbour[(int64_t)name * NEIGHBOURS + n];
            if (other < 0 || cost_between(t, end_at(t, name), end_at(t, other)) >= now - LEAST_GAIN)
                break;
            int32_t j = t->place[other >> 1];
            int entry = t->tour[j] == other;
            t->steps--;
            if (side == 0 && !entry &&
                (j >= i ? try_reversal(t, i, j) : try_reversal(t, j + 1, i - 1)))
                return 1;
            if (side == 1 && entry &&
                (j > i ? try_reversal(t, i, j - 1) : try_reversal(t, j, i - 1)))
                return 1;
            for (int32_t length = 1; length <= LONGEST; length++) {
                /* forth the run begins with that end on side 0, and ends with it on side 1 */
                int forth = side == 0 ? entry : !entry;
                int32_t first = (side == 0) == forth ? j : j - length + 1;
                if (try_move(t, first, first + length - 1, i, !forth))
                    return 1;
            }
        }
    }
    return 0;
}

/* Moves that no list of neighbours leads to: another stop last, or the last ones turned. */
static int improve_end(improving *t) {
    int found = 0;
    for (int32_t i = t->count; i-- > 0 && t->steps > 0 && t->frame->ends > 0;) {
        t->steps--;
        found |= try_reversal(t, i, t->count - 1) || try_move(t, i, i, t->count, 0) ||
                 try_move(t, i, i, t->count, 1);
    }
    return found | try_reversal(t, t->count - 1, t->count - 1);
}

iso_status iso_tour_improve(int32_t *tour, const iso_stop *stop, int32_t count,
                            const iso_tour_frame *frame, const iso_travel_cost *cost,
                            iso_arena *scratch) {
    improving t = {.stop = stop, .cost = cost, .frame = frame, .count = count, .tour = tour};
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    if (count < 2) {
        if (count == 1)
            try_reversal(&t, 0, 0);
        return ISO_OK;
    }
    t.steps = 100 * (int64_t)count + 10000;
    ISO_TRY(ISO_PUSH(t.place, scratch, count));
    ISO_TRY(find_neighbours(&t, scratch));
    for (int32_t i = 0; i < count; i++)
        t.place[tour[i] >> 1] = i;
    for (int found = 1; found && t.steps > 0;) {
        found = improve_end(&t);
        for (int32_t i = 0; i < count && t.steps > 0; i++)
            while (t.steps > 0 && improve_at(&t, i))
                found = 1;
    }
    iso_arena_pop(scratch, mark);
    return ISO_OK;
}

#include "chart/spread.h"

#include <math.h>

#include "base/vector.h"

enum { DOUBLINGS_MOST = 10, HALVINGS = 24 };

static const double pi = 3.14159265358979323846;

/* ---- the plan ---- */

/* mm of thickness for each mm of F at places of the part: the extremes, and where they are. */
typedef struct extremes {
    double least, most;
    iso_vec3 at_least;
} extremes;

static void find_extremes(extremes *e, const iso_field *field, const iso_vec3 *at, int64_t count) {
    *e = (extremes){HUGE_VAL, 0, {0, 0, 0}};
    for (int64_t i = 0; i < count; i++) {
        double value, thickness;
        iso_vec3 gradient;
        iso_field_evaluate(&value, &gradient, field, &at[i], 1);
        thickness = 1 / vec3_length(gradient);
        if (!(thickness < HUGE_VAL)) /* a field's center: layers have none there */
            continue;
        e->most = fmax(e->most, thickness);
        if (thickness < e->least) {
            e->least = thickness;
            e->at_least = at[i];
        }
    }
}

static void plan_even(spread *plan, const spread_options *o) {
    double steps = floor((o->high - o->low) / o->height + 0.5);
    plan->count = steps < 1 ? 1 : steps < 1e9 ? (int32_t)steps : (int32_t)1e9;
    plan->step = (o->high - o->low) / plan->count;
}

iso_status spread_plan(spread *plan, const chart *map, const iso_vec3 *at, int64_t count,
                       const spread_options *o) {
    extremes e;
    *plan = (spread){.chart = map, .low = o->low};
    find_extremes(&e, chart_field(map), at, count);
    plan_even(plan, o);
    plan->thickest = o->most;
    if (!(e.most > 0) ||
        (e.least * plan->step >= o->least && (o->most == 0 || e.most * plan->step <= o->most)))
        return ISO_OK;
    /* beads of half to all of that: around `height` if the limits allow it */
    plan->thickest = fmax(1.5 * o->height, 2 * o->least);
    if (o->most > 0)
        plan->thickest = fmin(plan->thickest, o->most);
    double step = plan->thickest / e.most;
    while (plan->doublings < DOUBLINGS_MOST &&
           2 * e.least * step * (1 << plan->doublings) < plan->thickest)
        plan->doublings++;
    int32_t block = 1 << plan->doublings;
    double blocks = ceil((o->high - o->low) / (step * block) - 1e-9);
    if (plan->thickest < 2 * o->least || 2 * e.least * step * block < plan->thickest ||
        !(blocks * block < 1e6))
        return iso_fail(ISO_OUTSIDE,
                        "layers are %.1f times as thick in some places as at x %.3f y %.3f z %.3f "
                        "mm (from the middle of the object and its foot): with thicknesses of "
                        "%.3f to %.3f mm there are none that fit together; the larger should be "
                        "twice the smaller at least",
                        e.most / e.least, e.at_least.x, e.at_least.y, e.at_least.z, o->least,
                        o->most);
    plan->count = (int32_t)fmax(blocks, 1) * block;
    plan->step = (o->high - o->low) / plan->count;
    return ISO_OK;
}

int32_t spread_most(const spread *plan, int32_t top) {
    int32_t k = 0;
    while (k < plan->doublings && top % (2 << k) == 0)
        k++;
    return k;
}

int32_t spread_source(int32_t top, int32_t k) {
    return k == 0 ? top : top - (1 << (k - 1));
}

/* ---- where ---- */

/* Of blocks of 2^k steps that end with step `top`: which are no thicker than allowed? */
static iso_status find_thin(bool *thin, const spread *plan, const int32_t block[2],
                            const iso_vec2 *flat, int64_t count, iso_arena *scratch) {
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    double layer[2] = {plan->low + block[0] * plan->step, (1 << block[1]) * plan->step};
    chart_point *point;
    ISO_TRY(ISO_PUSH(point, scratch, count));
    iso_status status = chart_layer(point, plan->chart, flat, layer, count);
    for (int64_t i = 0; status == ISO_OK && i < count; i++)
        thin[i] = point[i].thickness * layer[1] <= plan->thickest;
    iso_arena_pop(scratch, mark);
    return status;
}

iso_status spread_holds(bool *whole, const spread *plan, const int32_t block[2],
                        const iso_vec2 *flat, int64_t count, iso_arena *scratch) {
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    int32_t k = block[1], twice = 2 << k;
    int32_t parent[2] = {(block[0] + twice - 1) / twice * twice, k + 1};
    bool *thin;
    ISO_TRY(ISO_PUSH(thin, scratch, count));
    for (int64_t i = 0; i < count; i++) {
        whole[i] = true;
        thin[i] = false;
    }
    iso_status status = ISO_OK;
    if (k > 0) /* single steps can't be split */
        status = find_thin(whole, plan, block, flat, count, scratch);
    if (status == ISO_OK && k < plan->doublings)
        status = find_thin(thin, plan, parent, flat, count, scratch);
    for (int64_t i = 0; status == ISO_OK && i < count; i++)
        whole[i] = whole[i] && !thin[i];
    iso_arena_pop(scratch, mark);
    return status;
}

/* ---- paths ---- */

/* Along a path: its vertices, and places between them where beads are long. */
typedef struct station {
    int32_t vertex; /* the bead's */
    double share;   /* of the bead that lies before */
} station;

typedef struct cutter {
    const spread *plan;
    const iso_paths *paths;
    const int32_t *block;
    iso_paths *out;
    iso_arena *scratch;
    station *station;
    iso_vec2 *flat;
    bool *whole;
} cutter;

/* mm: the border isn't looked for between places closer than this. */
static const double look_every = 1;

static iso_point between(iso_point a, iso_point b, double t) {
    return (iso_point){iso_units(iso_mm(a.x) + t * iso_mm(b.x - a.x)),
                       iso_units(iso_mm(a.y) + t * iso_mm(b.y - a.y))};
}

static int32_t next_vertex(const iso_path *path, int32_t i) {
    return i + 1 < path->first + path->count ? i + 1 : path->first;
}

static int64_t stations_of(const iso_vec2 *a, const iso_vec2 *b) {
    double x = b->x - a->x, y = b->y - a->y;
    return 1 + (int64_t)(sqrt(x * x + y * y) / look_every);
}

static iso_vec2 to_mm(iso_point p) {
    return (iso_vec2){iso_mm(p.x), iso_mm(p.y)};
}

/* Of all paths; with `c->station` NULL they are counted only. */
static int64_t lay_stations(const cutter *c) {
    int64_t n = 0;
    for (int32_t p = 0; p < c->paths->count; p++) {
        const iso_path *path = &c->paths->path[p];
        for (int32_t i = 0; i < path->count; i++) {
            int32_t v = path->first + i;
            bool ends = i + 1 == path->count && !path->closed;
            iso_vec2 a = to_mm(c->paths->vertex[v].at);
            iso_vec2 b = to_mm(c->paths->vertex[ends ? v : next_vertex(path, v)].at);
            int64_t count = stations_of(&a, &b);
            for (int64_t k = 0; c->station && k < count; k++) {
                double t = (double)k / (double)count;
                c->station[n + k] = (station){v, t};
                c->flat[n + k] = (iso_vec2){a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
            }
            n += count;
        }
    }
    return n;
}

/* As thick as all steps of the block. */
static void thicken(iso_path_vertex *vertex, int32_t doublings) {
    double steps = 1 << doublings, area = vertex->area * steps;
    double height = iso_bead_height(vertex->width, vertex->area) * steps;
    if (doublings == 0 || !(height > 0))
        return;
    vertex->area = area < INT32_MAX ? (int32_t)area : INT32_MAX;
    vertex->width = (int32_t)(area / height + (1 - pi / 4) * height + 0.5);
}

static iso_status put(cutter *c, int32_t bead, iso_point at) {
    iso_paths *out = c->out;
    ISO_TRY(ISO_GROW(out->vertex, out->vertex_capacity, (int64_t)out->vertex_count + 1));
    iso_path_vertex *vertex = &out->vertex[out->vertex_count++];
    *vertex = c->paths->vertex[bead];
    vertex->at = at;
    thicken(vertex, c->block[1]);
    out->path[out->count - 1].count++;
    return ISO_OK;
}

static iso_status begin(cutter *c, const iso_path *like) {
    ISO_TRY(iso_paths_add(c->out, like, NULL, 0, 0, 0));
    iso_path *path = &c->out->path[c->out->count - 1];
    path->closed = path->follows = 0;
    return ISO_OK;
}

/* Where between two stations of a bead the block begins or ends to be whole. `to` is the share
 * where the second one lies. */
static iso_status find_border(double *share, const cutter *c, const station *from, double to,
                              iso_point end) {
    iso_vec2 a = to_mm(c->paths->vertex[from->vertex].at), b = to_mm(end);
    bool first, middle;
    double low = from->share, high = to;
    iso_vec2 at = {a.x + low * (b.x - a.x), a.y + low * (b.y - a.y)};
    ISO_TRY(spread_holds(&first, c->plan, c->block, &at, 1, c->scratch));
    for (int i = 0; i < HALVINGS; i++) {
        *share = 0.5 * (low + high);
        at = (iso_vec2){a.x + *share * (b.x - a.x), a.y + *share * (b.y - a.y)};
        ISO_TRY(spread_holds(&middle, c->plan, c->block, &at, 1, c->scratch));
        if (middle == first)
            low = *share;
        else
            high = *share;
    }
    return ISO_OK;
}

/* From station `i` to `j`, the next one on the path. */
static iso_status cut_between(cutter *c, const iso_path *path, int64_t i, int64_t j) {
    const station *from = &c->station[i], *to = &c->station[j];
    int32_t next = next_vertex(path, from->vertex);
    iso_point start = c->paths->vertex[from->vertex].at, end = c->paths->vertex[next].at;
    if (c->whole[i] != c->whole[j]) {
        double share;
        ISO_TRY(find_border(&share, c, from, to->vertex == from->vertex ? to->share : 1, end));
        if (c->whole[j])
            ISO_TRY(begin(c, path));
        ISO_TRY(put(c, from->vertex, between(start, end, share)));
    }
    if (c->whole[j] && to->share == 0)
        return put(c, to->vertex, c->paths->vertex[to->vertex].at);
    return ISO_OK;
}

static iso_status keep(cutter *c, const iso_path *path) {
    ISO_TRY(begin(c, path));
    for (int32_t i = 0; i < path->count; i++)
        ISO_TRY(put(c, path->first + i, c->paths->vertex[path->first + i].at));
    c->out->path[c->out->count - 1].closed = path->closed;
    return ISO_OK;
}

/* A path with stations from `first` to `end`. */
static iso_status cut_path(cutter *c, const iso_path *path, int64_t first, int64_t end) {
    int64_t count = end - first, held = 0, start = 0;
    for (int64_t i = first; i < end; i++)
        held += c->whole[i];
    if (held == 0)
        return ISO_OK;
    if (held == count)
        return keep(c, path);
    while (path->closed && c->whole[first + start])
        start++;
    if (c->whole[first + start]) {
        ISO_TRY(begin(c, path));
        ISO_TRY(put(c, path->first, c->paths->vertex[path->first].at));
    }
    for (int64_t k = 0; k < count - !path->closed; k++)
        ISO_TRY(cut_between(c, path, first + (start + k) % count, first + (start + k + 1) % count));
    return ISO_OK;
}

static iso_status cut_all(cutter *c) {
    int64_t count = lay_stations(c), end = 0;
    ISO_TRY(ISO_PUSH(c->flat, c->scratch, count));
    ISO_TRY(ISO_PUSH(c->whole, c->scratch, count));
    ISO_TRY(ISO_PUSH(c->station, c->scratch, count));
    lay_stations(c);
    ISO_TRY(spread_holds(c->whole, c->plan, c->block, c->flat, count, c->scratch));
    for (int32_t p = 0; p < c->paths->count; p++) {
        const iso_path *path = &c->paths->path[p];
        int64_t first = end;
        while (end < count && c->station[end].vertex >= path->first &&
               c->station[end].vertex < path->first + path->count)
            end++;
        ISO_TRY(cut_path(c, path, first, end));
    }
    return ISO_OK;
}

iso_status spread_paths(iso_paths *out, const iso_paths *paths, const spread *plan,
                        const int32_t block[2], iso_arena *scratch) {
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    cutter c = {.plan = plan, .paths = paths, .block = block, .out = out, .scratch = scratch};
    iso_paths_clear(out);
    iso_status status = cut_all(&c);
    iso_arena_pop(scratch, mark);
    if (status != ISO_OK)
        iso_paths_clear(out);
    return status;
}

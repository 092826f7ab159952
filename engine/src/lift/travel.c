/* Travels along a layer, a clearance above it. */
#include <math.h>

#include "base/vector.h"
#include "lift/sample.h"
#include "lift/task.h"

/* Nobody sees how exactly a travel follows the layer: its pieces may be off it by this share of
 * what it stays above it. */
static const double coarse = 0.25;
/* And turn by so much more. */
static const double wide_turn = 2;
/* The layer is off a chord by as much as the normals at its ends tell if it bends evenly, by twice
 * that if it has a crease halfway. */
static const double doubt = 2;

/* A short way needs no large rise: this share of its length, and at least so many mm. */
static const double steep = 0.25, least_rise = 0.05;

/* A travel that is to be sampled: from where the nozzle is to the first vertex of a path. */
typedef struct way {
    int32_t path;
    iso_point from;
} way;

typedef struct travels {
    lift_task *task;
    iso_paths *out;
    sample_limits limits;
    const way *ways;
} travels;

static iso_vec2 to_mm(iso_point p) {
    return (iso_vec2){iso_mm(p.x), iso_mm(p.y)};
}

static iso_status grow(iso_paths *out, int64_t more) {
    int64_t count = out->travel_count + more;
    if (count > INT32_MAX - 1)
        return iso_fail(ISO_OUTSIDE, "a layer with more than 2^31 turns of travels is too much");
    ISO_TRY(ISO_GROW(out->travel, out->travel_capacity, count));
    return ISO_GROW(out->travel_frame, out->travel_frame_capacity, count);
}

static void put(iso_paths *out, const lift_task *t, iso_vec3 at, const chart_point *on) {
    out->travel[out->travel_count] = (iso_point){iso_units(at.x), iso_units(at.y)};
    out->travel_frame[out->travel_count++] =
        (iso_frame){.normal = on->normal,
                    .height = iso_units(t->options->thickness * on->thickness),
                    .z = iso_units(at.z - t->options->z)};
}

iso_vec3 lift_above(const lift_task *task, const chart_point *on, double height) {
    iso_vec3 at = on->at;
    if (chart_kind_of(task->chart) != CHART_GRAPH)
        return vec3_along(at, height, on->normal);
    at.z += height / on->normal.z;
    return at;
}

/* Outside the part a layer may lie lower than the bed; the nozzle may not. */
static iso_vec3 above(const lift_task *t, const chart_point *on, double height) {
    iso_vec3 at = lift_above(t, on, height);
    if (chart_kind_of(t->chart) == CHART_GRAPH)
        at.z = fmax(at.z, height);
    return at;
}

/* By how much the layer may stand above the chords at a sample. A wave does so whatever its sign.
 */
static double bump_at(const samples *s, int64_t i, int64_t begin) {
    double before = i > begin ? fabs(chart_rise(&s->point[i - 1], &s->point[i])) : 0;
    double after = !sample_is_last(s, i) ? fabs(chart_rise(&s->point[i], &s->point[i + 1])) : 0;
    return doubt * fmax(before, after);
}

/* ---- near ways ---- */

/* The flat tip of a nozzle that doesn't tilt would scrape along a slope: it is so much lower than
 * the layer uphill. */
static const double level = 0.01;

/* As without layers that bend: straight from bead to bead. `from` and `to` are samples. */
static bool is_near(const lift_task *t, int64_t from, int64_t to) {
    const chart_point *a = &t->samples.point[from], *b = &t->samples.point[to];
    double most = t->options->near;
    iso_vec3 chord = vec3_minus(b->at, a->at);
    if (chart_kind_of(t->chart) == CHART_GRAPH &&
        !(fmin(a->normal.z, b->normal.z) > 1 - 0.5 * level * level))
        return false;
    return vec3_dot(chord, chord) <= most * most &&
           fabs(chart_rise(a, b)) <= 0.5 * t->options->tolerance &&
           vec3_dot(a->normal, b->normal) > 0.5;
}

static iso_status put_near(iso_paths *out, const lift_task *t, iso_path *path, int64_t to) {
    ISO_TRY(grow(out, 1));
    path->travel_first = out->travel_count;
    path->travel_count = 1;
    put(out, t, t->samples.point[to].at, &t->samples.point[to]);
    out->travel[path->travel_first] = out->vertex[path->first].at;
    out->travel_frame[path->travel_first].z = out->vertex[path->first].z;
    return ISO_OK;
}

/* ---- the others ---- */

static iso_status lay_ways(samples *s, const travels *t, int32_t first, int32_t end) {
    const iso_paths *flat = t->task->flat;
    int64_t count = 0, n = 0;
    for (int32_t w = first; w < end; w++)
        count += flat->path[t->ways[w].path].travel_count + 2;
    ISO_TRY(ISO_PUSH(s->flat, t->task->arena, count));
    ISO_TRY(ISO_PUSH(s->owner, t->task->arena, count));
    for (int32_t w = first; w < end; w++) {
        const iso_path *path = &flat->path[t->ways[w].path];
        s->flat[n++] = to_mm(t->ways[w].from);
        for (int32_t i = 0; i < path->travel_count; i++)
            s->flat[n++] = to_mm(flat->travel[path->travel_first + i]);
        s->flat[n++] = to_mm(flat->vertex[path->first].at);
        for (int64_t i = n - path->travel_count - 2; i < n; i++)
            s->owner[i] = w;
        s->owner[n - 1] = ~w;
    }
    s->count = n;
    return ISO_OK;
}

/* Of the way from sample `i` on: from end to end. */
static double rise_of_way(const travels *t, const samples *s, int64_t i) {
    double length = 0, most = t->task->options->clearance;
    for (; !sample_is_last(s, i) && steep * length < most; i++)
        length += vec3_distance(s->point[i].at, s->point[i + 1].at);
    return fmin(most, fmax(steep * length, least_rise));
}

static double uphill(const lift_task *t, const chart_point *on) {
    double z = on->normal.z;
    return t->options->tip * sqrt(fmax(0, 1 - z * z));
}

static iso_status put_ways(const travels *t, const samples *s) {
    int64_t begin = 0;
    double rise = 0;
    ISO_TRY(grow(t->out, s->count));
    for (int64_t i = 0; i < s->count; i++) {
        int32_t owner = s->owner[i];
        iso_path *path = &t->out->path[t->ways[owner < 0 ? ~owner : owner].path];
        if (i == begin) {
            path->travel_first = t->out->travel_count;
            rise = rise_of_way(t, s, i);
        }
        double height = rise + uphill(t->task, &s->point[i]) + bump_at(s, i, begin);
        put(t->out, t->task, above(t->task, &s->point[i], height), &s->point[i]);
        path->travel_count = t->out->travel_count - path->travel_first;
        if (sample_is_last(s, i))
            begin = i + 1;
    }
    return ISO_OK;
}

/* All at once. Where that fails as one leads where there is no layer, each half by itself, down to
 * the one that isn't known then. */
static iso_status make_ways(const travels *t, int32_t first, int32_t end) {
    iso_arena *arena = t->task->arena;
    iso_arena_mark mark = iso_arena_get_mark(arena);
    samples s;
    if (first == end)
        return ISO_OK;
    ISO_TRY(lay_ways(&s, t, first, end));
    iso_status status = sample_refine(&s, t->task->chart, &t->limits, arena);
    if (status == ISO_OK)
        status = put_ways(t, &s);
    iso_arena_pop(arena, mark);
    if (status != ISO_OUTSIDE)
        return status;
    if (end - first == 1)
        return ISO_OK;
    int32_t middle = first + (end - first) / 2;
    ISO_TRY(make_ways(t, first, middle));
    return make_ways(t, middle, end);
}

/* ---- all of them ---- */

/* Where the path's beads begin and end among the samples. */
typedef struct span {
    int64_t begin, end;
} span;

static span span_from(const samples *s, int64_t begin) {
    int64_t end = begin;
    while (!sample_is_last(s, end))
        end++;
    return (span){begin, end};
}

/* Near ways are put down, what is left goes to `ways`. */
static iso_status choose_ways(way *ways, int32_t *count, iso_paths *out, const lift_task *t) {
    const iso_paths *flat = t->flat;
    const iso_point *from = t->options->from;
    int64_t sample = 0, before = -1;
    *count = 0;
    for (int32_t p = 0; p < flat->count; p++) {
        const iso_path *path = &flat->path[p];
        if (path->count == 0)
            continue;
        if (before >= 0 && path->travel_count == 0 && is_near(t, before, sample))
            ISO_TRY(put_near(out, t, &out->path[p], sample));
        else if (from)
            ways[(*count)++] = (way){p, *from};
        span of = span_from(&t->samples, sample);
        before = of.end;
        sample = of.end + 1;
        from = &flat->vertex[path->first + (path->closed ? 0 : path->count - 1)].at;
    }
    return ISO_OK;
}

iso_status lift_travels(iso_paths *out, lift_task *task) {
    const lift_options *o = task->options;
    travels t = {.task = task, .out = out, .limits = task->limits};
    way *ways;
    int32_t count;
    t.limits.tolerance = fmax(o->tolerance, coarse * o->clearance);
    t.limits.bump = t.limits.tolerance;
    t.limits.turn = wide_turn * o->turn;
    t.limits.share = 0;
    t.limits.layer[1] = 0;
    ISO_TRY(ISO_PUSH(ways, task->arena, task->flat->count));
    ISO_TRY(choose_ways(ways, &count, out, task));
    t.ways = ways;
    return make_ways(&t, 0, count);
}

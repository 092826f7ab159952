#include "lift/lift.h"

#include <math.h>

#include "base/series.h"
#include "base/vector.h"
#include "lift/sample.h"
#include "lift/task.h"

static const double pi = 3.14159265358979323846;

/* ---- samples ---- */

/* By how much beads may differ from the mean of their piece. */
static const double bead_share = 0.08;
/* Tolerances that the layer may stand off the line between two points of it: lines are then moved
 * half of it (half_rise), and what is left is for neighbours that are moved otherwise. */
static const double both_sides = 1.6;

static int64_t samples_of(const iso_paths *flat) {
    int64_t count = 0;
    for (int32_t p = 0; p < flat->count; p++)
        count += flat->path[p].count > 0 ? flat->path[p].count + (flat->path[p].closed != 0) : 0;
    return count;
}

static iso_vec2 to_mm(iso_point p) {
    return (iso_vec2){iso_mm(p.x), iso_mm(p.y)};
}

/* A closed path comes back to its first vertex. */
static iso_status sample_paths(samples *s, const iso_paths *flat, iso_arena *arena) {
    int64_t n = 0;
    ISO_TRY(ISO_PUSH(s->flat, arena, samples_of(flat)));
    ISO_TRY(ISO_PUSH(s->owner, arena, samples_of(flat)));
    for (int32_t p = 0; p < flat->count; p++) {
        const iso_path *path = &flat->path[p];
        for (int32_t i = 0; i < path->count; i++) {
            s->flat[n] = to_mm(flat->vertex[path->first + i].at);
            s->owner[n++] = path->first + i;
        }
        if (path->closed && path->count > 0) {
            s->flat[n] = to_mm(flat->vertex[path->first].at);
            s->owner[n++] = path->first;
        }
        if (path->count > 0)
            s->owner[n - 1] = ~s->owner[n - 1];
    }
    s->count = n;
    return ISO_OK;
}

/* ---- what a printer is able to ---- */

static iso_status too_steep(const lift_task *t, const chart_point *p) {
    const double degree = 180 / 3.14159265358979323846;
    double z = p->normal.z, across = sqrt(fmax(0, 1 - z * z));
    return iso_fail(
        ISO_OUTSIDE,
        "at x %.3f y %.3f z %.3f mm (from the middle of the object and its foot) a "
        "layer is %.1f degrees steep, more than the nozzle is allowed to follow (%.1f): "
        "choose a flatter field, or a larger field_slope",
        p->at.x, p->at.y, p->at.z, degree * series_arctangent2(across, z),
        degree * series_arctangent(t->options->slope));
}

static iso_status wrong_thickness(const lift_task *t, const chart_point *p, double thickness) {
    bool thin = thickness < t->options->least;
    return iso_fail(ISO_OUTSIDE,
                    "at x %.3f y %.3f z %.3f mm (from the middle of the object and its foot) a "
                    "layer is %.4f mm thick, and may not be %s than %.4f mm: choose a %s "
                    "layer_height, or a field whose layers lie more evenly",
                    p->at.x, p->at.y, p->at.z, thickness, thin ? "thinner" : "thicker",
                    thin ? t->options->least : t->options->most, thin ? "larger" : "smaller");
}

/* Rounding mustn't refuse what was made to lie at the limit. */
static const double slack = 1e-3;

static iso_status check_points(const lift_task *t) {
    const lift_options *o = t->options;
    double upright = o->slope > 0 ? 1 / sqrt(1 + o->slope * o->slope) * (1 - slack) : -2;
    double least = o->least / o->thickness * (1 - slack);
    double most = o->most > 0 ? o->most / o->thickness * (1 + slack) : HUGE_VAL;
    for (int64_t i = 0; i < t->samples.count; i++) {
        const chart_point *p = &t->samples.point[i];
        if (!(p->normal.z >= upright))
            return too_steep(t, p);
        if (!(p->thickness >= least && p->thickness <= most))
            return wrong_thickness(t, p, p->thickness * o->thickness);
    }
    return ISO_OK;
}

/* ---- beads ---- */

/* mm^3 for each unit^2 of the flat bead's section: the chart's volume factor along the piece from i
 * to i + 1, by the trapezoid, less what the bend of the factor adds to that: its second difference,
 * on the same straight line, is the mean of those at both ends. */
static double factor_along(const lift_task *t, int64_t i) {
    const samples *s = &t->samples;
    int64_t begin = i > 0 && s->owner[i - 1] == s->owner[i] ? i - 1 : i;
    int64_t end = s->owner[i + 1] == s->owner[i] ? i + 2 : i + 1;
    double f[4] = {0}, x[4] = {0}, bend = 0;
    int32_t bends = 0;
    for (int64_t k = -1; k < 3; k++) {
        if (i + k < begin || i + k > end)
            continue;
        f[k + 1] = s->point[i + k].volume;
        x[k + 1] = k < 0    ? -t->length[i - 1]
                   : k == 0 ? 0
                   : k == 1 ? t->length[i]
                            : t->length[i] + t->length[i + 1];
    }
    if (!(x[2] > 0))
        return 0;
    double slope = (f[2] - f[1]) / x[2];
    if (i - 1 >= begin) {
        bend += (slope - (f[1] - f[0]) / -x[0]) / (x[2] - x[0]);
        bends++;
    }
    if (i + 2 <= end) {
        bend += ((f[3] - f[2]) / (x[3] - x[2]) - slope) / x[3];
        bends++;
    }
    double mean = 0.5 * (f[1] + f[2]);
    if (bends > 0)
        mean -= x[2] * x[2] * bend / (6 * bends);
    return mean * x[2];
}

static double units_between(const iso_path_vertex *a, const iso_path_vertex *b) {
    double x = (double)b->at.x - a->at.x, y = (double)b->at.y - a->at.y, z = (double)b->z - a->z;
    return sqrt(x * x + y * y + z * z);
}

static int32_t to_int32(double x) {
    return x < INT32_MAX ? (int32_t)(x + 0.5) : INT32_MAX;
}

/* The bead from one vertex to another is as wide as what it holds makes it. `factor` is the chart's
 * along the piece, in units of length, `thickness` that of the layer. Returns what finds no room as
 * the piece has no length. */
static double put_bead(iso_path_vertex *from, const iso_path_vertex *to, double factor,
                       double thickness) {
    double length = units_between(from, to);
    if (!(length > 0))
        return factor;
    double flat = from->area, area = flat * factor / length;
    double height = iso_bead_height(from->width, flat) * thickness;
    from->area = to_int32(area);
    if (height > 0)
        from->width = to_int32(area / height + (1 - pi / 4) * height);
    return 0;
}

/* ---- vertices ---- */

/* Where the straight line that begins at sample `i` ends: at the next sample that is meant for it,
 * if nothing between is off the line then. */
static int64_t line_end(const lift_task *t, int64_t i) {
    const samples *s = &t->samples;
    int64_t end = i + 1;
    while (!s->keep[end])
        end++;
    while (end > i + 1 && !sample_fits(s, i, end, t->chart, &t->limits))
        end = i + (end - i + 1) / 2;
    return end;
}

/* Vertices stand above the layer by half of what it stands above the lines that meet there: so
 * lines are as far above it at their ends as below it in their middles. */
static double half_rise(double before, double after) {
    if (before * after < 0)
        return 0.25 * (before + after);
    return 0.5 * (fabs(before) > fabs(after) ? before : after);
}

/* The samples of a path that become vertices, and how far the layer is off the lines that begin
 * there. Returns how many; a closed path's last is its first again. */
static int32_t choose_vertices(lift_task *t, int64_t first, int64_t last) {
    int32_t count = 0;
    for (int64_t i = first; i < last; count++) {
        int64_t end = line_end(t, i);
        t->chosen[count] = i;
        t->rise[count] = t->arcs ? 0 : chart_rise(&t->samples.point[i], &t->samples.point[end]);
        i = end;
    }
    t->chosen[count] = last;
    t->rise[count] = 0;
    return count + 1;
}

static void place_vertices(iso_path_vertex *vertex, iso_frame *frame, const lift_task *t,
                           int32_t count, bool closed) {
    for (int32_t i = 0; i < count; i++) {
        const chart_point *p = &t->samples.point[t->chosen[i]];
        int32_t owner = t->samples.owner[t->chosen[i]];
        double before = i > 0 ? t->rise[i - 1] : closed && count > 1 ? t->rise[count - 2] : 0;
        double after = i + 1 < count || !closed ? t->rise[i] : t->rise[0];
        iso_vec3 at = lift_above(t, p, half_rise(before, after));
        vertex[i] = t->flat->vertex[owner < 0 ? ~owner : owner];
        vertex[i].at = (iso_point){iso_units(at.x), iso_units(at.y)};
        vertex[i].z = iso_units(at.z - t->options->z);
        frame[i] = (iso_frame){.normal = p->normal,
                               .height = iso_units(t->options->thickness * p->thickness)};
    }
}

/* What has no room goes to the next line of the same bead. */
static void place_beads(iso_path_vertex *vertex, const lift_task *t, int32_t count) {
    const samples *s = &t->samples;
    double left = 0;
    for (int32_t i = 0; i + 1 < count; i++) {
        int64_t from = t->chosen[i], to = t->chosen[i + 1];
        double factor = i > 0 && s->owner[from] == s->owner[from - 1] ? left : 0;
        for (int64_t k = from; k < to; k++)
            factor += factor_along(t, k) * ISO_UNITS_PER_MM;
        left = put_bead(&vertex[i], &vertex[i + 1], factor,
                        0.5 * (s->point[from].thickness + s->point[to].thickness));
    }
}

static iso_status grow(iso_paths *out, int64_t more) {
    int64_t vertices = out->vertex_count + more;
    if (vertices > INT32_MAX - 1)
        return iso_fail(ISO_OUTSIDE, "a layer with more than 2^31 path vertices is too much");
    ISO_TRY(ISO_GROW(out->vertex, out->vertex_capacity, vertices));
    return ISO_GROW(out->frame, out->frame_capacity, vertices);
}

/* From sample *i on; leaves *i behind the path's last one. */
static iso_status lift_path(iso_paths *out, lift_task *t, const iso_path *flat, int64_t *i) {
    iso_path *path = &out->path[out->count++];
    *path = *flat;
    path->first = out->vertex_count;
    path->travel_first = path->travel_count = 0;
    if (flat->count == 0)
        return ISO_OK;
    int64_t first = *i, last = first;
    while (!sample_is_last(&t->samples, last))
        last++;
    *i = last + 1;
    ISO_TRY(grow(out, last - first + 1));
    iso_path_vertex *vertex = out->vertex + path->first;
    int32_t count = choose_vertices(t, first, last);
    place_vertices(vertex, out->frame + path->first, t, count, flat->closed);
    place_beads(vertex, t, count);
    path->count = count - (flat->closed != 0);
    out->vertex_count += path->count;
    return ISO_OK;
}

static void measure(const lift_task *t) {
    for (int64_t i = 0; i < t->samples.count; i++) {
        if (sample_is_last(&t->samples, i))
            continue;
        iso_vec2 step = sample_step(t->chart, t->samples.flat[i], t->samples.flat[i + 1]);
        t->length[i] = sqrt(step.x * step.x + step.y * step.y);
    }
}

static iso_status lift_all(iso_paths *out, lift_task *t) {
    const iso_paths *flat = t->flat;
    int64_t i = 0;
    ISO_TRY(sample_paths(&t->samples, flat, t->arena));
    ISO_TRY(sample_refine(&t->samples, t->chart, &t->limits, t->arena));
    ISO_TRY(check_points(t));
    ISO_TRY(sample_spread(&t->samples, t->chart, &t->limits, t->arena));
    ISO_TRY(ISO_PUSH(t->length, t->arena, t->samples.count));
    ISO_TRY(ISO_PUSH(t->chosen, t->arena, t->samples.count));
    ISO_TRY(ISO_PUSH(t->rise, t->arena, t->samples.count));
    measure(t);
    ISO_TRY(ISO_GROW(out->path, out->path_capacity, flat->count));
    for (int32_t p = 0; p < flat->count; p++)
        ISO_TRY(lift_path(out, t, &flat->path[p], &i));
    return lift_travels(out, t);
}

iso_status lift_paths(iso_paths *out, const iso_paths *flat, const chart *map,
                      const lift_options *options, iso_arena *scratch) {
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    lift_task task = {.flat = flat,
                      .chart = map,
                      .options = options,
                      .arcs = options->arcs && chart_kind_of(map) == CHART_CYLINDER,
                      .limits = {.layer = {options->r, options->thickness},
                                 .tolerance = options->tolerance,
                                 .bump = both_sides * options->tolerance,
                                 .turn = options->turn,
                                 .share = bead_share},
                      .arena = scratch};
    iso_paths_clear(out);
    iso_status status = lift_all(out, &task);
    iso_arena_pop(scratch, mark);
    if (status != ISO_OK)
        iso_paths_clear(out);
    return status;
}

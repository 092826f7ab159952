/* Frames that turn no more than the curve does: from vertex to vertex by two reflections (Wang,
 * Juettler, Zheng, Liu, Computation of Rotation Minimizing Frames, 2008). */
#include "channel/sweep.h"

#include "base/series.h"

typedef struct sweeper {
    const curve *line;
    iso_vec3 *tangent, *u; /* [count] */
    iso_vec3 end;
} sweeper;

static iso_vec3 edge_from(const curve *c, int32_t i) {
    return vec3_unit(vec3_minus(c->point[i + 1 < c->count ? i + 1 : 0], c->point[i]));
}

static void find_tangents(sweeper *s) {
    const curve *c = s->line;
    for (int32_t i = 0; i < c->count; i++) {
        iso_vec3 back = edge_from(c, i > 0 ? i - 1 : c->count - 1), ahead = edge_from(c, i);
        s->tangent[i] = vec3_unit(vec3_plus(back, ahead));
    }
    if (!c->closed) {
        s->tangent[0] = vec3_times(s->end, -1);
        s->tangent[c->count - 1] = s->end;
    }
}

static iso_vec3 any_across(iso_vec3 t) {
    iso_vec3 axis = t.z * t.z < 0.5 ? vec3(0, 0, 1) : vec3(1, 0, 0);
    return vec3_unit(vec3_cross(axis, t));
}

/* u at i, carried to j. */
static iso_vec3 carry(const sweeper *s, iso_vec3 u, int32_t i, int32_t j) {
    iso_vec3 v = vec3_minus(s->line->point[j], s->line->point[i]), t = s->tangent[i];
    double square = vec3_dot(v, v);
    if (square > 0) {
        u = vec3_along(u, -2 / square * vec3_dot(v, u), v);
        t = vec3_along(t, -2 / square * vec3_dot(v, t), v);
    }
    v = vec3_minus(s->tangent[j], t);
    square = vec3_dot(v, v);
    if (square > 0)
        u = vec3_along(u, -2 / square * vec3_dot(v, u), v);
    /* rounding adds up over thousands of steps */
    return vec3_unit(vec3_along(u, -vec3_dot(u, s->tangent[j]), s->tangent[j]));
}

/* The angle from u to v around t. */
static double angle_between(iso_vec3 u, iso_vec3 v, iso_vec3 t) {
    return series_arctangent2(vec3_dot(vec3_cross(u, v), t), vec3_dot(u, v));
}

static void find_frames(sweeper *s, skin *out, int32_t middle, iso_vec3 off) {
    int32_t n = s->line->count;
    s->u[0] = any_across(s->tangent[0]);
    for (int32_t i = 1; i < n; i++)
        s->u[i] = carry(s, s->u[i - 1], i - 1, i);
    double turn = angle_between(s->u[middle], off, s->tangent[middle]);
    out->twist = 0;
    if (s->line->closed)
        out->twist = angle_between(s->u[0], carry(s, s->u[n - 1], n - 1, 0), s->tangent[0]);
    double whole = curve_length(s->line);
    for (int32_t i = 0; i < n; i++) {
        double sine, cosine, share = whole > 0 ? out->at[i] / whole : 0;
        double before = whole > 0 ? out->at[middle] / whole : 0;
        series_sine_cosine(&sine, &cosine, turn - out->twist * (share - before));
        s->u[i] = vec3_plus(vec3_times(s->u[i], cosine),
                            vec3_times(vec3_cross(s->tangent[i], s->u[i]), sine));
    }
}

/* In the plane halfway between two edges sections are longer across the bend, so that along each
 * edge the channel is a prism of the very section: its volume is the section's area times the
 * curve's length. */
static void put_row(skin *out, const sweeper *s, const iso_channel_section *section, int32_t i) {
    const curve *c = s->line;
    iso_vec3 u = s->u[i], t = s->tangent[i], v = vec3_cross(t, u), bend = {0, 0, 0};
    double stretch = 0;
    if (c->closed || (i > 0 && i + 1 < c->count)) {
        iso_vec3 ahead = edge_from(c, i);
        double cosine = vec3_dot(t, ahead);
        bend = vec3_unit(vec3_along(ahead, -cosine, t));
        stretch = cosine > 0.1 ? 1 / cosine - 1 : 0;
    }
    for (int32_t k = 0; k < out->sides; k++) {
        iso_vec2 corner = section->corner[k];
        iso_vec3 w = vec3_plus(vec3_times(u, corner.x), vec3_times(v, corner.y));
        w = vec3_along(w, stretch * vec3_dot(w, bend), bend);
        out->point[(int64_t)out->sides * i + k] = vec3_plus(c->point[i], w);
    }
}

/* Within the side of the mould, and to a unit of the planar kernel. */
static void flatten(skin *out, const sweeper *s, int32_t row) {
    for (int32_t k = 0; k < out->sides; k++) {
        iso_vec3 *p = &out->point[(int64_t)out->sides * row + k], c = s->line->point[row];
        *p = vec3(s->end.x != 0 ? c.x : iso_mm(iso_units(p->x)),
                  s->end.y != 0 ? c.y : iso_mm(iso_units(p->y)), iso_mm(iso_units(p->z)));
    }
}

iso_status sweep(skin *out, const curve *line, const iso_channel_section *section, int32_t middle,
                 iso_vec3 off, iso_vec3 end, iso_arena *arena) {
    sweeper s = {.line = line, .end = end};
    *out = (skin){.sides = section->sides, .rows = line->count, .closed = line->closed};
    if ((int64_t)out->sides * out->rows > INT32_MAX / 8)
        return iso_fail(ISO_OUTSIDE, "a channel of %d sections with %d sides", out->rows,
                        out->sides);
    ISO_TRY(ISO_PUSH(out->point, arena, (int64_t)out->sides * out->rows));
    ISO_TRY(ISO_PUSH(out->at, arena, (int64_t)out->rows + 1));
    iso_arena_mark mark = iso_arena_get_mark(arena);
    ISO_TRY(ISO_PUSH(s.tangent, arena, line->count));
    ISO_TRY(ISO_PUSH(s.u, arena, line->count));
    curve_measure(out->at, line);
    find_tangents(&s);
    find_frames(&s, out, middle, off);
    for (int32_t i = 0; i < out->rows; i++)
        put_row(out, &s, section, i);
    if (!line->closed) {
        flatten(out, &s, 0);
        flatten(out, &s, out->rows - 1);
    }
    iso_arena_pop(arena, mark);
    return ISO_OK;
}

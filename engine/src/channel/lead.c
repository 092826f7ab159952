#include "channel/lead.h"

/* Of the depth, to both sides: the surface's slope is the mean of so much. */
#define SLOPE_REACH 0.25

// Rings

iso_status lead_off(curve *out, iso_channels *c, const ring *outline) {
    ring_offset offset = {c->options.depth, c->bend / STEPS_A_BEND, &c->part};
    int32_t folds;
    ISO_TRY(ring_push_off(out, &folds, outline, &offset));
    c->figures.folds += folds;
    return ISO_OK;
}

static iso_status ring_off(curve *out, iso_channels *c, const tower *t, double f, ring *outline,
                           iso_arena *arena) {
    ISO_TRY(ring_of_tower(outline, t, f, SLOPE_REACH * c->options.depth, arena));
    return lead_off(out, c, outline);
}

iso_status lead_note(iso_channels *c, int32_t tower_index, double f, const ring *outline) {
    iso_channel_figures *figures = &c->figures;
    iso_channel_ring noted = {.tower = tower_index, .channel = figures->channel_count, .height = f};
    for (int32_t i = 0; i < outline->count; i++) {
        noted.z += outline->point[i].z / outline->count;
        noted.length +=
            vec3_distance(outline->point[i > 0 ? i - 1 : outline->count - 1], outline->point[i]);
    }
    ISO_TRY(ISO_GROW(c->ring, c->ring_capacity, figures->ring_count + 1));
    ISO_TRY(ISO_GROW(c->outline, c->outline_capacity, figures->ring_count + 1));
    c->ring[figures->ring_count] = noted;
    c->outline[figures->ring_count++] = *outline;
    return ISO_OK;
}

// Channels

/* x of the section is to point off the part: away from the nearest point of the channel's rings. */
static iso_vec3 off_part(const iso_channels *c, iso_vec3 p) {
    iso_vec3 found = p;
    double best = INFINITY;
    for (int32_t r = 0; r < c->figures.ring_count; r++) {
        const ring *outline = &c->outline[r];
        if (c->ring[r].channel != c->figures.channel_count)
            continue;
        for (int32_t i = 0; i < outline->count; i++) {
            double distance = vec3_distance(p, outline->point[i]);
            if (distance < best)
                best = distance, found = outline->point[i];
        }
    }
    return vec3_unit(vec3_minus(p, found));
}

/* The channel takes the curve over, whatever comes of it. */
static iso_status add_channel(iso_channels *c, curve *line, const double leg[2]) {
    keeping keep = {c->options.depth, c->bend, c->bend / STEPS_A_BEND, 2};
    iso_status status = keep_off(line, &c->part, &keep);
    if (status == ISO_OK)
        status = ISO_GROW(c->channel, c->channel_capacity, c->figures.channel_count + 1);
    channel made = {.line = *line, .leg = {leg[0], leg[1]}};
    if (status == ISO_OK) {
        int32_t middle = line->count / 2;
        status = sweep(&made.skin, &made.line, &c->options.section, middle,
                       off_part(c, line->point[middle]), c->side.out, &c->arena);
    }
    if (status == ISO_OK)
        c->channel[c->figures.channel_count++] = made;
    else
        curve_free(line);
    *line = (curve){0};
    return status;
}

iso_status lead_to_ports(iso_channels *c, const curve *way) {
    curve line;
    double leg[2];
    ISO_TRY(route_ports(&line, leg, way, &c->side));
    return add_channel(c, &line, leg);
}

iso_status lead_ring(iso_channels *c, curve *pushed) {
    static const double none[2] = {0, 0};
    double middle = NAN;
    curve way;
    if (c->options.ports == ISO_CHANNEL_CLOSED)
        return add_channel(c, pushed, none);
    ISO_TRY(route_open(&way, &middle, pushed, &c->side));
    iso_status status = lead_to_ports(c, &way);
    curve_free(&way);
    return status;
}

/* Steps of the way from ring to ring, on the part's offset too. */
enum { STAIRS = 4 };

static iso_status append_stairs(series *s, iso_channels *c, const tower *t) {
    bool right = s->rings % 2 == 1;
    double middle = s->middle;
    for (int k = 1; k < STAIRS; k++) {
        iso_arena_mark mark = iso_arena_get_mark(&c->arena);
        ring outline;
        curve pushed = {0}, opened = {0};
        int32_t folds = c->figures.folds;
        iso_status status =
            ring_off(&pushed, c, t, s->last + c->options.pitch * k / STAIRS, &outline, &c->arena);
        if (status == ISO_OK)
            status = route_open(&opened, &middle, &pushed, &c->side);
        if (status == ISO_OK && middle == s->middle)
            status = curve_add(&s->way, opened.point[right ? 0 : opened.count - 1]);
        curve_free(&pushed);
        curve_free(&opened);
        iso_arena_pop(&c->arena, mark);
        c->figures.folds = folds;
        if (status != ISO_OK && status != ISO_NOT_VERIFIED)
            return status; /* without a place for a step the way goes straight on */
    }
    return ISO_OK;
}

iso_status lead_on(iso_channels *c, series *s, const tower *t, double f, const curve *pushed) {
    curve opened;
    double middle = s->rings > 0 ? s->middle : NAN;
    if (s->rings > 0 && t)
        ISO_TRY(append_stairs(s, c, t));
    ISO_TRY(route_open(&opened, &middle, pushed, &c->side));
    iso_status status = route_append(&s->way, &opened, s->rings % 2 == 0);
    curve_free(&opened);
    s->rings++;
    s->last = f;
    s->middle = middle;
    return status;
}

static iso_status add_level(iso_channels *c, int32_t tower_index, double f, series *s) {
    const tower *t = &c->tower[tower_index];
    ring outline;
    curve pushed = {0};
    ISO_TRY(ring_off(&pushed, c, t, f, &outline, &c->arena));
    iso_status status = lead_note(c, tower_index, f, &outline);
    if (status == ISO_OK)
        status = c->options.ports == ISO_CHANNEL_SERIES ? lead_on(c, s, t, f, &pushed)
                                                        : lead_ring(c, &pushed);
    curve_free(&pushed);
    return status;
}

/* The first of the levels at `low` or above. */
static double first_level(const iso_channels *c, double low) {
    double skipped = ceil((low - c->start) / c->options.pitch - 1e-9);
    return skipped > 0 ? skipped : 0;
}

iso_status lead_tower(iso_channels *c, int32_t index) {
    double low, high;
    const tower *t = &c->tower[index];
    const double *top = t->f + (int64_t)t->samples * (t->rings - 1);
    series s = {0};
    tower_range(&low, &high, t);
    iso_status status = ISO_OK;
    double f = c->start + c->options.pitch * first_level(c, low);
    for (double k = first_level(c, low); f <= high && status == ISO_OK;) {
        status = add_level(c, index, f, &s);
        f = c->start + c->options.pitch * ++k;
    }
    bool part_of_it = false;
    for (int32_t i = 0; i < t->samples; i++)
        part_of_it |= top[i] >= f;
    c->figures.incomplete += part_of_it;
    if (status == ISO_OK && s.rings > 0)
        status = lead_to_ports(c, &s.way);
    curve_free(&s.way);
    return status;
}

/* What stays of the mould between channels, around the part, and to the outside.
 *
 * Skins are cut into pieces along the channel, each with a tree of its own: corners of one are
 * asked for the nearest triangle of another. Pieces that follow each other along a channel are left
 * alone: what is nearer along it than half a turn of its narrowest bend is the channel itself. */
#include "channel/body.h"

#define PI 3.141592653589793

typedef struct piece {
    int32_t channel, first, last; /* rows, the last one with it */
    iso_vec3 min, max;
    iso_closest *tree;
} piece;

typedef struct wall_finder {
    const iso_channels *c;
    piece *piece;
    int64_t capacity;
    int32_t count;
} wall_finder;

static const skin *skin_of(const wall_finder *w, const piece *p) {
    return &w->c->channel[p->channel].skin;
}

static const iso_vec3 *row_of(const skin *s, int32_t row) {
    return s->point + (int64_t)s->sides * (row % s->rows);
}

static iso_status plant(wall_finder *w, piece *p) {
    const skin *s = skin_of(w, p);
    int64_t count = 2 * (int64_t)s->sides * (p->last - p->first), n = 0;
    iso_vec3 *corner;
    ISO_TRY(ISO_ALLOCATE(corner, 3 * count));
    for (int32_t r = p->first; r < p->last; r++)
        for (int32_t k = 0; k < s->sides; k++) {
            skin_square(corner + n, s, r, k);
            n += 6;
        }
    p->min = p->max = corner[0];
    for (int64_t i = 1; i < n; i++) {
        p->min = vec3(fmin(p->min.x, corner[i].x), fmin(p->min.y, corner[i].y),
                      fmin(p->min.z, corner[i].z));
        p->max = vec3(fmax(p->max.x, corner[i].x), fmax(p->max.y, corner[i].y),
                      fmax(p->max.z, corner[i].z));
    }
    iso_status status = closest_new(&p->tree, corner, count);
    iso_release(corner);
    return status;
}

static iso_status plant_all(wall_finder *w) {
    double step = PI / 4 * w->c->bend;
    for (int32_t i = 0; i < w->c->figures.channel_count; i++) {
        const skin *s = &w->c->channel[i].skin;
        int32_t rows = skin_steps(s);
        for (int32_t first = 0, last; first < rows; first = last) {
            last = first + 1;
            while (last < rows &&
                   s->at[last + 1 < s->rows + s->closed ? last + 1 : last] <= s->at[first] + step)
                last++;
            ISO_TRY(ISO_GROW(w->piece, w->capacity, w->count + 1));
            w->piece[w->count] = (piece){.channel = i, .first = first, .last = last};
            ISO_TRY(plant(w, &w->piece[w->count++]));
        }
    }
    return ISO_OK;
}

static double gap(double low, double high, double other_low, double other_high) {
    return fmax(0, fmax(other_low - high, low - other_high));
}

static double box_distance(const piece *a, const piece *b) {
    return vec3_length(vec3(gap(a->min.x, a->max.x, b->min.x, b->max.x),
                            gap(a->min.y, a->max.y, b->min.y, b->max.y),
                            gap(a->min.z, a->max.z, b->min.z, b->max.z)));
}

/* Along the channel, from end to beginning; the shorter way around a closed one. */
static double apart_along(const skin *s, const piece *a, const piece *b) {
    const piece *low = a->first < b->first ? a : b, *high = a->first < b->first ? b : a;
    double way = s->at[high->first] - s->at[low->last];
    if (s->closed)
        way = fmin(way, s->at[s->rows] - s->at[high->last] + s->at[low->first]);
    return way;
}

static void ask(iso_channel_wall *found, const wall_finder *w, const piece *a, const piece *b) {
    const skin *s = skin_of(w, a);
    int32_t guess = 0;
    for (int32_t r = a->first; r <= a->last; r++)
        for (int32_t k = 0; k < s->sides; k++) {
            iso_vec3 p = row_of(s, r)[k];
            double most = found->thickness;
            double square = closest_square(b->tree, p, most * most, &guess);
            if (square < most * most)
                *found = (iso_channel_wall){sqrt(square), p, a->channel, b->channel};
        }
}

/* Pairs are few times n^2 / 2 boxes, which cost a nanosecond each: ten metres of channels are two
 * thousand pieces. */
static void find_between(iso_channel_wall *found, const wall_finder *w) {
    for (int32_t i = 0; i < w->count; i++)
        for (int32_t j = i + 1; j < w->count; j++) {
            const piece *a = &w->piece[i], *b = &w->piece[j];
            if (box_distance(a, b) >= found->thickness)
                continue;
            if (a->channel == b->channel && apart_along(skin_of(w, a), a, b) < PI * w->c->bend)
                continue;
            ask(found, w, a, b);
            ask(found, w, b, a);
        }
}

/* An open channel's legs are to end in the side; so much of it isn't asked about. */
static bool is_leg(const iso_channels *c, const channel *way, int32_t row) {
    const skin *s = &way->skin;
    double at = s->at[row], whole = s->at[s->rows - 1];
    return !s->closed && (at < way->leg[0] + c->bend || whole - at < way->leg[1] + c->bend);
}

static void find_outside(iso_channels *c) {
    iso_channel_figures *f = &c->figures;
    iso_vec3 out = c->side.out;
    for (int32_t i = 0; i < f->channel_count; i++) {
        const skin *s = &c->channel[i].skin;
        for (int64_t n = 0; n < (int64_t)s->sides * s->rows; n++) {
            iso_vec3 p = s->point[n];
            bool leg = is_leg(c, &c->channel[i], (int32_t)(n / s->sides));
            double to[6] = {leg && out.x < 0 ? INFINITY : p.x - f->box_min.x,
                            leg && out.x > 0 ? INFINITY : f->box_max.x - p.x,
                            leg && out.y < 0 ? INFINITY : p.y - f->box_min.y,
                            leg && out.y > 0 ? INFINITY : f->box_max.y - p.y,
                            p.z - f->box_min.z,
                            f->box_max.z - p.z};
            for (int k = 0; k < 6; k++)
                if (to[k] < f->outside.thickness)
                    f->outside = (iso_channel_wall){to[k], p, i, -1};
        }
    }
}

static void find_to_part(iso_channels *c) {
    iso_channel_wall *found = &c->figures.to_part;
    int32_t guess = 0;
    for (int32_t i = 0; i < c->figures.channel_count; i++) {
        const skin *s = &c->channel[i].skin;
        for (int64_t n = 0; n < (int64_t)s->sides * s->rows; n++) {
            double most = found->thickness;
            double square = closest_square(c->part.tree, s->point[n], most * most, &guess);
            if (square < most * most)
                *found = (iso_channel_wall){sqrt(square), s->point[n], i, -1};
        }
    }
}

/* A channel that passes through the part has a point of its middle inside. */
static iso_status find_inside(iso_channels *c) {
    for (int32_t i = 0; i < c->figures.channel_count; i++) {
        const curve *line = &c->channel[i].line;
        uint8_t *inside;
        ISO_TRY(ISO_ALLOCATE(inside, line->count));
        iso_status status = enclosed_inside(&c->part.columns, inside, line->point, line->count);
        for (int32_t k = 0; k < line->count && status == ISO_OK; k++)
            if (inside[k])
                c->figures.to_part = (iso_channel_wall){0, line->point[k], i, -1};
        iso_release(inside);
        ISO_TRY(status);
    }
    return ISO_OK;
}

static void find_bends(iso_channels *c) {
    iso_channel_figures *f = &c->figures;
    f->bend = INFINITY;
    for (int32_t i = 0; i < f->channel_count; i++) {
        int32_t at;
        double radius = curve_least_radius(&at, &c->channel[i].line);
        if (radius < f->bend) {
            f->bend = radius;
            f->bend_at = c->channel[i].line.point[at];
            f->bend_channel = i;
        }
    }
}

iso_status channels_measure_walls(iso_channels *c) {
    static const iso_channel_wall none = {INFINITY, {0, 0, 0}, -1, -1};
    iso_channel_figures *f = &c->figures;
    wall_finder w = {.c = c};
    f->to_part = f->between = f->outside = none;
    find_bends(c);
    find_outside(c);
    find_to_part(c);
    ISO_TRY(find_inside(c));
    iso_status status = plant_all(&w);
    if (status == ISO_OK)
        find_between(&f->between, &w);
    for (int32_t i = 0; i < w.count; i++)
        closest_free(w.piece[i].tree);
    iso_release(w.piece);
    return status;
}

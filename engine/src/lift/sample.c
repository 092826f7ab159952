#include "lift/sample.h"

#include <math.h>

#include "base/vector.h"

enum {
    ROUNDS_MOST = 12,
    PIECES_MOST = 8, /* out of one at a time: where a layer bends in few places most pieces of an
                      * even cut would be for nothing */
    REACH_MOST = 1 << 20
};

/* mm: a layer's crease is passed over by a piece no longer than this. */
static const double shortest = 0.004;

iso_vec2 sample_step(const chart *map, iso_vec2 a, iso_vec2 b) {
    iso_vec2 step = {b.x - a.x, b.y - a.y};
    double period = chart_period(map);
    if (period > 0 && fabs(step.x) > 0.5 * period)
        step.x -= period * floor(step.x / period + 0.5);
    return step;
}

static double larger_share(double a, double b) {
    return (a > b ? a - b : b - a) / (a < b ? a : b);
}

/* How much a piece takes of what it may, as its ends tell: pieces that it should be. */
static double need_of(const chart_point *a, const chart_point *b, const chart *map,
                      const sample_limits *limits) {
    double rise = fabs(chart_rise(a, b));
    double need = sqrt(fmax(rise / limits->bump, rise * chart_swerve(map, b) / limits->tolerance));
    if (limits->turn > 0)
        need = fmax(need, vec3_distance(a->normal, b->normal) / limits->turn);
    if (limits->share > 0 && (a->volume != b->volume || a->thickness != b->thickness))
        need = fmax(need, fmax(larger_share(a->volume, b->volume),
                               larger_share(a->thickness, b->thickness)) /
                              limits->share);
    return need;
}

/* What a need may be over 1 as it is only estimated; pieces of equal shares come out a little
 * unequal. */
static const double enough = 1.02;

static int32_t pieces_of(const chart_point *a, const chart_point *b, const chart *map,
                         const sample_limits *limits) {
    double need = need_of(a, b, map, limits);
    return need <= enough ? 1 : need < PIECES_MOST ? (int32_t)ceil(need) : PIECES_MOST;
}

/* Is a sample no further off a straight line than it may be? */
static bool is_on(const chart_point *p, iso_vec3 a, iso_vec3 b, const sample_limits *limits) {
    iso_vec3 chord = vec3_minus(b, a), to = vec3_minus(p->at, a);
    double square = vec3_dot(chord, chord);
    if (square > 0)
        to = vec3_along(to, -vec3_dot(to, chord) / square, chord);
    double up = vec3_dot(to, p->normal), aside = vec3_dot(to, to) - up * up;
    return fabs(up) <= limits->bump * enough && aside <= limits->tolerance * limits->tolerance;
}

bool sample_fits(const samples *s, int64_t i, int64_t j, const chart *map,
                 const sample_limits *limits) {
    for (int64_t k = i + 1; k < j; k++)
        if (!is_on(&s->point[k], s->point[i].at, s->point[j].at, limits))
            return false;
    return pieces_of(&s->point[i], &s->point[j], map, limits) == 1;
}

/* A round of refinement. */
typedef struct round_of {
    int32_t number;
    int64_t added;
    int32_t *pieces; /* [samples] into which the piece after each one goes; 0: it is done */
} round_of;

static int32_t pieces_at(const samples *s, int64_t i, const chart *map, const sample_limits *limits,
                         bool first) {
    iso_vec2 step = sample_step(map, s->flat[i], s->flat[i + 1]);
    double square = step.x * step.x + step.y * step.y, reach = chart_reach(map);
    if (square < shortest * shortest)
        return 1;
    int32_t pieces = pieces_of(&s->point[i], &s->point[i + 1], map, limits);
    if (first && reach > 0 && square > reach * reach) {
        double least = ceil(sqrt(square) / reach);
        int32_t many = least < REACH_MOST ? (int32_t)least : REACH_MOST;
        pieces = pieces > many ? pieces : many;
    }
    return pieces;
}

static void count_pieces(round_of *round, const samples *s, const chart *map,
                         const sample_limits *limits) {
    round->added = 0;
    for (int64_t i = 0; i < s->count; i++) {
        if (round->number > 0 && round->pieces[i] == 0)
            continue;
        int32_t pieces =
            sample_is_last(s, i) ? 1 : pieces_at(s, i, map, limits, round->number == 0);
        round->pieces[i] = pieces == 1 ? 0 : pieces;
        round->added += pieces - 1;
    }
}

/* What comes between samples. */
static void place_added(iso_vec2 *flat, const round_of *round, const samples *s, const chart *map) {
    for (int64_t i = 0; i < s->count; i++) {
        if (round->pieces[i] == 0)
            continue;
        iso_vec2 step = sample_step(map, s->flat[i], s->flat[i + 1]);
        for (int32_t k = 1; k < round->pieces[i]; k++) {
            double t = (double)k / round->pieces[i];
            *flat++ = (iso_vec2){s->flat[i].x + t * step.x, s->flat[i].y + t * step.y};
        }
    }
}

static void merge(samples *to, int32_t *pieces, const round_of *round, const samples *s,
                  const samples *added) {
    int64_t n = 0, taken = 0;
    for (int64_t i = 0; i < s->count; i++) {
        to->flat[n] = s->flat[i];
        to->point[n] = s->point[i];
        to->owner[n] = s->owner[i];
        pieces[n++] = round->pieces[i];
        for (int32_t k = 1; k < round->pieces[i]; k++, taken++) {
            to->flat[n] = added->flat[taken];
            to->point[n] = added->point[taken];
            to->owner[n] = s->owner[i];
            pieces[n++] = 1; /* to be looked at */
        }
    }
}

static iso_status push_samples(samples *s, int64_t count, iso_arena *arena) {
    s->count = count;
    ISO_TRY(ISO_PUSH(s->flat, arena, count));
    ISO_TRY(ISO_PUSH(s->point, arena, count));
    return ISO_PUSH(s->owner, arena, count);
}

static iso_status add_samples(samples *s, round_of *round, const chart *map,
                              const sample_limits *limits, iso_arena *arena) {
    samples to, added;
    int32_t *pieces;
    ISO_TRY(push_samples(&to, s->count + round->added, arena));
    ISO_TRY(ISO_PUSH(pieces, arena, to.count));
    iso_arena_mark mark = iso_arena_get_mark(arena);
    ISO_TRY(push_samples(&added, round->added, arena));
    place_added(added.flat, round, s, map);
    ISO_TRY(chart_layer(added.point, map, added.flat, limits->layer, added.count));
    merge(&to, pieces, round, s, &added);
    iso_arena_pop(arena, mark);
    *s = to;
    round->pieces = pieces;
    return ISO_OK;
}

iso_status sample_refine(samples *s, const chart *map, const sample_limits *limits,
                         iso_arena *arena) {
    round_of round = {0};
    ISO_TRY(ISO_PUSH(s->point, arena, s->count));
    ISO_TRY(ISO_PUSH(round.pieces, arena, s->count));
    ISO_TRY(chart_layer(s->point, map, s->flat, limits->layer, s->count));
    for (; round.number < ROUNDS_MOST; round.number++) {
        count_pieces(&round, s, map, limits);
        if (round.added == 0)
            break;
        ISO_TRY(add_samples(s, &round, map, limits, arena));
    }
    return ISO_OK;
}

/* ---- spreading ---- */

/* Closer than this share of a piece to a sample, that sample will do. */
static const double close_by = 0.1;

/* Samples that are to come after others. */
typedef struct spread {
    samples added;
    int64_t *after; /* [added.count] */
    uint8_t *keep;  /* [samples] of those that are there */
    double *need;   /* [samples] of the piece that begins there */
} spread;

/* Between samples `begin` and `end`, `pieces` of the same need, `each`. */
static void spread_line(spread *to, const samples *s, const chart *map, const int64_t ends[2],
                        double each) {
    double done = 0, next = each;
    for (int64_t i = ends[0]; i < ends[1]; i++) {
        double need = to->need[i];
        for (; next < done + need && need > 0; next += each) {
            double t = (next - done) / need;
            if (t < close_by || t > 1 - close_by) {
                to->keep[t < 0.5 ? i : i + 1] = 1;
                continue;
            }
            iso_vec2 step = sample_step(map, s->flat[i], s->flat[i + 1]);
            to->added.flat[to->added.count] =
                (iso_vec2){s->flat[i].x + t * step.x, s->flat[i].y + t * step.y};
            to->after[to->added.count++] = i;
        }
        done += need;
    }
}

static int64_t line_end(const samples *s, int64_t i) {
    int64_t end = i + 1;
    while (s->owner[end] == s->owner[i])
        end++;
    return end;
}

static int64_t measure_needs(spread *to, const samples *s, const chart *map,
                             const sample_limits *limits) {
    int64_t most = 0;
    for (int64_t i = 0; i < s->count; i++) {
        to->keep[i] = sample_is_last(s, i) || i == 0 || s->owner[i] != s->owner[i - 1];
        to->need[i] = 0;
        if (sample_is_last(s, i) || (to->keep[i] && s->owner[i + 1] != s->owner[i]))
            continue;
        to->need[i] = need_of(&s->point[i], &s->point[i + 1], map, limits);
        most += (int64_t)to->need[i] + 2;
    }
    return most;
}

/* The last of several pieces mustn't fail by what rounding adds to the sum of their needs. */
static void spread_lines(spread *to, const samples *s, const chart *map) {
    for (int64_t i = 0; i < s->count; i++) {
        if (sample_is_last(s, i))
            continue;
        int64_t end = line_end(s, i);
        double sum = 0;
        for (int64_t k = i; k < end; k++)
            sum += to->need[k];
        double pieces = ceil(sum / enough);
        if (pieces > 1)
            spread_line(to, s, map, (int64_t[2]){i, end}, sum / pieces * (1 + 1e-9));
        i = end - 1;
    }
}

static void merge_spread(samples *all, const samples *s, const spread *from) {
    int64_t n = 0, taken = 0;
    for (int64_t i = 0; i < s->count; i++) {
        all->flat[n] = s->flat[i];
        all->point[n] = s->point[i];
        all->owner[n] = s->owner[i];
        all->keep[n++] = from->keep[i];
        for (; taken < from->added.count && from->after[taken] == i; taken++) {
            all->flat[n] = from->added.flat[taken];
            all->point[n] = from->added.point[taken];
            all->owner[n] = s->owner[i];
            all->keep[n++] = 1;
        }
    }
}

iso_status sample_spread(samples *s, const chart *map, const sample_limits *limits,
                         iso_arena *arena) {
    spread to;
    samples all;
    ISO_TRY(ISO_PUSH(to.keep, arena, s->count));
    ISO_TRY(ISO_PUSH(to.need, arena, s->count));
    int64_t most = measure_needs(&to, s, map, limits);
    ISO_TRY(push_samples(&to.added, most, arena));
    ISO_TRY(ISO_PUSH(to.after, arena, most));
    to.added.count = 0;
    spread_lines(&to, s, map);
    ISO_TRY(chart_layer(to.added.point, map, to.added.flat, limits->layer, to.added.count));
    ISO_TRY(push_samples(&all, s->count + to.added.count, arena));
    ISO_TRY(ISO_PUSH(all.keep, arena, all.count));
    merge_spread(&all, s, &to);
    *s = all;
    return ISO_OK;
}

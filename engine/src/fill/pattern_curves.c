/* Patterns of waves that run side by side: line, honeycomb, 3dhoneycomb, gyroid. All are drawn in
 * the clip's frame, in units, from before the region to behind it. */
#include <math.h>

#include "base/angle.h"
#include "fill/pattern.h"

static const double pi = 3.14159265358979323846;

/* ---- line ---- */

/* Lines that lean to and fro, so that neighbours nearly meet and part again. A wave instead of one
 * slope from end to end keeps its place whatever the region's size. */
void iso_pattern_line(iso_clip *clip, const iso_fill_options *options) {
    enum { HALF_WAVE = 16 }; /* spacings */
    double min[2], max[2], half = HALF_WAVE * options->spacing;
    double swing = options->spacing - iso_pattern_bead(options), slope = swing / half;
    double spacing = options->spacing * sqrt(1 + slope * slope); /* leaning lines are longer */
    iso_clip_extent(min, max, clip);
    double from = floor(min[0] / half) - 1, to = ceil(max[0] / half) + 1;
    for (double k = floor(min[1] / spacing) - 1; k <= ceil(max[1] / spacing) + 1; k++)
        for (double i = from; i <= to; i++) {
            double v = k * spacing + (fmod(fabs(i + k), 2) == 0 ? swing : -swing) / 2;
            (i == from ? iso_clip_move : iso_clip_draw)(clip, i * half, v);
        }
}

/* ---- honeycomb ---- */

/* Column k runs up between two neighbouring lines of upright walls and bends to each in turn, so
 * that upright walls are drawn twice, side by side, and slanted ones once. With sides a, columns
 * w = sqrt 3 / 2 a apart and beads s apart, a period of 3 a has the length
 *     3 a + 2 (w - s) / sqrt 3 = 4 a - 2 s / sqrt 3,
 * of which the density d = s length / (3 a w) gives a. A cell's middle is on the origin. */
void iso_pattern_honeycomb(iso_clip *clip, const iso_fill_options *options) {
    double d = options->density, s = iso_pattern_bead(options), root = sqrt(3);
    double a = s * (4 + sqrt(16 - 12 * d)) / (3 * root * d), w = root / 2 * a;
    double upright = 1.5 * a - (w - s) / root, min[2], max[2];
    iso_clip_extent(min, max, clip);
    double from = floor(min[1] / (1.5 * a)) - 1, to = ceil(max[1] / (1.5 * a)) + 1;
    for (double k = floor(min[0] / w) - 1; k <= ceil(max[0] / w); k++)
        for (double i = from; i <= to; i++) { /* walls stand where i + the line's number is odd */
            int right = fmod(fabs(i + k), 2) == 0;
            double u = right ? (k + 1) * w - s / 2 : k * w + s / 2;
            (i == from ? iso_clip_move : iso_clip_draw)(clip, u, 1.5 * a * i - upright / 2);
            iso_clip_draw(clip, u, 1.5 * a * i + upright / 2);
        }
}

/* ---- 3dhoneycomb ---- */

typedef struct turned {
    iso_clip *clip;
    int swap;
} turned;

static void begin(const turned *to, double u, double v) {
    iso_clip_move(to->clip, to->swap ? v : u, to->swap ? u : v);
}

static void go_on(const turned *to, double u, double v) {
    iso_clip_draw(to->clip, to->swap ? v : u, to->swap ? u : v);
}

static void find_range(double range[4], const turned *to) {
    double min[2], max[2];
    iso_clip_extent(min, max, to->clip);
    range[0] = min[to->swap], range[1] = max[to->swap];
    range[2] = min[!to->swap], range[3] = max[!to->swap];
}

/* Truncated octahedra, two kinds of places on a chessboard of squares p wide. At height z their
 * walls are p / 2 + b and p / 2 - b from the middles, b = p / 4 (1 - 4 |z| / l) with the period
 * l = sqrt 2 p, and slanted walls join those across the corners of the squares. Layers take turns
 * in drawing the rows and the columns. A wave is longer than straight by 2 (sqrt 2 - 1) |b| / p. */
void iso_pattern_honeycomb_3d(iso_clip *clip, const iso_fill_options *options) {
    double p = options->spacing * (1 + (sqrt(2) - 1) / 4), l = sqrt(2) * p;
    double height = fmod(options->z, l), range[4];
    double b = p / 4 * (1 - 4 * fmin(height, l - height) / l), half = fabs(b);
    turned to = {clip, options->layer & 1};
    find_range(range, &to);
    double from = floor(range[0] / p) - 1, end = ceil(range[1] / p) + 1;
    for (double k = floor(range[2] / p) - 1; k <= ceil(range[3] / p); k++)
        for (double i = from; i <= end; i++) {
            double v = (k + 0.5) * p + (fmod(fabs(i + k), 2) == 0 ? b : -b);
            (i == from ? begin : go_on)(&to, (i - 0.5) * p + half, v);
            go_on(&to, (i + 0.5) * p - half, v);
        }
}

/* ---- gyroid ---- */

static double arctangent(double x) {
    if (x < 0)
        return -arctangent(-x);
    if (x > 1)
        return pi / 2 - arctangent(1 / x);
    x /= 1 + sqrt(1 + x * x); /* twice half the angle: at most pi / 16 */
    x /= 1 + sqrt(1 + x * x);
    double square = x * x, sum = 0;
    for (int i = 10; i >= 0; i--)
        sum = 1.0 / (2 * i + 1) - square * sum;
    return 4 * x * sum;
}

/* The gyroid sin x cos y + sin y cos z + sin z cos x = 0 at a height z. Where |cos z| >= |sin z|,
 * sin x cos y + cos z sin y = - sin z cos x has two solutions y for each x; elsewhere
 * sin z cos x + cos y sin x = - cos z sin y has two solutions x for each y. Both are
 *     a cos t + b sin t = c,   t = arg (a, b) +- arccos (c / |(a, b)|). */
typedef struct gyroid {
    double sine, cosine; /* of z */
    int swap;            /* x for each y */
} gyroid;

static double gyroid_at(const gyroid *g, double x, int second) {
    double s, c, turn, a, b, k;
    iso_sine_cosine(&s, &c, x * (180 / pi));
    if (g->swap) {
        a = g->sine, b = c, k = -g->cosine * s;
        turn = arctangent(b / a) + (a < 0 ? pi : 0);
    } else {
        a = s, b = g->cosine, k = -g->sine * c;
        turn = (b < 0 ? -pi / 2 : pi / 2) - arctangent(a / b);
    }
    double rest = a * a + b * b - k * k;
    double apart = rest > 0 ? pi / 2 - arctangent(k / sqrt(rest)) : k < 0 ? pi : 0;
    return turn + (second ? -apart : apart);
}

enum { SAMPLES_MAX = 512 };

typedef struct wave {
    int32_t count;
    double x[SAMPLES_MAX + 1], y[SAMPLES_MAX + 1];
} wave;

/* Is all between samples i and j within the tolerance of the chord? */
static int is_flat(const wave *w, int32_t i, int32_t j, double tolerance) {
    double dx = w->x[j] - w->x[i], dy = w->y[j] - w->y[i];
    double most = tolerance * sqrt(dx * dx + dy * dy);
    for (int32_t k = i + 1; k < j; k++)
        if (fabs(dx * (w->y[k] - w->y[i]) - dy * (w->x[k] - w->x[i])) > most)
            return 0;
    return 1;
}

/* One period, its first point repeated at the end: samples so close that they are true to a sixth
 * of the tolerance, and of those the fewest that keep to it. */
static void find_wave(wave *w, const gyroid *g, int second, double tolerance) {
    int32_t samples = (int32_t)(2 * pi / sqrt(0.9 * tolerance)) + 8, kept = 0;
    samples = samples < SAMPLES_MAX ? samples : SAMPLES_MAX;
    for (int32_t i = 0; i <= samples; i++) {
        w->x[i] = 2 * pi * i / samples;
        w->y[i] = gyroid_at(g, i < samples ? w->x[i] : 0, second);
    }
    for (int32_t i = 0, j; i < samples; i = j) {
        for (j = i + 1; j < samples && is_flat(w, i, j + 1, tolerance); j++) {
        }
        kept++;
        w->x[kept] = w->x[j]; /* kept <= j: nothing still needed is lost */
        w->y[kept] = w->y[j];
    }
    w->count = kept + 1;
}

/* 0.391315 is the mean length of the curves on unit area, over all heights, in frames where the
 * period is 2 pi: so much bead per area as the density says. */
void iso_pattern_gyroid(iso_clip *clip, const iso_fill_options *options) {
    enum { TOLERANCE = 200 }; /* units: 20 um */
    double scale = 0.391315 * options->spacing, period = 2 * pi * scale, range[4];
    gyroid g;
    iso_sine_cosine(&g.sine, &g.cosine, options->z / scale * (180 / pi));
    g.swap = fabs(g.cosine) < fabs(g.sine);
    turned to = {clip, g.swap};
    find_range(range, &to);
    for (int second = 0; second < 2; second++) {
        wave w;
        find_wave(&w, &g, second, TOLERANCE / scale);
        for (double k = floor(range[2] / period) - 1; k <= ceil(range[3] / period) + 1; k++) {
            double from = floor(range[0] / period) - 1, end = ceil(range[1] / period);
            begin(&to, from * period, k * period + w.y[0] * scale);
            for (double i = from; i <= end; i++)
                for (int32_t n = 1; n < w.count; n++)
                    go_on(&to, i * period + w.x[n] * scale, k * period + w.y[n] * scale);
        }
    }
}

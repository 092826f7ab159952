/* Patterns of a single curve: hilbertcurve, archimedeanchords, octagramspiral. */
#include <math.h>

#include "base/angle.h"
#include "fill/pattern.h"

/* ---- hilbertcurve ---- */

typedef struct hilbert {
    iso_clip *clip;
    double spacing;
    int64_t low[2], high[2]; /* cells that matter */
    int64_t origin;          /* x and y of the cell on the frame's origin */
    int broken;
} hilbert;

/* The square from a corner along u and v, on both of which it is 2^level cells wide: the curve
 * enters in the corner and leaves at the end of u. (Hilbert 1891.) */
typedef struct square {
    int64_t x, y, ux, uy, vx, vy;
} square;

static int matters(const hilbert *h, const square *q) {
    int64_t x = q->x + q->ux + q->vx, y = q->y + q->uy + q->vy;
    int64_t left = q->x < x ? q->x : x, right = q->x < x ? x : q->x;
    int64_t below = q->y < y ? q->y : y, above = q->y < y ? y : q->y;
    return right > h->low[0] && left < h->high[0] && above > h->low[1] && below < h->high[1];
}

static void draw_square(hilbert *h, const square *q, int level) {
    if (!matters(h, q)) {
        h->broken = 1;
        return;
    }
    if (level == 0) { /* in half cells */
        double x = (double)(q->x + (q->ux + q->vx) / 2 - h->origin) / 2 * h->spacing;
        double y = (double)(q->y + (q->uy + q->vy) / 2 - h->origin) / 2 * h->spacing;
        (h->broken ? iso_clip_move : iso_clip_draw)(h->clip, x, y);
        h->broken = 0;
        return;
    }
    int64_t ux = q->ux / 2, uy = q->uy / 2, vx = q->vx / 2, vy = q->vy / 2;
    const square quarter[4] = {
        {q->x, q->y, vx, vy, ux, uy},
        {q->x + vx, q->y + vy, ux, uy, vx, vy},
        {q->x + vx + ux, q->y + vy + uy, ux, uy, vx, vy},
        {q->x + vx + 2 * ux, q->y + vy + 2 * uy, -vx, -vy, -ux, -uy},
    };
    for (int i = 0; i < 4; i++)
        draw_square(h, &quarter[i], level - 1);
}

/* One curve for any region that may come. The origin is a third of the way in, where no line
 * between large squares passes near, since across those the curve hardly ever goes. */
void iso_pattern_hilbert(iso_clip *clip, const iso_fill_options *options) {
    double min[2], max[2], reach = 8.0 * ISO_COORDINATE_MAX;
    hilbert h = {.clip = clip, .spacing = options->spacing, .broken = 1};
    int level = 1;
    while (ldexp(options->spacing, level) < 4 * reach && level < 30)
        level++;
    int64_t side = (int64_t)2 << level; /* coordinates count half cells */
    h.origin = side / 3 & ~(int64_t)1;
    iso_clip_extent(min, max, clip);
    for (int i = 0; i < 2; i++) {
        h.low[i] = h.origin + 2 * ((int64_t)floor(min[i] / options->spacing) - 1);
        h.high[i] = h.origin + 2 * ((int64_t)ceil(max[i] / options->spacing) + 1);
    }
    draw_square(&h, &(square){0, 0, side, 0, 0, side}, level);
}

/* ---- archimedeanchords ---- */

/* How near and how far the box of the region is from the origin. */
static void find_distances(double *nearest, double *furthest, const iso_clip *clip) {
    double min[2], max[2], low = 0, high = 0;
    iso_clip_extent(min, max, clip);
    for (int i = 0; i < 2; i++) {
        double beside = min[i] > 0 ? min[i] : max[i] < 0 ? -max[i] : 0;
        double beyond = -min[i] > max[i] ? -min[i] : max[i];
        low += beside * beside;
        high += beyond * beyond;
    }
    *nearest = sqrt(low);
    *furthest = sqrt(high);
}

void iso_pattern_archimedean(iso_clip *clip, const iso_fill_options *options) {
    enum { TOLERANCE = 150, CHORDS_MIN = 12 };
    double nearest, furthest, spacing = options->spacing;
    find_distances(&nearest, &furthest, clip);
    double from = fmax(floor(nearest / spacing) - 2, 0), to = ceil(furthest / spacing) + 1;
    iso_clip_move(clip, from * spacing, 0);
    for (double turn = from; turn < to; turn++) {
        double radius = (turn + 1) * spacing;
        int32_t chords = (int32_t)(3.14159 * sqrt(radius / (2 * TOLERANCE)));
        chords = chords < CHORDS_MIN ? CHORDS_MIN : chords;
        double s, c, x = 1, y = 0;
        iso_sine_cosine(&s, &c, 360.0 / chords);
        for (int32_t i = 1; i <= chords; i++) {
            double r = (turn + (double)i / chords) * spacing, next = x * c - y * s;
            y = x * s + y * c;
            x = next;
            iso_clip_draw(clip, r * (i == chords ? 1 : x), r * (i == chords ? 0 : y));
        }
    }
}

/* ---- octagramspiral ---- */

/* A star of eight points after another, all edges of it as long as the radius to its inner
 * corners, sqrt 2 spacings larger each: so they are a spacing apart. */
void iso_pattern_octagram(iso_clip *clip, const iso_fill_options *options) {
    const double diagonal = sqrt(0.5);
    double nearest, furthest, step = options->spacing / diagonal;
    find_distances(&nearest, &furthest, clip);
    double from = fmax(floor(nearest / (2 * step)) - 2, 0), to = ceil(furthest / step) + 1;
    iso_clip_move(clip, from * step, 0);
    for (double turn = from > 0 ? from : 1; turn <= to; turn++) {
        double r = turn * step, in = r * diagonal, out = r + in;
        double point[4][2] = {{r, 0}, {out, in}, {in, in}, {in, out}};
        for (int quarter = 0; quarter < 4; quarter++)
            for (int i = 0; i < 4; i++) {
                double x = point[i][0], y = point[i][1], swap = x;
                point[i][0] = -y; /* for the next quarter */
                point[i][1] = swap;
                int last = quarter == 3 && i == 3; /* reaches out to the next star */
                iso_clip_draw(clip, x + (last ? step : 0), y);
            }
    }
}

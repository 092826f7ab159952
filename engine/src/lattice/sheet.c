#include "lattice/sheet.h"

#include <math.h>
#include <stdbool.h>

#include "lattice/contour.h"

/* Net widths, in usual ones. A sheet is as thick as its section is wide where it stands upright;
 * elsewhere the section is wider, by 1.27 on average. */
#define LEAST 0.35
#define MOST 2.2
#define THICKEST 1.15 /* of a sheet that one line is drawn for */
/* Of the width of a bead: its line's tolerance, and how much the width may change before the piece
 * of line with that width ends. */
#define TOLERANCE (1.0 / 24)
#define WIDTH_CHANGE 0.25

/* Of the usual width: how far the width that is told may be off, so that not every piece has to
 * tell its own. Sections are exact. */
#define WIDTH_TOLD 0.2

sheet_bead sheet_bead_of(const iso_fill_options *fill) {
    const double corners = 0.21460183660255172; /* 1 - pi / 4 */
    double w = fill->width, rest = w * w - 4 * corners * fill->area;
    double height = rest <= 0 ? w : (w - sqrt(rest)) / (2 * corners);
    double net = fill->area / height, tolerance = TOLERANCE * w;
    return (sheet_bead){.height = height,
                        .usual = net,
                        .least = LEAST * net,
                        .most = MOST * net,
                        .corners = corners * height,
                        .told = WIDTH_TOLD * net,
                        .tolerance = fill->deviation > tolerance ? fill->deviation : tolerance};
}

/* mm; of half a sheet, for so many lines side by side. */
static double limit_of(const sheet_bead *bead, int lines) {
    return lines * THICKEST * bead->usual / (2 * ISO_UNITS_PER_MM);
}

/* Between neighbouring samples, a step apart, distances differ by no more steps than this. */
#define FAR_STEPS 2

/* Zones whose lines would hold less or more than their section by such a factor aren't for lines.
 */
#define SCALE_LEAST 0.75
#define SCALE_MOST 1.15
/* Where sheets that take several lines fill more than this, pores are about as narrow as beads, and
 * lines of one sheet lie over those of the next. */
#define SEVERAL_MOST 0.65

typedef struct drawing {
    const samples *samples;
    const sheet_bead *bead;
    const iso_fill_options *fill;
    iso_paths *out;
    iso_clip *clip;
    iso_arena *scratch;
    int lines, line;       /* the one at hand of so many side by side */
    double *value, *width; /* rows: two in turn, or one for each that is kept */
    uint8_t *ready;        /* of those: is it filled in? */
    double scale;          /* of widths, so that volumes come out true */
} drawing;

static double thin_limit(const drawing *d) {
    return d->lines == 1 ? 0 : limit_of(d->bead, d->lines - 1);
}

/* ---- samples to lines ---- */

/* How far from a line with slope g > 0 and bend c across it its strip ends, where the distance is h
 * more: or where it turns back, half way to another line. */
static double reach_of(double g, double c, double h) {
    double rest = g * g + 2 * c * h;
    return rest >= 0 ? 2 * h / (g + sqrt(rest)) : -g / c;
}

/* How wide the strip is, in steps, that holds all within h of the distance at column i, as far as
 * it is nearer to this line than to another: by the distance's slope and how that changes across
 * the line and along it. Lines cross where the slope is 0. `at` are the rows below, at hand and
 * above. */
static double strip_width(const float *const at[3], const int32_t column[3], double h) {
    int32_t w = column[0], i = column[1], e = column[2];
    double gx = ((double)at[1][e] - at[1][w]) / 2, gy = ((double)at[2][i] - at[0][i]) / 2;
    double xx = (double)at[1][e] + at[1][w] - 2 * (double)at[1][i];
    double yy = (double)at[2][i] + at[0][i] - 2 * (double)at[1][i];
    double xy = (((double)at[2][e] - at[2][w]) - ((double)at[0][e] - at[0][w])) / 4;
    double square = gx * gx + gy * gy, g = sqrt(square);
    if (!(square > 1e-12 * h * h))
        return HUGE_VAL;
    double c = (gx * gx * xx + 2 * gx * gy * xy + gy * gy * yy) / square;
    double twist = fabs((gx * gx - gy * gy) * xy + gx * gy * (yy - xx)) / square;
    double left = reach_of(g, c, h), right = reach_of(g, -c, h);
    return (left * twist < g ? left : g / twist) + (right * twist < g ? right : g / twist);
}

/* value: 0 on the line. width: that of the strip of section along it, in units, before any limits
 * of the nozzle's; below 0 where there is no such line. */
static void fill_row(const drawing *d, int32_t j, double *value, double *width) {
    const samples *s = d->samples;
    int32_t columns = s->raster.columns, last = columns - 1;
    bool first = j == 0 && !s->repeats, end = j + 1 == s->raster.rows && !s->repeats;
    const float *const at[3] = {samples_distance(s, first ? j : j + s->period - 1),
                                samples_distance(s, j), samples_distance(s, end ? j : j + 1)};
    const float *half = samples_half(s, j);
    int32_t before = s->repeats ? s->period - 1 : 0; /* column 0 */
    double place = (2 * d->line - d->lines + 1) / (double)d->lines;
    double thin = thin_limit(d), thick = limit_of(d->bead, d->lines);
    int32_t own = s->repeats ? s->period : columns;
    double far = FAR_STEPS * s->plane.step;
    for (int32_t i = 0; i < own; i++) {
        double h = half[i];
        value[i] = at[1][i] - place * h;
        width[i] = -1;
        if (!(h > thin && h <= thick))
            continue;
        width[i] = d->bead->most;
        if (fabs(value[i]) > far) /* no crossing is next to it */
            continue;
        int32_t column[3] = {i > 0 ? i - 1 : before, i, i < last ? i + 1 : i};
        double wide = strip_width(at, column, h / d->lines) * s->raster.step;
        width[i] = wide < d->bead->most ? wide : d->bead->most;
    }
    for (int32_t i = own; i < columns; i++) {
        value[i] = value[i - own];
        width[i] = width[i - own];
    }
}

static void row(contour_row *out, void *context, int32_t j) {
    drawing *d = context;
    int32_t columns = d->samples->raster.columns;
    int32_t slot = d->samples->repeats ? j % d->samples->period : j & 1;
    double *value = d->value + (int64_t)slot * columns;
    double *width = d->width + (int64_t)slot * columns;
    if (!d->samples->repeats || !d->ready[slot])
        fill_row(d, j, value, width);
    d->ready[slot] = 1;
    *out = (contour_row){value, width};
}

/* ---- lines to beads ---- */

typedef struct strand { /* a curve, cut down to where there is a line */
    int32_t count;
    double *x, *y, *width; /* units */
    uint8_t *square;       /* of the piece from each point on: inside or at the boundary? */
} strand;

typedef struct beads { /* of a strand, thinned */
    int32_t count;
    iso_point *point;
    iso_weave_bead *bead; /* of the piece to each point */
    uint8_t *square;
} beads;

static double length_of(const strand *s, int32_t i) {
    double dx = s->x[i + 1] - s->x[i], dy = s->y[i + 1] - s->y[i];
    return sqrt(dx * dx + dy * dy);
}

static iso_weave_bead bead_of(const drawing *d, double width, int32_t told) {
    const sheet_bead *bead = d->bead;
    width *= d->scale;
    width = width > bead->least ? width : bead->least;
    double full = width + bead->corners;
    if (fabs(full - told) > bead->told)
        told = (int32_t)(full + 0.5);
    return (iso_weave_bead){told, (int32_t)(width * bead->height + 0.5)};
}

static iso_point rounded(double x, double y) {
    return (iso_point){(int32_t)floor(x + 0.5), (int32_t)floor(y + 0.5)};
}

/* The directions from a point that pass by all others so far within the tolerance (Williams 1978;
 * Sklansky and Gonzalez 1980). */
typedef struct wedge {
    double left[2], right[2];
    int narrow; /* has any bounds */
} wedge;

static double cross_of(const double a[2], const double b[2]) {
    return a[0] * b[1] - a[1] * b[0];
}

static bool admits(const wedge *w, const double v[2]) {
    return !w->narrow || (cross_of(w->right, v) >= 0 && cross_of(v, w->left) >= 0);
}

static void tighten(wedge *w, const double v[2], double tolerance) {
    double r = sqrt(v[0] * v[0] + v[1] * v[1]);
    if (r <= tolerance)
        return;
    double part = tolerance / r;
    double left[2] = {v[0] - part * v[1], v[1] + part * v[0]};
    double right[2] = {v[0] + part * v[1], v[1] - part * v[0]};
    if (!w->narrow || cross_of(left, w->left) > 0)
        memcpy(w->left, left, sizeof left);
    if (!w->narrow || cross_of(w->right, right) > 0)
        memcpy(w->right, right, sizeof right);
    w->narrow = 1;
}

/* How far a straight piece may go from point i of a strand. */
static int32_t piece_end(const drawing *d, const strand *s, int32_t i) {
    wedge w = {.narrow = 0};
    double change = WIDTH_CHANGE * d->bead->usual;
    int32_t j = i + 1;
    for (;; j++) {
        double v[2] = {s->x[j] - s->x[i], s->y[j] - s->y[i]};
        if (j > i + 1 && (!admits(&w, v) || fabs(s->width[j] - s->width[i]) > change))
            return j - 1;
        if (j + 1 == s->count)
            return j;
        tighten(&w, v, d->bead->tolerance);
    }
}

static void thin(beads *out, const drawing *d, const strand *s) {
    out->point[0] = rounded(s->x[0], s->y[0]);
    out->count = 1;
    for (int32_t i = 0, j; i + 1 < s->count; i = j) {
        double volume = 0;
        uint8_t square = RASTER_INSIDE;
        j = piece_end(d, s, i);
        for (int32_t k = i; k < j; k++) {
            volume += (s->width[k] + s->width[k + 1]) / 2 * length_of(s, k);
            square = s->square[k] > square ? s->square[k] : square;
        }
        double dx = s->x[j] - s->x[i], dy = s->y[j] - s->y[i], chord = sqrt(dx * dx + dy * dy);
        int32_t n = out->count++;
        out->point[n] = rounded(s->x[j], s->y[j]);
        out->bead[n] = bead_of(d, chord > 0 ? volume / chord : 0,
                               n > 1 ? out->bead[n - 1].width : d->fill->width);
        out->square[n] = square;
    }
}

/* ---- drawing ---- */

static iso_status draw_closed(const drawing *d, const beads *b) {
    iso_path like = d->fill->like;
    iso_paths *out = d->out;
    like.closed = 1;
    ISO_TRY(iso_paths_add(out, &like, b->point, b->count - 1, d->fill->width, d->fill->area));
    iso_path_vertex *vertex = out->vertex + out->path[out->count - 1].first;
    for (int32_t i = 0; i + 1 < b->count; i++) {
        vertex[i].width = b->bead[i + 1].width;
        vertex[i].area = b->bead[i + 1].area;
    }
    return ISO_OK;
}

/* From point `first` on, around if it is closed. */
static void clip_beads(const drawing *d, const beads *b, int32_t first) {
    iso_clip *clip = d->clip;
    int32_t pieces = b->count - 1;
    int32_t beside = first + 1 < b->count ? first + 1 : 1;
    (b->square[beside] == RASTER_INSIDE ? iso_clip_move_within : iso_clip_move_to)(clip,
                                                                                   b->point[first]);
    for (int32_t k = 0, i = first; k < pieces; k++) {
        i = i == pieces ? 1 : i + 1;
        clip->bead = b->bead[i];
        (b->square[i] == RASTER_INSIDE ? iso_clip_draw_within : iso_clip_draw_to)(clip,
                                                                                  b->point[i]);
    }
}

/* A closed curve is best begun where it is outside, lest it be cut in two there. */
static int32_t outside_of(const drawing *d, const beads *b) {
    for (int32_t i = 1; i < b->count; i++)
        if (b->square[i] != RASTER_INSIDE && !iso_clip_holds(d->clip, b->point[i]))
            return i;
    return 0;
}

static iso_status draw_strand(const drawing *d, const strand *s, beads *b, bool closed) {
    if (s->count < 2)
        return ISO_OK;
    thin(b, d, s);
    bool inside = closed;
    for (int32_t i = 1; i < b->count && inside; i++)
        inside = b->square[i] == RASTER_INSIDE;
    if (inside && b->count > 3)
        return draw_closed(d, b);
    if (inside)
        return ISO_OK; /* less than a dot */
    clip_beads(d, b, closed ? outside_of(d, b) : 0);
    return d->clip->status;
}

static strand room_from(const strand *all, int32_t i) {
    return (strand){0, all->x + i, all->y + i, all->width + i, all->square + i};
}

/* A curve of the contour as it is, in units; a closed one has its first point at its end again. */
static void read_curve(strand *s, const drawing *d, const contour *c, int32_t start, bool closed) {
    const raster *r = &d->samples->raster;
    int32_t k = 0, i = start;
    for (const contour_crossing *at; (at = contour_step(c, &i)); k++) {
        s->x[k] = r->x + at->x * r->step;
        s->y[k] = r->y + at->y * r->step;
        s->width[k] = at->extra;
        s->square[k] = at->next >= 0 ? r->square[at->square] : RASTER_BOUNDARY;
    }
    if (closed) {
        s->x[k] = s->x[0];
        s->y[k] = s->y[0];
        s->width[k] = s->width[0];
        s->square[k++] = RASTER_BOUNDARY;
    }
    s->count = k;
}

static iso_status draw_curves(const drawing *d, contour *c, strand *s, beads *b) {
    int closed;
    for (int32_t start; (start = contour_start(c, &closed)) >= 0;) {
        read_curve(s, d, c, start, closed);
        for (int32_t i = 0; i < s->count; i++) {
            strand part = room_from(s, i);
            while (i + part.count < s->count && part.width[part.count] > 0)
                part.count++;
            ISO_TRY(draw_strand(d, &part, b, closed && part.count == s->count));
            i += part.count;
        }
    }
    return ISO_OK;
}

/* ---- volume ---- */

static double drawn_area(const drawing *d, const contour *c, bool all) {
    const raster *r = &d->samples->raster;
    double sum = 0;
    for (int32_t i = 0; i < c->count; i++) {
        const contour_crossing *a = contour_at(c, i);
        if (a->next < 0 || (!all && r->square[a->square] != RASTER_INSIDE))
            continue;
        const contour_crossing *b = contour_at(c, a->next);
        double dx = b->x - a->x, dy = b->y - a->y;
        if (a->extra > 0 && b->extra > 0)
            sum += (a->extra + b->extra) / 2 * sqrt(dx * dx + dy * dy);
    }
    return sum / r->step;
}

typedef struct share { /* in squares of the grid */
    double section, drawn, squares;
} share;

static void add_square(share *sum, const drawing *d, int32_t i, int32_t j) {
    double half = samples_half(d->samples, j)[i];
    if (half > thin_limit(d) && half <= limit_of(d->bead, d->lines)) {
        sum->section += samples_share(d->samples, i, j);
        sum->squares++;
    }
}

/* Of one period, whatever the region. */
static iso_status measure_period(share *sum, drawing *d) {
    int32_t nodes = d->samples->period + 1;
    contour_grid grid = {.columns = nodes, .rows = nodes, .row = row, .context = d};
    for (d->line = 0; d->line < d->lines; d->line++) {
        contour c;
        memset(d->ready, 0, (size_t)d->samples->period);
        iso_arena_mark mark = iso_arena_get_mark(d->scratch);
        ISO_TRY(contour_trace(&c, &grid, d->scratch));
        sum->drawn += drawn_area(d, &c, true);
        iso_arena_pop(d->scratch, mark);
    }
    ISO_TRY(samples_period_share(&sum->section, d->samples, d->scratch));
    sum->squares = (double)d->samples->period * d->samples->period;
    sum->section *= sum->squares;
    return ISO_OK;
}

/* Of the squares inside the region. */
static void measure_squares(share *sum, const drawing *d) {
    const raster *r = &d->samples->raster;
    for (int32_t j = 0; j + 1 < r->rows; j++)
        for (int32_t i = 0; i + 1 < r->columns; i++)
            if (r->square[(int64_t)j * (r->columns - 1) + i] == RASTER_INSIDE)
                add_square(sum, d, i, j);
}

/* ---- all of it ---- */

static iso_status trace_line(contour *c, drawing *d) {
    const raster *r = &d->samples->raster;
    contour_grid grid = {
        .columns = r->columns, .rows = r->rows, .square = r->square, .row = row, .context = d};
    memset(d->ready, 0, (size_t)(d->samples->repeats ? d->samples->period : 2));
    return contour_trace(c, &grid, d->scratch);
}

static iso_status draw_line(drawing *d, contour *c) {
    strand s = {0};
    beads b = {0};
    int64_t points = (int64_t)c->count + 1;
    ISO_TRY(ISO_PUSH(s.x, d->scratch, points));
    ISO_TRY(ISO_PUSH(s.y, d->scratch, points));
    ISO_TRY(ISO_PUSH(s.width, d->scratch, points));
    ISO_TRY(ISO_PUSH(s.square, d->scratch, points));
    ISO_TRY(ISO_PUSH(b.point, d->scratch, points));
    ISO_TRY(ISO_PUSH(b.bead, d->scratch, points));
    ISO_TRY(ISO_PUSH(b.square, d->scratch, points));
    return draw_curves(d, c, &s, &b);
}

/* Where so many lines run side by side. */
static iso_status draw_zone(drawing *d, bool *suits) {
    contour c[SHEET_LINES];
    share sum = {0};
    if (d->samples->repeats)
        ISO_TRY(measure_period(&sum, d));
    for (d->line = 0; d->line < d->lines; d->line++) {
        ISO_TRY(trace_line(&c[d->line], d));
        if (!d->samples->repeats)
            sum.drawn += drawn_area(d, &c[d->line], false);
    }
    if (!d->samples->repeats)
        measure_squares(&sum, d);
    d->scale = sum.drawn > 0 ? sum.section / sum.drawn : 1;
    *suits = d->scale >= SCALE_LEAST && d->scale <= SCALE_MOST &&
             (d->lines == 1 || sum.section <= SEVERAL_MOST * sum.squares);
    if (!*suits)
        return ISO_OK;
    for (int line = 0; line < d->lines; line++)
        ISO_TRY(draw_line(d, &c[line]));
    return ISO_OK;
}

double sheet_limit(const sheet_bead *bead, int lines) {
    return lines > 0 ? limit_of(bead, lines) : 0;
}

iso_status sheet_draw(iso_paths *out, uint32_t *left, const iso_region *region,
                      const samples *taken, const iso_fill_options *fill, iso_arena *scratch) {
    sheet_bead bead = sheet_bead_of(fill);
    iso_clip clip;
    iso_weave weave;
    drawing d = {taken, &bead, fill, out, &clip, scratch, .scale = 1};
    int64_t rows = taken->repeats ? taken->period : 2;
    *left = 0;
    ISO_TRY(iso_clip_begin(&clip, region, 0, (iso_point){0, 0}, scratch));
    clip.has_beads = 1;
    ISO_TRY(ISO_PUSH(d.value, scratch, rows * taken->raster.columns));
    ISO_TRY(ISO_PUSH(d.width, scratch, rows * taken->raster.columns));
    ISO_TRY(ISO_PUSH(d.ready, scratch, rows));
    for (d.lines = 1; d.lines <= SHEET_LINES; d.lines++) {
        bool suits = true;
        if (taken->thick > thin_limit(&d) && taken->thin <= limit_of(&bead, d.lines))
            ISO_TRY(draw_zone(&d, &suits));
        *left |= (uint32_t)!suits << d.lines;
    }
    if (taken->thick > limit_of(&bead, SHEET_LINES))
        *left |= (uint32_t)1 << (SHEET_LINES + 1);
    ISO_TRY(iso_clip_end(&weave, &clip));
    return iso_weave_draw(out, &weave, fill, scratch);
}

#include "fill/flank.h"

#include <stdlib.h>

/* Pieces are at least this many spacings long, and neighbours whose widths differ by less than
 * ALIKE are one. */
#define PIECE_LENGTH 1.5
#define ALIKE 0.04

/* Bounds of a bead's width beside its nominal one: what a nozzle can lay evenly. */
#define NARROWEST 0.6
#define WIDEST 1.4

/* An arc between two lines counts as running along them from this many spacings on. */
#define SLOPE_LENGTH 2.75

enum { NEIGHBOURS = 32 }; /* darts looked at in a cell */

static double along(const iso_sweep *sweep, iso_point p) {
    return ((double)p.x * (double)sweep->cosine + (double)p.y * (double)sweep->sine) / (1 << 30);
}

static int is_between(const iso_flanks *f, int32_t segment, double a, double b) {
    const iso_crossing *end = f->hatch->crossing + 2 * segment;
    double from = along(f->sweep, end[0].at), to = along(f->sweep, end[1].at);
    return from <= a && a <= to && from <= b && b <= to;
}

/* The segment on the other side of the cell that a valley's arc comes up to, or -1. */
static int32_t facing(const iso_flanks *f, int32_t dart) {
    const iso_fill_link *link = &f->hatch->link;
    int32_t other = link->arc[dart], side = dart & 1, d = dart;
    double a = along(f->sweep, f->hatch->crossing[dart >> 1].at);
    double b = along(f->sweep, f->hatch->crossing[other >> 1].at);
    for (int step = 0; step < NEIGHBOURS; step++) {
        d = link->arc[iso_fill_link_across(d)];
        if (d == dart)
            return -1;
        if ((d & 1) != side && is_between(f, d >> 2, a, b))
            return d >> 2;
    }
    return -1;
}

static double ahead_of(const iso_flanks *f, int32_t dart) {
    const iso_crossing *crossing = f->hatch->crossing;
    return along(f->sweep, crossing[f->hatch->link.arc[dart] >> 1].at) -
           along(f->sweep, crossing[dart >> 1].at);
}

int iso_flanks_run_along(const iso_flanks *f, int32_t dart) {
    return ((f->hatch->link.arc[dart] ^ dart) & 1) &&
           fabs(ahead_of(f, dart)) > SLOPE_LENGTH * f->usual.spacing;
}

/* An arc that runs along its lines lies above the lower one's segment or below that of the upper
 * one. */
static iso_flank slope_at(const iso_flanks *f, int32_t dart) {
    int32_t low = dart >> 1, high = f->hatch->link.arc[dart] >> 1;
    double ahead = ahead_of(f, dart);
    int over_low = (low & 1) == (ahead < 0), under_high = (high & 1) == (ahead > 0);
    if (!iso_flanks_run_along(f, dart) || over_low == under_high)
        return (iso_flank){.segment = -1};
    return over_low ? (iso_flank){low >> 1, dart, 1} : (iso_flank){high >> 1, dart, 0};
}

/* Which segment gives way to the arc that leaves from here? -1 if none. */
static iso_flank flank_at(const iso_flanks *f, int32_t dart) {
    int32_t other = f->hatch->link.arc[dart], above = dart & 1;
    if ((other ^ dart) & 1)
        return above ? slope_at(f, dart) : (iso_flank){.segment = -1};
    if (other < dart)
        return (iso_flank){.segment = -1};
    if (other >> 2 == dart >> 2)
        return (iso_flank){dart >> 2, dart, above};
    if (!((dart >> 1) & 1) || ((other >> 1) & 1))
        return (iso_flank){.segment = -1}; /* around several segments */
    return (iso_flank){facing(f, dart), dart, !above};
}

static int compare_flanks(const void *one, const void *other) {
    const iso_flank *a = one, *b = other;
    if (a->segment != b->segment)
        return a->segment < b->segment ? -1 : 1;
    return (a->dart > b->dart) - (a->dart < b->dart);
}

static int32_t bins_of(const iso_flanks *f, int32_t segment) {
    const iso_crossing *end = f->hatch->crossing + 2 * segment;
    double bins = iso_hatch_distance(end[0].at, end[1].at) / (PIECE_LENGTH * f->usual.spacing);
    return bins < 1 ? 1 : bins > ISO_FLANK_PIECES ? ISO_FLANK_PIECES : (int32_t)bins;
}

iso_status iso_flanks_find(iso_flanks *f, iso_arena *scratch) {
    const iso_fill_part *part = &f->hatch->part;
    int64_t points = 0;
    for (int32_t m = 0; m < part->count; m++)
        points += part->region->first[part->member[m] + 1] - part->region->first[part->member[m]];
    ISO_TRY(ISO_PUSH(f->point, scratch, points));
    ISO_TRY(ISO_PUSH(f->flank, scratch, f->hatch->link.count));
    for (int32_t d = 0; d < 2 * f->hatch->link.count; d++) {
        iso_flank flank = flank_at(f, d);
        if (flank.segment < 0)
            continue;
        f->flank[f->count++] = flank;
        f->pieces += bins_of(f, flank.segment);
    }
    qsort(f->flank, (size_t)f->count, sizeof *f->flank, compare_flanks);
    return ISO_OK;
}

int32_t iso_flanks_of(const iso_flanks *f, int32_t segment) {
    int32_t low = 0, high = f->count;
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (f->flank[middle].segment < segment)
            low = middle + 1;
        else
            high = middle;
    }
    return low < f->count && f->flank[low].segment == segment ? low : -1;
}

/* What is left over beside a line, piece by piece: areas of [0] below and [1] above it, beyond the
 * half spacing that it fills as it is. */
typedef struct bins {
    double left[2][ISO_FLANK_PIECES];
    int32_t count;
    double begin, length; /* along the line; of each bin */
} bins;

/* Add `left` units of height from `from` to `to`, wherever that is. */
static void spread(bins *b, int above, double from, double to, double left) {
    double sign = from < to ? 1 : -1, low = from < to ? from : to, high = from < to ? to : from;
    double end = b->begin + b->length * b->count;
    low = low > b->begin ? low : b->begin;
    high = high < end ? high : end;
    for (int32_t i = (int32_t)((low - b->begin) / b->length); i < b->count && low < high; i++) {
        double next = b->begin + b->length * (i + 1), to_here = next < high ? next : high;
        if (to_here > low)
            b->left[above][i] += sign * left * (to_here - low);
        low = to_here > low ? to_here : low;
    }
}

static void add_flank(bins *b, iso_flanks *f, const iso_flank *flank) {
    const iso_hatch *hatch = f->hatch;
    const iso_sweep *sweep = f->sweep;
    int32_t reach = hatch->link.arc[flank->dart];
    int32_t count = iso_hatch_follow(f->point, hatch, flank->dart, 4.0 * ISO_COORDINATE_MAX);
    if (count < 0)
        return;
    int64_t level = sweep->first + hatch->link.line[2 * flank->segment] * sweep->step;
    double sign = flank->above ? 1 : -1, scale = sign / (double)ISO_SWEEP_ONE;
    iso_point here = hatch->crossing[flank->dart >> 1].at, end = hatch->crossing[reach >> 1].at;
    double u = along(sweep, here), v = scale * (double)(iso_sweep_v(sweep, here) - level);
    int turned = along(sweep, end) < u;
    for (int32_t i = 0; i <= count; i++) {
        iso_point p = i < count ? f->point[i] : end;
        double to_u = along(sweep, p), to_v = scale * (double)(iso_sweep_v(sweep, p) - level);
        double du = fabs(to_u - u), dv = fabs(to_v - v);
        double edge = du > 0 && dv < 1.7 * du ? sqrt(1 + dv * dv / (du * du)) : 2;
        double left = (v + to_v) / 2 + f->margin * edge - f->usual.spacing / 2.0;
        if (turned)
            spread(b, flank->above, to_u, u, left);
        else
            spread(b, flank->above, u, to_u, left);
        u = to_u;
        v = to_v;
    }
}

/* By how much a bead of the usual width is to be wider on either side. */
static void bound(double left[2], const iso_flanks *f) {
    double more = left[0] + left[1], width = f->usual.width + more;
    double least = NARROWEST * f->nominal, most = WIDEST * f->nominal;
    double within = width < least ? least : width > most ? most : width;
    double excess = (within - width) / 2;
    left[0] += excess;
    left[1] += excess;
}

static int32_t rounded(double x) {
    return (int32_t)(x < 0 ? x - 0.5 : x + 0.5);
}

static iso_flank_piece piece_of(const iso_flanks *f, const double left[2]) {
    double more = left[0] + left[1], height = (double)f->usual.area / f->usual.spacing;
    return (iso_flank_piece){.width = f->usual.width + rounded(more),
                             .area = f->usual.area + rounded(more * height)};
}

/* Bounds what is left beside each bin and evens it out over neighbours that are alike. run[i] = the
 * first bin of those that bin i is alike with. */
static void even_out(bins *b, int32_t run[], const iso_flanks *f) {
    double limit = ALIKE * f->nominal;
    for (int32_t i = 0, from = 0; i < b->count; i++) {
        double here[2] = {b->left[0][i] / b->length, b->left[1][i] / b->length};
        bound(here, f);
        if (i > 0 &&
            !(fabs(here[0] - b->left[0][from]) < limit && fabs(here[1] - b->left[1][from]) < limit))
            from = i;
        run[i] = from;
        for (int side = 0; side < 2; side++) /* the mean of the run so far */
            b->left[side][from] += (here[side] - b->left[side][from]) / (i - from + 1);
    }
}

/* Where the middle of the bead passes from bin i - 1 to bin i. */
static iso_point turn_at(const bins *b, const int32_t run[], int32_t i, const iso_flanks *f,
                         const iso_crossing *end) {
    const double *low = b->left[0], *high = b->left[1];
    double up = (high[run[i - 1]] - low[run[i - 1]] + high[run[i]] - low[run[i]]) / 4;
    double t = (double)i / b->count, scale = up / (1 << 30);
    double dx = (double)end[1].at.x - end[0].at.x, dy = (double)end[1].at.y - end[0].at.y;
    return (iso_point){end[0].at.x + rounded(t * dx - scale * (double)f->sweep->sine),
                       end[0].at.y + rounded(t * dy + scale * (double)f->sweep->cosine)};
}

/* Bins to pieces. Within a run of bins that are alike the middle runs along the line, and what it
 * has moved it moves over the first and the last bin. */
static int32_t make_pieces(iso_flank_piece *piece, const iso_flanks *f, bins *b,
                           const iso_crossing *end) {
    int32_t run[ISO_FLANK_PIECES], count = 0;
    even_out(b, run, f);
    for (int32_t i = 1; i <= b->count; i++) {
        int32_t here = run[i - 1];
        if (i < b->count && run[i] == here && i - here > 1 && i + 1 < b->count &&
            run[i + 1] == here)
            continue; /* between two of its own */
        piece[count] = piece_of(f, (double[]){b->left[0][here], b->left[1][here]});
        piece[count++].to = i < b->count ? turn_at(b, run, i, f, end) : end[1].at;
    }
    return count;
}

int32_t iso_flanks_pieces(iso_flank_piece piece[ISO_FLANK_PIECES], iso_flanks *f, int32_t first) {
    int32_t segment = f->flank[first].segment;
    const iso_crossing *end = f->hatch->crossing + 2 * segment;
    bins b;
    b.count = bins_of(f, segment);
    b.begin = along(f->sweep, end[0].at);
    for (int side = 0; side < 2; side++)
        memset(b.left[side], 0, (size_t)b.count * sizeof *b.left[side]);
    b.length = (along(f->sweep, end[1].at) - b.begin) / b.count;
    if (b.length <= 0) {
        *piece = (iso_flank_piece){end[1].at, f->usual.width, f->usual.area};
        return 1;
    }
    for (int32_t i = first; i < f->count && f->flank[i].segment == segment; i++)
        add_flank(&b, f, &f->flank[i]);
    return make_pieces(piece, f, &b, end);
}

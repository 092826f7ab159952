#include "lattice/samples.h"

#include <math.h>

/* Samples a cell, for lines and for sections: struts of the least density worth asking for are a
 * tenth of a cell thick. */
enum { LINE_SAMPLES = 20, SECTION_SAMPLES = 48 };
/* What a period holds is measured in so many times finer steps. */
enum { FINER = 3 };
/* mm; how far a chord between samples of a large cell may lie from its curve: curves there have
 * radii of a quarter of a cell, more or less. */
#define CHORD 0.01
/* mm; no nozzle tells finer steps. */
#define STEP_LEAST 0.01

static double step_of(const iso_lattice_slice *slice, int samples_a_cell) {
    double cell = lattice_smallest_cell(slice->lattice), step = cell / samples_a_cell;
    double chord = sqrt(2 * cell * CHORD);
    if (slice->step > 0)
        return slice->step;
    step = step < chord ? step : chord;
    return step > STEP_LEAST ? step : STEP_LEAST;
}

double samples_line_step(const iso_lattice_slice *slice) {
    return step_of(slice, LINE_SAMPLES);
}

double samples_section_step(const iso_lattice_slice *slice) {
    return step_of(slice, SECTION_SAMPLES);
}

/* The columns of a row that are asked for: where the region is, and their neighbours. */
static int32_t first_column(const raster *r, int32_t j, int32_t *count) {
    int32_t squares = r->columns - 1, low = squares, high = -1;
    for (int32_t k = j - 2; k <= j + 1; k++) {
        if (k < 0 || k >= r->rows - 1)
            continue;
        const uint8_t *square = r->square + (int64_t)k * squares;
        for (int32_t i = 0; i < low; i++)
            if (square[i])
                low = i;
        for (int32_t i = squares - 1; i > high; i--)
            if (square[i])
                high = i;
    }
    low = low > 0 ? low - 1 : 0;
    high = high + 2 < squares ? high + 2 : squares;
    *count = high >= low && low < squares ? high - low + 1 : 0;
    return low;
}

typedef struct taking {
    samples *out;
    double *distance, *half; /* [columns] */
} taking;

static float limited(double x) {
    return (float)(x > SAMPLES_FAR ? SAMPLES_FAR : x > -SAMPLES_FAR ? x : -SAMPLES_FAR);
}

static void take_row(taking *t, int32_t j, int32_t first, int32_t count) {
    samples *s = t->out;
    int32_t columns = s->raster.columns;
    float *distance = s->distance + (int64_t)(j % s->period) * columns;
    float *half = s->half + (int64_t)(j % s->period) * columns;
    if (!s->repeats)
        for (int32_t i = 0; i < columns; i++) {
            distance[i] = (float)SAMPLES_FAR;
            half[i] = 0;
        }
    if (count == 0)
        return;
    lattice_sample_row(t->distance, t->half, s->lattice, &s->plane, j, first, count);
    for (int32_t i = 0; i < count; i++) {
        distance[first + i] = limited(t->distance[i]);
        half[first + i] = limited(t->half[i]);
        if (t->half[i] > -SAMPLES_FAR) {
            s->thin = t->half[i] < s->thin ? t->half[i] : s->thin;
            s->thick = t->half[i] > s->thick ? t->half[i] : s->thick;
        }
    }
    if (s->repeats)
        for (int32_t i = first + count; i < columns; i++) {
            distance[i] = distance[i - s->period];
            half[i] = half[i - s->period];
        }
}

iso_status samples_take(samples *out, const iso_region *region, const iso_lattice_slice *slice,
                        double step, double reach, iso_arena *scratch) {
    const iso_lattice_cell *table = lattice_cell(slice->lattice);
    double cell = lattice_smallest_cell(slice->lattice);
    double origin[2] = {slice->shift.x, slice->shift.y};
    step = cell / ceil(cell / step - 1e-9);
    *out = (samples){.has_sides = table->has_sides, .thin = SAMPLES_FAR, .thick = -SAMPLES_FAR};
    ISO_TRY(raster_make(&out->raster, region, origin, step * ISO_UNITS_PER_MM, reach, scratch));
    const raster *r = &out->raster;
    out->period = r->rows;
    if (lattice_is_uniform(slice->lattice) && table->repeat[0] == table->repeat[1]) {
        double samples_a_period = floor(cell / step + 0.5) * table->repeat[0];
        if (samples_a_period < r->rows && samples_a_period < r->columns) {
            out->period = (int32_t)samples_a_period;
            out->repeats = 1;
        }
    }
    int64_t kept = (int64_t)out->period * r->columns;
    ISO_TRY(ISO_PUSH(out->distance, scratch, kept));
    ISO_TRY(ISO_PUSH(out->half, scratch, kept));
    out->lattice = slice->lattice;
    out->plane = (iso_lattice_plane){
        {(r->x - slice->shift.x) / ISO_UNITS_PER_MM, (r->y - slice->shift.y) / ISO_UNITS_PER_MM},
        step,
        slice->z,
        r->columns,
        r->rows};
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    taking t = {out, NULL, NULL};
    ISO_TRY(ISO_PUSH(t.distance, scratch, r->columns));
    ISO_TRY(ISO_PUSH(t.half, scratch, r->columns));
    for (int32_t j = 0; j < out->period; j++) {
        int32_t count = out->period, first = out->repeats ? 0 : first_column(r, j, &count);
        take_row(&t, j, first, count);
    }
    iso_arena_pop(scratch, mark);
    return ISO_OK;
}

/* The part of a triangle where what is linear on it is at most 0. */
static double triangle_share(double a, double b, double c) {
    int below = (a <= 0) + (b <= 0) + (c <= 0);
    if (below == 0 || below == 3)
        return below / 3;
    int odd = below == 2; /* then one is above: what is cut off belongs to the other side */
    double tip = (a <= 0) != odd ? a : (b <= 0) != odd ? b : c;
    double p = tip == a ? b : a, q = tip == a || tip == b ? c : b;
    double share = tip / (tip - p) * (tip / (tip - q));
    return odd ? 1 - share : share;
}

static double square_share(const double v[4]) {
    int below = (v[0] <= 0) + (v[1] <= 0) + (v[2] <= 0) + (v[3] <= 0);
    if (below % 4 == 0)
        return below / 4;
    double middle = ((v[0] + v[1]) + (v[2] + v[3])) / 4, share = 0;
    for (int k = 0; k < 4; k++)
        share += triangle_share(v[k], v[(k + 1) % 4], middle);
    return share / 4;
}

double samples_share(const samples *s, int32_t i, int32_t j) {
    const float *d[2] = {samples_distance(s, j), samples_distance(s, j + 1)};
    const float *h[2] = {samples_half(s, j), samples_half(s, j + 1)};
    double below[4], above[4];
    for (int k = 0; k < 4; k++) {
        int row = k >> 1, column = i + (k == 1 || k == 2);
        below[k] = (double)d[row][column] - h[row][column];
        above[k] = (double)d[row][column] + h[row][column];
    }
    double share = square_share(below);
    if (s->has_sides && share > 0) {
        share -= square_share(above);
        share = share > 0 ? share : 0;
    }
    return share;
}

iso_status samples_period_share(double *share, const samples *s, iso_arena *scratch) {
    samples fine = {.has_sides = s->has_sides, .thin = SAMPLES_FAR, .thick = -SAMPLES_FAR};
    int32_t squares = s->period * FINER;
    taking t = {&fine, NULL, NULL};
    double sum = 0;
    fine.lattice = s->lattice;
    fine.plane = s->plane;
    fine.plane.step /= FINER;
    fine.raster.columns = fine.plane.columns = fine.plane.rows = squares + 1;
    fine.period = 2; /* rows in turn */
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    ISO_TRY(ISO_PUSH(fine.distance, scratch, 2 * ((int64_t)squares + 1)));
    ISO_TRY(ISO_PUSH(fine.half, scratch, 2 * ((int64_t)squares + 1)));
    ISO_TRY(ISO_PUSH(t.distance, scratch, squares + 1));
    ISO_TRY(ISO_PUSH(t.half, scratch, squares + 1));
    for (int32_t j = 0; j <= squares; j++) {
        take_row(&t, j, 0, squares + 1);
        for (int32_t i = 0; i < squares && j > 0; i++)
            sum += samples_share(&fine, i, j - 1);
    }
    iso_arena_pop(scratch, mark);
    *share = sum / ((double)squares * squares);
    return ISO_OK;
}

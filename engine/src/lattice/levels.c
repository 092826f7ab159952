/* What share of a cell lies below a level, and how steep it is. */
#include <math.h>

#include "base/memory.h"
#include "lattice/family.h"

/* Of the range of g. Shares between are linear: 8 times finer than the level table. */
enum { BINS = 8192 };

/* Most |g| of a box of eight samples, the gradient of the interpolant is itself trilinear between
 * its values at the corners, so never longer than the longest of these; and a corner's is made of
 * the steps to its neighbours, of which the worse is taken on each axis. */
static double find_steepest(const iso_lattice_cell *cell) {
    const float *g = cell->distance;
    int32_t n0 = cell->size[0], n1 = cell->size[1], n2 = cell->size[2];
    float scale[3], most = 0;
    for (int axis = 0; axis < 3; axis++)
        scale[axis] = (float)cell->size[axis] / (float)cell->repeat[axis];
    for (int32_t k = 0; k < n2; k++)
        for (int32_t j = 0; j < n1; j++) {
            const float *row = g + (int64_t)n0 * (j + (int64_t)n1 * k);
            const float *south = g + (int64_t)n0 * (((j - 1) & (n1 - 1)) + (int64_t)n1 * k);
            const float *north = g + (int64_t)n0 * (((j + 1) & (n1 - 1)) + (int64_t)n1 * k);
            const float *below = g + (int64_t)n0 * (j + (int64_t)n1 * ((k - 1) & (n2 - 1)));
            const float *above = g + (int64_t)n0 * (j + (int64_t)n1 * ((k + 1) & (n2 - 1)));
            for (int32_t i = 0; i < n0; i++) {
                float a = fabsf(row[(i + 1) & (n0 - 1)] - row[i]);
                float b = fabsf(row[(i - 1) & (n0 - 1)] - row[i]);
                float c = fabsf(north[i] - row[i]), d = fabsf(south[i] - row[i]);
                float e = fabsf(above[i] - row[i]), f = fabsf(below[i] - row[i]);
                float x = (a > b ? a : b) * scale[0];
                float y = (c > d ? c : d) * scale[1];
                float z = (e > f ? e : f) * scale[2];
                float square = x * x + y * y + z * z;
                most = square > most ? square : most;
            }
        }
    return sqrt(most) * (1 + 1e-6); /* floats were rounded */
}

/* A distribution of which ramps are known: share below x = sum of slope max(0, x - start). On the
 * bins' edges that is summed twice. */
typedef struct distribution {
    double bend[BINS + 2]; /* change of slope at an edge */
    double low, bin;
} distribution;

static void add_ramp(distribution *d, double start, double slope) {
    double place = (start - d->low) / d->bin;
    int32_t i = place <= 0 ? 0 : place >= BINS ? BINS : (int32_t)place;
    double part = place - i < 0 ? 0 : place - i > 1 ? 1 : place - i;
    d->bend[i] += slope * (1 - part);
    d->bend[i + 1] += slope * part;
}

/* A box of eight samples is taken for evenly spread over as wide a range as its gradient gives it:
 * the same mean and variance as a linear function has, and exact where that runs along an axis. */
static void add_box(distribution *d, double mean, double half, int has_sides) {
    double least = 0.5 * d->bin;
    half = half > least ? half : least;
    double from = mean - half, to = mean + half, slope = 0.5 / half;
    if (has_sides && to < 0)
        from = -from, to = -to, mean = from, from = to, to = mean;
    if (has_sides && from < 0) {
        add_ramp(d, 0, 2 * slope);
        add_ramp(d, -from, -slope);
    } else {
        add_ramp(d, from, slope);
    }
    add_ramp(d, to, -slope);
}

static void add_boxes(distribution *d, const iso_lattice_cell *cell) {
    int32_t n0 = cell->size[0], n1 = cell->size[1], n2 = cell->size[2];
    for (int32_t k = 0; k < n2; k++)
        for (int32_t j = 0; j < n1; j++) {
            int64_t up = (j + 1) & (n1 - 1), over = (k + 1) & (n2 - 1);
            const float *p = cell->distance + n0 * (j + (int64_t)n1 * k);
            const float *q = cell->distance + n0 * (up + (int64_t)n1 * k);
            const float *r = cell->distance + n0 * (j + n1 * over);
            const float *s = cell->distance + n0 * (up + n1 * over);
            for (int32_t i = 0; i < n0; i++) {
                int32_t o = (i + 1) & (n0 - 1);
                double x0 = (double)p[i] + q[i] + r[i] + s[i];
                double x1 = (double)p[o] + q[o] + r[o] + s[o];
                double y = (double)q[i] + q[o] + s[i] + s[o] - p[i] - p[o] - r[i] - r[o];
                double z = (double)r[i] + r[o] + s[i] + s[o] - p[i] - p[o] - q[i] - q[o];
                double x = x1 - x0;
                add_box(d, (x0 + x1) / 8, sqrt(x * x + y * y + z * z) / 8, cell->has_sides);
            }
        }
}

/* Invert the distribution at every k / ISO_CELL_LEVELS. */
static void find_levels(iso_lattice_cell *cell, const distribution *d, double boxes) {
    double below = 0, slope = 0;
    int32_t k = 1;
    for (int32_t i = 0; i <= BINS && k < ISO_CELL_LEVELS; i++) {
        slope += d->bend[i];
        double next = below + slope * d->bin;
        for (; k < ISO_CELL_LEVELS && boxes * k / ISO_CELL_LEVELS <= next; k++) {
            double rise = next - below;
            double part = rise > 0 ? (boxes * k / ISO_CELL_LEVELS - below) / rise : 1;
            cell->level[k] = (float)(d->low + (i + (part < 0 ? 0 : part)) * d->bin);
        }
        below = next;
    }
    for (; k < ISO_CELL_LEVELS; k++)
        cell->level[k] = (float)(d->low + BINS * d->bin);
}

iso_status cell_measure(iso_lattice_cell *cell) {
    int64_t count = (int64_t)cell->size[0] * cell->size[1] * cell->size[2];
    float low = cell->distance[0], high = low;
    for (int64_t i = 0; i < count; i++) {
        low = cell->distance[i] < low ? cell->distance[i] : low;
        high = cell->distance[i] > high ? cell->distance[i] : high;
    }
    if (!(high - low < HUGE_VALF) || high == low)
        return iso_fail(ISO_BAD_CONFIG, "the lattice's cell is the same everywhere");
    if (cell->has_sides) {
        high = high > -low ? high : -low;
        low = low > 0 ? low : 0;
    }
    distribution *d;
    ISO_TRY(ISO_ALLOCATE(d, 1));
    *d = (distribution){.low = low, .bin = ((double)high - low) / BINS};
    add_boxes(d, cell);
    find_levels(cell, d, (double)count);
    float beyond = (high - low) / (2 * BINS); /* by more than what floats round */
    cell->level[0] = low - beyond;
    cell->level[ISO_CELL_LEVELS] = high + beyond;
    iso_release(d);
    cell->steepest = find_steepest(cell);
    return ISO_OK;
}

#include "fill/sweep.h"

#include <math.h>

/* Sine and cosine for 0 <= x <= pi / 4 from their series: the C library's differ from machine to
 * machine. 9 terms leave less than 1e-16. */
static void sine_cosine(double x, double *sine, double *cosine) {
    double square = x * x, s = 1, c = 1;
    for (int i = 9; i > 0; i--) {
        s = 1 - s * square / (2 * i * (2 * i + 1));
        c = 1 - c * square / (2 * i * (2 * i - 1));
    }
    *sine = s * x;
    *cosine = c;
}

iso_sweep iso_sweep_of(double degrees) {
    double turned = fmod(degrees, 180); /* exact */
    if (turned < 0)
        turned += 180;
    if (turned >= 180) /* a tiny negative angle, rounded */
        turned = 0;
    int second = turned >= 90;
    double rest = second ? turned - 90 : turned;
    int steep = rest > 45;
    double s, c, half = 0.70710678118654752440, pi = 3.14159265358979323846;
    if (rest == 45)
        s = c = half;
    else
        sine_cosine((steep ? 90 - rest : rest) * (pi / 180), &s, &c);
    int64_t minor = (int64_t)(s * (1 << 30) + 0.5), major = (int64_t)(c * (1 << 30) + 0.5);
    iso_sweep sweep = {.cosine = steep ? minor : major, .sine = steep ? major : minor};
    if (second) {
        int64_t sine = sweep.cosine;
        sweep.cosine = -sweep.sine;
        sweep.sine = sine;
    }
    if (sweep.sine > sweep.cosine && sweep.sine > -sweep.cosine)
        sweep.along_y = 1;
    else
        sweep.along_x = sweep.cosine > 0 ? 1 : -1;
    return sweep;
}

static int64_t floor_divide(int64_t a, int64_t b) {
    int64_t q = a / b;
    return q - (a % b < 0);
}

void iso_sweep_repeat(iso_sweep *sweep, int64_t spacing, int64_t phase, const iso_extent *extent) {
    int64_t origin = phase | 1; /* low and high are even: never on a line */
    int64_t from = floor_divide(extent->low - origin, spacing) + 1;
    int64_t to = floor_divide(extent->high - origin, spacing);
    sweep->step = spacing;
    sweep->first = origin + from * spacing;
    sweep->count = to < from ? 0 : (int32_t)(to - from + 1);
}

/* Two lines share what is higher than 1.4 spacings: one alone would be too wide. */
static int32_t fitted_count(int64_t spacing, int64_t height) {
    if (height < 2 * spacing)
        return height > spacing * 7 / 5 ? 2 : 1;
    return (int32_t)((height + spacing / 2) / spacing);
}

void iso_sweep_fit(iso_sweep *sweep, int64_t spacing, int64_t margin, const iso_extent *extent) {
    /* An edge along the lines is straight to a unit only, so a line on it keeps two units off. */
    int64_t inset = 2 * ISO_SWEEP_ONE;
    int64_t from = extent->low - (extent->low_flat ? margin : 0);
    int64_t to = extent->high + (extent->high_flat ? margin : 0);
    sweep->count = fitted_count(spacing, to - from);
    if (sweep->count == 1) {
        sweep->first = (extent->low + (extent->high - extent->low) / 2) | 1;
        sweep->step = spacing;
        return;
    }
    int64_t half = (to - from) / sweep->count / 2, low = from + half, high = to - half;
    low = low < extent->low + inset ? extent->low + inset : low;
    high = high > extent->high - inset ? extent->high - inset : high;
    sweep->step = ((high - low) / (sweep->count - 1)) & ~(int64_t)1;
    sweep->first = low | 1;
}

double iso_sweep_place(iso_sweep *sweep, const iso_fill_options *options,
                       const iso_extent *extent) {
    enum { FRACTION = 256 }; /* options are kept to this part of a unit */
    int64_t scale = ISO_SWEEP_ONE / FRACTION;
    int64_t spacing = (int64_t)(options->spacing * FRACTION + 0.5) * scale;
    if (!options->fit) {
        int64_t phase = (int64_t)floor(options->phase * FRACTION + 0.5) * scale;
        iso_sweep_repeat(sweep, spacing, phase, extent);
        return 1;
    }
    int64_t margin = options->margin > 0 ? options->margin * ISO_SWEEP_ONE : 0;
    iso_sweep_fit(sweep, spacing, margin, extent);
    return (double)sweep->step / (double)spacing;
}

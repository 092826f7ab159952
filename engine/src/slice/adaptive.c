#include <isoslice/slice.h>

#include <math.h>
#include <stdbool.h>

#include "base/memory.h"

/* A step of thickness h on a surface whose unit normal has the height n stands off by h |n|, its
 * cusp. So every triangle bounds the layers that meet its range of heights by cusp / |n|. Bounds
 * are kept in bins of height; a triangle writes the two overlapping powers of two that make up its
 * range, and what is written for a power is handed down to the ones below at the end: that is
 * O(triangles + bins log bins), however tall triangles are. */

enum {
    BINS_A_LAYER = 8,   /* of the thinnest */
    BINS_MAX = 1 << 22, /* beyond, bins are coarser */
    FLATS_AHEAD = 6,    /* layers over which thickness is fitted to a flat face ahead */
    STEPS = 5           /* of thickness from min to max */
};

#define FLAT_LEAST 0.5 /* mm^2 of flat faces in a bin that are worth a layer's end */

typedef struct field {
    const iso_adaptive_options *options;
    double height, bin; /* mm */
    int32_t bins, powers;
    float *bound;   /* [powers * bins] */
    double *flat;   /* [bins] mm^2 of flat faces, then their height, or -1 */
    double *flat_z; /* [bins] the highest of them */
} field;

static int32_t bin_of(const field *f, double z) {
    double bin = z / f->bin;
    return bin <= 0 ? 0 : bin >= f->bins - 1 ? f->bins - 1 : (int32_t)bin;
}

static void add_bound(field *f, double low, double high, double bound) {
    int32_t from = bin_of(f, low), to = bin_of(f, high), length = to - from + 1, power = 0;
    while (2 << power <= length)
        power++;
    float *row = f->bound + (int64_t)power * f->bins;
    int32_t other = to + 1 - (1 << power);
    row[from] = fminf(row[from], (float)bound);
    row[other] = fminf(row[other], (float)bound);
}

static void add_triangle(field *f, const iso_vec3 *p, const iso_vec3 *q, const iso_vec3 *r) {
    double ux = q->x - p->x, uy = q->y - p->y, uz = q->z - p->z;
    double vx = r->x - p->x, vy = r->y - p->y, vz = r->z - p->z;
    double x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = fabs(ux * vy - uy * vx);
    double low = fmin(p->z, fmin(q->z, r->z)), high = fmax(p->z, fmax(q->z, r->z));
    if (high < 0 || low > f->height)
        return;
    if (low == high) {
        int32_t bin = bin_of(f, low);
        f->flat[bin] += z / 2;
        f->flat_z[bin] = fmax(f->flat_z[bin], low);
        return;
    }
    const iso_adaptive_options *o = f->options;
    double size = sqrt(x * x + y * y + z * z);
    if (z * o->max > o->cusp * size)
        add_bound(f, low, high, fmax(o->min, o->cusp * size / z));
}

static void hand_down(field *f) {
    for (int32_t power = f->powers - 1; power > 0; power--) {
        const float *from = f->bound + (int64_t)power * f->bins;
        float *to = f->bound + (int64_t)(power - 1) * f->bins;
        int32_t half = 1 << (power - 1);
        for (int32_t i = 0; i + 2 * half <= f->bins; i++) {
            to[i] = fminf(to[i], from[i]);
            to[i + half] = fminf(to[i + half], from[i]);
        }
    }
}

/* Bounds may not fall or rise faster than thickness may change: a layer as thick as the bound then
 * differs from the next by a step at most. */
static void soften(field *f) {
    const iso_adaptive_options *o = f->options;
    float slope = (float)((o->max - o->min) / STEPS / o->max * f->bin);
    for (int32_t i = 1; i < f->bins; i++)
        f->bound[i] = fminf(f->bound[i], f->bound[i - 1] + slope);
    for (int32_t i = f->bins - 1; i > 0; i--)
        f->bound[i - 1] = fminf(f->bound[i - 1], f->bound[i] + slope);
}

/* The thickest layer from z on that no bound on its way forbids. */
static double thickest(const field *f, double z) {
    double most = f->options->max;
    for (int32_t i = bin_of(f, z); i < f->bins && i * f->bin < z + most; i++)
        most = fmin(most, fmax(f->bound[i], i * f->bin - z));
    return fmax(most, f->options->min);
}

/* The next flat face above z that is worth it, the top of all in any case. */
static double next_flat(const field *f, double z, double reach) {
    for (int32_t i = bin_of(f, z); i < f->bins && i * f->bin <= z + reach; i++)
        if (f->flat[i] >= FLAT_LEAST && f->flat_z[i] > z + f->options->min / 2)
            return f->flat_z[i];
    return f->height;
}

/* The thickness of the layer that begins at z; 0 at the end. Layers up to a flat face nearby are
 * made thinner, all alike, so that one of them ends there. */
static double next_height(const field *f, double z) {
    const iso_adaptive_options *o = f->options;
    double most = thickest(f, z), left = f->height - z;
    if (left < o->min / 2)
        return 0;
    if (left <= o->min)
        return o->min;
    double way = next_flat(f, z, FLATS_AHEAD * most) - z;
    if (way > FLATS_AHEAD * most)
        return most;
    double layers = ceil(way / most - 1e-5), even = way / layers;
    return even >= o->min ? even : most;
}

static iso_status allocate(field *f, double height) {
    f->height = height;
    f->bin = fmax(f->options->min / BINS_A_LAYER, height / BINS_MAX);
    f->bins = (int32_t)(height / f->bin) + 1;
    for (f->powers = 1; 2 << (f->powers - 1) <= f->bins;)
        f->powers++;
    int64_t bounds = (int64_t)f->bins * f->powers;
    ISO_TRY(ISO_ALLOCATE(f->bound, bounds));
    ISO_TRY(ISO_ALLOCATE(f->flat, f->bins));
    ISO_TRY(ISO_ALLOCATE(f->flat_z, f->bins));
    for (int64_t i = 0; i < bounds; i++)
        f->bound[i] = (float)f->options->max;
    memset(f->flat, 0, (size_t)f->bins * sizeof *f->flat);
    memset(f->flat_z, 0, (size_t)f->bins * sizeof *f->flat_z);
    return ISO_OK;
}

static void add_mesh(field *f, const iso_mesh *mesh) {
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        const int32_t *v = mesh->origin + 3 * (int64_t)t;
        add_triangle(f, &mesh->position[v[0]], &mesh->position[v[1]], &mesh->position[v[2]]);
    }
}

/* Every layer is at least min thick but the first, which bounds their number. */
static iso_status make_levels(iso_levels *levels, const field *f) {
    const iso_adaptive_options *o = f->options;
    int64_t room = (int64_t)(f->height / o->min) + 3;
    ISO_TRY(ISO_ALLOCATE(levels->cut, room));
    ISO_TRY(ISO_ALLOCATE(levels->top, room));
    ISO_TRY(ISO_ALLOCATE(levels->height, room));
    double z = 0, height = o->first;
    for (int32_t i = 0; i < room && height > 0 && z + height / 2 < f->height; i++) {
        double top = z + height;
        if (fabs(f->height - top) < 1e-9 * f->height) /* by sums of rounded thirds */
            top = f->height;
        levels->cut[i] = z + height / 2;
        levels->top[i] = z = top;
        levels->height[i] = height;
        levels->count++;
        height = next_height(f, z);
    }
    return ISO_OK;
}

static bool above_zero(double value) {
    return value > 0 && value - value == 0;
}

iso_status iso_levels_adaptive(iso_levels *levels, const iso_mesh *mesh, int32_t count,
                               const iso_adaptive_options *options) {
    double height = 0;
    *levels = (iso_levels){0};
    if (!above_zero(options->first) || !above_zero(options->min) || !above_zero(options->max) ||
        !above_zero(options->cusp))
        return iso_fail(ISO_USAGE, "the heights of adaptive layers must be above 0");
    if (options->min > options->max)
        return iso_fail(ISO_USAGE,
                        "adaptive layers can't be %g mm at least and %g mm at most; see "
                        "min_layer_height and max_layer_height",
                        options->min, options->max);
    for (int32_t i = 0; i < count; i++)
        if (mesh[i].triangle_count > 0)
            height = fmax(height, mesh[i].max.z);
    if (!above_zero(height) || height / options->min > 10000000)
        return iso_fail(ISO_USAGE, "an object of height %g mm can't have layers of %g mm", height,
                        options->min);
    field f = {.options = options};
    iso_status status = allocate(&f, height);
    if (status == ISO_OK) {
        for (int32_t i = 0; i < count; i++)
            add_mesh(&f, &mesh[i]);
        hand_down(&f);
        soften(&f);
        status = make_levels(levels, &f);
    }
    iso_release(f.bound);
    iso_release(f.flat);
    iso_release(f.flat_z);
    if (status != ISO_OK)
        iso_levels_free(levels);
    return status;
}

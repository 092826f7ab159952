/* Structures of voxels by rule. */
#include "lattice/voxel.h"

#include <math.h>

#include "base/memory.h"
#include "base/series.h"
#include "lattice/distance.h"
#include "lattice/family.h"
#include "base/random.h"

/* Bars along the edges of the cell: where two of the three coordinates are within half a bar of a
 * plane between cells, so the second of them by size tells. */
iso_status voxel_cubic_fill(iso_lattice_cell *cell, const iso_lattice_options *options) {
    int32_t size = cell->size[0];
    float *g = cell->distance, step = 1 / (float)size;
    for (int32_t k = 0; k < size; k++)
        for (int32_t j = 0; j < size; j++) {
            int32_t y = j < size - j ? j : size - j, z = k < size - k ? k : size - k;
            int32_t low = y < z ? y : z, high = y < z ? z : y;
            for (int32_t i = 0; i < size; i++) {
                int32_t x = i < size - i ? i : size - i;
                *g++ = step * (float)(x < low ? low : x > high ? high : x);
            }
        }
    return ISO_OK;
}

/* ---- Random voxels ---- */

enum { RADIUS_MAX = 15 };

/* Each row of `out` the weighted sum of rows of `in` around it. `stride` floats make a row that
 * belongs together, `length` rows follow each other and wrap. */
static void blur_rows(float *out, const float *in, int64_t stride, int32_t length,
                      const float *weight, int32_t radius) {
    for (int32_t j = 0; j < length; j++) {
        float *to = out + stride * j;
        const float *from = in + stride * j;
        for (int64_t i = 0; i < stride; i++)
            to[i] = weight[0] * from[i];
        for (int32_t r = 1; r <= radius; r++) {
            const float *p = in + stride * ((j + r) & (length - 1));
            const float *q = in + stride * ((j - r) & (length - 1));
            for (int64_t i = 0; i < stride; i++)
                to[i] += weight[r] * (p[i] + q[i]);
        }
    }
}

static void blur_row(float *row, int32_t length, const float *weight, int32_t radius,
                     float *padded) {
    for (int32_t i = 0; i < length + 2 * radius; i++)
        padded[i] = row[(i - radius) & (length - 1)];
    const float *middle = padded + radius;
    for (int32_t i = 0; i < length; i++)
        row[i] = weight[0] * middle[i];
    for (int32_t r = 1; r <= radius; r++)
        for (int32_t i = 0; i < length; i++)
            row[i] += weight[r] * (middle[i + r] + middle[i - r]);
}

iso_status voxel_blur(float *field, int32_t size, double sigma) {
    float weight[RADIUS_MAX + 1], *other, *padded;
    int32_t radius = (int32_t)(3.5 * sigma) + 1;
    radius = radius < RADIUS_MAX ? radius : RADIUS_MAX;
    for (int32_t r = 0; r <= radius; r++)
        weight[r] = (float)series_exp(-0.5 * r * r / (sigma * sigma));
    int64_t plane = (int64_t)size * size;
    ISO_TRY(ISO_ALLOCATE(other, plane * size));
    iso_status status = ISO_ALLOCATE(padded, size + 2 * RADIUS_MAX);
    if (status != ISO_OK) {
        iso_release(other);
        return status;
    }
    for (int64_t row = 0; row < plane; row++)
        blur_row(field + row * size, size, weight, radius, padded);
    for (int32_t k = 0; k < size; k++)
        blur_rows(other + plane * k, field + plane * k, size, size, weight, radius);
    /* planes in pieces of a row, so that what is summed stays in the cache */
    for (int32_t j = 0; j < size; j++)
        for (int32_t k = 0; k < size; k++) {
            float *to = field + plane * k + (int64_t)size * j;
            const float *from = other + (int64_t)size * j;
            for (int32_t i = 0; i < size; i++)
                to[i] = weight[0] * from[plane * k + i];
            for (int32_t r = 1; r <= radius; r++) {
                const float *p = from + plane * ((k + r) & (size - 1));
                const float *q = from + plane * ((k - r) & (size - 1));
                for (int32_t i = 0; i < size; i++)
                    to[i] += weight[r] * (p[i] + q[i]);
            }
        }
    iso_release(padded);
    iso_release(other);
    return ISO_OK;
}

/* White noise blurred by sigma changes its sign every pi sqrt(2) sigma along a line (Rice 1944):
 * that is how wide its pores and walls are where half is solid. */
#define SIGMA_OF_PORE 0.22507907903927652

iso_status voxel_random_fill(iso_lattice_cell *cell, const iso_lattice_options *options) {
    int32_t size = cell->size[0];
    int64_t count = (int64_t)size * size * size;
    double pore = options->pore;
    if (!(pore >= 0.05 && pore <= 1))
        return iso_fail(ISO_BAD_CONFIG, "pores of %g cells; 0.05 to 1 are possible", pore);
    int32_t repeat = (int32_t)ceil(10 * pore - 1e-9); /* ten pores across the box, or eight */
    for (int axis = 0; axis < 3; axis++)
        cell->repeat[axis] = repeat < 8 ? repeat : 8;
    double sigma = SIGMA_OF_PORE * pore * size / cell->repeat[0];
    uint64_t state = options->seed;
    float *g = cell->distance;
    for (int64_t i = 0; i < count; i += 64) {
        uint64_t bits = random_next(&state);
        for (int bit = 0; bit < 64; bit++)
            g[i + bit] = bits >> bit & 1 ? 1.0f : -1.0f;
    }
    ISO_TRY(voxel_blur(g, size, sigma));
    ISO_TRY(distance_from_field(g, size, ISO_FIELD_ANY));
    float step = (float)cell->repeat[0] / (float)size;
    for (int64_t i = 0; i < count; i++)
        g[i] *= step;
    return ISO_OK;
}

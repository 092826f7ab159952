/* A random field of waves of one length in all directions, as the microstructures of spinodal
 * decomposition and of trabecular bone are modelled (Cahn 1965). */
#include "lattice/family.h"

#include "base/angle.h"
#include "lattice/distance.h"
#include "base/random.h"

/* Waves in the box, so that it repeats: all whole vectors whose length is about its length in
 * cells. */
enum { WAVES_MAX = 128, SHORTEST = 14, LONGEST = 18, REACH = 4, SIZE_MOST = 256 };

typedef struct wave {
    int32_t x, y, z;
    double cosine, sine; /* of its phase */
} wave;

static int32_t make_waves(wave *out, uint64_t seed) {
    int32_t made = 0;
    for (int32_t x = 0; x <= REACH; x++)
        for (int32_t y = -REACH; y <= REACH; y++)
            for (int32_t z = -REACH; z <= REACH; z++) {
                int32_t square = x * x + y * y + z * z;
                int is_half = x > 0 || (x == 0 && (y > 0 || (y == 0 && z > 0)));
                if (square < SHORTEST || square > LONGEST || !is_half)
                    continue;
                wave *w = &out[made++];
                w->x = x, w->y = y, w->z = z;
                iso_sine_cosine(&w->sine, &w->cosine, 360 * random_unit(&seed));
            }
    return made;
}

/* The waves of one row by their number along x: all that differ in y and z alone are one there. */
static void sum_row(float *row, const wave *waves, int32_t count, const double (*turn)[2],
                    const int32_t at[3]) {
    double c[REACH + 1] = {0}, s[REACH + 1] = {0};
    int32_t mask = at[0] - 1;
    for (int32_t i = 0; i < count; i++) {
        const wave *w = &waves[i];
        const double *t = turn[(w->y * at[1] + w->z * at[2]) & mask];
        c[w->x] += w->cosine * t[0] - w->sine * t[1];
        s[w->x] += w->cosine * t[1] + w->sine * t[0];
    }
    for (int32_t i = 0; i < at[0]; i++) {
        double sum = 0;
        for (int32_t x = 0; x <= REACH; x++) {
            const double *t = turn[(x * i) & mask];
            sum += c[x] * t[0] - s[x] * t[1];
        }
        row[i] = (float)sum;
    }
}

iso_status bone_fill(iso_lattice_cell *cell, const iso_lattice_options *options) {
    wave waves[WAVES_MAX];
    double turn[SIZE_MOST][2];
    int32_t size = cell->size[0], count = make_waves(waves, options->seed);
    for (int32_t i = 0; i < size; i++)
        iso_sine_cosine(&turn[i][1], &turn[i][0], 360.0 * i / size);
    for (int32_t k = 0; k < size; k++)
        for (int32_t j = 0; j < size; j++)
            sum_row(cell->distance + (int64_t)size * (j + (int64_t)size * k), waves, count,
                    (const double(*)[2])turn, (const int32_t[3]){size, j, k});
    ISO_TRY(distance_from_field(cell->distance, size, ISO_FIELD_ANY));
    float step = (float)cell->repeat[0] / (float)size;
    for (int64_t i = 0; i < (int64_t)size * size * size; i++)
        cell->distance[i] *= step;
    return ISO_OK;
}

/* Triply periodic minimal surfaces, by the first terms of their Fourier series (Gandy, Bardhan,
 * Mackay, Klinowski 2001), and the distance from these. */
#include "lattice/family.h"

#include "base/angle.h"
#include "lattice/distance.h"

enum { SIZE_MAX_OF_TABLE = 512 };

typedef struct wave { /* of one coordinate */
    double s, c, s2, c2;
} wave;

static double gyroid(const wave *x, const wave *y, const wave *z) {
    return x->s * y->c + y->s * z->c + z->s * x->c;
}

static double primitive(const wave *x, const wave *y, const wave *z) {
    return x->c + y->c + z->c;
}

static double diamond(const wave *x, const wave *y, const wave *z) {
    return x->s * y->s * z->s + x->s * y->c * z->c + x->c * y->s * z->c + x->c * y->c * z->s;
}

/* Negative around the cell's corners and middle, which thick bars join along its diagonals. */
static double iwp(const wave *x, const wave *y, const wave *z) {
    return x->c2 + y->c2 + z->c2 - 2 * (x->c * y->c + y->c * z->c + z->c * x->c);
}

static double neovius(const wave *x, const wave *y, const wave *z) {
    return 3 * (x->c + y->c + z->c) + 4 * x->c * y->c * z->c;
}

static double fischer_koch(const wave *x, const wave *y, const wave *z) {
    return x->c2 * y->s * z->c + x->c * y->c2 * z->s + x->s * y->c * z->c2;
}

typedef struct surface {
    double (*value)(const wave *x, const wave *y, const wave *z);
    iso_field_symmetry symmetry;
} surface;

/* In the order of iso_lattice_pattern, two patterns each. */
static const surface surfaces[] = {
    {gyroid, ISO_FIELD_EVEN}, {primitive, ISO_FIELD_ODD}, {diamond, ISO_FIELD_ODD},
    {iwp, ISO_FIELD_EVEN},    {neovius, ISO_FIELD_ODD},   {fischer_koch, ISO_FIELD_EVEN},
};

iso_status tpms_fill(iso_lattice_cell *cell, const iso_lattice_options *options) {
    const surface *s = &surfaces[(options->pattern - ISO_LATTICE_GYROID_SHEET) / 2];
    int32_t size = cell->size[0];
    wave at[SIZE_MAX_OF_TABLE];
    for (int32_t i = 0; i < size; i++) {
        iso_sine_cosine(&at[i].s, &at[i].c, 360.0 * i / size);
        iso_sine_cosine(&at[i].s2, &at[i].c2, 720.0 * i / size);
    }
    float *g = cell->distance;
    for (int32_t k = 0; k < size; k++)
        for (int32_t j = 0; j < size; j++)
            for (int32_t i = 0; i < size; i++)
                *g++ = (float)s->value(&at[i], &at[j], &at[k]);
    ISO_TRY(distance_from_field(cell->distance, size, s->symmetry));
    for (int64_t i = 0; i < (int64_t)size * size * size; i++)
        cell->distance[i] /= (float)size;
    return ISO_OK;
}

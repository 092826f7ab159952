/* The cell of a lattice: a cubic-link that wraps (paper, 4.1.5).
 *
 * Things are the samples of a box that repeats: index i + n0 (j + n1 k) is at (i, j, k) repeat /
 * size; alpha, beta, gamma step along the axes and wrap; g is the distance to the lattice's
 * skeleton, in cells. Skeletons:
 *
 *     sheet     a surface; g has a sign that tells its two sides; solid is |g| <= level
 *     solid     the surface around a solid; g < 0 inside; solid is g <= level
 *     strut     lines (or walls that have no two sides); g >= 0; solid is g <= level
 *     voxel     cubes or pictures; as solid
 *
 * Every kind is tabled, so that all are sampled alike and cost the same; and the share of the box
 * that is solid at a level is a matter of sorting, so that any density is had exactly. */
#ifndef ISO_LATTICE_CELL_H
#define ISO_LATTICE_CELL_H

#include <isoslice/link.h>
#include <isoslice/lattice.h>
#include <isoslice/status.h>

enum { ISO_CELL_LEVELS = 1024 };

typedef struct iso_lattice_cell {
    int32_t size[3];                  /* samples along each axis: powers of two, so that & wraps */
    int32_t repeat[3];                /* cells that the box is long; 1 for what repeats by itself */
    float *distance;                  /* [size0 size1 size2] in cells */
    float level[ISO_CELL_LEVELS + 1]; /* at the density k / ISO_CELL_LEVELS; 0: below all, so void;
                                       * the last: above all */
    int32_t has_sides;                /* a sheet */
    double steepest;                  /* most that g changes over a distance of 1, proven */
} iso_lattice_cell;

/* Deterministic; `options` gives pattern, seed and what else a pattern needs. Free with cell_free.
 */
iso_status cell_make(iso_lattice_cell *cell, const iso_lattice_options *options) ISO_MUST_CHECK;
void cell_free(iso_lattice_cell *cell);

/* The cubic-link itself, with g; for a look, a file, and the validator. */
iso_status cell_link(iso_cubic_link *out, const iso_lattice_cell *cell) ISO_MUST_CHECK;

/* The level that gives a density from 0 to 1: linear between the levels of the table. */
double cell_level(const iso_lattice_cell *cell, double density);
/* Its inverse. */
double cell_density(const iso_lattice_cell *cell, double level);

/* g at u, v, w in cells, trilinear; any finite numbers. */
double cell_distance(const iso_lattice_cell *cell, double u, double v, double w);

/* Where a coordinate falls on an axis: the samples before and after it, and how far between. */
typedef struct iso_cell_place {
    int32_t low, high;
    double part;
} iso_cell_place;

/* `u` in samples (cells times size / repeat), less than 2^31 from 0. */
static inline iso_cell_place cell_place(double u, int32_t size) {
    int32_t low = (int32_t)u;
    low -= u < low;
    return (iso_cell_place){low & (size - 1), (low + 1) & (size - 1), u - low};
}

/* As cell_distance, for coordinates in samples that are less than 2^31 from 0. */
static inline double cell_at(const iso_lattice_cell *cell, double u, double v, double w) {
    iso_cell_place x = cell_place(u, cell->size[0]), y = cell_place(v, cell->size[1]),
                   z = cell_place(w, cell->size[2]);
    int64_t n0 = cell->size[0], n1 = cell->size[1];
    const float *low = cell->distance + n0 * n1 * z.low, *high = cell->distance + n0 * n1 * z.high;
    const float *p = low + n0 * y.low, *q = low + n0 * y.high;
    const float *r = high + n0 * y.low, *s = high + n0 * y.high;
    double a = p[x.low] + x.part * (p[x.high] - p[x.low]);
    double b = q[x.low] + x.part * (q[x.high] - q[x.low]);
    double c = r[x.low] + x.part * (r[x.high] - r[x.low]);
    double d = s[x.low] + x.part * (s[x.high] - s[x.low]);
    a += y.part * (b - a);
    c += y.part * (d - c);
    return a + z.part * (c - a);
}

#endif

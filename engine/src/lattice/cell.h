/* The cell of a lattice: a cubic-link that wraps (paper, 4.1.5).
 *
 * Things are the samples of a box that repeats: index i + n0 (j + n1 k); alpha, beta, gamma step
 * along the axes and wrap; g is the distance to the lattice's skeleton, in cells. Skeletons:
 *
 *     sheet     a surface; g has a sign that tells its two sides; solid is |g| <= level
 *     solid     the surface around a solid; g < 0 inside; solid is g <= level
 *     strut     lines; g >= 0; solid is g <= level
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
    int32_t size[3];                  /* samples along each axis */
    int32_t repeat[3];                /* cells that the box is long; 1 for what repeats by itself */
    float *distance;                  /* [size0 size1 size2] in cells */
    float level[ISO_CELL_LEVELS + 1]; /* at the density k / ISO_CELL_LEVELS; 0: below all, so void;
                                       * the last: above all */
    int32_t has_sides;                /* a sheet */
    double steepest;                  /* most that g changes over a distance of 1 */
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

#endif

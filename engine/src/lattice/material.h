/* Which of two materials each cell of a lattice is of: an n-cube-link (paper, 4.1.5) whose axes are
 * the part's cells along u, v and w, and the material.
 *
 * Whole cells are of one material, so that few beads are cut; how many of them are of the second
 * one follows its share by ordered dither: a matrix of thresholds in three dimensions, spread
 * evenly over any block of a few cells. */
#ifndef ISO_LATTICE_MATERIAL_H
#define ISO_LATTICE_MATERIAL_H

#include <isoslice/link.h>

#include "lattice/map.h"

typedef struct iso_material {
    int32_t first[3], length[3]; /* cells along u, v and w that the part meets */
    double around;               /* cells in a full turn along u, or 0: u doesn't turn */
    uint8_t *tool;               /* [length0 length1 length2]; NULL: all are of the first */
} iso_material;

/* What the cells are of. `smallest` mm long at the least; `straight`: they are cubes of that size
 * along x, y and z, and have the share of their middles; others that of their mean. */
typedef struct iso_material_source {
    const iso_space *space;
    const iso_cell_map *map;
    const iso_grading *size, *share; /* share in percent */
    uint32_t wanted;                 /* variables, as bits */
    double smallest;
    bool straight;
} iso_material_source;

/* ISO_BAD_CONFIG: more cells than there is room for. */
iso_status material_make(iso_material *material, const iso_material_source *source) ISO_MUST_CHECK;
void material_free(iso_material *material);

/* Of the cell that has the place u, v, w; beyond the ends that of the last one. */
int32_t material_at(const iso_material *material, double u, double v, double w);

/* The share above which a cell is of the second material, between 0 and 1. */
double material_threshold(int32_t u, int32_t v, int32_t w);

/* The link: index u + length0 (v + length1 (w + length2 m)) has the projection p = 1 + m where the
 * cell is of material m, and 0, which is void, where it is of the other. No geometry. */
iso_status material_link(iso_cube_link *out, const iso_material *material) ISO_MUST_CHECK;

#endif

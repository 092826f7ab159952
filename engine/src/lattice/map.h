/* From a place in the part to a place in the lattice: u, v, w in cells.
 *
 * A map has three coordinates. Lengths, as x or the distance to the skin, are divided by the size
 * of a cell; where that varies with the very length alone, the cells along it are counted: the
 * integral of 1 / size, so that each cell is as long as was asked. Turns around an axis count a
 * whole number of cells, as many as fit at the mean radius: so nothing is torn, and cells are
 * longer outside and shorter inside. */
#ifndef ISO_LATTICE_MAP_H
#define ISO_LATTICE_MAP_H

#include "lattice/space.h"

typedef struct iso_cell_map {
    int32_t kind;       /* iso_lattice_map */
    double around;      /* cells in a full turn */
    double middle_z;    /* SPHERE: of its middle */
    int32_t counted;    /* the variable that cells are counted along, or -1 */
    double first, step; /* mm: where `cells` begins, and from one of it to the next */
    double *cells;      /* [MAP_STEPS + 1] from 0 up to there; the variable's 0 has 0 */
    double smallest;    /* mm, of a cell's edge along what is counted; else HUGE_VAL */
} iso_cell_map;

enum { MAP_STEPS = 4096 };

/* Variables that it needs, as bits. */
uint32_t map_wants(int32_t kind);

/* `repeat`: turns have a multiple of so many cells. ISO_BAD_CONFIG: a cell that is smaller than
 * `least` mm, or no number. */
iso_status map_make(iso_cell_map *map, int32_t kind, const iso_space *space,
                    const iso_grading *size, int32_t repeat, double least) ISO_MUST_CHECK;
void map_free(iso_cell_map *map);

/* Are cells as long as wide, wherever they are? Else map_stretch tells how long. */
bool map_is_even(const iso_cell_map *map);

typedef double iso_cell_places[3][GRADING_BLOCK];

/* size[i] is the cell's there, above 0. */
void map_cells(iso_cell_places cells, const iso_cell_map *map, const iso_places *places,
               const double *size, int32_t count);

/* mm that a cell is long along u, v and w. */
void map_stretch(iso_cell_places stretch, const iso_cell_map *map, const iso_places *places,
                 const double *size, int32_t count);

#endif

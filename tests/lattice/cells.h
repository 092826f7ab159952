/* What the tests of cells share: random numbers, areas and topology of a table. */
#ifndef TESTS_LATTICE_CELLS_H
#define TESTS_LATTICE_CELLS_H

#include <stdint.h>

#include "lattice/cell.h"

/* 0 <= u < 1, by another generator than the engine's. */
double random_number(uint64_t *state);

/* The surface g = level of a table, made of flat pieces in the six tetrahedra of each box: area in
 * cells^2 of one period, Euler number, and volume of g <= level, cells^3. */
typedef struct surface_figures {
    double area, volume;
    int64_t euler;
} surface_figures;
void measure_surface(surface_figures *out, const iso_lattice_cell *cell, double level);

/* Share of the box that is solid at each of the levels, by random points. */
void sampled_densities(double *share, const iso_lattice_cell *cell, const double *level,
                       int32_t levels, int64_t points);

#endif

/* A lattice in a part: what cell, map and grading make together, ready to be sampled. */
#ifndef ISO_LATTICE_LATTICE_H
#define ISO_LATTICE_LATTICE_H

#include <isoslice/lattice.h>
#include <isoslice/mesh.h>

#include "lattice/cell.h"

typedef struct iso_lattice iso_lattice;
struct iso_material; /* lattice/material.h */

/* The meshes give the frame and, where an expression or the map asks for it, the distance to the
 * skin; they aren't needed afterwards. ISO_BAD_CONFIG: an expression that can't be read (the
 * message names the option), a cell that isn't above 0 everywhere it is asked, a file that isn't
 * there; ISO_UNREADABLE. */
iso_status lattice_new(iso_lattice **lattice, const iso_lattice_options *options,
                       const iso_mesh *mesh, int32_t count) ISO_MUST_CHECK;
void lattice_free(iso_lattice *lattice);

const iso_lattice_cell *lattice_cell(const iso_lattice *lattice);

/* Constant cell, density and xyz map: then one cell and one level are all there is. */
int lattice_is_uniform(const iso_lattice *lattice);
double lattice_smallest_cell(const iso_lattice *lattice); /* mm, over the part's box */

/* What the cells are of, if there are two materials; else NULL. */
const struct iso_material *lattice_material(const iso_lattice *lattice);

/* A grid in a plane of height z: node (i, j) is at origin + step (i, j), in the coordinates of the
 * meshes. */
typedef struct iso_lattice_plane {
    iso_vec2 origin;
    double step, z;
    int32_t columns, rows;
} iso_lattice_plane;

/* A piece of it, columns first .. first + count - 1 of one row: `distance` to the skeleton in mm,
 * with its sign, and `half`: material is where distance (|distance| for cells with sides) <= half.
 * Void everywhere: half is -HUGE_VAL; solid: HUGE_VAL; where density is no number, void. `distance`
 * is always finite. A node has the same bits in any piece. Any number of threads at once; allocates
 * nothing. */
void lattice_sample_row(double *distance, double *half, const iso_lattice *lattice,
                        const iso_lattice_plane *plane, int32_t row, int32_t first, int32_t count);

/* The same at any points: the signed distance to the material's surface in mm, negative inside. */
void lattice_sample(double *value, const iso_lattice *lattice, const iso_vec3 *point,
                    int64_t count);

/* The tool, 0 or 1, that prints the cell at any points. */
void lattice_tools(uint8_t *tool, const iso_lattice *lattice, const iso_vec3 *point, int64_t count);

#endif

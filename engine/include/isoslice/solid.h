/* Inside and outside, told exactly.
 *
 * The surface is the meshes' triangles with corners rounded to a grid of 2^-k mm, fine enough that
 * the models' box spans 2^30 steps at least (0.1 nm for a part of 100 mm; corners of an STL file
 * larger than a millimetre don't move at all). Points are rounded to the same grid. The winding
 * number of a point is then an integer that is computed exactly: a tree of boxes says which
 * triangles a ray may meet, integers decide, with symbolic perturbation where it meets an edge or a
 * corner (Edelsbrunner and Muecke 1990). */
#ifndef ISOSLICE_SOLID_H
#define ISOSLICE_SOLID_H

#include <isoslice/geometry.h>
#include <isoslice/mesh.h>
#include <isoslice/status.h>

typedef struct iso_solid iso_solid;

/* The meshes are copied. ISO_BAD_CONFIG: the module isoslice-solid is missing. */
ISO_API iso_status iso_solid_new(iso_solid **solid, const iso_mesh *mesh,
                                 int32_t count) ISO_MUST_CHECK;
ISO_API void iso_solid_free(iso_solid *solid);

typedef struct iso_winding_options {
    int32_t directions; /* rays a point, 1 to 6: +x -x +y -y +z -z, in an order that `seed` gives;
                         * on closed surfaces all agree, and ISO_BUG says where they don't */
    uint64_t seed;
} iso_winding_options;

/* winding[i] of point[i], mm: how often the surface turns around it, outward-facing triangles
 * counting 1. A point that is exactly on the surface gets the winding number of x + e^3, y + e^2,
 * z + e next to it, e > 0 below any bound, as a slice at z has it, and on_surface[i] = 1 (may be
 * NULL). options may be NULL: one direction, the shortest way out. The same on every machine; any
 * number of threads at once on one solid. */
ISO_API iso_status iso_solid_winding(int32_t *winding, uint8_t *on_surface, const iso_solid *solid,
                                     const iso_vec3 *point, int64_t count,
                                     const iso_winding_options *options) ISO_MUST_CHECK;

#endif

/* Which shells of a mesh are inside out. */
#ifndef ISO_MESH_NESTING_H
#define ISO_MESH_NESTING_H

#include <isoslice/mesh.h>

#include <stdbool.h>

/* A shell of negative volume is a cavity if there is material around it, else it is inside out.
 * Directly within a shell that is turned, any shell with material around it is a cavity, so that a
 * model that is inside out as a whole keeps its cavities. Shells are judged from the outermost
 * inwards; what is around a shell is asked just inside the centroid of its first triangle. */
iso_status iso_mesh_find_inverted(bool *turned, const iso_mesh *mesh, const int32_t *shell,
                                  const double *volume, int32_t shells) ISO_MUST_CHECK;

/* The shell directly around each one, by its number, or -1. Shells are as find_inverted left them.
 */
iso_status iso_mesh_find_around(int32_t *around, const iso_mesh *mesh, const int32_t *shell,
                                const double *volume, int32_t shells) ISO_MUST_CHECK;

#endif

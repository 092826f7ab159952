/* What is mended, and what is refused (docs/models.md). */
#ifndef ISO_MESH_REPAIR_H
#define ISO_MESH_REPAIR_H

#include <isoslice/mesh.h>

#include <stdbool.h>

/* Make a welded mesh a closed, oriented double-link with its box, or say why not. `closed`: every
 * edge has exactly two darts, opposite, already linked. On failure the mesh still belongs to the
 * caller and is good for nothing but iso_mesh_free. */
iso_status iso_mesh_repair(iso_mesh *mesh, bool closed) ISO_MUST_CHECK;

#endif

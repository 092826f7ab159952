/* A mesh with shorter edges. */
#ifndef ISO_CHANNEL_SPLIT_H
#define ISO_CHANNEL_SPLIT_H

#include <stdbool.h>

#include <isoslice/mesh.h>

/* The same surface with edges halved until none is longer than `longest`, or there are so many
 * triangles that it has to do. Corners are rounded to floats. */
iso_status mesh_split(iso_mesh *out, const iso_mesh *mesh, double longest) ISO_MUST_CHECK;

#endif

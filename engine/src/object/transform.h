/* Transforming meshes that come along with others. */
#ifndef ISO_OBJECT_TRANSFORM_H
#define ISO_OBJECT_TRANSFORM_H

#include <isoslice/object.h>

/* As iso_meshes_transform, but the box is that of the first `leading` of the meshes alone: the
 * middle, and what has to fit. */
iso_status meshes_transform_along(iso_mesh *mesh, int32_t count, int32_t leading,
                                  const iso_transform *transform) ISO_MUST_CHECK;

#endif

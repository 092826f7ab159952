/* Between which values does a field run on some meshes? */
#ifndef ISO_SLICE_RANGE_H
#define ISO_SLICE_RANGE_H

#include <isoslice/field.h>
#include <isoslice/mesh.h>

/* Least and greatest value anywhere on the faces, to 0.001. ISO_BAD_CONFIG: the field has no finite
 * value at some vertex, which the message names, or there is none. */
iso_status field_range(double range[2], const iso_field *field, const iso_mesh *mesh,
                       int32_t count) ISO_MUST_CHECK;

#endif

/* The kinds of fields that iso_field_open knows besides those of a text alone. */
#ifndef ISO_HEIGHT_FIELDS_H
#define ISO_HEIGHT_FIELDS_H

#include "height/height.h"

/* mm along the surface of mesh[count] from each shell's lowest points. */
iso_status height_new_geodesic(iso_field **field, const iso_mesh *mesh,
                               int32_t count) ISO_MUST_CHECK;

/* Signed distance to the surface of a file, an STL or a .vdb grid; `origin` is where its
 * coordinates have the field's zero. */
iso_status height_new_distance(iso_field **field, const char *path, iso_vec3 origin) ISO_MUST_CHECK;
iso_status height_new_distance_to(iso_field **field, const iso_mesh *mesh,
                                  iso_vec3 origin) ISO_MUST_CHECK;

/* Layers that lie as the tops of mesh[count] do, nowhere steeper than `slope` degrees. */
iso_status height_new_auto_top(iso_field **field, const iso_mesh *mesh, int32_t count,
                               double slope) ISO_MUST_CHECK;

#endif

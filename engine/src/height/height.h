/* Height functions that come from models: distances along a surface, to another surface, and
 * layers fitted to a model's tops. */
#ifndef ISO_HEIGHT_HEIGHT_H
#define ISO_HEIGHT_HEIGHT_H

#include <isoslice/field.h>
#include <isoslice/mesh.h>

/* mm along the surface from `source` ([source_count] vertices, and edges between two of them), at
 * each vertex: exact on the triangles as they are, but for rounding; infinite on parts without a
 * source. ISO_USAGE: a source that is no vertex. */
iso_status height_geodesic(double *distance, const iso_mesh *mesh, const int32_t *source,
                           int32_t source_count) ISO_MUST_CHECK;

/* Upwards from each shell's own lowest points, where it is as high as they lie above `foot`. */
iso_status height_geodesic_rise(double *distance, const iso_mesh *mesh, double foot) ISO_MUST_CHECK;

/* A field's height at each vertex ([vertex_count]); of `geodesic` those measured along that very
 * model, where it is one of those that the field was opened with. What iso_slice_heights needs: an
 * ISO_FIELD_GEODESIC is linear in each triangle, and is cut exactly that way. */
void height_of_vertices(double *height, const iso_field *field, const iso_mesh *mesh);

#endif

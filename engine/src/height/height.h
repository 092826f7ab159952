/* Height functions that come from models: distances along a surface, to another surface, and
 * layers fitted to a model's tops. */
#ifndef ISO_HEIGHT_HEIGHT_H
#define ISO_HEIGHT_HEIGHT_H

#include <isoslice/field.h>
#include <isoslice/mesh.h>

/* mm along the surface from `source` ([source_count] vertices), at each vertex; infinite on parts
 * without one. Crane, Weischedel, Wardetzky, "Geodesics in Heat", 2013, on an intrinsic Delaunay
 * triangulation; then made exact along edges near the source. */
iso_status height_geodesic(double *distance, const iso_mesh *mesh, const int32_t *source,
                           int32_t source_count) ISO_MUST_CHECK;

#endif

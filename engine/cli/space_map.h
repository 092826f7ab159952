/* A picture of contours in space. */
#ifndef ISO_CLI_SPACE_MAP_H
#define ISO_CLI_SPACE_MAP_H

#include <isoslice/mesh.h>
#include <isoslice/slice.h>

#include "base/output.h"

/* What hides contours: meshes, each moved by an offset. */
typedef struct iso_space_body {
    const iso_mesh *mesh;
    iso_vec3 by;
} iso_space_body;

typedef struct iso_space_view {
    double azimuth, elevation; /* degrees: where the eye is, from x over y, and above the ground */
    const char *caption;       /* "": none */
} iso_space_view;

/* SVG: the contours as seen from far away, from blue at the lowest level to red at the highest;
 * what lies behind the bodies is pale. A layer's group has its height in `data-r`. */
iso_status iso_space_map(iso_output *output, const iso_curves *curves, const iso_levels *levels,
                         const iso_space_body *body, int32_t body_count,
                         const iso_space_view *view) ISO_MUST_CHECK;

#endif

/* How far a point is from the part, with its sign, and channels kept as far off as they are to be.
 */
#ifndef ISO_CHANNEL_KEEP_H
#define ISO_CHANNEL_KEEP_H

#include <isoslice/mesh.h>

#include "channel/curve.h"
#include "solid/closest.h"
#include "solid/enclosed.h"

typedef struct part_space {
    iso_vec3 *corner; /* [3 triangles] */
    iso_closest *tree;
    enclosed_columns columns;
} part_space;

iso_status part_space_new(part_space *part, const iso_mesh *mesh) ISO_MUST_CHECK;
void part_space_free(part_space *part);

typedef struct keeping {
    double depth;  /* mm that are to be kept, but for a few hundredths */
    double radius; /* of the narrowest bend */
    double step;   /* mm between points */
    int32_t fixed; /* points at the ends of an open curve that stay */
} keeping;

/* Make bends as wide as they are to be (curve_relax) and push what is too near to the part away
 * from it, in turns until both are so, or as far as it goes. */
iso_status keep_off(curve *c, const part_space *part, const keeping *options) ISO_MUST_CHECK;

#endif

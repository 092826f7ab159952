/* A picture of the contours of all layers. */
#ifndef ISO_CLI_CONTOUR_MAP_H
#define ISO_CLI_CONTOUR_MAP_H

#include <isoslice/slice.h>

#include "base/output.h"

/* "#rrggbb", from blue at the bed over green to red at the top. */
void iso_contour_colour(char text[8], int32_t level, int32_t count);

/* SVG: the layers side by side, each seen from above with its material filled, from blue at the bed
 * to red at the top; in a layer's group one unit is a mm and y goes up. */
iso_status iso_contour_map(iso_output *output, const iso_slices *slices,
                           const iso_levels *levels) ISO_MUST_CHECK;

#endif

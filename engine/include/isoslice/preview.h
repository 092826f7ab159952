/* A picture of what a G-code file draws: some of its layers side by side, as SVG. */
#ifndef ISOSLICE_PREVIEW_H
#define ISOSLICE_PREVIEW_H

#include <stdint.h>

#include <isoslice/status.h>

typedef struct iso_preview_options {
    const int32_t *layer;     /* [layer_count] which ones: 1 is the first, -1 the last; borrowed */
    int32_t layer_count;      /* 0: `spread` layers at even steps from the first to the last */
    int32_t spread;           /* usual 4; all of them if there are fewer */
    int32_t columns;          /* pictures in a row; usual 4 */
    int32_t panel;            /* pixels, the longer side of a picture; usual 460 */
    int travels;              /* draw moves without extrusion too; usual 1 */
    double filament_diameter; /* mm, for the width of beads without a ;WIDTH:; usual 1.75 */
    double view[2];           /* degrees: where the eye is, from x towards y, and above the ground;
                                 usual -90, 90: straight from above, with y up */
} iso_preview_options;

ISO_API iso_preview_options iso_preview_defaults(void);

/* Read G-code (G0 to G3 by I and J, G28, G90 to G92, M82, M83 and the comments ;LAYER_CHANGE,
 * ;TYPE:, ;WIDTH:, ;HEIGHT:) and draw the chosen layers, each by itself:
 * each bead at its width, coloured by its role, travels as thin lines, with a legend and a scale in
 * mm. A bead without a ;WIDTH: gets the width of a stadium (docs/flow.md) that holds its filament.
 * Without ;LAYER_CHANGE a layer begins where a bead has another z than the bead before.
 *
 * "-" is standard input, or standard output. In a layer's picture one SVG unit is 10 um, and
 * <use class="role-N"> are beads, with N an iso_role.
 * ISO_UNREADABLE: no file, nothing that prints in it, a coordinate beyond 10 m.
 * ISO_USAGE: a layer that the file does not have. */
ISO_API iso_status iso_preview_svg(const char *svg_path, const char *gcode_path,
                                   const iso_preview_options *options) ISO_MUST_CHECK;

#endif

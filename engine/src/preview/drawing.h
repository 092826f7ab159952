/* The moves of the chosen layers, and the SVG that shows them. */
#ifndef ISO_PREVIEW_DRAWING_H
#define ISO_PREVIEW_DRAWING_H

#include <stdint.h>

#include <isoslice/geometry.h>
#include <isoslice/preview.h>
#include <isoslice/status.h>

#include "base/output.h"

enum { ISO_PREVIEW_UNITS = 100 }; /* of the drawing, a mm: 10 um are finer than any pixel */

typedef struct iso_preview_stroke { /* in units of the drawing, y up */
    iso_point from, to, centre;
    int32_t width;  /* 0 for a travel */
    int32_t length; /* in space, of what is straight; of an arc that of its chord */
    int8_t turn;
    uint8_t role;
} iso_preview_stroke;

typedef struct iso_preview_panel {
    int32_t layer;        /* from 0 */
    int32_t z, top;       /* um, of its lowest bead and its highest one */
    int64_t first, count; /* strokes; they come one layer after the other */
} iso_preview_panel;

typedef struct iso_preview_drawing {
    int32_t layers; /* of the whole file */
    int32_t panel_count;
    iso_preview_panel *panel; /* ascending layers */
    iso_preview_stroke *stroke;
    int64_t stroke_count, stroke_capacity;
    iso_box box; /* of all beads of all panels, full width */
} iso_preview_drawing;

iso_status iso_preview_draw(iso_output *output, const iso_preview_drawing *drawing,
                            const iso_preview_options *options) ISO_MUST_CHECK;

#endif

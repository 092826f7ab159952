/* Which object is being printed, so that the printer or its host can leave one out. */
#ifndef ISO_GCODE_LABEL_H
#define ISO_GCODE_LABEL_H

#include "gcode/flavour.h"
#include "gcode/lines.h"

/* ISO_BAD_CONFIG if the flavour has no commands for what is asked. */
iso_status iso_labels_check(const iso_gcode_options *options) ISO_MUST_CHECK;

/* All objects, before the first layer. */
void iso_labels_define(iso_lines *lines, const iso_gcode_options *options);

/* Objects that are none (below 0, or not among them) have no label. */
void iso_labels_begin(iso_lines *lines, const iso_gcode_options *options, int32_t object);
void iso_labels_end(iso_lines *lines, const iso_gcode_options *options, int32_t object);

#endif

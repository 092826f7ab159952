/* Settings: options turned into the stages' own. */
#ifndef ISO_CONFIG_SETTINGS_H
#define ISO_CONFIG_SETTINGS_H

#include <isoslice/config.h>
#include <isoslice/fill.h>
#include <isoslice/wall.h>

/* What a layer's paths are made with. */
typedef struct iso_layer_settings {
    iso_wall_options wall;
    int32_t fill_count; /* passes over the same area */
    iso_fill_options fill[2];
    int32_t skirt_loops;    /* first layer only */
    int32_t skirt_distance; /* units, to the middle of the innermost loop */
    iso_bead skirt;
} iso_layer_settings;

/* `index` counts from 0; `height` in mm. */
void settings_of_layer(iso_layer_settings *settings, const iso_options *options, int32_t index,
                       double height);

/* Start and end texts must already be expanded and outlive the result. */
iso_gcode_options settings_of_gcode(const iso_options *options, const char *start, const char *end,
                                    int64_t timestamp);

/* Units by which a section's contours may be thinned. */
int32_t settings_thinning(const iso_options *options);

#endif

/* Layers that would be done too soon are printed more slowly. */
#ifndef ISO_GCODE_COOLING_H
#define ISO_GCODE_COOLING_H

#include <isoslice/gcode.h>

/* One slot a speed: role and speed class. */
enum { ISO_SPEED_SLOTS = 2 * ISO_ROLE_COUNT };

static inline int iso_speed_slot(int role, int speed_class) {
    return 2 * role + (speed_class == 1);
}

/* What a layer asks for. */
typedef struct iso_layer_work {
    double length[ISO_SPEED_SLOTS]; /* mm to extrude */
    double other_time;              /* s: travel and retraction */
} iso_layer_work;

typedef struct iso_layer_pace {
    int32_t feed[ISO_SPEED_SLOTS]; /* mm/min */
    int fan;                       /* percent */
    double time;                   /* s at these feeds, acceleration left out */
} iso_layer_pace;

/* All extrusions but bridges are slowed alike, none below min_print_speed, so that the layer takes
 * slowdown_below_layer_time. The fan blows by the time before that, as PrusaSlicer does. */
void iso_cooling_pace(iso_layer_pace *pace, const iso_layer_work *work,
                      const iso_gcode_options *options, int32_t layer);

#endif

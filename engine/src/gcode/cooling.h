/* What a layer is printed with: feeds, accelerations, fan. Layers that would be done too soon are
 * printed more slowly. */
#ifndef ISO_GCODE_COOLING_H
#define ISO_GCODE_COOLING_H

#include <isoslice/gcode.h>

enum {
    ISO_SPEED_SLOTS = 2 * ISO_ROLE_COUNT, /* one a speed: role and speed class */
    ISO_FEED_BINS = 64,
    ISO_FEED_BIN = 300 /* mm/min that a bin is wide */
};

static inline int iso_speed_slot(int role, int speed_class) {
    return 2 * role + (speed_class == 1);
}

static inline int iso_role_is_bridge(int role) {
    return role == ISO_ROLE_BRIDGE_INFILL || role == ISO_ROLE_OVERHANG_PERIMETER;
}

/* What a layer asks for. Beads whose section is too large for their role's speed are counted by the
 * speed that the flow leaves them. */
typedef struct iso_layer_work {
    double length[ISO_SPEED_SLOTS]; /* mm to extrude */
    double stops[ISO_SPEED_SLOTS];  /* how often it begins anew or turns sharply */
    double limited_length[ISO_FEED_BINS], limited_time[ISO_FEED_BINS]; /* mm, s */
    double other_time; /* s: travel, retraction, and what is neither slowed nor in a slot */
} iso_layer_work;

typedef struct iso_layer_pace {
    int32_t feed[ISO_SPEED_SLOTS];        /* mm/min */
    int32_t most_area[ISO_SPEED_SLOTS];   /* units^2: larger sections are printed more slowly, */
    double flow[ISO_SPEED_SLOTS];         /* by mm^3/s; 0: none is */
    int32_t acceleration[ISO_ROLE_COUNT]; /* mm/s^2 to tell; 0: nothing */
    int fan, bridge_fan;                  /* percent */
    double time;                          /* s */
} iso_layer_pace;

/* The feed in mm/min of a bead of that section, given in units^2. */
int32_t iso_pace_limited_feed(const iso_layer_pace *pace, int slot, double area);

/* Feeds and accelerations by the options alone. */
void iso_cooling_begin(iso_layer_pace *pace, const iso_gcode_options *options, int32_t layer);

/* The fastest extrusions but bridges are slowed to one speed, as fast as it may be, so that the
 * layer takes slowdown_below_layer_time; none below min_print_speed. So outer walls, which are slow
 * already, are the last to change. The fan blows by the time before that, as PrusaSlicer does. */
void iso_cooling_pace(iso_layer_pace *pace, const iso_layer_work *work,
                      const iso_gcode_options *options, int32_t layer);

#endif

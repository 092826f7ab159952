#include "gcode/cooling.h"

#include <math.h>
#include <string.h>

#include "gcode/head.h"

#define SQUARE_UNITS ((double)ISO_UNITS_PER_MM * ISO_UNITS_PER_MM)

static double usual_speed(const iso_gcode_options *options, int slot, int32_t layer) {
    int role = slot / 2, wall = role <= ISO_ROLE_OVERHANG_PERIMETER;
    double speed = layer == 0 ? options->first_layer_speed[role] : options->speed[role];
    double small =
        layer == 0 ? options->first_layer_small_perimeter_speed : options->small_perimeter_speed;
    return wall && slot % 2 ? small : speed;
}

static void set_feed(iso_layer_pace *pace, int slot, int32_t feed) {
    double most = pace->flow[slot] / feed * 60 * SQUARE_UNITS;
    pace->feed[slot] = feed;
    pace->most_area[slot] = most > 0 && most < INT32_MAX ? (int32_t)most : INT32_MAX;
}

int32_t iso_pace_limited_feed(const iso_layer_pace *pace, int slot, double area) {
    double feed = pace->flow[slot] * SQUARE_UNITS / area * 60;
    return feed < 1 ? 1 : feed < pace->feed[slot] ? (int32_t)feed : pace->feed[slot];
}

static double usual_acceleration(const iso_gcode_options *o, int role, int32_t layer) {
    if (!(o->default_acceleration > 0))
        return 0;
    if (layer == 0 && o->first_layer_acceleration > 0)
        return o->first_layer_acceleration;
    return o->role_acceleration[role] > 0 ? o->role_acceleration[role] : o->default_acceleration;
}

void iso_cooling_begin(iso_layer_pace *pace, const iso_gcode_options *o, int32_t layer) {
    double most = o->max_volumetric_speed, share = layer == 0 ? o->first_layer_share : 1;
    double even = o->auto_flow * share;
    for (int s = 0; s < ISO_SPEED_SLOTS; s++) {
        double speed = usual_speed(o, s, layer);
        pace->flow[s] = most;
        if (!(speed > 0)) { /* as fast as an even flow allows */
            speed = o->max_print_speed * share;
            pace->flow[s] = most > 0 && most < even ? most : even;
        }
        set_feed(pace, s, iso_head_feed(speed));
    }
    for (int role = 0; role < ISO_ROLE_COUNT; role++) {
        double acceleration = usual_acceleration(o, role, layer);
        double limit = o->emit_machine_limits ? o->limits.extruding : 0;
        if (limit > 0 && acceleration > limit)
            acceleration = limit;
        pace->acceleration[role] = (int32_t)(acceleration + 0.5);
    }
    pace->fan = pace->bridge_fan = 0;
    pace->time = 0;
}

/* ---- the time of a layer ---- */

/* Seconds for `length` at `speed`, from a stop to a stop `stops` times. */
static double time_with_stops(double length, double speed, double stops, double acceleration) {
    double each = stops > 0 ? length / stops : 0, ramps = speed * speed / acceleration;
    if (stops > 0 && each < ramps)
        return 2 * stops * sqrt(each / acceleration);
    return length / speed + stops * speed / acceleration;
}

typedef struct slowing {
    const iso_layer_work *work;
    const iso_layer_pace *usual;
    double acceleration[ISO_ROLE_COUNT]; /* mm/s^2, that of the machine if nothing is told */
} slowing;

static int is_adjustable(const slowing *s, int slot, int32_t least) {
    return !iso_role_is_bridge(slot / 2) && s->usual->feed[slot] > least;
}

/* Of the layer with no adjustable extrusion faster than `most` mm/min. */
static double time_at(const slowing *s, int32_t most, int32_t least) {
    const iso_layer_work *work = s->work;
    double time = work->other_time;
    for (int slot = 0; slot < ISO_SPEED_SLOTS; slot++) {
        int32_t feed = s->usual->feed[slot];
        if (feed > most && is_adjustable(s, slot, least))
            feed = most;
        if (work->length[slot] > 0)
            time += time_with_stops(work->length[slot], feed / 60.0, work->stops[slot],
                                    s->acceleration[slot / 2]);
    }
    for (int bin = 0; bin < ISO_FEED_BINS; bin++) {
        double slowed = work->limited_length[bin] * 60 / most;
        int free = work->limited_length[bin] * 60 > least * work->limited_time[bin];
        time += free && slowed > work->limited_time[bin] ? slowed : work->limited_time[bin];
    }
    return time;
}

/* The largest feed to which all faster ones can be lowered so that the layer takes `time`. */
static int32_t slowest_needed(const slowing *s, double time, int32_t least) {
    int32_t low = least, high = least;
    for (int slot = 0; slot < ISO_SPEED_SLOTS; slot++)
        if (s->usual->feed[slot] > high)
            high = s->usual->feed[slot];
    while (high - low > 1) {
        int32_t middle = low + (high - low) / 2;
        *(time_at(s, middle, least) >= time ? &low : &high) = middle;
    }
    return low;
}

/* ---- the fan ---- */

static int fan_by_time(const iso_gcode_options *options, double time) {
    int usual = options->fan_always_on ? options->min_fan_speed : 0;
    double shortest = options->slowdown_below_layer_time, longest = options->fan_below_layer_time;
    if (!options->cooling)
        return usual;
    if (time < shortest)
        return options->max_fan_speed;
    if (time >= longest)
        return usual;
    double t = (time - shortest) / (longest - shortest);
    return (int)(options->min_fan_speed * t + options->max_fan_speed * (1 - t) + 0.5);
}

/* Off on the first layers, and then evenly up to what layer time and bridges ask for. */
static void set_fans(iso_layer_pace *pace, const iso_gcode_options *o, int32_t layer) {
    int off = o->disable_fan_first_layers, full = o->full_fan_speed_layer;
    if (off == 0 && full > 0)
        off = 1;
    if (layer < off)
        return;
    double share = layer + 1 < full ? (double)(layer + 1 - off) / (full - off) : 1;
    pace->fan = (int)(fan_by_time(o, pace->time) * share + 0.5);
    pace->bridge_fan = (int)(o->bridge_fan_speed * share + 0.5);
    if (pace->bridge_fan < pace->fan)
        pace->bridge_fan = pace->fan;
}

void iso_cooling_pace(iso_layer_pace *pace, const iso_layer_work *work,
                      const iso_gcode_options *options, int32_t layer) {
    iso_layer_pace usual;
    int32_t least = iso_head_feed(options->min_print_speed), all = INT32_MAX;
    iso_cooling_begin(&usual, options, layer);
    slowing s = {.work = work, .usual = &usual};
    for (int role = 0; role < ISO_ROLE_COUNT; role++)
        s.acceleration[role] =
            usual.acceleration[role] > 0 ? usual.acceleration[role] : options->limits.extruding;
    *pace = usual;
    pace->time = time_at(&s, all, least);
    set_fans(pace, options, layer);
    if (!options->cooling || pace->time >= options->slowdown_below_layer_time)
        return;
    int32_t most = slowest_needed(&s, options->slowdown_below_layer_time, least);
    for (int slot = 0; slot < ISO_SPEED_SLOTS; slot++)
        if (pace->feed[slot] > most && is_adjustable(&s, slot, least))
            set_feed(pace, slot, most);
    pace->time = time_at(&s, most, least);
}

#include "gcode/cooling.h"

#include "gcode/head.h"

static int is_bridge(int slot) {
    int role = slot / 2;
    return role == ISO_ROLE_BRIDGE_INFILL || role == ISO_ROLE_OVERHANG_PERIMETER;
}

static double usual_speed(const iso_gcode_options *options, int slot, int32_t layer) {
    int role = slot / 2, wall = role <= ISO_ROLE_OVERHANG_PERIMETER;
    double speed = layer == 0 ? options->first_layer_speed[role] : options->speed[role];
    double small =
        layer == 0 ? options->first_layer_small_perimeter_speed : options->small_perimeter_speed;
    return wall && slot % 2 && small > 0 ? small : speed;
}

static double time_of(const iso_layer_pace *pace, const iso_layer_work *work) {
    double time = work->other_time;
    for (int s = 0; s < ISO_SPEED_SLOTS; s++)
        time += work->length[s] * 60 / pace->feed[s];
    return time;
}

/* Scale the free feeds by one factor; those that would fall below the least are set to it and leave
 * the race, until all that are left can be scaled. */
static void slow_down(iso_layer_pace *pace, const iso_layer_work *work, double time,
                      int32_t least) {
    int fixed[ISO_SPEED_SLOTS];
    for (int s = 0; s < ISO_SPEED_SLOTS; s++)
        fixed[s] = is_bridge(s) || pace->feed[s] <= least || work->length[s] <= 0;
    for (;;) {
        double free_time = 0, rest = time - work->other_time;
        for (int s = 0; s < ISO_SPEED_SLOTS; s++)
            *(fixed[s] ? &rest : &free_time) +=
                (fixed[s] ? -60 : 60) * work->length[s] / pace->feed[s];
        if (free_time <= rest * 1e-9 || (rest > 0 && free_time >= rest))
            return;
        double factor = rest > 0 ? free_time / rest : 0;
        int clamped = 0;
        for (int s = 0; s < ISO_SPEED_SLOTS; s++)
            if (!fixed[s] && pace->feed[s] * factor <= least) {
                pace->feed[s] = least;
                fixed[s] = clamped = 1;
            }
        if (clamped)
            continue;
        for (int s = 0; s < ISO_SPEED_SLOTS; s++)
            if (!fixed[s]) /* down, so that the time is reached */
                pace->feed[s] = (int32_t)(pace->feed[s] * factor);
        return;
    }
}

static int fan_by_time(const iso_gcode_options *options, double time) {
    int usual = options->fan_always_on ? options->min_fan_speed : 0;
    double shortest = options->slowdown_below_layer_time, longest = options->fan_below_layer_time;
    if (!options->cooling || time >= longest)
        return time < shortest && options->cooling ? options->max_fan_speed : usual;
    if (time < shortest)
        return options->max_fan_speed;
    double t = (time - shortest) / (longest - shortest);
    return (int)(options->min_fan_speed * t + options->max_fan_speed * (1 - t) + 0.5);
}

void iso_cooling_pace(iso_layer_pace *pace, const iso_layer_work *work,
                      const iso_gcode_options *options, int32_t layer) {
    for (int s = 0; s < ISO_SPEED_SLOTS; s++)
        pace->feed[s] = iso_head_feed(usual_speed(options, s, layer));
    pace->time = time_of(pace, work);
    int blows = layer >= options->disable_fan_first_layers;
    pace->fan = blows ? fan_by_time(options, pace->time) : 0;
    if (options->cooling && pace->time < options->slowdown_below_layer_time) {
        slow_down(pace, work, options->slowdown_below_layer_time,
                  iso_head_feed(options->min_print_speed));
        pace->time = time_of(pace, work);
    }
}

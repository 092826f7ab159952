#include "gcode/modes.h"

#include "gcode/number.h"

void iso_modes_start(iso_modes *modes, iso_lines *lines, const iso_gcode_options *options) {
    *modes = (iso_modes){.lines = lines,
                         .words = iso_flavour_get_words(options->flavour),
                         .comments = options->gcode_comments,
                         .tools = options->tools,
                         .fan = -1};
}

void iso_modes_say(iso_modes *modes, const char *command, int64_t number, const char *comment) {
    if (!command)
        return;
    char *p = iso_flavour_put(iso_lines_reserve(modes->lines), command, number, 0);
    iso_lines_accept(modes->lines, iso_modes_end_line(modes, p, comment));
}

void iso_modes_set_fan(iso_modes *modes, int percent) {
    if (percent == modes->fan)
        return;
    modes->fan = percent;
    if (percent > 0)
        iso_modes_say(modes, modes->words->fan, (255 * percent + 50) / 100, "fan on");
    else
        iso_modes_say(modes, modes->words->fan_off, 0, "fan off");
}

void iso_modes_heat_tool(iso_modes *modes, int32_t tool, int degrees, int wait) {
    const char *command = wait ? modes->words->nozzle_wait : modes->words->nozzle;
    if (!command)
        return;
    char *p = iso_lines_reserve(modes->lines);
    p = iso_flavour_put_for_tool(p, command, degrees, tool);
    iso_lines_accept(modes->lines,
                     iso_modes_end_line(modes, p, wait ? "wait for the nozzle" : "nozzle"));
}

void iso_modes_heat_nozzle(iso_modes *modes, int degrees, int wait) {
    const iso_flavour_words *words = modes->words;
    if (degrees <= 0 || (!wait && degrees == modes->nozzle))
        return;
    modes->nozzle = degrees;
    for (int32_t tool = 0; tool < modes->tools && modes->tools > 1; tool++)
        iso_modes_heat_tool(modes, tool, degrees, wait);
    if (modes->tools > 1)
        return;
    iso_modes_say(modes, wait ? words->nozzle_wait : words->nozzle, degrees,
                  wait ? "wait for the nozzle" : "nozzle");
}

void iso_modes_heat_bed(iso_modes *modes, int degrees, int wait) {
    const iso_flavour_words *words = modes->words;
    if (degrees <= 0 || (!wait && degrees == modes->bed))
        return;
    modes->bed = degrees;
    iso_modes_say(modes, wait ? words->bed_wait : words->bed, degrees,
                  wait ? "wait for the bed" : "bed");
}

void iso_modes_accelerate(iso_modes *modes, int32_t acceleration) {
    if (acceleration == 0 || acceleration == modes->acceleration)
        return;
    modes->acceleration = acceleration;
    if (!modes->words->travel_acceleration)
        modes->travel_acceleration = acceleration;
    iso_modes_say(modes, modes->words->acceleration, acceleration, "acceleration");
}

void iso_modes_accelerate_travel(iso_modes *modes, int32_t acceleration) {
    if (!modes->words->travel_acceleration) {
        iso_modes_accelerate(modes, acceleration);
        return;
    }
    if (acceleration == 0 || acceleration == modes->travel_acceleration)
        return;
    modes->travel_acceleration = acceleration;
    iso_modes_say(modes, modes->words->travel_acceleration, acceleration, "travel acceleration");
}

/* ---- the machine's limits ---- */

static char *put_axes(char *p, const char *command, const double value[4], double scale) {
    p = iso_put_text(p, command);
    for (int i = 0; i < 4; i++) {
        *p++ = ' ';
        *p++ = "XYZE"[i];
        p = iso_put_decimal(p, (int64_t)(value[i] * scale * 100 + 0.5), 2);
    }
    return p;
}

static char *put_word(char *p, const char *word, double value) {
    return iso_put_decimal(iso_put_text(p, word), (int64_t)(value * 100 + 0.5), 2);
}

static void end(iso_modes *modes, char *p, const char *comment) {
    iso_lines_accept(modes->lines, iso_modes_end_line(modes, p, comment));
}

/* Legacy Marlin has one acceleration for beads and travel. */
static void say_marlin(iso_modes *modes, const iso_machine_limits *l) {
    double travel = modes->words->travel_acceleration ? l->travel : l->extruding;
    char *p = put_axes(iso_lines_reserve(modes->lines), "M201", l->acceleration, 1);
    end(modes, p, "most acceleration, mm/s^2");
    p = put_axes(iso_lines_reserve(modes->lines), "M203", l->feedrate, 1);
    end(modes, p, "most speed, mm/s");
    p = put_word(iso_lines_reserve(modes->lines), "M204 P", l->extruding);
    p = put_word(put_word(p, " R", l->retracting), " T", travel);
    end(modes, p, "acceleration of beads, retraction and travel, mm/s^2");
    p = put_axes(iso_lines_reserve(modes->lines), "M205", l->jerk, 1);
    end(modes, p, "jerk, mm/s");
}

static void say_duet(iso_modes *modes, const iso_machine_limits *l) {
    char *p = put_axes(iso_lines_reserve(modes->lines), "M201", l->acceleration, 1);
    end(modes, p, "most acceleration, mm/s^2");
    p = put_axes(iso_lines_reserve(modes->lines), "M203", l->feedrate, 60);
    end(modes, p, "most speed, mm/min");
    p = put_word(iso_lines_reserve(modes->lines), "M204 P", l->extruding);
    end(modes, put_word(p, " T", l->travel), "acceleration of beads and travel, mm/s^2");
    p = put_axes(iso_lines_reserve(modes->lines), "M566", l->jerk, 60);
    end(modes, p, "jerk, mm/min");
}

static void say_klipper(iso_modes *modes, const iso_machine_limits *l) {
    double speed = l->feedrate[0] < l->feedrate[1] ? l->feedrate[0] : l->feedrate[1];
    char *p = put_word(iso_lines_reserve(modes->lines), "SET_VELOCITY_LIMIT VELOCITY=", speed);
    end(modes, put_word(p, " ACCEL=", l->extruding), "most speed and acceleration");
}

void iso_modes_say_limits(iso_modes *modes, const iso_machine_limits *limits) {
    switch (modes->words->limits) {
    case ISO_LIMITS_MARLIN:
        say_marlin(modes, limits);
        break;
    case ISO_LIMITS_DUET:
        say_duet(modes, limits);
        break;
    case ISO_LIMITS_KLIPPER:
        say_klipper(modes, limits);
        break;
    case ISO_LIMITS_UNSPOKEN:
        break;
    }
}

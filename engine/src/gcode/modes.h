/* What the machine was last told besides moves: fan, temperatures, acceleration. Commands are
 * written only where something changes. */
#ifndef ISO_GCODE_MODES_H
#define ISO_GCODE_MODES_H

#include "gcode/flavour.h"
#include "gcode/lines.h"

typedef struct iso_modes {
    iso_lines *lines;
    const iso_flavour_words *words;
    int comments; /* behind each command */
    int fan;      /* percent; -1 nobody knows */
    int nozzle, bed;
    int32_t tools;                             /* whose nozzles are as hot as each other */
    int32_t acceleration, travel_acceleration; /* mm/s^2; 0 nobody knows */
} iso_modes;

void iso_modes_start(iso_modes *modes, iso_lines *lines, const iso_gcode_options *options);

/* A command of the flavour's with a number in it; nothing if it has none. */
void iso_modes_say(iso_modes *modes, const char *command, int64_t number, const char *comment);

void iso_modes_set_fan(iso_modes *modes, int percent);
void iso_modes_heat_nozzle(iso_modes *modes, int degrees, int wait); /* 0 degrees: nothing */
/* One of several nozzles, whatever the others are told; 0 degrees: off. */
void iso_modes_heat_tool(iso_modes *modes, int32_t tool, int degrees, int wait);
void iso_modes_heat_bed(iso_modes *modes, int degrees, int wait);

/* For beads, and for travel moves; 0: leave it. */
void iso_modes_accelerate(iso_modes *modes, int32_t acceleration);
void iso_modes_accelerate_travel(iso_modes *modes, int32_t acceleration);

/* All of the machine's limits. */
void iso_modes_say_limits(iso_modes *modes, const iso_machine_limits *limits);

/* The end of a line: the comment, if there are any, and a newline. */
static inline char *iso_modes_end_line(const iso_modes *modes, char *to, const char *comment) {
    if (modes->comments)
        to = iso_put_text(ISO_PUT(to, " ; "), comment);
    return iso_put_newline(to);
}

#endif

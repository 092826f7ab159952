#include "gcode/flavour.h"

#include <string.h>

#include "gcode/number.h"
#include "pose/pose.h"

#define UNITS "G21 ; millimetres\nG90 ; absolute coordinates\n"
#define HEATING                                                                                    \
    .nozzle = "M104 S#", .nozzle_wait = "M109 S#", .bed = "M140 S#", .bed_wait = "M190 S#"
#define HEATING_BY_P                                                                               \
    .nozzle = "M104 P#", .nozzle_wait = "M109 P#", .bed = "M140 P#", .bed_wait = "M190 P#"
#define FAN .fan = "M106 S#", .fan_off = "M107"
#define E_AXIS .axis = " E", .reset_e = "G92 E0"
#define E_WAYS .relative_e = "M83 ; relative E", .absolute_e = "M82 ; absolute E"
#define RETRACTION .retract = "G10", .deretract = "G11"
#define MARLIN                                                                                     \
    HEATING, FAN, E_AXIS, E_WAYS, RETRACTION,                                                      \
        .units = UNITS, .volumetric = "M200 D#", .limits = ISO_LIMITS_MARLIN,                      \
        .labels = ISO_LABELS_MARLIN, .pause = "M0", .color_change = "M600", .progress = 1
#define SPRINTER HEATING, FAN, E_AXIS, E_WAYS, RETRACTION, .units = UNITS, .acceleration = "M204 S#"
#define MAKERBOT                                                                                   \
    .nozzle = "M104 S# T0", .bed = "M140 S#", .bed_wait = "M109 S#", .fan = "M126",                \
    .fan_off = "M127", .axis = " E", RETRACTION, .acceleration = "M204 S#", .progress = 1

/* Marlin 2 has no G93, and counts F in X, Y and Z, or in degrees if none of them moves. Klipper has
 * no word of its own: a manual_stepper takes it (docs/more-axes.md). */
static const iso_flavour_words words[ISO_FLAVOUR_COUNT] = {
    [ISO_FLAVOUR_MARLIN2] = {.name = "marlin2",
                             MARLIN,
                             .acceleration = "M204 P#",
                             .travel_acceleration = "M204 T#",
                             .turns = "ABC"},
    [ISO_FLAVOUR_MARLIN] = {.name = "marlin", MARLIN, .acceleration = "M204 S#"},
    [ISO_FLAVOUR_KLIPPER] = {.name = "klipper",
                             HEATING,
                             FAN,
                             E_AXIS,
                             E_WAYS,
                             RETRACTION,
                             .units = UNITS,
                             .acceleration = "SET_VELOCITY_LIMIT ACCEL=#",
                             .pause = "PAUSE",
                             .color_change = "PAUSE",
                             .limits = ISO_LIMITS_KLIPPER,
                             .labels = ISO_LABELS_KLIPPER,
                             .progress = 1,
                             .turns = "ABC"},
    [ISO_FLAVOUR_REPRAP] = {.name = "reprap", SPRINTER, .progress = 1},
    [ISO_FLAVOUR_REPRAPFIRMWARE] = {.name = "reprapfirmware",
                                    .nozzle = "G10 S# P0",
                                    .nozzle_wait = "G10 S# P0\nM116",
                                    .bed = "M140 S#",
                                    .bed_wait = "M190 S#",
                                    FAN,
                                    E_AXIS,
                                    E_WAYS,
                                    RETRACTION,
                                    .units = UNITS,
                                    .acceleration = "M204 P#",
                                    .travel_acceleration = "M204 T#",
                                    .volumetric = "M200 D#",
                                    .pause = "M226",
                                    .color_change = "M600",
                                    .limits = ISO_LIMITS_DUET,
                                    .labels = ISO_LABELS_DUET,
                                    .progress = 1,
                                    .turns = "ABC",
                                    .inverse_time = 1},
    [ISO_FLAVOUR_REPETIER] = {.name = "repetier",
                              HEATING,
                              FAN,
                              E_AXIS,
                              E_WAYS,
                              RETRACTION,
                              .units = UNITS,
                              .acceleration = "M201 X# Y#\nM202 X# Y#",
                              .volumetric = "M200 D#",
                              .turns = "ABC"},
    [ISO_FLAVOUR_SMOOTHIE] = {.name = "smoothie",
                              SPRINTER,
                              .volumetric = "M200 D#",
                              .pause = "M600",
                              .color_change = "M600"},
    [ISO_FLAVOUR_TEACUP] = {.name = "teacup",
                            .nozzle = "M104 S#",
                            .nozzle_wait = "M104 S#\nM116",
                            .bed = "M140 S#",
                            .bed_wait = "M140 S#\nM116",
                            .fan = "M106 S#",
                            .fan_off = "M106 S0",
                            E_AXIS,
                            E_WAYS,
                            RETRACTION,
                            .units = UNITS,
                            .acceleration = "M204 S#"},
    [ISO_FLAVOUR_MACHINEKIT] = {.name = "machinekit",
                                HEATING_BY_P,
                                .fan = "M106 P#",
                                .fan_off = "M107",
                                .axis = " A",
                                .reset_e = "G92 A0",
                                .retract = "G22",
                                .deretract = "G23",
                                .units = UNITS,
                                .acceleration = "M204 S#",
                                .turns = "BC",
                                .inverse_time = 1},
    [ISO_FLAVOUR_MACH3] = {.name = "mach3",
                           HEATING_BY_P,
                           .fan = "M106 P#",
                           .fan_off = "M107",
                           .axis = " A",
                           RETRACTION,
                           .units = UNITS,
                           .acceleration = "M204 S#",
                           .turns = "BC",
                           .inverse_time = 1},
    [ISO_FLAVOUR_SAILFISH] = {.name = "sailfish", MAKERBOT, .units = UNITS, .tool = "M108 T#"},
    [ISO_FLAVOUR_MAKERWARE] = {.name = "makerware",
                               MAKERBOT,
                               .units = "",
                               .retracted = "M103",
                               .deretracting = "M101",
                               .tool = "M135 T#"},
    [ISO_FLAVOUR_NO_EXTRUSION] = {.name = "no-extrusion",
                                  HEATING,
                                  FAN,
                                  .units = UNITS,
                                  .axis = "",
                                  .acceleration = "M204 S#",
                                  .turns = "ABC",
                                  .inverse_time = 1},
};

const iso_flavour_words *iso_flavour_get_words(iso_flavour flavour) {
    return &words[(unsigned)flavour < ISO_FLAVOUR_COUNT ? flavour : ISO_FLAVOUR_MARLIN2];
}

iso_status iso_flavour_check_machine(const iso_gcode_options *options) {
    const iso_flavour_words *of = iso_flavour_get_words(options->flavour);
    const char *letters = of->turns ? of->turns : "";
    for (int i = 0; pose_turns(options->machine) && i < 2; i++) {
        const char *letter = pose_letter(options->machine, i);
        if (*letter && !strstr(letters, letter))
            return iso_fail(ISO_BAD_CONFIG,
                            "kinematics: %s has no axis %s that turns the part%s; see "
                            "docs/more-axes.md for flavours that have",
                            of->name, letter,
                            strcmp(of->axis, " A") == 0 ? ", A is its filament" : "");
    }
    if (pose_turns(options->machine) && options->rotary_feed == ISO_FEED_INVERSE_TIME &&
        !of->inverse_time)
        return iso_fail(ISO_BAD_CONFIG,
                        "rotary_feed: %s has no G93; take compensated in place of inverse_time",
                        of->name);
    return ISO_OK;
}

char *iso_flavour_put(char *to, const char *command, int64_t number, int decimals) {
    for (; *command; command++)
        if (*command == '#')
            to = iso_put_decimal(to, number, decimals);
        else
            *to++ = *command;
    return to;
}

/* Behind the first line's words, instead of a tool that is named there. */
char *iso_flavour_put_for_tool(char *to, const char *command, int64_t number, int32_t tool) {
    char line[64];
    size_t end = strcspn(command, "\n");
    char letter = 'T';
    const char *rest = command + end;
    if (end > 3 && command[end - 1] == '0' && strchr("TP", command[end - 2])) {
        letter = command[end - 2];
        end -= 3;
    }
    memcpy(line, command, end);
    line[end] = '\0';
    to = iso_flavour_put(to, line, number, 0);
    *to++ = ' ';
    *to++ = letter;
    to = iso_put_decimal(to, tool, 0);
    return iso_flavour_put(to, rest, number, 0);
}

char *iso_flavour_put_tool(char *to, const iso_flavour_words *of, int32_t tool) {
    return iso_flavour_put(to, of->tool ? of->tool : "T#", tool, 0);
}

iso_status iso_flavour_from_name(iso_flavour *flavour, const char *name) {
    char known[256] = "";
    for (int i = 0; i < ISO_FLAVOUR_COUNT; i++) {
        if (strcmp(name, words[i].name) == 0) {
            *flavour = (iso_flavour)i;
            return ISO_OK;
        }
        strcat(i > 0 ? strcat(known, ", ") : known, words[i].name);
    }
    return iso_fail(ISO_BAD_CONFIG, "gcode_flavor: \"%s\" is not known; there are %s", name, known);
}

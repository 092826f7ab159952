/* What differs from firmware to firmware, as data. The words are those that PrusaSlicer writes for
 * its gcode_flavor of the same name; Klipper's are from its own manual. */
#ifndef ISO_GCODE_FLAVOUR_H
#define ISO_GCODE_FLAVOUR_H

#include <isoslice/gcode.h>

/* How the firmware is told the machine's limits. */
typedef enum iso_limits_dialect {
    ISO_LIMITS_UNSPOKEN,
    ISO_LIMITS_MARLIN, /* M201, M203 in mm/s, M204 P R T, M205 */
    ISO_LIMITS_DUET,   /* M201, M203 in mm/min, M204 P T, M566 in mm/min */
    ISO_LIMITS_KLIPPER /* SET_VELOCITY_LIMIT */
} iso_limits_dialect;

typedef enum iso_label_dialect {
    ISO_LABELS_UNSPOKEN,
    ISO_LABELS_MARLIN, /* M486 T, S */
    ISO_LABELS_DUET,   /* M486 S A"name" */
    ISO_LABELS_KLIPPER /* EXCLUDE_OBJECT_... */
} iso_label_dialect;

/* Commands may be several lines; # stands for the number. NULL: there is no such command. */
typedef struct iso_flavour_words {
    const char *name;                                  /* as the configuration has it */
    const char *nozzle, *nozzle_wait, *bed, *bed_wait; /* degrees Celsius */
    const char *fan, *fan_off;                         /* 0 to 255 */
    const char *units, *relative_e, *absolute_e, *reset_e;
    const char *axis;                     /* of the filament: " E", or "" */
    const char *retract, *deretract;      /* by the firmware */
    const char *retracted, *deretracting; /* said besides the moves */
    const char *acceleration;             /* mm/s^2 */
    const char *travel_acceleration;      /* NULL: the one for all moves */
    const char *volumetric;               /* E in mm^3, # the filament's diameter in mm */
    const char *pause, *color_change;     /* if the user's texts are empty */
    const char *tool;                     /* takes another; NULL: T# */
    iso_limits_dialect limits;
    iso_label_dialect labels;
    int progress;      /* understands M73 */
    const char *turns; /* letters of the axes that may turn the part; NULL: none */
    int inverse_time;  /* understands G93 and G94 */
} iso_flavour_words;

const iso_flavour_words *iso_flavour_get_words(iso_flavour flavour);

/* Does the flavour have the words for how the machine turns the part? ISO_BAD_CONFIG: no. */
iso_status iso_flavour_check_machine(const iso_gcode_options *options) ISO_MUST_CHECK;

/* The command with the number, in `decimals` decimals, for each #; returns the end. No newline. */
char *iso_flavour_put(char *to, const char *command, int64_t number, int decimals);

/* The same for one of several nozzles: tool 0 that it names, or a word T, becomes this one. */
char *iso_flavour_put_for_tool(char *to, const char *command, int64_t number, int32_t tool);

/* The command that takes a tool. */
char *iso_flavour_put_tool(char *to, const iso_flavour_words *of, int32_t tool);

#endif

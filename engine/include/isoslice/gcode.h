/* G-code: what the printer is told besides the paths. */
#ifndef ISOSLICE_GCODE_H
#define ISOSLICE_GCODE_H

#include <stddef.h>

#include <isoslice/path.h>

typedef enum iso_flavour {
    ISO_FLAVOUR_MARLIN2,
    ISO_FLAVOUR_MARLIN,
    ISO_FLAVOUR_KLIPPER,
    ISO_FLAVOUR_REPRAP,
    ISO_FLAVOUR_REPRAPFIRMWARE,
    ISO_FLAVOUR_REPETIER,
    ISO_FLAVOUR_SMOOTHIE,
    ISO_FLAVOUR_TEACUP,
    ISO_FLAVOUR_MACHINEKIT,
    ISO_FLAVOUR_MACH3,
    ISO_FLAVOUR_SAILFISH,
    ISO_FLAVOUR_MAKERWARE,
    ISO_FLAVOUR_NO_EXTRUSION,
    ISO_FLAVOUR_COUNT
} iso_flavour;

/* PrusaSlicer's gcode_flavor names (marlin2, no-extrusion), and klipper. ISO_BAD_CONFIG for others.
 */
ISO_API iso_status iso_flavour_from_name(iso_flavour *flavour, const char *name) ISO_MUST_CHECK;

typedef enum iso_kinematics {
    ISO_KINEMATICS_CARTESIAN,
    ISO_KINEMATICS_ROTARY_A, /* a mandrel along X */
    ISO_KINEMATICS_ROTARY_B, /* along Y */
    ISO_KINEMATICS_TABLE_AC, /* a table that tilts around X, and turns */
    ISO_KINEMATICS_TABLE_BC  /* around Y, and turns */
} iso_kinematics;

typedef enum iso_feed_mode {
    ISO_FEED_COMPENSATED, /* F such that the nozzle moves over the part as fast as it is to, for a
                           * machine whose F counts X, Y and Z alone */
    ISO_FEED_INVERSE_TIME /* G93: F is one over the minutes of each move */
} iso_feed_mode;

/* Texts of the user's, by where they stand. */
typedef enum iso_gcode_text_kind {
    ISO_TEXT_START,           /* before the print; asked for if start_gcode is NULL */
    ISO_TEXT_END,             /* after it; asked for if end_gcode is NULL */
    ISO_TEXT_START_FILAMENT,  /* after the start */
    ISO_TEXT_END_FILAMENT,    /* before the end */
    ISO_TEXT_BEFORE_LAYER,    /* at every layer, before the nozzle rises to it */
    ISO_TEXT_LAYER,           /* at every layer, once it is there */
    ISO_TEXT_BETWEEN_OBJECTS, /* of objects printed one after the other */
    ISO_TEXT_TOOLCHANGE,      /* before another tool is taken; also taking it, if it likes */
    ISO_TEXT_COLOR_CHANGE,
    ISO_TEXT_PAUSE,
    ISO_TEXT_TEMPLATE,
    ISO_TEXT_EVENT, /* one given in `events` itself: the place has it */
    ISO_TEXT_KIND_COUNT
} iso_gcode_text_kind;

enum { ISO_TOOLS_MOST = 2 }; /* of one print */

typedef struct iso_gcode_place {
    int32_t layer;                         /* from 0; -1 before the first one */
    double z;                              /* mm: the layer's top, z_offset left out */
    double max_z;                          /* mm: the highest top so far */
    int32_t object;                        /* that is coming, or -1 */
    const char *event;                     /* of ISO_TEXT_EVENT: the text as it was given */
    int32_t tool, next_tool, tool_changes; /* of ISO_TEXT_TOOLCHANGE; so far, this one included */
} iso_gcode_place;

/* Write the text of that kind into text[size], terminated; "" for none. A failure ends the job. */
typedef iso_status iso_gcode_text(char *text, size_t size, const void *payload,
                                  iso_gcode_text_kind kind, const iso_gcode_place *place);

/* An object as the labels name it; the path's `object` is its index. Belongs to the caller. */
typedef struct iso_gcode_object {
    const char *name;        /* of its model; characters that a command can't hold are replaced */
    int32_t model;           /* the model's number, from 0 */
    int32_t copy;            /* among the model's copies, from 0 */
    iso_vec2 center;         /* mm on the bed */
    const iso_vec2 *outline; /* [outline_count] mm on the bed: a polygon around it */
    int32_t outline_count;
} iso_gcode_object;

typedef enum iso_label_style {
    ISO_LABELS_DISABLED,
    ISO_LABELS_OCTOPRINT, /* comments */
    ISO_LABELS_FIRMWARE   /* commands of the flavour */
} iso_label_style;

/* What the machine is able to. */
typedef struct iso_machine_limits {
    double feedrate[4], acceleration[4], jerk[4]; /* x, y, z, e: mm/s, mm/s^2, mm/s */
    double extruding, retracting, travel;         /* mm/s^2, until the G-code says otherwise */
    double junction_deviation;                    /* mm */
} iso_machine_limits;

/* A move as it is written: where the tip of the nozzle goes, whichever axes bring it there. Places
 * are the part's, as it stands on the bed with all angles 0, z_offset left out, and rounded as the
 * file has them. A move that turns the part a lot is told in pieces. */
typedef struct iso_gcode_move {
    iso_vec3 from, to;               /* mm */
    iso_vec3 from_normal, to_normal; /* unit: where the tool comes from, if the part turns; else the
                                      * layer's, across the bead */
    double width, height;            /* mm of the bead it leaves; 0: a travel */
} iso_gcode_move;

/* Told of every move, in order, from the first place that is known; not of those that the user's
 * texts make. A failure ends the job. */
typedef iso_status iso_gcode_watch(void *payload, const iso_gcode_move *move);

struct pose_machine; /* pose/pose.h */

/* Lengths in mm, speeds in mm/s, accelerations in mm/s^2, temperatures in degrees Celsius, fan
 * speeds in percent, times in s. Names and meaning are PrusaSlicer's where it has them. Texts
 * belong to the caller and must outlive the writer; NULL is "". */
typedef struct iso_gcode_options {
    iso_flavour flavour;
    int use_relative_e_distances;
    int use_volumetric_e;
    int use_firmware_retraction;

    double speed[ISO_ROLE_COUNT]; /* 0: as auto_flow allows */
    double small_perimeter_speed; /* of perimeters with speed class 1; 0: as auto_flow allows */
    double first_layer_speed[ISO_ROLE_COUNT];
    double first_layer_small_perimeter_speed;
    double max_print_speed;      /* of speeds that are 0 */
    double auto_flow;            /* mm^3/s of speeds that are 0 */
    double first_layer_share;    /* of those two on the first layer */
    double max_volumetric_speed; /* mm^3/s of all; 0: no limit */
    double travel_speed;
    double travel_speed_z; /* 0: travel_speed */

    double default_acceleration;     /* 0: say nothing of acceleration, whatever the others are */
    double first_layer_acceleration; /* 0: as above it */
    double role_acceleration[ISO_ROLE_COUNT]; /* 0: default_acceleration */
    double travel_acceleration;               /* 0: docs/gcode.md */
    iso_machine_limits limits;
    int emit_machine_limits; /* tell the firmware at the start */

    double filament_diameter, filament_density /* g/cm^3 */, extrusion_multiplier;
    double filament_cost; /* per kg */

    double retract_length, retract_speed;
    double deretract_speed; /* 0: retract_speed */
    double retract_restart_extra, retract_before_travel, retract_lift;
    double retract_lift_above, retract_lift_below; /* z; below 0: no limit */
    int retract_layer_change;
    int wipe;                   /* while the filament is drawn back; not by the firmware */
    double retract_before_wipe; /* share of retract_length, 0 to 1 */

    int32_t tools; /* of the paths, numbers below it; at most ISO_TOOLS_MOST; 0: one. All are
                    * alike in filament, retraction and temperature */
    int temperature, first_layer_temperature; /* 0: say nothing */
    int bed_temperature, first_layer_bed_temperature;

    int cooling; /* slow down and blow by layer time */
    int fan_always_on;
    int min_fan_speed, max_fan_speed, bridge_fan_speed;
    int disable_fan_first_layers, full_fan_speed_layer;
    double fan_below_layer_time, slowdown_below_layer_time, min_print_speed;

    double z_offset;     /* in the layers' z already: to be left out of comments */
    int gcode_comments;  /* say behind every line what it is for */
    int remaining_times; /* M73 P R: progress and minutes left */

    iso_label_style labels;
    const iso_gcode_object *object; /* [object_count] for the labels; must outlive the writer */
    int32_t object_count;

    /* What happens at which heights: "5.2:color;8:pause;10:template;12.4:M300", and filament
     * changes besides. */
    const char *events;
    const double *colorprint_height; /* [colorprint_count] mm */
    int32_t colorprint_count;

    const struct pose_machine *machine; /* must outlive the writer; NULL: the part never turns */
    iso_feed_mode rotary_feed;          /* of a machine that turns it */
    iso_gcode_watch *watch;             /* or NULL */
    void *watch_payload;

    const char *start_gcode, *end_gcode;
    iso_gcode_text *text; /* of all other texts; or NULL: there are none */
    const void *text_payload;
    const char *generator; /* "isoslice 0.1.0" */
    int64_t timestamp;     /* seconds since 1970, UTC, of the first line */
} iso_gcode_options;

ISO_API iso_gcode_options iso_gcode_defaults(void);

/* Of a whole job. */
typedef struct iso_gcode_totals {
    double filament_mm, filament_cm3, filament_g, filament_cost;
    double time;             /* s, trapezoids with look-ahead (docs/gcode.md) */
    double idle_time;        /* s of those that extrude nothing: travel, retraction, z */
    double first_layer_time; /* s */
    double bead_mm, travel_mm;
    int64_t moves, retractions, layers;
    double tool_mm[ISO_TOOLS_MOST]; /* of filament; with several tools */
    int64_t tool_changes;
    int64_t bytes;
} iso_gcode_totals;

#endif

/* G-code: what the printer is told besides the paths. */
#ifndef ISOSLICE_GCODE_H
#define ISOSLICE_GCODE_H

#include <stddef.h>

#include <isoslice/path.h>

typedef enum iso_flavour { ISO_FLAVOUR_MARLIN2, ISO_FLAVOUR_MARLIN, ISO_FLAVOUR_COUNT } iso_flavour;

/* PrusaSlicer's gcode_flavor names: marlin2, marlin. ISO_BAD_CONFIG for others. */
ISO_API iso_status iso_flavour_from_name(iso_flavour *flavour, const char *name) ISO_MUST_CHECK;

/* Write the text of a layer into text[size]; `index` counts from 0, z in mm is its top. */
typedef iso_status iso_gcode_layer_text(char *text, size_t size, const void *payload, int32_t index,
                                        double z);

/* Lengths in mm, speeds in mm/s, accelerations in mm/s^2, temperatures in degrees Celsius, fan
 * speeds in percent, times in s. Names and meaning are PrusaSlicer's where it has them. Texts
 * belong to the caller and must outlive the writer; NULL is "". */
typedef struct iso_gcode_options {
    iso_flavour flavour;
    int use_relative_e_distances;

    double speed[ISO_ROLE_COUNT];
    double small_perimeter_speed; /* of perimeters with speed class 1; 0: as the others */
    double first_layer_speed[ISO_ROLE_COUNT];
    double first_layer_small_perimeter_speed;
    double travel_speed;
    double travel_speed_z; /* 0: travel_speed */

    double filament_diameter, filament_density /* g/cm^3 */, extrusion_multiplier;

    double retract_length, retract_speed;
    double deretract_speed; /* 0: retract_speed */
    double retract_restart_extra, retract_before_travel, retract_lift;

    int temperature, first_layer_temperature; /* 0: say nothing */
    int bed_temperature, first_layer_bed_temperature;

    int cooling; /* slow down and blow by layer time */
    int fan_always_on;
    int min_fan_speed, max_fan_speed;
    int disable_fan_first_layers;
    double fan_below_layer_time, slowdown_below_layer_time, min_print_speed;

    /* for the estimate of the time alone */
    double acceleration, travel_acceleration, retract_acceleration;
    double junction_deviation;
    double max_speed_z;

    int remaining_times; /* M73 P R: progress and minutes left */
    const char *start_gcode, *end_gcode;
    iso_gcode_layer_text *layer_text; /* of what comes once a layer's height is reached; or NULL */
    const void *layer_payload;
    const char *generator; /* "isoslice 0.1.0" */
    int64_t timestamp;     /* seconds since 1970, UTC, of the first line */
} iso_gcode_options;

ISO_API iso_gcode_options iso_gcode_defaults(void);

/* Of a whole job. */
typedef struct iso_gcode_totals {
    double filament_mm, filament_cm3, filament_g;
    double time;      /* s, trapezoids with junction deviation and look-ahead */
    double idle_time; /* s of those that extrude nothing: travel, retraction, z */
    double bead_mm, travel_mm;
    int64_t moves, retractions, layers;
    int64_t bytes;
} iso_gcode_totals;

#endif

#include <isoslice/gcode.h>
#include <isoslice/version.h>

iso_gcode_options iso_gcode_defaults(void) {
    iso_gcode_options options = {
        .flavour = ISO_FLAVOUR_MARLIN2,
        .use_relative_e_distances = 1,
        .speed = {[ISO_ROLE_EXTERNAL_PERIMETER] = 30,
                  [ISO_ROLE_PERIMETER] = 60,
                  [ISO_ROLE_OVERHANG_PERIMETER] = 60,
                  [ISO_ROLE_INTERNAL_INFILL] = 80,
                  [ISO_ROLE_SOLID_INFILL] = 20,
                  [ISO_ROLE_TOP_SOLID_INFILL] = 15,
                  [ISO_ROLE_IRONING] = 15,
                  [ISO_ROLE_BRIDGE_INFILL] = 60,
                  [ISO_ROLE_GAP_FILL] = 20,
                  [ISO_ROLE_SKIRT] = 60,
                  [ISO_ROLE_SUPPORT] = 60,
                  [ISO_ROLE_SUPPORT_INTERFACE] = 60,
                  [ISO_ROLE_CUSTOM] = 60},
        .small_perimeter_speed = 15,
        .first_layer_small_perimeter_speed = 30,
        .max_print_speed = 80,
        .auto_flow = 5,
        .first_layer_share = 1,
        .travel_speed = 130,
        .filament_diameter = 1.75,
        .filament_density = 1.24,
        .extrusion_multiplier = 1,
        .retract_length = 2,
        .retract_speed = 40,
        .retract_before_travel = 2,
        .temperature = 200,
        .first_layer_temperature = 200,
        .cooling = 1,
        .min_fan_speed = 35,
        .max_fan_speed = 100,
        .bridge_fan_speed = 100,
        .disable_fan_first_layers = 3,
        .fan_below_layer_time = 60,
        .slowdown_below_layer_time = 5,
        .min_print_speed = 10,
        .limits = {.feedrate = {500, 500, 12, 120},
                   .acceleration = {9000, 9000, 500, 10000},
                   .jerk = {10, 10, 0.2, 2.5},
                   .extruding = 1000,
                   .retracting = 1000,
                   .travel = 1000,
                   .junction_deviation = 0.013},
        .remaining_times = 1,
        .start_gcode = "G28 ; home all axes\nG1 Z5 F5000 ; lift nozzle\n",
        .end_gcode = "M104 S0 ; turn off temperature\nM140 S0 ; turn off bed\n"
                     "G28 X0 ; home X axis\nM84 ; disable motors\n",
        .generator = "isoslice " ISO_VERSION,
    };
    for (int role = 0; role < ISO_ROLE_COUNT; role++)
        options.first_layer_speed[role] = 30;
    return options;
}

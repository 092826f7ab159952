/* Options turned into those of the G-code. */
#include <isoslice/version.h>

#include "config/settings.h"

/* The flow of the thinnest bead whose speed is 0 at max_print_speed: at that flow all such beads
 * stay below it. Gap fill and ironing have speeds of their own. */
static double auto_flow(const iso_options *options) {
    static const iso_role roles[] = {
        ISO_ROLE_EXTERNAL_PERIMETER, ISO_ROLE_PERIMETER,        ISO_ROLE_INTERNAL_INFILL,
        ISO_ROLE_SOLID_INFILL,       ISO_ROLE_TOP_SOLID_INFILL, ISO_ROLE_BRIDGE_INFILL,
    };
    double least = 0, height = options->layer_height;
    for (size_t i = 0; i < sizeof roles / sizeof *roles; i++) {
        bool small = i < 2 && !(iso_options_speed(options, roles[i], true, false) > 0);
        if (iso_options_speed(options, roles[i], false, false) > 0 && !small)
            continue;
        double width = iso_options_width(options, roles[i], false, height);
        double area = iso_bead_of(iso_units(width), iso_units(height)).area * 1e-8; /* mm^2 */
        least = least > 0 && least < area ? least : area;
    }
    return least * options->max_print_speed;
}

static double lower(double a, double b) {
    return a > 0 && (a < b || !(b > 0)) ? a : b;
}

static void set_speeds(iso_gcode_options *g, const iso_options *options) {
    for (int role = 0; role < ISO_ROLE_COUNT; role++) {
        g->speed[role] = iso_options_speed(options, (iso_role)role, false, false);
        g->first_layer_speed[role] = iso_options_speed(options, (iso_role)role, false, true);
    }
    g->small_perimeter_speed = iso_options_speed(options, ISO_ROLE_EXTERNAL_PERIMETER, true, false);
    g->first_layer_small_perimeter_speed =
        iso_options_speed(options, ISO_ROLE_EXTERNAL_PERIMETER, true, true);
    g->max_print_speed = options->max_print_speed;
    g->auto_flow = auto_flow(options);
    g->first_layer_share =
        options->first_layer_speed.percent ? options->first_layer_speed.value / 100 : 1;
    g->max_volumetric_speed =
        lower(options->max_volumetric_speed, options->filament_max_volumetric_speed);
    g->travel_speed = options->travel_speed;
    g->travel_speed_z = options->travel_speed_z;
}

/* Roles without one of their own take that of the more general ones. */
static void set_accelerations(iso_gcode_options *g, const iso_options *options) {
    double *of = g->role_acceleration;
    of[ISO_ROLE_PERIMETER] = options->perimeter_acceleration;
    of[ISO_ROLE_EXTERNAL_PERIMETER] = options->external_perimeter_acceleration;
    of[ISO_ROLE_INTERNAL_INFILL] = options->infill_acceleration;
    of[ISO_ROLE_SOLID_INFILL] = options->solid_infill_acceleration;
    of[ISO_ROLE_TOP_SOLID_INFILL] = options->top_solid_infill_acceleration;
    of[ISO_ROLE_BRIDGE_INFILL] = of[ISO_ROLE_OVERHANG_PERIMETER] = options->bridge_acceleration;
    static const iso_role general[][2] = {{ISO_ROLE_EXTERNAL_PERIMETER, ISO_ROLE_PERIMETER},
                                          {ISO_ROLE_OVERHANG_PERIMETER, ISO_ROLE_PERIMETER},
                                          {ISO_ROLE_SOLID_INFILL, ISO_ROLE_INTERNAL_INFILL},
                                          {ISO_ROLE_TOP_SOLID_INFILL, ISO_ROLE_SOLID_INFILL},
                                          {ISO_ROLE_IRONING, ISO_ROLE_SOLID_INFILL},
                                          {ISO_ROLE_BRIDGE_INFILL, ISO_ROLE_SOLID_INFILL}};
    for (size_t i = 0; i < sizeof general / sizeof *general; i++)
        if (!(of[general[i][0]] > 0))
            of[general[i][0]] = of[general[i][1]];
    g->default_acceleration = options->default_acceleration;
    g->first_layer_acceleration = options->first_layer_acceleration;
    g->travel_acceleration = options->travel_acceleration;
}

static void set_cooling(iso_gcode_options *g, const iso_options *options) {
    g->cooling = options->cooling;
    g->fan_always_on = options->fan_always_on;
    g->min_fan_speed = options->min_fan_speed;
    g->max_fan_speed = options->max_fan_speed;
    g->bridge_fan_speed = options->bridge_fan_speed;
    g->disable_fan_first_layers = options->disable_fan_first_layers;
    g->full_fan_speed_layer = options->full_fan_speed_layer;
    g->fan_below_layer_time = options->fan_below_layer_time;
    g->slowdown_below_layer_time = options->slowdown_below_layer_time;
    g->min_print_speed = options->min_print_speed;
}

/* If they are to be ignored, those of an ordinary machine remain for the estimate. Legacy Marlin
 * has no junction deviation, and one acceleration for beads and travel. */
static void set_limits(iso_gcode_options *g, const iso_options *o) {
    if (o->machine_limits_usage == ISO_LIMITS_IGNORE)
        return;
    g->emit_machine_limits = o->machine_limits_usage == ISO_LIMITS_EMIT;
    g->limits = (iso_machine_limits){
        .feedrate = {o->machine_max_feedrate_x, o->machine_max_feedrate_y,
                     o->machine_max_feedrate_z, o->machine_max_feedrate_e},
        .acceleration = {o->machine_max_acceleration_x, o->machine_max_acceleration_y,
                         o->machine_max_acceleration_z, o->machine_max_acceleration_e},
        .jerk = {o->machine_max_jerk_x, o->machine_max_jerk_y, o->machine_max_jerk_z,
                 o->machine_max_jerk_e},
        .extruding = o->machine_max_acceleration_extruding,
        .retracting = o->machine_max_acceleration_retracting,
        .travel = o->machine_max_acceleration_travel,
        .junction_deviation = o->machine_max_junction_deviation};
    if (g->flavour == ISO_FLAVOUR_MARLIN) {
        g->limits.travel = g->limits.extruding;
        g->limits.junction_deviation = 0;
    }
}

static void set_machine(iso_gcode_options *g, const iso_options *options) {
    g->flavour = (iso_flavour)options->gcode_flavor;
    g->use_relative_e_distances = options->use_relative_e_distances;
    g->use_volumetric_e = options->use_volumetric_e;
    g->use_firmware_retraction = options->use_firmware_retraction;
    g->temperature = options->temperature;
    g->first_layer_temperature = options->first_layer_temperature;
    g->bed_temperature = options->bed_temperature;
    g->first_layer_bed_temperature = options->first_layer_bed_temperature;
    g->z_offset = options->z_offset;
    g->rotary_feed = (iso_feed_mode)options->rotary_feed;
}

static void set_filament(iso_gcode_options *g, const iso_options *options) {
    g->filament_diameter = options->filament_diameter;
    g->filament_density = options->filament_density;
    g->filament_cost = options->filament_cost;
    g->extrusion_multiplier = options->extrusion_multiplier;
    g->retract_length = options->retract_length;
    g->retract_speed = options->retract_speed;
    g->deretract_speed = options->deretract_speed;
    g->retract_restart_extra = options->retract_restart_extra;
    g->retract_before_travel = options->retract_before_travel;
    g->retract_lift = options->retract_lift;
    g->retract_lift_above = options->retract_lift_above;
    g->retract_lift_below = options->retract_lift_below;
    g->retract_layer_change = options->retract_layer_change;
    g->wipe = options->wipe;
    g->retract_before_wipe = options->retract_before_wipe / 100;
}

static void set_texts(iso_gcode_options *g, const iso_options *options, const iso_texts *texts) {
    g->text = texts ? texts_write : NULL;
    g->text_payload = texts;
    g->start_gcode = g->end_gcode = texts ? NULL : "";
    g->events = options->events;
    g->colorprint_height = options->colorprint_heights.value;
    g->colorprint_count = options->colorprint_heights.count;
    g->gcode_comments = options->gcode_comments;
    g->remaining_times = options->remaining_times;
    g->labels = (iso_label_style)options->gcode_label_objects;
}

iso_gcode_options settings_of_gcode(const iso_options *options, const iso_texts *texts,
                                    int64_t timestamp) {
    iso_gcode_options g = iso_gcode_defaults();
    set_machine(&g, options);
    set_speeds(&g, options);
    set_accelerations(&g, options);
    set_cooling(&g, options);
    set_limits(&g, options);
    set_filament(&g, options);
    set_texts(&g, options, texts);
    g.generator = "isoslice " ISO_VERSION;
    g.timestamp = timestamp;
    return g;
}

/* ---- turning the part ---- */

static iso_vec3 bed_middle(const iso_points *bed) {
    iso_vec2 low = bed->point[0], high = low;
    for (int32_t i = 1; i < bed->count; i++) {
        iso_vec2 p = bed->point[i];
        low = (iso_vec2){p.x < low.x ? p.x : low.x, p.y < low.y ? p.y : low.y};
        high = (iso_vec2){p.x > high.x ? p.x : high.x, p.y > high.y ? p.y : high.y};
    }
    return (iso_vec3){(low.x + high.x) / 2, (low.y + high.y) / 2, 0};
}

static iso_status set_range(pose_machine *machine, int axis, const iso_numbers *limits,
                            const char *key) {
    if (limits->count != 2 || !(limits->value[0] < limits->value[1]))
        return iso_fail(ISO_BAD_CONFIG, "%s: give the least and the greatest angle, as -90,90",
                        key);
    machine->low[axis] = limits->value[0];
    machine->high[axis] = limits->value[1];
    return ISO_OK;
}

iso_status settings_of_machine(pose_machine *machine, const iso_options *options) {
    const iso_numbers *pivot = &options->kinematics_pivot;
    pose_machine m = {.kinematics = (iso_kinematics)options->kinematics,
                      .fastest = {options->tilt_speed, options->turn_speed}};
    if (pivot->count != 0 && pivot->count != 3)
        return iso_fail(ISO_BAD_CONFIG, "kinematics_pivot: give X,Y,Z, three numbers; there are %d",
                        pivot->count);
    m.pivot = pivot->count == 3 ? (iso_vec3){pivot->value[0], pivot->value[1], pivot->value[2]}
                                : bed_middle(&options->bed_shape);
    ISO_TRY(set_range(&m, 0, &options->tilt_limits, "tilt_limits"));
    ISO_TRY(set_range(&m, 1, &options->turn_limits, "turn_limits"));
    *machine = m;
    return ISO_OK;
}

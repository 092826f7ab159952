#include "config/settings_machine.h"

#include <math.h>

static void set_box(iso_vec2 *low, iso_vec2 *high, const iso_numbers *corners) {
    const double *at = corners->value;
    *low = *high = (iso_vec2){0, 0};
    if (corners->count != 4)
        return;
    *low = (iso_vec2){fmin(at[0], at[2]), fmin(at[1], at[3])};
    *high = (iso_vec2){fmax(at[0], at[2]), fmax(at[1], at[3])};
}

static clearance_turning turning_of(int32_t kinematics) {
    switch ((iso_kinematics)kinematics) {
    case ISO_KINEMATICS_ROTARY_A:
        return CLEARANCE_ABOUT_X;
    case ISO_KINEMATICS_ROTARY_B:
        return CLEARANCE_ABOUT_Y;
    case ISO_KINEMATICS_TABLE_AC:
    case ISO_KINEMATICS_TABLE_BC:
        return CLEARANCE_ABOUT_ALL;
    default:
        return CLEARANCE_UPRIGHT;
    }
}

clearance_tool settings_of_tool(const iso_options *options) {
    clearance_tool tool = {.tip_diameter = options->clearance_tip,
                           .cone_angle = options->clearance_cone,
                           .cone_height = options->clearance_cone_height,
                           .carriage_height = options->clearance_carriage_height,
                           .gantry_height = options->clearance_gantry_height,
                           .turning = turning_of(options->kinematics)};
    set_box(&tool.block_low, &tool.block_high, &options->clearance_block);
    set_box(&tool.carriage_low, &tool.carriage_high, &options->clearance_carriage);
    return tool;
}

static iso_status check_box(const char *key, const iso_numbers *corners) {
    if (corners->count == 0 || corners->count == 4)
        return ISO_OK;
    return iso_fail(ISO_BAD_CONFIG, "%s: %d numbers; give two opposite corners as X,Y,X,Y, or none",
                    key, corners->count);
}

static iso_status check_limits(const char *key, const iso_numbers *limits) {
    if (limits->count == 2 && limits->value[0] <= limits->value[1])
        return ISO_OK;
    return iso_fail(ISO_BAD_CONFIG, "%s: give the least and the greatest angle", key);
}

iso_status settings_check_machine(const iso_options *options) {
    ISO_TRY(check_box("clearance_block", &options->clearance_block));
    ISO_TRY(check_box("clearance_carriage", &options->clearance_carriage));
    ISO_TRY(check_limits("tilt_limits", &options->tilt_limits));
    ISO_TRY(check_limits("turn_limits", &options->turn_limits));
    int32_t pivot = options->kinematics_pivot.count;
    if (pivot != 0 && pivot != 3)
        return iso_fail(ISO_BAD_CONFIG, "kinematics_pivot: %d numbers; give X,Y,Z", pivot);
    if (options->clearance_carriage_height < options->clearance_cone_height)
        return iso_fail(ISO_BAD_CONFIG,
                        "clearance_carriage_height = %g mm is below clearance_cone_height = %g mm",
                        options->clearance_carriage_height, options->clearance_cone_height);
    return ISO_OK;
}

/* Values that follow from several options, and the rules between them. */
#include <isoslice/config.h>

#include <stdio.h>
#include <string.h>

#include "config/settings_machine.h"
#include "config/settings_objects.h"
#include "config/value.h"

double iso_options_first_height(const iso_options *options) {
    if (options->layer_heights.count > 0)
        return options->layer_heights.value[0];
    return iso_relative_of(options->first_layer_height, options->layer_height);
}

int32_t iso_options_heights(double height[ISO_NUMBERS_MAX + 1], const iso_options *options) {
    int32_t count = options->layer_heights.count;
    for (int32_t i = 0; i < count; i++)
        height[i] = options->layer_heights.value[i];
    if (count == 0)
        height[count++] = iso_options_first_height(options);
    height[count++] = options->layer_height;
    return count;
}

static iso_relative width_option(const iso_options *options, iso_role role) {
    switch (role) {
    case ISO_ROLE_EXTERNAL_PERIMETER:
        return options->external_perimeter_extrusion_width;
    case ISO_ROLE_PERIMETER:
    case ISO_ROLE_OVERHANG_PERIMETER:
    case ISO_ROLE_SKIRT:
        return options->perimeter_extrusion_width;
    case ISO_ROLE_INTERNAL_INFILL:
        return options->infill_extrusion_width;
    case ISO_ROLE_SOLID_INFILL:
    case ISO_ROLE_BRIDGE_INFILL:
        return options->solid_infill_extrusion_width;
    case ISO_ROLE_TOP_SOLID_INFILL:
    case ISO_ROLE_IRONING:
        return options->top_infill_extrusion_width;
    default:
        return options->extrusion_width;
    }
}

double iso_options_width(const iso_options *options, iso_role role, bool first_layer,
                         double layer_height) {
    iso_relative width = width_option(options, role);
    if (first_layer && options->first_layer_extrusion_width.value > 0)
        width = options->first_layer_extrusion_width;
    if (width.value == 0)
        width = options->extrusion_width;
    if (width.value == 0)
        return options->nozzle_diameter * (role == ISO_ROLE_TOP_SOLID_INFILL ? 1 : 1.125);
    return iso_relative_of(width, layer_height);
}

static double usual_speed(const iso_options *options, iso_role role) {
    double walls = options->perimeter_speed;
    double solid = iso_relative_of(options->solid_infill_speed, options->infill_speed);
    switch (role) {
    case ISO_ROLE_EXTERNAL_PERIMETER:
        return iso_relative_of(options->external_perimeter_speed, walls);
    case ISO_ROLE_INTERNAL_INFILL:
        return options->infill_speed;
    case ISO_ROLE_SOLID_INFILL:
        return solid;
    case ISO_ROLE_TOP_SOLID_INFILL:
        return iso_relative_of(options->top_solid_infill_speed, solid);
    case ISO_ROLE_IRONING:
        return options->ironing_speed;
    case ISO_ROLE_OVERHANG_PERIMETER:
    case ISO_ROLE_BRIDGE_INFILL:
        return options->bridge_speed;
    case ISO_ROLE_GAP_FILL:
        return options->gap_fill_speed;
    default:
        return walls;
    }
}

double iso_options_speed(const iso_options *options, iso_role role, bool small_perimeter,
                         bool first_layer) {
    double speed = usual_speed(options, role);
    if (small_perimeter && (role == ISO_ROLE_EXTERNAL_PERIMETER || role == ISO_ROLE_PERIMETER))
        speed = iso_relative_of(options->small_perimeter_speed, options->perimeter_speed);
    return first_layer ? iso_relative_of(options->first_layer_speed, speed) : speed;
}

double iso_options_infill_overlap(const iso_options *options, bool first_layer,
                                  double layer_height) {
    double width = iso_options_width(options, ISO_ROLE_PERIMETER, first_layer, layer_height);
    return iso_relative_of(options->infill_overlap, width);
}

iso_vec2 iso_options_center(const iso_options *options) {
    if (options->center.given)
        return (iso_vec2){options->center.x, options->center.y};
    const iso_points *bed = &options->bed_shape;
    iso_vec2 low = bed->point[0], high = low;
    for (int32_t i = 1; i < bed->count; i++) {
        iso_vec2 p = bed->point[i];
        low = (iso_vec2){p.x < low.x ? p.x : low.x, p.y < low.y ? p.y : low.y};
        high = (iso_vec2){p.x > high.x ? p.x : high.x, p.y > high.y ? p.y : high.y};
    }
    return (iso_vec2){(low.x + high.x) / 2, (low.y + high.y) / 2};
}

/* ---- rules ---- */

/* A nozzle can't spread a bead higher than it is wide, and a bead is a stadium: no narrower than
 * it is high. */
static iso_status check_layer(const iso_options *options, const char *what, double height,
                              bool first) {
    char mm[32], limit[32];
    iso_number_write(mm, height);
    if (height > options->nozzle_diameter) {
        iso_number_write(limit, options->nozzle_diameter);
        return iso_fail(ISO_BAD_CONFIG, "%s: %s mm is more than nozzle_diameter = %s mm can print",
                        what, mm, limit);
    }
    static const iso_role roles[] = {ISO_ROLE_EXTERNAL_PERIMETER, ISO_ROLE_PERIMETER,
                                     ISO_ROLE_INTERNAL_INFILL, ISO_ROLE_SOLID_INFILL,
                                     ISO_ROLE_TOP_SOLID_INFILL};
    for (size_t i = 0; i < sizeof roles / sizeof *roles; i++) {
        double width = iso_options_width(options, roles[i], first, height);
        if (width >= height)
            continue;
        iso_number_write(limit, width);
        return iso_fail(ISO_BAD_CONFIG,
                        "%s: %s mm is higher than the extrusion of %s, %s mm wide; make the layer "
                        "thinner or the extrusion wider",
                        what, mm, iso_role_name(roles[i]), limit);
    }
    return ISO_OK;
}

static double double_area(const iso_points *bed) {
    double area = 0;
    for (int32_t i = 0; i < bed->count; i++) {
        iso_vec2 p = bed->point[i], q = bed->point[(i + 1) % bed->count];
        area += p.x * q.y - q.x * p.y;
    }
    return area;
}

static iso_status check_vase(const iso_options *o) {
    bool single = o->perimeters == 1 && o->fill_density == 0 && o->top_solid_layers == 0;
    if (!o->spiral_vase || (single && o->duplicate == 1))
        return ISO_OK;
    return iso_fail(ISO_BAD_CONFIG,
                    "spiral_vase: set perimeters = 1, fill_density = 0 and top_solid_layers = 0%s",
                    o->duplicate > 1 ? ", and print one copy" : "");
}

iso_status iso_options_check(const iso_options *options) {
    const iso_numbers *heights = &options->layer_heights;
    ISO_TRY(check_layer(options, "layer_height", options->layer_height, false));
    ISO_TRY(check_layer(options,
                        heights->count > 0 ? "layer_heights, layer 1" : "first_layer_height",
                        iso_options_first_height(options), true));
    for (int32_t i = 1; i < heights->count; i++) {
        char what[48];
        snprintf(what, sizeof what, "layer_heights, layer %d", i + 1);
        ISO_TRY(check_layer(options, what, heights->value[i], false));
    }
    if (options->min_fan_speed > options->max_fan_speed)
        return iso_fail(ISO_BAD_CONFIG, "min_fan_speed = %d is above max_fan_speed = %d",
                        options->min_fan_speed, options->max_fan_speed);
    ISO_TRY(settings_check_objects(options));
    ISO_TRY(settings_check_machine(options));
    if (options->adaptive_layers)
        ISO_TRY(check_layer(options, "max_layer_height", settings_of_adaptive(options).max, false));
    ISO_TRY(check_vase(options));
    if (options->lattice_drain.count % 2 != 0)
        return iso_fail(ISO_BAD_CONFIG, "lattice_drain: %d numbers are no pairs of X,Y",
                        options->lattice_drain.count);
    if (double_area(&options->bed_shape) == 0)
        return iso_fail(ISO_BAD_CONFIG, "bed_shape: the points lie on a line; give its corners one "
                                        "after the other around it");
    return ISO_OK;
}

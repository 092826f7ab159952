#include "config/settings_objects.h"

#include <math.h>

static double thickest_layer(const iso_options *options) {
    return options->max_layer_height > 0 ? options->max_layer_height
                                         : 0.75 * options->nozzle_diameter;
}

iso_object_options settings_of_objects(const iso_options *options) {
    const iso_numbers *fit = &options->scale_to_fit;
    iso_object_options made = {
        .transform = {.inches = options->inches,
                      .scale = iso_relative_of(options->scale, 1),
                      .rotate = {options->rotate_x, options->rotate_y, options->rotate}},
        .cut = options->cut,
        .drop_lower = options->cut_keep == ISO_CUT_UPPER,
        .drop_upper = options->cut_keep == ISO_CUT_LOWER,
        .split = options->split,
        .apart = options->arrange || options->duplicate > 1 || options->split ||
                 options->complete_objects,
        .float_above = !options->ensure_on_bed};
    if (options->mirror != ISO_MIRROR_NONE)
        made.transform.mirror[options->mirror - ISO_MIRROR_X] = true;
    if (fit->count == 3)
        made.transform.fit = (iso_vec3){fit->value[0], fit->value[1], fit->value[2]};
    return made;
}

iso_mesh_options settings_of_reading(const iso_options *options) {
    double scale = iso_relative_of(options->scale, 1) * (options->inches ? 25.4 : 1);
    return (iso_mesh_options){.volume = options->repair == ISO_REPAIR_VOLUME,
                              .voxel = options->repair_voxel / scale,
                              .sheet_thickness = options->sheet_thickness / scale};
}

/* What is drawn around all objects on the first layer must be on the bed too. */
static double margin_of(const iso_options *options) {
    double height = iso_options_first_height(options);
    double width = iso_options_width(options, ISO_ROLE_SKIRT, true, height);
    return options->skirts > 0 ? options->skirt_distance + options->skirts * width : 0;
}

static double brim_of(const iso_options *options) {
    bool outside = options->brim_type == ISO_BRIM_OUTER || options->brim_type == ISO_BRIM_BOTH;
    return outside && options->brim_width > 0 ? options->brim_width + options->brim_separation : 0;
}

double settings_of_growth(const iso_options *options) {
    double fuzz = options->fuzzy_skin == ISO_FUZZY_NONE ? 0 : options->fuzzy_skin_thickness;
    return fmax(0, options->xy_size_compensation) + fuzz;
}

iso_placing settings_of_placing(const iso_options *options) {
    const iso_numbers *grid = &options->duplicate_grid;
    double around = brim_of(options) + settings_of_growth(options),
           distance = options->duplicate_distance;
    if (options->complete_objects)
        distance = fmax(distance, options->extruder_clearance_radius);
    return (iso_placing){.bed = options->bed_shape.point,
                         .bed_count = options->bed_shape.count,
                         .by_hull = options->complete_objects,
                         .keep = options->dont_arrange,
                         .has_center = options->center.given,
                         .center = {options->center.x, options->center.y},
                         .copies = options->duplicate,
                         .columns = grid->count == 2 ? (int32_t)grid->value[0] : 0,
                         .rows = grid->count == 2 ? (int32_t)grid->value[1] : 0,
                         .distance = distance + 2 * around,
                         .margin = around + margin_of(options)};
}

iso_clearance settings_of_clearance(const iso_options *options) {
    return (iso_clearance){options->extruder_clearance_radius, options->extruder_clearance_height};
}

iso_adaptive_options settings_of_adaptive(const iso_options *options) {
    return (iso_adaptive_options){.first = iso_options_first_height(options),
                                  .min = options->min_layer_height,
                                  .max = thickest_layer(options),
                                  .cusp = options->cusp_height};
}

iso_status settings_check_objects(const iso_options *options) {
    const iso_numbers *fit = &options->scale_to_fit, *grid = &options->duplicate_grid;
    if (fit->count != 0 && fit->count != 3)
        return iso_fail(ISO_BAD_CONFIG, "scale_to_fit: %d numbers; give the box as X,Y,Z",
                        fit->count);
    if (grid->count != 0 && grid->count != 2)
        return iso_fail(ISO_BAD_CONFIG, "duplicate_grid: %d numbers; give columns and rows as X,Y",
                        grid->count);
    for (int32_t i = 0; i < grid->count; i++)
        if (grid->value[i] != floor(grid->value[i]))
            return iso_fail(ISO_BAD_CONFIG, "duplicate_grid: %g is not a whole number",
                            grid->value[i]);
    double most = thickest_layer(options);
    if (!options->adaptive_layers)
        return ISO_OK;
    if (options->min_layer_height > most)
        return iso_fail(ISO_BAD_CONFIG,
                        "min_layer_height = %g mm is above max_layer_height = %g mm",
                        options->min_layer_height, most);
    return ISO_OK;
}

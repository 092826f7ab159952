#include "part.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "measure.h"

void part_options(iso_options *options, double density) {
    static const char *const setting[][2] = {
        {"layer_height", "0.2"},
        {"first_layer_height", "0.2"},
        {"perimeters", "2"},
        {"fill_pattern", "rectilinear"},
        {"top_solid_layers", "4"},
        {"bottom_solid_layers", "4"},
        {"skirts", "0"},
        {"extrusion_width", "0.45"},
        {"perimeter_extrusion_width", "0.45"},
        {"external_perimeter_extrusion_width", "0.45"},
        {"infill_extrusion_width", "0.45"},
        {"solid_infill_extrusion_width", "0.45"},
        {"top_infill_extrusion_width", "0.45"},
        {"first_layer_extrusion_width", "0.45"},
        {"retract_lift", "0"},
        {"temperature", "210"},
        {"first_layer_temperature", "210"},
        {"bed_temperature", "60"},
        {"bed_shape", "0x0,400x0,400x400,0x400"},
        {"max_print_height", "400"},
    };
    char percent[32];
    iso_options_defaults(options);
    for (size_t i = 0; i < sizeof setting / sizeof *setting; i++)
        bench_must(iso_options_set(options, setting[i][0], setting[i][1], "bench"), "options");
    snprintf(percent, sizeof percent, "%g%%", density);
    bench_must(iso_options_set(options, "fill_density", percent, "bench"), "options");
    bench_must(iso_options_check(options), "options");
}

static void place(bench_part *part) {
    iso_mesh *mesh = &part->mesh;
    iso_vec2 center = iso_options_center(part->options);
    iso_mesh_translate(mesh, (iso_vec3){center.x - (mesh->min.x + mesh->max.x) / 2,
                                        center.y - (mesh->min.y + mesh->max.y) / 2, -mesh->min.z});
}

static void outline(bench_part *part) {
    iso_window *window = &part->window;
    int32_t count = part->levels.count;
    iso_shell_depth shells = settings_of_shells(part->options);
    bench_must(window_new(window, &part->levels, &shells, count, 1), part->path);
    for (int32_t i = 0; i < count; i++) {
        iso_layer *layer = window_layer(window, i);
        settings_of_layer(&layer->settings, part->options, i, part->levels.height[i]);
        bench_must(layer_outline(layer, &part->hand, &part->slices, 1, i), part->path);
    }
    for (int32_t level = 1; level < window->levels; level++)
        for (int32_t i = 0; i < window_wide_end(level, count); i++)
            bench_must(window_widen(window, i, level, part->hand.planar), part->path);
}

void part_load(bench_part *part, const char *path, const iso_options *options) {
    static double heights[ISO_NUMBERS_MAX + 1];
    *part = (bench_part){.path = path, .options = options};
    bench_must(iso_mesh_read(&part->mesh, path), path);
    place(part);
    int32_t count = iso_options_heights(heights, options);
    bench_must(iso_levels_from_heights(&part->levels, heights, count, part->mesh.max.z), path);
    bench_must(iso_slice_planar(&part->slices, &part->mesh, &part->levels), path);
    bench_must(hand_new(&part->hand), path);
    outline(part);
}

void part_fill(bench_part *part, int32_t index) {
    iso_shell_neighbours around = window_around(&part->window, index);
    iso_layer *layer = window_layer(&part->window, index);
    const iso_layer *beneath = index > 0 ? window_layer(&part->window, index - 1) : NULL;
    bench_must(layer_split(layer, &part->hand, &around), part->path);
    bench_must(layer_fill(layer, &part->hand, beneath), part->path);
}

void part_free(bench_part *part) {
    window_free(&part->window);
    hand_free(&part->hand);
    iso_slices_free(&part->slices);
    iso_levels_free(&part->levels);
    iso_mesh_free(&part->mesh);
}

#include "part.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "measure.h"

enum { AROUND_MOST = 64 };

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
    part->layer = bench_allocate(part->levels.count * (int64_t)sizeof *part->layer);
    memset(part->layer, 0, (size_t)part->levels.count * sizeof *part->layer);
    for (int32_t i = 0; i < part->levels.count; i++) {
        iso_layer *layer = &part->layer[i];
        settings_of_layer(&layer->settings, part->options, i, part->levels.height[i]);
        bench_must(layer_outline(layer, &part->hand, &part->slices, 1, i), part->path);
    }
}

void part_load(bench_part *part, const char *path, const iso_options *options) {
    static double heights[ISO_NUMBERS_MAX + 1];
    *part = (bench_part){.path = path, .options = options};
    bench_must(iso_mesh_read(&part->mesh, path), path);
    place(part);
    int32_t count = iso_options_heights(heights, options);
    bench_must(iso_levels_from_heights(&part->levels, heights, count, part->mesh.max.z), path);
    bench_must(iso_slice_planar(&part->slices, &part->mesh, &part->levels), path);
    settings_shells(&part->top, &part->bottom, options);
    bench_must(hand_new(&part->hand), path);
    outline(part);
}

iso_shell_neighbours part_around(const bench_part *part, int32_t index, const iso_region **region) {
    iso_shell_neighbours around = {
        .top = part->top, .bottom = part->bottom, .above = region, .below = region + part->top};
    for (int32_t i = 1; i <= part->top && index + i < part->levels.count; i++)
        region[around.above_count++] = &part->layer[index + i].coarse;
    for (int32_t i = 1; i <= part->bottom && index - i >= 0; i++)
        region[part->top + around.below_count++] = &part->layer[index - i].coarse;
    return around;
}

void part_fill(bench_part *part, int32_t index) {
    const iso_region *region[AROUND_MOST];
    iso_shell_neighbours around = part_around(part, index, region);
    bench_must(layer_fill(&part->layer[index], &part->hand, &around), part->path);
}

void part_free(bench_part *part) {
    for (int32_t i = 0; i < part->levels.count; i++)
        layer_free(&part->layer[i]);
    free(part->layer);
    hand_free(&part->hand);
    iso_slices_free(&part->slices);
    iso_levels_free(&part->levels);
    iso_mesh_free(&part->mesh);
}

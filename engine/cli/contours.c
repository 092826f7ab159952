/* isoslice contours: the iso-slice alone, as a link file, as JSON or as a picture in SVG.
 * Those of curved layers are space_contours.c's. */
#include <isoslice/link.h>
#include <isoslice/object.h>
#include <isoslice/slice.h>

#include <string.h>

#include "base/memory.h"
#include "base/output.h"
#include "config/settings_objects.h"
#include "config/value.h"
#include "contour_map.h"
#include "space_contours.h"
#include "verbs.h"
#include "warnings.h"

typedef struct cut {
    int32_t count; /* of models */
    iso_mesh *mesh;
    iso_objects objects;
    iso_instances instances;
    iso_slices *each; /* [each_count] by instance, then mesh */
    int32_t each_count;
    iso_levels levels;
    iso_slices slices; /* of all */
} cut;

static void cut_free(cut *part) {
    iso_meshes_free(part->mesh, part->count);
    iso_objects_free(&part->objects);
    iso_instances_free(&part->instances);
    for (int32_t i = 0; i < part->each_count; i++)
        iso_slices_free(&part->each[i]);
    iso_release(part->each);
    iso_levels_free(&part->levels);
    iso_slices_free(&part->slices);
}

/* ---- objects, as a print has them ---- */

static iso_status load_objects(cut *part, const char *const *path, int32_t count,
                               const iso_options *options) {
    iso_object_options object = settings_of_objects(options);
    iso_placing placing = settings_of_placing(options);
    iso_planar_scratch *scratch;
    ISO_TRY(ISO_ALLOCATE(part->mesh, count));
    memset(part->mesh, 0, (size_t)count * sizeof *part->mesh);
    part->count = count;
    for (int32_t i = 0; i < count; i++)
        ISO_TRY(iso_mesh_read(&part->mesh[i], path[i]));
    ISO_TRY(iso_objects_make(&part->objects, part->mesh, path, count, &object));
    ISO_TRY(iso_planar_scratch_new(&scratch));
    iso_status status = iso_objects_place(&part->instances, &part->objects, &placing, scratch);
    iso_planar_scratch_free(scratch);
    return status;
}

/* All objects are cut at the same heights here: where layers adapt to the slope, at those that suit
 * the highest one. */
static iso_status find_levels(cut *part, const iso_options *options) {
    const iso_object *highest = &part->objects.object[0];
    for (int32_t i = 1; i < part->objects.count; i++)
        if (part->objects.object[i].max.z > highest->max.z)
            highest = &part->objects.object[i];
    if (options->adaptive_layers) {
        iso_adaptive_options adaptive = settings_of_adaptive(options);
        return iso_levels_adaptive(&part->levels, highest->mesh, highest->mesh_count, &adaptive);
    }
    double height[ISO_NUMBERS_MAX + 1];
    int32_t count = iso_options_heights(height, options);
    return iso_levels_from_heights(&part->levels, height, count, highest->max.z);
}

static void move_slices(iso_slices *slices, iso_point by) {
    for (int64_t i = 0; i < slices->crossing_count; i++) {
        slices->point[i].x += iso_mm(by.x);
        slices->point[i].y += iso_mm(by.y);
    }
}

static iso_status slice_models(cut *part) {
    int64_t count = 0;
    for (int32_t i = 0; i < part->instances.count; i++)
        count += part->objects.object[part->instances.instance[i].object].mesh_count;
    ISO_TRY(ISO_ALLOCATE(part->each, count));
    for (int32_t i = 0; i < part->instances.count; i++) {
        const iso_instance *instance = &part->instances.instance[i];
        const iso_object *object = &part->objects.object[instance->object];
        for (int32_t m = 0; m < object->mesh_count; m++) {
            iso_slices *slices = &part->each[part->each_count];
            ISO_TRY(iso_slice_planar(slices, &object->mesh[m], &part->levels));
            part->each_count++;
            move_slices(slices, instance->by);
        }
    }
    iso_objects_free(&part->objects);
    return iso_slices_join(&part->slices, part->each, part->each_count);
}

/* ---- formats ---- */

static iso_status write_link(const char *path, const cut *part) {
    iso_coloured_link link;
    ISO_TRY(iso_slices_to_link(&link, &part->slices, &part->levels));
    iso_status status = iso_multilink_write(path, &link.link, ISO_LINK_FLOAT64);
    iso_multilink_free(&link.link);
    return status;
}

static void put_point(iso_output *output, iso_vec2 point, const char *format) {
    char x[32], y[32];
    iso_number_write(x, point.x);
    iso_number_write(y, point.y);
    iso_output_print(output, format, x, y);
}

static void put_contour_json(iso_output *output, const iso_slices *slices, int32_t contour) {
    int64_t first = slices->contour_first[contour];
    for (int64_t i = first; i < slices->contour_first[contour + 1]; i++)
        put_point(output, slices->point[i], i == first ? "[[%s,%s]" : ",[%s,%s]");
    iso_output_print(output, "]");
}

static iso_status write_json(iso_output *output, const cut *part) {
    const iso_slices *slices = &part->slices;
    char z[32], top[32];
    iso_output_print(output, "{\"unit\": \"mm\", \"levels\": [");
    for (int32_t l = 0; l < slices->level_count; l++) {
        iso_number_write(z, part->levels.cut[l]);
        iso_number_write(top, part->levels.top[l]);
        iso_output_print(output, "%s\n  {\"z\": %s, \"top\": %s, \"contours\": [", l > 0 ? "," : "",
                         z, top);
        for (int32_t c = slices->level_first[l]; c < slices->level_first[l + 1]; c++) {
            iso_output_print(output, c > slices->level_first[l] ? ",\n    " : "\n    ");
            put_contour_json(output, slices, c);
        }
        iso_output_print(output, "]}");
    }
    return iso_output_print(output, "\n]}\n");
}

static iso_status write_contours(const char *path, const cut *part) {
    bool json = iso_ends_in(path, ".json"), svg = iso_ends_in(path, ".svg");
    if (!json && !svg)
        return write_link(path, part);
    iso_output *output;
    ISO_TRY(iso_output_open(&output, path));
    iso_status status =
        json ? write_json(output, part) : iso_contour_map(output, &part->slices, &part->levels);
    if (status == ISO_OK)
        return iso_output_commit(output);
    iso_output_abandon(output);
    return status;
}

static iso_status write_flat(const char *path, cut *part, const iso_options *options) {
    ISO_TRY(find_levels(part, options));
    ISO_TRY(slice_models(part));
    return write_contours(path, part);
}

/* Flat layers in whatever words: a field that can be told without the model. */
static bool is_flat(const iso_options *options) {
    iso_field *field;
    if (!*options->field)
        return true;
    if (iso_field_new(&field, options->field) != ISO_OK)
        return false;
    bool flat = iso_field_is_z(field);
    iso_field_free(field);
    return flat;
}

static iso_status warn(const iso_arguments *arguments) {
    iso_report report = {0};
    iso_status status = iso_warnings_add(&report, &arguments->notes);
    if (status == ISO_OK && !arguments->quiet)
        iso_warnings_print(&report);
    iso_report_free(&report);
    return status;
}

iso_status iso_verb_contours(const iso_arguments *arguments) {
    char name[4096];
    const char *path = arguments->output;
    if (arguments->file_count == 0)
        return iso_fail(ISO_USAGE, "no model given; see isoslice contours --help");
    if (!path) {
        ISO_TRY(iso_replace_ending(name, sizeof name, arguments->file[0], ".mlk"));
        path = name;
    }
    if (strcmp(path, "-") != 0 && !iso_ends_in(path, ".mlk") && !iso_ends_in(path, ".json") &&
        !iso_ends_in(path, ".svg"))
        return iso_fail(ISO_USAGE, "%s: contours are written as .mlk, .json or .svg", path);
    ISO_TRY(iso_keep_files(arguments, path));
    ISO_TRY(warn(arguments));
    cut part = {0};
    iso_status status =
        load_objects(&part, arguments->file, arguments->file_count, &arguments->options);
    if (status == ISO_OK)
        status = is_flat(&arguments->options)
                     ? write_flat(path, &part, &arguments->options)
                     : iso_space_contours(path, &part.objects, &part.instances, arguments);
    cut_free(&part);
    return status;
}

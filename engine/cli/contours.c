/* isoslice contours: the iso-slice alone, as a link file, as JSON or as a map in SVG. */
#include <isoslice/link.h>
#include <isoslice/mesh.h>
#include <isoslice/slice.h>

#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "base/output.h"
#include "config/value.h"
#include "verbs.h"
#include "warnings.h"

typedef struct cut {
    iso_mesh mesh;
    iso_levels levels;
    iso_slices slices;
} cut;

static void cut_free(cut *part) {
    iso_slices_free(&part->slices);
    iso_levels_free(&part->levels);
    iso_mesh_free(&part->mesh);
}

/* As a print would cut it: the part stands on the bed. x and y stay as they are. */
static iso_status slice_part(cut *part, const char *path, const iso_options *options) {
    double height[ISO_NUMBERS_MAX + 1];
    int32_t count = iso_options_heights(height, options);
    ISO_TRY(iso_mesh_read(&part->mesh, path));
    iso_mesh_translate(&part->mesh, (iso_vec3){0, 0, -part->mesh.min.z});
    ISO_TRY(iso_levels_from_heights(&part->levels, height, count, part->mesh.max.z));
    return iso_slice_planar(&part->slices, &part->mesh, &part->levels);
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

/* From blue at the bed over green to red at the top. */
static void put_colour(char text[8], int32_t level, int32_t count) {
    int t = count > 1 ? (int)((int64_t)level * 510 / (count - 1)) : 0;
    int red = t > 255 ? t - 255 : 0, blue = t < 255 ? 255 - t : 0;
    snprintf(text, 8, "#%02x%02x%02x", red & 255, (200 * (255 - red - blue) / 255) & 255,
             blue & 255);
}

static void put_level_svg(iso_output *output, const cut *part, int32_t level) {
    const iso_slices *slices = &part->slices;
    char colour[8], z[32];
    put_colour(colour, level, slices->level_count);
    iso_number_write(z, part->levels.cut[level]);
    iso_output_print(output, "<g id=\"layer%d\" data-z=\"%s\" stroke=\"%s\">\n", level + 1, z,
                     colour);
    for (int32_t c = slices->level_first[level]; c < slices->level_first[level + 1]; c++) {
        iso_output_print(output, "<path d=\"");
        for (int64_t i = slices->contour_first[c]; i < slices->contour_first[c + 1]; i++)
            put_point(output, slices->point[i],
                      i == slices->contour_first[c] ? "M%s %s" : "L%s %s");
        iso_output_print(output, "Z\"/>\n");
    }
    iso_output_print(output, "</g>\n");
}

/* A map seen from above, one unit a mm, y upwards. */
static iso_status write_svg(iso_output *output, const cut *part) {
    char left[32], bottom[32], width[32], height[32];
    const iso_mesh *mesh = &part->mesh;
    iso_number_write(left, mesh->min.x - 1);
    iso_number_write(bottom, -mesh->max.y - 1);
    iso_number_write(width, mesh->max.x - mesh->min.x + 2);
    iso_number_write(height, mesh->max.y - mesh->min.y + 2);
    iso_output_print(output,
                     "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%smm\" height=\"%smm\" "
                     "viewBox=\"%s %s %s %s\">\n"
                     "<g transform=\"scale(1,-1)\" fill=\"none\" stroke-width=\"0.05\">\n",
                     width, height, left, bottom, width, height);
    for (int32_t l = 0; l < part->slices.level_count; l++)
        put_level_svg(output, part, l);
    return iso_output_print(output, "</g>\n</svg>\n");
}

static bool ends_with(const char *path, const char *ending) {
    size_t length = strlen(path), n = strlen(ending);
    return length > n && strcasecmp(path + length - n, ending) == 0;
}

static iso_status write_contours(const char *path, const cut *part) {
    bool json = ends_with(path, ".json"), svg = ends_with(path, ".svg");
    if (!json && !svg)
        return write_link(path, part);
    iso_output *output;
    ISO_TRY(iso_output_open(&output, path));
    (void)(json ? write_json(output, part) : write_svg(output, part));
    return iso_output_commit(output);
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
    ISO_TRY(iso_one_file(arguments));
    if (!path) {
        ISO_TRY(iso_replace_ending(name, sizeof name, arguments->file[0], ".mlk"));
        path = name;
    }
    if (strcmp(path, "-") != 0 && !ends_with(path, ".mlk") && !ends_with(path, ".json") &&
        !ends_with(path, ".svg"))
        return iso_fail(ISO_USAGE, "%s: contours are written as .mlk, .json or .svg", path);
    ISO_TRY(warn(arguments));
    cut part = {0};
    iso_status status = slice_part(&part, arguments->file[0], &arguments->options);
    if (status == ISO_OK)
        status = write_contours(path, &part);
    cut_free(&part);
    return status;
}

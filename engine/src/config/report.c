#include <isoslice/report.h>

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <isoslice/version.h>

#include "base/memory.h"
#include "config/json.h"

void iso_report_free(iso_report *report) {
    for (int32_t i = 0; i < report->input_count; i++)
        iso_release(report->input[i].path);
    for (int32_t i = 0; i < report->warning_count; i++)
        iso_release(report->warning[i].message);
    iso_release(report->input);
    iso_release(report->stage);
    iso_release(report->warning);
    *report = (iso_report){0};
}

static iso_status copy_text(char **copy, const char *text) {
    size_t size = strlen(text) + 1;
    *copy = iso_allocate(size);
    if (!*copy)
        return iso_no_memory(size);
    memcpy(*copy, text, size);
    return ISO_OK;
}

iso_status iso_report_warn(iso_report *report, const char *code, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    if (length < 0)
        return iso_fail(ISO_BUG, "a warning %s that can't be formatted", code);
    ISO_TRY(ISO_GROW(report->warning, report->warning_capacity, report->warning_count + 1));
    size_t size = (size_t)length + 1;
    char *message = iso_allocate(size);
    if (!message)
        return iso_no_memory(size);
    va_start(arguments, format);
    vsnprintf(message, size, format, arguments);
    va_end(arguments);
    report->warning[report->warning_count++] = (iso_report_warning){code, message};
    return ISO_OK;
}

/* "5 duplicate and 2 degenerate triangles dropped", of the counts that aren't zero */
iso_status iso_report_warn_mended(iso_report *report, const char *path,
                                  const iso_mesh_defects *found) {
    const struct {
        int64_t count;
        const char *what;
    } list[] = {{found->degenerate, "degenerate triangles dropped"},
                {found->duplicate, "duplicate triangles dropped"},
                {found->cancelled, "coincident faces dropped"},
                {found->welded_vertices, "vertices welded"},
                {found->flipped_triangles, "triangles turned over"},
                {found->inverted_shells, "shells turned inside out"},
                {found->holes_closed, "holes closed"},
                {found->sheets, "sheets given a thickness"}};
    char text[1024];
    size_t length = 0;
    for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
        if (list[i].count > 0)
            length +=
                (size_t)snprintf(text + length, sizeof text - length, "%s%lld %s",
                                 length > 0 ? ", " : "", (long long)list[i].count, list[i].what);
    }
    if (found->sheets > 0)
        length += (size_t)snprintf(text + length, sizeof text - length, " of %g mm",
                                   found->sheet_thickness);
    if (found->voxel > 0)
        length += (size_t)snprintf(
            text + length, sizeof text - length,
            "%smade anew on a grid of %.4g mm from %lld triangles, %.3g mm off at most, %.2g in the "
            "mean%s",
            length > 0 ? "; " : "", found->voxel, (long long)found->triangles_read,
            found->largest_error, found->mean_error,
            found->largest_error > 2.99 * found->voxel
                ? ": some triangles enclose nothing and are gone"
                : "");
    return length == 0 ? ISO_OK : iso_report_warn(report, "mesh-mended", "%s: %s", path, text);
}

iso_status iso_report_add_input(iso_report *report, const char *path, const iso_mesh *mesh) {
    ISO_TRY(ISO_GROW(report->input, report->input_capacity, report->input_count + 1));
    iso_report_input *input = &report->input[report->input_count];
    ISO_TRY(copy_text(&input->path, path));
    input->triangle_count = mesh->triangle_count;
    input->vertex_count = mesh->vertex_count;
    input->size =
        (iso_vec3){mesh->max.x - mesh->min.x, mesh->max.y - mesh->min.y, mesh->max.z - mesh->min.z};
    input->volume = iso_mesh_volume(mesh);
    input->mesh_bytes = (int64_t)mesh->triangle_count * 3 * 2 * (int64_t)sizeof(int32_t) +
                        (int64_t)mesh->vertex_count * (int64_t)sizeof(iso_vec3);
    input->defects = mesh->defects;
    report->input_count++;
    return iso_report_warn_mended(report, path, &mesh->defects);
}

iso_status iso_report_add_stage(iso_report *report, const char *name, double seconds,
                                int64_t bytes) {
    for (int32_t i = 0; i < report->stage_count; i++) {
        iso_report_stage *stage = &report->stage[i];
        if (strcmp(stage->name, name) != 0)
            continue;
        stage->seconds += seconds;
        stage->bytes = bytes > stage->bytes ? bytes : stage->bytes;
        return ISO_OK;
    }
    ISO_TRY(ISO_GROW(report->stage, report->stage_capacity, report->stage_count + 1));
    report->stage[report->stage_count++] = (iso_report_stage){name, seconds, bytes};
    return ISO_OK;
}

/* ---- as JSON ---- */

void iso_json_defects(iso_json *json, const iso_mesh_defects *defects) {
    iso_json_begin(json, "defects", '{');
    iso_json_integer(json, "degenerate", defects->degenerate);
    iso_json_integer(json, "duplicate", defects->duplicate);
    iso_json_integer(json, "cancelled", defects->cancelled);
    iso_json_integer(json, "bad_edges", defects->bad_edges);
    iso_json_integer(json, "welded_vertices", defects->welded_vertices);
    iso_json_integer(json, "flipped_triangles", defects->flipped_triangles);
    iso_json_integer(json, "inverted_shells", defects->inverted_shells);
    iso_json_integer(json, "holes_closed", defects->holes_closed);
    iso_json_number(json, "cap_area_mm2", defects->cap_area);
    iso_json_integer(json, "sheets", defects->sheets);
    iso_json_number(json, "sheet_thickness_mm", defects->sheet_thickness);
    if (defects->voxel > 0) {
        iso_json_number(json, "voxel_mm", defects->voxel);
        iso_json_number(json, "largest_error_mm", defects->largest_error);
        iso_json_number(json, "mean_error_mm", defects->mean_error);
    }
    iso_json_end(json, '}');
}

static void write_input(iso_json *json, const iso_report_input *input) {
    iso_json_begin(json, NULL, '{');
    iso_json_text(json, "file", input->path);
    iso_json_integer(json, "triangles_read", input->defects.triangles_read);
    iso_json_integer(json, "triangles", input->triangle_count);
    iso_json_integer(json, "vertices", input->vertex_count);
    iso_json_integer(json, "shells", input->defects.shells);
    iso_json_begin(json, "size_mm", '[');
    iso_json_number(json, NULL, input->size.x);
    iso_json_number(json, NULL, input->size.y);
    iso_json_number(json, NULL, input->size.z);
    iso_json_end(json, ']');
    iso_json_number(json, "volume_mm3", input->volume);
    iso_json_integer(json, "memory_bytes", input->mesh_bytes);
    iso_json_defects(json, &input->defects);
    iso_json_end(json, '}');
}

static iso_status write_option(void *payload, const char *key, const char *value) {
    iso_json_text(payload, key, value);
    return ISO_OK;
}

static void write_layers(iso_json *json, const iso_report *report) {
    iso_json_begin(json, "layers", '{');
    iso_json_integer(json, "count", report->layer_count);
    iso_json_number(json, "height_mm", report->printed_height);
    iso_json_number(json, "mesh_volume_mm3", report->mesh_volume);
    iso_json_number(json, "sliced_volume_mm3", report->sliced_volume);
    iso_json_end(json, '}');
}

static void write_stages(iso_json *json, const iso_report *report) {
    iso_json_begin(json, "stages", '[');
    for (int32_t i = 0; i < report->stage_count; i++) {
        iso_json_begin(json, NULL, '{');
        iso_json_text(json, "name", report->stage[i].name);
        iso_json_number(json, "seconds", report->stage[i].seconds);
        iso_json_integer(json, "bytes", report->stage[i].bytes);
        iso_json_end(json, '}');
    }
    iso_json_end(json, ']');
    iso_json_number(json, "seconds", report->seconds);
    iso_json_integer(json, "peak_memory_kib", report->peak_memory_kib);
    iso_json_integer(json, "threads", report->threads);
}

/* Left out where nothing was to be looked at. */
static void write_solid(iso_json *json, const iso_report_solid *solid) {
    if (solid->points == 0)
        return;
    iso_json_begin(json, "solid", '{');
    iso_json_integer(json, "contours", solid->contours);
    iso_json_integer(json, "contours_checked", solid->contours_checked);
    iso_json_integer(json, "contours_buried", solid->contours_buried);
    iso_json_integer(json, "contours_empty", solid->contours_empty);
    iso_json_integer(json, "contours_wrong", solid->contours_wrong);
    iso_json_integer(json, "points", solid->points);
    iso_json_integer(json, "shells", solid->shells);
    iso_json_integer(json, "shells_overlapping", solid->shells_overlapping);
    iso_json_integer(json, "shells_nested", solid->shells_nested);
    iso_json_integer(json, "shells_hollow", solid->shells_hollow);
    iso_json_integer(json, "cavities", solid->cavities);
    iso_json_end(json, '}');
}

static void write_kernel(iso_json *json, const iso_planar_counts *kernel) {
    iso_json_begin(json, "kernel", '{');
    iso_json_integer(json, "operations", kernel->operations);
    iso_json_integer(json, "untouched", kernel->untouched);
    iso_json_integer(json, "arranged", kernel->arranged);
    iso_json_integer(json, "edges", kernel->edges);
    iso_json_integer(json, "collisions", kernel->collisions);
    iso_json_end(json, '}');
}

static void write_print(iso_json *json, const iso_gcode_totals *print) {
    iso_json_begin(json, "filament", '{');
    iso_json_number(json, "mm", print->filament_mm);
    iso_json_number(json, "cm3", print->filament_cm3);
    iso_json_number(json, "g", print->filament_g);
    iso_json_end(json, '}');
    iso_json_begin(json, "print", '{');
    iso_json_number(json, "seconds", print->time);
    iso_json_number(json, "idle_seconds", print->idle_time);
    iso_json_number(json, "bead_mm", print->bead_mm);
    iso_json_number(json, "travel_mm", print->travel_mm);
    iso_json_integer(json, "moves", print->moves);
    iso_json_integer(json, "retractions", print->retractions);
    iso_json_integer(json, "gcode_bytes", print->bytes);
    iso_json_end(json, '}');
}

static void write_pores(iso_json *json, const iso_porous_figures *f) {
    if (f->detail > 0) {
        iso_json_begin(json, "pore_size_mm", '{');
        iso_json_number(json, "largest", f->pore_largest);
        iso_json_number(json, "mean", f->pore_mean);
        iso_json_number(json, "d10", f->pore_d10);
        iso_json_number(json, "d50", f->pore_d50);
        iso_json_number(json, "d90", f->pore_d90);
        iso_json_end(json, '}');
        iso_json_number(json, "wall_mean_mm", f->wall_mean);
        iso_json_number(json, "wall_smallest_mm", f->wall_smallest);
        iso_json_number(json, "size_step_mm", f->detail);
    }
    iso_json_integer(json, "pieces", f->pieces);
    iso_json_integer(json, "pieces_removed", f->removed);
    iso_json_number(json, "removed_mm3", f->removed_volume);
    iso_json_integer(json, "pieces_left", f->left);
    iso_json_integer(json, "closed_pores", f->closed_pores);
    iso_json_number(json, "closed_mm3", f->closed_volume);
}

static void write_lattice(iso_json *json, const iso_report *report) {
    const iso_porous_figures *f = report->lattice;
    if (!f)
        return;
    iso_json_begin(json, "lattice", '{');
    iso_json_text(json, "output", report->lattice_output ? report->lattice_output : "");
    iso_json_integer(json, "triangles", report->lattice_triangles);
    iso_json_number(json, "voxel_mm", f->voxel);
    iso_json_integer(json, "voxels", f->voxels);
    iso_json_number(json, "cell_mm", f->cell);
    iso_json_number(json, "cells", f->cells);
    if (f->asked_porosity >= 0)
        iso_json_number(json, "porosity_asked", f->asked_porosity);
    iso_json_number(json, "porosity", f->porosity);
    iso_json_number(json, "porosity_with_skin", f->part_porosity);
    iso_json_number(json, "part_mm3", f->part_volume);
    iso_json_number(json, "material_mm3", f->volume);
    iso_json_number(json, "surface_mm2", f->surface);
    iso_json_number(json, "pore_surface_mm2", f->pore_surface);
    iso_json_number(json, "specific_surface_per_mm",
                    f->part_volume > 0 ? f->pore_surface / f->part_volume : 0);
    write_pores(json, f);
    iso_json_end(json, '}');
}

static void write_place(iso_json *json, const char *name, iso_vec3 p) {
    iso_json_begin(json, name, '[');
    iso_json_number(json, NULL, p.x);
    iso_json_number(json, NULL, p.y);
    iso_json_number(json, NULL, p.z);
    iso_json_end(json, ']');
}

/* Left out if there is none, as between the turns of one ring. */
static void write_wall(iso_json *json, const char *name, const iso_channel_wall *wall) {
    if (wall->channel < 0)
        return;
    iso_json_begin(json, name, '{');
    iso_json_number(json, "mm", wall->thickness);
    iso_json_integer(json, "channel", wall->channel + 1);
    if (wall->other >= 0)
        iso_json_integer(json, "other", wall->other + 1);
    write_place(json, "at", wall->at);
    iso_json_end(json, '}');
}

static void write_rings(iso_json *json, const iso_channel_figures *f) {
    iso_json_begin(json, "rings", '[');
    for (int32_t i = 0; i < f->ring_count; i++) {
        iso_json_begin(json, NULL, '{');
        iso_json_integer(json, "tower", f->ring[i].tower + 1);
        iso_json_integer(json, "channel", f->ring[i].channel + 1);
        iso_json_number(json, "height_mm", f->ring[i].height);
        if (f->ring[i].measured) {
            iso_json_number(json, "measured_mm", f->ring[i].mean);
            iso_json_number(json, "least_mm", f->ring[i].least);
            iso_json_number(json, "most_mm", f->ring[i].most);
        }
        iso_json_number(json, "z_mm", f->ring[i].z);
        iso_json_number(json, "length_mm", f->ring[i].length);
        iso_json_end(json, '}');
    }
    iso_json_end(json, ']');
}

static void write_channels(iso_json *json, const iso_report *report) {
    const iso_channel_figures *f = report->channels;
    if (!f)
        return;
    iso_json_begin(json, "channels", '{');
    iso_json_integer(json, "count", f->channel_count);
    iso_json_integer(json, "towers", f->tower_count);
    iso_json_integer(json, "triangles", report->channel_triangles);
    iso_json_number(json, "pitch_error_total", f->pitch_total);
    iso_json_number(json, "pitch_error_rms", f->pitch_rms);
    iso_json_number(json, "pitch_error_max", f->pitch_max);
    iso_json_number(json, "height_error_rms", f->spread_rms);
    iso_json_number(json, "length_mm", f->length);
    iso_json_number(json, "volume_mm3", f->volume);
    iso_json_number(json, "part_mm3", f->part_volume);
    iso_json_number(json, "mould_mm3", f->mould_volume);
    write_place(json, "mould_min", f->box_min);
    write_place(json, "mould_max", f->box_max);
    iso_json_number(json, "bend_mm", f->bend);
    iso_json_integer(json, "bend_channel", f->bend_channel + 1);
    write_place(json, "bend_at", f->bend_at);
    write_wall(json, "wall_to_part", &f->to_part);
    write_wall(json, "wall_between", &f->between);
    write_wall(json, "wall_outside", &f->outside);
    iso_json_integer(json, "folds", f->folds);
    iso_json_integer(json, "narrow", f->narrow);
    iso_json_integer(json, "incomplete", f->incomplete);
    write_rings(json, f);
    iso_json_end(json, '}');
}

static void write_warnings(iso_json *json, const iso_report *report) {
    iso_json_begin(json, "warnings", '[');
    for (int32_t i = 0; i < report->warning_count; i++) {
        iso_json_begin(json, NULL, '{');
        iso_json_text(json, "code", report->warning[i].code);
        iso_json_text(json, "message", report->warning[i].message);
        iso_json_end(json, '}');
    }
    iso_json_end(json, ']');
}

iso_status iso_report_write(const iso_report *report, const iso_options *options, iso_status status,
                            const char *message, const char *path) {
    iso_output *output;
    ISO_TRY(iso_output_open(&output, path));
    iso_json json = {output, 0, false};
    iso_json_begin(&json, NULL, '{');
    iso_json_text(&json, "program", "isoslice " ISO_VERSION);
    iso_json_integer(&json, "status", status);
    iso_json_text(&json, "message", status == ISO_OK ? "" : message);
    iso_json_begin(&json, "input", '[');
    for (int32_t i = 0; i < report->input_count; i++)
        write_input(&json, &report->input[i]);
    iso_json_end(&json, ']');
    iso_json_begin(&json, "options", '{');
    iso_status printed = iso_options_print_changed(options, write_option, &json);
    iso_json_end(&json, '}');
    write_layers(&json, report);
    write_stages(&json, report);
    write_solid(&json, &report->solid);
    write_lattice(&json, report);
    write_channels(&json, report);
    write_kernel(&json, &report->kernel);
    write_print(&json, &report->print);
    write_warnings(&json, report);
    iso_json_end(&json, '}');
    if (printed != ISO_OK) {
        iso_output_abandon(output);
        return printed;
    }
    return iso_output_commit(output);
}

/* isoslice lattice: a model becomes a porous part, as a mesh, as a volume or as G-code. */
#include <isoslice/porous.h>

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

#include "base/memory.h"
#include "config/settings.h"
#include "config/settings_objects.h"
#include "lattice_figures.h"
#include "progress.h"
#include "solid/module.h"
#include "verbs.h"

typedef enum format { FORMAT_STL, FORMAT_VDB, FORMAT_GCODE, FORMAT_COUNT } format;

typedef struct work {
    const iso_arguments *arguments;
    const char *output;
    format format;
    iso_report report;
    iso_objects objects;
    iso_progress line;
    iso_porous *porous;
    iso_porous_figures figures;
    iso_vec2 drain[ISO_NUMBERS_MAX / 2];
    char percent[32]; /* of settings_of_lattice */
    double begun;
} work;

/* Too much for a stack. */
static iso_options settings;
static work job;

static double clock_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

/* ---- what is asked for ---- */

static iso_status find_format(format *found, const char *path) {
    static const char *const ending[FORMAT_COUNT] = {".stl", ".vdb", ".gcode"};
    for (int f = 0; f < FORMAT_COUNT; f++) {
        if (iso_ends_in(path, ending[f])) {
            *found = f;
            return ISO_OK;
        }
    }
    return iso_fail(ISO_USAGE, "%s: a lattice is written as .stl, .vdb or .gcode", path);
}

static iso_status check_paths(const work *w) {
    const iso_arguments *arguments = w->arguments;
    if (arguments->report && strcmp(arguments->report, w->output) == 0)
        return iso_fail(ISO_USAGE, "%s: can't hold both the lattice and the report", w->output);
    ISO_TRY(iso_keep_files(arguments, w->output));
    return iso_keep_files(arguments, arguments->report);
}

/* The pattern, and for G-code what a lattice wants of a print: no walls nor solid layers but those
 * that make the skin. */
static iso_status choose_settings(const work *w) {
    settings = w->arguments->options;
    if (!settings_have_lattice(&settings)) {
        if (!iso_options_is_default(&settings, iso_option_find("fill_pattern")))
            return iso_fail(ISO_BAD_CONFIG,
                            "fill_pattern: this one is no lattice; docs/lattices.md "
                            "has those that are");
        settings.fill_pattern = ISO_PATTERN_LATTICE + ISO_LATTICE_GYROID_SHEET;
    }
    if (settings.lattice_drain.count > 0 && !(settings.lattice_skin > 0))
        return iso_fail(ISO_BAD_CONFIG, "lattice_drain: without lattice_skin there is nothing to "
                                        "drill holes through");
    if (w->format != FORMAT_GCODE)
        return ISO_OK;
    double skin = settings.lattice_skin;
    double width = iso_options_width(&settings, ISO_ROLE_PERIMETER, false, settings.layer_height);
    settings.perimeters = skin > 0 ? (int32_t)fmax(1, floor(skin / width + 0.5)) : 0;
    settings.top_solid_layers = settings.bottom_solid_layers = skin > 0;
    settings.top_solid_min_thickness = settings.bottom_solid_min_thickness = skin;
    settings.solid_infill_below_area = 0;
    settings.solid_infill_every_layers = 0;
    settings.infill_every_layers = 1;
    settings.ensure_vertical_shell_thickness = skin > 0;
    return iso_options_check(&settings);
}

/* ---- the part ---- */

/* As a print has it, but at the place that the files have it at. */
static iso_status load(work *w) {
    const iso_arguments *arguments = w->arguments;
    iso_mesh_options reading = settings_of_reading(&settings);
    iso_object_options object = settings_of_objects(&settings);
    iso_mesh *mesh;
    int32_t count = arguments->file_count;
    if (w->format != FORMAT_GCODE)
        object.apart = object.split = false;
    object.float_above = object.float_above || w->format != FORMAT_GCODE;
    ISO_TRY(ISO_ALLOCATE(mesh, count));
    memset(mesh, 0, (size_t)count * sizeof *mesh);
    iso_status status = ISO_OK;
    for (int32_t i = 0; i < count && status == ISO_OK; i++) {
        status = iso_mesh_read_with(&mesh[i], arguments->file[i], &reading);
        if (status == ISO_OK && w->format != FORMAT_GCODE) /* a print reports them itself */
            status = iso_report_add_input(&w->report, arguments->file[i], &mesh[i]);
    }
    if (status == ISO_OK)
        status = iso_objects_make(&w->objects, mesh, arguments->file, count, &object);
    iso_meshes_free(mesh, count);
    ISO_TRY(status);
    if (w->objects.count > 1 && w->format != FORMAT_GCODE)
        return iso_fail(ISO_USAGE, "a lattice is made of one part: say with --cut-keep which half "
                                   "is to be kept");
    const iso_object *part = &w->objects.object[0];
    for (int32_t m = 0; m < part->mesh_count && w->format != FORMAT_GCODE; m++)
        iso_mesh_translate(&part->mesh[m], (iso_vec3){part->origin.x, part->origin.y, 0});
    return ISO_OK;
}

static iso_porous_options options_of(work *w) {
    static const int32_t output[FORMAT_COUNT] = {ISO_POROUS_STL, ISO_POROUS_VDB,
                                                 ISO_POROUS_FIGURES};
    const iso_numbers *drain = &settings.lattice_drain;
    for (int32_t i = 0; i < drain->count / 2; i++)
        w->drain[i] = (iso_vec2){drain->value[2 * i], drain->value[2 * i + 1]};
    iso_porous_options options = {.lattice = settings_of_lattice(&settings, w->percent),
                                  .skin = settings.lattice_skin,
                                  .drain = w->drain,
                                  .drain_count = drain->count / 2,
                                  .drain_diameter = settings.lattice_drain_diameter,
                                  .voxel = w->arguments->voxel,
                                  .output = output[w->format],
                                  .threads = w->arguments->threads};
    if (w->arguments->progress && !w->arguments->quiet) {
        options.progress = iso_progress_draw;
        options.payload = &w->line;
    }
    return options;
}

static iso_status warn_of_figures(work *w) {
    const iso_porous_figures *f = &w->figures;
    if (f->wall_smallest > 0 && f->voxel > f->wall_smallest / 1.5 && w->format != FORMAT_GCODE)
        ISO_TRY(
            iso_report_warn(&w->report, "lattice-coarse",
                            "voxels of %.3g mm are too coarse for walls of %.3g mm: --voxel %.2g "
                            "or a larger lattice_cell would hold them",
                            f->voxel, f->wall_smallest, f->wall_smallest / 3));
    double width =
        iso_options_width(&settings, ISO_ROLE_INTERNAL_INFILL, false, settings.layer_height);
    if (f->wall_mean > 0 && f->wall_mean < width / 4 && w->format == FORMAT_GCODE)
        ISO_TRY(iso_report_warn(&w->report, "lattice-thin",
                                "walls of %.2g mm are thinner than the narrowest beads, so the "
                                "print is denser than asked: a larger lattice_cell, more density "
                                "or a finer nozzle would help",
                                f->wall_mean));
    if (f->left > 0 || f->removed_volume > 0.01 * f->volume)
        ISO_TRY(iso_report_warn(&w->report, "lattice-pieces",
                                "%lld pieces hold to nothing: %lld were removed, %.4g mm3 in all",
                                (long long)(f->removed + f->left), (long long)f->removed,
                                f->removed_volume));
    return ISO_OK;
}

static iso_status analyse(work *w) {
    iso_porous_options options = options_of(w);
    const iso_object *part = &w->objects.object[0];
    ISO_TRY(iso_porous_new(&w->porous, part->mesh, part->mesh_count, &options));
    iso_objects_free(&w->objects);
    ISO_TRY(iso_porous_analyse(&w->figures, w->porous));
    w->report.lattice = &w->figures;
    ISO_TRY(warn_of_figures(w));
    if (settings.lattice_open && w->figures.closed_pores > 0)
        return iso_fail(ISO_NOT_VERIFIED,
                        "%lld pores are closed, %.4g mm3 that nothing can leave; lattice_drain "
                        "opens a skin, and not every pattern is open",
                        (long long)w->figures.closed_pores, w->figures.closed_volume);
    return ISO_OK;
}

/* ---- formats ---- */

static iso_status write_stl(work *w) {
    ISO_TRY(analyse(w));
    w->report.lattice_output = "mesh";
    return iso_porous_write_stl(&w->report.lattice_triangles, w->porous, w->output);
}

static iso_status write_vdb(work *w) {
    iso_porous_kind kind;
    ISO_TRY(analyse(w));
    ISO_TRY(iso_porous_write_vdb(&kind, w->porous, w->output));
    w->report.lattice_output = kind == ISO_POROUS_MASK ? "mask" : "distance";
    if (kind == ISO_POROUS_MASK)
        return iso_report_warn(&w->report, "lattice-mask",
                               "%s is a mask: distances would need more than 1.5 GB", w->output);
    return ISO_OK;
}

/* A print needs no module, only what is told about it does. */
static iso_status find_reason(const char **reason, const work *w) {
    static const char *const several = "several objects are printed";
    static char missing[256];
    const void *table;
    *reason = w->objects.count > 1 ? several : NULL;
    for (int m = 0; m < ISO_MODULE_COUNT && !*reason; m++) {
        if (module_open(&table, m) == ISO_OK)
            continue;
        snprintf(missing, sizeof missing, "%s", iso_error_message());
        *reason = missing;
    }
    if (*reason && settings.lattice_open)
        return iso_fail(ISO_BAD_CONFIG, "lattice_open can't be told: %s", *reason);
    return ISO_OK;
}

static iso_status write_gcode(work *w) {
    iso_lattice_cut cut = {0};
    const iso_lattice_cut *used = NULL;
    const char *reason;
    ISO_TRY(load(w));
    ISO_TRY(find_reason(&reason, w));
    if (reason) {
        ISO_TRY(iso_report_warn(
            &w->report, "lattice-not-analysed",
            "not looked at: pieces of the lattice that hold to nothing stay; %s", reason));
    } else {
        ISO_TRY(analyse(w));
        iso_porous_cut(&cut, w->porous);
        used = &cut;
    }
    iso_progress_clear(&w->line);
    w->report.lattice_output = "gcode";
    return iso_slice_files(&w->report, w->arguments, &settings, used, w->output);
}

static iso_status run(work *w) {
    ISO_TRY(choose_settings(w));
    if (w->format == FORMAT_GCODE)
        return write_gcode(w);
    ISO_TRY(load(w));
    return w->format == FORMAT_STL ? write_stl(w) : write_vdb(w);
}

static void print_summary(const work *w) {
    bool talks = w->arguments->progress && !w->arguments->quiet;
    if (talks && w->report.lattice)
        iso_lattice_print(stderr, w->output, &w->figures);
}

static void note_time(work *w) {
    struct rusage usage;
    if (w->format == FORMAT_GCODE)
        return; /* the job has noted its own */
    w->report.seconds = clock_seconds() - w->begun;
    if (getrusage(RUSAGE_SELF, &usage) == 0)
        w->report.peak_memory_kib = usage.ru_maxrss;
}

iso_status iso_verb_lattice(const iso_arguments *arguments) {
    work *w = &job;
    if (arguments->file_count == 0)
        return iso_fail(ISO_USAGE, "no model given; see isoslice lattice --help");
    if (!arguments->output)
        return iso_fail(ISO_USAGE,
                        "say with -o where the lattice goes: to a file that ends in .stl, "
                        ".vdb or .gcode");
    *w = (work){.arguments = arguments, .output = arguments->output, .begun = clock_seconds()};
    ISO_TRY(find_format(&w->format, w->output));
    ISO_TRY(check_paths(w));
    iso_status status = run(w);
    iso_progress_clear(&w->line);
    note_time(w);
    iso_porous_free(w->porous);
    iso_objects_free(&w->objects);
    if (status == ISO_OK)
        print_summary(w);
    status = iso_finish_job(&w->report, arguments, &settings, status);
    iso_report_free(&w->report);
    return status;
}

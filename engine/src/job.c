/* The order of a job's stages. Nothing else knows it.
 *
 *     models -> meshes -> slices -> per layer: region -> walls -> fill -> paths -> order -> G-code
 *
 * Layers are made in blocks, in parallel; ordering and writing a block is serial, since each path
 * starts where the one before ended. So the bytes don't depend on the number of threads, and
 * nothing but the slices outlives its block. */
#include <isoslice/job.h>

#include <math.h>
#include <stdlib.h>
#include <sys/resource.h>

#include "base/memory.h"
#include "base/output.h"
#include "base/parallel.h"
#include "gcode/writer.h"
#include "path/order.h"
#include "planar/section.h"
#include "window.h"

enum { LAYERS_PER_THREAD = 8 };

static const char *const stage_name[ISO_STAGE_COUNT] = {"read",   "slice", "regions", "walls",
                                                        "shells", "fill",  "order",   "write"};

typedef struct iso_job {
    iso_report *report;
    const iso_options *options;
    const iso_job_hooks *hooks;
    iso_pool *pool;
    int32_t threads;
    iso_hand *hand; /* [threads] */

    int32_t model_count;
    iso_mesh *mesh;     /* [model_count]; emptied once sliced */
    iso_slices *slices; /* [model_count] */
    iso_vec3 min, max;  /* of all models */
    iso_levels levels;
    double projected; /* mm^2 of all triangles seen from above */

    int32_t block; /* layers filled in one go */
    iso_window window;
    int32_t begin,
        level; /* first layer of the parallel loop under way, and the level of its runs */
    iso_paths ordered;
    iso_order_state order;
    iso_output *output;
    iso_gcode_writer *writer;
    iso_texts texts;
    int32_t empty, lowest_empty; /* layers without a path, and the first of them */
    double seconds[ISO_STAGE_COUNT];
    int64_t bytes[ISO_STAGE_COUNT]; /* of each stage's output, at its largest */
} iso_job;

static void progress(const iso_job *job, double done, const char *stage) {
    if (job->hooks->progress)
        job->hooks->progress(job->hooks->payload, done, stage);
}

/* ---- models ---- */

static iso_status read_models(iso_job *job, const char *const *input) {
    for (int32_t i = 0; i < job->model_count; i++) {
        iso_mesh *mesh = &job->mesh[i];
        progress(job, 0.1 * i / job->model_count, stage_name[ISO_STAGE_READ]);
        ISO_TRY(iso_mesh_read(mesh, input[i]));
        ISO_TRY(iso_report_add_input(job->report, input[i], mesh));
    }
    return ISO_OK;
}

static double projected_area(const iso_mesh *mesh) {
    double sum = 0;
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        const int32_t *v = mesh->origin + 3 * (int64_t)t;
        iso_vec3 a = mesh->position[v[0]], b = mesh->position[v[1]], c = mesh->position[v[2]];
        sum += fabs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
    }
    return sum / 2;
}

/* Is (x, y) in the bed's polygon, its edge included? */
static bool on_bed(const iso_points *bed, double x, double y) {
    bool inside = false;
    for (int32_t i = 0; i < bed->count; i++) {
        iso_vec2 a = bed->point[i], b = bed->point[i + 1 == bed->count ? 0 : i + 1];
        double side = (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
        bool within = fmin(a.x, b.x) <= x && x <= fmax(a.x, b.x) && fmin(a.y, b.y) <= y &&
                      y <= fmax(a.y, b.y);
        if (side == 0 && within)
            return true;
        if ((a.y <= y) != (b.y <= y) && (side > 0) == (b.y > a.y))
            inside = !inside;
    }
    return inside;
}

static iso_status check_volume(const iso_job *job) {
    const iso_points *bed = &job->options->bed_shape;
    if (job->max.z > job->options->max_print_height)
        return iso_fail(ISO_OUTSIDE, "the model is %.2f mm high, max_print_height is %.2f mm",
                        job->max.z, job->options->max_print_height);
    if (on_bed(bed, job->min.x, job->min.y) && on_bed(bed, job->max.x, job->min.y) &&
        on_bed(bed, job->max.x, job->max.y) && on_bed(bed, job->min.x, job->max.y))
        return ISO_OK;
    for (int32_t m = 0; m < job->model_count; m++)
        for (int32_t v = 0; v < job->mesh[m].vertex_count; v++) {
            iso_vec3 p = job->mesh[m].position[v];
            if (!on_bed(bed, p.x, p.y))
                return iso_fail(
                    ISO_OUTSIDE,
                    "the model, %.2f x %.2f mm, reaches beyond the bed at (%.2f, %.2f); "
                    "see bed_shape and center",
                    job->max.x - job->min.x, job->max.y - job->min.y, p.x, p.y);
        }
    return ISO_OK;
}

static iso_status place_models(iso_job *job) {
    iso_meshes_place(job->mesh, job->model_count, iso_options_center(job->options));
    job->min = job->mesh[0].min;
    job->max = job->mesh[0].max;
    for (int32_t i = 1; i < job->model_count; i++) {
        const iso_mesh *mesh = &job->mesh[i];
        job->min = (iso_vec3){fmin(job->min.x, mesh->min.x), fmin(job->min.y, mesh->min.y),
                              fmin(job->min.z, mesh->min.z)};
        job->max = (iso_vec3){fmax(job->max.x, mesh->max.x), fmax(job->max.y, mesh->max.y),
                              fmax(job->max.z, mesh->max.z)};
    }
    return check_volume(job);
}

static int64_t slices_bytes(const iso_slices *slices) {
    return slices->crossing_count * (int64_t)sizeof *slices->point +
           slices->contour_count * (int64_t)sizeof *slices->contour_first +
           slices->level_count * (int64_t)sizeof *slices->level_first;
}

/* Each mesh is let go as soon as it is sliced. */
static iso_status slice_models(iso_job *job) {
    double heights[ISO_NUMBERS_MAX + 1];
    int32_t count = iso_options_heights(heights, job->options);
    iso_report *report = job->report;
    ISO_TRY(iso_levels_from_heights(&job->levels, heights, count, job->max.z));
    if (job->levels.count == 0)
        return iso_fail(ISO_OUTSIDE,
                        "the model is %.4f mm high: too low for a first layer of %.3f mm",
                        job->max.z, heights[0]);
    report->layer_count = job->levels.count;
    report->printed_height = job->levels.top[job->levels.count - 1];
    for (int32_t i = 0; i < job->model_count; i++) {
        iso_mesh *mesh = &job->mesh[i];
        ISO_TRY(iso_slice_planar(&job->slices[i], mesh, &job->levels));
        report->mesh_volume += iso_mesh_volume_between(mesh, 0, report->printed_height);
        job->projected += projected_area(mesh);
        job->bytes[ISO_STAGE_READ] += job->report->input[i].mesh_bytes;
        job->bytes[ISO_STAGE_SLICE] += slices_bytes(&job->slices[i]);
        iso_mesh_free(mesh);
    }
    return ISO_OK;
}

/* Slices at the middles of layers miss the volume by less than half a layer under all surface seen
 * from above, and usually by far less. More than that is a wrong slice. */
static iso_status verify_volume(const iso_job *job) {
    const iso_report *report = job->report;
    double sliced = 0, thickest = 0;
    for (int32_t i = 0; i < job->levels.count; i++) {
        double area = 0;
        for (int32_t m = 0; m < job->model_count; m++)
            area += section_area(&job->slices[m], i);
        sliced += area * job->levels.height[i];
        thickest = fmax(thickest, job->levels.height[i]);
    }
    double allowed = 1e-6 * report->mesh_volume + job->projected * thickest / 2;
    if (fabs(sliced - report->mesh_volume) > allowed)
        return iso_fail(ISO_NOT_VERIFIED,
                        "the slices hold %.3f mm^3, the model %.3f mm^3: nothing was written",
                        sliced, report->mesh_volume);
    return ISO_OK;
}

/* ---- layers ---- */

static iso_status outline_task(void *payload, int64_t number, int worker) {
    iso_job *job = payload;
    int32_t index = job->begin + (int32_t)number;
    iso_layer *layer = window_layer(&job->window, index);
    settings_of_layer(&layer->settings, job->options, index, job->levels.height[index]);
    layer->settings.sparse.z = iso_units(job->levels.cut[index]);
    return layer_outline(layer, &job->hand[worker], job->slices, job->model_count, index);
}

static iso_status widen_task(void *payload, int64_t number, int worker) {
    iso_job *job = payload;
    return window_widen(&job->window, job->begin + (int32_t)number, job->level,
                        job->hand[worker].planar);
}

static iso_status split_task(void *payload, int64_t number, int worker) {
    iso_job *job = payload;
    int32_t index = job->begin + (int32_t)number;
    iso_shell_neighbours around = window_around(&job->window, index);
    return layer_split(window_layer(&job->window, index), &job->hand[worker], &around);
}

static iso_status fill_task(void *payload, int64_t number, int worker) {
    iso_job *job = payload;
    int32_t index = job->begin + (int32_t)number;
    const iso_layer *beneath = index > 0 ? window_layer(&job->window, index - 1) : NULL;
    return layer_fill(window_layer(&job->window, index), &job->hand[worker], beneath);
}

/* Models lie on the bed; what is drawn around them need not. */
static iso_status check_skirt(const iso_job *job, const iso_paths *paths) {
    for (int32_t i = 0; i < paths->count; i++) {
        const iso_path *path = &paths->path[i];
        for (int32_t v = path->first; path->role == ISO_ROLE_SKIRT && v < path->first + path->count;
             v++) {
            iso_point at = paths->vertex[v].at;
            if (!on_bed(&job->options->bed_shape, iso_mm(at.x), iso_mm(at.y)))
                return iso_fail(ISO_OUTSIDE,
                                "the skirt reaches beyond the bed at (%.2f, %.2f); see skirts and "
                                "skirt_distance",
                                iso_mm(at.x), iso_mm(at.y));
        }
    }
    return ISO_OK;
}

static iso_status write_layer(iso_job *job, int32_t index) {
    iso_layer *layer = window_layer(&job->window, index);
    double begun = iso_stage_clock();
    if (index == 0)
        ISO_TRY(check_skirt(job, &layer->paths));
    iso_order_options order = settings_of_order(job->options);
    ISO_TRY(
        iso_order_layer(&job->ordered, &layer->paths, &job->order, &order, &job->hand[0].arena));
    double ordered = iso_stage_clock();
    if (job->ordered.count == 0 && job->empty++ == 0)
        job->lowest_empty = index;
    double top = job->levels.top[index] + job->options->z_offset;
    iso_gcode_layer_info info = {.index = index,
                                 .z = iso_units(top),
                                 .height = iso_units(job->levels.height[index]),
                                 .paths = &job->ordered};
    ISO_TRY(iso_gcode_layer(job->writer, &info));
    layer->seconds[ISO_STAGE_ORDER] = ordered - begun;
    layer->seconds[ISO_STAGE_WRITE] = iso_stage_clock() - ordered;
    for (int s = 0; s < ISO_STAGE_COUNT; s++)
        job->seconds[s] += layer->seconds[s];
    job->report->sliced_volume += layer->square_mm * job->levels.height[index];
    return ISO_OK;
}

static iso_status warn_of_empty_layers(const iso_job *job) {
    if (job->empty == 0)
        return ISO_OK;
    return iso_report_warn(job->report, "empty-layers",
                           "%d of %d layers have no room for a bead and stay empty, the lowest at "
                           "z = %.3f mm",
                           job->empty, job->levels.count, job->levels.top[job->lowest_empty]);
}

static int32_t least(int32_t a, int32_t b) {
    return a < b ? a : b;
}

/* Outlines up to `end`, and the runs that lie wholly below it. */
static iso_status advance(iso_job *job, int32_t end) {
    iso_window *window = &job->window;
    for (job->level = 0; job->level < window->levels; job->level++) {
        int32_t wide = window_wide_end(job->level, end);
        job->begin = window->made[job->level];
        if (wide <= job->begin)
            break;
        ISO_TRY(iso_parallel_for(job->pool, wide - job->begin,
                                 job->level == 0 ? outline_task : widen_task, job));
        window->made[job->level] = wide;
    }
    return ISO_OK;
}

/* Layers up to `end` split into their shells. */
static iso_status split_layers(iso_job *job, int32_t end) {
    iso_window *window = &job->window;
    ISO_TRY(advance(job, least(end + window->top, window->count)));
    job->begin = window->split;
    ISO_TRY(iso_parallel_for(job->pool, end - job->begin, split_task, job));
    window->split = end;
    return ISO_OK;
}

/* Outlines run ahead by the height of the top shell, and stay until the bottom shell above them is
 * done. */
static iso_status make_layers(iso_job *job) {
    int32_t count = job->levels.count;
    for (int32_t filled = 0; filled < count;) {
        int32_t end = least(filled + job->block, count);
        progress(job, 0.15 + 0.85 * filled / count, "layers");
        ISO_TRY(split_layers(job, end));
        job->begin = filled;
        ISO_TRY(iso_parallel_for(job->pool, end - filled, fill_task, job));
        for (; filled < end; filled++)
            ISO_TRY(write_layer(job, filled));
    }
    progress(job, 1, "done");
    return warn_of_empty_layers(job);
}

/* ---- output ---- */

static iso_status config_line(void *payload, const char *key, const char *value) {
    iso_output *output = payload;
    iso_output_write(output, "; ", 2);
    iso_output_write(output, key, strlen(key));
    iso_output_write(output, " = ", 3);
    iso_output_write(output, value, strlen(value));
    return iso_output_write(output, "\n", 1);
}

typedef struct iso_config_block {
    const iso_options *options;
} iso_config_block;

static iso_status config_lines(iso_output *output, void *payload) {
    const iso_config_block *block = payload;
    return iso_options_print(block->options, config_line, output);
}

static iso_status begin_texts(iso_job *job) {
    const iso_macro_job known = {.input_filename = job->report->input[0].path,
                                 .timestamp = job->hooks->timestamp,
                                 .object_count = job->model_count,
                                 .instance_count = job->model_count,
                                 .layer_count = job->levels.count};
    texts_begin(&job->texts, job->options, &known);
    ISO_TRY(texts_place(&job->texts, job->slices, job->model_count));
    return texts_check(&job->texts, job->levels.top[job->levels.count - 1]);
}

static iso_status begin_output(iso_job *job, const char *path) {
    ISO_TRY(begin_texts(job));
    iso_gcode_options gcode = settings_of_gcode(job->options, &job->texts, job->hooks->timestamp);
    ISO_TRY(iso_output_open(&job->output, path));
    ISO_TRY(iso_gcode_writer_new(&job->writer, job->output, &gcode));
    return iso_gcode_begin(job->writer);
}

static iso_status finish_output(iso_job *job) {
    iso_config_block block = {job->options};
    ISO_TRY(iso_gcode_finish(&job->report->print, job->writer, config_lines, &block));
    iso_output *output = job->output;
    job->output = NULL; /* commit frees it, whatever comes of it */
    return iso_output_commit(output);
}

/* ---- the job ---- */

static iso_status job_new(iso_job *job, int32_t input_count) {
    job->model_count = input_count;
    ISO_TRY(iso_pool_new(&job->pool, job->hooks->threads));
    job->threads = job->report->threads = iso_pool_threads(job->pool);
    job->block = LAYERS_PER_THREAD * job->threads;
    ISO_TRY(ISO_ALLOCATE(job->mesh, input_count));
    memset(job->mesh, 0, (size_t)input_count * sizeof *job->mesh);
    ISO_TRY(ISO_ALLOCATE(job->slices, input_count));
    memset(job->slices, 0, (size_t)input_count * sizeof *job->slices);
    ISO_TRY(ISO_ALLOCATE(job->hand, job->threads));
    memset(job->hand, 0, (size_t)job->threads * sizeof *job->hand);
    for (int32_t i = 0; i < job->threads; i++)
        ISO_TRY(hand_new(&job->hand[i]));
    return ISO_OK;
}

static void job_free(iso_job *job) {
    iso_gcode_writer_free(job->writer);
    iso_output_abandon(job->output);
    for (int32_t i = 0; job->mesh && i < job->model_count; i++)
        iso_mesh_free(&job->mesh[i]);
    for (int32_t i = 0; job->slices && i < job->model_count; i++)
        iso_slices_free(&job->slices[i]);
    window_free(&job->window);
    for (int32_t i = 0; job->hand && i < job->threads; i++)
        hand_free(&job->hand[i]);
    iso_paths_free(&job->ordered);
    iso_order_state_free(&job->order);
    iso_levels_free(&job->levels);
    iso_release(job->mesh);
    iso_release(job->slices);
    iso_release(job->hand);
    texts_free(&job->texts);
    iso_pool_free(job->pool);
}

static void report_kernel(iso_job *job) {
    for (int32_t i = 0; job->hand && i < job->threads && job->hand[i].planar; i++) {
        iso_planar_counts c = iso_planar_get_counts(job->hand[i].planar);
        iso_planar_counts *sum = &job->report->kernel;
        sum->operations += c.operations;
        sum->untouched += c.untouched;
        sum->arranged += c.arranged;
        sum->edges += c.edges;
        sum->collisions += c.collisions;
    }
}

static int64_t region_bytes(const iso_region *region) {
    return region->point_capacity * (int64_t)sizeof *region->point +
           region->contour_capacity * (int64_t)(sizeof *region->first + sizeof *region->parent);
}

static int64_t paths_bytes(const iso_paths *paths) {
    return paths->vertex_capacity * (int64_t)sizeof *paths->vertex +
           paths->path_capacity * (int64_t)sizeof *paths->path;
}

/* The window's layers keep their room from layer to layer, so at the end it is the largest there
 * was. Walls and fill share the paths. */
static void measure_window(iso_job *job) {
    const iso_window *window = &job->window;
    for (int32_t i = 0; window->layer && i < window->ring; i++) {
        const iso_layer *layer = &window->layer[i];
        job->bytes[ISO_STAGE_REGIONS] += region_bytes(&layer->region);
        job->bytes[ISO_STAGE_WALLS] += region_bytes(&layer->area);
        for (int32_t k = 0; k < layer->levels; k++)
            job->bytes[ISO_STAGE_SHELLS] += region_bytes(&layer->run[k]);
        job->bytes[ISO_STAGE_FILL] += paths_bytes(&layer->paths);
    }
    job->bytes[ISO_STAGE_ORDER] = paths_bytes(&job->ordered);
}

static iso_status report_stages(iso_job *job, double begun) {
    struct rusage usage;
    report_kernel(job);
    measure_window(job);
    job->report->seconds = iso_stage_clock() - begun;
    if (getrusage(RUSAGE_SELF, &usage) == 0)
        job->report->peak_memory_kib = usage.ru_maxrss;
    for (int s = 0; s < ISO_STAGE_COUNT; s++)
        ISO_TRY(iso_report_add_stage(job->report, stage_name[s], job->seconds[s], job->bytes[s]));
    return ISO_OK;
}

static iso_status load(iso_job *job, const char *const *input, int32_t input_count) {
    double begun = iso_stage_clock();
    if (input_count < 1)
        return iso_fail(ISO_USAGE, "no model was given");
    for (int k = 0; k < ISO_STAGE_COUNT;
         k++) /* so that no report can fail once the output is there */
        ISO_TRY(iso_report_add_stage(job->report, stage_name[k], 0, 0));
    ISO_TRY(iso_options_check(job->options));
    ISO_TRY(job_new(job, input_count));
    ISO_TRY(read_models(job, input));
    ISO_TRY(place_models(job));
    double read = iso_stage_clock();
    progress(job, 0.1, stage_name[ISO_STAGE_SLICE]);
    ISO_TRY(slice_models(job));
    ISO_TRY(verify_volume(job));
    iso_shell_depth shells = settings_of_shells(job->options);
    ISO_TRY(window_new(&job->window, &job->levels, &shells, job->block, 0));
    job->seconds[ISO_STAGE_READ] = read - begun;
    job->seconds[ISO_STAGE_SLICE] = iso_stage_clock() - read;
    return ISO_OK;
}

static iso_status print_job(iso_job *job, const char *const *input, int32_t input_count,
                            const char *output) {
    ISO_TRY(load(job, input, input_count));
    ISO_TRY(begin_output(job, output));
    ISO_TRY(make_layers(job));
    double begun = iso_stage_clock();
    ISO_TRY(finish_output(job));
    job->seconds[ISO_STAGE_WRITE] += iso_stage_clock() - begun;
    return ISO_OK;
}

iso_status iso_job_run(iso_report *report, const iso_options *options, const char *const *input,
                       int32_t input_count, const char *output, const iso_job_hooks *hooks) {
    static const iso_job_hooks none;
    iso_job job = {.report = report, .options = options, .hooks = hooks ? hooks : &none};
    double begun = iso_stage_clock();
    iso_status status = print_job(&job, input, input_count, output);
    iso_status reported = report_stages(&job, begun);
    job_free(&job);
    return status != ISO_OK ? status : reported;
}

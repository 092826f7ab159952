/* The order of a job's stages. Nothing else knows it.
 *
 *     files -> plate: objects, copies -> stacks: slices -> per layer: region -> walls -> fill ->
 * paths
 *           -> steps: the copies' paths of one height -> order -> G-code
 *
 * Layers are made once for all copies of an object, in blocks, in parallel; ordering and writing is
 * serial, since each path starts where the one before ended. So the bytes don't depend on the
 * number of threads, and nothing but the slices outlives its block. */
#include <isoslice/job.h>

#include <math.h>
#include <stdlib.h>
#include <sys/resource.h>

#include "base/memory.h"
#include "base/output.h"
#include "bend.h"
#include "config/foreign.h"
#include "gcode/writer.h"
#include "path/order.h"
#include "path/spiral.h"
#include "plate.h"
#include "reachable.h"
#include "stack.h"
#include "surround.h"

static const char *const stage_name[ISO_STAGE_COUNT] = {"read",   "slice", "regions", "walls",
                                                        "shells", "fill",  "order",   "write"};

typedef struct iso_job {
    iso_report *report;
    const iso_options *options;
    const iso_job_hooks *hooks;
    iso_crew crew;
    iso_plate plate;
    iso_stack *stack; /* [plate.objects.count] */
    int32_t *next;    /* [plate.objects.count] layers that are written, of each object */

    int64_t layers, layers_done; /* of all objects, for the progress */
    int32_t steps;               /* written so far */
    iso_surround surround;
    iso_paths piece, ordered;
    iso_order_options order;
    iso_order_state *state; /* [tools][plate.instances.count + 1] of each copy; the last: what is
                             * around */
    int32_t tools, tool;    /* how many the print takes, and which one the nozzle is of */
    iso_point position;     /* of the nozzle */
    bool spirals;           /* the layer below did */
    iso_bend bend;
    iso_output *output;
    iso_gcode_writer *writer;
    iso_texts texts;
    int32_t empty;       /* steps without a path */
    double lowest_empty; /* mm, top of the first of them */
    double seconds[ISO_STAGE_COUNT];
    int64_t bytes[ISO_STAGE_COUNT]; /* of each stage's output, at its largest */
} iso_job;

static void progress(const iso_job *job, double done, const char *stage) {
    if (job->hooks->progress)
        job->hooks->progress(job->hooks->payload, done, stage);
}

/* ---- objects ---- */

static iso_status slice_objects(iso_job *job) {
    iso_report *report = job->report;
    int32_t count = job->plate.objects.count;
    ISO_TRY(ISO_ALLOCATE(job->stack, count));
    memset(job->stack, 0, (size_t)count * sizeof *job->stack);
    ISO_TRY(ISO_ALLOCATE(job->next, count));
    memset(job->next, 0, (size_t)count * sizeof *job->next);
    for (int32_t i = 0; i < count; i++) {
        iso_stack *stack = &job->stack[i];
        stack->report = report;
        stack->cut = count == 1 ? job->hooks->lattice_cut : NULL;
        ISO_TRY(stack_slice(stack, &job->plate.objects.object[i], job->options,
                            job->plate.modifiers.count > 0 ? &job->plate.modifiers : NULL,
                            &job->crew));
        double height = stack->levels.top[stack->levels.count - 1];
        if (stack->levels.count > report->layer_count)
            report->layer_count = stack->levels.count;
        report->printed_height = fmax(report->printed_height, height);
        job->bytes[ISO_STAGE_SLICE] += stack->slice_bytes;
        job->tools = job->tools > stack->tools ? job->tools : stack->tools;
    }
    for (int32_t i = 0; i < report->input_count; i++)
        job->bytes[ISO_STAGE_READ] += report->input[i].mesh_bytes;
    for (int32_t i = 0; i < job->plate.instances.count; i++) {
        const iso_stack *stack = &job->stack[job->plate.instances.instance[i].object];
        report->mesh_volume += stack->mesh_volume;
        job->layers += stack->levels.count;
    }
    return ISO_OK;
}

/* ---- what surrounds the print ---- */

static iso_status add_moved(iso_region *all, const iso_region *region, iso_point by) {
    int32_t base = all->count ? all->first[all->count] : 0;
    for (int32_t c = 0; c < region->count; c++)
        ISO_TRY(iso_region_add(all, region->point + region->first[c],
                               region->first[c + 1] - region->first[c]));
    for (int32_t p = base; all->count && p < all->first[all->count]; p++)
        all->point[p] = (iso_point){all->point[p].x + by.x, all->point[p].y + by.y};
    return ISO_OK;
}

/* The first layers of all copies. */
static iso_status gather_first_layers(iso_region *all, iso_job *job) {
    for (int32_t i = 0; i < job->plate.instances.count; i++) {
        const iso_instance *instance = &job->plate.instances.instance[i];
        iso_layer *layer;
        ISO_TRY(stack_layer(&layer, &job->stack[instance->object], 0));
        ISO_TRY(add_moved(all, &layer->region, instance->by));
    }
    return ISO_OK;
}

/* Where the objects reach to, on layers that have a skirt. */
static iso_status gather_feet(iso_region *all, iso_job *job) {
    for (int32_t i = 0; i < job->plate.instances.count; i++) {
        const iso_instance *instance = &job->plate.instances.instance[i];
        ISO_TRY(add_moved(all, &job->plate.objects.object[instance->object].foot, instance->by));
    }
    return ISO_OK;
}

/* ---- steps ---- */

/* What is printed at one height: a layer of each of some objects, for some of their copies. */
typedef struct iso_step {
    int32_t z, height;            /* units */
    const iso_instance *instance; /* [count]; those of other objects are passed over */
    int32_t count;
} iso_step;

static bool takes_part(const iso_job *job, const iso_step *step, int32_t object) {
    const iso_levels *levels = &job->stack[object].levels;
    int32_t next = job->next[object];
    return next < levels->count && iso_units(levels->top[next]) == step->z &&
           iso_units(levels->height[next]) == step->height;
}

static int32_t states(const iso_job *job) {
    return job->plate.instances.count + 1;
}

/* Those of one tool; their vertices are the others' too. */
static iso_status choose_paths(iso_paths *out, const iso_paths *paths, int32_t tool,
                               iso_arena *arena) {
    *out = (iso_paths){.vertex = paths->vertex, .vertex_count = paths->vertex_count};
    ISO_TRY(ISO_PUSH(out->path, arena, paths->count));
    for (int32_t i = 0; i < paths->count; i++)
        if (paths->path[i].tool == tool)
            out->path[out->count++] = paths->path[i];
    return ISO_OK;
}

/* The ordered piece, in space and where it belongs on the bed. */
static iso_status place_piece(iso_job *job, iso_bend_layer *layer, iso_point by) {
    iso_paths *placed;
    ISO_TRY(bend_lift(&placed, &job->bend, &job->piece, layer, &job->crew.hand[0].arena));
    return iso_paths_append(&job->ordered, placed, by, layer->copy);
}

/* Paths of a step: `copy` is the number of an instance; as many as there are: what is around them.
 * `merged`: the layer is 2^merged levels thick. */
typedef struct iso_turn {
    const iso_paths *paths;
    int32_t copy, tool, merged;
} iso_turn;

/* A print with one tool takes the paths as they are. */
static iso_status order_paths(iso_job *job, const iso_step *step, const iso_turn *turn) {
    const iso_paths *paths = turn->paths;
    int32_t copy = turn->copy, tool = turn->tool;
    bool around = copy == job->plate.instances.count;
    const iso_instance *instance = &job->plate.instances.instance[around ? 0 : copy];
    const iso_stack *stack = &job->stack[instance->object];
    iso_point by = around ? (iso_point){0, 0} : instance->by;
    iso_bend_layer layer = {.curved = around ? NULL : &stack->curved,
                            .levels = &stack->levels,
                            .level = job->next[instance->object],
                            .merged = turn->merged,
                            .height = step->height,
                            .copy = around ? -1 : copy};
    iso_order_state *state = &job->state[tool * states(job) + copy];
    iso_arena *arena = &job->crew.hand[0].arena;
    iso_arena_mark mark = iso_arena_get_mark(arena);
    iso_paths own;
    layer.from = state->position = (iso_point){job->position.x - by.x, job->position.y - by.y};
    if (job->tools > 1) {
        ISO_TRY(choose_paths(&own, paths, tool, arena));
        paths = &own;
    }
    ISO_TRY(iso_order_layer(&job->piece, paths, state, &job->order, arena));
    iso_arena_pop(arena, mark);
    job->position = (iso_point){state->position.x + by.x, state->position.y + by.y};
    return place_piece(job, &layer, by);
}

/* The layers that take part, with their paths. */
static iso_status make_layers(iso_job *job, const iso_step *step) {
    for (int32_t i = 0; i < job->plate.objects.count; i++) {
        iso_layer *layer;
        if (!takes_part(job, step, i))
            continue;
        ISO_TRY(stack_layer(&layer, &job->stack[i], job->next[i]));
        for (int s = 0; s < ISO_STAGE_COUNT; s++)
            job->seconds[s] += layer->seconds[s];
        memset(layer->seconds, 0, sizeof layer->seconds);
    }
    return ISO_OK;
}

/* Of layers of a field several may end at one level, of different thickness (chart/spread.h). */
static iso_status order_layer(iso_job *job, const iso_step *step, int32_t copy, int32_t tool) {
    int32_t object = job->plate.instances.instance[copy].object, level = job->next[object];
    const iso_stack *stack = &job->stack[object];
    iso_arena *arena = &job->crew.hand[0].arena;
    iso_arena_mark mark = iso_arena_get_mark(arena);
    for (int32_t k = 0; k < curved_merges(&stack->curved, level); k++) {
        const iso_layer *layer =
            window_layer(&stack->window, curved_source(&stack->curved, level, k));
        iso_turn turn = {.copy = copy, .tool = tool, .merged = k};
        iso_sets sets;
        ISO_TRY(curved_part(&turn.paths, &job->bend.part, &stack->curved, &layer->paths,
                            (int32_t[2]){level, k}, arena));
        double r = stack->curved.low + stack->levels.top[level];
        ISO_TRY(reachable_sets(&sets, turn.paths, &stack->curved, r, bend_tool(&job->bend), arena));
        for (int32_t i = 0; i < sets.count; i++) {
            turn.paths = &sets.set[i];
            ISO_TRY(order_paths(job, step, &turn));
        }
        iso_arena_pop(arena, mark);
    }
    return ISO_OK;
}

/* What one tool prints. Copies take turns there and back again, so that the next layer begins where
 * this one ends. */
static iso_status order_tool(iso_job *job, const iso_step *step, const iso_paths *around,
                             int32_t tool) {
    if (around)
        ISO_TRY(order_paths(job, step, &(iso_turn){around, job->plate.instances.count, tool, 0}));
    for (int32_t k = 0; k < step->count; k++) {
        int32_t i = job->steps & 1 ? step->count - 1 - k : k;
        const iso_instance *instance = &step->instance[i];
        int32_t object = instance->object, index = job->next[object];
        const iso_stack *stack = &job->stack[object];
        if (!takes_part(job, step, object))
            continue;
        const iso_layer *layer = window_layer(&stack->window, index);
        ISO_TRY(order_layer(job, step, (int32_t)(instance - job->plate.instances.instance), tool));
        if (tool > 0)
            continue; /* it has been counted */
        job->report->sliced_volume += stack->level_volume
                                          ? stack->level_volume[index]
                                          : layer->square_mm * stack->levels.height[index];
        job->layers_done++;
    }
    return ISO_OK;
}

/* The tool that the layer below ended with begins: so there's one change in a layer. */
static iso_status order_step(iso_job *job, const iso_step *step) {
    double begun = iso_stage_clock();
    iso_paths_clear(&job->ordered);
    const iso_paths *around;
    ISO_TRY(surround_step(&around, &job->surround, step->z, step->height, job->options));
    for (int32_t turn = 0; turn < job->tools; turn++)
        ISO_TRY(order_tool(job, step, around, turn == 0 ? job->tool : 1 - job->tool));
    if (job->ordered.count > 0)
        job->tool = job->ordered.path[job->ordered.count - 1].tool;
    job->seconds[ISO_STAGE_ORDER] += iso_stage_clock() - begun;
    return ISO_OK;
}

/* Above the bottom shell. The next loop goes on from where the one below ended: a short way off at
 * most, on upright walls none. */
static iso_status spiral_step(iso_job *job, const iso_step *step, int32_t index, iso_point from) {
    bool flat = !job->spirals;
    if (!job->options->spiral_vase || index < job->options->bottom_solid_layers || index == 0) {
        job->spirals = false; /* the object before may have ended as one */
        return ISO_OK;
    }
    ISO_TRY(path_spiral(&job->spirals, &job->ordered, flat ? NULL : &from, step->height, flat));
    return ISO_OK;
}

/* Outlines may have been thinned, and joins of walls be off, by 0.4 of gcode_resolution each. */
static iso_status find_arcs(iso_gcode_layer_info *info, const iso_job *job, iso_arena *arena) {
    iso_arc_options options = iso_arc_defaults();
    iso_arc *arc;
    options.tolerance = 0.5 * job->options->gcode_resolution * ISO_UNITS_PER_MM;
    ISO_TRY(iso_paths_find_arcs(&arc, &info->arc_count, &job->ordered, &options, arena));
    info->arc = arc;
    return ISO_OK;
}

/* Then a step prints nothing where it is part of a thicker layer that ends higher up. */
static bool merges(const iso_job *job) {
    for (int32_t i = 0; i < job->plate.objects.count; i++)
        if (curved_behind(&job->stack[i].curved) > 0)
            return true;
    return false;
}

static iso_status write_step(iso_job *job, const iso_step *step, int32_t index) {
    iso_point from = job->position;
    ISO_TRY(make_layers(job, step));
    ISO_TRY(order_step(job, step));
    ISO_TRY(spiral_step(job, step, index, from));
    double begun = iso_stage_clock();
    if (job->ordered.count == 0 && !merges(job) && job->empty++ == 0)
        job->lowest_empty = iso_mm(step->z);
    iso_arena *arena = &job->crew.hand[0].arena;
    iso_arena_mark mark = iso_arena_get_mark(arena);
    iso_gcode_layer_info info = {.index = index,
                                 .z = step->z + iso_units(job->options->z_offset),
                                 .height = step->height,
                                 .paths = &job->ordered};
    if (job->options->arc_fitting != ISO_ARCS_DISABLED && !job->bend.on)
        ISO_TRY(find_arcs(&info, job, arena));
    ISO_TRY(bend_pose(&info, &job->bend));
    iso_status status = iso_gcode_layer(job->writer, &info);
    iso_arena_pop(arena, mark);
    ISO_TRY(status);
    ISO_TRY(bend_check(&job->bend, false));
    job->seconds[ISO_STAGE_WRITE] += iso_stage_clock() - begun;
    for (int32_t i = 0; i < job->plate.objects.count; i++)
        job->next[i] += takes_part(job, step, i);
    job->steps++;
    progress(job, 0.15 + 0.85 * (double)job->layers_done / (double)job->layers, "layers");
    return ISO_OK;
}

/* The lowest layer that isn't written yet. */
static bool next_step(iso_step *step, const iso_job *job) {
    bool found = false;
    for (int32_t i = 0; i < job->plate.objects.count; i++) {
        const iso_levels *levels = &job->stack[i].levels;
        int32_t next = job->next[i];
        if (next == levels->count)
            continue;
        int32_t z = iso_units(levels->top[next]), height = iso_units(levels->height[next]);
        if (!found || z < step->z || (z == step->z && height < step->height)) {
            step->z = z;
            step->height = height;
        }
        found = true;
    }
    return found;
}

static iso_status print_together(iso_job *job) {
    const iso_instances *instances = &job->plate.instances;
    iso_step step = {.instance = instances->instance, .count = instances->count};
    for (int32_t index = 0; next_step(&step, job); index++)
        ISO_TRY(write_step(job, &step, index));
    return ISO_OK;
}

/* Objects that aren't being printed are kept out by having no layer left. */
static iso_status print_one_by_one(iso_job *job) {
    const iso_instances *instances = &job->plate.instances;
    for (int32_t i = 0; i < job->plate.objects.count; i++)
        job->next[i] = job->stack[i].levels.count;
    for (int32_t i = 0; i < instances->count; i++) {
        iso_step step = {.instance = &instances->instance[i], .count = 1};
        int32_t object = step.instance->object;
        if (i > 0)
            ISO_TRY(iso_gcode_next_object(job->writer, i));
        stack_rewind(&job->stack[object]);
        job->next[object] = 0;
        for (int32_t index = 0; next_step(&step, job); index++)
            ISO_TRY(write_step(job, &step, index));
    }
    return ISO_OK;
}

static iso_status warn_of_empty_layers(const iso_job *job) {
    if (job->empty == 0)
        return ISO_OK;
    return iso_report_warn(job->report, "empty-layers",
                           "%d of %d layers have no room for a bead and stay empty, the lowest at "
                           "z = %.3f mm",
                           job->empty, job->steps, job->lowest_empty);
}

static iso_status warn_of_unused_modifiers(const iso_job *job) {
    for (int32_t i = 0; i < job->plate.modifiers.count; i++) {
        const iso_modifier *modifier = &job->plate.modifiers.modifier[i];
        bool used = false;
        for (int32_t k = 0; k < job->crew.count; k++)
            used = used || (job->crew.hand[k].modified.used && job->crew.hand[k].modified.used[i]);
        if (!used)
            ISO_TRY(iso_report_warn(job->report, "modifier-unused",
                                    "modifiers, line %d: %s changes nothing: no sparse infill of "
                                    "the print is within it, or later modifiers have all of it",
                                    modifier->line, modifier->path));
    }
    return ISO_OK;
}

static iso_status print_steps(iso_job *job) {
    int64_t count = (int64_t)job->tools * states(job);
    ISO_TRY(ISO_ALLOCATE(job->state, count));
    memset(job->state, 0, (size_t)count * sizeof *job->state);
    job->order = settings_of_order(job->options);
    ISO_TRY(job->options->complete_objects ? print_one_by_one(job) : print_together(job));
    progress(job, 1, "done");
    ISO_TRY(warn_of_unused_modifiers(job));
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
    ISO_TRY(iso_options_print(block->options, config_line, output));
    return iso_foreign_print(&block->options->foreign, config_line, output);
}

static iso_status begin_texts(iso_job *job, const iso_region *first) {
    const iso_macro_job known = {.input_filename = job->report->input[0].path,
                                 .timestamp = job->hooks->timestamp,
                                 .object_count = job->plate.objects.count,
                                 .instance_count = job->plate.instances.count,
                                 .layer_count = job->report->layer_count};
    texts_begin(&job->texts, job->options, &known);
    ISO_TRY(texts_place(&job->texts, first));
    return texts_check(&job->texts, job->report->printed_height);
}

/* Then there is no bed to draw a skirt on. */
static bool has_mandrel(const iso_job *job) {
    return job->options->field[0] && (job->options->kinematics == ISO_KINEMATICS_ROTARY_A ||
                                      job->options->kinematics == ISO_KINEMATICS_ROTARY_B);
}

/* What the first layer decides, before anything is written. */
static iso_status look_at_first_layers(iso_job *job) {
    iso_region first = {0}, all = {0};
    iso_status status = gather_first_layers(&first, job);
    if (status == ISO_OK)
        status = gather_feet(&all, job);
    if (status == ISO_OK && !has_mandrel(job))
        status =
            surround_make(&job->surround, &first, &all, job->options, job->crew.hand[0].planar);
    if (status == ISO_OK)
        status = begin_texts(job, &first);
    iso_region_free(&first);
    iso_region_free(&all);
    return status;
}

static iso_status begin_output(iso_job *job, const char *path) {
    iso_gcode_options gcode = settings_of_gcode(job->options, &job->texts, job->hooks->timestamp);
    gcode.tools = job->tools;
    gcode.object = job->plate.label;
    gcode.object_count = job->plate.label ? job->plate.instances.count : 0;
    for (int32_t i = 0; i < job->plate.instances.count && !job->bend.on; i++) {
        const iso_instance *instance = &job->plate.instances.instance[i];
        const iso_curved *curved = &job->stack[instance->object].curved;
        if (!curved_is_flat(curved))
            ISO_TRY(bend_begin(&job->bend, &gcode, job->options, curved, instance->by,
                               job->plate.instances.count == 1));
    }
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

static void job_free(iso_job *job) {
    iso_gcode_writer_free(job->writer);
    iso_output_abandon(job->output);
    for (int32_t i = 0; job->stack && i < job->plate.objects.count; i++)
        stack_free(&job->stack[i]);
    iso_release(job->stack);
    iso_release(job->next);
    for (int32_t i = 0; job->state && i < job->tools * states(job); i++)
        iso_order_state_free(&job->state[i]);
    iso_release(job->state);
    bend_free(&job->bend);
    crew_free(&job->crew);
    plate_free(&job->plate);
    surround_free(&job->surround);
    iso_paths_free(&job->piece);
    iso_paths_free(&job->ordered);
    texts_free(&job->texts);
}

static void report_kernel(iso_job *job) {
    for (int32_t i = 0; job->crew.hand && i < job->crew.count && job->crew.hand[i].planar; i++) {
        iso_planar_counts c = iso_planar_get_counts(job->crew.hand[i].planar);
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
static void measure_window(iso_job *job, const iso_window *window) {
    for (int32_t i = 0; window->layer && i < window->ring; i++) {
        const iso_layer *layer = &window->layer[i];
        job->bytes[ISO_STAGE_REGIONS] += region_bytes(&layer->region);
        job->bytes[ISO_STAGE_WALLS] += region_bytes(&layer->area);
        for (int32_t k = 0; k < layer->levels; k++)
            job->bytes[ISO_STAGE_SHELLS] += region_bytes(&layer->run[k]);
        job->bytes[ISO_STAGE_FILL] += paths_bytes(&layer->paths);
    }
}

static iso_status report_stages(iso_job *job, double begun) {
    struct rusage usage;
    report_kernel(job);
    for (int32_t i = 0; job->stack && i < job->plate.objects.count; i++)
        measure_window(job, &job->stack[i].window);
    job->bytes[ISO_STAGE_ORDER] = paths_bytes(&job->piece) + paths_bytes(&job->ordered);
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
    ISO_TRY(crew_new(&job->crew, job->hooks->threads));
    job->report->threads = job->crew.count;
    progress(job, 0, stage_name[ISO_STAGE_READ]);
    ISO_TRY(plate_load(&job->plate, job->report, job->options, input, input_count));
    double read = iso_stage_clock();
    progress(job, 0.1, stage_name[ISO_STAGE_SLICE]);
    ISO_TRY(slice_objects(job));
    job->seconds[ISO_STAGE_READ] = read - begun;
    job->seconds[ISO_STAGE_SLICE] = iso_stage_clock() - read;
    return ISO_OK;
}

static iso_status print_job(iso_job *job, const char *const *input, int32_t input_count,
                            const char *output) {
    ISO_TRY(load(job, input, input_count));
    ISO_TRY(look_at_first_layers(job));
    ISO_TRY(begin_output(job, output));
    ISO_TRY(print_steps(job));
    ISO_TRY(bend_check(&job->bend, true));
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

#include "gcode/writer.h"

#include <math.h>
#include <stddef.h>

#include "base/memory.h"
#include "gcode/cooling.h"
#include "gcode/event.h"
#include "gcode/flavour.h"
#include "gcode/head.h"
#include "gcode/label.h"
#include "gcode/lines.h"
#include "gcode/number.h"
#include "gcode/progress.h"
#include "gcode/text.h"
#include "gcode/work.h"

static const double pi = 3.14159265358979323846;

enum {
    TEXT_SIZE = 64 << 10,
    CLEARANCE = 10000 /* units over what stands, on the way to the next object */
};

struct iso_gcode_writer {
    iso_gcode_options options;
    const iso_flavour_words *words;
    int64_t layers;   /* so far */
    double clock;     /* s at full speed; the planner's own lags behind by its window */
    double next_mark; /* of the progress, by that clock */
    int32_t highest;  /* units: top of the highest layer so far */
    int32_t object;   /* that labels say is being printed; -1 none */
    int32_t tool;     /* in use */
    int awaited;      /* tools that needn't be waited for to be hot, as bits */
    double tool_mm[ISO_TOOLS_MOST];
    iso_gcode_place place;
    iso_progress progress;
    iso_events events;
    double *length; /* [length_capacity] units: of each segment of the layer */
    int64_t length_capacity;
    char *text; /* [TEXT_SIZE] if there is one to be asked for */
    iso_head head;
    iso_lines lines;
};

/* A line to be filled in when the whole time is known. */
static iso_status mark_progress(iso_gcode_writer *w) {
    if (!w->options.remaining_times || !w->words->progress)
        return ISO_OK;
    char *p = iso_lines_reserve(&w->lines);
    int64_t offset = iso_lines_offset(&w->lines);
    ISO_TRY(iso_progress_mark(&w->progress, offset, iso_planner_elapsed(&w->head.planner)));
    iso_lines_accept(&w->lines, iso_progress_put_line(p, 0, 0));
    w->next_mark = w->clock + ISO_PROGRESS_INTERVAL;
    return ISO_OK;
}

/* What is drawn around objects belongs to none. */
static void label_object(iso_gcode_writer *w, int32_t object) {
    if (object == w->object)
        return;
    iso_labels_end(&w->lines, &w->options, w->object);
    iso_labels_begin(&w->lines, &w->options, object);
    w->object = object;
}

static iso_status check_layer(const iso_gcode_writer *w, const iso_gcode_layer_info *layer) {
    const iso_paths *paths = layer->paths;
    if (w->head.machine && ((paths->vertex_count > 0 && !layer->pose) ||
                            (paths->travel_count > 0 && !layer->travel_pose)))
        return iso_fail(ISO_BUG, "layer %d: the machine turns the part, and nobody says how",
                        layer->index);
    for (int32_t i = 0; i < paths->count; i++)
        if (paths->path[i].role >= ISO_ROLE_COUNT)
            return iso_fail(ISO_BUG, "layer %d, path %d: there is no role %d", layer->index, i,
                            paths->path[i].role);
    for (int32_t i = 0; i < paths->count; i++)
        if (paths->path[i].tool > 0 && paths->path[i].tool >= w->options.tools)
            return iso_fail(ISO_BUG, "layer %d, path %d: there is no tool %d", layer->index, i,
                            paths->path[i].tool);
    for (int32_t v = 0; v < paths->vertex_count; v++)
        if ((uint32_t)paths->vertex[v].role >= ISO_ROLE_COUNT)
            return iso_fail(ISO_BUG, "layer %d, vertex %d: there is no role %d", layer->index, v,
                            paths->vertex[v].role);
    return ISO_OK;
}

/* Text of the user's: whole lines, as they are. */
static iso_status put_user_text(iso_gcode_writer *w, const char *text) {
    static const char *const moving[] = {"G0", "G1", "G2", "G3", "G28"};
    if (!text || !*text)
        return ISO_OK;
    iso_head_end_inverse_time(&w->head);
    ISO_TRY(iso_lines_flush(&w->lines));
    size_t size = strlen(text);
    ISO_TRY(iso_output_write(w->lines.output, text, size));
    w->head.feed = ISO_HEAD_UNKNOWN;
    for (size_t i = 0; i < sizeof moving / sizeof *moving; i++)
        if (iso_text_has_command(text, moving[i]))
            iso_head_forget_place(&w->head);
    return text[size - 1] == '\n' ? ISO_OK : iso_output_write(w->lines.output, "\n", 1);
}

/* "" if there is none. */
static iso_status ask_text(iso_gcode_writer *w, iso_gcode_text_kind kind) {
    const iso_gcode_options *o = &w->options;
    if (!o->text)
        return ISO_OK; /* empty from the beginning */
    return o->text(w->text, TEXT_SIZE, o->text_payload, kind, &w->place);
}

static iso_status put_text(iso_gcode_writer *w, iso_gcode_text_kind kind) {
    ISO_TRY(ask_text(w, kind));
    return put_user_text(w, w->text);
}

/* The layer's own, once the nozzle is at its height. */
static iso_status put_layer_text(iso_gcode_writer *w) {
    ISO_TRY(ask_text(w, ISO_TEXT_LAYER));
    if (*w->text)
        iso_head_reach_layer(&w->head);
    return put_user_text(w, w->text);
}

static void put_line(iso_gcode_writer *w, const char *text) {
    char *p = iso_put_text(iso_lines_reserve(&w->lines), text);
    iso_lines_accept(&w->lines, iso_put_newline(p));
}

/* Filament that the tool in use took since the last change. */
static void count_filament(iso_gcode_writer *w) {
    double others = 0;
    for (int32_t i = 0; i < ISO_TOOLS_MOST; i++)
        others += i == w->tool ? 0 : w->tool_mm[i];
    w->tool_mm[w->tool] = iso_head_filament(&w->head) - others;
}

/* The filament is drawn back, and nothing of it counts as any object. The user's text may take the
 * tool by itself. */
static iso_status change_tool(iso_gcode_writer *w, int32_t tool) {
    char command[32];
    *iso_flavour_put_tool(command, w->words, tool) = '\0';
    label_object(w, -1);
    iso_head_retract(&w->head);
    count_filament(w);
    if (!(w->awaited >> tool & 1) && w->head.modes.nozzle > 0)
        iso_modes_heat_tool(&w->head.modes, tool, w->head.modes.nozzle, 1);
    w->awaited |= 1 << tool;
    w->place.tool = w->tool;
    w->place.next_tool = tool;
    w->place.tool_changes++;
    ISO_TRY(put_text(w, ISO_TEXT_TOOLCHANGE));
    if (!iso_text_has_command(w->text, command))
        put_line(w, command);
    iso_head_take_tool(&w->head, w->tool, tool);
    w->tool = tool;
    return ISO_OK;
}

static iso_status draw_path(iso_gcode_writer *w, const iso_paths *paths, const iso_path *path,
                            const iso_layer_pace *pace) {
    if (path->count < 2)
        return ISO_OK;
    if (w->clock > w->next_mark)
        ISO_TRY(mark_progress(w));
    if (path->tool != w->tool)
        ISO_TRY(change_tool(w, path->tool));
    label_object(w, path->role == ISO_ROLE_SKIRT ? -1 : path->object);
    double drawn_before = w->head.bead_mm;
    ISO_TRY(iso_head_draw(&w->head, paths, path, w->length + path->first, pace));
    w->clock += (w->head.bead_mm - drawn_before) * 60 /
                pace->feed[iso_speed_slot(path->role, path->speed_class)];
    return w->head.watched;
}

static iso_status put_event(iso_gcode_writer *w, const iso_event *event) {
    const char *usual = event->kind == ISO_TEXT_PAUSE          ? w->words->pause
                        : event->kind == ISO_TEXT_COLOR_CHANGE ? w->words->color_change
                                                               : NULL;
    put_line(w, event->kind == ISO_TEXT_PAUSE          ? ";PAUSE_PRINT"
                : event->kind == ISO_TEXT_COLOR_CHANGE ? ";COLOR_CHANGE,T0"
                                                       : ";CUSTOM_GCODE");
    if (event->kind == ISO_TEXT_EVENT) {
        w->place.event = event->text;
        return w->options.text ? put_text(w, ISO_TEXT_EVENT) : put_user_text(w, event->text);
    }
    if (event->kind == ISO_TEXT_PAUSE && event->text) {
        iso_lines_accept(&w->lines, ISO_PUT(iso_lines_reserve(&w->lines), "M117 "));
        ISO_TRY(put_user_text(w, event->text));
    }
    ISO_TRY(ask_text(w, event->kind));
    return put_user_text(w, *w->text ? w->text : usual);
}

static iso_status put_events(iso_gcode_writer *w) {
    const iso_event *event;
    while ((event = iso_events_take(&w->events, w->place.z)) != NULL)
        ISO_TRY(put_event(w, event));
    return ISO_OK;
}

static iso_status begin_layer(iso_gcode_writer *w, const iso_gcode_layer_info *layer) {
    int32_t top = layer->z - iso_units(w->options.z_offset);
    char *p = ISO_PUT(iso_lines_reserve(&w->lines), ";LAYER_CHANGE\n;Z:");
    p = iso_put_decimal(p, top, 4);
    p = ISO_PUT(p, "\n;HEIGHT:");
    p = iso_put_decimal(p, layer->height, 4);
    iso_lines_accept(&w->lines, iso_put_newline(p));
    w->highest = layer->z > w->highest ? layer->z : w->highest;
    w->place.layer = layer->index;
    w->place.z = iso_mm(top);
    w->place.max_z = iso_mm(w->highest - iso_units(w->options.z_offset));
    if (w->options.retract_layer_change && w->layers > 0)
        iso_head_retract(&w->head);
    ISO_TRY(put_text(w, ISO_TEXT_BEFORE_LAYER));
    if (w->words->reset_e)
        put_line(w, w->words->reset_e);
    int space = layer->paths->frame != NULL || w->head.machine != NULL;
    iso_head_begin_layer(&w->head, layer->z, layer->height, space);
    w->head.pose = layer->pose;
    w->head.travel_pose = layer->travel_pose;
    w->head.arc = layer->arc;
    w->head.arc_end = layer->arc + layer->arc_count;
    return put_layer_text(w);
}

/* The first layer's temperatures end with it; the next object's begin with its own. */
static void change_temperatures(iso_gcode_writer *w, int32_t layer) {
    const iso_gcode_options *o = &w->options;
    iso_modes *modes = &w->head.modes;
    if (layer > 1 || w->layers == 0)
        return;
    iso_modes_heat_nozzle(modes, layer == 0 ? o->first_layer_temperature : o->temperature, 0);
    iso_modes_heat_bed(modes, layer == 0 ? o->first_layer_bed_temperature : o->bed_temperature, 0);
}

iso_status iso_gcode_layer(iso_gcode_writer *w, const iso_gcode_layer_info *layer) {
    ISO_TRY(check_layer(w, layer));
    ISO_TRY(ISO_GROW(w->length, w->length_capacity, layer->paths->vertex_count));
    iso_layer_work work;
    iso_layer_pace pace;
    iso_cooling_begin(&pace, &w->options, layer->index);
    iso_work_measure(&work, w->length, layer->paths, &pace, &w->head);
    iso_cooling_pace(&pace, &work, &w->options, layer->index);
    ISO_TRY(begin_layer(w, layer));
    ISO_TRY(mark_progress(w));
    change_temperatures(w, layer->index);
    ISO_TRY(put_events(w));
    if (w->layers++ == 1)
        iso_planner_set_mark(&w->head.planner);
    for (int32_t i = 0; i < layer->paths->count; i++)
        ISO_TRY(draw_path(w, layer->paths, &layer->paths->path[i], &pace));
    label_object(w, -1);
    return iso_output_write(w->lines.output, "", 0);
}

iso_status iso_gcode_next_object(iso_gcode_writer *w, int32_t object) {
    w->place.object = object;
    w->events.next = w->events.count; /* they came with the first object */
    iso_head_rise_above(&w->head, w->highest + CLEARANCE + w->head.lift);
    ISO_TRY(w->head.watched);
    iso_modes_set_fan(&w->head.modes, 0);
    return put_text(w, ISO_TEXT_BETWEEN_OBJECTS);
}

static iso_status writer_start(iso_gcode_writer *w, iso_output *output) {
    const iso_gcode_options *o = &w->options;
    w->words = iso_flavour_get_words(o->flavour);
    w->object = -1;
    w->place = (iso_gcode_place){.layer = -1, .object = 0};
    iso_lines_start(&w->lines, output);
    iso_head_start(&w->head, &w->lines, o);
    ISO_TRY(iso_flavour_check_machine(o));
    ISO_TRY(iso_labels_check(o));
    ISO_TRY(iso_events_new(&w->events, o));
    ISO_TRY(ISO_ALLOCATE(w->text, o->text ? TEXT_SIZE : 1));
    w->text[0] = '\0';
    return ISO_OK;
}

iso_status iso_gcode_writer_new(iso_gcode_writer **writer, iso_output *output,
                                const iso_gcode_options *options) {
    *writer = NULL;
    if (!(options->filament_diameter > 0))
        return iso_fail(ISO_BAD_CONFIG, "filament_diameter: must be greater than 0");
    if (options->tools > ISO_TOOLS_MOST)
        return iso_fail(ISO_BUG, "%d tools: there are %d at most", options->tools,
                        (int)ISO_TOOLS_MOST);
    iso_gcode_writer *w = iso_allocate(sizeof *w);
    if (!w)
        return iso_no_memory(sizeof *w);
    memset(w, 0, offsetof(iso_gcode_writer, head));
    w->options = *options;
    iso_status status = writer_start(w, output);
    if (status != ISO_OK) {
        iso_gcode_writer_free(w);
        return status;
    }
    *writer = w;
    return ISO_OK;
}

void iso_gcode_writer_free(iso_gcode_writer *w) {
    if (!w)
        return;
    iso_progress_free(&w->progress);
    iso_release(w->length);
    iso_release(w->text);
    iso_events_free(&w->events);
    iso_release(w);
}

/* Does the text heat the nozzle, or the bed, by itself? */
static int heats_nozzle(const iso_gcode_writer *w, const char *text) {
    return iso_text_has_command(text, "M104") || iso_text_has_command(text, "M109") ||
           (w->options.flavour == ISO_FLAVOUR_REPRAPFIRMWARE && iso_text_has_command(text, "G10"));
}

static int heats_bed(const char *text) {
    return iso_text_has_command(text, "M140") || iso_text_has_command(text, "M190");
}

/* Does a line that begins with the command have the word as well? */
static int heats_tool(const char *text, const char *command, char letter, int32_t tool) {
    const char word[] = {' ', letter, (char)('0' + tool), '\0'};
    for (const char *line = text; *line; line += *line == '\n') {
        size_t size = strcspn(line, "\n");
        const char *found = strstr(line, word);
        if (strncmp(line, command, strlen(command)) == 0 && found && found < line + size)
            return 1;
        line += size;
    }
    return 0;
}

/* A start text may heat the first nozzle alone: then the others are heated here, and waited for
 * where they are first used. */
static void heat_others(iso_gcode_writer *w, const char *start) {
    w->awaited = 1;
    for (int32_t tool = 1; tool < w->options.tools; tool++)
        if (!heats_nozzle(w, start) || heats_tool(start, "M104", 'T', tool) ||
            heats_tool(start, "M109", 'T', tool) || heats_tool(start, "G10", 'P', tool))
            w->awaited |= 1 << tool;
        else if (w->options.first_layer_temperature > 0)
            iso_modes_heat_tool(&w->head.modes, tool, w->options.first_layer_temperature, 0);
}

/* What holds from the start text on. */
static iso_status put_ways(iso_gcode_writer *w) {
    char *p = iso_put_text(iso_lines_reserve(&w->lines), w->words->units);
    iso_lines_accept(&w->lines, p);
    const char *way = w->head.relative_e ? w->words->relative_e : w->words->absolute_e;
    if (way)
        put_line(w, way);
    if (w->options.use_volumetric_e && w->words->volumetric) {
        int64_t diameter = (int64_t)(w->options.filament_diameter * 1000 + 0.5);
        p = iso_flavour_put(iso_lines_reserve(&w->lines), w->words->volumetric, diameter, 3);
        iso_lines_accept(&w->lines, iso_put_newline(p));
    }
    if (w->options.tools > 1)
        iso_lines_accept(&w->lines, iso_put_newline(iso_flavour_put_tool(
                                        iso_lines_reserve(&w->lines), w->words, 0)));
    return put_text(w, ISO_TEXT_START_FILAMENT);
}

/* The start text: the one given, or the one asked for. */
static iso_status start_text(const char **text, iso_gcode_writer *w) {
    *text = w->options.start_gcode;
    if (*text)
        return ISO_OK;
    *text = w->text;
    return ask_text(w, ISO_TEXT_START);
}

iso_status iso_gcode_begin(iso_gcode_writer *w) {
    const iso_gcode_options *o = &w->options;
    const char *start;
    char date[ISO_DATE_SIZE];
    ISO_TRY(start_text(&start, w));
    iso_text_date(date, o->timestamp);
    ISO_TRY(iso_output_print(w->lines.output, "; generated by %s on %s\n\n",
                             o->generator ? o->generator : "isoslice", date));
    iso_labels_define(&w->lines, o);
    if (o->emit_machine_limits)
        iso_modes_say_limits(&w->head.modes, &o->limits);
    iso_modes_set_fan(&w->head.modes, 0);
    if (!heats_bed(start))
        iso_modes_heat_bed(&w->head.modes, o->first_layer_bed_temperature, 1);
    if (!heats_nozzle(w, start))
        iso_modes_heat_nozzle(&w->head.modes, o->first_layer_temperature, 0);
    ISO_TRY(mark_progress(w));
    put_line(w, ";TYPE:Custom");
    ISO_TRY(put_user_text(w, start));
    if (!heats_nozzle(w, start))
        iso_modes_heat_nozzle(&w->head.modes, o->first_layer_temperature, 1);
    heat_others(w, start);
    w->head.modes.nozzle = o->first_layer_temperature;
    w->head.modes.bed = o->first_layer_bed_temperature;
    ISO_TRY(put_ways(w));
    return iso_lines_flush(&w->lines);
}

static void sum_up(iso_gcode_totals *totals, iso_gcode_writer *w) {
    iso_planner_stop(&w->head.planner);
    double section = pi / 4 * w->options.filament_diameter * w->options.filament_diameter;
    double mm = iso_head_filament(&w->head);
    count_filament(w);
    *totals = (iso_gcode_totals){.filament_mm = mm,
                                 .filament_cm3 = mm * section / 1000,
                                 .filament_g = mm * section / 1000 * w->options.filament_density,
                                 .filament_cost = mm * section / 1e6 * w->options.filament_density *
                                                  w->options.filament_cost,
                                 .time = w->head.planner.time,
                                 .first_layer_time = w->layers > 1 ? w->head.planner.mark_time
                                                                   : w->head.planner.time,
                                 .idle_time = w->head.planner.idle_time,
                                 .bead_mm = w->head.bead_mm,
                                 .travel_mm = w->head.travel_mm,
                                 .moves = w->head.moves,
                                 .retractions = w->head.retractions,
                                 .layers = w->layers,
                                 .tool_changes = w->place.tool_changes};
    memcpy(totals->tool_mm, w->tool_mm, sizeof totals->tool_mm);
}

static void put_figure(iso_gcode_writer *w, const char *name, double value) {
    char *p = ISO_PUT(iso_lines_reserve(&w->lines), "; ");
    p = ISO_PUT(iso_put_text(p, name), " = ");
    p = iso_put_decimal(p, (int64_t)(value * 100 + 0.5), 2);
    iso_lines_accept(&w->lines, iso_put_newline(p));
}

static void put_time(iso_gcode_writer *w, const char *name, double seconds) {
    char *p = ISO_PUT(iso_lines_reserve(&w->lines), "; ");
    p = ISO_PUT(iso_put_text(p, name), " (normal mode) = ");
    p = iso_text_put_duration(p, (int64_t)seconds);
    iso_lines_accept(&w->lines, iso_put_newline(p));
}

/* What all tools take, or each of several. */
static void put_filament(iso_gcode_writer *w, const char *name, double value, double mm) {
    if (w->options.tools < 2) {
        put_figure(w, name, value);
        return;
    }
    char *p = ISO_PUT(iso_lines_reserve(&w->lines), "; ");
    p = ISO_PUT(iso_put_text(p, name), " = ");
    for (int32_t tool = 0; tool < w->options.tools; tool++) {
        double own = mm > 0 ? value * w->tool_mm[tool] / mm : 0;
        p = tool > 0 ? ISO_PUT(p, ", ") : p;
        p = iso_put_decimal(p, (int64_t)(own * 100 + 0.5), 2);
    }
    iso_lines_accept(&w->lines, iso_put_newline(p));
}

static void put_figures(iso_gcode_writer *w, const iso_gcode_totals *sum) {
    put_filament(w, "filament used [mm]", sum->filament_mm, sum->filament_mm);
    put_filament(w, "filament used [cm3]", sum->filament_cm3, sum->filament_mm);
    put_filament(w, "filament used [g]", sum->filament_g, sum->filament_mm);
    if (sum->filament_cost > 0)
        put_figure(w, "filament cost", sum->filament_cost);
    put_figure(w, "total filament used [g]", sum->filament_g);
    put_figure(w, "total filament cost", sum->filament_cost);
    put_time(w, "estimated printing time", sum->time);
    put_time(w, "estimated first layer printing time", sum->first_layer_time);
}

/* An end text turns off the nozzle in use. */
static void cool_others(iso_gcode_writer *w) {
    for (int32_t tool = 0; tool < w->options.tools; tool++)
        if (tool != w->tool && w->head.modes.nozzle > 0)
            iso_modes_heat_tool(&w->head.modes, tool, 0, 0);
}

iso_status iso_gcode_finish(iso_gcode_totals *totals, iso_gcode_writer *w,
                            iso_gcode_config_lines *config, void *payload) {
    iso_gcode_totals sum;
    iso_head_retract(&w->head);
    ISO_TRY(w->head.watched);
    iso_head_end_inverse_time(&w->head);
    iso_modes_set_fan(&w->head.modes, 0);
    sum_up(&sum, w);
    put_line(w, ";TYPE:Custom");
    if (w->options.use_volumetric_e)
        iso_modes_say(&w->head.modes, w->words->volumetric, 0, "E in mm again");
    cool_others(w);
    ISO_TRY(put_text(w, ISO_TEXT_END_FILAMENT));
    if (w->options.end_gcode)
        ISO_TRY(put_user_text(w, w->options.end_gcode));
    else
        ISO_TRY(put_text(w, ISO_TEXT_END));
    if (w->options.remaining_times && w->words->progress)
        iso_lines_accept(&w->lines, iso_progress_put_line(iso_lines_reserve(&w->lines), 100, 0));
    put_figures(w, &sum);
    ISO_TRY(iso_lines_flush(&w->lines));
    if (config) {
        ISO_TRY(iso_output_print(w->lines.output, "\n; prusaslicer_config = begin\n"));
        ISO_TRY(config(w->lines.output, payload));
        ISO_TRY(iso_output_print(w->lines.output, "; prusaslicer_config = end\n"));
    }
    ISO_TRY(iso_progress_fill_in(w->lines.output, &w->progress, sum.time));
    sum.bytes = iso_output_size(w->lines.output);
    *totals = sum;
    return ISO_OK;
}

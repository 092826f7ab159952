#include "gcode/writer.h"

#include <math.h>
#include <stddef.h>

#include "base/memory.h"
#include "gcode/cooling.h"
#include "gcode/flavour.h"
#include "gcode/head.h"
#include "gcode/lines.h"
#include "gcode/number.h"
#include "gcode/progress.h"
#include "gcode/text.h"

static const double pi = 3.14159265358979323846;

enum { LAYER_TEXT_SIZE = 64 << 10 };

struct iso_gcode_writer {
    iso_gcode_options options;
    const iso_flavour_words *words;
    int fan;          /* percent last said */
    int64_t layers;   /* so far */
    double clock;     /* s at full speed; the planner's own lags behind by its window */
    double next_mark; /* of the progress, by that clock */
    iso_progress progress;
    double *length; /* [length_capacity] units: of each segment of the layer */
    int64_t length_capacity;
    char *layer_text; /* [LAYER_TEXT_SIZE] if there is one */
    iso_head head;
    iso_lines lines;
};

static void set_fan(iso_gcode_writer *w, int percent) {
    if (percent == w->fan)
        return;
    w->fan = percent;
    char *p =
        iso_put_text(iso_lines_reserve(&w->lines), percent > 0 ? w->words->fan : w->words->fan_off);
    if (percent > 0)
        p = iso_put_integer(p, (255 * percent + 50) / 100);
    iso_lines_accept(&w->lines, iso_put_newline(p));
}

static void say(iso_gcode_writer *w, const char *command, int value) {
    char *p = iso_put_integer(iso_put_text(iso_lines_reserve(&w->lines), command), value);
    iso_lines_accept(&w->lines, iso_put_newline(p));
}

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

static iso_status draw_path(iso_gcode_writer *w, const iso_paths *paths, const iso_path *path,
                            const iso_layer_pace *pace) {
    if (path->count < 2)
        return ISO_OK;
    if (w->clock > w->next_mark)
        ISO_TRY(mark_progress(w));
    set_fan(w, pace->fan);
    double drawn_before = w->head.bead_mm;
    iso_head_draw(&w->head, paths, path, w->length + path->first, pace);
    w->clock += (w->head.bead_mm - drawn_before) * 60 /
                pace->feed[iso_speed_slot(path->role, path->speed_class)];
    return ISO_OK;
}

static double length_between(const iso_path_vertex *a, const iso_path_vertex *b) {
    double dx = (double)b->at.x - a->at.x, dy = (double)b->at.y - a->at.y;
    double dz = (double)b->z - a->z;
    return sqrt(dx * dx + dy * dy + dz * dz); /* of an integer below 2^53: rounded once */
}

/* From `end` by way of the points where the travel turns. */
static double length_of_travel(const iso_paths *paths, const iso_path *path,
                               const iso_path_vertex *end) {
    iso_path_vertex at = *end;
    double sum = 0;
    for (int32_t i = 0; i < path->travel_count; i++) {
        iso_path_vertex turn = at;
        turn.at = paths->travel[path->travel_first + i];
        sum += length_between(&at, &turn);
        at = turn;
    }
    return sum + length_between(&at, &paths->vertex[path->first]);
}

/* Every segment's length, and what the layer asks for by speed. */
static void measure(iso_layer_work *work, iso_gcode_writer *w, const iso_paths *paths) {
    const iso_path_vertex *end = NULL;
    double travel_units = 0;
    int32_t retractions = 0;
    *work = (iso_layer_work){0};
    for (int32_t i = 0; i < paths->count; i++) {
        const iso_path *path = &paths->path[i];
        const iso_path_vertex *vertex = paths->vertex + path->first;
        double *length = w->length + path->first;
        if (path->count < 2)
            continue;
        int32_t last = path->count - 1;
        for (int32_t k = 0; k < last; k++)
            length[k] = length_between(&vertex[k], &vertex[k + 1]);
        if (path->closed)
            length[last] = length_between(&vertex[last], &vertex[0]);
        for (int32_t k = 0; k < last + path->closed; k++)
            work->length[iso_speed_slot(vertex[k].role, path->speed_class)] +=
                length[k] / ISO_UNITS_PER_MM;
        if (end) {
            double units = length_of_travel(paths, path, end);
            travel_units += units;
            retractions += path->retract != ISO_RETRACT_NOT &&
                           units > w->options.retract_before_travel * ISO_UNITS_PER_MM;
        }
        end = &vertex[path->closed ? 0 : last];
    }
    work->other_time = travel_units / ISO_UNITS_PER_MM * 60 / w->head.travel_feed +
                       retractions * iso_head_retraction_time(&w->head);
}

static iso_status check_layer(const iso_gcode_layer_info *layer) {
    const iso_paths *paths = layer->paths;
    for (int32_t i = 0; i < paths->count; i++)
        if (paths->path[i].role >= ISO_ROLE_COUNT)
            return iso_fail(ISO_BUG, "layer %d, path %d: there is no role %d", layer->index, i,
                            paths->path[i].role);
    for (int32_t v = 0; v < paths->vertex_count; v++)
        if ((uint32_t)paths->vertex[v].role >= ISO_ROLE_COUNT)
            return iso_fail(ISO_BUG, "layer %d, vertex %d: there is no role %d", layer->index, v,
                            paths->vertex[v].role);
    return ISO_OK;
}

static void begin_layer(iso_gcode_writer *w, const iso_gcode_layer_info *layer) {
    char *p = ISO_PUT(iso_lines_reserve(&w->lines), ";LAYER_CHANGE\n;Z:");
    p = iso_put_decimal(p, layer->z, 4);
    p = ISO_PUT(p, "\n;HEIGHT:");
    p = iso_put_decimal(p, layer->height, 4);
    *p++ = '\n';
    p = iso_put_text(p, w->words->reset_e);
    iso_lines_accept(&w->lines, iso_put_newline(p));
    iso_head_begin_layer(&w->head, layer->z);
}

/* The first layer's temperatures end with it. */
static void change_temperatures(iso_gcode_writer *w) {
    const iso_gcode_options *o = &w->options;
    if (o->temperature > 0 && o->temperature != o->first_layer_temperature)
        say(w, w->words->nozzle, o->temperature);
    if (o->bed_temperature > 0 && o->bed_temperature != o->first_layer_bed_temperature)
        say(w, w->words->bed, o->bed_temperature);
}

/* Text of the user's: whole lines, as they are. */
static iso_status put_user_text(iso_gcode_writer *w, const char *text) {
    if (!text || !*text)
        return ISO_OK;
    ISO_TRY(iso_lines_flush(&w->lines));
    size_t size = strlen(text);
    ISO_TRY(iso_output_write(w->lines.output, text, size));
    w->head.feed = ISO_HEAD_UNKNOWN;
    if (iso_text_has_command(text, "G0") || iso_text_has_command(text, "G1") ||
        iso_text_has_command(text, "G28"))
        iso_head_forget_place(&w->head);
    return text[size - 1] == '\n' ? ISO_OK : iso_output_write(w->lines.output, "\n", 1);
}

static iso_status put_layer_text(iso_gcode_writer *w, const iso_gcode_layer_info *layer) {
    const iso_gcode_options *o = &w->options;
    if (!o->layer_text)
        return ISO_OK;
    ISO_TRY(o->layer_text(w->layer_text, LAYER_TEXT_SIZE, o->layer_payload, layer->index,
                          iso_mm(layer->z)));
    iso_head_reach_layer(&w->head);
    return put_user_text(w, w->layer_text);
}

iso_status iso_gcode_layer(iso_gcode_writer *w, const iso_gcode_layer_info *layer) {
    ISO_TRY(check_layer(layer));
    ISO_TRY(ISO_GROW(w->length, w->length_capacity, layer->paths->vertex_count));
    iso_layer_work work;
    iso_layer_pace pace;
    measure(&work, w, layer->paths);
    iso_cooling_pace(&pace, &work, &w->options, layer->index);
    begin_layer(w, layer);
    ISO_TRY(put_layer_text(w, layer));
    ISO_TRY(mark_progress(w));
    if (w->layers++ == 1)
        change_temperatures(w);
    for (int32_t i = 0; i < layer->paths->count; i++)
        ISO_TRY(draw_path(w, layer->paths, &layer->paths->path[i], &pace));
    return iso_output_write(w->lines.output, "", 0);
}

iso_status iso_gcode_writer_new(iso_gcode_writer **writer, iso_output *output,
                                const iso_gcode_options *options) {
    *writer = NULL;
    if (!(options->filament_diameter > 0))
        return iso_fail(ISO_BAD_CONFIG, "filament_diameter: must be greater than 0");
    iso_gcode_writer *w = iso_allocate(sizeof *w);
    if (!w)
        return iso_no_memory(sizeof *w);
    memset(w, 0, offsetof(iso_gcode_writer, head));
    w->options = *options;
    w->words = iso_flavour_get_words(options->flavour);
    w->fan = -1;
    iso_lines_start(&w->lines, output);
    iso_head_start(&w->head, &w->lines, &w->options);
    if (options->layer_text && !(w->layer_text = iso_allocate(LAYER_TEXT_SIZE))) {
        iso_gcode_writer_free(w);
        return iso_no_memory(LAYER_TEXT_SIZE);
    }
    *writer = w;
    return ISO_OK;
}

void iso_gcode_writer_free(iso_gcode_writer *w) {
    if (!w)
        return;
    iso_progress_free(&w->progress);
    iso_release(w->length);
    iso_release(w->layer_text);
    iso_release(w);
}

iso_status iso_gcode_begin(iso_gcode_writer *w) {
    const iso_gcode_options *o = &w->options;
    const char *start = o->start_gcode ? o->start_gcode : "";
    int bed = o->first_layer_bed_temperature > 0 && !iso_text_has_command(start, "M140") &&
              !iso_text_has_command(start, "M190");
    int nozzle = o->first_layer_temperature > 0 && !iso_text_has_command(start, "M104") &&
                 !iso_text_has_command(start, "M109");
    char date[ISO_DATE_SIZE];
    iso_text_date(date, o->timestamp);
    ISO_TRY(iso_output_print(w->lines.output, "; generated by %s on %s\n\n",
                             o->generator ? o->generator : "isoslice", date));
    set_fan(w, 0);
    if (bed)
        say(w, w->words->bed_wait, o->first_layer_bed_temperature);
    if (nozzle)
        say(w, w->words->nozzle, o->first_layer_temperature);
    ISO_TRY(mark_progress(w));
    iso_lines_accept(&w->lines, ISO_PUT(iso_lines_reserve(&w->lines), ";TYPE:Custom\n"));
    ISO_TRY(put_user_text(w, start));
    if (nozzle)
        say(w, w->words->nozzle_wait, o->first_layer_temperature);
    char *p =
        ISO_PUT(iso_lines_reserve(&w->lines), "G21 ; millimetres\nG90 ; absolute coordinates\n");
    p = iso_put_text(p, o->use_relative_e_distances ? w->words->relative_e : w->words->absolute_e);
    iso_lines_accept(&w->lines, iso_put_newline(p));
    return iso_lines_flush(&w->lines);
}

static void sum_up(iso_gcode_totals *totals, iso_gcode_writer *w) {
    iso_planner_stop(&w->head.planner);
    double section = pi / 4 * w->options.filament_diameter * w->options.filament_diameter;
    double mm = iso_head_filament(&w->head);
    *totals = (iso_gcode_totals){.filament_mm = mm,
                                 .filament_cm3 = mm * section / 1000,
                                 .filament_g = mm * section / 1000 * w->options.filament_density,
                                 .time = w->head.planner.time,
                                 .idle_time = w->head.planner.idle_time,
                                 .bead_mm = w->head.bead_mm,
                                 .travel_mm = w->head.travel_mm,
                                 .moves = w->head.moves,
                                 .retractions = w->head.retractions,
                                 .layers = w->layers};
}

static void put_figure(iso_gcode_writer *w, const char *name, double value) {
    char *p = ISO_PUT(iso_lines_reserve(&w->lines), "; ");
    p = ISO_PUT(iso_put_text(p, name), " = ");
    p = iso_put_decimal(p, (int64_t)(value * 100 + 0.5), 2);
    iso_lines_accept(&w->lines, iso_put_newline(p));
}

iso_status iso_gcode_finish(iso_gcode_totals *totals, iso_gcode_writer *w,
                            iso_gcode_config_lines *config, void *payload) {
    iso_gcode_totals sum;
    iso_head_retract(&w->head);
    set_fan(w, 0);
    sum_up(&sum, w);
    iso_lines_accept(&w->lines, ISO_PUT(iso_lines_reserve(&w->lines), ";TYPE:Custom\n"));
    ISO_TRY(put_user_text(w, w->options.end_gcode));
    if (w->options.remaining_times && w->words->progress)
        iso_lines_accept(&w->lines, iso_progress_put_line(iso_lines_reserve(&w->lines), 100, 0));
    put_figure(w, "filament used [mm]", sum.filament_mm);
    put_figure(w, "filament used [cm3]", sum.filament_cm3);
    put_figure(w, "filament used [g]", sum.filament_g);
    put_figure(w, "total filament used [g]", sum.filament_g);
    char *p = ISO_PUT(iso_lines_reserve(&w->lines), "; estimated printing time (normal mode) = ");
    p = iso_text_put_duration(p, (int64_t)sum.time);
    iso_lines_accept(&w->lines, iso_put_newline(p));
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

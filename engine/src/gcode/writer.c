#include "gcode/writer.h"

#include <math.h>
#include <stddef.h>

#include "base/memory.h"
#include "gcode/cooling.h"
#include "gcode/flavour.h"
#include "gcode/number.h"
#include "gcode/planner.h"
#include "gcode/progress.h"
#include "gcode/text.h"

static const double pi = 3.14159265358979323846;

enum {
    BUFFER_SIZE = 128 << 10, /* beyond iso_output's own buffer, which it then passes by */
    LINES_MAX = 512,         /* bytes that one reserve() holds ready: a few lines */
    E_DECIMALS = 100000,
    UNKNOWN = INT32_MIN
};

/* E is summed up in 2^-28 of its last digit (10 nm): what 10^7 moves round away stays below a tenth
 * of that digit, and 343 km of filament fit an int64. */
#define E_FRACTION 28

struct iso_gcode_writer {
    iso_output *output;
    iso_gcode_options options;
    const iso_flavour_words *words;
    double e_scale; /* E in 2^-E_FRACTION of its last digit for a bead of one unit^3 */
    int32_t travel_feed, travel_feed_z, retract_feed, deretract_feed; /* mm/min */
    int32_t lift;                                                     /* units */
    int64_t retract_e, deretract_e;

    /* where the machine is */
    int32_t x, y;    /* um */
    int32_t z;       /* units */
    int32_t layer_z; /* units */
    int32_t feed;    /* mm/min */
    double speed;    /* mm/s: the same */
    int64_t e;       /* last digits of E since it was reset */
    int retracted, fan;
    int32_t role, width; /* last said in comments */

    int64_t drawn;   /* E to have been extruded by now, with fraction */
    int64_t emitted; /* E that was, in last digits */

    iso_gcode_totals totals;
    iso_planner planner;
    iso_progress progress;
    double clock, next_mark; /* s at full speed, since the window of the planner lags behind */
    double *length;          /* [length_capacity] units: of each segment of the layer */
    int64_t length_capacity;
    size_t used;
    char buffer[BUFFER_SIZE];
};

static int32_t to_feed(double speed) {
    double feed = speed * 60 + 0.5;
    return feed < 1 ? 1 : (int32_t)feed;
}

static int64_t to_e(double mm) {
    return (int64_t)(mm * E_DECIMALS + (mm < 0 ? -0.5 : 0.5));
}

static int32_t to_micrometres(int32_t units) {
    return units < 0 ? (units - 5) / 10 : (units + 5) / 10;
}

static iso_status flush(iso_gcode_writer *w) {
    size_t used = w->used;
    w->used = 0;
    return iso_output_write(w->output, w->buffer, used);
}

/* Where the next lines go: LINES_MAX bytes are free there. A failure to write is kept by the output
 * and comes back at the end of the layer. */
static char *reserve(iso_gcode_writer *w) {
    if (w->used > BUFFER_SIZE - LINES_MAX)
        (void)!flush(w);
    return w->buffer + w->used;
}

static void accept(iso_gcode_writer *w, const char *end) {
    w->used = (size_t)(end - w->buffer);
}

static char *put_text(char *p, const char *text) {
    size_t size = strlen(text);
    memcpy(p, text, size);
    return p + size;
}

#define PUT(p, literal) (memcpy(p, literal, sizeof literal - 1), (p) + sizeof literal - 1)

static char *put_feed(iso_gcode_writer *w, char *p, int32_t feed) {
    if (feed == w->feed)
        return p;
    w->feed = feed;
    w->speed = feed / 60.0;
    p = PUT(p, " F");
    return iso_put_integer(p, feed);
}

/* Move the filament by `delta` last digits. */
static char *put_e(iso_gcode_writer *w, char *p, int64_t delta) {
    w->e += delta;
    p = PUT(p, " E");
    return iso_put_hundred_thousandths(p, w->options.use_relative_e_distances ? delta : w->e);
}

static void plan(iso_gcode_writer *w, double dx, double dy, double dz, int extrudes) {
    iso_planner_move move = {.dx = dx, .dy = dy, .dz = dz, .extrudes = extrudes};
    move.length = sqrt(dx * dx + dy * dy + dz * dz);
    move.speed = w->speed;
    move.acceleration = extrudes ? w->options.acceleration : w->options.travel_acceleration;
    double z_speed = w->options.max_speed_z;
    double rise = dz < 0 ? -dz : dz;
    if (rise > 0 && z_speed > 0 && rise * move.speed > z_speed * move.length)
        move.speed = z_speed * move.length / rise;
    iso_planner_add(&w->planner, &move);
    w->totals.moves++;
    *(extrudes ? &w->totals.bead_mm : &w->totals.travel_mm) += move.length;
}

static void plan_filament(iso_gcode_writer *w, int64_t e) {
    iso_planner_move move = {.length = (double)(e < 0 ? -e : e) / E_DECIMALS,
                             .speed = w->speed,
                             .acceleration = w->options.retract_acceleration};
    iso_planner_add(&w->planner, &move);
    w->totals.moves++;
}

static void set_fan(iso_gcode_writer *w, int percent) {
    if (percent == w->fan)
        return;
    w->fan = percent;
    char *p = put_text(reserve(w), percent > 0 ? w->words->fan : w->words->fan_off);
    if (percent > 0)
        p = iso_put_integer(p, (255 * percent + 50) / 100);
    *p++ = '\n';
    accept(w, p);
}

static void say(iso_gcode_writer *w, const char *command, int value) {
    char *p = iso_put_integer(put_text(reserve(w), command), value);
    *p++ = '\n';
    accept(w, p);
}

static void move_filament(iso_gcode_writer *w, int64_t e, int32_t feed) {
    char *p = PUT(reserve(w), "G1");
    p = put_e(w, p, e);
    p = put_feed(w, p, feed);
    *p++ = '\n';
    accept(w, p);
    plan_filament(w, e);
}

static void retract(iso_gcode_writer *w) {
    if (w->retracted || w->retract_e == 0)
        return;
    w->retracted = 1;
    w->totals.retractions++;
    move_filament(w, -w->retract_e, w->retract_feed);
}

static void deretract(iso_gcode_writer *w) {
    if (!w->retracted)
        return;
    w->retracted = 0;
    move_filament(w, w->deretract_e, w->deretract_feed);
}

static void move_z(iso_gcode_writer *w, int32_t z) {
    if (z == w->z)
        return;
    char *p = PUT(reserve(w), "G1 Z");
    p = iso_put_thousandths(p, to_micrometres(z));
    p = put_feed(w, p, w->travel_feed_z);
    *p++ = '\n';
    accept(w, p);
    if (w->z != UNKNOWN)
        plan(w, 0, 0, iso_mm(z - w->z), 0);
    w->z = z;
}

static double mm_between(const iso_gcode_writer *w, int32_t x, int32_t y) {
    double dx = (double)x - w->x, dy = (double)y - w->y;
    return sqrt(dx * dx + dy * dy) / 1000;
}

/* To the beginning of a path, filament ready. */
static void travel(iso_gcode_writer *w, iso_point to, int32_t z) {
    int32_t x = to_micrometres(to.x), y = to_micrometres(to.y);
    int known = w->x != UNKNOWN, away = x != w->x || y != w->y;
    if (!known || (away && mm_between(w, x, y) > w->options.retract_before_travel))
        retract(w);
    if (away) {
        int32_t low = z > w->layer_z ? z : w->layer_z;
        move_z(w, w->retracted ? low + w->lift : low);
        char *p = PUT(reserve(w), "G1 X");
        p = iso_put_thousandths(p, x);
        p = PUT(p, " Y");
        p = iso_put_thousandths(p, y);
        p = put_feed(w, p, w->travel_feed);
        *p++ = '\n';
        accept(w, p);
        if (known)
            plan(w, (x - w->x) / 1000.0, (y - w->y) / 1000.0, 0, 0);
        w->x = x;
        w->y = y;
    }
    move_z(w, z);
    deretract(w);
}

static char *put_width(iso_gcode_writer *w, char *p, int32_t width) {
    w->width = width;
    p = iso_put_decimal(PUT(p, ";WIDTH:"), width, 4);
    *p++ = '\n';
    return p;
}

/* From where the machine is to `to`, leaving a bead of `length` units and section `area`. A segment
 * that vanishes in the rounding hands its material to the next one. */
static void draw(iso_gcode_writer *w, const iso_path_vertex *from, iso_point to, int32_t z,
                 double length, int32_t feed) {
    w->drawn += (int64_t)(length * from->area * w->e_scale + 0.5);
    int32_t x = to_micrometres(to.x), y = to_micrometres(to.y);
    if (x == w->x && y == w->y && z == w->z)
        return;
    char *p = reserve(w);
    if (from->width != w->width)
        p = put_width(w, p, from->width);
    p = PUT(p, "G1 X");
    p = iso_put_thousandths(p, x);
    p = PUT(p, " Y");
    p = iso_put_thousandths(p, y);
    if (z != w->z) {
        p = PUT(p, " Z");
        p = iso_put_thousandths(p, to_micrometres(z));
    }
    int64_t e = (w->drawn + ((int64_t)1 << (E_FRACTION - 1))) >> E_FRACTION;
    if (e != w->emitted)
        p = put_e(w, p, e - w->emitted);
    w->emitted = e;
    p = put_feed(w, p, feed);
    *p++ = '\n';
    accept(w, p);
    plan(w, (x - w->x) / 1000.0, (y - w->y) / 1000.0, iso_mm(z - w->z), 1);
    w->x = x;
    w->y = y;
    w->z = z;
}

/* A line to be filled in when the whole time is known. */
static iso_status mark_progress(iso_gcode_writer *w) {
    if (!w->options.remaining_times || !w->words->progress)
        return ISO_OK;
    char *p = reserve(w);
    int64_t offset = iso_output_size(w->output) + (int64_t)w->used;
    ISO_TRY(iso_progress_mark(&w->progress, offset, iso_planner_elapsed(&w->planner)));
    accept(w, iso_progress_put_line(p, 0, 0));
    w->next_mark = w->clock + ISO_PROGRESS_INTERVAL;
    return ISO_OK;
}

static iso_status draw_path(iso_gcode_writer *w, const iso_paths *paths, const iso_path *path,
                            const iso_layer_pace *pace) {
    const iso_path_vertex *vertex = paths->vertex + path->first;
    const double *length = w->length + path->first;
    int32_t segments = path->closed ? path->count : path->count - 1;
    if (path->count < 2)
        return ISO_OK;
    if (w->clock > w->next_mark)
        ISO_TRY(mark_progress(w));
    int bridge = path->role == ISO_ROLE_BRIDGE_INFILL || path->role == ISO_ROLE_OVERHANG_PERIMETER;
    set_fan(w, bridge ? pace->bridge_fan : pace->fan);
    travel(w, vertex[0].at, w->layer_z + vertex[0].z);
    if (path->role != w->role) {
        char *p = put_text(PUT(reserve(w), ";TYPE:"), iso_role_name(path->role));
        *p++ = '\n';
        accept(w, p);
        w->role = path->role;
    }
    int32_t feed = pace->feed[iso_speed_slot(path->role, path->speed_class)];
    double drawn_before = w->totals.bead_mm;
    for (int32_t i = 0; i < segments; i++) {
        const iso_path_vertex *to = &vertex[i + 1 < path->count ? i + 1 : 0];
        draw(w, &vertex[i], to->at, w->layer_z + to->z, length[i], feed);
    }
    w->clock += (w->totals.bead_mm - drawn_before) * 60 / feed;
    return ISO_OK;
}

static double length_between(const iso_path_vertex *a, const iso_path_vertex *b) {
    double dx = (double)b->at.x - a->at.x, dy = (double)b->at.y - a->at.y;
    double dz = (double)b->z - a->z;
    return sqrt(dx * dx + dy * dy + dz * dz); /* of an integer below 2^53: rounded once */
}

/* Every segment's length, and what the layer asks for by speed. */
static void measure(iso_layer_work *work, iso_gcode_writer *w, const iso_paths *paths) {
    const iso_path_vertex *end = NULL;
    double travel_units = 0;
    *work = (iso_layer_work){0};
    for (int32_t i = 0; i < paths->count; i++) {
        const iso_path *path = &paths->path[i];
        const iso_path_vertex *vertex = paths->vertex + path->first;
        double *length = w->length + path->first, sum = 0;
        if (path->count < 2)
            continue;
        for (int32_t k = 0; k + 1 < path->count; k++)
            sum += length[k] = length_between(&vertex[k], &vertex[k + 1]);
        int32_t last = path->count - 1;
        if (path->closed)
            sum += length[last] = length_between(&vertex[last], &vertex[0]);
        if (end)
            travel_units += length_between(end, &vertex[0]);
        end = &vertex[path->closed ? 0 : last];
        work->length[iso_speed_slot(path->role, path->speed_class)] += sum / ISO_UNITS_PER_MM;
    }
    work->other_time = travel_units / ISO_UNITS_PER_MM * 60 / w->travel_feed;
}

static iso_status check_layer(const iso_gcode_layer_info *layer) {
    const iso_paths *paths = layer->paths;
    for (int32_t i = 0; i < paths->count; i++)
        if (paths->path[i].role >= ISO_ROLE_COUNT)
            return iso_fail(ISO_BUG, "layer %d, path %d: there is no role %d", layer->index, i,
                            paths->path[i].role);
    return ISO_OK;
}

static void begin_layer(iso_gcode_writer *w, const iso_gcode_layer_info *layer) {
    char *p = PUT(reserve(w), ";LAYER_CHANGE\n;Z:");
    p = iso_put_decimal(p, layer->z, 4);
    p = PUT(p, "\n;HEIGHT:");
    p = iso_put_decimal(p, layer->height, 4);
    *p++ = '\n';
    p = put_text(p, w->words->reset_e);
    *p++ = '\n';
    accept(w, p);
    w->e = 0;
    w->layer_z = layer->z;
    w->role = w->width = UNKNOWN;
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
    ISO_TRY(flush(w));
    size_t size = strlen(text);
    ISO_TRY(iso_output_write(w->output, text, size));
    w->feed = UNKNOWN;
    return text[size - 1] == '\n' ? ISO_OK : iso_output_write(w->output, "\n", 1);
}

iso_status iso_gcode_layer(iso_gcode_writer *w, const iso_gcode_layer_info *layer) {
    ISO_TRY(check_layer(layer));
    ISO_TRY(ISO_GROW(w->length, w->length_capacity, layer->paths->vertex_count));
    iso_layer_work work;
    iso_layer_pace pace;
    measure(&work, w, layer->paths);
    iso_cooling_pace(&pace, &work, &w->options, layer->index);
    begin_layer(w, layer);
    ISO_TRY(put_user_text(w, w->options.layer_gcode));
    ISO_TRY(mark_progress(w));
    if (w->totals.layers++ == 1)
        change_temperatures(w);
    for (int32_t i = 0; i < layer->paths->count; i++)
        ISO_TRY(draw_path(w, layer->paths, &layer->paths->path[i], &pace));
    return iso_output_write(w->output, "", 0);
}

iso_status iso_gcode_writer_new(iso_gcode_writer **writer, iso_output *output,
                                const iso_gcode_options *options) {
    *writer = NULL;
    if (!(options->filament_diameter > 0))
        return iso_fail(ISO_BAD_CONFIG, "filament_diameter: must be greater than 0");
    iso_gcode_writer *w = iso_allocate(sizeof *w);
    if (!w)
        return iso_no_memory(sizeof *w);
    memset(w, 0, offsetof(iso_gcode_writer, planner));
    w->output = output;
    w->options = *options;
    w->words = iso_flavour_get_words(options->flavour);
    double section = pi / 4 * options->filament_diameter * options->filament_diameter;
    double unit = 1.0 / ISO_UNITS_PER_MM;
    w->e_scale = options->extrusion_multiplier * unit * unit * unit / section * E_DECIMALS *
                 (double)((int64_t)1 << E_FRACTION);
    w->travel_feed = to_feed(options->travel_speed);
    w->travel_feed_z =
        to_feed(options->travel_speed_z > 0 ? options->travel_speed_z : options->travel_speed);
    w->retract_feed = to_feed(options->retract_speed);
    w->deretract_feed =
        to_feed(options->deretract_speed > 0 ? options->deretract_speed : options->retract_speed);
    w->retract_e = to_e(options->retract_length);
    w->deretract_e = to_e(options->retract_length + options->retract_restart_extra);
    w->lift = iso_units(options->retract_lift);
    w->x = w->y = w->z = w->feed = w->role = w->width = UNKNOWN;
    w->fan = -1;
    iso_planner_start(&w->planner, options->junction_deviation);
    w->progress = (iso_progress){0};
    w->clock = w->next_mark = 0;
    w->length = NULL;
    w->length_capacity = 0;
    w->used = 0;
    *writer = w;
    return ISO_OK;
}

void iso_gcode_writer_free(iso_gcode_writer *w) {
    if (!w)
        return;
    iso_progress_free(&w->progress);
    iso_release(w->length);
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
    ISO_TRY(iso_output_print(w->output, "; generated by %s on %s\n\n",
                             o->generator ? o->generator : "isoslice", date));
    set_fan(w, 0);
    if (bed)
        say(w, w->words->bed_wait, o->first_layer_bed_temperature);
    if (nozzle)
        say(w, w->words->nozzle, o->first_layer_temperature);
    ISO_TRY(mark_progress(w));
    accept(w, PUT(reserve(w), ";TYPE:Custom\n"));
    ISO_TRY(put_user_text(w, start));
    if (nozzle)
        say(w, w->words->nozzle_wait, o->first_layer_temperature);
    char *p = PUT(reserve(w), "G21 ; millimetres\nG90 ; absolute coordinates\n");
    p = put_text(p, o->use_relative_e_distances ? w->words->relative_e : w->words->absolute_e);
    *p++ = '\n';
    accept(w, p);
    return flush(w);
}

static void sum_up(iso_gcode_totals *totals, iso_gcode_writer *w) {
    iso_planner_stop(&w->planner);
    *totals = w->totals;
    double section = pi / 4 * w->options.filament_diameter * w->options.filament_diameter;
    totals->filament_mm = (double)w->emitted / E_DECIMALS;
    totals->filament_cm3 = totals->filament_mm * section / 1000;
    totals->filament_g = totals->filament_cm3 * w->options.filament_density;
    totals->time = w->planner.time;
    totals->idle_time = w->planner.idle_time;
}

static void put_figure(iso_gcode_writer *w, const char *name, double value) {
    char *p = PUT(reserve(w), "; ");
    p = PUT(put_text(p, name), " = ");
    p = iso_put_decimal(p, (int64_t)(value * 100 + 0.5), 2);
    *p++ = '\n';
    accept(w, p);
}

iso_status iso_gcode_finish(iso_gcode_totals *totals, iso_gcode_writer *w,
                            iso_gcode_config_lines *config, void *payload) {
    iso_gcode_totals sum;
    retract(w);
    set_fan(w, 0);
    sum_up(&sum, w);
    accept(w, PUT(reserve(w), ";TYPE:Custom\n"));
    ISO_TRY(put_user_text(w, w->options.end_gcode));
    if (w->options.remaining_times && w->words->progress)
        accept(w, iso_progress_put_line(reserve(w), 100, 0));
    put_figure(w, "filament used [mm]", sum.filament_mm);
    put_figure(w, "filament used [cm3]", sum.filament_cm3);
    put_figure(w, "filament used [g]", sum.filament_g);
    put_figure(w, "total filament used [g]", sum.filament_g);
    char *p = PUT(reserve(w), "; estimated printing time (normal mode) = ");
    p = iso_text_put_duration(p, (int64_t)sum.time);
    *p++ = '\n';
    accept(w, p);
    ISO_TRY(flush(w));
    if (config) {
        ISO_TRY(iso_output_print(w->output, "\n; prusaslicer_config = begin\n"));
        ISO_TRY(config(w->output, payload));
        ISO_TRY(iso_output_print(w->output, "; prusaslicer_config = end\n"));
    }
    ISO_TRY(iso_progress_fill_in(w->output, &w->progress, sum.time));
    sum.bytes = iso_output_size(w->output);
    *totals = sum;
    return ISO_OK;
}

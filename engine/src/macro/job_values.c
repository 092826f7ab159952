/* What a job knows: its date, its models, the place of its first layer, its one extruder. */
#include <stdio.h>
#include <string.h>

#include <isoslice/version.h>

#include "macro/names.h"

/* ---- the date ---- */

typedef struct date {
    int year, month, day, hour, minute, second;
} date;

/* Howard Hinnant, chrono-Compatible Low-Level Date Algorithms: civil_from_days. */
static date date_of(int64_t timestamp) {
    int64_t days = timestamp / 86400, seconds = timestamp % 86400;
    if (seconds < 0) {
        seconds += 86400;
        days--;
    }
    days += 719468;
    int64_t era = (days >= 0 ? days : days - 146096) / 146097, of_era = days - era * 146097;
    int64_t year = (of_era - of_era / 1460 + of_era / 36524 - of_era / 146096) / 365;
    int64_t of_year = of_era - (365 * year + year / 4 - year / 100),
            month = (5 * of_year + 2) / 153;
    date d = {.year = (int)(year + era * 400 + (month >= 10)),
              .month = (int)(month < 10 ? month + 3 : month - 9),
              .day = (int)(of_year - (153 * month + 2) / 5 + 1),
              .hour = (int)(seconds / 3600),
              .minute = (int)(seconds / 60 % 60),
              .second = (int)(seconds % 60)};
    return d;
}

/* ---- making values ---- */

static iso_status text_value(iso_datum *value, iso_macro_run *run, const char *text, size_t count) {
    iso_datum given = iso_datum_text(text, (int32_t)count), nothing = iso_datum_text("", 0);
    return macro_join(value, run, &given, &nothing);
}

static iso_status list_value(iso_datum *value, iso_macro_run *run, const iso_datum *item,
                             int32_t count) {
    void *room;
    ISO_TRY(macro_push(&room, run, (size_t)count * sizeof *item));
    memcpy(room, item, (size_t)count * sizeof *item);
    *value = iso_datum_list(room, count);
    return ISO_OK;
}

static iso_status pair_value(iso_datum *value, iso_macro_run *run, double x, double y) {
    iso_datum item[] = {iso_datum_number(x), iso_datum_number(y)};
    return list_value(value, run, item, 2);
}

static iso_status hull_value(iso_datum *value, iso_macro_run *run, const iso_macro_job *job) {
    iso_vec2 low = job->print_min, high = job->print_max;
    const iso_vec2 box[] = {low, {high.x, low.y}, high, {low.x, high.y}};
    int32_t count = job->hull_count > 0 ? job->hull_count : 4;
    const iso_vec2 *hull = job->hull_count > 0 ? job->hull : box;
    void *room;
    ISO_TRY(macro_push(&room, run, (size_t)count * sizeof(iso_datum)));
    for (int32_t i = 0; i < count; i++)
        ((iso_datum *)room)[i] = (iso_datum){.kind = ISO_DATUM_POINT, .point = hull[i]};
    *value = iso_datum_list(room, count);
    return ISO_OK;
}

/* ---- the values ---- */

enum {
    TIMESTAMP,
    YEAR,
    MONTH,
    DAY,
    HOUR,
    MINUTE,
    SECOND,
    INPUT,
    INPUT_BASE,
    OBJECTS,
    INSTANCES,
    LAYERS,
    SCALE,
    PRINT_MIN,
    PRINT_MAX,
    PRINT_SIZE,
    HULL,
    /* from here on they need no job */
    BED_MIN,
    BED_MAX,
    BED_SIZE,
    ZERO,
    ONE,
    NO,
    USED,
    FILAMENT,
    NOTHING,
    VERSION
};

static const struct {
    const char *key;
    int value;
} values[] = {
    {"timestamp", TIMESTAMP},
    {"year", YEAR},
    {"month", MONTH},
    {"day", DAY},
    {"hour", HOUR},
    {"minute", MINUTE},
    {"second", SECOND},
    {"input_filename", INPUT},
    {"input_filename_base", INPUT_BASE},
    {"num_objects", OBJECTS},
    {"num_instances", INSTANCES},
    {"total_layer_count", LAYERS},
    {"scale", SCALE},
    {"first_layer_print_min", PRINT_MIN},
    {"first_layer_print_max", PRINT_MAX},
    {"first_layer_print_size", PRINT_SIZE},
    {"first_layer_print_convex_hull", HULL},
    {"print_bed_min", BED_MIN},
    {"print_bed_max", BED_MAX},
    {"print_bed_size", BED_SIZE},
    {"initial_extruder", ZERO},
    {"initial_tool", ZERO},
    {"current_extruder", ZERO},
    {"filament_extruder_id", ZERO},
    {"current_object_idx", ZERO},
    {"total_toolchanges", ZERO},
    {"num_extruders", ONE},
    {"num_printing_extruders", ONE},
    {"extruders_count", ONE},
    {"is_extruder_used", USED},
    {"initial_filament_type", FILAMENT},
    {"has_wipe_tower", NO},
    {"has_single_extruder_multi_material_priming", NO},
    {"physical_printer_preset", NOTHING},
    {"version", VERSION},
};

static iso_status date_value(iso_datum *value, iso_macro_run *run, int which) {
    char text[64];
    date d = date_of(run->scope->job->timestamp);
    const int part[] = {d.year, d.month, d.day, d.hour, d.minute, d.second};
    if (which != TIMESTAMP) {
        *value = iso_datum_integer(part[which - YEAR]);
        return ISO_OK;
    }
    int count = snprintf(text, sizeof text, "%04d%02d%02d-%02d%02d%02d", d.year, d.month, d.day,
                         d.hour, d.minute, d.second);
    return text_value(value, run, text, (size_t)count);
}

/* "part.gcode" or "part" of "folder/part.stl": of the name, PrusaSlicer keeps what its result will
 * be called. */
static iso_status input_value(iso_datum *value, iso_macro_run *run, bool base) {
    char text[256];
    const char *path = run->scope->job->input_filename, *name = path ? path : "";
    for (const char *c = name; *c; c++)
        if (*c == '/')
            name = c + 1;
    const char *dot = strrchr(name, '.');
    int length = dot && dot > name ? (int)(dot - name) : (int)strlen(name);
    int count = snprintf(text, sizeof text, base ? "%.*s" : "%.*s.gcode",
                         length > 240 ? 240 : length, name);
    return text_value(value, run, text, (size_t)count);
}

static iso_status of_job(iso_datum *value, iso_macro_run *run, int which) {
    const iso_macro_job *job = run->scope->job;
    static const char unscaled[] = "x:100% y:100% z:100%";
    const iso_datum scale = iso_datum_text(unscaled, sizeof unscaled - 1);
    switch (which) {
    case INPUT:
    case INPUT_BASE:
        return input_value(value, run, which == INPUT_BASE);
    case OBJECTS:
        *value = iso_datum_integer(job->object_count);
        return ISO_OK;
    case INSTANCES:
        *value = iso_datum_integer(job->instance_count);
        return ISO_OK;
    case LAYERS:
        *value = iso_datum_integer(job->layer_count);
        return ISO_OK;
    case SCALE:
        return list_value(value, run, &scale, 1);
    case PRINT_MIN:
        return pair_value(value, run, job->print_min.x, job->print_min.y);
    case PRINT_MAX:
        return pair_value(value, run, job->print_max.x, job->print_max.y);
    case PRINT_SIZE:
        return pair_value(value, run, job->print_max.x - job->print_min.x,
                          job->print_max.y - job->print_min.y);
    case HULL:
        return hull_value(value, run, job);
    default:
        return date_value(value, run, which);
    }
}

static iso_status bed_value(iso_datum *value, iso_macro_run *run, int which) {
    const iso_options *options = run->scope->options;
    if (!options || options->bed_shape.count == 0)
        return ISO_OK;
    const iso_points *bed = &options->bed_shape;
    iso_vec2 low = bed->point[0], high = low;
    for (int32_t i = 1; i < bed->count; i++) {
        iso_vec2 p = bed->point[i];
        low = (iso_vec2){p.x < low.x ? p.x : low.x, p.y < low.y ? p.y : low.y};
        high = (iso_vec2){p.x > high.x ? p.x : high.x, p.y > high.y ? p.y : high.y};
    }
    if (which == BED_MIN)
        return pair_value(value, run, low.x, low.y);
    if (which == BED_MAX)
        return pair_value(value, run, high.x, high.y);
    return pair_value(value, run, high.x - low.x, high.y - low.y);
}

static iso_status of_printer(iso_datum *value, iso_macro_run *run, int which) {
    const iso_datum used = iso_datum_bool(true);
    switch (which) {
    case ZERO:
    case ONE:
        *value = iso_datum_integer(which == ONE);
        return ISO_OK;
    case NO:
        *value = iso_datum_bool(false);
        return ISO_OK;
    case USED:
        return list_value(value, run, &used, 1);
    case NOTHING:
        *value = iso_datum_text("", 0);
        return ISO_OK;
    case VERSION:
        *value = iso_datum_text(ISO_VERSION, sizeof ISO_VERSION - 1);
        return ISO_OK;
    case FILAMENT:
        ISO_TRY(macro_find(value, run, "filament_type"));
        if (value->kind == ISO_DATUM_LIST && value->count > 0)
            *value = value->item[0];
        return ISO_OK;
    default:
        return bed_value(value, run, which);
    }
}

static int find_value(const char *key) {
    for (size_t i = 0; i < sizeof values / sizeof *values; i++)
        if (strcmp(values[i].key, key) == 0)
            return values[i].value;
    return -1;
}

bool names_needs_job(const char *key) {
    int value = find_value(key);
    return value >= 0 && value < BED_MIN;
}

iso_status names_of_job(iso_datum *value, iso_macro_run *run, const char *key) {
    int which = find_value(key);
    if (which < 0)
        return ISO_OK;
    if (which >= BED_MIN)
        return of_printer(value, run, which);
    return run->scope->job ? of_job(value, run, which) : ISO_OK;
}

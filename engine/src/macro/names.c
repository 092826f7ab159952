#include "macro/names.h"

#include <stddef.h>
#include <string.h>

#include "config/value.h"

/* ---- options ---- */

static const struct {
    size_t offset;
    int32_t length;
    const char *key;
} fields[] = {
#define ISO_OPTION(key, kind, initial, unit, min, max, category, help)                             \
    {offsetof(iso_options, key), (int32_t)sizeof #key - 1, #key},
#include "config/options.inl"
#undef ISO_OPTION
};

enum { FIELD_COUNT = sizeof fields / sizeof *fields };

/* iso_option_find for those that come at every layer: most keys differ in their length. */
static int32_t find_option(const char *key) {
    int32_t length = (int32_t)strlen(key);
    for (int32_t i = 0; i < FIELD_COUNT; i++)
        if (fields[i].length == length && memcmp(fields[i].key, key, (size_t)length) == 0)
            return i;
    return -1;
}

static iso_status numbers_value(iso_datum *value, iso_macro_run *run, const iso_numbers *numbers) {
    void *room;
    ISO_TRY(macro_push(&room, run, (size_t)numbers->count * sizeof(iso_datum)));
    for (int32_t i = 0; i < numbers->count; i++)
        ((iso_datum *)room)[i] = iso_datum_number(numbers->value[i]);
    *value = iso_datum_list(room, numbers->count);
    return ISO_OK;
}

static iso_status points_value(iso_datum *value, iso_macro_run *run, const iso_vec2 *point,
                               int32_t count) {
    void *room;
    ISO_TRY(macro_push(&room, run, (size_t)count * sizeof(iso_datum)));
    for (int32_t i = 0; i < count; i++)
        ((iso_datum *)room)[i] = (iso_datum){.kind = ISO_DATUM_POINT, .point = point[i]};
    *value = iso_datum_list(room, count);
    return ISO_OK;
}

static iso_status place_value(iso_datum *value, iso_macro_run *run, const iso_place *place) {
    iso_vec2 point = {place->x, place->y};
    if (place->given)
        return points_value(value, run, &point, 1);
    *value = (iso_datum){.kind = ISO_DATUM_NIL};
    return ISO_OK;
}

static iso_datum relative_value(const iso_relative *relative) {
    iso_datum value = iso_datum_number(relative->value);
    value.percent = relative->percent;
    value.relative = value.percent || value.number == 0;
    return value;
}

static iso_status word_value(iso_datum *value, iso_macro_run *run, const void *field,
                             iso_option_kind kind) {
    char word[ISO_DATUM_TEXT_SIZE];
    size_t length = iso_value_format(word, sizeof word, field, kind);
    iso_datum text = iso_datum_text(word, (int32_t)length), nothing = iso_datum_text("", 0);
    return length < sizeof word ? macro_join(value, run, &text, &nothing) : ISO_OK;
}

iso_status names_of_options(iso_datum *value, iso_macro_run *run, const char *key) {
    int32_t option = run->scope->options ? find_option(key) : -1;
    if (option < 0)
        return ISO_OK;
    const void *field = (const char *)run->scope->options + fields[option].offset;
    iso_option_kind kind = iso_option_at(option)->kind;
    switch (kind) {
    case ISO_VALUE_BOOL:
        *value = iso_datum_bool(*(const bool *)field);
        return ISO_OK;
    case ISO_VALUE_INTEGER:
        *value = iso_datum_integer(*(const int32_t *)field);
        return ISO_OK;
    case ISO_VALUE_NUMBER:
    case ISO_VALUE_PERCENT:
        *value = iso_datum_number(*(const double *)field);
        value->percent = kind == ISO_VALUE_PERCENT;
        return ISO_OK;
    case ISO_VALUE_RELATIVE:
        *value = relative_value(field);
        return ISO_OK;
    case ISO_VALUE_TEXT:
        *value = iso_datum_text(field, (int32_t)strlen(field));
        return ISO_OK;
    case ISO_VALUE_PLACE:
        return place_value(value, run, field);
    case ISO_VALUE_POINTS:
        return points_value(value, run, ((const iso_points *)field)->point,
                            ((const iso_points *)field)->count);
    case ISO_VALUE_NUMBERS:
        return numbers_value(value, run, field);
    default:
        return word_value(value, run, field, kind);
    }
}

/* ---- percent of what ---- */

static const struct {
    const char *key, *of;
} parents[] = {
    {"external_perimeter_speed", "perimeter_speed"},
    {"small_perimeter_speed", "perimeter_speed"},
    {"solid_infill_speed", "infill_speed"},
    {"top_solid_infill_speed", "solid_infill_speed"},
    {"support_material_interface_speed", "support_material_speed"},
    {"first_layer_height", "layer_height"},
    {"infill_anchor", "infill_extrusion_width"},
    {"infill_anchor_max", "infill_extrusion_width"},
    {"infill_overlap", "perimeter_extrusion_width"},
    {"support_material_xy_spacing", "external_perimeter_extrusion_width"},
    {"min_bead_width", "nozzle_diameter"},
    {"min_feature_size", "nozzle_diameter"},
    {"wall_transition_filter_deviation", "nozzle_diameter"},
    {"wall_transition_length", "nozzle_diameter"},
    {"scale", NULL},
};

static bool ends_with(const char *text, const char *end) {
    size_t length = strlen(text), of_end = strlen(end);
    return length >= of_end && strcmp(text + length - of_end, end) == 0;
}

static iso_status number_named(double *number, iso_macro_run *run, const char *key,
                               const char *at) {
    iso_datum value;
    ISO_TRY(macro_find(&value, run, key));
    ISO_TRY(macro_single(&value, run, at));
    ISO_TRY(macro_absolute(&value, run, key, at));
    if (!iso_datum_is_numeric(&value))
        return macro_fail(run, at, "%s is no number", key);
    *number = iso_datum_as_number(&value);
    return ISO_OK;
}

/* Zero stands for extrusion_width, and there for 1.125 nozzles (support and top: one). Percent are
 * of the height of layers. The rules are PrusaSlicer's. */
static iso_status absolute_width(iso_datum *value, iso_macro_run *run, const char *key,
                                 const char *at) {
    double number = 0;
    iso_datum width = *value;
    if (iso_datum_as_number(&width) == 0 && strcmp(key, "extrusion_width") != 0) {
        ISO_TRY(macro_find(&width, run, "extrusion_width"));
        if (!iso_datum_is_numeric(&width))
            return macro_fail(run, at, "extrusion_width is no number");
    }
    double written = iso_datum_as_number(&width);
    if (width.percent) {
        bool first = strncmp(key, "first_layer_", 12) == 0;
        ISO_TRY(number_named(&number, run, first ? "first_layer_height" : "layer_height", at));
        number *= written / 100;
    } else if (written == 0) {
        bool bare = strncmp(key, "support_", 8) == 0 || strncmp(key, "top_", 4) == 0;
        ISO_TRY(number_named(&number, run, "nozzle_diameter", at));
        number = (float)number * (bare ? 1 : 1.125f); /* as exact as PrusaSlicer has it */
    } else {
        number = written;
    }
    *value = iso_datum_number(number);
    return ISO_OK;
}

iso_status macro_absolute(iso_datum *value, iso_macro_run *run, const char *key, const char *at) {
    if (!value->relative)
        return ISO_OK;
    value->relative = false;
    if (ends_with(key, "extrusion_width"))
        return absolute_width(value, run, key, at);
    if (!value->percent)
        return ISO_OK;
    double part = iso_datum_as_number(value) / 100, whole = 1;
    for (size_t i = 0; i < sizeof parents / sizeof *parents; i++)
        if (strcmp(key, parents[i].key) == 0) {
            if (parents[i].of)
                ISO_TRY(number_named(&whole, run, parents[i].of, at));
            *value = iso_datum_number(part * whole);
            return ISO_OK;
        }
    return macro_fail(run, at,
                      "%s is in percent of something that has no name; give it a number, or write "
                      "[%s] for its text",
                      key, key);
}

/* ---- names ---- */

iso_macro_variable *macro_variable(iso_macro_run *run, const char *key) {
    iso_macro_globals *globals = run->scope->globals;
    for (int32_t i = 0; i < run->local_count; i++)
        if (strcmp(run->local[i].key, key) == 0)
            return &run->local[i];
    for (int32_t i = 0; globals && i < globals->count; i++)
        if (strcmp(globals->variable[i].key, key) == 0)
            return &globals->variable[i];
    return NULL;
}

static bool number_of_place(iso_datum *value, const iso_macro_scope *scope, const char *key) {
    for (int32_t i = 0; i < scope->number_count; i++)
        if (strcmp(scope->number[i].key, key) == 0) {
            const iso_macro_number *number = &scope->number[i];
            *value = number->whole ? iso_datum_integer((int32_t)number->value)
                                   : iso_datum_number(number->value);
            return true;
        }
    return false;
}

static iso_status find_given(iso_datum *value, iso_macro_run *run, const char *key) {
    if (number_of_place(value, run->scope, key))
        return ISO_OK;
    ISO_TRY(names_of_job(value, run, key));
    if (value->kind == ISO_DATUM_NONE)
        ISO_TRY(names_of_options(value, run, key));
    return value->kind == ISO_DATUM_NONE ? names_of_files(value, run, key) : ISO_OK;
}

iso_status macro_find(iso_datum *value, iso_macro_run *run, const char *key) {
    const iso_macro_variable *variable = macro_variable(run, key);
    *value = (iso_datum){.kind = ISO_DATUM_NONE};
    if (variable) {
        *value = variable->value;
        return ISO_OK;
    }
    return find_given(value, run, key);
}

bool macro_is_key(iso_macro_run *run, const char *key) {
    iso_datum value = {.kind = ISO_DATUM_NONE};
    return find_given(&value, run, key) != ISO_OK || value.kind != ISO_DATUM_NONE;
}

/* ---- names without a value here ---- */

static const struct {
    const char *key, *why;
} elsewhere[] = {
    {"layer_num", "it is known in the codes of layers, of filaments' ends and of the end"},
    {"layer_z", "it is known in the codes of layers, of filaments' ends and of the end"},
    {"max_layer_z", "it is known in the codes of layers, of filaments' ends and of the end"},
    {"previous_extruder", "it is known in toolchange_gcode alone"},
    {"next_extruder", "it is known in toolchange_gcode alone"},
    {"toolchange_z", "it is known in toolchange_gcode alone"},
    {"toolchange_count", "it is known in toolchange_gcode alone"},
    {"color_change_extruder", "it is known in color_change_gcode alone"},
    {"print_time", "it is known only when the print is done"},
    {"normal_print_time", "it is known only when the print is done"},
    {"silent_print_time", "it is known only when the print is done"},
    {"used_filament", "it is known only when the print is done"},
    {"extruded_volume", "it is known only when the print is done"},
    {"extruded_volume_total", "it is known only when the print is done"},
    {"extruded_weight", "it is known only when the print is done"},
    {"extruded_weight_total", "it is known only when the print is done"},
    {"total_cost", "it is known only when the print is done"},
    {"total_weight", "it is known only when the print is done"},
    {"total_wipe_tower_cost", "isoslice has no wipe tower"},
    {"total_wipe_tower_filament", "isoslice has no wipe tower"},
    {"position", "isoslice doesn't tell macros where the nozzle is"},
    {"e_position", "isoslice doesn't tell macros where the nozzle is"},
    {"e_retracted", "isoslice doesn't tell macros where the nozzle is"},
    {"e_restart_extra", "isoslice doesn't tell macros where the nozzle is"},
    {"zhop", "isoslice doesn't tell macros where the nozzle is"},
};

iso_status macro_unknown(const iso_macro_run *run, const char *key, const char *at) {
    for (size_t i = 0; i < sizeof elsewhere / sizeof *elsewhere; i++)
        if (strcmp(key, elsewhere[i].key) == 0)
            return macro_fail(run, at, "%s has no value here: %s", key, elsewhere[i].why);
    if (!run->scope->job && names_needs_job(key))
        return macro_fail(run, at, "%s has no value without a job", key);
    const char *near = iso_option_suggest(key);
    if (near)
        return macro_fail(run, at, "there is no option or variable %s; is it %s?", key, near);
    return macro_fail(run, at,
                      "there is no option or variable %s; if a profile should set it, it has no "
                      "such line",
                      key);
}

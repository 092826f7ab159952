/* From the lines of files to options: which sections, their parents, what isn't ours. */
#include <isoslice/config.h>

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "config/foreign.h"
#include "config/ini.h"
#include "config/notes.h"
#include "config/spelling.h"
#include "config/value.h"
#include "macro/macro.h"

enum {
    DEPTH_MAX = 32, /* of parents' parents; deeper is a circle */
    NAME_SIZE = 256
};

typedef struct reader {
    iso_options *options;
    iso_config_notes *notes;
    const char *path;
    iso_ini ini;
    bool is_arachne; /* its walls are as wide as the part whatever thin_walls says */
} reader;

/* ---- lines ---- */

static bool is_numeric(iso_option_kind kind) {
    return kind == ISO_VALUE_BOOL || kind == ISO_VALUE_INTEGER || kind == ISO_VALUE_NUMBER ||
           kind == ISO_VALUE_PERCENT || kind == ISO_VALUE_RELATIVE;
}

static bool has_word(int32_t option, const char *value) {
    for (int32_t i = 0; iso_option_word(option, i); i++)
        if (strcmp(iso_option_word(option, i), value) == 0)
            return true;
    return false;
}

/* Keys that describe: nothing is printed otherwise for them, but macros may ask what they say. */
static bool is_description(const char *key) {
    static const char *const ends[] = {"_notes",   "_vendor",   "_model",        "_variant",
                                       "_type",    "_colour",   "_settings_id",  "_profile",
                                       "_texture", "_id",       "_spool_weight", "_condition",
                                       "_prints",  "_printers", "_technology"};
    static const char *const whole[] = {
        "notes", "inherits", "renamed_from", "prusaslicer_config", "print_host", "host_type"};
    if (strncmp(key, "octoprint_", 10) == 0 || strncmp(key, "printhost_", 10) == 0 ||
        strncmp(key, "serial_", 7) == 0)
        return true; /* of the connection */
    size_t length = strlen(key);
    for (size_t i = 0; i < sizeof whole / sizeof *whole; i++)
        if (strcmp(key, whole[i]) == 0)
            return true;
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++)
        if (length > strlen(ends[i]) && strcmp(key + length - strlen(ends[i]), ends[i]) == 0)
            return true;
    return false;
}

/* What only the choice of presets is about. */
static bool is_of_presets(const char *key) {
    return strncmp(key, "compatible_", 11) == 0 || strcmp(key, "inherits") == 0 ||
           strcmp(key, "renamed_from") == 0 || strcmp(key, "prusaslicer_config") == 0;
}

static void note_foreign(const reader *from, const char *key, const char *value) {
    if (!is_description(key))
        iso_notes_add_unknown(from->notes, key);
    if (!is_of_presets(key) && !iso_foreign_set(&from->options->foreign, key, value))
        iso_notes_add_unused(from->notes, key, "(no room for more)");
}

/* The first of a list, one value per extruder: "a";"b" of texts, 1,2 of numbers; numbers may have a
 * comment behind them: 0 # off. What is no list remains as it is. */
static const char *first_value(char *first, size_t size, int32_t option, const char *value) {
    const iso_option_info *info = iso_option_at(option);
    const char *begin = value;
    size_t length = strcspn(value, ",#");
    if (info->kind == ISO_VALUE_TEXT) {
        if (*value != '"' || !iso_macro_is_text_list(info->key))
            return value;
        begin = value + 1;
        for (length = 0; begin[length] && begin[length] != '"'; length++)
            length += begin[length] == '\\' && begin[length + 1];
    } else if (!is_numeric(info->kind) || value[length] == 0) {
        return value;
    }
    if (length >= size)
        return value;
    memcpy(first, begin, length);
    first[length] = 0;
    return first;
}

static iso_status apply_value(reader *from, int32_t option, const char *value, int32_t number) {
    char where[NAME_SIZE + 16], first[ISO_VALUE_TEXT_SIZE];
    snprintf(where, sizeof where, number > 0 ? "%.255s:%d" : "%.255s", from->path, number);
    return iso_options_set(from->options, iso_option_at(option)->key,
                           first_value(first, sizeof first, option, value), where);
}

/* That profiles turn thin_walls off says nothing where perimeter_generator is arachne, which print
 * profiles mean when they are silent about it; walls of less than two beads would double or go. */
static bool note_generator(reader *from, const char *key, const char *value) {
    if (strcmp(key, "perimeter_generator") != 0)
        return false;
    from->is_arachne = strcmp(value, "arachne") == 0;
    return iso_foreign_set(&from->options->foreign, key, value);
}

/* Words that older versions of PrusaSlicer had as 0 and 1. */
static const char *todays_word(const char *key, const char *value) {
    static const char *const words[][3] = {{"gcode_label_objects", "disabled", "octoprint"},
                                           {"draft_shield", "disabled", "enabled"}};
    bool is_one = strcmp(value, "1") == 0;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strcmp(key, words[i][0]) == 0 && (is_one || strcmp(value, "0") == 0))
            return words[i][1 + is_one];
    return value;
}

static iso_status apply_line(reader *from, const iso_ini_line *given) {
    const iso_ini_line today = {given->key, todays_word(given->key, given->value), given->number};
    const iso_ini_line *line = &today;
    int32_t option = iso_option_find(line->key);
    if (option < 0) {
        if (!note_generator(from, line->key, line->value))
            note_foreign(from, line->key, line->value);
        return ISO_OK;
    }
    bool is_empty = *line->value == 0 && (is_numeric(iso_option_at(option)->kind) ||
                                          iso_option_at(option)->kind == ISO_VALUE_POINTS);
    if (is_empty || (iso_option_word(option, 0) && !has_word(option, line->value))) {
        iso_notes_add_unused(from->notes, line->key, line->value);
        return ISO_OK;
    }
    iso_notes_drop_unused(from->notes, line->key);
    return apply_value(from, option, line->value, line->number);
}

/* filament_retract_length and its like are the filament's say over the printer's retract_length;
 * nil says nothing. */
static iso_status apply_overrides(reader *from) {
    static const char *const keys[] = {
        "filament_retract_length",        "filament_retract_lift",
        "filament_retract_lift_above",    "filament_retract_lift_below",
        "filament_retract_speed",         "filament_deretract_speed",
        "filament_retract_restart_extra", "filament_retract_before_travel",
        "filament_retract_layer_change",  "filament_wipe",
        "filament_retract_before_wipe"};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        const char *value = iso_foreign_get(&from->options->foreign, keys[i]);
        int32_t option = iso_option_find(keys[i] + strlen("filament_"));
        if (value && option >= 0 && strncmp(value, "nil", 3) != 0 && *value)
            ISO_TRY(apply_value(from, option, value, 0));
    }
    return ISO_OK;
}

/* ---- sections ---- */

static iso_status apply_section(reader *from, int32_t section, int depth);

/* `inherits = *common*; *fine*`: names of sections of the same type */
static iso_status apply_parents(reader *from, const char *child, const iso_ini_line *line,
                                int depth) {
    int type = (int)strcspn(child, ":");
    const char *at = line->value;
    while (*at) {
        at += strspn(at, "; \"");
        size_t length = strcspn(at, ";\"");
        while (length > 0 && at[length - 1] == ' ')
            length--;
        if (length == 0)
            break;
        char name[NAME_SIZE];
        snprintf(name, sizeof name, "%.*s:%.*s", type, child, (int)length, at);
        int32_t parent = iso_ini_find(&from->ini, name);
        if (parent >= 0)
            ISO_TRY(apply_section(from, parent, depth + 1));
        else
            iso_notes_add_unused(from->notes, line->key, name);
        at += length;
    }
    return ISO_OK;
}

static iso_status apply_section(reader *from, int32_t index, int depth) {
    const iso_ini_section *section = &from->ini.section[index];
    if (depth > DEPTH_MAX)
        return iso_fail(ISO_BAD_CONFIG, "%s: [%s] inherits from itself", from->path, section->name);
    const iso_ini_line *line = section->count > 0 ? from->ini.line + section->first : NULL;
    for (int32_t i = 0; i < section->count && *section->name; i++)
        if (strcmp(line[i].key, "inherits") == 0)
            ISO_TRY(apply_parents(from, section->name, &line[i], depth));
    for (int32_t i = 0; i < section->count; i++)
        ISO_TRY(apply_line(from, &line[i]));
    return ISO_OK;
}

static const char *const section_type[] = {"printer", "filament", "print"};
enum { TYPE_COUNT = sizeof section_type / sizeof *section_type };

static bool may_choose(const char *section, const char *type) {
    size_t length = strlen(type);
    return strncmp(section, type, length) == 0 && section[length] == ':' && !strchr(section, '*');
}

/* What may be chosen, as a hint: of `type`, or of all if that is NULL. */
static void list_choices(char *names, size_t size, const reader *from, const char *type) {
    size_t length = 0;
    names[0] = 0;
    for (int32_t i = 1; i < from->ini.section_count; i++) {
        const char *name = from->ini.section[i].name;
        bool fits = false;
        for (int t = 0; t < TYPE_COUNT; t++)
            fits = fits || ((!type || strcmp(type, section_type[t]) == 0) &&
                            may_choose(name, section_type[t]));
        if (!fits)
            continue;
        if (length + strlen(name) + 8 > size) {
            snprintf(names + length, size - length, ", ...");
            return;
        }
        length +=
            (size_t)snprintf(names + length, size - length, "%s%s", length > 0 ? ", " : "", name);
    }
}

/* The section whose name is nearest to a missing one; NULL if none is near. */
static const char *nearest_section(const reader *from, const char *missing, const char *type) {
    const char *nearest = NULL;
    size_t prefix = strlen(type) + 1;
    int best = (int)(strlen(missing) - prefix) / 2;
    for (int32_t i = 1; i < from->ini.section_count; i++) {
        const char *name = from->ini.section[i].name;
        if (!may_choose(name, type))
            continue;
        int distance = iso_edit_distance(name + prefix, missing + prefix);
        if (distance < best) {
            best = distance;
            nearest = name;
        }
    }
    return nearest;
}

static iso_status fail_choice(const reader *from, const char *missing, const char *type) {
    char names[512];
    list_choices(names, sizeof names, from, type);
    const char *near = missing ? nearest_section(from, missing, type) : NULL;
    if (near)
        return iso_fail(ISO_BAD_CONFIG, "%s: has no section [%s]; is it [%s]? It has %s",
                        from->path, missing, near, names);
    if (missing)
        return iso_fail(ISO_BAD_CONFIG, "%s: has no section [%s]; it has %s", from->path, missing,
                        names);
    return iso_fail(ISO_BAD_CONFIG,
                    "%s: is a bundle; say which sections to take, as -c '%s:print:NAME'; it has %s",
                    from->path, from->path, names);
}

/* Macros may ask for the names of the presets. */
static iso_status apply_preset(reader *from, const char *type, const char *name, int32_t index) {
    char key[32], value[2 * NAME_SIZE + 4];
    bool is_list = strcmp(type, "filament") == 0;
    size_t n = 0;
    if (is_list)
        value[n++] = '"';
    for (; *name && n < sizeof value - 4; name++) {
        if (*name == '\\' || (*name == '"' && is_list))
            value[n++] = '\\';
        value[n++] = *name;
    }
    if (is_list)
        value[n++] = '"';
    value[n] = 0;
    from->is_arachne = from->is_arachne || strcmp(type, "print") == 0;
    ISO_TRY(apply_section(from, index, 0));
    snprintf(key, sizeof key, "%s_settings_id", type);
    note_foreign(from, key, value);
    return ISO_OK;
}

static iso_status apply_named(reader *from, const char *type, const char *name, size_t length) {
    char section[NAME_SIZE];
    snprintf(section, sizeof section, "%s:%.*s", type, (int)length, name);
    int32_t index = iso_ini_find(&from->ini, section);
    if (index < 0)
        return fail_choice(from, section, type);
    return apply_preset(from, type, section + strlen(type) + 1, index);
}

/* The sections that [presets] of a bundle names, a missing one being a preset of the system. */
static iso_status apply_presets(reader *from, int32_t presets) {
    const iso_ini_section *section = &from->ini.section[presets];
    int32_t applied = 0;
    for (int t = 0; t < TYPE_COUNT; t++) {
        for (int32_t i = section->first; i < section->first + section->count; i++) {
            const iso_ini_line *line = &from->ini.line[i];
            char name[NAME_SIZE];
            snprintf(name, sizeof name, "%s:%s", section_type[t], line->value);
            int32_t chosen = iso_ini_find(&from->ini, name);
            if (strcmp(line->key, section_type[t]) != 0 || chosen < 0)
                continue;
            ISO_TRY(apply_preset(from, section_type[t], line->value, chosen));
            applied++;
        }
    }
    return applied > 0 ? ISO_OK : fail_choice(from, NULL, NULL);
}

/* The first of ":printer:", ":filament:", ":print:" in the text; NULL if there is none. */
static const char *find_choice(const char *text, const char **type) {
    const char *found = NULL;
    for (int t = 0; t < TYPE_COUNT; t++) {
        char mark[16];
        snprintf(mark, sizeof mark, ":%s:", section_type[t]);
        const char *at = strstr(text, mark);
        if (at && (!found || at < found)) {
            found = at;
            *type = section_type[t];
        }
    }
    return found;
}

static iso_status apply_choices(reader *from, const char *choice) {
    const char *type = NULL;
    ISO_TRY(apply_section(from, 0, 0));
    while (choice && (choice = find_choice(choice, &type))) {
        const char *name = choice + strlen(type) + 2, *ignored;
        const char *next = find_choice(name, &ignored);
        ISO_TRY(apply_named(from, type, name, next ? (size_t)(next - name) : strlen(name)));
        choice = next;
    }
    return ISO_OK;
}

static iso_status apply_file(reader *from, const char *choice) {
    int32_t presets = iso_ini_find(&from->ini, "presets");
    if (choice || from->ini.section_count == 1)
        return apply_choices(from, choice);
    return presets >= 0 ? apply_presets(from, presets) : fail_choice(from, NULL, NULL);
}

iso_status iso_options_read(iso_options *options, const char *path, iso_config_notes *notes) {
    char file[4096];
    const char *type, *choice = access(path, F_OK) == 0 ? NULL : find_choice(path, &type);
    size_t length = choice ? (size_t)(choice - path) : strlen(path);
    if (length >= sizeof file)
        return iso_fail(ISO_BAD_CONFIG, "%.60s...: the name is too long", path);
    memcpy(file, path, length);
    file[length] = 0;
    iso_options changed = *options;
    reader from = {&changed, notes, file, {0}, false};
    ISO_TRY(iso_ini_read(&from.ini, file));
    iso_status status = apply_file(&from, choice);
    if (status == ISO_OK)
        status = apply_overrides(&from);
    if (status == ISO_OK && from.is_arachne)
        status = iso_options_set(&changed, "thin_walls", "1", file);
    if (status == ISO_OK)
        *options = changed;
    iso_ini_free(&from.ini);
    return status;
}

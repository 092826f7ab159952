#include "arguments.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "config/notes.h"
#include "config/spelling.h"
#include "config/value.h"

enum {
    S = 1 << ISO_VERB_SLICE,
    C = 1 << ISO_VERB_CONTOURS,
    I = 1 << ISO_VERB_INFO,
    P = 1 << ISO_VERB_PREVIEW,
    L = 1 << ISO_VERB_LATTICE,
    H = 1 << ISO_VERB_CHANNELS
};

typedef enum flag_number {
#define ISO_FLAG(name, letter, argument, verbs, help) FLAG_##name,
#include "flags.inl"
#undef ISO_FLAG
    FLAG_COUNT
} flag_number;

static const iso_flag_info flag_table[] = {
#define ISO_FLAG(name, letter, argument, verbs, help) {#name, letter, argument, verbs, help},
#include "flags.inl"
#undef ISO_FLAG
};

int iso_flag_count(void) {
    return FLAG_COUNT;
}

const iso_flag_info *iso_flag_at(int i) {
    return &flag_table[i];
}

const char *iso_verb_name(iso_verb verb) {
    static const char *const name[] = {"slice",   "contours", "info",
                                       "preview", "lattice",  "channels"};
    return name[verb];
}

/* ---- walking along argv ---- */

typedef enum kind { IS_FILE, IS_FLAG, IS_OPTION } kind;

/* One argument, with its value if it takes one. */
typedef struct argument {
    kind kind;
    int index;           /* of the flag or option */
    bool negated;        /* --no-... */
    const char *written; /* for messages: "--layer-height" */
    const char *value;   /* of a file: its name; NULL if it has none */
} argument;

typedef struct walk {
    int argc, at;
    char **argv;
    iso_verb verb;
    bool files_only; /* "--" went by */
    char name[64];   /* of the argument, without a value */
} walk;

static int find_flag(const char *name) {
    if (iso_same_key("load", name))
        return FLAG_config;
    for (int i = 0; i < FLAG_COUNT; i++)
        if (iso_same_key(flag_table[i].name, name))
            return i;
    return -1;
}

bool iso_verb_has_options(iso_verb verb) {
    return verb == ISO_VERB_SLICE || verb == ISO_VERB_CONTOURS || verb == ISO_VERB_LATTICE;
}

static iso_status fail_unknown(const walk *along, const char *written) {
    const char *name = written + strspn(written, "-"), *near = NULL;
    int best = iso_edit_tolerance(name) + 1;
    for (int i = 0; i < FLAG_COUNT; i++) {
        int distance = iso_edit_distance(flag_table[i].name, name);
        if (distance < best && (flag_table[i].verbs & 1u << along->verb)) {
            best = distance;
            near = flag_table[i].name;
        }
    }
    if (!near && iso_verb_has_options(along->verb))
        near = iso_option_suggest(name);
    char suggestion[64];
    snprintf(suggestion, sizeof suggestion, "%s", near ? near : "help");
    for (char *c = suggestion; *c; c++)
        *c = *c == '_' ? '-' : *c;
    return iso_fail(ISO_USAGE,
                    near ? "there is no flag %s; is it --%s?"
                         : "there is no flag %s; "
                           "see --%s",
                    written, suggestion);
}

/* A switch takes no value but behind '=', where an option's may stand. */
static iso_status take_value(walk *along, argument *found, const char *equals, bool is_switch) {
    if (equals) {
        found->value = equals + 1;
    } else if (!is_switch) {
        if (along->at == along->argc)
            return iso_fail(ISO_USAGE, "%s: a value is due behind it", found->written);
        found->value = along->argv[along->at++];
    }
    return ISO_OK;
}

static iso_status read_long(walk *along, argument *found, const char *text) {
    const char *equals = strchr(text, '=');
    size_t length = equals ? (size_t)(equals - text) : strlen(text);
    if (length >= sizeof along->name)
        return iso_fail(ISO_USAGE, "there is no flag %.60s...", text);
    memcpy(along->name, text, length);
    along->name[length] = 0;
    const char *name = along->name + 2;
    found->written = along->name;
    bool positive = true;
    for (int turn = 0; turn < 2; turn++) {
        int flag = find_flag(name), option = iso_option_find(name);
        bool flag_fits = flag >= 0 && (flag_table[flag].verbs & 1u << along->verb);
        bool option_fits = option >= 0 && iso_verb_has_options(along->verb);
        if (flag_fits && (positive || !*flag_table[flag].argument)) {
            *found = (argument){IS_FLAG, flag, !positive, along->name, NULL};
            return take_value(along, found, equals, !*flag_table[flag].argument);
        }
        if (option_fits && (positive || iso_option_at(option)->kind == ISO_VALUE_BOOL)) {
            *found = (argument){IS_OPTION, option, !positive, along->name, NULL};
            return take_value(along, found, equals, iso_option_at(option)->kind == ISO_VALUE_BOOL);
        }
        if (strncmp(name, "no-", 3) != 0 && strncmp(name, "no_", 3) != 0)
            break;
        positive = false;
        name += 3;
    }
    return fail_unknown(along, along->name);
}

static iso_status read_short(walk *along, argument *found, const char *text) {
    snprintf(along->name, sizeof along->name, "-%c", text[1]);
    for (int i = 0; i < FLAG_COUNT; i++) {
        if (flag_table[i].letter != text[1] || !(flag_table[i].verbs & 1u << along->verb))
            continue;
        *found = (argument){IS_FLAG, i, false, along->name, NULL};
        bool is_switch = !*flag_table[i].argument;
        if (text[2] == 0)
            return take_value(along, found, NULL, is_switch);
        if (is_switch)
            return iso_fail(ISO_USAGE, "%s: write the letters apart", text);
        found->value = text + 2;
        return ISO_OK;
    }
    return fail_unknown(along, along->name);
}

static iso_status next_argument(walk *along, argument *found) {
    const char *text = along->argv[along->at++];
    if (!along->files_only && strcmp(text, "--") == 0) {
        along->files_only = true;
        if (along->at == along->argc) {
            *found = (argument){IS_FILE, 0, false, text, NULL};
            return ISO_OK;
        }
        text = along->argv[along->at++];
    }
    if (along->files_only || text[0] != '-' || text[1] == 0) {
        *found = (argument){IS_FILE, 0, false, text, text};
        return ISO_OK;
    }
    return text[1] == '-' ? read_long(along, found, text) : read_short(along, found, text);
}

/* ---- what arguments mean ---- */

/* Files are read first, then single settings, then flags: so the later ones win wherever they
 * stand. */
typedef enum phase_number { PHASE_FILES, PHASE_SETTINGS, PHASE_FLAGS, PHASE_COUNT } phase_number;

static iso_status read_setting(iso_arguments *arguments, const char *text) {
    char key[64];
    size_t length = strcspn(text, "=");
    if (text[length] == 0 || length == 0 || length >= sizeof key)
        return iso_fail(ISO_USAGE, "-s %.60s: is not of the form key=value", text);
    memcpy(key, text, length);
    key[length] = 0;
    while (length > 0 && key[length - 1] == ' ')
        key[--length] = 0;
    const char *value = text + strcspn(text, "=") + 1;
    iso_notes_drop_unused(&arguments->notes, key);
    return iso_options_set(&arguments->options, key, value + strspn(value, " "), "-s");
}

static iso_status read_count(int32_t *count, const argument *given, int32_t most) {
    double number;
    const char *at = given->value;
    if (!iso_number_read(&number, &at) || *at != 0 || number < 0 || number > most ||
        number != (int32_t)number)
        return iso_fail(ISO_USAGE, "%s %.60s: a whole number from 0 to %d is due", given->written,
                        given->value, most);
    *count = (int32_t)number;
    return ISO_OK;
}

static iso_status read_length(double *length, const argument *given) {
    const char *at = given->value;
    if (!iso_number_read(length, &at) || *at != 0 || *length < 0 || *length > 1000)
        return iso_fail(ISO_USAGE, "%s %.60s: mm from 0 to 1000 are due", given->written,
                        given->value);
    return ISO_OK;
}

static iso_status read_view(iso_arguments *arguments, const argument *given) {
    double *view = arguments->view;
    const char *at = given->value;
    if (!iso_number_read(&view[0], &at) || *at++ != ',' || !iso_number_read(&view[1], &at) || *at ||
        !(view[0] >= -360 && view[0] <= 360) || view[1] < -90 || view[1] > 90)
        return iso_fail(ISO_USAGE,
                        "%s %.60s: two angles are due, as -60,30; the second one from -90 to 90",
                        given->written, given->value);
    arguments->view_given = true;
    return ISO_OK;
}

static iso_status read_layers(iso_arguments *arguments, const argument *given) {
    const char *at = given->value;
    arguments->layer_count = 0;
    do {
        double number;
        if (!iso_number_read(&number, &at) || number != (int32_t)number || number == 0 ||
            arguments->layer_count == ISO_LAYERS_MAX)
            return iso_fail(ISO_USAGE, "%s %.60s: a list of layers is due, as 1,20,-1",
                            given->written, given->value);
        arguments->layer[arguments->layer_count++] = (int32_t)number;
    } while (*at++ == ',');
    return at[-1] == 0 ? ISO_OK
                       : iso_fail(ISO_USAGE, "%s %.60s: a list of layers is due, as 1,20,-1",
                                  given->written, given->value);
}

static iso_status read_page(iso_arguments *arguments, const argument *given) {
    static const struct {
        flag_number flag;
        iso_page page;
    } pages[] = {{FLAG_help, ISO_PAGE_HELP},
                 {FLAG_version, ISO_PAGE_VERSION},
                 {FLAG_list_options, ISO_PAGE_OPTIONS},
                 {FLAG_man, ISO_PAGE_MAN}};
    for (size_t i = 0; i < sizeof pages / sizeof *pages; i++)
        if ((int)pages[i].flag == given->index)
            arguments->page = pages[i].page;
    if (!given->value)
        return ISO_OK;
    if (arguments->page != ISO_PAGE_OPTIONS || strcmp(given->value, "markdown") != 0)
        return iso_fail(ISO_USAGE, "%s: takes no value", given->written);
    arguments->page = ISO_PAGE_OPTIONS_MARKDOWN;
    return ISO_OK;
}

static iso_status read_switch(iso_arguments *arguments, const argument *given) {
    bool on = !given->negated;
    if (given->value)
        return iso_fail(ISO_USAGE, "%s: takes no value", given->written);
    switch (given->index) {
    case FLAG_strict:
        arguments->strict = on;
        break;
    case FLAG_progress:
        arguments->progress = on;
        break;
    case FLAG_timestamp:
        arguments->timestamp = on;
        break;
    case FLAG_travels:
        arguments->travels = on;
        break;
    case FLAG_json:
        arguments->json = on;
        break;
    case FLAG_quiet:
        arguments->quiet = on;
        break;
    case FLAG_holes:
        arguments->channels.holes = on;
        break;
    }
    return ISO_OK;
}

/* One of `count` words. */
static iso_status read_word(int *choice, const argument *given, const char *const *word,
                            int count) {
    char all[128] = "";
    for (int i = 0; i < count; i++) {
        size_t length = strlen(all);
        if (iso_same_key(word[i], given->value)) {
            *choice = i;
            return ISO_OK;
        }
        snprintf(all + length, sizeof all - length, "%s%s", i > 0 ? ", " : "", word[i]);
    }
    return iso_fail(ISO_USAGE, "%s %.60s: one of %s is due", given->written, given->value, all);
}

static iso_status read_choice(iso_channel_options *channels, const argument *given) {
    static const char *const mode[] = {"planar", "pointwise", "geodesic"};
    static const char *const ports[] = {"none", "parallel", "series"};
    static const char *const side[] = {"left", "right", "front", "back"};
    int choice = 0;
    switch (given->index) {
    case FLAG_mode:
        ISO_TRY(read_word(&choice, given, mode, ISO_CHANNEL_MODE_COUNT));
        channels->mode = (iso_channel_mode)choice;
        return ISO_OK;
    case FLAG_ports:
        ISO_TRY(read_word(&choice, given, ports, ISO_CHANNEL_PORTS_COUNT));
        channels->ports = (iso_channel_ports)choice;
        return ISO_OK;
    default:
        ISO_TRY(read_word(&choice, given, side, ISO_CHANNEL_SIDE_COUNT));
        channels->side = (iso_channel_side)choice;
        return ISO_OK;
    }
}

/* Flags of `isoslice channels` that take a value. */
static iso_status read_channel_flag(iso_arguments *arguments, const argument *given) {
    iso_channel_options *channels = &arguments->channels;
    switch (given->index) {
    case FLAG_section:
        arguments->section = given->value;
        return ISO_OK;
    case FLAG_write:
        arguments->write = given->value;
        return ISO_OK;
    case FLAG_sides:
        return read_count(&arguments->sides, given, ISO_SECTION_SIDES_MAX);
    case FLAG_levels:
        return read_count(&channels->levels, given, 10000);
    case FLAG_samples:
        return read_count(&channels->samples, given, 10000);
    case FLAG_pitch:
        return read_length(&channels->pitch, given);
    case FLAG_depth:
        return read_length(&channels->depth, given);
    case FLAG_start:
        return read_length(&channels->start, given);
    case FLAG_margin:
        return read_length(&channels->margin, given);
    case FLAG_wall:
        return read_length(&channels->wall, given);
    case FLAG_bend:
        return read_length(&channels->bend, given);
    default:
        return read_choice(channels, given);
    }
}

static iso_status read_flag(iso_arguments *arguments, const argument *given) {
    if (iso_flag_at(given->index)->verbs == H && *iso_flag_at(given->index)->argument)
        return read_channel_flag(arguments, given);
    switch (given->index) {
    case FLAG_output:
        arguments->output = given->value;
        return ISO_OK;
    case FLAG_report:
        arguments->report = given->value;
        return ISO_OK;
    case FLAG_threads:
        return read_count(&arguments->threads, given, 1024);
    case FLAG_columns:
        return read_count(&arguments->columns, given, 100);
    case FLAG_voxel:
        return read_length(&arguments->voxel, given);
    case FLAG_layers:
        return read_layers(arguments, given);
    case FLAG_view:
        return read_view(arguments, given);
    case FLAG_help:
    case FLAG_version:
    case FLAG_list_options:
    case FLAG_man:
        return read_page(arguments, given);
    default:
        return read_switch(arguments, given);
    }
}

static iso_status read_option(iso_arguments *arguments, const argument *given) {
    if (given->negated && given->value)
        return iso_fail(ISO_USAGE, "%s: takes no value", given->written);
    const char *value = given->value ? given->value : given->negated ? "0" : "1";
    iso_notes_drop_unused(&arguments->notes, iso_option_at(given->index)->key);
    return iso_options_set(&arguments->options, iso_option_at(given->index)->key, value,
                           given->written);
}

static iso_status read_argument(iso_arguments *arguments, const argument *given,
                                phase_number phase) {
    bool is_config = given->kind == IS_FLAG && given->index == FLAG_config;
    bool is_setting = given->kind == IS_FLAG && given->index == FLAG_set;
    if (is_config || is_setting) {
        if (phase == PHASE_FILES && is_config) {
            arguments->config_count++;
            return iso_options_read(&arguments->options, given->value, &arguments->notes);
        }
        return phase == PHASE_SETTINGS && is_setting ? read_setting(arguments, given->value)
                                                     : ISO_OK;
    }
    if (phase != PHASE_FLAGS)
        return ISO_OK;
    return given->kind == IS_OPTION ? read_option(arguments, given) : read_flag(arguments, given);
}

static iso_status read_phase(iso_arguments *arguments, walk along, phase_number phase) {
    int files = along.at;
    arguments->file = (const char *const *)along.argv + files;
    while (along.at < along.argc) {
        argument given = {0};
        ISO_TRY(next_argument(&along, &given));
        if (given.kind != IS_FILE) {
            ISO_TRY(read_argument(arguments, &given, phase));
        } else if (given.value && phase == PHASE_FLAGS) {
            along.argv[files++] = (char *)given.value; /* behind where the walk reads */
            arguments->file_count++;
        }
    }
    return ISO_OK;
}

static iso_status check_notes(const iso_arguments *arguments) {
    const iso_config_notes *notes = &arguments->notes;
    if (!arguments->strict)
        return ISO_OK;
    if (notes->unknown_count > 0)
        return iso_fail(ISO_BAD_CONFIG, "%d settings are not isoslice's: %.400s",
                        notes->unknown_count, notes->unknown);
    if (notes->unused_count > 0)
        return iso_fail(ISO_BAD_CONFIG, "%d settings can't be followed: %.400s",
                        notes->unused_count, notes->unused);
    return ISO_OK;
}

/* "slcie part.stl": the first file isn't there, and it looks like a verb. */
static iso_status check_verb(const iso_arguments *arguments) {
    const char *first = arguments->file_count > 0 ? arguments->file[0] : "";
    if (arguments->verb_given || !*first || strpbrk(first, "./") || access(first, F_OK) == 0)
        return ISO_OK;
    for (int v = 0; v < ISO_VERB_COUNT; v++)
        if (iso_edit_distance(iso_verb_name(v), first) <= iso_edit_tolerance(first))
            return iso_fail(ISO_USAGE, "there is no verb %s; is it %s?", first, iso_verb_name(v));
    return ISO_OK;
}

iso_status iso_arguments_read(iso_arguments *arguments, int argc, char **argv) {
    *arguments = (iso_arguments){.travels = true,
                                 .progress = isatty(STDERR_FILENO) == 1,
                                 .channels = iso_channel_defaults(),
                                 .sides = 32,
                                 .view = {-60, 30}};
    iso_options_defaults(&arguments->options);
    walk along = {.argc = argc, .at = 1, .argv = argv};
    for (int v = 0; v < ISO_VERB_COUNT && argc > 1; v++) {
        if (strcmp(argv[1], iso_verb_name(v)) == 0) {
            arguments->verb = along.verb = v;
            arguments->verb_given = true;
            along.at = 2;
        }
    }
    for (int p = 0; p < PHASE_COUNT; p++)
        ISO_TRY(read_phase(arguments, along, p));
    if (arguments->page != ISO_PAGE_NONE)
        return ISO_OK;
    ISO_TRY(check_verb(arguments));
    ISO_TRY(check_notes(arguments));
    return iso_options_check(&arguments->options);
}

#include <isoslice/config.h>

#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "config/spelling.h"
#include "config/value.h"

static const iso_option_info option_table[] = {
#define ISO_OPTION(key, kind, initial, unit, min, max, category, help)                             \
    {#key, ISO_VALUE_##kind, initial, unit, min, max, category, help},
#include "config/options.inl"
#undef ISO_OPTION
};

static const size_t option_offset[] = {
#define ISO_OPTION(key, kind, initial, unit, min, max, category, help) offsetof(iso_options, key),
#include "config/options.inl"
#undef ISO_OPTION
};

enum { OPTION_COUNT = sizeof option_table / sizeof *option_table };

int32_t iso_option_count(void) {
    return OPTION_COUNT;
}

const iso_option_info *iso_option_at(int32_t option) {
    return &option_table[option];
}

const char *iso_option_word(int32_t option, int32_t i) {
    return iso_value_word(option_table[option].kind, i);
}

int32_t iso_option_find(const char *key) {
    for (int32_t i = 0; i < OPTION_COUNT; i++)
        if (iso_same_key(option_table[i].key, key))
            return i;
    return -1;
}

const char *iso_option_suggest(const char *key) {
    const char *nearest = NULL;
    int best = iso_edit_tolerance(key) + 1;
    for (int32_t i = 0; i < OPTION_COUNT; i++) {
        int distance = iso_edit_distance(option_table[i].key, key);
        if (distance < best) {
            best = distance;
            nearest = option_table[i].key;
        }
    }
    return nearest;
}

static void *field_of(iso_options *options, int32_t option) {
    return (char *)options + option_offset[option];
}

static const void *field_in(const iso_options *options, int32_t option) {
    return (const char *)options + option_offset[option];
}

void iso_options_defaults(iso_options *options) {
    memset(options, 0, sizeof *options);
    iso_value value;
    for (int32_t i = 0; i < OPTION_COUNT; i++) {
        const iso_option_info *info = &option_table[i];
        if (!iso_value_parse(&value, info, info->initial))
            memcpy(field_of(options, i), &value, iso_value_size(info->kind));
    }
}

/* What would be right, as "0.01 to 5 mm". */
static void describe_range(char *text, size_t size, const iso_option_info *info) {
    char low[32], high[32];
    const char *unit = info->unit;
    size_t n = 0;
    switch (info->kind) {
    case ISO_VALUE_BOOL:
        snprintf(text, size, "0 or 1");
        break;
    case ISO_VALUE_TEXT:
        snprintf(text, size, "a text");
        break;
    default:
        if (iso_option_is_word(info->kind)) {
            for (int32_t i = 0; iso_value_word(info->kind, i) && n < size; i++)
                n += (size_t)snprintf(text + n, size - n, "%s%s", i == 0 ? "" : ", ",
                                      iso_value_word(info->kind, i));
            break;
        }
        iso_number_write(low, info->min);
        iso_number_write(high, info->max);
        snprintf(text, size, "%s to %s%s%s%s", low, high, *unit ? " " : "", unit,
                 info->kind != ISO_VALUE_RELATIVE ? ""
                 : info->min > 0                  ? ", or 1% to 1000%"
                                                  : ", or 0% to 1000%");
    }
}

static iso_status fail_unknown(const char *key, const char *where) {
    const char *near = iso_option_suggest(key);
    return near ? iso_fail(ISO_BAD_CONFIG, "%s: there is no option %.60s; is it %s?", where, key,
                           near)
                : iso_fail(ISO_BAD_CONFIG,
                           "%s: there is no option %.60s; see isoslice "
                           "--list-options",
                           where, key);
}

iso_status iso_options_set(iso_options *options, const char *key, const char *value,
                           const char *where) {
    int32_t option = iso_option_find(key);
    if (option < 0)
        return fail_unknown(key, where);
    const iso_option_info *info = &option_table[option];
    iso_value parsed;
    const char *wrong = iso_value_parse(&parsed, info, value);
    if (wrong) {
        char range[1024];
        describe_range(range, sizeof range, info);
        return iso_fail(ISO_BAD_CONFIG, "%s: %s = %.80s %s; allowed: %s", where, info->key, value,
                        wrong, range);
    }
    memcpy(field_of(options, option), &parsed, iso_value_size(info->kind));
    return ISO_OK;
}

size_t iso_options_format(char *text, size_t size, const iso_options *options, int32_t option) {
    return iso_value_format(text, size, field_in(options, option), option_table[option].kind);
}

bool iso_options_is_default(const iso_options *options, int32_t option) {
    char text[ISO_VALUE_TEXT_SIZE];
    iso_options_format(text, sizeof text, options, option);
    return strcmp(text, option_table[option].initial) == 0;
}

static iso_status print_options(const iso_options *options, bool only_changed,
                                iso_option_printer *print, void *payload) {
    char text[ISO_VALUE_TEXT_SIZE];
    for (int32_t i = 0; i < OPTION_COUNT; i++) {
        iso_options_format(text, sizeof text, options, i);
        if (!only_changed || strcmp(text, option_table[i].initial) != 0)
            ISO_TRY(print(payload, option_table[i].key, text));
    }
    return ISO_OK;
}

iso_status iso_options_print(const iso_options *options, iso_option_printer *print, void *payload) {
    return print_options(options, false, print, payload);
}

iso_status iso_options_print_changed(const iso_options *options, iso_option_printer *print,
                                     void *payload) {
    return print_options(options, true, print, payload);
}

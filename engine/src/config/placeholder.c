#include "config/placeholder.h"

#include <string.h>

#include "config/value.h"

/* [key], {key} and {key[0]}: there is one extruder. */
static bool read_key(char key[64], const char *text, size_t length) {
    if (length >= 64)
        return false;
    memcpy(key, text, length);
    key[length] = 0;
    char *index = strchr(key, '[');
    if (index && (strcmp(index, "[0]") == 0 || strcmp(index, "[initial_extruder]") == 0))
        *index = 0;
    return true;
}

typedef struct filling {
    const iso_options *options;
    const iso_placeholder *more;
    int32_t count;
} filling;

static bool find_value(char value[ISO_VALUE_TEXT_SIZE], const filling *with, const char *key) {
    for (int32_t i = 0; i < with->count; i++)
        if (strcmp(with->more[i].key, key) == 0) {
            iso_number_write(value, with->more[i].value);
            return true;
        }
    int32_t option = iso_option_find(key);
    if (option >= 0)
        iso_options_format(value, ISO_VALUE_TEXT_SIZE, with->options, option);
    return option >= 0;
}

static iso_status fail_placeholder(const char *text, size_t length) {
    return iso_fail(ISO_BAD_CONFIG,
                    "the G-code has a placeholder %.*s that names no option; take it out or write "
                    "what it stands for",
                    length > 60 ? 60 : (int)length + 2, text);
}

iso_status iso_placeholders_fill(char *out, size_t size, const char *text,
                                 const iso_options *options, const iso_placeholder *more,
                                 int32_t count) {
    filling with = {options, more, count};
    size_t length = 0;
    while (*text) {
        char single[2] = {*text, 0}, key[64], value[ISO_VALUE_TEXT_SIZE];
        const char *piece = single;
        if (*text == '[' || *text == '{') {
            char closing = *text == '[' ? ']' : '}';
            size_t inside = strcspn(text + 1, closing == ']' ? "]\n" : "}\n");
            if (text[inside + 1] != closing || !read_key(key, text + 1, inside) ||
                !find_value(value, &with, key))
                return fail_placeholder(text, inside);
            piece = value;
            text += inside + 1;
        }
        size_t added = strlen(piece);
        if (length + added >= size)
            return iso_fail(ISO_BAD_CONFIG,
                            "the G-code is longer than %zu bytes with its placeholders filled in",
                            size - 1);
        memcpy(out + length, piece, added);
        length += added;
        text++;
    }
    if (size > 0)
        out[length] = 0;
    return ISO_OK;
}

iso_status iso_options_expand(char *out, size_t size, const char *text,
                              const iso_options *options) {
    return iso_placeholders_fill(out, size, text, options, NULL, 0);
}

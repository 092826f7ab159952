#include "config/placeholder.h"

#include <string.h>

#include "macro/macro.h"

enum { NUMBERS_MAX = 8 };

iso_status iso_placeholders_fill(char *out, size_t size, const char *text,
                                 const iso_options *options, const iso_placeholder *more,
                                 int32_t count) {
    iso_macro_number number[NUMBERS_MAX];
    for (int32_t i = 0; i < count && i < NUMBERS_MAX; i++)
        number[i] =
            (iso_macro_number){more[i].key, more[i].value, strcmp(more[i].key, "layer_num") == 0};
    const iso_macro_scope scope = {.options = options, .number = number, .number_count = count};
    return iso_macro_expand(out, size, text, "the G-code", &scope);
}

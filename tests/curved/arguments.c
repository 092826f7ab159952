#include "arguments.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int read_numbers(double *to, const char *text, int count) {
    for (int i = 0; i < count; i++) {
        char *end;
        to[i] = strtod(text, &end);
        if (end == text || (*end != ',' && *end != 0))
            return 0;
        text = *end ? end + 1 : end;
    }
    return 1;
}

int arguments_read(const argument *known, int known_count, int count, char **word) {
    int unnamed = 0;
    for (int i = 1; i < count; i++) {
        const char *text = word[i];
        int is_named = text[0] == '-' && text[1] == '-', skip = is_named ? 0 : unnamed++, k = 0;
        while (k < known_count && (strcmp(known[k].name, is_named ? text : "") != 0 || skip-- > 0))
            k++;
        const argument *a = &known[k];
        int takes = k < known_count && is_named && (a->word || a->count > 0),
            good = k < known_count;
        const char *value = !takes ? text : i + 1 < count ? word[++i] : "";
        if (good && a->word)
            *a->word = value;
        else if (good && a->count > 0)
            good = read_numbers(a->number, value, a->count);
        else if (good)
            *a->number = 1;
        if (!good) {
            fprintf(stderr, "%s isn't understood\n", text);
            return 0;
        }
    }
    return 1;
}

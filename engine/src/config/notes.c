#include "config/notes.h"

#include <stdio.h>
#include <string.h>

/* The entry of a list that is `key`, or begins with "key ="; NULL if there is none. */
static char *find_entry(char *list, const char *key) {
    size_t length = strlen(key);
    for (char *at = list; (at = strstr(at, key)); at++) {
        bool begins = at == list || (at - list >= 2 && at[-2] == ',');
        const char *end = at + length;
        if (begins && (*end == 0 || *end == ',' || strncmp(end, " =", 2) == 0))
            return at;
    }
    return NULL;
}

static void add_entry(char *list, size_t size, int32_t *count, const char *entry) {
    size_t length = strlen(list);
    ++*count;
    if (length + strlen(entry) + 3 <= size)
        snprintf(list + length, size - length, "%s%s", length > 0 ? ", " : "", entry);
}

void iso_notes_add_unknown(iso_config_notes *notes, const char *key) {
    char entry[64];
    snprintf(entry, sizeof entry, "%.60s", key);
    if (!find_entry(notes->unknown, entry))
        add_entry(notes->unknown, sizeof notes->unknown, &notes->unknown_count, entry);
}

void iso_notes_drop_unused(iso_config_notes *notes, const char *key) {
    char *entry = find_entry(notes->unused, key);
    if (!entry)
        return;
    char *next = strstr(entry, ", ");
    if (next)
        memmove(entry, next + 2, strlen(next + 2) + 1);
    else
        *(entry == notes->unused ? entry : entry - 2) = 0;
    notes->unused_count--;
}

/* Values have no commas here, or an entry would end too early. */
void iso_notes_add_unused(iso_config_notes *notes, const char *key, const char *value) {
    char entry[128];
    snprintf(entry, sizeof entry, "%.48s = %.60s", key, value);
    for (char *c = entry; *c; c++)
        *c = *c == ',' ? ';' : *c;
    if (strcmp(key, "inherits") != 0)
        iso_notes_drop_unused(notes, key);
    else if (strstr(notes->unused, entry))
        return;
    add_entry(notes->unused, sizeof notes->unused, &notes->unused_count, entry);
}

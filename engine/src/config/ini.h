/* The lines of a configuration file, whatever its kind. */
#ifndef ISO_CONFIG_INI_H
#define ISO_CONFIG_INI_H

#include <stdint.h>

#include <isoslice/status.h>

typedef struct iso_ini_line {
    const char *key, *value; /* trimmed */
    int32_t number;          /* in the file, from 1 */
} iso_ini_line;

typedef struct iso_ini_section {
    const char *name;     /* "print:0.20mm"; the lines before the first [..] have none: "" */
    int32_t first, count; /* lines */
} iso_ini_section;

typedef struct iso_ini {
    char *text; /* the file, cut up; the strings above point into it */
    iso_ini_line *line;
    iso_ini_section *section; /* [0] is the nameless one */
    int32_t line_count, section_count;
    int64_t line_capacity, section_capacity;
} iso_ini;

/* ISO_BAD_CONFIG, naming file and line. */
iso_status iso_ini_read(iso_ini *ini, const char *path) ISO_MUST_CHECK;
void iso_ini_free(iso_ini *ini);
/* The number of a section by its name, or -1. */
int32_t iso_ini_find(const iso_ini *ini, const char *name);

#endif

#include "config/ini.h"

#include <ctype.h>
#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "base/memory.h"

/* Settings stand at the end of a G-code file, and no configuration is longer. */
enum { TAIL_SIZE = 8 << 20 };

void iso_ini_free(iso_ini *ini) {
    iso_release(ini->text);
    iso_release(ini->line);
    iso_release(ini->section);
    *ini = (iso_ini){0};
}

int32_t iso_ini_find(const iso_ini *ini, const char *name) {
    for (int32_t i = 0; i < ini->section_count; i++)
        if (strcmp(ini->section[i].name, name) == 0)
            return i;
    return -1;
}

static iso_status unreadable(const char *path) {
    return iso_fail(ISO_BAD_CONFIG, "%s: can't be read: %s", path, strerror(errno));
}

static iso_status end_text(char *text, size_t length, const char *path) {
    text[length] = 0;
    return memchr(text, 0, length) ? iso_fail(ISO_BAD_CONFIG, "%s: is not a text file", path)
                                   : ISO_OK;
}

/* The last TAIL_SIZE bytes of a file. *whole tells whether that is all of it. */
static iso_status read_tail(char **text, FILE *file, const char *path, bool *whole) {
    if (fseeko(file, 0, SEEK_END) != 0)
        return unreadable(path);
    off_t size = ftello(file);
    *whole = size <= TAIL_SIZE;
    size_t length = (size_t)(*whole ? size : TAIL_SIZE);
    if (size < 0 || fseeko(file, -(off_t)length, SEEK_END) != 0)
        return unreadable(path);
    *text = iso_allocate(length + 1);
    if (!*text)
        return iso_no_memory(length + 1);
    errno = EIO;
    if (fread(*text, 1, length, file) != length)
        return unreadable(path);
    return end_text(*text, length, path);
}

/* Of a pipe, all there is. */
static iso_status read_pipe(char **text, FILE *file, const char *path, bool *whole) {
    int64_t capacity = 0;
    size_t length = 0, got = 1;
    *whole = true;
    while (got > 0 && length <= TAIL_SIZE) {
        ISO_TRY(ISO_GROW(*text, capacity, (int64_t)length + 4097));
        got = fread(*text + length, 1, (size_t)capacity - length - 1, file);
        length += got;
    }
    if (ferror(file))
        return unreadable(path);
    if (length > TAIL_SIZE)
        return iso_fail(ISO_BAD_CONFIG, "%s: is too long for a configuration", path);
    return end_text(*text, length, path);
}

static iso_status read_text(char **text, const char *path, bool *whole) {
    FILE *file = fopen(path, "rb");
    if (!file)
        return unreadable(path);
    bool is_pipe = fseeko(file, 0, SEEK_END) != 0 && errno == ESPIPE;
    iso_status status =
        is_pipe ? read_pipe(text, file, path, whole) : read_tail(text, file, path, whole);
    fclose(file);
    return status;
}

static bool is_gcode(const char *path, const char *text) {
    const char *dot = strrchr(path, '.');
    return text[0] == ';' || (dot && (strcasecmp(dot, ".gcode") == 0 ||
                                      strcasecmp(dot, ".g") == 0 || strcasecmp(dot, ".gco") == 0));
}

/* ---- lines ---- */

static char *trim(char *text) {
    while (isspace((unsigned char)*text))
        text++;
    size_t length = strlen(text);
    while (length > 0 && isspace((unsigned char)text[length - 1]))
        length--;
    text[length] = 0;
    return text;
}

/* Cut the next line off *rest; NULL at the end. */
static char *next_line(char **rest) {
    char *line = *rest;
    if (!line || *line == 0)
        return NULL;
    char *end = line + strcspn(line, "\n");
    *rest = *end ? end + 1 : end;
    *end = 0;
    return line;
}

static iso_status add_section(iso_ini *ini, const char *name) {
    ISO_TRY(ISO_GROW(ini->section, ini->section_capacity, ini->section_count + 1));
    ini->section[ini->section_count++] = (iso_ini_section){name, ini->line_count, 0};
    return ISO_OK;
}

static iso_status add_line(iso_ini *ini, char *line, int32_t number) {
    char *equals = strchr(line, '=');
    *equals = 0;
    ISO_TRY(ISO_GROW(ini->line, ini->line_capacity, ini->line_count + 1));
    ini->line[ini->line_count++] = (iso_ini_line){trim(line), trim(equals + 1), number};
    ini->section[ini->section_count - 1].count++;
    return ISO_OK;
}

static iso_status parse_ini(iso_ini *ini, const char *path) {
    static const char byte_order_mark[] = "\xEF\xBB\xBF";
    char *rest = ini->text, *raw;
    if (strncmp(rest, byte_order_mark, 3) == 0)
        rest += 3;
    for (int32_t number = 1; (raw = next_line(&rest)); number++) {
        char *line = trim(raw);
        size_t length = strlen(line);
        if (length == 0 || *line == '#' || *line == ';')
            continue;
        if (*line == '[' && line[length - 1] == ']') {
            line[length - 1] = 0;
            ISO_TRY(add_section(ini, trim(line + 1)));
        } else if (*line == '=' || !strchr(line, '=')) {
            return iso_fail(ISO_BAD_CONFIG, "%s:%d: %.60s is not of the form key = value", path,
                            number, line);
        } else {
            ISO_TRY(add_line(ini, line, number));
        }
    }
    return ISO_OK;
}

/* "; layer_height = 0.2" */
static bool is_setting(const char *line) {
    if (line[0] != ';' || line[1] != ' ')
        return false;
    size_t key = strspn(line + 2, "abcdefghijklmnopqrstuvwxyz0123456789_");
    return key > 0 && strncmp(line + 2 + key, " =", 2) == 0;
}

/* The block of settings is the longest run of such lines, of equals the last. Blank lines don't
 * end a run. */
static iso_status parse_gcode(iso_ini *ini, const char *path, bool whole) {
    char *rest = ini->text, *raw;
    int32_t run = 0, best = 0, best_first = 0;
    for (int32_t number = 1; (raw = next_line(&rest)); number++) {
        if (is_setting(raw)) {
            int32_t at = whole ? number : 0; /* without the beginning, lines have no numbers */
            ISO_TRY(add_line(ini, raw + 2, at));
            run++;
        } else if (*trim(raw) != 0) {
            run = 0;
        }
        if (run > 0 && run >= best) {
            best = run;
            best_first = ini->line_count - run;
        }
    }
    if (best == 0)
        return iso_fail(ISO_BAD_CONFIG, "%s: has no block of settings (; key = value) at its end",
                        path);
    ini->section[0].first = best_first;
    ini->section[0].count = best;
    return ISO_OK;
}

iso_status iso_ini_read(iso_ini *ini, const char *path) {
    bool whole = true;
    *ini = (iso_ini){0};
    iso_status status = read_text(&ini->text, path, &whole);
    if (status == ISO_OK)
        status = add_section(ini, "");
    if (status == ISO_OK && is_gcode(path, ini->text))
        status = parse_gcode(ini, path, whole);
    else if (status == ISO_OK && !whole)
        status = iso_fail(ISO_BAD_CONFIG, "%s: is too long for a configuration", path);
    else if (status == ISO_OK)
        status = parse_ini(ini, path);
    if (status != ISO_OK)
        iso_ini_free(ini);
    return status;
}

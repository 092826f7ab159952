/* A buffer that lines are formatted into in place, before an output. */
#ifndef ISO_GCODE_LINES_H
#define ISO_GCODE_LINES_H

#include <string.h>

#include "base/output.h"

enum {
    ISO_LINES_BUFFER = 128 << 10, /* beyond iso_output's own buffer, which it then passes by */
    ISO_LINES_READY = 512         /* bytes that one reserve holds ready: a few lines */
};

typedef struct iso_lines {
    iso_output *output;
    size_t used;
    char buffer[ISO_LINES_BUFFER];
} iso_lines;

static inline void iso_lines_start(iso_lines *lines, iso_output *output) {
    lines->output = output;
    lines->used = 0;
}

static inline iso_status iso_lines_flush(iso_lines *lines) {
    size_t used = lines->used;
    lines->used = 0;
    return iso_output_write(lines->output, lines->buffer, used);
}

/* Where the next lines go: ISO_LINES_READY bytes are free there. A failure to write is kept by the
 * output. */
static inline char *iso_lines_reserve(iso_lines *lines) {
    if (lines->used > ISO_LINES_BUFFER - ISO_LINES_READY)
        (void)!iso_lines_flush(lines);
    return lines->buffer + lines->used;
}

static inline void iso_lines_accept(iso_lines *lines, const char *end) {
    lines->used = (size_t)(end - lines->buffer);
}

/* How far into the output the next line begins. */
static inline int64_t iso_lines_offset(const iso_lines *lines) {
    return iso_output_size(lines->output) + (int64_t)lines->used;
}

static inline char *iso_put_text(char *to, const char *text) {
    size_t size = strlen(text);
    memcpy(to, text, size);
    return to + size;
}

static inline char *iso_put_newline(char *to) {
    *to = '\n';
    return to + 1;
}

#define ISO_PUT(to, literal) (memcpy(to, literal, sizeof literal - 1), (to) + sizeof literal - 1)

#endif

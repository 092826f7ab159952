/* One line of G-code taken apart. */
#ifndef FIO_VIRTUAL_LINE_H
#define FIO_VIRTUAL_LINE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <isoprint/virtual_printer.h>

typedef enum fio_line_kind {
    FIO_LINE_EMPTY,   /* blank or comment: no answer */
    FIO_LINE_COMMAND, /* to be executed */
    FIO_LINE_DAMAGED, /* checksum wrong or missing */
} fio_line_kind;

typedef struct fio_line {
    char text[FIO_LINE_MOST + 1]; /* without comments, N and checksum; ends with a 0 */
    int length;
    bool cut;        /* longer than FIO_LINE_MOST */
    bool has_number; /* N was there */
    bool has_checksum;
    int64_t number;    /* of N; -1 */
    char letter;       /* G, M, T; 0 if there is no such command */
    int code, subcode; /* G92.1 is 92 and 1 */
    int arguments;     /* index in text; no pointer, so that a line can be copied */
    /* Words: bit l - 'A'. Values only where `valued` says so. */
    uint32_t seen, valued;
    int stray; /* a byte that belongs to no word, as unsigned char; -1 */
    double value[26];
} fio_line;

fio_line_kind fio_line_parse(fio_line *line, const char *bytes, size_t length);

/* Read the words of `arguments`: not for commands whose argument is free text. */
void fio_line_words(fio_line *line);

static inline bool fio_line_seen(const fio_line *line, char letter) {
    return line->seen >> (letter - 'A') & 1;
}

static inline bool fio_line_has(const fio_line *line, char letter) {
    return line->valued >> (letter - 'A') & 1;
}

static inline double fio_line_value(const fio_line *line, char letter) {
    return line->value[letter - 'A'];
}

#endif

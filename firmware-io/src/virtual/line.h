/* One line of G-code taken apart. */
#ifndef FIO_VIRTUAL_LINE_H
#define FIO_VIRTUAL_LINE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <isoprint/virtual_printer.h>

/* What Marlin thinks of a line's number and checksum. */
typedef enum fio_line_verdict {
    FIO_LINE_GOOD,      /* no number, or the one that is due and a checksum that fits */
    FIO_LINE_REPEATED,  /* it was just had: dropped, without an ok */
    FIO_LINE_NUMBER,    /* not the one that is due */
    FIO_LINE_CHECKSUM,  /* does not fit */
    FIO_LINE_UNCHECKED, /* a number without a checksum */
} fio_line_verdict;

typedef struct fio_line {
    char text[FIO_LINE_MOST + 1]; /* without comments, N and checksum; ends with a 0 */
    int length;
    bool has_number;   /* N was there */
    int64_t number;    /* of N; -1 */
    char letter;       /* G, M, T; 0 if there is no such command */
    int code, subcode; /* G92.1 is 92 and 1 */
    int arguments;     /* index in text; no pointer, so that a line can be copied */
    /* Words: bit l - 'A'. Values only where `valued` says so. */
    uint32_t seen, valued;
    int stray; /* a byte that belongs to no word, as unsigned char; -1 */
    double value[26];
} fio_line;

/* Copy what is no comment (`;` to the end, or in parentheses), at most FIO_LINE_MOST bytes. Returns
 * the length; 0 for a line that gets no answer. */
int fio_line_strip(char text[FIO_LINE_MOST + 1], bool *cut, const char *bytes, size_t length);

/* Check number and checksum of a stripped line, by the rules and in the order of Marlin's
 * bugfix-2.1 queue. *last, the number before, follows a good line. A `lower` n is a number, too, if
 * allowed. */
fio_line_verdict fio_line_check(const char *text, int64_t *last, bool lower);
int64_t fio_line_number(const char *text);                /* of a line that begins with N */
const char *fio_line_complaint(fio_line_verdict verdict); /* "checksum mismatch" … */

/* Take a stripped line apart: number and checksum are cut off. `lower`: n, g, m and t will do. */
void fio_line_read(fio_line *line, const char *text, int length, bool lower);

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

/* What a person sees on standard error: messages, and below them one line that changes. */
#ifndef FIO_CLI_SCREEN_H
#define FIO_CLI_SCREEN_H

#include <stdbool.h>

#include "output.h"

typedef struct fio_screen {
    fio_output output;
    bool is_terminal, quiet;
    bool line_shown;
    char line[512]; /* the one that changes */
} fio_screen;

void fio_screen_open(fio_screen *screen, bool quiet);

/* "isoprint: …" and a line end. Bytes of others have to be made visible (utf8.h) beforehand. */
void fio_screen_say(fio_screen *screen, const char *format, ...) FIO_PRINTF(2, 3);
/* The same even if quiet. */
void fio_screen_fail(fio_screen *screen, const char *format, ...) FIO_PRINTF(2, 3);

/* Show this line; on a terminal alone. */
void fio_screen_line(fio_screen *screen, const char *text);

/* The width has changed. */
void fio_screen_redraw(fio_screen *screen);

/* Leaves the last line standing. */
void fio_screen_close(fio_screen *screen);

#endif

/* The log of everything said between host and printer, each line with its time. */
#ifndef FIO_CLI_DIALOGUE_H
#define FIO_CLI_DIALOGUE_H

#include <stddef.h>

#include "output.h"

typedef struct fio_dialogue {
    fio_output output;
    const char *path; /* NULL: no log */
    double start, flushed;
} fio_dialogue;

/* `path` NULL: no log. FIO_NOT_WRITTEN. `start` is what the times count from. */
fio_status fio_dialogue_open(fio_dialogue *dialogue, const char *path,
                             const char *port) FIO_MUST_CHECK;
void fio_dialogue_start(fio_dialogue *dialogue, double start);

/* `who`: '>' the host, '<' the printer, '#' a note. Line ends of `bytes` are left out. */
void fio_dialogue_add(fio_dialogue *dialogue, double now, char who, const char *bytes, size_t size);

/* On disk at the latest a second after it was said, if this is called so often. */
void fio_dialogue_flush(fio_dialogue *dialogue, double now);

/* FIO_NOT_WRITTEN if it is not whole. */
fio_status fio_dialogue_close(fio_dialogue *dialogue) FIO_MUST_CHECK;

#endif

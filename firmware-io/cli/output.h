/* Lines for a descriptor that may be slow: a full pipe or a stopped terminal must never hold the
 * printer up, so that what has no room any more is dropped, whole lines at a time, and counted. */
#ifndef FIO_CLI_OUTPUT_H
#define FIO_CLI_OUTPUT_H

#include <poll.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <isoprint/status.h>

enum { FIO_OUTPUT_ROOM = 65536 };

typedef struct fio_output {
    int descriptor; /* -1: none, everything is dropped in silence */
    bool owned;     /* to be closed */
    bool is_file;   /* never slow: written when half full, and by flush() */
    bool is_socket;
    int error; /* errno of the first write that failed; nothing is written behind it */
    int64_t dropped;
    size_t first, length; /* what waits, as a ring */
    char bytes[FIO_OUTPUT_ROOM];
} fio_output;

/* Write to a descriptor that is somebody else's as well: its flags stay as they are. */
void fio_output_share(fio_output *output, int descriptor);

/* FIO_NOT_WRITTEN if the file can't be made. */
fio_status fio_output_create(fio_output *output, const char *path) FIO_MUST_CHECK;

void fio_output_line(fio_output *output, const char *bytes, size_t size);

/* Write what can be written without waiting. */
void fio_output_flush(fio_output *output);

/* True if something waits for room: watch for it with this, flush when it comes. */
bool fio_output_waits(const fio_output *output, struct pollfd *poll);

/* Write all that is left, for at most `seconds`, and let go. False if something was lost. */
bool fio_output_close(fio_output *output, double seconds);

#endif

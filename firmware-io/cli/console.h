/* Single commands: of --send, or of standard input line by line as they come. */
#ifndef FIO_CLI_CONSOLE_H
#define FIO_CLI_CONSOLE_H

#include <poll.h>
#include <stdbool.h>
#include <stddef.h>

#include "protocol/encode.h"
#include "stream/streamer.h"

typedef struct fio_console {
    const char *const *commands; /* those of --send; NULL: standard input */
    int count, at;
    bool ended;           /* there will be no more lines */
    int error;            /* an errno: why standard input could not be read on */
    bool skipping;        /* the rest of a line that was too long */
    size_t first, length; /* what of standard input has been read and not yet been sent */
    char bytes[4096];
    char line[FIO_WIRE_LINE_MOST + 1];
    bool temperatures, reports; /* M105, M155 was among the lines */
    bool refused;               /* a line could not be sent */
    bool pending;               /* `line` waits for the streamer to take it */
} fio_console;

void fio_console_open(fio_console *console, const char *const *commands, int count);

/* True if standard input is to be watched. */
bool fio_console_waits(const fio_console *console, struct pollfd *poll);

/* Hand over what the streamer takes, end it after the last one. FIO_USAGE for a line that can't be
 * sent (it is passed over). */
fio_status fio_console_feed(fio_console *console, fio_streamer *streamer,
                            double now) FIO_MUST_CHECK;

#endif

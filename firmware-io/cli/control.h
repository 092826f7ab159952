/* What reaches a running session from outside: signals, keys, lines of a console, a job in a pipe.
 */
#ifndef FIO_CLI_CONTROL_H
#define FIO_CLI_CONTROL_H

#include "console.h"
#include "job.h"
#include "narrator.h"
#include "stream/session.h"

typedef struct fio_control {
    fio_narrator *narrator;
    fio_streamer *streamer;
    fio_job *job;         /* NULL: none */
    fio_console *console; /* NULL: none */
    int interrupts;
    double cancel_asked; /* by a first c */
    bool cancelled;
    bool told; /* the message of the failure has been shown */
} fio_control;

/* `control` must outlive the session. */
fio_session_hooks fio_control_hooks(fio_control *control);

#endif

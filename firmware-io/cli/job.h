/* The job: a source of commands, looked at before and while it is printed. */
#ifndef FIO_CLI_JOB_H
#define FIO_CLI_JOB_H

#include <stdbool.h>

#include "stream/streamer.h"

typedef struct fio_job {
    fio_source *source;
    const char *name; /* for messages */
    bool is_pipe;
    bool waits;         /* there was nothing to read the last time: watch the descriptor */
    bool peeked;        /* `first` has been read and not yet been given out */
    fio_status failure; /* why next() gave FIO_SOURCE_FAILED */
    fio_source_command first;
} fio_job;

/* `path` "-": standard input, of which the first command is waited for; otherwise the whole file is
 * gone through. FIO_UNREADABLE if it can't be read or holds no command, FIO_FAULTY if it holds what
 * a job must not do, FIO_CANCELLED if a signal comes meanwhile. */
fio_status fio_job_open(fio_job *job, const char *path) FIO_MUST_CHECK;
void fio_job_close(fio_job *job);

/* For the streamer. `context` is the job. A pipe can't seek. */
fio_source_result fio_job_next(void *context, fio_source_command *command);
fio_status fio_job_seek(void *context, int64_t index);

/* Where to go on to begin with this line: FIO_USAGE if there is no command from there on. Leaves
 * the job at its beginning. Not for pipes. */
fio_status fio_job_find_line(fio_job *job, int64_t line, fio_stream_resume *resume) FIO_MUST_CHECK;

/* Stop watching a pipe that has become readable: the streamer will come for it in its own time. */
void fio_job_look(fio_job *job);

/* The line of a command, or the one behind the last command's. Leaves the job behind it. Not for
 * pipes. */
fio_status fio_job_line_of(fio_job *job, int64_t *line, int64_t index) FIO_MUST_CHECK;

#endif

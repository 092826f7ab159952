/* Going on with a job that broke off, and seeing to it that this job can be gone on with. */
#ifndef FIO_CLI_RESUMPTION_H
#define FIO_CLI_RESUMPTION_H

#include "arguments.h"
#include "job.h"
#include "narrator.h"
#include "stream/journal.h"

typedef struct fio_resumption {
    fio_journal *journal; /* that is being written; NULL: none */
    char journal_path[1100];
    char file[1100];
    const char *port;
    bool resumes; /* `from` says where this job goes on */
    fio_stream_resume from;
    fio_journal_job job; /* of the journal that was read */
} fio_resumption;

/* What --resume-from says, if it names a journal: then the file and the port may come from it. */
fio_status fio_resumption_read(fio_resumption *resumption,
                               const fio_arguments *arguments) FIO_MUST_CHECK;

/* Once the job is open: is it the journal's, or where is the line? */
fio_status fio_resumption_match(fio_resumption *resumption, const fio_arguments *arguments,
                                fio_job *job) FIO_MUST_CHECK;

/* May the journal be begun anew? Asks, if an earlier run of this job is in it. */
fio_status fio_resumption_check(fio_resumption *resumption, const fio_arguments *arguments,
                                const fio_job *job) FIO_MUST_CHECK;

/* Begin the journal. One that was not asked for and can't be written is only warned of. */
fio_status fio_resumption_begin(fio_resumption *resumption, const fio_arguments *arguments,
                                const fio_job *job, fio_narrator *narrator) FIO_MUST_CHECK;

/* The streamer's mark. A failure is told once; the job goes on. */
void fio_resumption_mark(fio_resumption *resumption, const fio_stream_resume *resume,
                         fio_narrator *narrator);

/* After the end. `command` (`size` bytes) is what goes on with the job, "" if nothing does. */
void fio_resumption_end(fio_resumption *resumption, const fio_arguments *arguments,
                        fio_status status, const fio_stream_report *report, fio_job *job,
                        char *command, size_t size);

#endif

/* How far a job came, on disk: survives a killed host.
 *
 * A text file to which records are appended, each with a checksum; the last whole one counts. The
 * first names the job: path, size, fingerprint. A finished job's journal is removed. */
#ifndef FIO_STREAM_JOURNAL_H
#define FIO_STREAM_JOURNAL_H

#include <stdint.h>

#include <isoprint/status.h>

#include "stream/streamer.h"

typedef struct fio_journal fio_journal;

typedef struct fio_journal_job {
    char path[1024]; /* of the G-code, absolute; "-" for standard input */
    char port[128];
    int64_t size;
    uint64_t fingerprint;
} fio_journal_job;

/* Begin anew, in place of a journal that is there, which stays if this fails. `from`: the first
 * record, so that at no moment a resumed job has none; NULL: none yet. */
fio_status fio_journal_create(fio_journal **journal, const char *path, const fio_journal_job *job,
                              const fio_stream_resume *from) FIO_MUST_CHECK;
/* Returns once a killed process can't lose it; without waiting for the disk, which has it soon. */
fio_status fio_journal_add(fio_journal *journal, const fio_stream_resume *resume) FIO_MUST_CHECK;
/* `done`: the job was printed whole; the file is removed. */
void fio_journal_close(fio_journal *journal, bool done);

/* FIO_UNREADABLE if it is none, or has no whole record. After the machine was started anew `number`
 * is -1: the last records may be missing. */
fio_status fio_journal_read(const char *path, fio_journal_job *job,
                            fio_stream_resume *resume) FIO_MUST_CHECK;

#endif

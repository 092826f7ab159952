/* How far a job is, and how long it will still take. */
#ifndef FIO_CLI_PROGRESS_H
#define FIO_CLI_PROGRESS_H

#include "base/text.h"
#include "stream/streamer.h"

typedef struct fio_progress {
    fio_source_summary whole;
    double last;   /* time of the last update; < 0: none yet */
    double active; /* s spent printing since the first layer began, pauses left out */
    double from;   /* share of the job that was done then; < 0: not begun */
    int minutes;   /* the last M73 R, and when it came */
    double minutes_at;
    double share;        /* 0 … 1; < 0: not known */
    double seconds_left; /* < 0: not known */
} fio_progress;

void fio_progress_begin(fio_progress *progress, const fio_source_summary *whole);
void fio_progress_update(fio_progress *progress, const fio_stream_report *report, double now);

/* "42 %, layer 31/74, 12 min left, nozzle 215/215 C, bed 60/60 C", with what is known. */
void fio_progress_describe(fio_text *text, const fio_progress *progress,
                           const fio_stream_report *report);

/* "printing", "paused", … */
const char *fio_progress_state_name(fio_stream_state state);

/* "45 s", "12 min", "1 h 05 min" */
void fio_progress_duration(fio_text *text, double seconds);

#endif

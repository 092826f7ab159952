/* Tells what happens: to a person on standard error, to a program on standard output, and to the
 * log. One at a time. */
#ifndef FIO_CLI_NARRATOR_H
#define FIO_CLI_NARRATOR_H

#include "arguments.h"
#include "dialogue.h"
#include "json.h"
#include "progress.h"
#include "screen.h"

typedef struct fio_narrator {
    fio_screen screen;
    fio_output out; /* standard output */
    fio_dialogue dialogue;
    fio_json json;
    fio_progress progress;
    bool use_json;
    bool ended;           /* the end has been told */
    bool answers;         /* what the printer says goes to standard output: console, --send */
    bool has_job;         /* there is a progress to tell of */
    bool upload;          /* of writing to the card */
    bool started;         /* and the file there is being printed */
    bool paused_for_user; /* the printer waits for a person */
    double start, now;    /* of the transport's clock */
    double told;          /* when the last progress went out as JSON or as a line of a pipe */
    int tenth;            /* the last 10 % told in a pipe */
    /* Of a console: which lines under way are isoprint's own, so that their answers are not shown.
     */
    uint64_t own;               /* bit i: the i-th line that is not answered yet */
    int under_way;              /* lines, at most 64 */
    char token[8];              /* what the last one of our own lets the printer echo */
    bool temperatures, reports; /* somebody has asked for them by M105, by M155 */
    int64_t complaints;         /* answers that say that a command was not done */
    double said_since;          /* when the first complaint of a while was said… */
    int said;                   /* … how many were, */
    int64_t unsaid;             /* and how many more there are */
} fio_narrator;

void fio_narrator_open(fio_narrator *narrator, const fio_arguments *arguments);

/* From here on times count. */
void fio_narrator_start(fio_narrator *narrator, double now, const char *port,
                        const fio_source_summary *whole, const char *file);

void fio_narrator_event(fio_narrator *narrator, const fio_stream_event *event);

/* At least every second: progress, and what waits to be written. */
void fio_narrator_update(fio_narrator *narrator, double now, const fio_stream_report *report);

/* The end of a job or a console. `resume`: the command to go on with; "" if there is none. */
void fio_narrator_end(fio_narrator *narrator, fio_status status, const fio_stream_report *report,
                      const char *resume);

/* A note of our own: on the screen and as a "warning". */
void fio_narrator_warn(fio_narrator *narrator, const char *text);

/* Write the object in narrator->json, which was begun and filled. */
void fio_narrator_object(fio_narrator *narrator);

/* Descriptors that wait for room; at most 3. */
int fio_narrator_descriptors(const fio_narrator *narrator, struct pollfd *polls);
void fio_narrator_flush(fio_narrator *narrator);

/* FIO_NOT_WRITTEN if standard output or the log is not whole. */
fio_status fio_narrator_close(fio_narrator *narrator) FIO_MUST_CHECK;

#endif

/* Streaming a job to a firmware: a state machine without a clock, a port or a thread of its own.
 *
 * Bytes from the printer and the time go in, bytes for the printer come out; the source is asked
 * for commands as room appears. Whoever drives it (session.h, a test) passes the time with each
 * call; it never goes back. Nothing allocates after fio_streamer_create().
 *
 * Every command that goes out is numbered, the host's own included, and kept until it is known that
 * the firmware has it: for a firmware that checks numbers, what it executes is the file, each
 * command once and in order. The window is what surely fits: command slots and receive bytes where
 * the firmware tells or is known, else one line. Numbers, not oks, say what has arrived: an ok only
 * opens the window, and the end of a job is believed only when a numbered command after its last
 * one was answered. */
#ifndef FIO_STREAM_STREAMER_H
#define FIO_STREAM_STREAMER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <isoprint/status.h>

#include "protocol/answer.h"
#include "protocol/firmware.h"
#include "protocol/source.h"
#include "protocol/track.h"

typedef struct fio_streamer fio_streamer;

typedef enum fio_stream_state {
    FIO_STREAM_GREETING, /* waiting for the boot, M115, M110 */
    FIO_STREAM_RUNNING,  /* the job, or in a console: commands as they come */
    FIO_STREAM_PAUSING,  /* until the moves under way are made and the position is known */
    FIO_STREAM_PAUSED,
    FIO_STREAM_RESUMING,   /* going back to where the job was */
    FIO_STREAM_FINISHING,  /* all is sent; until it is sure that all has arrived, and is made */
    FIO_STREAM_CANCELLING, /* heaters off, motors on, until that is answered */
    FIO_STREAM_DONE,       /* the end; `status` of the report says which */
    FIO_STREAM_STATES
} fio_stream_state;

typedef struct fio_stream_options {
    const fio_firmware *firmware;     /* NULL: ask it */
    int64_t rate;                     /* bits/s, for timeouts; 0: no wire */
    bool no_greeting;                 /* the firmware is known to listen: no wait for "start" */
    bool no_numbers;                  /* plain lines, one at a time: never exactly once */
    int window_lines, window_bytes;   /* 0: as the firmware tells */
    double greeting_seconds;          /* 0: the firmware's own; then FIO_NO_PRINTER */
    double silence_seconds;           /* without a byte while an answer is due; 0: as is usual */
    double report_seconds;            /* between temperatures: 2 */
    const char *upload;               /* write the job to this file of the SD card, don't run it */
    const char *on_pause, *on_cancel; /* further G-code, parted by '\n'; NULL: none */
    double lift;                      /* mm above the part on pause and cancel: 2 */
    double retract;                   /* mm on pause: 2 */
    bool finish_heaters_off;          /* also at the regular end */
} fio_stream_options;

enum { FIO_STREAM_RUNS = 16 };

/* Commands of the host among those of the job: so many lines from this number on. */
typedef struct fio_stream_run {
    int64_t number, count;
} fio_stream_run;

/* Where an earlier run of this job ended. */
typedef struct fio_stream_resume {
    int64_t accepted; /* commands of the job that the firmware surely has: 0 … this - 1 */
    int64_t sent;     /* commands that went out, >= accepted: whether they arrived is open */
    /* N of the first line that the firmware has not surely got; -1 if it has been reset since, or
     * does not count lines. From there on come the commands of the job, `accepted` first, but for
     * the runs of host commands. So the firmware's "Last Line" tells which command is next. */
    int64_t number;
    int32_t run_count;
    fio_stream_run runs[FIO_STREAM_RUNS];
    int64_t made;         /* commands surely made, <= accepted: where to go on after a reset */
    fio_track track;      /* before the command `accepted`… */
    fio_track track_made; /* …and before the command `made` */
} fio_stream_resume;

typedef enum fio_stream_event_kind {
    FIO_STREAM_STATE,    /* `state` changed */
    FIO_STREAM_FIRMWARE, /* `firmware` is known now */
    FIO_STREAM_ANSWER,   /* `answer` came: temperatures, positions, echoes, actions, everything */
    FIO_STREAM_SENT,     /* `text` went out, for logs */
    FIO_STREAM_MARK, /* before a command of the host goes out: what a journal needs, in `resume` */
    FIO_STREAM_RESEND,  /* the firmware asked for line `number` again */
    FIO_STREAM_WARNING, /* `text`: something was mended, or looks wrong */
    FIO_STREAM_PROMPT,  /* `text`: what a person at the printer is asked; "" ends it */
    FIO_STREAM_EVENTS
} fio_stream_event_kind;

typedef struct fio_stream_event {
    fio_stream_event_kind kind;
    double time;
    fio_stream_state state;
    const fio_firmware *firmware;
    const fio_answer *answer;
    const fio_stream_resume *resume;
    const char *text;
    size_t length;
    int64_t number;
} fio_stream_event;

typedef struct fio_stream_source {
    /* As fio_source_next(). */
    fio_source_result (*next)(void *context, fio_source_command *command);
    /* As fio_source_seek(); NULL: the source can't go back. */
    fio_status (*seek)(void *context, int64_t index);
    void *context;
} fio_stream_source;

typedef struct fio_stream_listener {
    void (*event)(void *context, const fio_stream_event *event); /* NULL: nobody listens */
    void *context;
} fio_stream_listener;

typedef struct fio_stream_report {
    fio_stream_state state;
    fio_status status;      /* of the end: FIO_OK, FIO_FAULTY, FIO_NO_PRINTER, FIO_LINK_LOST, … */
    const char *message;    /* of the end: what happened, where, and what to do; "" */
    int64_t sent, accepted; /* commands of the job */
    int64_t line;           /* of the file, of the last accepted command; 0: none */
    int64_t offset;         /* in bytes, behind it */
    int32_t layer;
    int64_t lines_sent, bytes_sent, resends, repeats; /* on the wire, everything included */
    int64_t lost_answers;                             /* oks that never came */
    double idle; /* s in which the window was open and the source had nothing */
    bool has_temperatures, has_bed;
    double nozzle, nozzle_target, bed, bed_target;
    int percent, minutes_left; /* of M73 in the job; -1 */
    bool heaters_off;          /* confirmed by the firmware after the end */
    fio_stream_resume resume;  /* valid at the end; until then see FIO_STREAM_MARK */
} fio_stream_report;

fio_stream_options fio_stream_options_defaults(void);

/* `source` NULL: a console that runs until fio_streamer_cancel() or _finish(). `resume` NULL: from
 * the beginning. Texts and rows behind pointers must outlive the streamer. */
fio_status fio_streamer_create(fio_streamer **streamer, const fio_stream_options *options,
                               const fio_stream_source *source, const fio_stream_resume *resume,
                               const fio_stream_listener *listener) FIO_MUST_CHECK;
void fio_streamer_free(fio_streamer *streamer); /* NULL is fine */

/* The printer said this. */
void fio_streamer_receive(fio_streamer *streamer, double now, const void *bytes, size_t size);

/* Time passed; also when the source has become readable. */
void fio_streamer_tick(fio_streamer *streamer, double now);

/* When fio_streamer_tick() has to be called at the latest; INFINITY: nothing is waited for. */
double fio_streamer_deadline(const fio_streamer *streamer);

/* What is to be written next: *bytes is valid until the next call. `discard`: an emergency; what
 * the transport still holds has to be forgotten first. */
size_t fio_streamer_output(fio_streamer *streamer, double now, const char **bytes, bool *discard);
void fio_streamer_wrote(fio_streamer *streamer, double now, size_t size);

/* The link is gone; `status` and its message say how. */
void fio_streamer_lost(fio_streamer *streamer, double now, fio_status status, const char *message);

/* What a person, or a signal, wants; each is a request that takes its time, except the emergency
 * stop, which is the next thing on the wire in any state. A request that makes no sense in a state
 * is ignored. */
void fio_streamer_pause(fio_streamer *streamer, double now);
void fio_streamer_resume(fio_streamer *streamer, double now);
void fio_streamer_cancel(fio_streamer *streamer, double now);
void fio_streamer_finish(fio_streamer *streamer, double now); /* of a console */
void fio_streamer_emergency(fio_streamer *streamer, double now);
/* One command by hand, between those of the job; FIO_USAGE if it may not be sent now, or if too
 * many wait already. M108, M112, M410 and M876 go out of band. */
fio_status fio_streamer_command(fio_streamer *streamer, double now,
                                const char *text) FIO_MUST_CHECK;

const fio_stream_report *fio_streamer_report(const fio_streamer *streamer);

#endif

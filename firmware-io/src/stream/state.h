/* The inside of the streamer.
 *
 * Lines are known by their numbers: those up to `accepted` are surely in the firmware, those up to
 * `executed` surely worked at (moves may still be in the planner), those up to `answered` have had
 * an ok as far as oks can be counted, those before `cursor` are on the wire, those before `next`
 * exist. Each line between is kept in a ring. A firmware without numbers is treated alike, save
 * that they stay at home and that oks are believed. */
#ifndef FIO_STREAM_STATE_H
#define FIO_STREAM_STATE_H

#include "protocol/encode.h"
#include "stream/streamer.h"

enum {
    FIO_HISTORY = 1024,          /* lines kept: a power of two */
    FIO_HISTORY_RESERVE = 64,    /* of them for markers and what the host adds */
    FIO_FIRST_NUMBER = 1000,     /* given by M110: a firmware that was reset counts from 0 */
    FIO_FAR_NUMBER = 2000000000, /* no line has it: whoever gets it tells the last one it had */
    FIO_MARKER_LINES = 24,       /* lines between two markers, at least while lines are sent */
    FIO_MARKER_LINES_MOST = 192, /* at most: well below what is kept */
    FIO_HOST_QUEUE = 64,         /* commands of the host that wait */
    FIO_MOVES_KEPT = 256,  /* moves of which it is open whether they are made: a power of two */
    FIO_PROBLEM_MOST = 512 /* bytes of a message */
};

/* Lines after a Resend that go one by one: a firmware that throws away what it has received in the
 * middle of a line that is just coming may take the rest of that for a command without a number. */
#define FIO_CAREFUL_LINES 64
#define FIO_MARKER_SECONDS 1.0       /* between two markers while lines are sent */
#define FIO_MARKER_SECONDS_LEAST 0.1 /* each goes to the journal */
#define FIO_STALL_SECONDS 0.6        /* an ok is overdue */
#define FIO_STALL_PACED 2.5          /* … at most, where oks come slowly anyway */
#define FIO_STALL_MOST 8.0           /* the same, after having asked in vain */
#define FIO_STALL_LONG 5.0           /* … where what is under way may take long, and in the end */
#define FIO_STALL_RARE 30.0
#define FIO_PLAIN_SECONDS                                                                          \
    60.0                         /* silence during usual commands, of a firmware with no heartbeat \
                                  */
#define FIO_LONG_SECONDS 1200.0  /* … and during heating, homing and the like */
#define FIO_USER_SECONDS 14400.0 /* … and while a person is waited for */
#define FIO_END_SECONDS 6.0 /* for the heaters to be off, unless the firmware says it is busy */

typedef struct fio_sent_line {
    int64_t number;
    int64_t index; /* of the job's command; -1: the host's own */
    int64_t line, offset;
    int64_t end; /* bytes of all lines so far, this one included */
    double time; /* when it was written last; INFINITY: not yet */
    unsigned traits;
    int32_t layer;
    uint16_t length;
    bool marker, moved; /* moved: surely takes a block of the planner */
    char wire[FIO_WIRE_LINE_MOST + 1];
    fio_track track; /* before it; of the job's commands */
} fio_sent_line;

typedef enum fio_greeting {
    FIO_GREETING_BOOT,   /* waiting whether it says "start" */
    FIO_GREETING_LAST,   /* it was asked for its last line: the job goes on with the next */
    FIO_GREETING_NUMBER, /* M110 is under way */
    FIO_GREETING_BANNER, /* it does not number: "$I" is under way */
    FIO_GREETING_NAME,   /* M115 is under way */
    FIO_GREETING_SET_UP, /* M155, M28 and what else comes before the job */
    FIO_GREETING_SKIP,   /* reading what was printed before */
    FIO_GREETING_RESTORE /* back to where the job was */
} fio_greeting;

typedef struct fio_host_command {
    uint16_t length;
    bool marker; /* whatever waits, waits for this one */
    char text[FIO_WIRE_LINE_MOST + 1];
} fio_host_command;

typedef struct fio_recovery {
    bool waiting; /* for the answers to what was sent behind the line that is wanted */
    int64_t line; /* wanted */
    double until, quiet;
    int left;          /* lines that may still be answered by a Resend */
    int repeats;       /* of the same line, in sequence */
    int oks;           /* that belong to a Resend, not to a line */
    int64_t last_line; /* of an error; -1 */
    int64_t told;      /* by the last Resend */
    double last_time;
    int doubts; /* a number that can't be was told so many times */
    int64_t doubtful;
    double doubt_time;
    double stall, progress; /* s to wait; the last sign that lines are worked at */
    int stalls;
    int64_t extra;   /* the line that was sent beyond the window after a stall; -1 */
    int64_t careful; /* up to this number lines go one by one */
    bool allow_one;  /* line more than fits the window */
} fio_recovery;

typedef struct fio_pulse {
    double heard, answered, busy, reported; /* when: a byte, an ok, "busy", temperatures */
    bool busy_seen, reports_seen;
    double pace; /* s between two oks: the longest of late */
    double poll; /* when temperatures were asked for last */
    double trip; /* s: the shortest of late from a line to its ok; 0: not known */
    double shortest;
    int samples;
} fio_pulse;

struct fio_streamer {
    fio_stream_options options;
    fio_stream_source source;
    bool has_source, has_resume;
    fio_stream_resume from;
    fio_stream_listener listener;
    fio_firmware firmware;
    fio_answer_parser parser;
    fio_stream_report report;
    char message[FIO_PROBLEM_MOST];
    fio_stream_state state;
    double now, started;
    bool begun;
    bool plain; /* no numbers */

    /* What is being written. */
    char out[2 * FIO_WIRE_LINE_MOST];
    size_t out_length, out_done;
    int64_t out_number; /* -1: no line of the history */
    bool discard;
    char raw[4 * FIO_WIRE_LINE_MOST]; /* out of band: goes before all lines */
    size_t raw_length;

    /* Lines. */
    int64_t next, cursor, answered, accepted, executed, claimed;
    int64_t answered_end, end; /* bytes: of all lines up to `answered`, and of all */
    int32_t run_count;
    fio_stream_run runs[FIO_STREAM_RUNS];
    int64_t moves[FIO_MOVES_KEPT]; /* numbers of executed moves that may not be made */
    unsigned move_first, move_last;
    int64_t unmade;    /* the first line that may have moves in the planner; -1 */
    double planned[4]; /* position up to which moves were surely blocks of the planner */
    bool undrained;    /* moves of an earlier run may still be under way */
    bool renumbered;   /* the numbers the firmware now counts are not those of the job's lines */
    int64_t job_accepted, job_made; /* commands */
    fio_track track, track_made;    /* after all that was sent; before the command `job_made` */

    /* The marker: a command whose answer proves that all before it was executed. */
    int64_t marker, marker_lines; /* the newest; lines behind it */
    double marker_time, marker_answered, temperatures_told;
    bool marker_told;  /* it had its ok */
    bool marker_alone; /* nothing else was under way when it was sent */
    bool probe;        /* one is wanted because an answer is overdue */
    int echoes_missed;
    bool echoes, echo_proved; /* M118 is known */
    int64_t await;            /* its execution brings the next step; -1: nothing is waited for */
    bool await_queued;

    fio_host_command host[FIO_HOST_QUEUE];
    unsigned host_first, host_last;

    /* The job. */
    fio_source_command pending;
    bool has_pending, source_ended, source_dry;
    double dry_since;
    int64_t skip, skip_start; /* commands before `skip` are not sent; from where on they count */
    int64_t job_sent;

    fio_recovery recovery;
    fio_pulse pulse;

    fio_greeting greeting;
    double greeting_until, step_until;
    int attempts, obeyed;
    bool resume_saved; /* in the report, before the numbers were set anew */
    bool started_anew; /* "start" was heard, or the firmware counts from elsewhere */
    bool rubbish, halted;
    int64_t told_last; /* "Last Line" as told once; -1 */
    bool handshaking;  /* an M110 has no ok yet */
    bool named;        /* M115 was answered */
    bool skipped, skipped_anew;

    bool foreign_pause, finishing, ending, emergency, opened_file;
    int end_repeats;
    int emergencies; /* times it was sent */
    double emergency_time, end_started;
    int end_resets;  /* and other reasons to number anew, since it began to end */
    bool end_silent; /* it ends because nothing came any more */
    fio_track paused;
    bool retracted;
    fio_status end_status;

    fio_sent_line lines[FIO_HISTORY];
};

/* streamer.c */
void fio_streamer_say(fio_streamer *streamer, fio_stream_event_kind kind, const char *text,
                      int64_t number);
void fio_streamer_warn(fio_streamer *streamer, const char *format, ...) FIO_PRINTF(2, 3);
void fio_streamer_enter(fio_streamer *streamer, fio_stream_state state);
void fio_streamer_check(fio_streamer *streamer); /* has what is waited for been executed? */

/* history.c */
fio_sent_line *fio_history_line(fio_streamer *streamer, int64_t number); /* NULL: not kept */
void fio_history_restart(fio_streamer *streamer, int64_t last);
bool fio_history_has_room(const fio_streamer *streamer);
/* Number a command and put it on the wire; false if it is too long for the firmware. */
bool fio_history_add(fio_streamer *streamer, const char *text, size_t length,
                     const fio_source_command *job, bool marker);
void fio_history_accept(fio_streamer *streamer, int64_t number);
void fio_history_execute(fio_streamer *streamer, int64_t number);
void fio_history_resume(const fio_streamer *streamer, fio_stream_resume *resume);
/* The command that follows line `last`; -1 if it can't be told. */
int64_t fio_history_index(const fio_stream_resume *resume, int64_t last);

/* window.c */
bool fio_window_open(const fio_streamer *streamer, size_t length);
int64_t fio_window_lines(const fio_streamer *streamer); /* under way */
int64_t fio_window_bytes(const fio_streamer *streamer);
void fio_window_answer(fio_streamer *streamer, const fio_answer *answer); /* an ok */
void fio_window_set(fio_streamer *streamer, int64_t answered);

/* marker.c */
bool fio_marker_due(const fio_streamer *streamer);
double fio_marker_deadline(const fio_streamer *streamer);
size_t fio_marker_text(const fio_streamer *streamer, char *text, size_t capacity);
void fio_marker_sent(fio_streamer *streamer);
bool fio_marker_hear(fio_streamer *streamer, const fio_answer *answer); /* true: it is one's echo */
void fio_marker_answered(fio_streamer *streamer, const fio_answer *answer);

/* feed.c: the next line, if there is one and room for it, is put into `out`. */
bool fio_feed(fio_streamer *streamer);

/* queue.c */
bool fio_queue_command(fio_streamer *streamer, const char *text, size_t length);
void fio_queue_text(fio_streamer *streamer, const char *text);    /* commands parted by '\n' */
void fio_queue_restore(fio_streamer *streamer, const char *text); /* what it knows of this */
void fio_queue_await(fio_streamer *streamer); /* a marker; step follows once it is executed */
void fio_queue_clear(fio_streamer *streamer);
bool fio_queue_is_empty(const fio_streamer *streamer);
int fio_queue_room(const fio_streamer *streamer);
void fio_queue_raw(fio_streamer *streamer, const char *bytes, size_t size);

/* recovery.c */
void fio_recovery_resend(fio_streamer *streamer, int64_t number);
void fio_recovery_tick(fio_streamer *streamer);
double fio_recovery_deadline(const fio_streamer *streamer);
void fio_recovery_progress(fio_streamer *streamer);
bool fio_recovery_take_ok(fio_streamer *streamer); /* true: it belonged to a Resend */
bool fio_recovery_holds(const fio_streamer *streamer);
void fio_recovery_provoke(fio_streamer *streamer);

/* pulse.c */
void fio_pulse_hear(fio_streamer *streamer, const fio_answer *answer);
void fio_pulse_tick(fio_streamer *streamer);
double fio_pulse_deadline(const fio_streamer *streamer);
double fio_pulse_patience(const fio_streamer *streamer); /* s: of lines under way */
double fio_pulse_silence(const fio_streamer *streamer);  /* s: without any byte */

/* handshake.c */
void fio_handshake_begin(fio_streamer *streamer);
void fio_handshake_number(fio_streamer *streamer); /* M110 */
void fio_handshake_tick(fio_streamer *streamer);
double fio_handshake_deadline(const fio_streamer *streamer);
void fio_handshake_hear(fio_streamer *streamer, const fio_answer *answer);
bool fio_handshake_ok(fio_streamer *streamer,
                      const fio_answer *answer); /* true: the ok was its own */
bool fio_handshake_resend(fio_streamer *streamer, int64_t number);
bool fio_handshake_halted(fio_streamer *streamer); /* true: that may have been long ago */
void fio_handshake_step(fio_streamer *streamer);
void fio_handshake_skipped(fio_streamer *streamer);

/* pause.c */
void fio_pause_step(fio_streamer *streamer);
void fio_pause_hear(fio_streamer *streamer, const fio_answer *answer);
void fio_pause_action(fio_streamer *streamer, const fio_answer *answer);

/* ends.c */
void fio_end(fio_streamer *streamer, fio_status status, bool renumber, const char *format, ...)
    FIO_PRINTF(4, 5);
void fio_end_now(fio_streamer *streamer, fio_status status, const char *format, ...)
    FIO_PRINTF(3, 4);
void fio_end_finish(fio_streamer *streamer); /* the job has been sent */
void fio_end_step(fio_streamer *streamer);
void fio_end_again(fio_streamer *streamer); /* lines count anew: what was said is said again */
void fio_end_halted(fio_streamer *streamer, const fio_answer *answer);
void fio_end_tick(fio_streamer *streamer);
double fio_end_deadline(const fio_streamer *streamer);

#endif

/* The inside of the virtual printer. */
#ifndef FIO_VIRTUAL_PRINTER_H
#define FIO_VIRTUAL_PRINTER_H

#include <isoprint/virtual_printer.h>

#include "base/text.h"
#include "virtual/heater.h"
#include "virtual/line.h"
#include "virtual/planner.h"

/* Lines that wait for their place in the log: a power of two. The planner is made to move on before
 * an entry is overwritten, whether there is a log or not, so that a log changes no time. */
enum { FIO_PENDING = 256 };

typedef struct fio_pending {
    fio_executed executed;
    int blocks; /* still in the planner */
    bool started, dropped;
    char text[FIO_LINE_MOST + 1];
} fio_pending;

/* An arc whose chords are still to be planned. */
typedef struct fio_arc {
    double centre[2], radius, growth; /* radius + growth · fraction at a fraction of the way */
    double start_angle, angle;        /* rad; positive is counter-clockwise */
    double start_z, end[3], extrusion, feedrate;
    int chords, next; /* next > chords: none is left */
} fio_arc;

struct fio_virtual_printer {
    fio_virtual_options options;
    fio_limits limits;
    fio_planner planner;
    fio_heater nozzle[FIO_TOOLS_MOST], bed;
    fio_statistics statistics;

    double clock;       /* s; end of the last block taken */
    double machine[3];  /* after all lines read */
    double offset[3];   /* logical = machine + offset */
    double e;           /* logical */
    double angle[3];    /* degrees: A, B, C, after all lines read */
    double turn;        /* degrees that the move being read turns the part; its sign is the largest
                         * one's */
    double inverse;     /* moves a second that F asks for by G93; 0: the line has none */
    double unit_length; /* 1, or 25.4 after G20 */
    bool homed[3], absolute, absolute_extrusion, inverse_time, end_stops, halted, finished;
    bool allow_cold;
    double feedrate, feedrate_percent, flow_percent; /* feedrate 0: none given yet */
    double extrusion_minimum_temperature;
    double fan;
    double firmware_retract[2], firmware_retracted; /* mm now retracted by G10 */
    int tool, progress_percent, minutes_left;
    double parked[FIO_TOOLS_MOST], firmware_parked[FIO_TOOLS_MOST]; /* mm retracted, of the tools
                                                                     * that aren't in use */

    double extrusion_z; /* of the last level extrusion */
    double filament_area;

    int64_t line;        /* being executed: 1 = the first */
    uint32_t line_codes; /* events already told of it */
    int64_t last_number, lost_line;
    fio_reply *reply;
    void *reply_context;

    fio_arc arc;
    bool answered; /* the command's own answer was its ok */

    /* Within a machine time comes from outside: `clock` is now, the oldest block has left the
     * planner and is being made, and a command that takes time is `waiting`. */
    bool live, running, waiting, wait_user, ran_dry;
    fio_block block;
    double block_start, block_end, delayed_start;
    double wait_start, wait_end;
    fio_activity wait_activity;
    fio_heater *wait_heater;
    int64_t starved;
    /* What a machine's firmware does itself: 1 it did, -1 nobody knows this, 0 the printer's. */
    int (*firmware)(void *context, const fio_line *line);
    const char *unknown; /* what is said before an unknown command; NULL: "error:20", no ok */
    void *firmware_context;

    fio_execution_log log;
    int64_t sequence, logged; /* commands executed; of them, logged */
    bool open;                /* command `sequence` is being executed */
    double log_clock;         /* end of the last entry */

    fio_event faults[FIO_EVENTS_KEPT], warnings[FIO_EVENTS_KEPT];
    fio_pending pending[FIO_PENDING];
};

/* event.c: one event of each code a line. `text` may be given in two parts with a number between.
 */
void fio_printer_event(fio_virtual_printer *printer, fio_event_code code, const char *text);
void fio_printer_event_value(fio_virtual_printer *printer, fio_event_code code, const char *before,
                             double value, const char *after);
void fio_printer_say(fio_virtual_printer *printer, const char *text);

/* printer.c: the parts of executing one line. */
void fio_printer_next_line(fio_virtual_printer *printer, fio_reply *reply, void *context);
void fio_printer_begin(fio_virtual_printer *printer, fio_line *line, bool cut);
void fio_printer_reset(fio_virtual_printer *printer); /* what a reset of its processor does */

/* live.c: a printer whose time comes from outside. */
void fio_printer_live(fio_virtual_printer *printer, double now);
/* Make what is made by `now`. */
void fio_printer_advance(fio_virtual_printer *printer, double now);
/* When the block being made ends, or the next one begins; INFINITY: nothing moves. */
double fio_printer_next(const fio_virtual_printer *printer);
/* The planner, as it is now, lets this line be executed without waiting for it. */
bool fio_printer_ready(fio_virtual_printer *printer, const fio_line *line);
void fio_printer_stop(fio_virtual_printer *printer); /* where it is, and forget what is planned */
int fio_printer_moves_free(const fio_virtual_printer *printer);
/* The time of a waiting command is over, at `clock`. */
void fio_printer_end_wait(fio_virtual_printer *printer);
void fio_printer_run_out(fio_virtual_printer *printer); /* make all moves that are planned */
void fio_printer_added(fio_virtual_printer *printer, bool along_path); /* a block to the planner */

/* motion.c */
void fio_printer_spend(fio_virtual_printer *printer, int64_t sequence, double start, double seconds,
                       fio_activity activity);
void fio_printer_block_done(fio_virtual_printer *printer, const fio_block *block);
void fio_printer_know_entry(fio_virtual_printer *printer, bool known);
void fio_printer_start_entry(fio_virtual_printer *printer, const fio_line *line);
void fio_printer_end_entry(fio_virtual_printer *printer);
void fio_printer_drain(fio_virtual_printer *printer);
void fio_printer_abandon(fio_virtual_printer *printer); /* the planner's moves are never made */
/* Drain, then let `seconds` pass. */
void fio_printer_wait(fio_virtual_printer *printer, double seconds, fio_activity activity);
/* Move to machine coordinates and by `extrusion` (before flow_percent), clamped, planned, counted;
 * the part turns as the line being read has it. */
void fio_printer_move(fio_virtual_printer *printer, const double target[3], double extrusion,
                      double feedrate);
void fio_printer_home(fio_virtual_printer *printer, const bool axes[3]);

/* Read X Y Z E F and A B C: the machine target and the extrusion; tells of bad words. */
double fio_printer_target(fio_virtual_printer *printer, const fio_line *line, double target[3]);
double fio_printer_feedrate(const fio_virtual_printer *printer); /* mm/s now */

/* arc.c */
void fio_printer_arc(fio_virtual_printer *printer, const fio_line *line, bool clockwise);
/* Plan the next chord of the arc under way; false if there is none. */
bool fio_printer_next_chord(fio_virtual_printer *printer);

/* command.c */
void fio_printer_temperatures(const fio_virtual_printer *printer, fio_text *text);
void fio_printer_say_position(fio_virtual_printer *printer);
void fio_printer_halt(fio_virtual_printer *printer, const char *why); /* heaters off, mute */

/* command.c, setting.c: false if the command is unknown. */
bool fio_printer_command(fio_virtual_printer *printer, fio_line *line);
bool fio_printer_setting(fio_virtual_printer *printer, const fio_line *line);

#endif

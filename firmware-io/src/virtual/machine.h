/* The inside of a machine: a serial line, a firmware with its buffers, and the printer. */
#ifndef FIO_VIRTUAL_MACHINE_H
#define FIO_VIRTUAL_MACHINE_H

#include <isoprint/machine.h>

#include "virtual/card.h"
#include "virtual/dialect.h"
#include "virtual/meatpack.h"
#include "virtual/packet.h"
#include "virtual/printer.h"
#include "virtual/random.h"
#include "virtual/reader.h"
#include "virtual/script.h"
#include "virtual/wire.h"

enum {
    FIO_RECEIVE_MOST = 4096, /* bytes of the receive buffer: a power of two */
    FIO_SLOTS_MOST = 64,
    FIO_HELD_MOST = 16
};

/* A line that was taken in and waits for its turn. */
typedef struct fio_queued {
    char text[FIO_LINE_MOST + 1];
    int length;
    bool cut;
    bool tainted; /* what the host sent is not what arrived */
    bool silent;  /* no ok: not from the host, or it was said already */
    bool from_card;
} fio_queued;

typedef enum fio_processor {
    FIO_BOOTING,
    FIO_IDLE,
    FIO_WORKING, /* until `until` */
    FIO_BLOCKED, /* until the planner lets the line be executed */
    FIO_CHORDS,  /* of an arc, each needs a place in the planner */
    FIO_WAITING, /* for a heater, a time, a person */
    FIO_HALTED
} fio_processor;

/* An answer that comes late. */
typedef struct fio_late {
    double at;
    size_t length;
    char text[120];
} fio_late;

/* What the script has ordered and is not yet done. */
typedef struct fio_plan {
    bool reset, ok_first, demand_checksums;
    const char *halt; /* the error, NULL: don't */
    double plug_at, silent_until, mute_until, busy_until, throttle;
    double lose_oks, double_oks, late_oks, late_seconds, lose_answers;
    double flip_lines, cut_lines, reject_lines;
    int64_t miscount;
} fio_plan;

/* A transfer of files in packets. */
typedef struct fio_transfer {
    bool on, writing, dummy;
    uint8_t number; /* of the next packet */
    int retries;
    double deadline; /* for the rest of a packet */
    fio_packet packet;
} fio_transfer;

/* What M500 keeps. */
typedef struct fio_settings {
    fio_limits limits;
    double retract[2];
} fio_settings;

/* Of one heater's thermal protection. */
typedef struct fio_watch {
    double target, at, temperature, runaway_at;
    bool stable;
} fio_watch;

struct fio_machine {
    fio_machine_options options;
    const fio_dialect *dialect;
    fio_virtual_printer *printer;
    fio_machine_counts counts;
    double now;
    bool plugged, dtr, rts;
    int64_t host_rate; /* 0: never set, taken to be right */

    fio_wire in, out;
    /* Received and not yet read: the byte, and FIO_TAINT if it is not what was sent there. */
    uint16_t received[FIO_RECEIVE_MOST];
    unsigned received_first, received_last;
    bool lost_before; /* bytes were lost before the next one received */
    bool mid_line;    /* the last byte received was not the end of a line */
    fio_unpacker unpacker;
    fio_reader reader;
    bool line_tainted; /* as a whole: one of its ends is false */
    int taint_at;      /* where its text is damaged first; INT32_MAX: nowhere */
    fio_emergency_parser emergency;
    fio_emergency pending; /* came while the processor hung */

    fio_queued queue[FIO_SLOTS_MOST];
    int queued, oldest;
    fio_line line;  /* of queue[oldest], being executed */
    bool answered;  /* its ok was said before it was executed */
    bool prompting; /* the host was told to ask its user */
    fio_processor processor;
    double until, busy_at, busy_seconds;
    double wait_report_at;
    double temperature_seconds, temperature_at; /* M155; 0: off */
    double position_seconds, position_at;       /* M154 */

    double idle_at; /* when it has had nothing to do for as long as "wait" takes */
    bool quick_reset;
    double card_seconds, card_at; /* M27 S */
    fio_settings defaults, kept;
    bool stored; /* `kept` is valid */
    fio_card card;
    fio_reader card_reader;
    fio_transfer transfer;

    fio_random random;  /* of the faults */
    fio_random reading; /* of how reads are cut: how often the host reads changes no other fault */
    int line_length, last_line_length;  /* bytes of the line now arriving, and of the one before */
    int damage_at, lose_at, lose_count; /* where in it; -1: nowhere */
    bool splitting;                     /* the last read was cut: the next one is not */
    double merged_until;                /* what has arrived is not shown before */
    fio_plan plan;
    fio_script script;
    int64_t bytes_arrived;
    double thermal_at;
    fio_watch watches[FIO_TOOLS_MOST + 1]; /* the last is the bed's */
    int held;
    fio_late late[FIO_HELD_MOST];
};

#define FIO_TAINT 0x100

/* firmware.c, firmware_read.c: do all that is due at `now`. */
void fio_firmware_step(fio_machine *machine);
/* When something is due of itself; INFINITY: nothing. */
double fio_firmware_next(const fio_machine *machine);
void fio_firmware_reset(fio_machine *machine);
void fio_firmware_read(fio_machine *machine); /* bytes received to lines queued */
void fio_firmware_receive(fio_machine *machine, uint8_t byte, bool tainted);
void fio_firmware_lose(fio_machine *machine, uint8_t byte); /* it never came */
bool fio_firmware_may_receive(const fio_machine *machine);  /* there is room */
void fio_firmware_kill(fio_machine *machine, const char *error);
/* Ask for the line that is due, since this one was not it. */
void fio_firmware_reject(fio_machine *machine, fio_line_verdict verdict, const char *text);
/* By the dialect's rules; what is to be said of it is said. */
bool fio_firmware_accepts(fio_machine *machine, const char *text);

/* M108 and the like, or a person at the machine. */
void fio_firmware_emergency(fio_machine *machine, fio_emergency what);

/* machine.c: the cable. What arrived may be read until it is put back. */
void fio_machine_unplug(fio_machine *machine);
void fio_machine_plug_in(fio_machine *machine);

/* script_run.c: the moment has come for the count-th time, or at this time. */
void fio_script_happens(fio_machine *machine, fio_moment moment, double count);
void fio_script_command(fio_machine *machine, const char *text); /* is about to be executed */
double fio_script_next(const fio_machine *machine); /* when time alone makes something happen */
void fio_script_pass(fio_machine *machine);         /* do it, and what could not be done at once */

/* thermal.c */
void fio_thermal_check(fio_machine *machine);
double fio_thermal_next(const fio_machine *machine);

/* firmware_command.c: what the firmware answers without the printer: 1 it did, -1 it knows that
 * there is no such command, 0 it is the printer's. */
int fio_firmware_command(void *machine, const fio_line *line);
void fio_firmware_reports(fio_machine *machine); /* what is due of itself */
double fio_firmware_next_report(const fio_machine *machine);

void fio_firmware_set_interval(const fio_machine *machine, const fio_line *line, double *seconds,
                               double *at);

/* firmware_card.c: false: not a command of the card. */
bool fio_firmware_card(fio_machine *machine, const fio_line *line);
void fio_firmware_say_progress(fio_machine *machine);
void fio_firmware_save_line(fio_machine *machine, const fio_line *line);
bool fio_firmware_card_line(fio_machine *machine); /* the next one is in card_reader */

/* firmware_grbl.c: true: it was one of these. */
bool fio_firmware_real_time(fio_machine *machine, uint8_t byte);
bool fio_firmware_dollar(fio_machine *machine, const char *text);
/* Klipper's, likewise. */
bool fio_firmware_macro(fio_machine *machine, const char *text);

/* firmware_packet.c: M28 B1. */
void fio_firmware_binary(fio_machine *machine);
void fio_firmware_take_packet_byte(fio_machine *machine, uint8_t byte);
void fio_firmware_packet_late(fio_machine *machine); /* the rest of a packet does not come */

/* firmware_setting.c */
bool fio_firmware_setting(fio_machine *machine, int code);
void fio_firmware_keep_defaults(fio_machine *machine);
void fio_firmware_load_settings(fio_machine *machine);

/* firmware_answer.c */
void fio_firmware_say(fio_machine *machine, const char *text);
void fio_firmware_reply(void *machine, const char *text, size_t length);
void fio_firmware_ok(fio_machine *machine);
void fio_firmware_early_ok(fio_machine *machine, const char *text);   /* of a line just read */
void fio_firmware_say_lines(fio_machine *machine, const char *lines); /* parted by '\n'; NULL */

/* fault.c: a byte comes to the end of the wire, an answer goes out. */
void fio_fault_byte(fio_machine *machine, uint8_t byte);
void fio_fault_answer(fio_machine *machine, const char *text, size_t length, bool ok);
/* Keep an answer back; false if there is no room. Those that are due go out by release(). */
bool fio_fault_hold(fio_machine *machine, const char *text, size_t length, double seconds);
double fio_fault_next(const fio_machine *machine);
void fio_fault_release(fio_machine *machine);

#endif

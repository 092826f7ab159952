/* What a firmware says, line by line: any bytes in any pieces become a sequence of answers.
 *
 * Nothing here knows what was asked. Lines end with LF, CR or both; empty ones are no answers. A
 * line longer than FIO_ANSWER_MOST bytes is cut, the rest is skipped and the answer is marked.
 * Bytes that are no text are kept as they are, zeros included. A line that was damaged on the way
 * is FIO_ANSWER_OTHER wherever its form shows it; where damage can't be seen ("ok N5" that was "ok
 * N7") the numbers are wrong, so whoever acts upon them has to be able to doubt them. */
#ifndef FIO_PROTOCOL_ANSWER_H
#define FIO_PROTOCOL_ANSWER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { FIO_ANSWER_MOST = 511, FIO_ANSWER_TOOLS = 8 };

typedef enum fio_answer_kind {
    FIO_ANSWER_OTHER,
    /* "ok", alone or with anything behind a blank. "ok N3 P15 B3", "ok 12" (Repetier), "ok T:…" are
     * read only if all of the line has that form: else the numbers are -1, as for a plain ok. "k",
     * "okk" and "ok12" are none. */
    FIO_ANSWER_OK,
    FIO_ANSWER_RESEND, /* "Resend: 5", "Resend:5", "rs 5", "rs N5", and nothing else: `line` */
    FIO_ANSWER_BUSY,   /* "echo:busy: processing", "busy: …": `busy` */
    FIO_ANSWER_WAIT,   /* "wait": Repetier's, idle and wanting lines */
    /* It booted: "start" (rubbish of the wire before it is forgiven), "Grbl 1.1h […]", "Smoothie",
     * "Marlin 2.1…", "RepRapFirmware for …" alone, "// Klipper state: Ready". Several may follow
     * one reset. */
    FIO_ANSWER_START,
    FIO_ANSWER_ERROR, /* "Error:…", "error:…", "!! …": `line` if it names the last line */
    /* "Error:Printer halted. kill() called!", "… system stopped!", "// Klipper state: Shutdown",
     * "ALARM:1", "Emergency Stop! …", "fatal:…": it does nothing any more until it is reset. */
    FIO_ANSWER_HALTED,
    FIO_ANSWER_ACTION,       /* "//action:…", "// action:…": `rest` is what follows */
    FIO_ANSWER_TEMPERATURES, /* " T:20.1 /0.0 B:…" of itself */
    FIO_ANSWER_POSITION,     /* "X:0.00 Y:0.00 Z:0.00 E:0.00 Count …" */
    FIO_ANSWER_FIRMWARE,     /* "FIRMWARE_NAME:…", "[VER:…]" */
    FIO_ANSWER_CAPABILITY,   /* "Cap:NAME:1": `rest` is "NAME", `line` its value */
    FIO_ANSWER_SD, /* "SD printing byte 12/345" (`line` = 12), "File opened: …", "Done …" … */
    FIO_ANSWER_ECHO,      /* "echo:…" of any other sort, "// …" */
    FIO_ANSWER_PREVENTED, /* "echo:Unknown command: …", "cold extrusion prevented" and the like */
    FIO_ANSWER_KINDS
} fio_answer_kind;

typedef enum fio_busy {
    FIO_BUSY_PROCESSING, /* or anything but the two below */
    FIO_BUSY_PAUSED_FOR_USER,
    FIO_BUSY_PAUSED_FOR_INPUT
} fio_busy;

typedef struct fio_answer {
    fio_answer_kind kind;
    const char *text; /* the whole line without its end; valid until the next call of the parser */
    size_t length;
    const char *rest; /* the part after the word that told the kind, within `text` */
    size_t rest_length;
    bool cut;
    int64_t line;      /* N of an ok, a Resend, "Last Line: n"; -1 if it names none */
    int planner_free;  /* P of an ok; -1 */
    int commands_free; /* B of an ok; -1 */
    fio_busy busy;
    /* Temperatures, also of "ok T:…", °C; a target that is not told is -1. Bit t of `nozzles`: Tt
     * was there. A T alone is the active tool's and counts as T0 unless there is a T0. */
    bool has_temperatures, has_bed;
    uint32_t nozzles;
    double nozzle[FIO_ANSWER_TOOLS], nozzle_target[FIO_ANSWER_TOOLS], bed, bed_target;
    double position[4]; /* of FIO_ANSWER_POSITION, as told; E 0 if it is not told */
} fio_answer;

typedef void fio_answer_taker(void *context, const fio_answer *answer);

typedef struct fio_answer_parser {
    char line[FIO_ANSWER_MOST + 1];
    int length;
    bool cut;
} fio_answer_parser;

void fio_answer_parser_reset(fio_answer_parser *parser);

/* Take all of `size` bytes; `taker` is called once for every line that became whole, with a text
 * that ends with a 0. */
void fio_answer_parser_feed(fio_answer_parser *parser, const void *bytes, size_t size,
                            fio_answer_taker *taker, void *context);

/* One whole line, with or without its end. *answer points into `line`. */
void fio_answer_read(fio_answer *answer, const char *line, size_t length);

/* Whether `rest` is this: fio_answer_says(answer, "AUTOREPORT_TEMP"). */
bool fio_answer_says(const fio_answer *answer, const char *text);

#endif

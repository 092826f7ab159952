/* What a firmware says, line by line: any bytes in any pieces become a sequence of answers.
 *
 * Nothing here knows what was asked. Lines end with LF, CR or both; a line longer than
 * FIO_ANSWER_MOST bytes is cut, the rest is skipped and the answer is marked. Bytes that are no
 * text are kept as they are. An answer that was damaged on the way is `FIO_ANSWER_OTHER`; the
 * numbers of one that was only partly damaged may be wrong, so whoever acts upon them has to be
 * able to doubt them. */
#ifndef FIO_PROTOCOL_ANSWER_H
#define FIO_PROTOCOL_ANSWER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { FIO_ANSWER_MOST = 511, FIO_ANSWER_TOOLS = 8 };

typedef enum fio_answer_kind {
    FIO_ANSWER_OTHER,
    FIO_ANSWER_OK,     /* "ok", "ok N3 P15 B3", "ok T:…", "ok 12" (Repetier), "k" is none */
    FIO_ANSWER_RESEND, /* "Resend: 5", "Resend:5", "rs 5", "rs N5" : `line` */
    FIO_ANSWER_BUSY,   /* "echo:busy: processing", "busy: …": `busy` */
    FIO_ANSWER_WAIT,   /* "wait": Repetier's, idle and wanting lines */
    FIO_ANSWER_START, /* "start", "Grbl 1.1h […]", "Smoothie", "Marlin 2.1…" alone: it booted */
    FIO_ANSWER_ERROR, /* "Error:…", "error:…", "!! …": `line` if it names the last line */
    FIO_ANSWER_HALTED, /* "Error:Printer halted. kill() called!", "!! …" of a dead one, "Alarm" */
    FIO_ANSWER_ACTION, /* "//action:…", "// action:…": `rest` is what follows */
    FIO_ANSWER_TEMPERATURES, /* " T:20.1 /0.0 B:…" of itself, `ok` false */
    FIO_ANSWER_POSITION,     /* "X:0.00 Y:0.00 Z:0.00 E:0.00 Count …" */
    FIO_ANSWER_FIRMWARE,     /* "FIRMWARE_NAME:…" */
    FIO_ANSWER_CAPABILITY,   /* "Cap:NAME:1": `rest` is "NAME", `line` its value */
    FIO_ANSWER_SD,   /* "SD printing byte 12/345", "File opened: …", "Done printing file" … */
    FIO_ANSWER_ECHO, /* "echo:…" of any other sort */
    FIO_ANSWER_PREVENTED, /* "echo:Unknown command: …", "cold extrusion prevented" and the like */
    FIO_ANSWER_KINDS
} fio_answer_kind;

typedef enum fio_busy {
    FIO_BUSY_PROCESSING,
    FIO_BUSY_PAUSED_FOR_USER,
    FIO_BUSY_PAUSED_FOR_INPUT
} fio_busy;

typedef struct fio_answer {
    fio_answer_kind kind;
    const char *text; /* the whole line, ends with a 0; valid until the next call of the parser */
    size_t length;
    const char *rest; /* the part after the word that told the kind, within `text` */
    bool cut;
    int64_t line;      /* N of an ok, a Resend, "Last Line: n"; -1 if it names none */
    int planner_free;  /* P of an ok; -1 */
    int commands_free; /* B of an ok; -1 */
    fio_busy busy;
    /* Temperatures, also of "ok T:…". Bit t of `nozzles`: T or Tt was there. */
    bool has_temperatures, has_bed;
    uint32_t nozzles;
    double nozzle[FIO_ANSWER_TOOLS], nozzle_target[FIO_ANSWER_TOOLS], bed, bed_target;
    double position[4]; /* of FIO_ANSWER_POSITION */
} fio_answer;

typedef void fio_answer_taker(void *context, const fio_answer *answer);

typedef struct fio_answer_parser {
    char line[FIO_ANSWER_MOST + 1];
    int length;
    bool cut, escaped;
} fio_answer_parser;

void fio_answer_parser_reset(fio_answer_parser *parser);

/* Take all of `size` bytes; `taker` is called once for every line that became whole. */
void fio_answer_parser_feed(fio_answer_parser *parser, const void *bytes, size_t size,
                            fio_answer_taker *taker, void *context);

/* One whole line, with or without its end. *answer points into `line`, which ends with a 0. */
void fio_answer_read(fio_answer *answer, const char *line, size_t length);

#endif

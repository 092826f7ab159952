/* A script of what goes wrong and when, read into a table of fixed size. docs/virtual-printer.md
 * describes the language. */
#ifndef FIO_VIRTUAL_SCRIPT_H
#define FIO_VIRTUAL_SCRIPT_H

#include <stdbool.h>
#include <stdint.h>

#include <isoprint/status.h>

enum { FIO_SCRIPT_STEPS = 128, FIO_SCRIPT_TEXT = 8192 };

typedef enum fio_moment {
    FIO_AT_TIME,    /* s */
    FIO_AT_LINE,    /* the n-th line that arrives, good or bad */
    FIO_AT_NUMBER,  /* the line with this number is accepted */
    FIO_AT_BYTE,    /* the n-th byte arrives */
    FIO_AT_OK,      /* before the n-th ok */
    FIO_AT_COMMAND, /* a line that begins so is about to be executed */
    FIO_MOMENTS
} fio_moment;

typedef enum fio_deed {
    FIO_DO_RESET,
    FIO_DO_UNPLUG, /* for `value` s; 0: until it is plugged in */
    FIO_DO_PLUG,
    FIO_DO_HALT, /* text: the error */
    FIO_DO_SILENT,
    FIO_DO_MUTE,
    FIO_DO_BUSY,
    FIO_DO_THROTTLE,
    FIO_DO_ANSWER, /* text */
    FIO_DO_ACTION, /* text */
    FIO_DO_LOSE_OK,
    FIO_DO_DOUBLE_OK,
    FIO_DO_LATE_OK,
    FIO_DO_LOSE_ANSWER,
    FIO_DO_FLIP_LINE,
    FIO_DO_CUT_LINE,
    FIO_DO_REJECT,
    FIO_DO_RESEND,
    FIO_DO_MISCOUNT,
    FIO_DO_FORGET,
    FIO_DO_DEMAND, /* from now on no line without number and checksum is taken */
    FIO_DO_RELAX,
    FIO_DO_OK_FIRST,
    FIO_DO_OK_LAST,
    FIO_DO_PRESS,
    FIO_DO_NOZZLE_DEAD,
    FIO_DO_NOZZLE_STUCK,
    FIO_DO_NOZZLE_WELL,
    FIO_DO_NOZZLE_OPEN,
    FIO_DO_NOZZLE_SHORT,
    FIO_DO_BED_DEAD,
    FIO_DO_BED_STUCK,
    FIO_DO_BED_WELL,
    FIO_DO_BED_OPEN,
    FIO_DO_BED_SHORT,
    FIO_DO_FLIP_IN, /* the first of the probabilities, in the order of fio_machine_faults */
    FIO_DO_FLIP_OUT,
    FIO_DO_FLIP_BYTES,
    FIO_DO_LOSE_BYTES,
    FIO_DO_LOSE_OKS,
    FIO_DO_DOUBLE_OKS,
    FIO_DO_LATE_OKS,
    FIO_DO_SPLIT,
    FIO_DO_MERGE,
    FIO_DEEDS
} fio_deed;

typedef struct fio_script_step {
    fio_moment moment;
    fio_deed deed;
    double at;    /* the next time it is due; INFINITY: never again */
    double every; /* 0: once */
    double value;
    int text;    /* in the script's texts; -1 */
    int command; /* the same, of FIO_AT_COMMAND */
} fio_script_step;

typedef struct fio_script {
    int count, used;
    uint32_t moments; /* bit m: there is a step that waits for moment m */
    fio_script_step steps[FIO_SCRIPT_STEPS];
    char texts[FIO_SCRIPT_TEXT];
} fio_script;

/* FIO_USAGE: the message says line, column, and what is expected there. */
fio_status fio_script_read(fio_script *script, const char *text) FIO_MUST_CHECK;

#endif

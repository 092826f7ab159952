/* How firmwares other than Marlin put what they say, and how they check what they are told. */
#ifndef FIO_VIRTUAL_DIALECT_H
#define FIO_VIRTUAL_DIALECT_H

#include <stdbool.h>

typedef enum fio_numbering {
    FIO_NUMBERS_MARLIN,   /* in sequence, with a checksum; the last two again are passed over */
    FIO_NUMBERS_STRICT,   /* the same, but nothing is passed over */
    FIO_NUMBERS_REPETIER, /* the last forty again are passed over, and told of */
    FIO_NUMBERS_SUMS,     /* only checksums are looked at */
    FIO_NUMBERS_IGNORED
} fio_numbering;

typedef struct fio_dialect {
    const char *name;
    const char *banner;   /* after a reset; lines parted by '\n' */
    const char *identity; /* FIRMWARE_NAME of M115; lines */
    fio_numbering numbering;
    const char *resend;  /* what stands before the number wanted; NULL: not a word */
    bool resend_errors;  /* an error message comes before it … */
    bool resend_ok;      /* … and an ok after it */
    bool numbers_ok;     /* "ok 5" */
    bool early_ok;       /* when the line was read, not when it was executed */
    const char *busy;    /* NULL: says nothing while it works */
    double wait_seconds; /* "wait" when there was nothing to do for so long; 0: never */
    bool out_of_band;    /* M112 acts at once, if the option allows it */
    bool capabilities;   /* M115 lists them */
    bool ok_last;        /* M115 is one line that begins with ok */
    const char *unknown; /* what stands before an unknown command; NULL: an error code instead */
    const char *killed;  /* what it says when it stops for good; lines */
    const char *dead;    /* what it says to each line afterwards; NULL: nothing */
} fio_dialect;

const fio_dialect *fio_dialect_find(const char *name); /* NULL: there is none */

#endif

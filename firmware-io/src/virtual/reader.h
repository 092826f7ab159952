/* Bytes to lines, as Marlin's queue reads them. */
#ifndef FIO_VIRTUAL_READER_H
#define FIO_VIRTUAL_READER_H

#include <stdbool.h>

#include <isoprint/virtual_printer.h>

typedef struct fio_reader {
    char text[FIO_LINE_MOST + 1]; /* ends with a 0 once the line is whole */
    int length;
    bool over; /* the rest of the line is passed over: a comment, or too much */
    bool cut, escaped;
    bool done; /* the next byte begins a new line */
} fio_reader;

/* True if a line became whole that is not empty. */
bool fio_reader_feed(fio_reader *reader, char c);

/* Emergency commands, found in the raw bytes before anything is read: M108, M112, M410, M876 Sn. */
typedef enum fio_emergency {
    FIO_EMERGENCY_NONE,
    FIO_EMERGENCY_BREAK,  /* M108 */
    FIO_EMERGENCY_KILL,   /* M112 */
    FIO_EMERGENCY_STOP,   /* M410 */
    FIO_EMERGENCY_ANSWER, /* M876: `choice` */
} fio_emergency;

typedef struct fio_emergency_parser {
    int state, choice;
} fio_emergency_parser;

fio_emergency fio_emergency_feed(fio_emergency_parser *parser, char c);

#endif

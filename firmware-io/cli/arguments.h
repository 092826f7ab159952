/* The command line, read into one struct. */
#ifndef FIO_CLI_ARGUMENTS_H
#define FIO_CLI_ARGUMENTS_H

#include <stdbool.h>
#include <stdint.h>

#include <isoprint/status.h>

typedef enum fio_work {
    FIO_WORK_PRINT,
    FIO_WORK_UPLOAD,
    FIO_WORK_CHECK, /* --dry-run */
    FIO_WORK_SEND,
    FIO_WORK_CONSOLE,
    FIO_WORK_LIST,
    FIO_WORK_HELP,
    FIO_WORK_VERSION,
    FIO_WORK_MAN
} fio_work;

enum { FIO_SENDS_MOST = 64 };

/* Texts are borrowed from argv or the environment; NULL if not given. */
typedef struct fio_arguments {
    fio_work work;
    const char *file; /* "-": standard input */
    const char *port, *firmware, *journal, *resume_from, *on_pause, *on_cancel, *upload, *log,
        *virtual_options;
    const char *send[FIO_SENDS_MOST];
    int send_count;
    int64_t baud; /* bits/s; 0: auto */
    double wait;  /* s */
    int window_lines, window_bytes;
    double bed[3]; /* mm; 0: not given */
    bool probe, no_reset, heaters_off, start, json, quiet, yes;
    bool baud_given;
} fio_arguments;

/* FIO_USAGE with a message that names the argument. Changes nothing of argv. */
fio_status fio_arguments_read(fio_arguments *arguments, int argc, char **argv) FIO_MUST_CHECK;

typedef struct fio_flag_info {
    const char *name; /* '_' stands for '-'; NULL: `help` is the title of the flags behind it */
    char letter;
    const char *argument, *range, *help;
} fio_flag_info;

int fio_flag_count(void);
const fio_flag_info *fio_flag_at(int flag);

/* Print the help, the version or the manual page to standard output. */
void fio_page_print(fio_work work);

#endif

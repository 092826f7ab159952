/* What isoprint-virtual says about a run. */
#ifndef FIO_CLI_REPORT_H
#define FIO_CLI_REPORT_H

#include <stdio.h>

#include <isoprint/machine.h>

typedef struct report_subject {
    const char *name; /* the file, or what it stood at the far end of */
    const fio_virtual_printer *printer;
    const fio_machine *machine;       /* NULL: lines went straight into the printer */
    int bound_first, bound_now;       /* interfaces that Linux' driver had, and has */
    const char *check, *check_result; /* the file of --check, what differs; NULL */
    bool quiet;                       /* no summary */
} report_subject;

/* The summary to standard output, as text or JSON; with text, "name:line: fault outside: …", one
 * line for each kept fault and warning, to standard error. FIO_NOT_WRITTEN. */
fio_status report_write(const report_subject *subject, bool json) FIO_MUST_CHECK;

/* One line of the execution log: number of the line, start, duration, x, y, z, e, command, parted
 * by tabs. The context is the FILE. */
void report_log_entry(void *context, const fio_executed *executed);

#endif

/* What isoprint-virtual says about a run. */
#ifndef FIO_CLI_REPORT_H
#define FIO_CLI_REPORT_H

#include <stdio.h>

#include <isoprint/virtual_printer.h>

void report_summary(FILE *out, const char *name, const fio_virtual_printer *printer);
void report_json(FILE *out, const char *name, const fio_virtual_printer *printer);

/* "name:line: fault outside: …", one line for each kept fault and warning. */
void report_events(FILE *out, const char *name, const fio_virtual_printer *printer);

/* One line of the execution log: number of the line, start, duration, x, y, z, e, command, parted
 * by tabs. The context is the FILE. */
void report_log_entry(void *context, const fio_executed *executed);

#endif

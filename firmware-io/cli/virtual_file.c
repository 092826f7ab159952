#include "virtual_file.h"

#include <errno.h>
#include <string.h>

#include "report.h"

/* Line by line through a buffer. Of a line longer than the buffer the rest is passed over: the
 * firmware keeps but its first FIO_LINE_MOST bytes anyway. */
static fio_status run(fio_virtual_printer *printer, FILE *in, const char *name) {
    static char buffer[1 << 20];
    size_t held = 0, got;
    bool skipping = false; /* the rest of such a line */
    errno = 0;
    while ((got = fread(buffer + held, 1, sizeof buffer - held, in)) > 0) {
        size_t length = held + got, start = 0;
        for (char *stop; (stop = memchr(buffer + start, '\n', length - start));) {
            size_t next = (size_t)(stop - buffer) + 1;
            fio_status status = FIO_OK;
            if (!skipping)
                status =
                    fio_virtual_printer_execute(printer, buffer + start, next - start, NULL, NULL);
            if (status != FIO_OK && status != FIO_REJECTED)
                return status;
            skipping = false;
            start = next;
        }
        held = length - start;
        memmove(buffer, buffer + start, held);
        if (held == sizeof buffer || (skipping && held)) {
            fio_status status = FIO_OK;
            if (!skipping)
                status = fio_virtual_printer_execute(printer, buffer, held, NULL, NULL);
            if (status != FIO_OK && status != FIO_REJECTED)
                return status;
            skipping = true;
            held = 0;
        }
    }
    if (ferror(in))
        return fio_fail(FIO_UNREADABLE, "%s: can't be read: %s", name, strerror(errno));
    fio_status status = FIO_OK;
    if (held > 0 && !skipping)
        status = fio_virtual_printer_execute(printer, buffer, held, NULL, NULL);
    if (status != FIO_OK && status != FIO_REJECTED)
        return status;
    if (fio_virtual_printer_statistics(printer)->commands == 0)
        return fio_fail(FIO_UNREADABLE, "%s: there is no command in it", name);
    return FIO_OK;
}

static fio_status run_and_report(const virtual_arguments *given, FILE *in,
                                 const fio_execution_log *log, const char *name) {
    fio_virtual_printer *printer = NULL;
    fio_status status = fio_virtual_printer_create(&printer, &given->machine.printer, log);
    if (status == FIO_OK)
        status = run(printer, in, name);
    if (status == FIO_OK) {
        fio_status verdict = fio_virtual_printer_finish(printer);
        const report_subject subject = {.name = name, .printer = printer, .quiet = given->quiet};
        status = report_write(&subject, given->json);
        if (status == FIO_OK)
            status = verdict;
    }
    fio_virtual_printer_free(printer);
    return status;
}

fio_status virtual_file_run(const virtual_arguments *given, const fio_execution_log *log) {
    bool standard = !strcmp(given->run, "-");
    const char *name = standard ? "standard input" : given->run;
    FILE *in = standard ? stdin : fopen(given->run, "rb");
    if (!in)
        return fio_fail(FIO_UNREADABLE, "%s: can't be opened: %s", name, strerror(errno));
    fio_status status = run_and_report(given, in, log, name);
    if (!standard)
        fclose(in);
    return status;
}

/* isoprint-virtual: a printer that exists only in memory, and says what happened to it. */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "report.h"
#include "standin/mock.h"
#include "virtual_check.h"
#include "virtual_file.h"
#include "virtual_options.h"
#include "virtual_serve.h"

typedef struct logs {
    FILE *log, *executed;
    virtual_check *check;
} logs;

static void on_executed(void *context, const fio_executed *executed) {
    logs *to = context;
    if (to->log)
        report_log_entry(to->log, executed);
    if (to->executed) {
        fwrite(executed->text, 1, executed->length, to->executed);
        fputc('\n', to->executed);
    }
}

static void on_executed_checked(void *context, const fio_executed *executed) {
    logs *to = context;
    on_executed(context, executed);
    virtual_check_entry(to->check, executed);
}

/* `followed`: each line is to be seen at once, by whoever watches a printer at work. */
static fio_status open_log(FILE **log, const char *path, bool followed) {
    *log = path ? fopen(path, "wbe") : NULL;
    if (*log && followed)
        setvbuf(*log, NULL, _IOLBF, BUFSIZ);
    return path && !*log
               ? fio_fail(FIO_NOT_WRITTEN, "%s: can't be written: %s", path, strerror(errno))
               : FIO_OK;
}

static fio_status close_log(FILE *log, const char *path, fio_status status) {
    bool lost = log && ferror(log);
    if (log && (fclose(log) || lost) && (status == FIO_OK || status == FIO_FAULTY))
        return fio_fail(FIO_NOT_WRITTEN, "%s: could not be written whole", path);
    return status;
}

static fio_status run_file(const virtual_arguments *given, logs *to) {
    const fio_execution_log log = {to->check ? on_executed_checked : on_executed, to};
    fio_status status = virtual_file_run(given, &log);
    const char *differs = to->check ? virtual_check_result(to->check) : NULL;
    if (differs && (status == FIO_OK || status == FIO_FAULTY))
        return fio_fail(FIO_FAULTY, "%s: %s", given->check, differs);
    return status;
}

static fio_status run(const virtual_arguments *given, int *code) {
    logs to = {NULL, NULL, NULL};
    fio_status status = open_log(&to.log, given->log, !given->run);
    if (status == FIO_OK)
        status = open_log(&to.executed, given->executed, !given->run);
    if (status == FIO_OK && given->check)
        status = virtual_check_open(&to.check, given->check, given->host_commands);
    const fio_execution_log log = {on_executed, &to};
    if (status == FIO_OK)
        status = given->run ? run_file(given, &to) : virtual_serve(given, &log, to.check, code);
    virtual_check_close(to.check);
    status = close_log(to.log, given->log, status);
    return close_log(to.executed, given->executed, status);
}

int main(int argc, char **argv) {
    virtual_arguments given;
    int code = 0;
    fio_status status = argc > 0 ? virtual_arguments_read(&given, argv) : FIO_USAGE;
    if (status == FIO_OK && !given.done && given.usb)
        status = fio_mock_preload(argv);
    if (status == FIO_OK && !given.done)
        status = run(&given, &code);
    if (status != FIO_OK)
        fprintf(stderr, "isoprint-virtual: %s\n", fio_error_message());
    if (status == FIO_USAGE)
        fputs("Try isoprint-virtual --help.\n", stderr);
    return code ? code : (int)status;
}

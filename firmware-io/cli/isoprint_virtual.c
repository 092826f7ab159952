/* isoprint-virtual: run a G-code file through the virtual printer. */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include <isoprint/virtual_printer.h>

#include "base/number.h"
#include "report.h"

static const char help[] =
    "isoprint-virtual --run FILE [options]\n"
    "Run a G-code file ('-': standard input) on a virtual Marlin printer and say what happened.\n"
    "\n"
    "  --run FILE        the G-code\n"
    "  --bed XxYxZ       size of the volume in mm (250x210x210)\n"
    "  --origin X,Y,Z    its lowest corner (0,0,0)\n"
    "  --filament MM     diameter of the filament (1.75)\n"
    "  --max-flow MM3    warn above this flow in mm3/s (15)\n"
    "  --max-nozzle C    hottest nozzle allowed (285)\n"
    "  --classic-jerk    corners by jerk instead of junction deviation\n"
    "  --log FILE        write each executed line with its time and position\n"
    "  --json            write the summary as JSON\n"
    "  --help, --version\n"
    "\n"
    "Exit codes: 0 no fault, 2 usage, 3 unreadable, 7 output not written, 8 faults.\n";

typedef struct arguments {
    const char *run, *log;
    bool json, done;
    fio_virtual_options options;
} arguments;

/* `count` numbers parted by the character `between`, and nothing else. */
static bool read_numbers(double *values, int count, char between, const char *text) {
    const char *end = text + strlen(text);
    for (int i = 0; i < count; i++) {
        const char *after = fio_number_read(&values[i], text, end);
        if (after == text || (i < count - 1 && *after != between))
            return false;
        text = i < count - 1 ? after + 1 : after;
    }
    return text == end;
}

/* The value of a "--name value" or "--name=value" option; NULL if arg is not this option. */
static const char *value_of(const char *name, char **argv, int *i) {
    size_t length = strlen(name);
    if (strncmp(argv[*i], name, length) != 0)
        return NULL;
    if (argv[*i][length] == '=')
        return argv[*i] + length + 1;
    if (argv[*i][length] == 0)
        return argv[*i + 1] ? argv[++*i] : "";
    return NULL;
}

static bool read_option(arguments *given, char **argv, int *i) {
    fio_virtual_options *options = &given->options;
    const struct {
        const char *name;
        double *values;
        int count;
        char between;
    } numeric[] = {
        {"--bed", options->size, 3, 'x'},
        {"--origin", options->origin, 3, ','},
        {"--filament", &options->filament_diameter, 1, 0},
        {"--max-flow", &options->maximum_flow, 1, 0},
        {"--max-nozzle", &options->nozzle.maximum, 1, 0},
    };
    const char *value;
    for (size_t k = 0; k < sizeof numeric / sizeof *numeric; k++)
        if ((value = value_of(numeric[k].name, argv, i)))
            return read_numbers(numeric[k].values, numeric[k].count, numeric[k].between, value);
    if ((value = value_of("--run", argv, i)))
        return *(given->run = value) != 0;
    if ((value = value_of("--log", argv, i)))
        return *(given->log = value) != 0;
    if (!strcmp(argv[*i], "--json"))
        return given->json = true;
    if (!strcmp(argv[*i], "--classic-jerk"))
        return options->classic_jerk = true;
    return false;
}

static fio_status read_arguments(arguments *given, char **argv) {
    *given = (arguments){.options = fio_virtual_options_defaults()};
    for (int i = 1; argv[i]; i++) {
        if (!strcmp(argv[i], "--help") || !strcmp(argv[i], "--version")) {
            fputs(argv[i][2] == 'h' ? help : "isoprint-virtual " FIO_VERSION "\n", stdout);
            given->done = true;
            return FIO_OK;
        }
        int at = i;
        if (!read_option(given, argv, &i))
            return fio_fail(FIO_USAGE, "%s: no such option, or a value it can't have", argv[at]);
    }
    if (!given->run)
        return fio_fail(FIO_USAGE, "which file? Give it with --run FILE");
    return FIO_OK;
}

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

static fio_status report(const arguments *given, const char *name,
                         const fio_virtual_printer *printer) {
    if (given->json)
        report_json(stdout, name, printer);
    else
        report_summary(stdout, name, printer);
    if (fflush(stdout) || ferror(stdout))
        return fio_fail(FIO_NOT_WRITTEN, "the summary could not be written");
    if (!given->json)
        report_events(stderr, name, printer);
    return FIO_OK;
}

static fio_status run_and_report(const arguments *given, FILE *in, FILE *log, const char *name) {
    fio_virtual_printer *printer = NULL;
    fio_execution_log sink = {log ? report_log_entry : NULL, log};
    fio_status status = fio_virtual_printer_create(&printer, &given->options, &sink);
    if (status == FIO_OK)
        status = run(printer, in, name);
    if (status == FIO_OK) {
        fio_status verdict = fio_virtual_printer_finish(printer);
        status = report(given, name, printer);
        if (status == FIO_OK)
            status = verdict;
    }
    fio_virtual_printer_free(printer);
    return status;
}

static fio_status open_and_run(const arguments *given) {
    bool standard = !strcmp(given->run, "-");
    const char *name = standard ? "standard input" : given->run;
    FILE *in = standard ? stdin : fopen(given->run, "rb");
    if (!in)
        return fio_fail(FIO_UNREADABLE, "%s: can't be opened: %s", name, strerror(errno));
    FILE *log = given->log ? fopen(given->log, "wb") : NULL;
    fio_status status = FIO_OK;
    if (given->log && !log)
        status = fio_fail(FIO_NOT_WRITTEN, "%s: can't be written: %s", given->log, strerror(errno));
    else
        status = run_and_report(given, in, log, name);
    if (!standard)
        fclose(in);
    bool lost = log && ferror(log);
    if (log && (fclose(log) || lost) && (status == FIO_OK || status == FIO_FAULTY))
        status = fio_fail(FIO_NOT_WRITTEN, "%s: could not be written whole", given->log);
    return status;
}

int main(int argc, char **argv) {
    arguments given;
    fio_status status = argc > 0 ? read_arguments(&given, argv) : FIO_USAGE;
    if (status == FIO_OK && !given.done)
        status = open_and_run(&given);
    if (status != FIO_OK)
        fprintf(stderr, "isoprint-virtual: %s\n", fio_error_message());
    if (status == FIO_USAGE)
        fputs("Try isoprint-virtual --help.\n", stderr);
    return (int)status;
}

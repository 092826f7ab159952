#include "check.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include <isoprint/virtual_printer.h>

#include "job.h"
#include "signals.h"

enum { SHOWN_MOST = 10 }; /* of each kind, to a person */

/* A printer hotter and larger than any, where nothing is known of the one it is for. */
static fio_virtual_options options_of(const fio_arguments *arguments) {
    fio_virtual_options options = fio_virtual_options_defaults();
    for (int i = 0; i < 3; i++)
        options.size[i] = arguments->bed[0] > 0 ? arguments->bed[i] : 10000;
    options.nozzle.maximum = 500;
    options.nozzle.full_power = 600;
    options.bed.maximum = 200;
    options.bed.full_power = 250;
    options.tools = FIO_TOOLS_MOST;
    return options;
}

/* Empty lines for what the source leaves out, so that faults have the file's own line numbers. */
static fio_status execute(fio_virtual_printer *printer, fio_job *job) {
    fio_source_command command;
    fio_source_result result = FIO_SOURCE_END;
    fio_status status = FIO_OK;
    int64_t line = 1;
    while (status == FIO_OK && (result = fio_job_next(job, &command)) != FIO_SOURCE_END) {
        if (result == FIO_SOURCE_FAILED)
            return job->failure;
        if (result == FIO_SOURCE_LATER) {
            struct pollfd input = {fio_source_descriptor(job->source), POLLIN, 0};
            poll(&input, 1, 250);
            status = fio_signals_check();
            continue;
        }
        for (; line < command.line && status == FIO_OK; line++)
            status = fio_virtual_printer_execute(printer, "", 0, NULL, NULL);
        if (status == FIO_OK)
            status = fio_virtual_printer_execute(printer, command.text, command.length, NULL, NULL);
        line = command.line + 1;
        if (command.index % 4096 == 0 && status == FIO_OK)
            status = fio_signals_check();
    }
    return status;
}

/* Without a size of the bed nothing is outside of it. */
static bool counts(const fio_arguments *arguments, const fio_event *event) {
    return arguments->bed[0] > 0 || event->code != FIO_FAULT_OUTSIDE;
}

static void tell_event(fio_narrator *narrator, const fio_job *job, const char *kind,
                       const fio_event *event, int64_t before) {
    fio_json *json = &narrator->json;
    if (before < SHOWN_MOST)
        fio_screen_say(&narrator->screen, "%s:%" PRId64 ": %s %s: %s", job->name, event->line, kind,
                       fio_event_name(event->code), event->text);
    if (!narrator->use_json)
        return;
    fio_json_begin(json, kind);
    fio_json_integer(json, "line", event->line);
    fio_json_string(json, "code", fio_event_name(event->code));
    fio_json_string(json, "text", event->text);
    fio_narrator_object(narrator);
}

static void tell_rest(fio_narrator *narrator, const fio_job *job, const char *kind, int64_t count) {
    if (count > SHOWN_MOST)
        fio_screen_say(&narrator->screen, "%s: %" PRId64 " more %s", job->name, count - SHOWN_MOST,
                       kind);
}

static fio_status tell_events(const fio_arguments *arguments, fio_narrator *narrator,
                              const fio_job *job, const fio_virtual_printer *printer) {
    const fio_statistics *statistics = fio_virtual_printer_statistics(printer);
    const fio_event *event;
    int64_t faults = statistics->fault_count;
    if (arguments->bed[0] <= 0)
        faults -= statistics->count[FIO_FAULT_OUTSIDE];
    int64_t told = 0;
    for (int64_t i = 0; (event = fio_virtual_printer_fault(printer, i)); i++)
        if (counts(arguments, event))
            tell_event(narrator, job, "fault", event, told++);
    tell_rest(narrator, job, "faults", faults);
    for (int64_t i = 0; (event = fio_virtual_printer_warning(printer, i)); i++)
        tell_event(narrator, job, "warning", event, i);
    tell_rest(narrator, job, "warnings", statistics->warning_count);
    return faults == 0 ? FIO_OK
                       : fio_fail(FIO_FAULTY, "%s: %" PRId64 " faults; nothing was sent", job->name,
                                  faults);
}

static double printing_time(const fio_statistics *statistics) {
    return statistics->time[FIO_EXTRUDING] + statistics->time[FIO_TRAVELLING] +
           statistics->time[FIO_RETRACTING] + statistics->time[FIO_LIFTING];
}

static void tell_as_text(fio_narrator *narrator, const fio_job *job,
                         const fio_statistics *statistics) {
    static const char *const axes[3] = {", x ", ", y ", ", z "};
    char bytes[1400];
    fio_text text = fio_text_in(bytes, sizeof bytes - 1);
    fio_text_string(&text, job->name);
    fio_text_string(&text, ": ");
    fio_text_integer(&text, statistics->commands);
    fio_text_string(&text, " commands, ");
    fio_text_integer(&text, statistics->layers);
    fio_text_string(&text, " layers, ");
    fio_progress_duration(&text, printing_time(statistics));
    fio_text_string(&text, ", filament ");
    fio_text_number(&text, statistics->filament, 0);
    fio_text_string(&text, " mm");
    for (int i = 0; i < 3 && statistics->extrusion_moves > 0; i++) {
        fio_text_string(&text, axes[i]);
        fio_text_number(&text, statistics->extrusion_minimum[i], 2);
        fio_text_string(&text, " to ");
        fio_text_number(&text, statistics->extrusion_maximum[i], 2);
    }
    fio_text_string(&text, ", nozzle ");
    fio_text_number(&text, statistics->highest_nozzle, 0);
    fio_text_string(&text, " C, bed ");
    fio_text_number(&text, statistics->highest_bed, 0);
    fio_text_string(&text, " C at most");
    bytes[text.length] = '\n';
    fio_output_line(&narrator->out, bytes, text.length + 1);
}

static void tell_as_json(fio_narrator *narrator, const fio_job *job,
                         const fio_statistics *statistics, fio_status status) {
    fio_json *json = &narrator->json;
    fio_json_begin(json, "check");
    fio_json_integer(json, "status", status);
    fio_json_string(json, "file", job->name);
    fio_json_integer(json, "commands", statistics->commands);
    fio_json_integer(json, "layers", statistics->layers);
    fio_json_number(json, "seconds", printing_time(statistics), 1);
    fio_json_number(json, "filament_mm", statistics->filament, 2);
    for (int i = 0; i < 3 && statistics->extrusion_moves > 0; i++) {
        static const char *const lowest[] = {"x_min", "y_min", "z_min"};
        static const char *const highest[] = {"x_max", "y_max", "z_max"};
        fio_json_number(json, lowest[i], statistics->extrusion_minimum[i], 3);
        fio_json_number(json, highest[i], statistics->extrusion_maximum[i], 3);
    }
    fio_json_number(json, "nozzle", statistics->highest_nozzle, 1);
    fio_json_number(json, "bed", statistics->highest_bed, 1);
    fio_narrator_object(narrator);
}

static fio_status check(const fio_arguments *arguments, fio_narrator *narrator, fio_job *job,
                        fio_virtual_printer *printer) {
    fio_status status = execute(printer, job);
    if (status != FIO_OK)
        return status;
    if (fio_virtual_printer_finish(printer) == FIO_BUG)
        return FIO_BUG;
    status = tell_events(arguments, narrator, job, printer);
    if (narrator->use_json)
        tell_as_json(narrator, job, fio_virtual_printer_statistics(printer), status);
    else if (!arguments->quiet)
        tell_as_text(narrator, job, fio_virtual_printer_statistics(printer));
    return status;
}

fio_status fio_check_run(const fio_arguments *arguments, fio_narrator *narrator) {
    static fio_job job; /* too much for a stack */
    fio_virtual_printer *printer = NULL;
    fio_virtual_options options = options_of(arguments);
    fio_status status = fio_job_open(&job, arguments->file);
    if (status == FIO_OK)
        status = fio_virtual_printer_create(&printer, &options, NULL);
    if (status == FIO_OK)
        status = check(arguments, narrator, &job, printer);
    fio_virtual_printer_free(printer);
    fio_job_close(&job);
    return status;
}

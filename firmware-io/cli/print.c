#include "print.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "resumption.h"
#include "terminal.h"

enum { WITHOUT_LINES_SECONDS = 6 };

enum { SCRIPT_COMMANDS = 40, SCRIPT_SIZE = SCRIPT_COMMANDS * FIO_WIRE_LINE_MOST };

/* All that one job needs; one at a time, and too much for a stack. */
typedef struct running_job {
    fio_arguments arguments;
    fio_control *control;
    fio_job job;
    fio_resumption resumption;
    fio_transport *transport;
    fio_streamer *streamer;
    fio_stream_options options;
    bool patient; /* a printer that says nothing may do so once DTR is raised */
    char on_pause[SCRIPT_SIZE], on_cancel[SCRIPT_SIZE];
} running_job;

static const char *port_of(const fio_arguments *arguments, const char *of_journal) {
    const char *environment = getenv("ISOPRINT_PORT");
    if (arguments->port)
        return arguments->port;
    if (of_journal && *of_journal)
        return of_journal;
    return environment && *environment ? environment : "auto";
}

/* The commands of a small file, parted by line ends. */
static fio_status read_script(char *text, const char *path, const char **commands) {
    fio_source *source;
    fio_source_command command;
    fio_source_result result = FIO_SOURCE_END;
    fio_text all = fio_text_in(text, SCRIPT_SIZE);
    *commands = NULL;
    if (!path)
        return FIO_OK;
    if (!strcmp(path, "-"))
        return fio_fail(FIO_USAGE, "--on-pause and --on-cancel take files, not standard input");
    fio_status status = fio_source_open(&source, path);
    while (status == FIO_OK && (result = fio_source_next(source, &command)) == FIO_SOURCE_COMMAND) {
        if (command.index == SCRIPT_COMMANDS || command.length > 90)
            status = fio_fail(FIO_USAGE, "%s:%lld: at most %d commands of 90 bytes are taken", path,
                              (long long)command.line, SCRIPT_COMMANDS);
        fio_text_bytes(&all, command.text, command.length);
        fio_text_string(&all, "\n");
    }
    fio_source_close(source);
    if (status == FIO_OK && result == FIO_SOURCE_FAILED)
        status = FIO_UNREADABLE;
    *commands = text;
    return status;
}

static fio_status set_options(fio_stream_options *options, const fio_arguments *arguments) {
    *options = fio_stream_options_defaults();
    options->rate = arguments->baud > 0 ? arguments->baud : options->rate;
    options->no_greeting = arguments->no_reset;
    options->window_lines = arguments->window_lines;
    options->window_bytes = arguments->window_bytes;
    options->upload = arguments->upload;
    options->finish_heaters_off = arguments->heaters_off;
    return fio_connection_firmware(&options->firmware, arguments->firmware);
}

static void on_job_event(void *context, const fio_stream_event *event) {
    running_job *running = context;
    if (event->kind == FIO_STREAM_MARK && event->resume)
        fio_resumption_mark(&running->resumption, event->resume, running->control->narrator);
    fio_narrator_event(running->control->narrator, event);
}

static void on_console_event(void *context, const fio_stream_event *event) {
    fio_narrator_event(context, event);
}

/* ---- a job ---- */

/* Everything that can be wrong without a printer, before there is one. */
static fio_status prepare(running_job *running) {
    const fio_arguments *arguments = &running->arguments;
    fio_resumption *resumption = &running->resumption;
    fio_stream_options *options = &running->options;
    fio_status status = set_options(options, arguments);
    if (status == FIO_OK)
        status = read_script(running->on_pause, arguments->on_pause, &options->on_pause);
    if (status == FIO_OK)
        status = read_script(running->on_cancel, arguments->on_cancel, &options->on_cancel);
    if (status == FIO_OK)
        status = fio_resumption_read(resumption, arguments);
    if (status != FIO_OK)
        return status;
    if (resumption->resumes) {
        /* A printer that was not reset knows how far it came, and stands where it stood. */
        running->patient = !running->arguments.no_reset;
        running->arguments.no_reset = options->no_greeting = true;
        options->greeting_seconds = running->patient ? WITHOUT_LINES_SECONDS : 0;
    }
    resumption->port = port_of(arguments, resumption->port);
    status = fio_job_open(&running->job, resumption->file);
    if (status == FIO_OK)
        status = fio_resumption_match(resumption, arguments, &running->job);
    if (status == FIO_OK && arguments->work == FIO_WORK_PRINT)
        status = fio_resumption_check(resumption, arguments, &running->job);
    return status;
}

static fio_status stream(running_job *running) {
    fio_control *control = running->control;
    fio_resumption *resumption = &running->resumption;
    fio_stream_source source = {fio_job_next, running->job.is_pipe ? NULL : fio_job_seek,
                                &running->job};
    fio_stream_listener listener = {on_job_event, running};
    fio_status status =
        fio_streamer_create(&running->streamer, &running->options, &source,
                            resumption->resumes ? &resumption->from : NULL, &listener);
    if (status != FIO_OK)
        return status;
    control->streamer = running->streamer;
    control->job = &running->job;
    control->narrator->has_job = true;
    fio_session_hooks hooks = fio_control_hooks(control);
    return fio_session_run(running->transport, running->streamer, &hooks);
}

/* Boards with USB of their own may be mute until DTR is raised, which others take for a reset: to
 * go on with a job it is tried without at first. */
static fio_status stream_with_or_without_lines(running_job *running) {
    fio_transport *transport = running->transport;
    fio_terminal_keys(running->job.is_pipe);
    fio_status status = stream(running);
    if (status == FIO_NO_PRINTER && running->patient && transport->type->set_lines &&
        !running->control->cancelled && !running->job.is_pipe &&
        transport->type->set_lines(transport, true, true) == FIO_OK) {
        fio_streamer_free(running->streamer);
        running->streamer = NULL;
        running->options.no_greeting = false;
        running->options.greeting_seconds = 0;
        status = fio_job_seek(&running->job, 0);
        if (status == FIO_OK)
            status = stream(running);
    }
    fio_terminal_restore();
    bool refused = status == FIO_UNREADABLE && running->job.failure != FIO_OK;
    return refused ? running->job.failure : status;
}

/* M23 and M24 of a file that is on the card now. */
static fio_status start_from_card(running_job *running) {
    static fio_console console;
    char select[80];
    const char *commands[] = {select, "M24"};
    fio_control *control = running->control;
    fio_stream_listener listener = {on_job_event, running};
    fio_streamer *streamer;
    fio_stream_options options;
    snprintf(select, sizeof select, "M23 %s", running->arguments.upload);
    fio_status status = set_options(&options, &running->arguments);
    options.upload = NULL;
    options.no_greeting = true;
    if (status == FIO_OK)
        status = fio_streamer_create(&streamer, &options, NULL, NULL, &listener);
    if (status != FIO_OK)
        return status;
    int64_t complaints = control->narrator->complaints;
    fio_console_open(&console, commands, 2);
    control->streamer = streamer;
    control->job = NULL;
    control->console = &console;
    fio_session_hooks hooks = fio_control_hooks(control);
    status = fio_session_run(running->transport, streamer, &hooks);
    fio_streamer_free(streamer);
    if (status == FIO_OK && control->narrator->complaints > complaints)
        status = fio_fail(FIO_FAULTY, "the printer did not start %s from its card",
                          running->arguments.upload);
    control->narrator->started = status == FIO_OK;
    return status;
}

/* Tell of the end, and put the message of the failure back that others may have overwritten. */
static fio_status end(running_job *running, fio_status status) {
    char message[512], command[2600];
    fio_control *control = running->control;
    const fio_stream_report *report = fio_streamer_report(running->streamer);
    snprintf(message, sizeof message, "%s", fio_error_message());
    fio_resumption_end(&running->resumption, &running->arguments, status, report, &running->job,
                       command, sizeof command);
    if (status == FIO_OK && running->arguments.start)
        status = start_from_card(running);
    else if (status != FIO_OK)
        status = fio_fail(status, "%s", message);
    fio_narrator_end(control->narrator, status, report, command);
    if (status != FIO_OK && *command) {
        fio_screen_fail(&control->narrator->screen, "%s", fio_error_message());
        fio_screen_fail(&control->narrator->screen, "to go on with the job: %s", command);
        control->told = true;
    }
    return status;
}

static fio_status run(running_job *running) {
    const fio_arguments *arguments = &running->arguments;
    fio_control *control = running->control;
    fio_narrator *narrator = control->narrator;
    fio_resumption *resumption = &running->resumption;
    narrator->upload = arguments->work == FIO_WORK_UPLOAD;
    fio_status status = fio_dialogue_open(&narrator->dialogue, arguments->log, resumption->port);
    if (status == FIO_OK)
        status = fio_connection_open(&running->transport, resumption->port, arguments, control);
    if (status == FIO_OK && arguments->work == FIO_WORK_PRINT)
        status = fio_resumption_begin(resumption, arguments, &running->job, narrator);
    if (status != FIO_OK)
        return status;
    fio_narrator_start(narrator, fio_transport_now(running->transport), resumption->port,
                       fio_source_whole(running->job.source), running->job.name);
    status = stream_with_or_without_lines(running);
    return running->streamer ? end(running, status) : status;
}

fio_status fio_print_run(const fio_arguments *arguments, fio_control *control) {
    static running_job running;
    running.arguments = *arguments;
    running.control = control;
    fio_status status = prepare(&running);
    if (status == FIO_OK)
        status = run(&running);
    if (running.resumption.journal)
        fio_journal_close(running.resumption.journal, !running.resumption.resumes);
    fio_streamer_free(running.streamer);
    control->streamer = NULL;
    fio_transport_close(running.transport);
    fio_job_close(&running.job);
    return status;
}

/* ---- single commands ---- */

static fio_status converse(const fio_arguments *arguments, fio_transport *transport,
                           fio_control *control) {
    static fio_console console;
    fio_stream_options options;
    fio_streamer *streamer;
    fio_stream_listener listener = {on_console_event, control->narrator};
    bool sends = arguments->work == FIO_WORK_SEND;
    fio_status status = set_options(&options, arguments);
    if (status == FIO_OK)
        status = fio_streamer_create(&streamer, &options, NULL, NULL, &listener);
    if (status != FIO_OK)
        return status;
    fio_console_open(&console, sends ? arguments->send : NULL, arguments->send_count);
    control->streamer = streamer;
    control->console = &console;
    control->narrator->answers = true;
    fio_session_hooks hooks = fio_control_hooks(control);
    status = fio_session_run(transport, streamer, &hooks);
    if (status == FIO_OK && sends && control->narrator->complaints > 0)
        status = fio_fail(FIO_FAULTY, "the printer refused a command; its answer says which");
    if (status == FIO_OK && sends && console.refused)
        status = FIO_USAGE;
    if (status == FIO_OK && console.error)
        status =
            fio_fail(FIO_UNREADABLE, "standard input can't be read: %s", strerror(console.error));
    fio_narrator_end(control->narrator, status, fio_streamer_report(streamer), "");
    fio_streamer_free(streamer);
    control->streamer = NULL;
    return status;
}

fio_status fio_print_commands(const fio_arguments *arguments, fio_control *control) {
    fio_transport *transport = NULL;
    const char *port = port_of(arguments, NULL);
    fio_narrator *narrator = control->narrator;
    fio_status status = fio_dialogue_open(&narrator->dialogue, arguments->log, port);
    if (status == FIO_OK)
        status = fio_connection_open(&transport, port, arguments, control);
    if (status != FIO_OK)
        return status;
    fio_narrator_start(narrator, fio_transport_now(transport), port, NULL, NULL);
    status = converse(arguments, transport, control);
    fio_transport_close(transport);
    return status;
}

#include "virtual_serve.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "report.h"
#include "standin/mock.h"
#include "standin/usbip.h"
#include "virtual_command.h"

enum { SCRIPT_MOST = 1 << 20, STEPS_MOST = 1000000 };

typedef struct serving {
    const virtual_arguments *given;
    fio_machine *machine;
    fio_virtual_usb *device;
    fio_standin *standin;
    fio_pace pace;
    fio_execution_log log; /* the caller's */
    virtual_check *check;
    int64_t epoch; /* changes with whatever interrupts a print */
    FILE *trace;
    char *script;
} serving;

static void on_executed(void *context, const fio_executed *executed) {
    serving *s = context;
    if (s->log.entry)
        s->log.entry(s->log.context, executed);
    if (!s->check)
        return;
    int64_t epoch = fio_machine_count(s->machine)->resets;
    if (s->standin) /* at the end there is none any more, and nothing interrupts */
        epoch += s->standin->sessions + s->standin->plugs;
    if (s->standin && epoch != s->epoch)
        virtual_check_interrupted(s->check);
    s->epoch = epoch;
    virtual_check_entry(s->check, executed);
}

static void on_control(void *context, const uint8_t setup[8], const uint8_t *data, int moved) {
    FILE *trace = context;
    fprintf(trace, "%02x %02x wValue=%04x wIndex=%04x len=%d", setup[0], setup[1],
            setup[2] | setup[3] << 8, setup[4] | setup[5] << 8, setup[6] | setup[7] << 8);
    if (moved < 0)
        fputs(" stall", trace);
    for (int i = 0; i < moved; i++)
        fprintf(trace, "%s%02x", i ? " " : " : ", data[i]);
    fputc('\n', trace);
}

/* The file of --script, then the steps of --do. */
static fio_status read_script(serving *s) {
    const char *path = s->given->script, *steps = s->given->steps ? s->given->steps : "";
    size_t size = 0, more = strlen(steps);
    if (!path && !more)
        return FIO_OK;
    FILE *file = path ? fopen(path, "re") : NULL;
    if (path && !file)
        return fio_fail(FIO_UNREADABLE, "%s: can't be opened: %s", path, strerror(errno));
    s->script = malloc(SCRIPT_MOST + more + 2);
    if (s->script && file)
        size = fread(s->script, 1, SCRIPT_MOST, file);
    bool failed = file && ferror(file);
    if (file)
        fclose(file);
    if (!s->script)
        return fio_fail(FIO_NO_MEMORY, "no memory for a script");
    if (failed || size == SCRIPT_MOST || memchr(s->script, 0, size))
        return fio_fail(FIO_UNREADABLE, "%s: can't be read, is no text, or is too long", path);
    if (size > 0 && s->script[size - 1] != '\n')
        s->script[size++] = '\n';
    memcpy(s->script + size, steps, more + 1);
    return FIO_OK;
}

static fio_status make_machine(serving *s) {
    fio_status status = read_script(s);
    if (status != FIO_OK)
        return status;
    fio_machine_options options = s->given->machine;
    options.log = (fio_execution_log){on_executed, s};
    options.script = s->script;
    return fio_machine_create(&s->machine, &options);
}

static const char *chip_of(const virtual_arguments *given) {
    return given->usb ? given->usb : given->usbip ? given->usbip : given->vhci;
}

static fio_status make_device(serving *s) {
    const virtual_arguments *given = s->given;
    fio_virtual_usb_options options = given->usb_device;
    options.chip = chip_of(given);
    if (!options.chip)
        return FIO_OK;
    if (given->usb_trace && !(s->trace = fopen(given->usb_trace, "we")))
        return fio_fail(FIO_NOT_WRITTEN, "%s: can't be written: %s", given->usb_trace,
                        strerror(errno));
    options.trace = s->trace ? on_control : NULL;
    options.trace_context = s->trace;
    return fio_virtual_usb_create(&s->device, s->machine, &options);
}

/* "[HOST:]PORT"; the host's name goes to `host`. */
static fio_status read_address(char host[256], int *port, const char *text) {
    const char *colon = strrchr(text, ':'), *digits = colon ? colon + 1 : text;
    size_t length = colon ? (size_t)(colon - text) : 0;
    char *end;
    long value = strtol(digits, &end, 10);
    if (length >= 256 || *digits < '0' || *digits > '9' || *end || value > 65535)
        return fio_fail(FIO_USAGE, "%s is no [HOST:]PORT", text);
    snprintf(host, 256, "%.*s", (int)length, text);
    if (length == 0)
        snprintf(host, 256, "localhost");
    *port = (int)value;
    return FIO_OK;
}

static fio_status stand_in(serving *s) {
    const virtual_arguments *given = s->given;
    fio_mock_options mock = {given->usb_denied, given->usb_bound, given->usb_stall};
    char host[256];
    int port = 0;
    s->pace = fio_pace_start(given->speed);
    if (given->pty)
        return fio_standin_pty(&s->standin, s->machine, &s->pace, *given->pty ? given->pty : NULL);
    if (given->socket)
        return fio_standin_socket(&s->standin, s->machine, &s->pace, given->socket);
    if (given->usb)
        return fio_standin_mock(&s->standin, s->machine, &s->pace, s->device, &mock);
    if (given->vhci)
        return fio_standin_vhci(&s->standin, s->machine, &s->pace, s->device);
    fio_status status = read_address(host, &port, given->tcp ? given->tcp : given->usbip_port);
    if (status != FIO_OK)
        return status;
    return given->tcp ? fio_standin_tcp(&s->standin, s->machine, &s->pace, host, port)
                      : fio_standin_usbip(&s->standin, s->machine, &s->pace, s->device, host, port);
}

/* What the printer has received is done before it is looked at, in no time. */
static void work_off(serving *s) {
    char bytes[512];
    double now = fio_pace_now(&s->pace);
    for (int i = 0; i < STEPS_MOST; i++) {
        /* Nobody else reads what it says; and reports that come by themselves are no work. */
        while (fio_machine_read(s->machine, now, bytes, sizeof bytes) > 0)
            continue;
        if (!fio_machine_working(s->machine))
            break;
        double next = fio_machine_next(s->machine);
        if (!(next < INFINITY))
            break;
        now = fmax(now, next);
        fio_machine_advance(s->machine, now);
    }
}

static fio_status run(serving *s, virtual_command *command, int *code) {
    const virtual_arguments *given = s->given;
    fio_status status = FIO_OK;
    if (given->command)
        status =
            virtual_command_start(command, given->command, s->standin->where, given->usb_denied);
    else if (printf("%s\n", s->standin->where) < 0 || fflush(stdout))
        status = fio_fail(FIO_NOT_WRITTEN, "what to open could not be written");
    if (status != FIO_OK)
        return status;
    const fio_standin_end end = {.stop = &virtual_command_ended,
                                 .mask = &command->mask,
                                 .once = given->once,
                                 .idle_seconds = given->idle,
                                 .replug_seconds = given->replug};
    status = fio_standin_run(s->standin, &end);
    *code = virtual_command_finish(command);
    return status;
}

static fio_status conclude(serving *s) {
    report_subject subject = {.name = s->standin->where,
                              .printer = fio_machine_printer(s->machine),
                              .machine = s->machine,
                              .check = s->given->check,
                              .quiet = s->given->quiet};
    char where[sizeof s->standin->where];
    memcpy(where, s->standin->where, sizeof where);
    subject.name = where;
    if (s->given->usb)
        fio_mock_bound(s->standin, &subject.bound_now, &subject.bound_first);
    fio_standin_close(s->standin); /* its threads first: the machine is nobody else's now */
    s->standin = NULL;
    work_off(s);
    fio_status verdict = fio_machine_finish(s->machine);
    if (s->check)
        subject.check_result = virtual_check_result(s->check);
    fio_status status = report_write(&subject, s->given->json);
    if (status == FIO_OK && subject.check_result)
        return fio_fail(FIO_FAULTY, "%s: %s", s->given->check, subject.check_result);
    return status == FIO_OK ? verdict : status;
}

fio_status virtual_serve(const virtual_arguments *given, const fio_execution_log *log,
                         virtual_check *check, int *code) {
    serving s = {.given = given, .log = *log, .check = check};
    virtual_command command;
    *code = 0;
    virtual_command_prepare(&command);
    fio_status status = make_machine(&s);
    if (status == FIO_OK)
        status = make_device(&s);
    if (status == FIO_OK)
        status = stand_in(&s);
    if (status == FIO_OK)
        status = run(&s, &command, code);
    if (status == FIO_OK)
        status = conclude(&s);
    fio_standin_close(s.standin);
    fio_virtual_usb_free(s.device);
    fio_machine_free(s.machine);
    if (s.trace && fclose(s.trace) && status == FIO_OK)
        status = fio_fail(FIO_NOT_WRITTEN, "%s: could not be written whole", given->usb_trace);
    free(s.script);
    return status;
}

#include "connection.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "signals.h"
#include "utf8.h"

static const int64_t usual_rates[] = {115200, 250000, 500000, 1000000, 230400, 57600, 38400};

enum { USUAL_RATES = sizeof usual_rates / sizeof *usual_rates };

/* Of the first question the board may still be starting. */
static const double first_probe = 8, next_probe = 3; /* s */

static const double wait_slice = 1; /* s between two looks at the signals */

static fio_status wait_for_port(const char *port, const fio_arguments *arguments) {
    fio_status status = fio_signals_check();
    if (arguments->wait <= 0 || status != FIO_OK)
        return status;
    for (double left = arguments->wait; left > 0; left -= wait_slice) {
        fio_status found = fio_port_wait(port, fmin(wait_slice, left));
        status = fio_signals_check();
        if (status != FIO_OK || found != FIO_NO_PRINTER)
            return status != FIO_OK ? status : found;
    }
    return fio_fail(FIO_NO_PRINTER, "%s: did not appear within %.0f s",
                    strcmp(port, "auto") ? port : "a printer", arguments->wait);
}

/* ---- who is there ---- */

typedef struct found_firmware {
    fio_streamer *streamer;
    char *name;
    size_t size;
    bool found;
} found_firmware;

static void on_event(void *context, const fio_stream_event *event) {
    found_firmware *found = context;
    const char *name = NULL;
    size_t length = 0;
    if (event->kind == FIO_STREAM_ANSWER && event->answer->kind == FIO_ANSWER_FIRMWARE) {
        name = event->answer->rest;
        static const char key[] = "FIRMWARE_NAME:";
        if (!strncmp(name, key, sizeof key - 1))
            name += sizeof key - 1 + strspn(name + sizeof key - 1, " ");
        const char *end = strstr(name, " SOURCE_CODE_URL");
        end = end ? end : strstr(name, " PROTOCOL_VERSION");
        length = end ? (size_t)(end - name) : strlen(name);
    } else if (event->kind == FIO_STREAM_FIRMWARE && !found->found) {
        name = event->firmware->name;
        length = strlen(name);
    }
    if (!name)
        return;
    fio_text text = fio_text_in(found->name, found->size);
    fio_utf8_visible(&text, name, length);
    found->found = true;
}

/* Once it has answered, or a signal wants the end. */
static void leave(void *context, double now, const struct pollfd *polls, int count) {
    found_firmware *found = context;
    if (fio_streamer_report(found->streamer)->state == FIO_STREAM_RUNNING)
        fio_streamer_finish(found->streamer, now);
    else if (fio_signals_check() != FIO_OK)
        fio_streamer_lost(found->streamer, now, FIO_CANCELLED, fio_error_message());
}

fio_status fio_connection_probe(fio_transport *transport, int64_t rate, double seconds, char *name,
                                size_t size) {
    fio_streamer *streamer;
    found_firmware found = {NULL, name, size, false};
    fio_stream_listener listener = {on_event, &found};
    fio_stream_options options = fio_stream_options_defaults();
    options.rate = rate;
    options.greeting_seconds = seconds;
    name[0] = 0;
    fio_status status = fio_streamer_create(&streamer, &options, NULL, NULL, &listener);
    if (status != FIO_OK)
        return status;
    found.streamer = streamer;
    fio_session_hooks hooks = {NULL, leave, 0.1, &found};
    status = fio_session_run(transport, streamer, &hooks);
    fio_streamer_free(streamer);
    if (status == FIO_OK && !found.found)
        snprintf(name, size, "unknown");
    return status;
}

static fio_status find_rate(fio_transport *transport, const char *port, fio_control *control) {
    char name[128];
    if (!transport->type->set_rate)
        return FIO_OK;
    for (int i = 0; i < USUAL_RATES; i++) {
        fio_status status = fio_signals_check();
        if (status == FIO_OK)
            status = transport->type->set_rate(transport, usual_rates[i]);
        if (status == FIO_USAGE)
            continue; /* a rate that this chip has not */
        if (status == FIO_OK)
            status = fio_connection_probe(transport, usual_rates[i],
                                          i == 0 ? first_probe : next_probe, name, sizeof name);
        if (status == FIO_OK)
            fio_screen_say(&control->narrator->screen,
                           "%s answers at %" PRId64 " bits/s; --baud %" PRId64 " is quicker", port,
                           usual_rates[i], usual_rates[i]);
        if (status != FIO_NO_PRINTER)
            return status;
    }
    return fio_fail(FIO_NO_PRINTER, "%s: nothing answers at any of the usual rates", port);
}

fio_status fio_connection_open(fio_transport **transport, const char *port,
                               const fio_arguments *arguments, fio_control *control) {
    fio_port_options options = fio_port_options_defaults();
    options.rate = arguments->baud > 0 ? arguments->baud : usual_rates[0];
    options.keep_lines = arguments->no_reset;
    options.virtual_options = arguments->virtual_options;
    *transport = NULL;
    fio_status status = wait_for_port(port, arguments);
    if (status == FIO_OK)
        status = fio_port_open(transport, port, &options);
    if (status == FIO_OK)
        status = fio_signals_check(); /* a signal while it was being opened */
    if (status == FIO_OK && arguments->baud == 0)
        status = find_rate(*transport, port, control);
    if (status != FIO_OK) {
        fio_transport_close(*transport);
        *transport = NULL;
    }
    return status;
}

/* ---- firmware by name ---- */

static bool same_letters(const char *a, const char *b) {
    for (; *a && *b; a++, b++)
        if ((*a | 0x20) != (*b | 0x20))
            return false;
    return *a == *b;
}

fio_status fio_connection_firmware(const fio_firmware **firmware, const char *name) {
    char known[256];
    fio_text text = fio_text_in(known, sizeof known);
    *firmware = NULL;
    if (!name)
        return FIO_OK;
    for (int kind = FIO_FIRMWARE_UNKNOWN + 1; kind < FIO_FIRMWARE_KINDS; kind++) {
        const fio_firmware *row = fio_firmware_of((fio_firmware_kind)kind);
        if (same_letters(row->name, name)) {
            *firmware = row;
            return FIO_OK;
        }
        fio_text_string(&text, text.length > 0 ? ", " : "");
        fio_text_string(&text, row->name);
    }
    return fio_fail(FIO_USAGE, "--firmware %.40s: there is none of this name; these are known: %s",
                    name, known);
}

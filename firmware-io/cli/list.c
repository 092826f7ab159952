#include "list.h"

#include <stdio.h>
#include <string.h>

#include "signals.h"
#include "utf8.h"

static const double probe_seconds = 5;

/* What is behind it, or why that is not known. */
static fio_status probe(char *firmware, size_t size, const fio_port *port,
                        const fio_arguments *arguments, fio_narrator *narrator) {
    fio_transport *transport;
    fio_port_options options = fio_port_options_defaults();
    options.rate = arguments->baud > 0 ? arguments->baud : options.rate;
    options.keep_lines = arguments->no_reset;
    fio_status status = fio_signals_check();
    if (status != FIO_OK)
        return status;
    status = fio_port_open(&transport, port->name, &options);
    if (status == FIO_OK) {
        status = fio_connection_probe(transport, options.rate, probe_seconds, firmware, size);
        fio_transport_close(transport);
    }
    if (status == FIO_CANCELLED)
        return status;
    if (status != FIO_OK) {
        firmware[0] = 0;
        fio_screen_say(&narrator->screen, "%s: %s", port->name, fio_error_message());
    }
    return FIO_OK;
}

static void print_object(fio_narrator *narrator, const fio_port *port, const char *firmware) {
    fio_json *json = &narrator->json;
    fio_json_begin(json, "port");
    fio_json_string(json, "port", port->name);
    fio_json_string(json, "board", port->board);
    fio_json_string(json, "driver", port->driver);
    fio_json_string(json, "serial", port->serial);
    fio_json_integer(json, "vendor", port->vendor);
    fio_json_integer(json, "product", port->product);
    fio_json_boolean(json, "certain", port->certain);
    fio_json_boolean(json, "allowed", port->allowed);
    if (!port->allowed)
        fio_json_string(json, "reason", port->reason);
    if (firmware)
        fio_json_string(json, "firmware", firmware);
    fio_narrator_object(narrator);
}

static void pad(fio_text *text, const char *cell, size_t width) {
    size_t before = text->length;
    fio_utf8_visible(text, cell, strlen(cell));
    for (size_t i = text->length - before; i < width; i++)
        fio_text_string(text, " ");
    fio_text_string(text, "  ");
}

static void print_row(fio_narrator *narrator, const char *const *cells, const size_t *widths,
                      int columns) {
    char bytes[1024];
    fio_text text = fio_text_in(bytes, sizeof bytes - 1);
    for (int i = 0; i < columns; i++)
        pad(&text, cells[i], widths[i]);
    while (text.length > 0 && bytes[text.length - 1] == ' ')
        text.length--;
    bytes[text.length] = '\n';
    fio_output_line(&narrator->out, bytes, text.length + 1);
}

static size_t larger(size_t a, size_t b) {
    return a > b ? a : b;
}

static fio_status print_ports(const fio_port *ports, int count, const fio_arguments *arguments,
                              fio_control *control) {
    static const char *const head[] = {"port", "board", "driver", "firmware"};
    size_t widths[4] = {4, 5, 6, 8};
    fio_narrator *narrator = control->narrator;
    int columns = arguments->probe ? 4 : 3;
    for (int i = 0; i < count; i++) {
        widths[0] = larger(widths[0], strlen(ports[i].name));
        widths[1] = larger(widths[1], strlen(ports[i].board));
        widths[2] = larger(widths[2], strlen(ports[i].driver));
    }
    if (!arguments->json)
        print_row(narrator, head, widths, columns);
    for (int i = 0; i < count; i++) {
        char firmware[128] = "";
        if (arguments->probe && ports[i].allowed) {
            fio_status status = probe(firmware, sizeof firmware, &ports[i], arguments, narrator);
            if (status != FIO_OK)
                return status;
        }
        const char *const cells[] = {ports[i].name, ports[i].board, ports[i].driver,
                                     *firmware ? firmware : "-"};
        if (arguments->json)
            print_object(narrator, &ports[i], *firmware ? firmware : NULL);
        else
            print_row(narrator, cells, widths, columns);
        if (!ports[i].allowed && !arguments->json)
            fio_screen_say(&narrator->screen, "%s: %s", ports[i].name, ports[i].reason);
    }
    return FIO_OK;
}

fio_status fio_list_print(const fio_arguments *arguments, fio_control *control) {
    fio_port *ports = NULL;
    int count = 0;
    fio_status status = fio_ports_list(&ports, &count);
    if (status != FIO_OK)
        return status;
    if (count == 0)
        fio_screen_say(&control->narrator->screen,
                       "there is no port that a printer may be behind; is it plugged in and on?");
    else
        status = print_ports(ports, count, arguments, control);
    fio_ports_free(ports);
    return status;
}

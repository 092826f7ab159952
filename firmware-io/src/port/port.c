#include <isoprint/port.h>

#include "base/memory.h"
#include "port/choose.h"
#include "port/virtual_port.h"
#include "transport/descriptor.h"
#include "transport/socket.h"
#include "transport/tty.h"
#include "usb/transport.h"

#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const double connect_seconds = 2;

fio_port_options fio_port_options_defaults(void) {
    return (fio_port_options){.rate = 115200};
}

/* What follows `prefix` in a name, NULL if it begins otherwise. */
static const char *after(const char *name, const char *prefix) {
    size_t length = strlen(prefix);
    return strncmp(name, prefix, length) == 0 ? name + length : NULL;
}

static fio_status not_a_name(const char *name) {
    if (after(name, "/dev/") || after(name, "tty"))
        return fio_fail(FIO_USAGE, "\"%s\" is no port; is it tty:%s%s?", name,
                        *name == '/' ? "" : "/dev/", name);
    return fio_fail(FIO_USAGE,
                    "\"%s\" is no port: it takes auto, usb:VID:PID[:SERIAL], tty:PATH, "
                    "socket:PATH, tcp:HOST:PORT or virtual[:SCRIPT]",
                    name);
}

static fio_status open_found(fio_transport **transport, const char *name,
                             const fio_port_table *table, const fio_port_options *options) {
    const fio_usb_found *found = NULL;
    const fio_port_entry *entry = NULL;
    fio_status status = strcmp(name, "auto") == 0 ? fio_port_choose(&entry, table)
                                                  : fio_port_choose_usb(&found, table, name);
    if (status != FIO_OK)
        return status;
    if (entry && !entry->usb)
        return fio_tty_open(transport, entry->port.tty, options->rate, options->keep_lines);
    return fio_usb_open(transport, entry ? entry->usb : found, entry ? entry->port.name : name,
                        options->rate, !options->keep_lines);
}

static fio_status open_searched(fio_transport **transport, const char *name,
                                const fio_port_options *options) {
    fio_port_table *table = fio_allocate(sizeof *table);
    if (!table)
        return fio_fail(FIO_NO_MEMORY, "no memory for the list of ports");
    fio_port_table_read(table);
    fio_status status = open_found(transport, name, table, options);
    fio_release(table);
    return status;
}

static bool searched(const char *name) {
    return strcmp(name, "auto") == 0 || (after(name, "usb:") && fio_port_usb_name(name));
}

fio_status fio_port_open(fio_transport **transport, const char *name,
                         const fio_port_options *options) {
    *transport = NULL;
    fio_port_options usual = fio_port_options_defaults();
    if (!options)
        options = &usual;
    const char *rest;
    if (searched(name))
        return open_searched(transport, name, options);
    if ((rest = after(name, "tty:")) && *rest)
        return fio_tty_open(transport, rest, options->rate, options->keep_lines);
    if ((rest = after(name, "socket:")) && *rest)
        return fio_socket_open_path(transport, rest, connect_seconds);
    if ((rest = after(name, "tcp:")))
        return fio_socket_open_host(transport, rest, connect_seconds);
    if (strcmp(name, "virtual") == 0)
        return fio_virtual_port_open(transport, NULL, options);
    if ((rest = after(name, "virtual:")) && *rest)
        return fio_virtual_port_open(transport, rest, options);
    return not_a_name(name);
}

/* --- waiting -----------------------------------------------------------------------------------*/

enum { ABSENT, THERE, USABLE };

static int look(const char *name, fio_port_table *table) {
    const char *rest;
    if ((rest = after(name, "tty:")) || (rest = after(name, "socket:")))
        return access(rest, F_OK) < 0 ? ABSENT : access(rest, R_OK | W_OK) < 0 ? THERE : USABLE;
    if (!searched(name))
        return USABLE; /* nothing that one could see come */
    fio_port_table_read(table);
    int best = ABSENT;
    for (int i = 0; i < table->count; i++) {
        const fio_port_entry *entry = &table->entries[i];
        bool meant = strcmp(name, "auto") == 0 || (entry->usb && fio_port_names(name, entry->usb));
        int this = !meant ? ABSENT : entry->port.allowed ? USABLE : THERE;
        best = this > best ? this : best;
    }
    return best;
}

static bool well_formed(const char *name) {
    return searched(name) || strcmp(name, "virtual") == 0 || after(name, "virtual:") ||
           after(name, "tty:") || after(name, "socket:") || after(name, "tcp:");
}

/* A port that may not be opened yet may be so in a moment, once udev is done with it. */
static fio_status wait_for(const char *name, double seconds, fio_port_table *table) {
    double end = fio_monotonic() + seconds, left;
    int state = look(name, table);
    fio_usb_watch *watch = NULL;
    /* To be told of events costs as much as several looks. Without USB there still are ttys. */
    if (state != USABLE && searched(name) && seconds >= 1 && fio_usb_watch_open(&watch) != FIO_OK)
        watch = NULL;
    while (state != USABLE && (left = end - fio_monotonic()) > 0) {
        /* Of a device that may be opened at last no event tells. */
        if (!watch || state == THERE || fio_usb_watch_wait(watch, left) != FIO_OK)
            poll(NULL, 0, fio_poll_milliseconds(left < 0.1 ? left : 0.1));
        state = look(name, table);
    }
    fio_usb_watch_close(watch);
    if (state == ABSENT)
        return fio_fail(FIO_NO_PRINTER, "%s: did not appear within %.0f s",
                        strcmp(name, "auto") == 0 ? "a printer" : name, seconds);
    return FIO_OK;
}

fio_status fio_port_wait(const char *name, double seconds) {
    if (!well_formed(name))
        return not_a_name(name);
    fio_port_table *table = fio_allocate(sizeof *table);
    if (!table)
        return fio_fail(FIO_NO_MEMORY, "no memory for the list of ports");
    fio_status status = wait_for(name, seconds, table);
    fio_release(table);
    return status;
}

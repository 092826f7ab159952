/* What isoprint-virtual is told to do. */
#ifndef FIO_CLI_VIRTUAL_OPTIONS_H
#define FIO_CLI_VIRTUAL_OPTIONS_H

#include <stdint.h>
#include <stdio.h>

#include <isoprint/machine.h>

#include "virtual/usb_device.h"

typedef struct virtual_arguments {
    /* One of these, by its name. */
    const char *run, *pty, *socket, *tcp, *usb, *usbip, *vhci;
    const char *usbip_port;
    char **command; /* after "--"; NULL: none */
    double speed;   /* 0: instant */
    bool once;
    double idle, replug; /* s; 0 and -1: not given */
    const char *executed, *log, *check, *host_commands, *script, *steps, *usb_trace;
    bool json, quiet;
    fio_machine_options machine;
    int64_t seed;
    fio_virtual_usb_options usb_device;
    int64_t usb_stall;
    bool usb_denied, usb_bound;
    bool done; /* --help or --version: nothing is left to do */
} virtual_arguments;

/* FIO_USAGE with a message if they make no sense. */
fio_status virtual_arguments_read(virtual_arguments *given, char **argv) FIO_MUST_CHECK;

#endif

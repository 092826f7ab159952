/* A machine, and a stand-in that is driven step by step by the test's own thread. */
#ifndef TESTS_USB_RIG_H
#define TESTS_USB_RIG_H

#include <poll.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#include "check.h"
#include "standin/standin.h"

/* A printer whose answers come at once. */
static inline fio_machine *rig_machine(bool resets) {
    fio_machine_options options = fio_machine_options_defaults();
    fio_machine *machine = NULL;
    options.rate = 0;
    options.line_seconds = options.boot_seconds = 0;
    options.reset_on_dtr = resets;
    if (fio_machine_create(&machine, &options) != FIO_OK) {
        fprintf(stderr, "no machine: %s\n", fio_error_message());
        exit(1);
    }
    return machine;
}

/* Let it look at what happened, as its loop would. */
static inline void rig_turn(fio_standin *standin) {
    struct pollfd polls[FIO_STANDIN_POLLS];
    for (int i = 0, quiet = 0; i < 50 && quiet < 3; i++) {
        int count = standin->type->polls(standin, polls, FIO_STANDIN_POLLS);
        quiet = poll(polls, (nfds_t)count, 1) > 0 ? 0 : quiet + 1;
        CHECK_EQUAL(FIO_OK, fio_standin_turn(standin, polls, count));
    }
}

/* Read from a non-blocking descriptor until `text` came, or nothing more does. */
static inline bool rig_reads(fio_standin *standin, int file, const char *text) {
    static char bytes[8192];
    size_t length = 0;
    for (int i = 0; i < 50; i++) {
        rig_turn(standin);
        ssize_t got = read(file, bytes + length, sizeof bytes - 1 - length);
        length += got > 0 ? (size_t)got : 0;
        bytes[length] = 0;
        if (strstr(bytes, text))
            return true;
    }
    fprintf(stderr, "no '%s' in '%s'\n", text, bytes);
    return false;
}

static inline int64_t rig_lines(const fio_machine *machine) {
    return fio_virtual_printer_statistics(fio_machine_printer(machine))->lines;
}

#endif

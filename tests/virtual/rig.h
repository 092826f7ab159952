/* A virtual printer on the bench: feed it text, look at it. */
#ifndef TESTS_VIRTUAL_RIG_H
#define TESTS_VIRTUAL_RIG_H

#include <stdio.h>
#include <stdlib.h>

#include <isoprint/virtual_printer.h>

#include "check.h"

static inline fio_virtual_printer *rig_make(const fio_virtual_options *options,
                                            const fio_execution_log *log) {
    fio_virtual_printer *printer = NULL;
    if (fio_virtual_printer_create(&printer, options, log) != FIO_OK) {
        fprintf(stderr, "no virtual printer: %s\n", fio_error_message());
        exit(1);
    }
    return printer;
}

static inline void rig_run(fio_virtual_printer *printer, const char *text) {
    CHECK_EQUAL(FIO_OK, fio_virtual_printer_run(printer, text, strlen(text)));
}

/* A default printer that has executed `text`. */
static inline fio_virtual_printer *rig_after(const char *text) {
    fio_virtual_printer *printer = rig_make(NULL, NULL);
    rig_run(printer, text);
    return printer;
}

static inline fio_state rig_state(const fio_virtual_printer *printer) {
    fio_state state;
    fio_virtual_printer_state(printer, &state);
    return state;
}

static inline const fio_statistics *rig_statistics(const fio_virtual_printer *printer) {
    return fio_virtual_printer_statistics(printer);
}

/* The line with its number and checksum. */
static inline const char *rig_numbered(int number, const char *command) {
    static char text[200];
    int length = snprintf(text, sizeof text - 8, "N%d %s", number, command);
    unsigned sum = 0;
    for (int i = 0; i < length; i++)
        sum ^= (unsigned char)text[i];
    snprintf(text + length, 8, "*%u", sum);
    return text;
}

#endif

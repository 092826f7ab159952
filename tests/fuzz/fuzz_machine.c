/* Bytes as what a host says, in pieces and at times that are part of them, to a machine of any
 * firmware: it never hangs, never goes back in time, and counts no more than there was. */
#include "fuzz.h"

#include <math.h>
#include <string.h>

#include <isoprint/machine.h>

static void execute(void *context, const fio_executed *executed) {
    double *last = context;
    if (executed->start < *last - 1e-9 || !(executed->duration >= 0) ||
        strlen(executed->text) != executed->length)
        abort();
    *last = executed->start;
}

/* Control bytes 1 to 7 let time pass, from a millisecond to 1,000 s. */
static void converse(fio_machine *machine, const uint8_t *bytes, size_t size) {
    char heard[512];
    double now = 0;
    int64_t read = 0;
    for (size_t i = 0; i < size; i++) {
        if (bytes[i] >= 8 || bytes[i] == 0) {
            fio_machine_write(machine, now, bytes + i, 1);
            continue;
        }
        double end = now + pow(10, bytes[i] - 4.);
        for (int turns = 0; now < end && turns < 500; turns++) {
            double next = fio_machine_next(machine);
            if (next < now)
                abort();
            now = next < end ? next : end;
            size_t count = fio_machine_read(machine, now, heard, sizeof heard);
            read += (int64_t)count;
            if (count == 0 && next == now && fio_machine_readable(machine))
                abort();
        }
        fio_machine_set_lines(machine, now, bytes[i] & 1, bytes[i] & 2);
    }
    const fio_machine_counts *counts = fio_machine_count(machine);
    if (counts->bytes_out != read || counts->undetectable > counts->lines_in)
        abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    static const char *const firmwares[] = {"marlin", "prusa",    "repetier",      "klipper",
                                            "grbl",   "smoothie", "reprapfirmware"};
    if (size < 2 || size > 4096)
        return 0;
    double last = 0;
    fio_machine_options options = fio_machine_options_defaults();
    options.firmware = firmwares[bytes[0] % 7];
    options.rate = bytes[1] & 1 ? 250000 : 0;
    options.emergency_parser = bytes[1] & 2;
    options.advanced_ok = bytes[1] & 4;
    options.reset_on_dtr = bytes[1] & 8;
    options.faults.flip_in = bytes[1] & 16 ? 0.2 : 0;
    options.faults.late_ok = bytes[1] & 32 ? 0.2 : 0;
    options.log = (fio_execution_log){execute, &last};
    fio_machine *machine = NULL;
    if (fio_machine_create(&machine, &options) != FIO_OK)
        abort();
    converse(machine, bytes + 2, size - 2);
    if (fio_machine_finish(machine) == FIO_BUG)
        abort();
    fio_machine_free(machine);
    return 0;
}

/* Bytes as a script of a virtual printer's faults: it is read or refused, and what was read can be
 * played to a machine that prints, without an end of its patience. */
#include "fuzz.h"

#include <math.h>
#include <string.h>

#include <isoprint/machine.h>

static void play(fio_machine *machine) {
    static const char lines[] = "M104 S60\nN1 G28*18\nG1 X10 F600\nM105\nG4 P100\nM117 x\n";
    char heard[256];
    double now = 0;
    for (int turns = 0; turns < 300; turns++) {
        fio_machine_write(machine, now, lines, sizeof lines - 1);
        double next = fio_machine_next(machine);
        if (next < now)
            abort();
        now = next < now + 1 ? next : now + 1;
        fio_machine_read(machine, now, heard, sizeof heard);
    }
    if (fio_machine_count(machine)->bytes_in < 0 || fio_machine_finish(machine) == FIO_BUG)
        abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    static char text[4096];
    if (size >= sizeof text)
        return 0;
    memcpy(text, bytes, size);
    text[size] = 0;
    fio_machine_options options = fio_machine_options_defaults();
    options.script = text;
    options.rate = 250000;
    fio_machine *machine = NULL;
    fio_status status = fio_machine_create(&machine, &options);
    if (status != FIO_OK &&
        (status != FIO_USAGE || machine || !strstr(fio_error_message(), "line")))
        abort();
    if (status == FIO_OK)
        play(machine);
    fio_machine_free(machine);
    return 0;
}

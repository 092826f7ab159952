/* A line to a printer in memory, and its answer back, through the installed library. */
#include <stdio.h>
#include <string.h>

#include <isoprint/machine.h>
#include <isoprint/port.h>

int ports_here(void); /* in C++ */

static int ask(fio_transport *transport, const char *line, const char *wanted) {
    char answer[4096] = "";
    size_t length = 0, count;
    if (fio_transport_write(transport, line, strlen(line), &count) != FIO_OK)
        return 0;
    for (int i = 0; i < 1000 && !strstr(answer, wanted); i++) {
        if (fio_transport_wait(transport, false, NULL, 0, 1) != FIO_OK ||
            fio_transport_read(transport, answer + length, sizeof answer - 1 - length, &count) !=
                FIO_OK)
            return 0;
        answer[length += count] = 0;
    }
    return strstr(answer, wanted) != NULL;
}

int main(void) {
    fio_port_options options = fio_port_options_defaults();
    fio_transport *transport;
    options.virtual_options = "speed=0";
    if (ports_here() < 0 || fio_port_open(&transport, "virtual", &options) != FIO_OK) {
        fprintf(stderr, "%s\n", fio_error_message());
        return 1;
    }
    /* Opening starts it anew; until it has said so it does not listen. */
    int good = ask(transport, "", "Marlin") && ask(transport, "M115\n", "FIRMWARE_NAME:") &&
               ask(transport, "M105\n", "ok T:");
    fio_transport_close(transport);

    fio_machine *machine;
    fio_machine_options printer = fio_machine_options_defaults();
    if (fio_machine_create(&machine, &printer) != FIO_OK ||
        fio_machine_transport(&transport, machine, 0, 0) != FIO_OK)
        return 1;
    good = good && ask(transport, "", "Marlin") && ask(transport, "M105\n", "ok T:") &&
           fio_machine_count(machine)->oks == 1;
    fio_transport_close(transport);
    fio_machine_free(machine);
    printf("isoprint: %s\n", good ? "the printer answers" : "no answer");
    return !good;
}

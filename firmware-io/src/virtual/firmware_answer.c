/* What the firmware says. */
#include <string.h>

#include "virtual/machine.h"

void fio_firmware_reply(void *machine, const char *text, size_t length) {
    bool ok = length >= 2 && text[0] == 'o' && text[1] == 'k' && (length == 2 || text[2] == ' ');
    fio_fault_answer(machine, text, length, ok);
}

void fio_firmware_say(fio_machine *machine, const char *text) {
    fio_firmware_reply(machine, text, strlen(text));
}

void fio_firmware_ok(fio_machine *machine) {
    char bytes[64];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    fio_text_string(&text, "ok");
    machine->counts.oks++;
    if (machine->options.advanced_ok) {
        if (machine->line.has_number) {
            fio_text_string(&text, " N");
            fio_text_integer(&text, machine->line.number);
        }
        fio_text_string(&text, " P");
        fio_text_integer(&text, fio_printer_moves_free(machine->printer));
        fio_text_string(&text, " B");
        fio_text_integer(&text, machine->options.command_slots - machine->queued);
    }
    fio_firmware_say(machine, bytes);
}

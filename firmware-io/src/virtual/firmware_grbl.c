/* What is grbl's alone: single bytes that act at once, and the commands that begin with '$'; and
 * Klipper's commands that are words. */
#include <string.h>

#include "virtual/machine.h"

static void status(fio_machine *machine) {
    const fio_virtual_printer *printer = machine->printer;
    bool alarm = machine->processor == FIO_HALTED;
    bool runs = fio_printer_next(printer) < INFINITY || machine->processor == FIO_WAITING;
    char bytes[120];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    fio_text_string(&text, alarm ? "<Alarm|MPos:" : runs ? "<Run|MPos:" : "<Idle|MPos:");
    for (int i = 0; i < 3; i++) {
        fio_text_string(&text, i ? "," : "");
        fio_text_number(&text, printer->machine[i], 3);
    }
    fio_text_string(&text, "|Bf:");
    fio_text_integer(&text, fio_printer_moves_free(printer));
    fio_text_string(&text, ",");
    int used = (int)(machine->received_last - machine->received_first);
    fio_text_integer(&text, machine->options.receive_bytes - 1 - used);
    fio_text_string(&text, "|FS:0,0>");
    fio_firmware_say(machine, bytes);
}

bool fio_firmware_real_time(fio_machine *machine, uint8_t byte) {
    switch (byte) {
    case '?':
        status(machine);
        return true;
    case 0x18: /* it is ready again at once */
        machine->plan.reset = true;
        machine->quick_reset = true;
        return true;
    case '!':
    case '~':
        return true;
    default:
        return false;
    }
}

bool fio_firmware_macro(fio_machine *machine, const char *text) {
    fio_virtual_printer *printer = machine->printer;
    if (strcmp(text, "TURN_OFF_HEATERS") != 0)
        return false;
    for (int tool = 0; tool < printer->options.tools; tool++)
        fio_heater_set(&printer->nozzle[tool], printer->clock, 0);
    fio_heater_set(&printer->bed, printer->clock, 0);
    fio_firmware_ok(machine);
    return true;
}

bool fio_firmware_dollar(fio_machine *machine, const char *text) {
    if (*text != '$')
        return false;
    if (!strcmp(text, "$I")) {
        fio_firmware_say(machine, "[VER:1.1h.20190825:]");
        fio_firmware_say(machine, "[OPT:V,15,128]");
    } else if (!strcmp(text, "$$")) {
        fio_firmware_say(machine, "$10=1");
        fio_firmware_say(machine, "$110=500.000");
        fio_firmware_say(machine, "$111=500.000");
        fio_firmware_say(machine, "$112=12.000");
    } else if (strcmp(text, "$") && strcmp(text, "$G") && strcmp(text, "$H") &&
               strcmp(text, "$X")) {
        fio_firmware_say(machine, "error:3");
        return true;
    }
    fio_firmware_ok(machine);
    return true;
}

/* Commands of the firmware itself: what it is, what it tells and when. */
#include <math.h>
#include <string.h>

#include "virtual/machine.h"

static void say_capabilities(fio_machine *machine) {
    static const char *const capabilities[] = {
        "SERIAL_XON_XOFF:0",
        "BINARY_FILE_TRANSFER:1",
        "EEPROM:1",
        "VOLUMETRIC:0",
        "AUTOREPORT_POS:1",
        "AUTOREPORT_TEMP:1",
        "PROGRESS:0",
        "PRINT_JOB:1",
        "AUTOLEVEL:0",
        "RUNOUT:0",
        "Z_PROBE:0",
        "BUILD_PERCENT:1",
        "SOFTWARE_POWER:0",
        "HOST_ACTION_COMMANDS:1",
        "PROMPT_SUPPORT:1",
        "SDCARD:1",
        "SD_WRITE:1",
        "AUTOREPORT_SD_STATUS:1",
        "LONG_FILENAME:1",
        "THERMAL_PROTECTION:1",
        "ARCS:1",
        "MEATPACK:1",
    };
    for (size_t i = 0; i < sizeof capabilities / sizeof *capabilities; i++) {
        char bytes[64];
        fio_text text = fio_text_in(bytes, sizeof bytes);
        fio_text_string(&text, "Cap:");
        fio_text_string(&text, capabilities[i]);
        fio_firmware_say(machine, bytes);
    }
    fio_firmware_say(machine, machine->options.emergency_parser ? "Cap:EMERGENCY_PARSER:1"
                                                                : "Cap:EMERGENCY_PARSER:0");
}

static void say_identity(fio_machine *machine) {
    const char *identity = machine->dialect->identity;
    char bytes[240];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    fio_text_string(&text, machine->dialect->ok_last ? "ok " : "");
    fio_text_string(&text, identity);
    if (identity[strlen(identity) - 1] == ':') {
        fio_text_integer(&text, machine->options.printer.tools);
        fio_text_string(&text, " UUID:cede2a2f-41a2-4748-9b12-c55c62f367ff");
    }
    machine->counts.oks += machine->dialect->ok_last;
    machine->printer->answered = machine->dialect->ok_last;
    fio_firmware_say(machine, bytes);
    if (machine->dialect->capabilities)
        say_capabilities(machine);
    if (machine->dialect->numbering == FIO_NUMBERS_STRICT && machine->dialect->busy) {
        fio_firmware_say(machine, "Cap:AUTOREPORT_TEMP:1");
        fio_firmware_say(machine, "Cap:AUTOREPORT_POSITION:1");
    }
}

/* Klipper's order and digits. */
static void say_short_temperatures(fio_machine *machine) {
    const fio_virtual_printer *printer = machine->printer;
    const fio_heater *heaters[2] = {&printer->bed, &printer->nozzle[printer->tool]};
    char bytes[120];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    fio_text_string(&text, "ok");
    for (int i = 0; i < 2; i++) {
        fio_text_string(&text, i ? " T0:" : " B:");
        fio_text_number(&text, fio_heater_reading(heaters[i], printer->clock), 1);
        fio_text_string(&text, " /");
        fio_text_number(&text, heaters[i]->target, 1);
    }
    fio_firmware_say(machine, bytes);
}

/* M105: its ok stands in front of the temperatures, without N, P and B. */
static void say_temperatures(fio_machine *machine) {
    char bytes[320];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    machine->printer->answered = true;
    machine->counts.oks += !machine->dialect->early_ok;
    if (machine->dialect->ok_last) {
        say_short_temperatures(machine);
        return;
    }
    fio_text_string(&text, machine->dialect->early_ok ? "" : "ok");
    fio_printer_temperatures(machine->printer, &text);
    fio_firmware_say(machine, bytes + (machine->dialect->early_ok ? 1 : 0));
}

/* S of an automatic report: seconds, at most a minute. */
void fio_firmware_set_interval(const fio_machine *machine, const fio_line *line, double *seconds,
                               double *at) {
    if (!fio_line_has(line, 'S'))
        return;
    *seconds = floor(fmin(fmax(fio_line_value(line, 'S'), 0), 60));
    *at = machine->now + *seconds;
}

static void keep_alive(fio_machine *machine, const fio_line *line) {
    char bytes[32];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    if (!machine->dialect->busy)
        return;
    if (fio_line_has(line, 'S')) {
        machine->busy_seconds = floor(fmin(fmax(fio_line_value(line, 'S'), 0), 60));
        machine->busy_at = machine->now + machine->busy_seconds;
        return;
    }
    fio_text_string(&text, "echo:M113 S");
    fio_text_integer(&text, (int64_t)machine->busy_seconds);
    fio_firmware_say(machine, bytes);
}

static void stop(fio_machine *machine) {
    fio_printer_halt(machine->printer, "emergency stop (M112)");
    if (machine->dialect->capabilities)
        fio_firmware_say(machine, "echo:M112 Shutdown");
    fio_firmware_say_lines(machine, machine->dialect->killed);
}

/* grbl has no heaters, no extruder and no card. */
static int grbl_command(const fio_line *line) {
    static const short known[] = {0, 1, 2, 3, 4, 5, 7, 8, 9, 30};
    if (line->letter == 'G')
        return 0;
    for (size_t i = 0; line->letter == 'M' && i < sizeof known / sizeof *known; i++)
        if (line->code == known[i])
            return line->code < 2 ? 0 : 1;
    return -1;
}

int fio_firmware_command(void *context, const fio_line *line) {
    fio_machine *machine = context;
    if (!machine->dialect->identity)
        return grbl_command(line);
    if (line->letter != 'M')
        return 0;
    switch (line->code) {
    case 105:
        say_temperatures(machine);
        return 1;
    case 108:
    case 410: /* what they do was done when they came */
    case 876:
        return 1;
    case 112:
        stop(machine);
        return 1;
    case 113:
        keep_alive(machine, line);
        return 1;
    case 115:
        say_identity(machine);
        return 1;
    case 154:
        fio_firmware_set_interval(machine, line, &machine->position_seconds, &machine->position_at);
        return 1;
    case 155:
        fio_firmware_set_interval(machine, line, &machine->temperature_seconds,
                                  &machine->temperature_at);
        return 1;
    default:
        return fio_firmware_setting(machine, line->code) || fio_firmware_card(machine, line);
    }
}

void fio_firmware_reports(fio_machine *machine) {
    if (machine->temperature_seconds > 0 && machine->now >= machine->temperature_at) {
        char bytes[320];
        fio_text text = fio_text_in(bytes, sizeof bytes);
        fio_printer_temperatures(machine->printer, &text);
        fio_firmware_say(machine, bytes);
        machine->temperature_at = machine->now + machine->temperature_seconds;
    }
    if (machine->position_seconds > 0 && machine->now >= machine->position_at) {
        machine->printer->reply = fio_firmware_reply;
        machine->printer->reply_context = machine;
        fio_printer_say_position(machine->printer);
        machine->position_at = machine->now + machine->position_seconds;
    }
    if (machine->card_seconds > 0 && machine->now >= machine->card_at) {
        if (machine->card.printing)
            fio_firmware_say_progress(machine);
        machine->card_at = machine->now + machine->card_seconds;
    }
}

double fio_firmware_next_report(const fio_machine *machine) {
    double next = INFINITY;
    if (machine->temperature_seconds > 0)
        next = machine->temperature_at;
    if (machine->position_seconds > 0)
        next = fmin(next, machine->position_at);
    if (machine->card_seconds > 0)
        next = fmin(next, machine->card_at);
    return next;
}

/* Commands of the firmware itself: what it is, what it tells and when. */
#include <math.h>
#include <string.h>

#include "virtual/machine.h"

static void say_identity(fio_machine *machine) {
    char bytes[200];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    fio_text_string(&text, "FIRMWARE_NAME:Marlin 2.1 (isoprint virtual printer) "
                           "PROTOCOL_VERSION:1.0 MACHINE_TYPE:Virtual EXTRUDER_COUNT:");
    fio_text_integer(&text, machine->options.printer.tools);
    fio_text_string(&text, " UUID:cede2a2f-41a2-4748-9b12-c55c62f367ff");
    fio_firmware_say(machine, bytes);
    static const char *const capabilities[] = {
        "SERIAL_XON_XOFF:0",
        "BINARY_FILE_TRANSFER:0",
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
        text = fio_text_in(bytes, sizeof bytes);
        fio_text_string(&text, "Cap:");
        fio_text_string(&text, capabilities[i]);
        fio_firmware_say(machine, bytes);
    }
    fio_firmware_say(machine, machine->options.emergency_parser ? "Cap:EMERGENCY_PARSER:1"
                                                                : "Cap:EMERGENCY_PARSER:0");
}

/* M105: its ok stands in front of the temperatures, without N, P and B. */
static void say_temperatures(fio_machine *machine) {
    char bytes[320];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    fio_text_string(&text, "ok");
    fio_printer_temperatures(machine->printer, &text);
    machine->counts.oks++;
    fio_firmware_say(machine, bytes);
    machine->printer->answered = true;
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
    if (fio_line_has(line, 'S')) {
        machine->busy_seconds = floor(fmin(fmax(fio_line_value(line, 'S'), 0), 60));
        machine->busy_at = machine->now + machine->busy_seconds;
        return;
    }
    fio_text_string(&text, "echo:M113 S");
    fio_text_integer(&text, (int64_t)machine->busy_seconds);
    fio_firmware_say(machine, bytes);
}

bool fio_firmware_command(void *context, const fio_line *line) {
    fio_machine *machine = context;
    if (line->letter != 'M')
        return false;
    switch (line->code) {
    case 105:
        say_temperatures(machine);
        return true;
    case 108:
    case 410: /* what they do was done when they came */
    case 876:
        return true;
    case 113:
        keep_alive(machine, line);
        return true;
    case 115:
        say_identity(machine);
        return true;
    case 154:
        fio_firmware_set_interval(machine, line, &machine->position_seconds, &machine->position_at);
        return true;
    case 155:
        fio_firmware_set_interval(machine, line, &machine->temperature_seconds,
                                  &machine->temperature_at);
        return true;
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

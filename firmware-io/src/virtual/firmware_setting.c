/* Settings that outlive a reset: M500 to M503. */
#include "virtual/machine.h"

static fio_settings current(const fio_machine *machine) {
    const fio_virtual_printer *printer = machine->printer;
    return (fio_settings){.limits = printer->limits,
                          .retract = {printer->firmware_retract[0], printer->firmware_retract[1]}};
}

static void use(fio_machine *machine, const fio_settings *settings) {
    fio_virtual_printer *printer = machine->printer;
    printer->limits = settings->limits;
    printer->firmware_retract[0] = settings->retract[0];
    printer->firmware_retract[1] = settings->retract[1];
}

void fio_firmware_keep_defaults(fio_machine *machine) {
    machine->defaults = current(machine);
}

void fio_firmware_load_settings(fio_machine *machine) {
    if (machine->stored)
        use(machine, &machine->kept);
}

static void say_axes(fio_machine *machine, const char *name, const double values[4]) {
    char bytes[120];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    fio_text_string(&text, name);
    for (int i = 0; i < 4; i++) {
        const char letter[] = {' ', "XYZE"[i], 0};
        fio_text_string(&text, letter);
        fio_text_number(&text, values[i], 2);
    }
    fio_firmware_say(machine, bytes);
}

static void say_values(fio_machine *machine, const char *name, const char *letters,
                       const double *values) {
    char bytes[120];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    fio_text_string(&text, name);
    for (int i = 0; letters[i]; i++) {
        const char letter[] = {' ', letters[i], 0};
        fio_text_string(&text, letter);
        fio_text_number(&text, values[i], letters[i] == 'J' ? 3 : 2);
    }
    fio_firmware_say(machine, bytes);
}

static void report(fio_machine *machine) {
    const fio_limits *limits = &machine->printer->limits;
    static const double steps[4] = {80, 80, 400, 500};
    const double *retract = machine->printer->firmware_retract;
    const double accelerations[] = {limits->print_acceleration, limits->retract_acceleration,
                                    limits->travel_acceleration};
    const double advanced[] = {limits->minimum_feedrate, limits->minimum_travel_feedrate,
                               limits->junction_deviation};
    const double retraction[] = {retract[0], retract[1] * 60};
    fio_firmware_say(machine, "echo:; Linear Units:");
    fio_firmware_say(machine, "echo:  G21 ; (mm)");
    fio_firmware_say(machine, "echo:; Steps per unit:");
    say_axes(machine, "echo: M92", steps);
    fio_firmware_say(machine, "echo:; Max feedrates (units/s):");
    say_axes(machine, "echo:  M203", limits->feedrate);
    fio_firmware_say(machine, "echo:; Max Acceleration (units/s2):");
    say_axes(machine, "echo:  M201", limits->acceleration);
    fio_firmware_say(machine, "echo:; Acceleration (units/s2) (P<print-accel> R<retract-accel> "
                              "T<travel-accel>):");
    say_values(machine, "echo:  M204", "PRT", accelerations);
    fio_firmware_say(machine, "echo:; Advanced (S<min_feedrate> T<min_travel_feedrate> "
                              "J<junc_dev>):");
    say_values(machine, "echo:  M205", "STJ", advanced);
    fio_firmware_say(machine, "echo:; Retract (S<length> F<feedrate>):");
    say_values(machine, "echo:  M207", "SF", retraction);
}

bool fio_firmware_setting(fio_machine *machine, int code) {
    switch (code) {
    case 500:
        machine->kept = current(machine);
        machine->stored = true;
        fio_firmware_say(machine, "echo:Settings Stored");
        return true;
    case 501:
        fio_firmware_load_settings(machine);
        fio_firmware_say(machine, machine->stored ? "echo:Stored settings retrieved"
                                                  : "echo:EEPROM is empty");
        return true;
    case 502:
        use(machine, &machine->defaults);
        fio_firmware_say(machine, "echo:Hardcoded Default Settings Loaded");
        return true;
    case 503:
        report(machine);
        return true;
    default:
        return false;
    }
}

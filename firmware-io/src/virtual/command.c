/* Commands that move, heat, wait and answer; those that only set a limit are in setting.c. */
#include <math.h>
#include <string.h>

#include "virtual/printer.h"

#define LEVELLING_SECONDS 30 /* of a machine: nine points and the way between them */
#define LONGEST_DWELL 1e6    /* s: no print waits for more than eleven days */

static void move(fio_virtual_printer *printer, const fio_line *line) {
    fio_statistics *statistics = &printer->statistics;
    double path = statistics->extruded_along_paths, target[3];
    if (line->code >= 2) {
        fio_printer_arc(printer, line, line->code == 2);
    } else {
        double extrusion = fio_printer_target(printer, line, target);
        fio_printer_move(printer, target, extrusion, fio_printer_feedrate(printer));
    }
    statistics->moves++;
    if (statistics->extruded_along_paths == path)
        return;
    statistics->extrusion_moves++;
    if (printer->feedrate == 0 && !printer->inverse_time)
        fio_printer_event(printer, FIO_FAULT_NO_FEEDRATE, "extruding before any F was given");
}

static void dwell(fio_virtual_printer *printer, const fio_line *line) {
    double seconds = 0;
    if (fio_line_has(line, 'P'))
        seconds = fio_line_value(line, 'P') / 1000;
    if (fio_line_has(line, 'S'))
        seconds = fio_line_value(line, 'S');
    fio_printer_wait(printer, seconds < LONGEST_DWELL ? seconds : LONGEST_DWELL, FIO_DWELLING);
}

/* M0 and M1 wait for a time if they have one, else for M108; M600 always for M108. */
static void wait_for_user(fio_virtual_printer *printer, const fio_line *line) {
    double seconds = 0;
    if (line->code < 2 && fio_line_has(line, 'P'))
        seconds = fio_line_value(line, 'P') / 1000;
    if (line->code < 2 && fio_line_has(line, 'S'))
        seconds = fio_line_value(line, 'S');
    fio_printer_wait(printer, seconds > 0 ? fmin(seconds, LONGEST_DWELL) : INFINITY, FIO_DWELLING);
    printer->wait_user = true;
}

/* G10 and G11, with the lengths of M207. */
static void firmware_retract(fio_virtual_printer *printer, bool retract) {
    bool retracted = printer->firmware_retracted > 0;
    if (retract == retracted)
        return;
    double length = retract ? printer->firmware_retract[0] : printer->firmware_retracted;
    fio_printer_move(printer, printer->machine, retract ? -length : length,
                     printer->firmware_retract[1]);
    printer->firmware_retracted = retract ? length : 0;
}

static void home(fio_virtual_printer *printer, const fio_line *line) {
    bool axes[3];
    for (int i = 0; i < 3; i++)
        axes[i] = fio_line_seen(line, (char)('X' + i));
    if (!axes[0] && !axes[1] && !axes[2])
        axes[0] = axes[1] = axes[2] = true;
    if (fio_line_seen(line, 'O')) /* only what is not homed yet */
        for (int i = 0; i < 3; i++)
            axes[i] = axes[i] && !printer->homed[i];
    fio_printer_home(printer, axes);
}

static void level_bed(fio_virtual_printer *printer) {
    fio_printer_drain(printer);
    if (!printer->homed[0] || !printer->homed[1] || !printer->homed[2])
        fio_printer_event(printer, FIO_FAULT_NOT_HOMED, "bed levelling before homing (G28)");
    if (printer->live)
        fio_printer_wait(printer, LEVELLING_SECONDS, FIO_HOMING);
}

static void set_position(fio_virtual_printer *printer, const fio_line *line) {
    if (line->seen & ~line->valued)
        fio_printer_event(printer, FIO_FAULT_BAD_WORD, "a word without a number, or an absurd one");
    if (line->subcode == 1)
        memset(printer->offset, 0, sizeof printer->offset);
    for (int i = 0; i < 3 && line->subcode == 0; i++)
        if (fio_line_has(line, (char)('X' + i)))
            printer->offset[i] =
                fio_line_value(line, (char)('X' + i)) * printer->unit_length - printer->machine[i];
    for (int i = 0; i < 3 && line->subcode == 0; i++)
        if (fio_line_has(line, (char)('A' + i)))
            printer->angle[i] = fio_line_value(line, (char)('A' + i));
    if (line->subcode == 0 && fio_line_has(line, 'E'))
        printer->e = fio_line_value(line, 'E') * printer->unit_length;
}

static void motors_off(fio_virtual_printer *printer, const fio_line *line) {
    if (fio_line_seen(line, 'S'))
        return; /* only sets the time after which they go off */
    fio_printer_drain(printer);
    bool some = false;
    for (int i = 0; i < 3; i++)
        some = some || fio_line_seen(line, (char)('X' + i));
    some = some || fio_line_seen(line, 'E');
    for (int i = 0; i < 3; i++)
        if (!some || fio_line_seen(line, (char)('X' + i)))
            printer->homed[i] = false; /* a loose axis may be pushed away */
}

static void note_heat(fio_virtual_printer *printer) {
    fio_statistics *statistics = &printer->statistics;
    for (int i = 0; i < printer->options.tools; i++)
        statistics->highest_nozzle =
            fmax(statistics->highest_nozzle, fio_heater_at(&printer->nozzle[i], printer->clock));
    statistics->highest_bed =
        fmax(statistics->highest_bed, fio_heater_at(&printer->bed, printer->clock));
}

/* M104, M109, M140, M190: S waits for heating only, R for cooling too. */
static void heat(fio_virtual_printer *printer, const fio_line *line, bool bed, bool wait) {
    int tool = printer->tool;
    if (!bed && fio_line_has(line, 'T')) {
        double index = fio_line_value(line, 'T');
        if (!(index >= 0 && index < printer->options.tools)) {
            fio_printer_event_value(printer, FIO_FAULT_BAD_TOOL, "there is no nozzle ", index, "");
            return;
        }
        tool = (int)index;
    }
    fio_heater *heater = bed ? &printer->bed : &printer->nozzle[tool];
    bool cooling = !fio_line_has(line, 'S') && fio_line_has(line, 'R');
    if (wait)
        fio_printer_drain(printer);
    if (cooling || fio_line_has(line, 'S')) {
        double target = fio_line_value(line, cooling ? 'R' : 'S');
        if (target < 0 || target > heater->options.maximum) {
            fio_printer_event_value(printer, FIO_FAULT_TEMPERATURE, "a target of ", target,
                                    " C is out of range");
            target = target < 0 ? 0 : heater->options.maximum;
        }
        note_heat(printer);
        fio_heater_set(heater, printer->clock, target);
    } else if (fio_line_seen(line, 'S') || fio_line_seen(line, 'R')) {
        fio_printer_event(printer, FIO_FAULT_BAD_WORD, "a temperature without a number");
        return;
    }
    if (!wait)
        return;
    bool heating = heater->target > fio_heater_at(heater, printer->clock);
    if (!heating && !cooling)
        return;
    double seconds = fio_heater_wait(heater, printer->clock);
    if (isinf(seconds) && !printer->live) {
        fio_printer_event_value(printer, FIO_FAULT_TEMPERATURE, "waiting for ever for ",
                                heater->target, " C");
        return;
    }
    fio_printer_wait(printer, seconds, FIO_HEATING);
    if (printer->live) {
        printer->wait_heater = heater;
        return;
    }
    fio_heater_set(heater, printer->clock, heater->target);
    if (heating)
        heater->temperature = heater->target;
    note_heat(printer);
}

static void fan(fio_virtual_printer *printer, const fio_line *line, bool on) {
    if (fio_line_has(line, 'P') && fio_line_value(line, 'P') != 0)
        return; /* the part's fan is fan 0; others cool the machine */
    double speed = fio_line_has(line, 'S') ? fio_line_value(line, 'S') : 255;
    printer->fan = !on ? 0 : speed < 0 ? 0 : speed > 255 ? 255 : speed;
}

void fio_printer_halt(fio_virtual_printer *printer, const char *why) {
    fio_printer_abandon(printer);
    note_heat(printer);
    for (int i = 0; i < FIO_TOOLS_MOST; i++)
        fio_heater_set(&printer->nozzle[i], printer->clock, 0);
    fio_heater_set(&printer->bed, printer->clock, 0);
    printer->fan = 0;
    printer->halted = true;
    fio_printer_event(printer, FIO_FAULT_HALTED, why);
}

static void halt(fio_virtual_printer *printer) {
    fio_printer_halt(printer, "emergency stop (M112)");
    fio_printer_say(printer, "echo:M112 Shutdown");
    fio_printer_say(printer, "Error:Printer halted. kill() called!");
    fio_printer_say(printer, "//action:poweroff");
}

static void select_tool(fio_virtual_printer *printer, const fio_line *line) {
    if (line->code < printer->options.tools) {
        fio_printer_drain(printer);
        printer->parked[printer->tool] = printer->statistics.retracted;
        printer->firmware_parked[printer->tool] = printer->firmware_retracted;
        printer->tool = line->code;
        printer->statistics.retracted = printer->parked[printer->tool];
        printer->firmware_retracted = printer->firmware_parked[printer->tool];
        return;
    }
    fio_printer_event_value(printer, FIO_FAULT_BAD_TOOL, "there is no tool ", line->code, "");
    fio_printer_say(printer, "echo:Invalid extruder");
}

static void progress(fio_virtual_printer *printer, const fio_line *line) {
    double percent = fio_line_has(line, 'P') ? fio_line_value(line, 'P') : -1;
    double minutes = fio_line_has(line, 'R') ? fio_line_value(line, 'R') : -1;
    if (percent >= 0)
        printer->progress_percent = percent < 100 ? (int)percent : 100;
    if (minutes >= 0)
        printer->minutes_left = (int)minutes;
}

void fio_printer_say_position(fio_virtual_printer *printer) {
    static const double steps[3] = {80, 80, 400};
    static const char *const logical[3] = {"X:", " Y:", " Z:"};
    static const char *const counts[3] = {" Count X:", " Y:", " Z:"};
    char bytes[160];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    for (int i = 0; i < 3; i++) {
        fio_text_string(&text, logical[i]);
        fio_text_number(&text, printer->machine[i] + printer->offset[i], 2);
    }
    fio_text_string(&text, " E:");
    fio_text_number(&text, printer->e, 2);
    for (int i = 0; i < 3; i++) {
        fio_text_string(&text, counts[i]);
        fio_text_number(&text, printer->machine[i] * steps[i], 0);
    }
    fio_printer_say(printer, bytes);
}

/* A stop is pressed where homing ends, and nowhere else. */
static void say_end_stops(fio_virtual_printer *printer) {
    static const char *const names[3][2] = {{"x_min: open", "x_min: TRIGGERED"},
                                            {"y_min: open", "y_min: TRIGGERED"},
                                            {"z_min: open", "z_min: TRIGGERED"}};
    fio_printer_say(printer, "Reporting endstop status");
    for (int i = 0; i < 3; i++)
        fio_printer_say(printer, names[i][printer->machine[i] <= printer->options.origin[i]]);
}

static void say_heater(fio_text *text, const char *name, const fio_heater *heater, double time) {
    fio_text_string(text, name);
    fio_text_number(text, fio_heater_reading(heater, time), 2);
    fio_text_string(text, " /");
    fio_text_number(text, heater->target, 2);
}

void fio_printer_temperatures(const fio_virtual_printer *printer, fio_text *text) {
    say_heater(text, " T:", &printer->nozzle[printer->tool], printer->clock);
    say_heater(text, " B:", &printer->bed, printer->clock);
    for (int i = 0; printer->options.tools > 1 && i < printer->options.tools; i++) {
        const char name[] = {' ', 'T', (char)('0' + i), ':', 0};
        say_heater(text, name, &printer->nozzle[i], printer->clock);
    }
    fio_text_string(text, " @:0 B@:0");
}

/* Marlin's M105 has its ok in front. */
static void say_temperatures(fio_virtual_printer *printer) {
    char bytes[320];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    fio_text_string(&text, "ok");
    fio_printer_temperatures(printer, &text);
    fio_printer_say(printer, bytes);
    printer->answered = true;
}

static void say_firmware(fio_virtual_printer *printer) {
    char bytes[200];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    fio_text_string(&text, "FIRMWARE_NAME:Marlin 2.1 (isoprint virtual printer) "
                           "PROTOCOL_VERSION:1.0 MACHINE_TYPE:Virtual EXTRUDER_COUNT:");
    fio_text_integer(&text, printer->options.tools);
    fio_printer_say(printer, bytes);
    fio_printer_say(printer, "Cap:PROGRESS:1");
    fio_printer_say(printer, "Cap:EMERGENCY_PARSER:0");
    fio_printer_say(printer, "Cap:AUTOREPORT_TEMP:0");
}

static bool execute_g(fio_virtual_printer *printer, const fio_line *line) {
    if (line->subcode != 0 && !(line->code == 92 && line->subcode == 1))
        return false;
    switch (line->code) {
    case 0:
    case 1:
    case 2:
    case 3:
        move(printer, line);
        return true;
    case 4:
        dwell(printer, line);
        return true;
    case 10:
    case 11:
        firmware_retract(printer, line->code == 10);
        return true;
    case 17: /* the xy plane, the only one there is */
        return true;
    case 20:
    case 21:
        printer->unit_length = line->code == 20 ? 25.4 : 1;
        return true;
    case 28:
        home(printer, line);
        return true;
    case 29:
        level_bed(printer);
        return true;
    case 90: /* Marlin's G90 and G91 hold for E too, until M82 or M83 */
    case 91:
        printer->absolute = printer->absolute_extrusion = line->code == 90;
        return true;
    case 92:
        set_position(printer, line);
        return true;
    case 93:
    case 94:
        printer->inverse_time = line->code == 93;
        return true;
    default:
        return false;
    }
}

/* M commands that do something now; false leaves the line to the settings. */
static bool execute_m(fio_virtual_printer *printer, const fio_line *line) {
    switch (line->code) {
    case 18:
    case 84:
        motors_off(printer, line);
        return true;
    case 73:
        progress(printer, line);
        return true;
    case 104:
    case 109:
        heat(printer, line, false, line->code == 109);
        return true;
    case 106:
    case 107:
        fan(printer, line, line->code == 106);
        return true;
    case 112:
        halt(printer);
        return true;
    case 114:
        fio_printer_say_position(printer);
        return true;
    case 115:
        say_firmware(printer);
        return true;
    case 118:
        fio_printer_say(printer,
                        line->text + line->arguments + strspn(line->text + line->arguments, " "));
        return true;
    case 119:
        say_end_stops(printer);
        return true;
    case 140:
    case 190:
        heat(printer, line, true, line->code == 190);
        return true;
    case 0:
    case 1:
    case 600:
        fio_printer_drain(printer);
        if (printer->live)
            wait_for_user(printer, line);
        return true;
    case 400:
        fio_printer_drain(printer);
        return true;
    default:
        return false;
    }
}

static bool has_free_text(const fio_line *line) {
    static const int codes[] = {23, 28, 30, 32, 117, 118, 486};
    for (size_t i = 0; line->letter == 'M' && i < sizeof codes / sizeof *codes; i++)
        if (line->code == codes[i])
            return true;
    return false;
}

bool fio_printer_command(fio_virtual_printer *printer, fio_line *line) {
    if (!has_free_text(line))
        fio_line_words(line);
    int done = printer->firmware ? printer->firmware(printer->firmware_context, line) : 0;
    bool known = done >= 0;
    switch (done ? 0 : line->letter) {
    case 'G':
        known = execute_g(printer, line);
        break;
    case 'M':
        if (line->code == 105) {
            say_temperatures(printer);
            return true;
        }
        known = execute_m(printer, line) || fio_printer_setting(printer, line);
        break;
    case 'T':
        select_tool(printer, line);
        break;
    default:
        known = done > 0 || (!done && line->length == 0);
    }
    if (!known && !printer->unknown) {
        fio_printer_say(printer, "error:20");
        printer->answered = true;
    } else if (!known) {
        char bytes[FIO_LINE_MOST + 64];
        fio_text text = fio_text_in(bytes, sizeof bytes);
        fio_text_string(&text, printer->unknown);
        fio_text_string(&text, "\"");
        fio_text_bytes(&text, line->text, (size_t)line->length);
        fio_text_string(&text, "\"");
        fio_printer_say(printer, bytes);
    }
    return known;
}

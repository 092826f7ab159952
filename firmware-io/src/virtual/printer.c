/* Making a printer, taking its lines in, looking at it, ending the print. */
#include "virtual/printer.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

#define PI 3.14159265358979323846

fio_virtual_options fio_virtual_options_defaults(void) {
    return (fio_virtual_options){
        .flavour = FIO_FLAVOUR_MARLIN,
        .size = {250, 210, 210},
        .nozzle = {.maximum = 285, .full_power = 500, .time_constant = 120},
        .bed = {.maximum = 120, .full_power = 160, .time_constant = 300},
        .room_temperature = 20,
        .extrusion_minimum_temperature = 170,
        .extrusion_maximum_length = 200,
        .filament_diameter = 1.75,
        .maximum_flow = 15,
        .maximum_feedrate = {500, 500, 12, 120},
        .maximum_acceleration = {9000, 9000, 500, 10000},
        .print_acceleration = 1500,
        .retract_acceleration = 1500,
        .travel_acceleration = 1500,
        .junction_deviation = 0.013,
        .jerk = {10, 10, 0.4, 2.5},
        .homing_feedrate = {50, 50, 8},
        .firmware_retract = {2, 40},
        .tools = 1,
        .planner_blocks = 16,
    };
}

static bool all_positive(const double *values, int count) {
    for (int i = 0; i < count; i++)
        if (!(values[i] > 0 && values[i] <= 1e9))
            return false;
    return true;
}

static bool heater_is_sane(const fio_heater_options *heater, double room) {
    return heater->maximum > room && heater->full_power > heater->maximum &&
           heater->full_power < 1e5 && heater->time_constant > 0 && heater->time_constant < 1e6;
}

static fio_status check_options(const fio_virtual_options *options) {
    if (options->flavour != FIO_FLAVOUR_MARLIN)
        return fio_fail(FIO_USAGE, "the virtual printer knows Marlin's flavour only");
    for (int i = 0; i < 3; i++)
        if (!(fabs(options->origin[i]) <= 1e6 && options->size[i] > 0 && options->size[i] <= 1e6))
            return fio_fail(FIO_USAGE, "the printer's volume must be between 0 and 1e6 mm wide");
    if (!(fabs(options->room_temperature) < 1000) ||
        !heater_is_sane(&options->nozzle, options->room_temperature) ||
        !heater_is_sane(&options->bed, options->room_temperature))
        return fio_fail(FIO_USAGE,
                        "a heater needs room < maximum < full power, and a time constant");
    const double positive[] = {options->extrusion_maximum_length,
                               options->filament_diameter,
                               options->maximum_flow,
                               options->print_acceleration,
                               options->retract_acceleration,
                               options->travel_acceleration,
                               options->junction_deviation};
    if (!all_positive(positive, (int)(sizeof positive / sizeof *positive)) ||
        !all_positive(options->maximum_feedrate, 4) ||
        !all_positive(options->maximum_acceleration, 4) || !all_positive(options->jerk, 4) ||
        !all_positive(options->homing_feedrate, 3) || !all_positive(options->firmware_retract, 2))
        return fio_fail(FIO_USAGE, "speeds, accelerations and lengths of a printer are positive");
    if (options->tools < 1 || options->tools > FIO_TOOLS_MOST)
        return fio_fail(FIO_USAGE, "a printer has 1 to %d tools, not %d", FIO_TOOLS_MOST,
                        options->tools);
    if (options->planner_blocks < 2 || options->planner_blocks > FIO_BLOCKS_MOST)
        return fio_fail(FIO_USAGE, "a planner has 2 to %d blocks, not %d", FIO_BLOCKS_MOST,
                        options->planner_blocks);
    return FIO_OK;
}

static fio_heater cold_heater(const fio_heater_options *options, double room) {
    return (fio_heater){.temperature = room, .room = room, .options = *options};
}

/* What the firmware knows after it booted. */
static void set_state(fio_virtual_printer *printer) {
    const fio_virtual_options *options = &printer->options;
    fio_limits *limits = &printer->limits;
    memcpy(limits->feedrate, options->maximum_feedrate, sizeof limits->feedrate);
    memcpy(limits->acceleration, options->maximum_acceleration, sizeof limits->acceleration);
    memcpy(limits->jerk, options->jerk, sizeof limits->jerk);
    limits->print_acceleration = options->print_acceleration;
    limits->retract_acceleration = options->retract_acceleration;
    limits->travel_acceleration = options->travel_acceleration;
    limits->minimum_feedrate = limits->minimum_travel_feedrate = 0;
    limits->junction_deviation = options->junction_deviation;
    limits->classic_jerk = options->classic_jerk;
    memcpy(printer->firmware_retract, options->firmware_retract, sizeof printer->firmware_retract);
    memset(printer->offset, 0, sizeof printer->offset);
    memset(printer->homed, 0, sizeof printer->homed);
    printer->e = printer->feedrate = printer->fan = printer->firmware_retracted = 0;
    printer->unit_length = 1;
    printer->inverse_time = false;
    printer->inverse = printer->turn = 0;
    printer->absolute = printer->absolute_extrusion = printer->end_stops = true;
    printer->allow_cold = printer->halted = false;
    printer->feedrate_percent = printer->flow_percent = 100;
    printer->extrusion_minimum_temperature = options->extrusion_minimum_temperature;
    printer->progress_percent = printer->minutes_left = -1;
    printer->last_number = 0;
    printer->tool = 0;
    memset(printer->parked, 0, sizeof printer->parked);
    memset(printer->firmware_parked, 0, sizeof printer->firmware_parked);
}

void fio_printer_reset(fio_virtual_printer *printer) {
    if (printer->waiting)
        fio_printer_end_wait(printer);
    if (printer->open)
        fio_printer_end_entry(printer);
    fio_printer_abandon(printer);
    for (int i = 0; i < FIO_TOOLS_MOST; i++)
        fio_heater_set(&printer->nozzle[i], printer->clock, 0);
    fio_heater_set(&printer->bed, printer->clock, 0);
    set_state(printer);
}

static void set_up(fio_virtual_printer *printer, const fio_virtual_options *options) {
    printer->options = *options;
    printer->unknown = "echo:Unknown command: ";
    printer->planner.capacity = options->planner_blocks;
    for (int i = 0; i < FIO_TOOLS_MOST; i++)
        printer->nozzle[i] = cold_heater(&options->nozzle, options->room_temperature);
    printer->bed = cold_heater(&options->bed, options->room_temperature);
    printer->statistics.highest_nozzle = options->room_temperature;
    printer->statistics.highest_bed = options->room_temperature;
    memcpy(printer->machine, options->origin, sizeof printer->machine);
    printer->filament_area = PI / 4 * options->filament_diameter * options->filament_diameter;
    set_state(printer);
}

fio_status fio_virtual_printer_create(fio_virtual_printer **printer,
                                      const fio_virtual_options *options,
                                      const fio_execution_log *log) {
    fio_virtual_options defaults = fio_virtual_options_defaults();
    *printer = NULL;
    if (!options)
        options = &defaults;
    fio_status status = check_options(options);
    if (status != FIO_OK)
        return status;
    fio_virtual_printer *made = fio_allocate(sizeof *made);
    if (!made)
        return fio_fail(FIO_NO_MEMORY, "no memory for a virtual printer (%zu bytes)", sizeof *made);
    set_up(made, options);
    if (log)
        made->log = *log;
    *printer = made;
    return FIO_OK;
}

void fio_virtual_printer_free(fio_virtual_printer *printer) {
    fio_release(printer);
}

static fio_status reject(fio_virtual_printer *printer, const char *why) {
    char bytes[96];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    fio_text_string(&text, "Error:");
    fio_text_string(&text, why);
    fio_text_string(&text, ", Last Line: ");
    fio_text_integer(&text, printer->last_number);
    fio_printer_say(printer, bytes);
    text = fio_text_in(bytes, sizeof bytes);
    fio_text_string(&text, "Resend: ");
    fio_text_integer(&text, printer->last_number + 1);
    fio_printer_say(printer, bytes);
    fio_printer_say(printer, "ok");
    printer->statistics.rejected_lines++;
    if (!printer->lost_line)
        printer->lost_line = printer->line;
    return fio_fail(FIO_REJECTED, "line %lld: %s", (long long)printer->line, why);
}

void fio_printer_begin(fio_virtual_printer *printer, fio_line *line, bool cut) {
    if (cut) {
        bool g = line->letter == 'G';
        fio_printer_event(printer, g ? FIO_FAULT_LINE_TOO_LONG : FIO_WARNING_TEXT_CUT,
                          "the line is longer than the firmware keeps, and was cut");
    }
    printer->statistics.commands++;
    printer->answered = false;
    fio_printer_start_entry(printer, line);
    bool known = fio_printer_command(printer, line);
    fio_printer_know_entry(printer, known);
    if (known)
        return;
    printer->statistics.unknown_commands++;
    fio_printer_event(printer, FIO_WARNING_UNKNOWN_COMMAND, line->text);
}

void fio_printer_next_line(fio_virtual_printer *printer, fio_reply *reply, void *context) {
    printer->line++;
    printer->line_codes = 0;
    printer->statistics.lines++;
    printer->reply = reply;
    printer->reply_context = context;
}

fio_status fio_virtual_printer_execute(fio_virtual_printer *printer, const char *line,
                                       size_t length, fio_reply *reply, void *context) {
    if (printer->finished)
        return fio_fail(FIO_USAGE, "the print is finished: make a new virtual printer");
    if (printer->live)
        return fio_fail(FIO_USAGE, "the printer belongs to a machine, which feeds it");
    char text[FIO_LINE_MOST + 1];
    bool cut;
    fio_printer_next_line(printer, reply, context);
    int kept = fio_line_strip(text, &cut, line, length);
    if (kept == 0)
        return FIO_OK;
    if (printer->halted) {
        fio_printer_event(printer, FIO_FAULT_HALTED, "a line after the emergency stop");
        return fio_fail(FIO_REJECTED, "the printer is halted");
    }
    int64_t before = printer->last_number;
    fio_line_verdict verdict = fio_line_check(text, &printer->last_number, true);
    if (verdict == FIO_LINE_REPEATED) {
        printer->statistics.duplicate_lines++;
        return FIO_OK;
    }
    if (verdict != FIO_LINE_GOOD)
        return reject(printer, fio_line_complaint(verdict));
    fio_line parsed;
    fio_line_read(&parsed, text, kept, true);
    if (parsed.length == 0 && !parsed.has_number)
        return FIO_OK;
    if (parsed.has_number || printer->last_number != before)
        printer->lost_line = 0;
    fio_printer_begin(printer, &parsed, cut);
    if (!printer->halted && !printer->answered) /* a halted Marlin is mute */
        fio_printer_say(printer, "ok");
    fio_printer_end_entry(printer);
    return FIO_OK;
}

fio_status fio_virtual_printer_run(fio_virtual_printer *printer, const char *text, size_t length) {
    const char *end = text + length;
    while (text < end) {
        const char *stop = memchr(text, '\n', (size_t)(end - text));
        const char *next = stop ? stop + 1 : end;
        fio_status status =
            fio_virtual_printer_execute(printer, text, (size_t)(next - text), NULL, NULL);
        if (status != FIO_OK && status != FIO_REJECTED)
            return status;
        text = next;
    }
    return FIO_OK;
}

static void look_at_heaters(fio_virtual_printer *printer) {
    fio_statistics *statistics = &printer->statistics;
    for (int i = 0; i < printer->options.tools; i++) {
        const fio_heater *nozzle = &printer->nozzle[i];
        statistics->highest_nozzle =
            fmax(statistics->highest_nozzle, fio_heater_at(nozzle, printer->clock));
        if (nozzle->target > 0)
            fio_printer_event_value(printer, FIO_FAULT_HEATER_LEFT_ON, "the nozzle is left at ",
                                    nozzle->target, " C (M104 S0 is missing)");
    }
    statistics->highest_bed =
        fmax(statistics->highest_bed, fio_heater_at(&printer->bed, printer->clock));
    printer->line_codes = 0; /* nozzle and bed are two faults */
    if (printer->bed.target > 0)
        fio_printer_event_value(printer, FIO_FAULT_HEATER_LEFT_ON, "the bed is left at ",
                                printer->bed.target, " C (M140 S0 is missing)");
}

fio_status fio_virtual_printer_finish(fio_virtual_printer *printer) {
    if (printer->finished)
        return fio_fail(FIO_USAGE, "the print is already finished");
    printer->finished = true;
    if (printer->live)
        fio_printer_run_out(printer);
    fio_printer_drain(printer);
    printer->line_codes = 0;
    printer->line = printer->lost_line;
    if (printer->lost_line)
        fio_printer_event(printer, FIO_FAULT_LINE_LOST, "a line was rejected and never sent again");
    printer->line = 0;
    look_at_heaters(printer);
    if (printer->fan > 0)
        fio_printer_event(printer, FIO_WARNING_FAN_LEFT_ON, "the fan is left on (M107 is missing)");
    if (printer->statistics.fault_count == 0)
        return FIO_OK;
    const fio_event *first = &printer->faults[0];
    return fio_fail(FIO_FAULTY, "%lld faults, the first in line %lld: %s: %s",
                    (long long)printer->statistics.fault_count, (long long)first->line,
                    fio_event_name(first->code), first->text);
}

void fio_virtual_printer_state(const fio_virtual_printer *printer, fio_state *state) {
    *state = (fio_state){
        .time = printer->clock,
        .inches = printer->unit_length != 1,
        .inverse_time = printer->inverse_time,
        .absolute = printer->absolute,
        .absolute_extrusion = printer->absolute_extrusion,
        .halted = printer->halted,
        .line_number = printer->last_number,
        .feedrate = printer->feedrate,
        .feedrate_percent = printer->feedrate_percent,
        .flow_percent = printer->flow_percent,
        .acceleration = {printer->limits.print_acceleration, printer->limits.retract_acceleration,
                         printer->limits.travel_acceleration},
        .fan = printer->fan,
        .bed = fio_heater_at(&printer->bed, printer->clock),
        .bed_target = printer->bed.target,
        .tool = printer->tool,
        .progress_percent = printer->progress_percent,
        .minutes_left = printer->minutes_left,
    };
    for (int i = 0; i < 3; i++) {
        state->machine[i] = printer->machine[i];
        state->position[i] = printer->machine[i] + printer->offset[i];
        state->angle[i] = printer->angle[i];
        state->homed[i] = printer->homed[i];
    }
    state->position[3] = printer->e;
    for (int i = 0; i < printer->options.tools; i++) {
        state->nozzle[i] = fio_heater_at(&printer->nozzle[i], printer->clock);
        state->nozzle_target[i] = printer->nozzle[i].target;
    }
}

const fio_statistics *fio_virtual_printer_statistics(const fio_virtual_printer *printer) {
    return &printer->statistics;
}

const fio_event *fio_virtual_printer_fault(const fio_virtual_printer *printer, int64_t index) {
    bool there = index >= 0 && index < FIO_EVENTS_KEPT && index < printer->statistics.fault_count;
    return there ? &printer->faults[index] : NULL;
}

const fio_event *fio_virtual_printer_warning(const fio_virtual_printer *printer, int64_t index) {
    bool there = index >= 0 && index < FIO_EVENTS_KEPT && index < printer->statistics.warning_count;
    return there ? &printer->warnings[index] : NULL;
}

#include <stdio.h>
#include <string.h>

#include "virtual/printer.h"

static const char *const names[FIO_EVENT_CODES] = {
    [FIO_FAULT_OUTSIDE] = "outside",
    [FIO_FAULT_NOT_HOMED] = "not_homed",
    [FIO_FAULT_COLD_EXTRUSION] = "cold_extrusion",
    [FIO_FAULT_LONG_EXTRUSION] = "long_extrusion",
    [FIO_FAULT_NO_FEEDRATE] = "no_feedrate",
    [FIO_FAULT_BAD_FEEDRATE] = "bad_feedrate",
    [FIO_FAULT_BAD_ARC] = "bad_arc",
    [FIO_FAULT_BAD_WORD] = "bad_word",
    [FIO_FAULT_BAD_SETTING] = "bad_setting",
    [FIO_FAULT_TEMPERATURE] = "temperature",
    [FIO_FAULT_BAD_TOOL] = "bad_tool",
    [FIO_FAULT_LINE_TOO_LONG] = "line_too_long",
    [FIO_FAULT_LINE_LOST] = "line_lost",
    [FIO_FAULT_HALTED] = "halted",
    [FIO_FAULT_HEATER_LEFT_ON] = "heater_left_on",
    [FIO_WARNING_UNKNOWN_COMMAND] = "unknown_command",
    [FIO_WARNING_RETRACTED] = "retracted",
    [FIO_WARNING_OVERPRIMED] = "overprimed",
    [FIO_WARNING_FLOW] = "flow",
    [FIO_WARNING_TEXT_CUT] = "text_cut",
    [FIO_WARNING_FAN_LEFT_ON] = "fan_left_on",
};

static const char *const activities[FIO_ACTIVITIES] = {
    [FIO_EXTRUDING] = "extruding", [FIO_TRAVELLING] = "travelling", [FIO_RETRACTING] = "retracting",
    [FIO_LIFTING] = "lifting",     [FIO_HOMING] = "homing",         [FIO_HEATING] = "heating",
    [FIO_DWELLING] = "dwelling",
};

const char *fio_event_name(fio_event_code code) {
    return (unsigned)code < FIO_EVENT_CODES ? names[code] : "unknown";
}

const char *fio_activity_name(fio_activity activity) {
    return (unsigned)activity < FIO_ACTIVITIES ? activities[activity] : "unknown";
}

void fio_printer_event(fio_virtual_printer *printer, fio_event_code code, const char *text) {
    fio_statistics *statistics = &printer->statistics;
    if (printer->line_codes >> code & 1)
        return; /* an arc out of the volume is one fault, not one for each of its chords */
    printer->line_codes |= 1u << code;
    statistics->count[code]++;
    bool warning = code >= FIO_WARNING_UNKNOWN_COMMAND;
    int64_t index = warning ? statistics->warning_count++ : statistics->fault_count++;
    if (index >= FIO_EVENTS_KEPT)
        return;
    fio_event *event = warning ? &printer->warnings[index] : &printer->faults[index];
    event->code = code;
    event->line = printer->line;
    snprintf(event->text, sizeof event->text, "%s", text);
}

void fio_printer_event_value(fio_virtual_printer *printer, fio_event_code code, const char *before,
                             double value, const char *after) {
    char bytes[sizeof printer->faults->text];
    fio_text text = fio_text_in(bytes, sizeof bytes);
    fio_text_string(&text, before);
    fio_text_number(&text, value, 3);
    fio_text_string(&text, after);
    fio_printer_event(printer, code, bytes);
}

void fio_printer_say(fio_virtual_printer *printer, const char *text) {
    if (printer->reply)
        printer->reply(printer->reply_context, text, strlen(text));
}

/* M commands that set limits, percentages and modes, and those accepted without an effect here. */
#include <stddef.h>

#include "virtual/printer.h"

static const char axis_letters[4] = {'X', 'Y', 'Z', 'E'};

/* Set *setting to the letter's value times `scale`, if it is there and positive. */
static void set_positive(fio_virtual_printer *printer, double *setting, const fio_line *line,
                         char letter, double scale) {
    if (!fio_line_seen(line, letter))
        return;
    double value = fio_line_has(line, letter) ? fio_line_value(line, letter) * scale : 0;
    if (value > 0)
        *setting = value;
    else
        fio_printer_event(printer, FIO_FAULT_BAD_SETTING, "a setting that is not positive");
}

static void set_axes(fio_virtual_printer *printer, double settings[4], const fio_line *line) {
    for (int i = 0; i < 4; i++)
        set_positive(printer, &settings[i], line, axis_letters[i], printer->unit_length);
}

static void set_not_negative(fio_virtual_printer *printer, double *setting, const fio_line *line,
                             char letter) {
    if (!fio_line_has(line, letter))
        return;
    double value = fio_line_value(line, letter) * printer->unit_length;
    if (value >= 0)
        *setting = value;
    else
        fio_printer_event(printer, FIO_FAULT_BAD_SETTING, "a setting below zero");
}

static void set_accelerations(fio_virtual_printer *printer, const fio_line *line) {
    fio_limits *limits = &printer->limits;
    double unit = printer->unit_length;
    set_positive(printer, &limits->print_acceleration, line, 'S', unit);
    set_positive(printer, &limits->travel_acceleration, line, 'S', unit);
    set_positive(printer, &limits->print_acceleration, line, 'P', unit);
    set_positive(printer, &limits->retract_acceleration, line, 'R', unit);
    set_positive(printer, &limits->travel_acceleration, line, 'T', unit);
}

static void set_advanced(fio_virtual_printer *printer, const fio_line *line) {
    fio_limits *limits = &printer->limits;
    set_not_negative(printer, &limits->minimum_feedrate, line, 'S');
    set_not_negative(printer, &limits->minimum_travel_feedrate, line, 'T');
    set_axes(printer, limits->jerk, line);
    set_positive(printer, &limits->junction_deviation, line, 'J', printer->unit_length);
}

static void set_cold_extrusion(fio_virtual_printer *printer, const fio_line *line) {
    if (fio_line_has(line, 'P'))
        printer->allow_cold = fio_line_value(line, 'P') != 0;
    if (fio_line_has(line, 'S')) {
        printer->extrusion_minimum_temperature = fio_line_value(line, 'S');
        printer->allow_cold = fio_line_value(line, 'S') == 0;
    }
}

/* Known, and without an effect on what is modelled here. */
static bool accepted(int code) {
    static const short codes[] = {17,  23,  24,  25,  27,  28,  29,  30,  31,  32,  75,  76,
                                  77,  78,  80,  81,  85,  92,  108, 110, 111, 113, 117, 154,
                                  155, 208, 209, 300, 301, 303, 304, 410, 412, 413, 420, 486,
                                  500, 501, 502, 503, 569, 593, 851, 900, 906, 907, 913, 914};
    for (size_t i = 0; i < sizeof codes / sizeof *codes; i++)
        if (codes[i] == code)
            return true;
    return false;
}

bool fio_printer_setting(fio_virtual_printer *printer, const fio_line *line) {
    switch (line->code) {
    case 82:
    case 83:
        printer->absolute_extrusion = line->code == 82;
        return true;
    case 110:
        if (!line->has_number && fio_line_has(line, 'N'))
            printer->last_number = (int64_t)fio_line_value(line, 'N');
        return true;
    case 201:
        set_axes(printer, printer->limits.acceleration, line);
        return true;
    case 203:
        set_axes(printer, printer->limits.feedrate, line);
        return true;
    case 204:
        set_accelerations(printer, line);
        return true;
    case 205:
        set_advanced(printer, line);
        return true;
    case 207:
        set_positive(printer, &printer->firmware_retract[0], line, 'S', printer->unit_length);
        set_positive(printer, &printer->firmware_retract[1], line, 'F', printer->unit_length / 60);
        return true;
    case 211:
        if (fio_line_has(line, 'S'))
            printer->end_stops = fio_line_value(line, 'S') != 0;
        return true;
    case 220:
        set_positive(printer, &printer->feedrate_percent, line, 'S', 1);
        return true;
    case 221:
        set_positive(printer, &printer->flow_percent, line, 'S', 1);
        return true;
    case 302:
        set_cold_extrusion(printer, line);
        return true;
    default:
        return accepted(line->code);
    }
}

/* G2 and G3: arcs in the xy plane, cut into chords as Marlin does. */
#include <math.h>

#include "virtual/printer.h"

#define TURN 6.283185307179586
#define MOST_CHORD 1.0      /* mm */
#define CHORDS_OF_CIRCLE 72 /* at least */
#define MOST_CHORDS 100000  /* of one command: more is no arc of a print */
#define LEAST_ANGLE 5e-7    /* rad: closer ends are a whole circle, as in grbl */

typedef fio_arc arc;

/* The centre from R: left of the chord for the shorter counter-clockwise arc. */
static bool centre_from_radius(double centre[2], const double start[2], const double end[2],
                               double radius, bool clockwise) {
    double x = end[0] - start[0], y = end[1] - start[1], chord = sqrt(x * x + y * y);
    double height_squared = radius * radius - chord * chord / 4;
    if (chord < 1e-9 || height_squared < -1e-3 * chord) /* an end rounded away by some µm is fine */
        return false;
    double height = height_squared > 0 ? sqrt(height_squared) : 0;
    double side = clockwise == (radius < 0) ? 1 : -1;
    centre[0] = (start[0] + end[0]) / 2 - side * height * y / chord;
    centre[1] = (start[1] + end[1]) / 2 + side * height * x / chord;
    return true;
}

static bool measure(arc *shape, const double start[2], const double end[2], bool clockwise,
                    double circles) {
    double ax = start[0] - shape->centre[0], ay = start[1] - shape->centre[1];
    double bx = end[0] - shape->centre[0], by = end[1] - shape->centre[1];
    double radius = sqrt(ax * ax + ay * ay), end_radius = sqrt(bx * bx + by * by);
    double error = fabs(end_radius - radius);
    if (radius < 1e-6 || error > 0.5 || (error > 0.005 && error > 0.001 * radius))
        return false; /* grbl's rule */
    double angle = atan2(ax * by - ay * bx, ax * bx + ay * by);
    if (clockwise && angle >= -LEAST_ANGLE)
        angle -= TURN;
    if (!clockwise && angle <= LEAST_ANGLE)
        angle += TURN;
    angle += clockwise ? -TURN * circles : TURN * circles;
    double chord = TURN * radius / CHORDS_OF_CIRCLE;
    chord = chord < MOST_CHORD ? chord : MOST_CHORD;
    double chords = ceil(fabs(angle) * radius / chord - 1e-9);
    if (!(chords <= MOST_CHORDS))
        return false;
    shape->radius = radius;
    shape->growth = end_radius - radius;
    shape->start_angle = atan2(ay, ax);
    shape->angle = angle;
    shape->chords = chords < 1 ? 1 : (int)chords;
    return true;
}

void fio_printer_arc(fio_virtual_printer *printer, const fio_line *line, bool clockwise) {
    double unit = printer->unit_length, target[3];
    double start[3] = {printer->machine[0], printer->machine[1], printer->machine[2]};
    double extrusion = fio_printer_target(printer, line, target);
    arc shape;
    bool good = false;
    if (fio_line_has(line, 'R')) {
        good = centre_from_radius(shape.centre, start, target, fio_line_value(line, 'R') * unit,
                                  clockwise);
    } else if (fio_line_has(line, 'I') || fio_line_has(line, 'J')) {
        shape.centre[0] =
            start[0] + (fio_line_has(line, 'I') ? fio_line_value(line, 'I') : 0) * unit;
        shape.centre[1] =
            start[1] + (fio_line_has(line, 'J') ? fio_line_value(line, 'J') : 0) * unit;
        good = true;
    }
    double circles = fio_line_has(line, 'P') ? floor(fio_line_value(line, 'P')) : 0;
    circles = circles < 0 ? 0 : circles > 100 ? 100 : circles;
    if (!good || !measure(&shape, start, target, clockwise, circles)) {
        fio_printer_event(printer, FIO_FAULT_BAD_ARC,
                          "an arc without a centre, or whose ends are not equally far from it");
        return;
    }
    printer->statistics.arcs++;
    shape.start_z = start[2];
    for (int i = 0; i < 3; i++)
        shape.end[i] = target[i];
    shape.extrusion = extrusion / shape.chords;
    shape.feedrate = fio_printer_feedrate(printer);
    if (printer->inverse > 0)
        shape.feedrate =
            printer->inverse * fabs(shape.angle) * shape.radius * printer->feedrate_percent / 100;
    printer->inverse = 0;
    shape.next = 1;
    printer->arc = shape;
    fio_printer_next_chord(printer);
    while (!printer->live && fio_printer_next_chord(printer))
        ;
}

bool fio_printer_next_chord(fio_virtual_printer *printer) {
    arc *shape = &printer->arc;
    if (shape->next > shape->chords)
        return false;
    int i = shape->next++;
    if (i == shape->chords) {
        fio_printer_move(printer, shape->end, shape->extrusion, shape->feedrate);
        return true;
    }
    double fraction = (double)i / shape->chords;
    double angle = shape->start_angle + shape->angle * fraction;
    double radius = shape->radius + shape->growth * fraction;
    double point[3] = {shape->centre[0] + radius * cos(angle),
                       shape->centre[1] + radius * sin(angle),
                       shape->start_z + (shape->end[2] - shape->start_z) * fraction};
    fio_printer_move(printer, point, shape->extrusion, shape->feedrate);
    return true;
}

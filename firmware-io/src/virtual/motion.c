/* Moves, their record, and the clock. */
#include <math.h>
#include <string.h>

#include "virtual/printer.h"

/* mm: below these a difference is rounding of the G-code's decimals or of sums of them. */
#define VOLUME_TOLERANCE 1e-6
#define RETRACTED_TOLERANCE 0.01
#define LEVEL_TOLERANCE 1e-4
/* mm: of a shorter path, rounded to micrometres, nobody can tell the flow. */
#define FLOW_LENGTH 0.02

#define DEFAULT_FEEDRATE 25. /* mm/s, before any F: Marlin's 1500 mm/min */

static fio_pending *pending_of(fio_virtual_printer *printer, int64_t sequence) {
    return &printer->pending[sequence & (FIO_PENDING - 1)];
}

static void flush_log(fio_virtual_printer *printer) {
    while (printer->logged < printer->sequence) {
        int64_t sequence = printer->logged + 1;
        fio_pending *pending = pending_of(printer, sequence);
        if (pending->blocks > 0 || (printer->open && sequence == printer->sequence))
            return;
        printer->logged = sequence;
        if (pending->dropped)
            continue;
        double read = printer->live ? pending->executed.start : 0;
        if (!pending->started)
            pending->executed.start = read > printer->log_clock ? read : printer->log_clock;
        printer->log_clock = pending->executed.start + pending->executed.duration;
        printer->log.entry(printer->log.context, &pending->executed);
    }
}

void fio_printer_spend(fio_virtual_printer *printer, int64_t sequence, double start, double seconds,
                       fio_activity activity) {
    if (printer->log.entry) {
        fio_pending *pending = pending_of(printer, sequence);
        if (!pending->started)
            pending->executed.start = start;
        pending->started = true;
        pending->executed.duration = printer->live ? start + seconds - pending->executed.start
                                                   : pending->executed.duration + seconds;
    }
    printer->statistics.time[activity] += seconds;
    printer->statistics.total_time += seconds;
}

static void pass_time(fio_virtual_printer *printer, int64_t sequence, double seconds,
                      fio_activity activity) {
    fio_printer_spend(printer, sequence, printer->clock, seconds, activity);
    printer->clock += seconds;
}

void fio_printer_block_done(fio_virtual_printer *printer, const fio_block *block) {
    if (!printer->log.entry)
        return;
    pending_of(printer, block->sequence)->blocks--;
    flush_log(printer);
}

static void take_block(fio_virtual_printer *printer) {
    fio_block block;
    double seconds = fio_planner_take(&printer->planner, &block);
    pass_time(printer, block.sequence, seconds, block.activity);
    fio_printer_block_done(printer, &block);
}

void fio_printer_drain(fio_virtual_printer *printer) {
    while (printer->planner.count > 0)
        take_block(printer);
    fio_planner_rest(&printer->planner);
}

void fio_printer_abandon(fio_virtual_printer *printer) {
    printer->planner.count = 0;
    printer->running = printer->ran_dry = false;
    fio_planner_rest(&printer->planner);
    int64_t end = printer->sequence + (printer->open ? 0 : 1);
    for (int64_t i = printer->logged + 1; printer->log.entry && i < end; i++) {
        fio_pending *pending = pending_of(printer, i);
        pending->dropped = pending->blocks > 0;
        pending->blocks = 0;
    }
}

void fio_printer_wait(fio_virtual_printer *printer, double seconds, fio_activity activity) {
    fio_printer_drain(printer);
    if (printer->live) {
        printer->waiting = seconds > 0;
        printer->wait_start = printer->clock;
        printer->wait_end = printer->clock + seconds;
        printer->wait_activity = activity;
        printer->wait_heater = NULL;
        printer->wait_user = false;
    } else if (seconds > 0)
        pass_time(printer, printer->sequence, seconds, activity);
}

void fio_printer_start_entry(fio_virtual_printer *printer, const fio_line *line) {
    fio_planner *planner = &printer->planner;
    int64_t sequence = ++printer->sequence;
    printer->open = true; /* before any flush: its place in the ring still holds an older entry */
    while (planner->count > 0 &&
           sequence - planner->blocks[planner->oldest].sequence >= FIO_PENDING)
        take_block(printer);
    if (!printer->log.entry)
        return;
    flush_log(printer);
    fio_pending *pending = pending_of(printer, sequence);
    pending->blocks = 0;
    pending->started = pending->dropped = false;
    memcpy(pending->text, line->text, (size_t)line->length + 1);
    pending->executed = (fio_executed){.line = printer->line,
                                       .number = line->number,
                                       .start = printer->clock,
                                       .text = pending->text,
                                       .length = (size_t)line->length};
}

void fio_printer_know_entry(fio_virtual_printer *printer, bool known) {
    if (printer->log.entry)
        pending_of(printer, printer->sequence)->executed.known = known;
}

void fio_printer_end_entry(fio_virtual_printer *printer) {
    printer->open = false;
    if (!printer->log.entry)
        return;
    fio_executed *executed = &pending_of(printer, printer->sequence)->executed;
    memcpy(executed->position, printer->machine, sizeof printer->machine);
    executed->position[3] = printer->e;
    flush_log(printer);
}

double fio_printer_feedrate(const fio_virtual_printer *printer) {
    double feedrate = printer->feedrate > 0 ? printer->feedrate : DEFAULT_FEEDRATE;
    return feedrate * printer->feedrate_percent / 100;
}

/* A, B and C: degrees, whatever the unit of length is. */
static void read_turn(fio_virtual_printer *printer, const fio_line *line) {
    double squared = 0, largest = 0;
    for (int i = 0; i < 3; i++) {
        if (!fio_line_has(line, (char)('A' + i)))
            continue;
        double value = fio_line_value(line, (char)('A' + i));
        double by = printer->absolute ? value - printer->angle[i] : value;
        printer->angle[i] += by;
        printer->statistics.turned[i] += fabs(by);
        squared += by * by;
        largest = fabs(by) > fabs(largest) ? by : largest;
    }
    printer->turn = copysign(sqrt(squared), largest);
}

/* With G93 each line needs its own. */
static void read_feedrate(fio_virtual_printer *printer, const fio_line *line) {
    bool given = fio_line_has(line, 'F');
    double value = given ? fio_line_value(line, 'F') / 60 : 0;
    if (printer->inverse_time)
        printer->inverse = value > 0 ? value : 0;
    else if (value > 0)
        printer->feedrate = value * printer->unit_length;
    if (value > 0 || (!given && !printer->inverse_time))
        return;
    fio_printer_event(printer, FIO_FAULT_BAD_FEEDRATE,
                      given ? "a feedrate that is not positive" : "no F, and G93 holds");
}

double fio_printer_target(fio_virtual_printer *printer, const fio_line *line, double target[3]) {
    static const uint32_t coordinates = 1u << ('X' - 'A') | 1u << ('Y' - 'A') | 1u << ('Z' - 'A') |
                                        1u << ('E' - 'A') | 1u << ('F' - 'A') | 1u << ('I' - 'A') |
                                        1u << ('J' - 'A') | 1u << ('R' - 'A') | 1u << ('A' - 'A') |
                                        1u << ('B' - 'A') | 1u << ('C' - 'A');
    if (line->stray >= 0)
        fio_printer_event_value(printer, FIO_FAULT_BAD_WORD,
                                "a byte that belongs to no word: ", line->stray, "");
    if (line->seen & ~line->valued & coordinates)
        fio_printer_event(printer, FIO_FAULT_BAD_WORD, "a word without a number, or an absurd one");
    for (int i = 0; i < 3; i++) {
        target[i] = printer->machine[i];
        if (!fio_line_has(line, (char)('X' + i)))
            continue;
        double value = fio_line_value(line, (char)('X' + i)) * printer->unit_length;
        target[i] = printer->absolute ? value - printer->offset[i] : target[i] + value;
    }
    read_turn(printer, line);
    read_feedrate(printer, line);
    if (!fio_line_has(line, 'E'))
        return 0;
    double value = fio_line_value(line, 'E') * printer->unit_length;
    double extrusion = printer->absolute_extrusion ? value - printer->e : value;
    printer->e = printer->absolute_extrusion ? value : printer->e + value;
    return extrusion;
}

/* The target within the volume, as the end stops leave it. */
static void clamp(fio_virtual_printer *printer, double clamped[3], const double target[3]) {
    static const char *const leave[3] = {"x goes to ", "y goes to ", "z goes to "};
    for (int i = 0; i < 3; i++) {
        double low = printer->options.origin[i], high = low + printer->options.size[i];
        clamped[i] = target[i];
        if (target[i] == printer->machine[i])
            continue;
        if (!printer->homed[i])
            fio_printer_event(printer, FIO_FAULT_NOT_HOMED, "a move before homing (G28)");
        if (target[i] >= low - VOLUME_TOLERANCE && target[i] <= high + VOLUME_TOLERANCE)
            continue;
        fio_printer_event_value(printer, FIO_FAULT_OUTSIDE, leave[i], target[i],
                                ", out of the volume");
        if (printer->end_stops)
            clamped[i] = target[i] < low ? low : high;
    }
}

/* What of the extrusion the firmware allows. */
static double allowed(fio_virtual_printer *printer, double extrusion) {
    fio_heater *nozzle = &printer->nozzle[printer->tool];
    double now = fio_heater_at(nozzle, printer->clock);
    if (now == nozzle->target && now != nozzle->temperature)
        fio_heater_set(nozzle, printer->clock, now); /* settled: no exponential from now on */
    if (!printer->allow_cold && now < printer->extrusion_minimum_temperature) {
        fio_printer_event_value(printer, FIO_FAULT_COLD_EXTRUSION,
                                "cold extrusion prevented, the nozzle has ", now, " C");
        return 0;
    }
    if (fabs(extrusion) > printer->options.extrusion_maximum_length) {
        fio_printer_event_value(printer, FIO_FAULT_LONG_EXTRUSION,
                                "too long extrusion prevented: ", extrusion, " mm");
        return 0;
    }
    return extrusion;
}

static void count_filament(fio_virtual_printer *printer, double extrusion, bool along_path) {
    fio_statistics *statistics = &printer->statistics;
    double before = statistics->retracted;
    if (extrusion < 0) {
        statistics->retracted = before - extrusion;
        statistics->retracted_length -= extrusion;
        if (before <= RETRACTED_TOLERANCE && statistics->retracted > RETRACTED_TOLERANCE)
            statistics->retractions++;
        return;
    }
    if (along_path) {
        statistics->extruded_along_paths += extrusion;
        if (before > RETRACTED_TOLERANCE)
            fio_printer_event_value(printer, FIO_WARNING_RETRACTED, "extruding while ", before,
                                    " mm of filament are retracted");
    }
    /* Priming before the first path is usual; later it is a blob. */
    bool printing = statistics->extruded_along_paths > 0;
    if (!along_path && printing && extrusion > before + RETRACTED_TOLERANCE)
        fio_printer_event_value(printer, FIO_WARNING_OVERPRIMED,
                                "pushed in place: ", extrusion - before,
                                " mm more than was retracted");
    double back = extrusion < before ? extrusion : before;
    statistics->retracted = before - back;
    statistics->unretracted_length += back;
    statistics->filament += extrusion - back;
    statistics->volume += (extrusion - back) * printer->filament_area;
    if (before > RETRACTED_TOLERANCE && statistics->retracted <= RETRACTED_TOLERANCE)
        statistics->unretractions++;
}

static void count_path(fio_virtual_printer *printer, const double end[3], double length,
                       double flow, bool first) {
    fio_statistics *statistics = &printer->statistics;
    const double *start = printer->machine;
    statistics->extrusion_length += length;
    for (int i = 0; i < 3; i++) {
        double low = start[i] < end[i] ? start[i] : end[i];
        double high = start[i] < end[i] ? end[i] : start[i];
        if (first || low < statistics->extrusion_minimum[i])
            statistics->extrusion_minimum[i] = low;
        if (first || high > statistics->extrusion_maximum[i])
            statistics->extrusion_maximum[i] = high;
    }
    /* A spiral's path is never level, so it counts as the one layer it stands on. */
    if (start[2] == end[2] && (first || fabs(end[2] - printer->extrusion_z) > LEVEL_TOLERANCE)) {
        statistics->layers++;
        printer->extrusion_z = end[2];
    }
    if (length < FLOW_LENGTH)
        return;
    if (flow > statistics->highest_flow)
        statistics->highest_flow = flow;
    if (flow > printer->options.maximum_flow * 1.0001)
        fio_printer_event_value(printer, FIO_WARNING_FLOW, "a flow of ", flow, " mm3/s");
}

void fio_printer_move(fio_virtual_printer *printer, const double target[3], double extrusion,
                      double feedrate) {
    fio_statistics *statistics = &printer->statistics;
    if (fio_planner_full(&printer->planner))
        take_block(printer);
    double end[3];
    clamp(printer, end, target);
    extrusion *= printer->flow_percent / 100;
    if (extrusion != 0)
        extrusion = allowed(printer, extrusion);
    double delta[5], nominal = 0, squared = 0;
    for (int i = 0; i < 3; i++) {
        delta[i] = end[i] - printer->machine[i];
        squared += delta[i] * delta[i];
    }
    delta[3] = extrusion;
    delta[4] = printer->turn;
    printer->turn = 0;
    if (printer->inverse > 0) {
        double length = squared >= 1e-16 ? sqrt(squared)
                        : delta[4] != 0  ? fabs(delta[4])
                                         : fabs(extrusion);
        feedrate = printer->inverse * length * printer->feedrate_percent / 100;
        printer->inverse = 0;
    }
    bool planned = fio_planner_add(&printer->planner, &printer->limits, delta, feedrate, &nominal);
    if (planned) {
        fio_block *block = fio_planner_newest(&printer->planner);
        bool level = delta[0] != 0 || delta[1] != 0 || delta[4] != 0;
        bool moves = level || delta[2] != 0;
        bool along_path = extrusion > 0 && moves;
        bool first = statistics->extruded_along_paths == 0;
        double mm = squared >= 1e-16 ? block->length : 0; /* nobody knows the part's radius */
        block->sequence = printer->sequence;
        memcpy(block->start, printer->machine, sizeof block->start);
        memcpy(block->end, end, sizeof end);
        block->activity = along_path ? FIO_EXTRUDING
                          : !moves   ? FIO_RETRACTING
                          : level    ? FIO_TRAVELLING
                                     : FIO_LIFTING;
        if (printer->log.entry)
            pending_of(printer, printer->sequence)->blocks++;
        if (printer->live)
            fio_printer_added(printer, along_path);
        if (extrusion != 0)
            count_filament(printer, extrusion, along_path);
        if (along_path)
            count_path(printer, end, mm,
                       extrusion / block->length * nominal * printer->filament_area, first);
        else if (moves)
            statistics->travel_length += mm;
    }
    memcpy(printer->machine, end, sizeof end);
}

void fio_printer_home(fio_virtual_printer *printer, const bool axes[3]) {
    const fio_virtual_options *options = &printer->options;
    double seconds = 0;
    for (int i = 0; i < 3; i++) {
        if (!axes[i])
            continue;
        /* Nobody knows where an axis stands before homing: half its length is the mean. */
        double way = printer->homed[i] ? fabs(printer->machine[i] - options->origin[i])
                                       : options->size[i] / 2;
        seconds += way / options->homing_feedrate[i];
        printer->machine[i] = options->origin[i];
        printer->offset[i] = 0;
        printer->homed[i] = true;
    }
    fio_printer_wait(printer, seconds, FIO_HOMING);
}

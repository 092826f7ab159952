/* A printer in outside time: blocks are taken when time reaches them. */
#include <math.h>

#include "virtual/printer.h"

/* Marlin gives the look-ahead a chance: the first block after a rest begins when there are three of
 * them, or this late (BLOCK_DELAY_FOR_1ST_MOVE). */
#define FIRST_BLOCK_DELAY 0.1 /* s */
#define BLOCKS_TO_BEGIN 3
#define ROUNDING 1e-6 /* °C */

void fio_printer_live(fio_virtual_printer *printer, double now) {
    printer->live = true;
    printer->clock = printer->log_clock = now;
}

static void begin_block(fio_virtual_printer *printer, double at) {
    double seconds = fio_planner_take(&printer->planner, &printer->block);
    printer->running = true;
    printer->block_start = at;
    printer->block_end = at + seconds;
}

static void end_block(fio_virtual_printer *printer) {
    fio_block done = printer->block;
    double start = printer->block_start, end = printer->block_end;
    printer->running = false;
    printer->clock = end;
    fio_printer_spend(printer, done.sequence, start, end - start, done.activity);
    if (printer->planner.count > 0)
        begin_block(printer, end);
    else
        printer->ran_dry = done.activity == FIO_EXTRUDING;
    fio_printer_block_done(printer, &done);
}

double fio_printer_next(const fio_virtual_printer *printer) {
    if (printer->running)
        return printer->block_end;
    return printer->planner.count > 0 ? printer->delayed_start : INFINITY;
}

void fio_printer_advance(fio_virtual_printer *printer, double now) {
    for (double next; (next = fio_printer_next(printer)) <= now;) {
        if (printer->running)
            end_block(printer);
        else
            begin_block(printer, next);
    }
    if (now > printer->clock)
        printer->clock = now;
}

void fio_printer_added(fio_virtual_printer *printer, bool along_path) {
    if (printer->ran_dry && along_path)
        printer->starved++;
    printer->ran_dry = false;
    if (printer->running)
        return;
    if (printer->planner.count == 1)
        printer->delayed_start = printer->clock + FIRST_BLOCK_DELAY;
    else if (printer->planner.count >= BLOCKS_TO_BEGIN)
        begin_block(printer, printer->clock);
}

void fio_printer_stop(fio_virtual_printer *printer) {
    const fio_planner *planner = &printer->planner;
    const fio_block *block = &printer->block;
    if (printer->running) { /* a constant speed is near enough */
        double took = printer->block_end - printer->block_start;
        double done = took > 0 ? (printer->clock - printer->block_start) / took : 1;
        for (int i = 0; i < 3; i++)
            printer->machine[i] = block->start[i] + (block->end[i] - block->start[i]) * done;
    } else if (planner->count > 0) {
        for (int i = 0; i < 3; i++)
            printer->machine[i] = planner->blocks[planner->oldest].start[i];
    }
    fio_printer_abandon(printer);
}

int fio_printer_moves_free(const fio_virtual_printer *printer) {
    /* One place of Marlin's ring stays empty; the block being made keeps its own. */
    int used = printer->planner.count + (printer->running ? 1 : 0);
    int left = printer->planner.capacity - 1 - used;
    return left > 0 ? left : 0;
}

static bool makes_moves(const fio_line *line) {
    return line->letter == 'G' && (line->code <= 3 || line->code == 10 || line->code == 11);
}

static bool drains(const fio_line *line) {
    static const short codes[] = {0, 1, 18, 84, 109, 190, 400, 600};
    if (line->letter == 'G')
        return line->code == 4 || line->code == 28 || line->code == 29;
    if (line->letter == 'T')
        return true;
    for (size_t i = 0; line->letter == 'M' && i < sizeof codes / sizeof *codes; i++)
        if (line->code == codes[i])
            return true;
    return false;
}

bool fio_printer_ready(fio_virtual_printer *printer, const fio_line *line) {
    const fio_planner *planner = &printer->planner;
    bool moving = printer->running || planner->count > 0;
    if (!moving) {
        if (drains(line))
            printer->ran_dry = false; /* it stands still because it was told to */
        return true;
    }
    int64_t oldest =
        printer->running ? printer->block.sequence : planner->blocks[planner->oldest].sequence;
    if (printer->sequence + 1 - oldest >= FIO_PENDING)
        return false; /* the log's ring is full */
    return !drains(line) && (!makes_moves(line) || fio_printer_moves_free(printer) > 0);
}

void fio_printer_end_wait(fio_virtual_printer *printer) {
    fio_heater *heater = printer->wait_heater;
    printer->waiting = false;
    fio_printer_spend(printer, printer->sequence, printer->wait_start,
                      printer->clock - printer->wait_start, printer->wait_activity);
    if (!heater)
        return;
    fio_heater_set(heater, printer->clock, heater->target);
    if (heater->target > 0 && fabs(heater->temperature - heater->target) < ROUNDING)
        heater->temperature = heater->target;
}

void fio_printer_run_out(fio_virtual_printer *printer) {
    while (printer->running || printer->planner.count > 0)
        fio_printer_advance(printer, fio_printer_next(printer));
}

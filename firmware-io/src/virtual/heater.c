#include "virtual/heater.h"

#include <math.h>
#include <stdbool.h>

#define OPEN_READING -14.  /* °C: what Marlin's tables give for no current … */
#define SHORT_READING 938. /* … and for a wire to ground */

/* Where T tends to, and where it stops on the way: the target, if it lies on the way. */
static double tendency(const fio_heater *heater) {
    bool heats = heater->health == FIO_HEATER_STUCK ||
                 (heater->health != FIO_HEATER_DEAD && heater->target > heater->temperature);
    return heats ? heater->options.full_power : heater->room;
}

static bool controlled(const fio_heater *heater) {
    return heater->health != FIO_HEATER_DEAD && heater->health != FIO_HEATER_STUCK;
}

double fio_heater_reading(const fio_heater *heater, double time) {
    return heater->health == FIO_THERMISTOR_OPEN    ? OPEN_READING
           : heater->health == FIO_THERMISTOR_SHORT ? SHORT_READING
                                                    : fio_heater_at(heater, time);
}

double fio_heater_at(const fio_heater *heater, double time) {
    double from = heater->temperature, target = heater->target, limit = tendency(heater);
    if ((from == target && controlled(heater)) || time <= heater->time || from == limit)
        return from;
    double decay = exp(-(time - heater->time) / heater->options.time_constant);
    double now = limit + (from - limit) * decay;
    if (!controlled(heater))
        return now;
    if (target > from)
        return now < target ? now : target;
    return now > target ? now : target;
}

void fio_heater_set(fio_heater *heater, double time, double target) {
    heater->temperature = fio_heater_at(heater, time);
    heater->time = time;
    heater->target = target;
}

double fio_heater_wait(const fio_heater *heater, double time) {
    double now = fio_heater_at(heater, time), target = heater->target;
    if (now == target)
        return 0;
    if (heater->health == FIO_HEATER_DEAD && target > now)
        return INFINITY;
    if (heater->health == FIO_HEATER_STUCK && target < now)
        return INFINITY;
    if (target > now) {
        double limit = heater->options.full_power;
        return heater->options.time_constant * log((limit - now) / (limit - target));
    }
    double goal = target + 1, room = heater->room;
    if (now <= goal)
        return 0;
    return goal > room ? heater->options.time_constant * log((now - room) / (goal - room))
                       : INFINITY;
}

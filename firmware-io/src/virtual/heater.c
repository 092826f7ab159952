#include "virtual/heater.h"

#include <math.h>

/* Where T tends to, and where it stops on the way: the target, if it lies on the way. */
static double tendency(const fio_heater *heater) {
    return heater->target > heater->temperature ? heater->options.full_power : heater->room;
}

double fio_heater_at(const fio_heater *heater, double time) {
    double from = heater->temperature, target = heater->target, limit = tendency(heater);
    if (from == target || time <= heater->time || from == limit)
        return from;
    double decay = exp(-(time - heater->time) / heater->options.time_constant);
    double now = limit + (from - limit) * decay;
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

/* Marlin's thermal protection: what heats too slowly, cools while it is heated, or shows impossible
 * temperatures stops the machine. Times and degrees are Marlin's own. */
#include <math.h>

#include "virtual/machine.h"

#define CHECK_SECONDS 1
#define RISE 2     /* °C that have to be gained … */
#define TOO_HOT 15 /* °C above the highest target allowed */
#define NEAR 0.5   /* °C below the target: it is reached */

static const struct protection {
    double watch_seconds; /* … within this */
    double period, hysteresis;
} protections[2] = {{20, 40, 4}, {60, 20, 2}}; /* nozzle, bed */

static bool on_watch(const fio_heater *heater) {
    return heater->target > 0 || heater->health != FIO_HEATER_WELL;
}

static const fio_heater *heater_of(const fio_machine *machine, int index) {
    return index < FIO_TOOLS_MOST ? &machine->printer->nozzle[index] : &machine->printer->bed;
}

double fio_thermal_next(const fio_machine *machine) {
    for (int i = 0; i <= FIO_TOOLS_MOST; i++)
        if (on_watch(heater_of(machine, i)))
            return machine->thermal_at;
    return INFINITY;
}

static void start_watch(fio_watch *watch, const struct protection *rule, double now, double reading,
                        double target) {
    bool far = target > reading + rule->hysteresis + RISE;
    watch->at = far ? now + rule->watch_seconds : INFINITY;
    watch->temperature = reading + RISE;
}

/* What is wrong; NULL: nothing. */
static const char *complaint(fio_watch *watch, const fio_heater *heater,
                             const struct protection *rule, double now) {
    double reading = fio_heater_reading(heater, now), target = heater->target;
    if (reading > heater->options.maximum + TOO_HOT)
        return "MAXTEMP triggered";
    if (target > 0 && reading < 0 && heater->health == FIO_THERMISTOR_OPEN)
        return "MINTEMP triggered";
    if (target != watch->target) {
        watch->target = target;
        watch->stable = false;
        start_watch(watch, rule, now, reading, target);
    }
    if (target == 0)
        return NULL;
    if (reading >= watch->temperature)
        start_watch(watch, rule, now, reading, target);
    else if (now >= watch->at)
        return "Heating failed";
    if (reading >= target - (watch->stable ? rule->hysteresis : NEAR)) {
        watch->stable = true;
        watch->at = INFINITY;
        watch->runaway_at = now + rule->period;
    } else if (watch->stable && now >= watch->runaway_at)
        return "Thermal Runaway";
    return NULL;
}

void fio_thermal_check(fio_machine *machine) {
    if (machine->now < machine->thermal_at)
        return;
    machine->thermal_at = machine->now + CHECK_SECONDS;
    for (int i = 0; i <= FIO_TOOLS_MOST; i++) {
        bool bed = i == FIO_TOOLS_MOST;
        const fio_heater *heater = heater_of(machine, i);
        const char *why = complaint(&machine->watches[i], heater, &protections[bed], machine->now);
        if (!why)
            continue;
        char bytes[96], name[2] = {(char)('0' + i), 0};
        fio_text text = fio_text_in(bytes, sizeof bytes);
        fio_text_string(&text, "Error:");
        fio_text_string(&text, why);
        fio_text_string(&text, ", system stopped! Heater_ID: ");
        fio_text_string(&text, bed ? "bed" : name);
        fio_firmware_kill(machine, bytes);
        return;
    }
}

/* A heater under perfect control: T follows the first-order curve to its target and stays. */
#ifndef FIO_VIRTUAL_HEATER_H
#define FIO_VIRTUAL_HEATER_H

#include <isoprint/virtual_printer.h>

typedef enum fio_heater_health {
    FIO_HEATER_WELL,
    FIO_HEATER_DEAD,      /* does not heat, whatever it is told */
    FIO_HEATER_STUCK,     /* heats at full power, whatever it is told */
    FIO_THERMISTOR_OPEN,  /* reads far too cold */
    FIO_THERMISTOR_SHORT, /* reads far too hot */
} fio_heater_health;

typedef struct fio_heater {
    fio_heater_health health;
    double temperature; /* at `time` */
    double time;
    double target; /* 0 = off */
    double room;
    fio_heater_options options;
} fio_heater;

/* T at `time`, not before the heater's own. */
double fio_heater_at(const fio_heater *heater, double time);

/* What its thermistor shows. */
double fio_heater_reading(const fio_heater *heater, double time);

void fio_heater_set(fio_heater *heater, double time, double target);

/* Seconds from `time` until T is at the target: 0 if it is there, INFINITY if it never is. Cooling
 * ends at the target only asymptotically close to the room, so it counts as there within 1 degree.
 */
double fio_heater_wait(const fio_heater *heater, double time);

#endif

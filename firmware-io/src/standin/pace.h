/* The machine's clock against ours: as fast, so many times faster, or jumping over what it works
 * at. Machine time is in seconds and starts at 0. */
#ifndef FIO_STANDIN_PACE_H
#define FIO_STANDIN_PACE_H

#include <stdbool.h>

typedef struct fio_pace {
    double speed;  /* machine seconds a second */
    bool instant;  /* may jump besides, by fio_pace_skip() */
    double origin; /* our clock's at machine time 0 */
    double skipped;
} fio_pace;

/* `speed` 0: instant, and as fast as ours where nothing is worked at. */
fio_pace fio_pace_start(double speed);
double fio_pace_now(const fio_pace *pace);

/* Our seconds until this machine time; 0 if it is over. */
double fio_pace_until(const fio_pace *pace, double time);

/* Let the clock stand at `time`, if that is later than now. */
void fio_pace_skip(fio_pace *pace, double time);

#endif

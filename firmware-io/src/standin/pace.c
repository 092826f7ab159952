#include "standin/pace.h"

#include <time.h>

static double monotonic(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + (double)time.tv_nsec * 1e-9;
}

fio_pace fio_pace_start(double speed) {
    return (fio_pace){
        .speed = speed > 0 ? speed : 1, .instant = !(speed > 0), .origin = monotonic()};
}

double fio_pace_now(const fio_pace *pace) {
    return (monotonic() - pace->origin) * pace->speed + pace->skipped;
}

double fio_pace_until(const fio_pace *pace, double time) {
    double seconds = (time - fio_pace_now(pace)) / pace->speed;
    return seconds > 0 ? seconds : 0;
}

void fio_pace_skip(fio_pace *pace, double time) {
    double ahead = time - fio_pace_now(pace);
    if (ahead > 0)
        pace->skipped += ahead;
}

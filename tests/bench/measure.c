#include "measure.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { ROUNDS_MOST = 200 };

/* Rounds go on until they took this long together. */
#define ENOUGH_SECONDS 0.1

static double seconds_of(clockid_t clock) {
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

double bench_cpu_clock(void) {
    return seconds_of(CLOCK_PROCESS_CPUTIME_ID);
}

double bench_wall_clock(void) {
    return seconds_of(CLOCK_MONOTONIC);
}

double bench_least(void (*run)(void *payload), void (*reset)(void *payload), void *payload) {
    double least = 0, sum = 0;
    for (int i = 0; i < BENCH_ROUNDS || (sum < ENOUGH_SECONDS && i < ROUNDS_MOST); i++) {
        double begun = bench_cpu_clock();
        run(payload);
        double took = bench_cpu_clock() - begun;
        if (reset)
            reset(payload);
        if (i == 0 || took < least)
            least = took;
        sum += took;
    }
    return least;
}

void bench_must(iso_status status, const char *what) {
    if (status == ISO_OK)
        return;
    fprintf(stderr, "bench-stages: %s: %s\n", what, iso_error_message());
    exit(status);
}

void bench_must_system(int good, const char *what) {
    if (good)
        return;
    fprintf(stderr, "bench-stages: %s: %s\n", what, strerror(errno));
    exit(1);
}

void *bench_allocate(int64_t size) {
    void *block = malloc(size > 0 ? (size_t)size : 1);
    bench_must_system(block != NULL, "memory");
    return block;
}

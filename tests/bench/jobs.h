/* Whole jobs, each in a process of its own. */
#ifndef TESTS_BENCH_JOBS_H
#define TESTS_BENCH_JOBS_H

#include <stdint.h>

enum { BENCH_STAGES_MOST = 16 };

typedef struct bench_job {
    double cpu;        /* s, user and system: the least of all runs */
    double cpu_median; /* s */
    double wall;       /* s, the least */
    int64_t kib;       /* peak memory, the least */
    int32_t stage_count;
    char stage[BENCH_STAGES_MOST][16];
    double seconds[BENCH_STAGES_MOST]; /* of each stage, in the run of the least CPU */
    int64_t bytes;                     /* of the G-code */
} bench_job;

/* Run this program anew as `--job` once and again: at least BENCH_ROUNDS times, 20 times if that is
 * quick. To be called while this process is still small, for a new process begins with the
 * memory of the one it came from. */
void jobs_measure(bench_job *job, const char *model, int threads, double density,
                  const char *output);

/* A process that does nothing: `true`. */
void jobs_measure_nothing(bench_job *job);

/* What `--job MODEL THREADS DENSITY OUTPUT DESCRIPTOR` does. Returns the exit code. */
int jobs_main(char **argument);

#endif

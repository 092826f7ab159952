/* What the benchmarks measure with: CPU time of the process, the least of several rounds, since
 * whatever else the machine does can only add to it. */
#ifndef TESTS_BENCH_MEASURE_H
#define TESTS_BENCH_MEASURE_H

#include <stdint.h>

#include <isoslice/status.h>

enum { BENCH_ROUNDS = 5 };

double bench_cpu_clock(void);  /* s of CPU, all threads of this process */
double bench_wall_clock(void); /* s */

/* Least CPU seconds of run(payload) over at least BENCH_ROUNDS rounds, more if they are short.
 * reset(payload), not counted, follows each; NULL: none. */
double bench_least(void (*run)(void *payload), void (*reset)(void *payload), void *payload);

/* End the program with the library's message unless all is well. */
void bench_must(iso_status status, const char *what);

/* The same for the system's functions: errno is read. */
void bench_must_system(int good, const char *what);

/* Memory or the end of the program. */
void *bench_allocate(int64_t size);

#endif

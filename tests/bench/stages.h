/* Each stage by itself, with the floor beside it. */
#ifndef TESTS_BENCH_STAGES_H
#define TESTS_BENCH_STAGES_H

#include "part.h"

typedef struct bench_rate {
    double amount; /* in millions, of one round */
    const char *unit;
} bench_rate;

typedef struct bench_row {
    const char *stage;
    double seconds;
    bench_rate rate[2]; /* the second may be of no unit: none */
    const char *floor;
    double floor_seconds;
} bench_row;

enum { BENCH_ROWS_MOST = 24 };

typedef struct bench_table {
    int count;
    bench_row row[BENCH_ROWS_MOST];
} bench_table;

/* Measure all stages of a model, on this thread alone. `scratch_path` names a file to be written
 * and removed. */
void stages_measure(bench_table *table, const char *path, const iso_options *options,
                    const char *scratch_path);

#endif

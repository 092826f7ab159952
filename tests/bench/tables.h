/* How the figures are shown. */
#ifndef TESTS_BENCH_TABLES_H
#define TESTS_BENCH_TABLES_H

#include "jobs.h"
#include "stages.h"

enum { BENCH_JOBS = 4 }; /* 1 and 2 threads at 15 %, then at 100 % */

typedef struct bench_model {
    char name[64];
    bench_table stages;
    bench_job job[BENCH_JOBS];
} bench_model;

/* The name of a file without its folder and its ".stl". */
void tables_name(bench_model *model, const char *path);

void tables_print(const bench_model *model, const bench_job *nothing);
void tables_print_markdown(const bench_model *model, int count, const bench_job *nothing);

#endif

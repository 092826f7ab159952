#include "tables.h"

#include <stdio.h>
#include <string.h>

static const char *const job_name[BENCH_JOBS] = {"15 %, 1 thread", "15 %, 2 threads",
                                                 "solid, 1 thread", "solid, 2 threads"};

void tables_name(bench_model *model, const char *path) {
    const char *slash = strrchr(path, '/');
    snprintf(model->name, sizeof model->name, "%s", slash ? slash + 1 : path);
    char *end = strstr(model->name, ".stl");
    if (end)
        *end = 0;
}

static double per_second(const bench_row *row, int k) {
    return row->seconds > 0 ? row->rate[k].amount / row->seconds : 0;
}

static double ratio(const bench_row *row) {
    return row->floor_seconds > 0 ? row->seconds / row->floor_seconds : 0;
}

static double share(const bench_job *job, int32_t stage) {
    double sum = 0;
    for (int32_t i = 0; i < job->stage_count; i++)
        sum += job->seconds[i];
    return sum > 0 ? 100 * job->seconds[stage] / sum : 0;
}

static void print_job(const char *name, const bench_job *job) {
    printf("  %-18s %9.1f %9.1f %9.1f", name, 1e3 * job->cpu, 1e3 * job->cpu_median,
           1e3 * job->wall);
    if (job->bytes)
        printf(" %9.1f %9.2f", (double)job->kib / 1024, 1e-6 * (double)job->bytes);
    putchar('\n');
}

void tables_print(const bench_model *model, const bench_job *nothing) {
    printf("%s\n  %-20s %9s   %-26s %-12s %9s %7s\n", model->name, "stage", "CPU ms", "rate",
           "floor", "CPU ms", "ratio");
    for (int i = 0; i < model->stages.count; i++) {
        const bench_row *row = &model->stages.row[i];
        printf("  %-20s %9.3f %8.2f %-20s %-12s %9.3f %7.2f\n", row->stage, 1e3 * row->seconds,
               per_second(row, 0), row->rate[0].unit, row->floor, 1e3 * row->floor_seconds,
               ratio(row));
        if (row->rate[1].unit)
            printf("  %-20s %9s %8.2f %s\n", "", "", per_second(row, 1), row->rate[1].unit);
    }
    printf("  %-18s %9s %9s %9s %9s %9s\n", "whole job", "CPU ms", "median", "wall ms", "MiB",
           "MB out");
    for (int k = 0; k < BENCH_JOBS; k++)
        print_job(job_name[k], &model->job[k]);
    print_job("nothing (true)", nothing);
    for (int k = 0; k < BENCH_JOBS; k += 2) {
        printf("  share, %s:", job_name[k]);
        for (int32_t i = 0; i < model->job[k].stage_count; i++)
            printf(" %s %.0f %%", model->job[k].stage[i], share(&model->job[k], i));
        putchar('\n');
    }
    fflush(stdout);
}

/* Three digits, never an exponent. */
static void print_short(const char *before, double value, const char *after) {
    printf("%s%.*f%s", before, value < 9.995 ? 2 : value < 99.95 ? 1 : 0, value, after);
}

static void print_stages_markdown(const bench_model *model, int count) {
    printf("| stage | rate in | floor |");
    for (int m = 0; m < count; m++)
        printf(" %s |", model[m].name);
    printf("\n|---|---|---|");
    for (int m = 0; m < count; m++)
        printf("---:|");
    putchar('\n');
    for (int i = 0; i < model->stages.count; i++) {
        const bench_row *kind = &model->stages.row[i];
        printf("| %s | %s", kind->stage, kind->rate[0].unit);
        if (kind->rate[1].unit)
            printf("; %s", kind->rate[1].unit);
        printf(" | %s |", kind->floor);
        for (int m = 0; m < count; m++) {
            const bench_row *row = &model[m].stages.row[i];
            print_short(" ", per_second(row, 0), "");
            if (row->rate[1].unit)
                print_short("; ", per_second(row, 1), "");
            print_short(" (**", ratio(row), "**) |");
        }
        putchar('\n');
    }
}

static void print_jobs_markdown(const bench_model *model, int count, const bench_job *nothing) {
    printf("\n| model | job | CPU ms | median | wall ms | MiB | MB of G-code |\n"
           "|---|---|---:|---:|---:|---:|---:|\n");
    for (int m = 0; m < count; m++)
        for (int k = 0; k < BENCH_JOBS; k++) {
            const bench_job *job = &model[m].job[k];
            printf("| %s | %s | %.1f | %.1f | %.1f | %.1f | %.2f |\n", model[m].name, job_name[k],
                   1e3 * job->cpu, 1e3 * job->cpu_median, 1e3 * job->wall, (double)job->kib / 1024,
                   1e-6 * (double)job->bytes);
        }
    printf("| | `true` | %.1f | %.1f | %.1f | | |\n", 1e3 * nothing->cpu, 1e3 * nothing->cpu_median,
           1e3 * nothing->wall);
}

static void print_shares_markdown(const bench_model *model, int count) {
    printf("\n| share of the time, 1 thread |");
    for (int32_t i = 0; i < model->job[0].stage_count; i++)
        printf(" %s |", model->job[0].stage[i]);
    printf("\n|---|");
    for (int32_t i = 0; i < model->job[0].stage_count; i++)
        printf("---:|");
    putchar('\n');
    for (int m = 0; m < count; m++)
        for (int k = 0; k < BENCH_JOBS; k += 2) {
            printf("| %s, %s |", model[m].name, k ? "solid" : "15 %");
            for (int32_t i = 0; i < model[m].job[k].stage_count; i++)
                printf(" %.0f %% |", share(&model[m].job[k], i));
            putchar('\n');
        }
}

void tables_print_markdown(const bench_model *model, int count, const bench_job *nothing) {
    print_stages_markdown(model, count);
    print_jobs_markdown(model, count, nothing);
    print_shares_markdown(model, count);
}

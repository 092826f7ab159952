#include "jobs.h"

#include <isoslice/job.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "measure.h"
#include "part.h"

enum { RUNS_MOST = 20 };

/* Runs go on, up to RUNS_MOST, until they took this long together. */
#define ENOUGH_SECONDS 2.0

/* What the process of a job sends home. */
typedef struct news {
    int64_t kib, bytes;
    int32_t stage_count;
    char stage[BENCH_STAGES_MOST][16];
    double seconds[BENCH_STAGES_MOST];
} news;

int jobs_main(char **argument) {
    static iso_options options;
    iso_report report = {0};
    iso_job_hooks hooks = {.threads = atoi(argument[1])};
    const char *model = argument[0];
    part_options(&options, atof(argument[2]));
    bench_must(iso_job_run(&report, &options, &model, 1, argument[3], &hooks), model);
    news n = {.kib = report.peak_memory_kib, .bytes = report.print.bytes};
    for (int32_t i = 0; i < report.stage_count && i < BENCH_STAGES_MOST; i++) {
        snprintf(n.stage[i], sizeof n.stage[i], "%s", report.stage[i].name);
        n.seconds[i] = report.stage[i].seconds;
        n.stage_count = i + 1;
    }
    bench_must_system(write(atoi(argument[4]), &n, sizeof n) == sizeof n, "pipe");
    iso_report_free(&report);
    return 0;
}

static double children_cpu(void) {
    struct rusage usage;
    getrusage(RUSAGE_CHILDREN, &usage);
    return (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
           1e-6 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

/* CPU seconds of a process that runs `argument`, and what it says at the pipe's end `from`. */
static double run(char *const *argument, double *wall, news *n, int from, int to) {
    double cpu = children_cpu(), begun = bench_wall_clock();
    pid_t child = fork();
    bench_must_system(child >= 0, "fork");
    if (child == 0) {
        if (from >= 0)
            close(from);
        execvp(argument[0], argument);
        _exit(127);
    }
    if (to >= 0)
        close(to);
    int status, good = from < 0 || read(from, n, sizeof *n) == sizeof *n;
    bench_must_system(waitpid(child, &status, 0) == child, "waitpid");
    *wall = bench_wall_clock() - begun;
    if (!good || !WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        fprintf(stderr, "bench-stages: %s failed\n", argument[0]);
        exit(1);
    }
    if (from >= 0)
        close(from);
    return children_cpu() - cpu;
}

static void keep_least(bench_job *job, int number, double cpu, double wall, const news *n) {
    if (number == 0 || wall < job->wall)
        job->wall = wall;
    if (number == 0 || n->kib < job->kib)
        job->kib = n->kib;
    if (number > 0 && cpu >= job->cpu)
        return;
    job->cpu = cpu;
    job->bytes = n->bytes;
    job->stage_count = n->stage_count;
    memcpy(job->stage, n->stage, sizeof job->stage);
    memcpy(job->seconds, n->seconds, sizeof job->seconds);
}

static int ascending(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void find_median(bench_job *job, double *cpu, int count) {
    qsort(cpu, (size_t)count, sizeof *cpu, ascending);
    job->cpu_median = (cpu[count / 2] + cpu[(count - 1) / 2]) / 2;
}

void jobs_measure(bench_job *job, const char *model, int threads, double density,
                  const char *output) {
    char thread_text[16], density_text[32], pipe_text[16];
    double cpu[RUNS_MOST], sum = 0;
    int count = 0;
    *job = (bench_job){0};
    for (; count < BENCH_ROUNDS || (count < RUNS_MOST && sum < ENOUGH_SECONDS); count++) {
        int ends[2];
        news n = {0};
        double wall;
        bench_must_system(pipe(ends) == 0, "pipe");
        snprintf(thread_text, sizeof thread_text, "%d", threads);
        snprintf(density_text, sizeof density_text, "%g", density);
        snprintf(pipe_text, sizeof pipe_text, "%d", ends[1]);
        char *argument[] = {"/proc/self/exe", "--job",        (char *)model, thread_text,
                            density_text,     (char *)output, pipe_text,     NULL};
        cpu[count] = run(argument, &wall, &n, ends[0], ends[1]);
        keep_least(job, count, cpu[count], wall, &n);
        sum += wall;
    }
    unlink(output);
    find_median(job, cpu, count);
}

void jobs_measure_nothing(bench_job *job) {
    char *argument[] = {"true", NULL};
    double cpu[RUNS_MOST];
    *job = (bench_job){0};
    for (int i = 0; i < RUNS_MOST; i++) {
        double wall;
        cpu[i] = run(argument, &wall, NULL, -1, -1);
        keep_least(job, i, cpu[i], wall, &(news){0});
    }
    find_median(job, cpu, RUNS_MOST);
}

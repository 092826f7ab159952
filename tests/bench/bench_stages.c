/* bench-stages [--check | --markdown] MODEL.stl|FOLDER...
 *
 * What each stage costs, beside the floor under it; docs/speed.md says how to read it. */
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "checks.h"
#include "jobs.h"
#include "measure.h"
#include "stages.h"
#include "tables.h"

enum { MODELS_MOST = 64 };

typedef struct arguments {
    bool check, markdown;
    int model_count;
    char *model[MODELS_MOST];
} arguments;

static int is_stl(const struct dirent *entry) {
    size_t length = strlen(entry->d_name);
    return length > 4 && strcmp(entry->d_name + length - 4, ".stl") == 0;
}

static void add_model(arguments *given, const char *folder, const char *name) {
    if (given->model_count == MODELS_MOST) {
        fprintf(stderr, "bench-stages: more than %d models\n", MODELS_MOST);
        exit(2);
    }
    size_t size = strlen(folder) + strlen(name) + 2;
    char *path = bench_allocate((int64_t)size);
    snprintf(path, size, "%s%s%s", folder, *folder ? "/" : "", name);
    given->model[given->model_count++] = path;
}

static void add_path(arguments *given, const char *path) {
    struct stat about;
    bench_must_system(stat(path, &about) == 0, path);
    if (!S_ISDIR(about.st_mode)) {
        add_model(given, "", path);
        return;
    }
    struct dirent **entry;
    int count = scandir(path, &entry, is_stl, alphasort);
    bench_must_system(count >= 0, path);
    for (int i = 0; i < count; i++) {
        add_model(given, path, entry[i]->d_name);
        free(entry[i]);
    }
    free(entry);
}

static void measure(const arguments *given, const char *scratch_path) {
    static const double density[BENCH_JOBS] = {15, 15, 100, 100};
    static iso_options options;
    static bench_model model[MODELS_MOST];
    bench_job nothing;
    jobs_measure_nothing(&nothing);
    for (int m = 0; m < given->model_count; m++)
        for (int k = 0; k < BENCH_JOBS; k++)
            jobs_measure(&model[m].job[k], given->model[m], 1 + k % 2, density[k], scratch_path);
    part_options(&options, 15);
    for (int m = 0; m < given->model_count; m++) {
        tables_name(&model[m], given->model[m]);
        stages_measure(&model[m].stages, given->model[m], &options, scratch_path);
        if (!given->markdown)
            tables_print(&model[m], &nothing);
    }
    if (given->markdown)
        tables_print_markdown(model, given->model_count, &nothing);
}

static int check(const arguments *given, const char *scratch_path) {
    static iso_options options;
    int broken = 0;
    part_options(&options, 15);
    for (int m = 0; m < given->model_count; m++)
        broken += checks_run(given->model[m], &options, scratch_path);
    return broken;
}

/* In memory if there is a place for it: how long a disk takes is not the engine's doing. */
static void make_folder(char *folder, size_t size) {
    const char *place = getenv("TMPDIR");
    if (!place || !*place)
        place = access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp";
    snprintf(folder, size, "%s/bench-stages-XXXXXX", place);
    bench_must_system(mkdtemp(folder) != NULL, folder);
}

int main(int count, char **argument) {
    arguments given = {0};
    if (count == 7 && strcmp(argument[1], "--job") == 0)
        return jobs_main(argument + 2);
    for (int i = 1; i < count; i++) {
        if (strcmp(argument[i], "--check") == 0)
            given.check = true;
        else if (strcmp(argument[i], "--markdown") == 0)
            given.markdown = true;
        else
            add_path(&given, argument[i]);
    }
    if (given.model_count == 0) {
        fprintf(stderr, "bench-stages [--check | --markdown] MODEL.stl|FOLDER...\n");
        return 2;
    }
    char folder[512], path[600];
    make_folder(folder, sizeof folder);
    snprintf(path, sizeof path, "%s/part.gcode", folder);
    int broken = 0;
    if (given.check)
        broken = check(&given, path);
    else
        measure(&given, path);
    rmdir(folder);
    for (int m = 0; m < given.model_count; m++)
        free(given.model[m]);
    return broken > 0;
}

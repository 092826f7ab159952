/* Modules that are there, missing, broken or of another version. What is opened stays open, so each
 * case is a run of this program by itself: "open" says what came of it. */
#include "solid/module.h"

#include <libgen.h>
#include <limits.h>
#include <pthread.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "check.h"

static char self[PATH_MAX], folder[] = "/tmp/isoslice-module-XXXXXX";

enum { THREADS = 8 };

static void *open_solid(void *payload) {
    const void **table = payload;
    if (module_open(table, ISO_MODULE_SOLID) != ISO_OK)
        *table = NULL;
    return NULL;
}

/* What test_maps.py looks for in the program's. */
static int is_mapped(const char *name) {
    char line[2 * PATH_MAX];
    int found = 0;
    FILE *maps = fopen("/proc/self/maps", "r");
    while (maps && fgets(line, sizeof line, maps))
        found |= strstr(line, name) != NULL;
    if (maps)
        fclose(maps);
    return found;
}

static void test_same_table_for_all_threads(void) {
    pthread_t thread[THREADS];
    const void *table[THREADS];
    CHECK(!is_mapped("embree") && !is_mapped("isoslice-solid.so"));
    for (int i = 0; i < THREADS; i++)
        CHECK_EQUAL(0, pthread_create(&thread[i], NULL, open_solid, &table[i]));
    for (int i = 0; i < THREADS; i++) {
        pthread_join(thread[i], NULL);
        CHECK(table[i] != NULL && table[i] == table[0]);
    }
    CHECK(is_mapped("embree") && is_mapped("isoslice-solid.so"));
}

/* Run `program` with ISOSLICE_MODULES; its status, and what it said. */
static int run(char *message, size_t size, const char *program, const char *modules) {
    char command[3 * PATH_MAX];
    snprintf(command, sizeof command, "ISOSLICE_MODULES='%s' '%s' open", modules, program);
    FILE *pipe = popen(command, "r");
    size_t length = pipe ? fread(message, 1, size - 1, pipe) : 0;
    message[length] = 0;
    int code = pipe ? pclose(pipe) : -1;
    return code < 0 ? code : code >> 8;
}

static void path_in_folder(char *path, const char *name) {
    snprintf(path, PATH_MAX, "%s/%s", folder, name);
}

static void test_named_folder(void) {
    char message[1000];
    CHECK_EQUAL(0, run(message, sizeof message, self, "/does/not/exist"));
    CHECK(strstr(message, "opened") != NULL);
}

static void test_broken(void) {
    char message[1000], path[PATH_MAX];
    path_in_folder(path, "isoslice-solid.so");
    FILE *file = fopen(path, "w");
    if (CHECK(file != NULL)) {
        fputs("not a library", file);
        fclose(file);
    }
    CHECK_EQUAL(ISO_BAD_CONFIG, run(message, sizeof message, self, folder));
    CHECK(strstr(message, path) != NULL);
    CHECK(strstr(message, "libembree3-3") != NULL);
    unlink(path);
}

static void test_other_version(void) {
    char message[1000], other[PATH_MAX + 20], own[PATH_MAX];
    snprintf(own, sizeof own, "%s", self);
    snprintf(other, sizeof other, "%s/other-version", dirname(own));
    CHECK_EQUAL(ISO_BAD_CONFIG, run(message, sizeof message, self, other));
    CHECK(strstr(message, "is of version 12345, not") != NULL);
}

/* A copy of this program in a folder without modules around. Where isoslice is installed the module
 * is found there, which is right too. */
static void test_missing(void) {
    char message[1000], path[PATH_MAX], command[3 * PATH_MAX];
    path_in_folder(path, "copy");
    snprintf(command, sizeof command, "cp '%s' '%s'", self, path);
    CHECK_EQUAL(0, system(command));
    int code = run(message, sizeof message, path, "");
    if (access(ISO_MODULES_INSTALLED "/isoslice-solid.so", F_OK) != 0) {
        CHECK_EQUAL(ISO_BAD_CONFIG, code);
        CHECK(strstr(message, "isoslice-solid.so is not in") != NULL);
        CHECK(strstr(message, "libembree-dev") != NULL);
        CHECK(strstr(message, folder) != NULL);
    }
    unlink(path);
}

int main(int count, char **argument) {
    if (count > 1) {
        const void *table;
        iso_status status = module_open(&table, ISO_MODULE_SOLID);
        puts(status == ISO_OK ? "opened" : iso_error_message());
        return status;
    }
    ssize_t length = readlink("/proc/self/exe", self, sizeof self - 1);
    if (!CHECK(length > 0 && mkdtemp(folder) != NULL))
        return check_verdict();
    RUN(test_same_table_for_all_threads);
    RUN(test_named_folder);
    RUN(test_broken);
    RUN(test_other_version);
    RUN(test_missing);
    rmdir(folder);
    return check_verdict();
}

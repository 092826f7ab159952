#include "transport/holder.h"

#include <ctype.h>
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bool same_device(const struct stat *one, const struct stat *other) {
    if (S_ISCHR(one->st_mode) && S_ISCHR(other->st_mode))
        return one->st_rdev == other->st_rdev;
    return one->st_dev == other->st_dev && one->st_ino == other->st_ino;
}

static bool has_open(const char *process, const struct stat *node) {
    char folder[300], target[8];
    snprintf(folder, sizeof folder, "/proc/%s/fd", process);
    DIR *files = opendir(folder);
    if (!files)
        return false;
    bool found = false;
    for (struct dirent *file; !found && (file = readdir(files));) {
        char link[600];
        struct stat opened;
        snprintf(link, sizeof link, "%s/%s", folder, file->d_name);
        /* Only devices are looked at: a file on a dead network drive would hold us up. */
        if (readlink(link, target, sizeof target) >= 5 && memcmp(target, "/dev/", 5) == 0)
            found = stat(link, &opened) == 0 && same_device(&opened, node);
    }
    closedir(files);
    return found;
}

static void describe(char *text, size_t capacity, const char *process) {
    char path[300], name[64] = "";
    snprintf(path, sizeof path, "/proc/%s/comm", process);
    FILE *file = fopen(path, "re");
    if (file) {
        if (fgets(name, sizeof name, file))
            name[strcspn(name, "\n")] = 0;
        fclose(file);
    }
    snprintf(text, capacity, "%s (process %s)", name[0] ? name : "a program", process);
}

bool fio_holder_find(char *text, size_t capacity, const char *path) {
    struct stat node;
    if (stat(path, &node) < 0)
        return false;
    DIR *processes = opendir("/proc");
    bool found = false;
    for (struct dirent *process; processes && !found && (process = readdir(processes));) {
        if (!isdigit((unsigned char)process->d_name[0]) || atol(process->d_name) == getpid())
            continue;
        found = has_open(process->d_name, &node);
        if (found)
            describe(text, capacity, process->d_name);
    }
    if (processes)
        closedir(processes);
    return found;
}

#define _GNU_SOURCE /* dladdr1, secure_getenv */
#include "solid/module.h"

#include <dlfcn.h>
#include <limits.h>
#include <link.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct description {
    const char *file;
    int32_t version;
    const char *package;     /* what it needs to run */
    const char *development; /* what it needs to be built */
} description;

static const description modules[ISO_MODULE_COUNT] = {
    [ISO_MODULE_SOLID] = {"isoslice-solid.so", MODULE_VERSION_SOLID,
                          "libembree3-3 (or libembree4-4)", "libembree-dev"},
    [ISO_MODULE_VOLUME] = {"isoslice-volume.so", MODULE_VERSION_VOLUME,
                           "libopenvdb10.0 and libpng16-16",
                           "libopenvdb-dev, libboost-dev, libtbb-dev and libpng-dev"},
    [ISO_MODULE_SPARSE] = {"isoslice-sparse.so", MODULE_VERSION_SPARSE, "libcxsparse3",
                           "libsuitesparse-dev"},
};

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static const void *opened[ISO_MODULE_COUNT]; /* under the lock */

/* The folder of the library or program that this code is in, without a final slash. The loader
 * knows a program by whatever name it was called, so that one is asked of the kernel. */
static int own_folder(char *folder, size_t size) {
    char path[PATH_MAX];
    Dl_info info;
    struct link_map *map = NULL;
    if (!dladdr1(&modules, &info, (void **)&map, RTLD_DL_LINKMAP) || !map || !map->l_name[0]) {
        ssize_t length = readlink("/proc/self/exe", path, sizeof path - 1);
        if (length < 0)
            return 0;
        path[length] = 0;
    } else if (!realpath(map->l_name, path)) {
        return 0;
    }
    char *slash = strrchr(path, '/');
    if (!slash)
        return 0;
    *slash = 0;
    return (size_t)snprintf(folder, size, "%s", path) < size;
}

/* Join folder, way and file, and see whether it is there. Each folder that it isn't in is added to
 * `tried`. */
static int look(char *path, char *tried, size_t tried_size, const char *folder, const char *way,
                const char *file) {
    if ((size_t)snprintf(path, PATH_MAX, "%s%s/%s", folder, way, file) >= PATH_MAX)
        return 0;
    if (access(path, F_OK) == 0)
        return 1;
    size_t used = strlen(tried), left = tried_size - used;
    if ((size_t)snprintf(tried + used, left, "%s%s%s", used ? ", " : "", folder, way) >= left)
        tried[used] = 0; /* the message has no room for it */
    return 0;
}

/* The first one there is decides: a broken module is not passed over in silence. */
static int find(char *path, char *tried, size_t tried_size, const char *file) {
    char own[PATH_MAX];
    const char *named = secure_getenv("ISOSLICE_MODULES");
    if (named && *named && look(path, tried, tried_size, named, "", file))
        return 1;
    if (own_folder(own, sizeof own) &&
        (look(path, tried, tried_size, own, "", file) ||
         look(path, tried, tried_size, own, "/isoslice", file) ||
         look(path, tried, tried_size, own, "/../" ISO_MODULES_BESIDE, file)))
        return 1;
    return look(path, tried, tried_size, ISO_MODULES_INSTALLED, "", file);
}

static iso_status open_locked(const void **table, const description *module) {
    char path[PATH_MAX], tried[400] = "";
    if (!find(path, tried, sizeof tried, module->file))
        return iso_fail(ISO_BAD_CONFIG,
                        "%s is not in %s: install it (to build it takes %s), or name its "
                        "folder in ISOSLICE_MODULES",
                        module->file, tried, module->development);
    void *handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!handle)
        return iso_fail(ISO_BAD_CONFIG, "%s can't be opened: install %s (%s)", path,
                        module->package, dlerror());
    const module_header *header = dlsym(handle, "isoslice_module");
    if (!header || header->version != module->version) {
        int32_t version = header ? header->version : 0;
        dlclose(handle);
        return iso_fail(ISO_BAD_CONFIG,
                        "%s is of version %d, not %d: install the one that belongs to this "
                        "isoslice",
                        path, version, module->version);
    }
    *table = header;
    return ISO_OK;
}

iso_status module_open(const void **table, iso_module module) {
    iso_status status = ISO_OK;
    pthread_mutex_lock(&lock);
    if (!opened[module])
        status = open_locked(&opened[module], &modules[module]);
    *table = opened[module];
    pthread_mutex_unlock(&lock);
    return status;
}

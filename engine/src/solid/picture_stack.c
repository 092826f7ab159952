/* Which pictures there are, and all of them as one block; isoslice-volume.so reads each. */
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/sort.h"
#include "solid/volume.h"
#include "solid/volume_table.h"

enum { PICTURES_MAX = 1000000, DIGITS_MAX = 9 };

typedef char *file_name;

typedef struct name_list {
    file_name *name;
    int64_t count, capacity;
} name_list;

static void list_free(name_list *list) {
    for (int64_t i = 0; i < list->count; i++)
        iso_release(list->name[i]);
    iso_release(list->name);
}

static iso_status list_add(name_list *list, const char *folder, const char *name) {
    ISO_TRY(ISO_GROW(list->name, list->capacity, list->count + 1));
    size_t size = strlen(folder) + strlen(name) + 2;
    char *copy = iso_allocate(size);
    if (!copy)
        return iso_no_memory(size);
    snprintf(copy, size, "%s%s%s", folder, *folder ? "/" : "", name);
    list->name[list->count++] = copy;
    return ISO_OK;
}

static int before(const file_name *a, const file_name *b) {
    return strcmp(*a, *b) < 0;
}

ISO_SORT(sort_names, file_name, before)

static int is_picture(const char *name) {
    size_t length = strlen(name);
    return length > 4 && name[0] != '.' && strcasecmp(name + length - 4, ".png") == 0;
}

static iso_status list_folder(name_list *list, const char *path) {
    DIR *folder = opendir(path);
    if (!folder)
        return iso_fail(ISO_UNREADABLE, "%s: can't be read: %s", path, strerror(errno));
    iso_status status = ISO_OK;
    for (const struct dirent *entry; status == ISO_OK && (entry = readdir(folder));)
        if (is_picture(entry->d_name))
            status = list_add(list, path, entry->d_name);
    closedir(folder);
    ISO_TRY(status);
    if (list->count == 0)
        return iso_fail(ISO_UNREADABLE, "%s: has no pictures *.png in it", path);
    sort_names(list->name, list->count);
    return ISO_OK;
}

/* "a%03db": what stands before and after the number, and how many digits it has at least. "%%" is a
 * per cent sign. The text comes from a user, so printf never sees it. */
typedef struct name_pattern {
    char *text; /* before, 0, after */
    const char *after;
    int digits, zeros;
} name_pattern;

static int parse_number(name_pattern *pattern, const char **at) {
    const char *p = *at + 1;
    if (*p == '0')
        pattern->zeros = 1, p++;
    for (; *p >= '0' && *p <= '9'; p++) {
        pattern->digits = 10 * pattern->digits + (*p - '0');
        if (pattern->digits > DIGITS_MAX)
            return 0;
    }
    *at = p + 1;
    return *p == 'd';
}

static iso_status parse_pattern(name_pattern *pattern, const char *path) {
    *pattern = (name_pattern){0};
    size_t size = strlen(path) + 2;
    pattern->text = iso_allocate(size);
    if (!pattern->text)
        return iso_no_memory(size);
    char *out = pattern->text;
    for (const char *p = path; *p;) {
        if (*p != '%' || p[1] == '%') {
            p += *p == '%';
            *out++ = *p++;
            continue;
        }
        if (pattern->after || !parse_number(pattern, &p)) {
            iso_release(pattern->text);
            return iso_fail(ISO_UNREADABLE,
                            "%s: one number is allowed in the name of a stack of pictures, like "
                            "%%d or %%03d (%d digits at most); write %%%% for a per cent sign",
                            path, DIGITS_MAX);
        }
        *out++ = 0;
        pattern->after = out;
    }
    *out = 0;
    return ISO_OK;
}

static iso_status list_numbered(name_list *list, const name_pattern *pattern, const char *path) {
    size_t size = strlen(pattern->text) + strlen(pattern->after) + 24;
    char *name = iso_allocate(size);
    if (!name)
        return iso_no_memory(size);
    iso_status status = ISO_OK;
    for (int number = 0; status == ISO_OK && number < PICTURES_MAX; number++) {
        snprintf(name, size, pattern->zeros ? "%s%0*d%s" : "%s%*d%s", pattern->text,
                 pattern->digits, number, pattern->after);
        if (access(name, F_OK) == 0)
            status = list_add(list, "", name);
        else if (number > 0)
            break; /* they may count from 0 or from 1 */
    }
    iso_release(name);
    if (status == ISO_OK && list->count == 0)
        return iso_fail(ISO_UNREADABLE, "%s: there is neither picture 0 nor picture 1", path);
    return status;
}

static iso_status list_pictures(name_list *list, const char *path) {
    struct stat there;
    if (stat(path, &there) == 0)
        return S_ISDIR(there.st_mode) ? list_folder(list, path) : list_add(list, "", path);
    if (!strchr(path, '%'))
        return iso_fail(ISO_UNREADABLE, "%s: can't be read: %s", path, strerror(errno));
    name_pattern pattern;
    ISO_TRY(parse_pattern(&pattern, path));
    iso_status status = pattern.after ? list_numbered(list, &pattern, path)
                                      : iso_fail(ISO_UNREADABLE, "%s: there is no such file", path);
    iso_release(pattern.text);
    return status;
}

static iso_status read_one(volume_picture *picture, const volume_table *table, const char *path) {
    char message[VOLUME_MESSAGE] = "";
    *picture = (volume_picture){.allocate = iso_allocate, .release = iso_release};
    iso_status status = table->picture_read(picture, path, message);
    return status == ISO_OK ? ISO_OK : iso_fail(status, "%s: %s", path, message);
}

/* The first picture decides the size of the block. */
static iso_status take(uint8_t **value, int32_t size[3], const volume_picture *picture, int64_t z,
                       const name_list *list) {
    if (!*value) {
        size[0] = picture->width;
        size[1] = picture->height;
        size[2] = (int32_t)list->count;
        ISO_TRY(ISO_ALLOCATE(*value, (int64_t)size[0] * size[1] * size[2]));
    }
    if (picture->width != size[0] || picture->height != size[1])
        return iso_fail(ISO_UNREADABLE,
                        "%s: has %d x %d pixels, but %s has %d x %d: all pictures of a stack must "
                        "have one size",
                        list->name[z], picture->width, picture->height, list->name[0], size[0],
                        size[1]);
    size_t width = (size_t)size[0], height = (size_t)size[1];
    uint8_t *layer = *value + (size_t)z * width * height;
    for (size_t y = 0; y < height; y++)
        memcpy(layer + y * width, picture->value + (height - 1 - y) * width, width);
    return ISO_OK;
}

static iso_status read_all(uint8_t **value, int32_t size[3], const volume_table *table,
                           const name_list *list) {
    for (int64_t z = 0; z < list->count; z++) {
        volume_picture picture;
        ISO_TRY(read_one(&picture, table, list->name[z]));
        iso_status status = take(value, size, &picture, z, list);
        iso_release(picture.value);
        ISO_TRY(status);
    }
    return ISO_OK;
}

iso_status volume_read_pictures(uint8_t **value, int32_t size[3], const char *path) {
    *value = NULL;
    const void *table;
    ISO_TRY(module_open(&table, ISO_MODULE_VOLUME));
    name_list list = {0};
    iso_status status = list_pictures(&list, path);
    if (status == ISO_OK)
        status = read_all(value, size, table, &list);
    if (status != ISO_OK) {
        iso_release(*value);
        *value = NULL;
    }
    list_free(&list);
    return status;
}

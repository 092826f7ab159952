#include "config/foreign.h"

#include <string.h>

/* Where the entry of a key begins, or `used`. */
static size_t find_entry(const iso_foreign *foreign, const char *key) {
    size_t at = 0, used = (size_t)foreign->used;
    while (at < used) {
        const char *entry = foreign->text + at;
        size_t key_size = strlen(entry) + 1;
        if (strcmp(entry, key) == 0)
            break;
        at += key_size + strlen(entry + key_size) + 1;
    }
    return at;
}

const char *iso_foreign_get(const iso_foreign *foreign, const char *key) {
    size_t at = find_entry(foreign, key);
    return at == (size_t)foreign->used ? NULL : foreign->text + at + strlen(key) + 1;
}

static void drop_entry(iso_foreign *foreign, size_t at) {
    char *entry = foreign->text + at;
    size_t size = strlen(entry) + 1;
    size += strlen(entry + size) + 1;
    memmove(entry, entry + size, (size_t)foreign->used - at - size);
    foreign->used -= (int32_t)size;
    memset(foreign->text + foreign->used, 0, size); /* equal stores have equal bytes */
}

bool iso_foreign_set(iso_foreign *foreign, const char *key, const char *value) {
    size_t at = find_entry(foreign, key), key_size = strlen(key) + 1, size = strlen(value) + 1;
    if (at < (size_t)foreign->used)
        drop_entry(foreign, at);
    at = (size_t)foreign->used;
    if (key_size + size > sizeof foreign->text - at)
        return false;
    memcpy(foreign->text + at, key, key_size);
    memcpy(foreign->text + at + key_size, value, size);
    foreign->used += (int32_t)(key_size + size);
    return true;
}

iso_status iso_foreign_print(const iso_foreign *foreign, iso_option_printer *print, void *payload) {
    for (size_t at = 0; at < (size_t)foreign->used;) {
        const char *key = foreign->text + at, *value = key + strlen(key) + 1;
        ISO_TRY(print(payload, key, value));
        at += strlen(key) + strlen(value) + 2;
    }
    return ISO_OK;
}

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "height/fields.h"

static const char distance_prefix[] = "distance:";

static bool is_space(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

/* Text without the spaces around it. */
typedef struct words {
    const char *text;
    size_t length;
} words;

static words trimmed(const char *text) {
    words w = {text, strlen(text)};
    while (w.length > 0 && is_space(w.text[0])) {
        w.text++;
        w.length--;
    }
    while (w.length > 0 && is_space(w.text[w.length - 1]))
        w.length--;
    return w;
}

static bool is(words w, const char *name) {
    return w.length == strlen(name) && memcmp(w.text, name, w.length) == 0;
}

static iso_status open_distance(iso_field **field, words w, iso_vec3 origin) {
    size_t skip = sizeof distance_prefix - 1;
    words name = {w.text + skip, w.length - skip};
    while (name.length > 0 && is_space(name.text[0])) {
        name.text++;
        name.length--;
    }
    if (name.length == 0)
        return iso_fail(ISO_BAD_CONFIG, "distance: of what? It takes a file, .stl or .vdb");
    char *path = iso_allocate(name.length + 1);
    if (!path)
        return iso_no_memory(name.length + 1);
    memcpy(path, name.text, name.length);
    path[name.length] = 0;
    iso_status status = height_new_distance(field, path, origin);
    iso_release(path);
    return status;
}

static iso_status open_text(iso_field **field, const char *text, const iso_mesh *mesh,
                            int32_t count, double slope, iso_vec3 origin) {
    *field = NULL;
    words w = trimmed(text);
    if (is(w, "geodesic"))
        return height_new_geodesic(field, mesh, count);
    if (is(w, "auto-top"))
        return height_new_auto_top(field, mesh, count, slope);
    if (w.length >= sizeof distance_prefix - 1 &&
        memcmp(w.text, distance_prefix, sizeof distance_prefix - 1) == 0)
        return open_distance(field, w, origin);
    return iso_field_new(field, text);
}

iso_status iso_field_open(iso_field **field, const char *text, const iso_mesh *mesh, int32_t count,
                          double slope, iso_vec3 origin) {
    iso_status status = open_text(field, text, mesh, count, slope, origin);
    if (status != ISO_BAD_CONFIG)
        return status;
    char message[512]; /* of iso_fail, which is about to overwrite it */
    snprintf(message, sizeof message, "%s", iso_error_message());
    return iso_fail(status, "field: %s", message);
}

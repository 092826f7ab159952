#include "link/multilink.h"

#include <string.h>

#include "base/memory.h"

static const iso_kind_row kinds[ISO_KIND_COUNT] = {
    [ISO_KIND_LINK] = {"link", 1, 1, {"φ"}, 0, {0}, 0, {0}},
    [ISO_KIND_COLOURED_LINK] = {"coloured link", 1, 1, {"φ"}, 1, {"c"}, 0, {"cφ = c"}},
    [ISO_KIND_SQUARE_LINK] = {"square-link", 2, 2, {"α", "β"}, 0, {0}, 1, {0}},
    [ISO_KIND_TRIANGULATION] =
        {"triangulation", 2, 2, {"θ", "φ"}, 0, {0}, 0, {"θ³ = 1", "θ² = φθφ", "gφ = g"}},
    [ISO_KIND_SQUARE_PATCH] =
        {"square patch", 2, 2, {"θ", "φ"}, 0, {0}, 0, {"θ⁴ = 1", "θ³ = φθφ", "gφ = g"}},
    /* βαβα = 1 follows: maps of a finite set with a product 1 are bijections. A dart that is its
     * own successor or its own opposite would be a face or an edge without extent. */
    [ISO_KIND_DOUBLE_LINK] = {"double-link",
                              2,
                              2,
                              {"α", "β"},
                              2,
                              {"f", "v"},
                              0,
                              {"αβαβ = 1", "fα = f", "vβ = v", "gβ = g", "α ≠ 1", "βα ≠ 1"}},
    [ISO_KIND_CUBIC_LINK] = {"cubic-link", 3, 3, {"α", "β", "γ"}, 0, {0}, 1, {0}},
    [ISO_KIND_CUBE_LINK] = {"n-cube-link",
                            1,
                            ISO_LINK_MAPS_MAX,
                            {"α₁", "α₂", "α₃", "α₄", "α₅", "α₆", "α₇", "α₈"},
                            0,
                            {0},
                            1,
                            {0}},
    /* g is a map here: the other end of a piece of the boundary (paper, 4.2) */
    [ISO_KIND_FILLING_LINK] = {"contour-filling link",
                               3,
                               3,
                               {"r", "s", "g"},
                               2,
                               {"q", "p"},
                               0,
                               {"r² = 1", "s² = 1", "g² = 1", "qr = q", "qs = q", "pg = p"}},
};

const iso_kind_row *iso_kind_get(iso_link_kind kind) {
    return (unsigned)kind < ISO_KIND_COUNT ? &kinds[kind] : NULL;
}

const char *iso_link_kind_name(iso_link_kind kind) {
    const iso_kind_row *row = iso_kind_get(kind);
    return row ? row->name : "unknown kind";
}

/* Cut at the start of a character if the name is too long. */
static void set_name(iso_map *map, const char *name) {
    size_t length = strlen(name);
    if (length >= sizeof map->name) {
        length = sizeof map->name - 1;
        while (length > 0 && (name[length] & 0xC0) == 0x80)
            length--;
    }
    memcpy(map->name, name, length);
    memset(map->name + length, 0, sizeof map->name - length);
}

iso_multilink iso_multilink_view(iso_link_kind kind, int32_t size, int map_count, int dimension,
                                 const double *g) {
    iso_multilink view = {.kind = kind, .size = size, .dimension = dimension, .g = g};
    const iso_kind_row *row = iso_kind_get(kind);
    if (!row)
        return view;
    view.map_count = row->map_least == row->map_most ? row->map_least : map_count;
    view.projection_count = row->projection_count;
    for (int i = 0; i < view.map_count && i < row->map_most; i++)
        set_name(&view.map[i], row->map[i]);
    for (int i = 0; i < row->projection_count; i++)
        set_name(&view.projection[i], row->projection[i]);
    return view;
}

void iso_map_store(iso_map *map, const int32_t *image, int32_t range) {
    map->rule = ISO_MAP_STORED;
    map->stride = map->length = 0;
    map->range = range;
    map->image = image;
}

void iso_map_step(iso_map *map, iso_map_rule rule, int32_t stride, int32_t length, int32_t range) {
    map->rule = rule;
    map->stride = stride;
    map->length = length;
    map->range = range;
    map->image = NULL;
}

iso_map *iso_multilink_add_projection(iso_multilink *view, const char *name) {
    int last = ISO_LINK_MAPS_MAX - 1;
    iso_map *map = &view->projection[view->projection_count < last ? view->projection_count : last];
    view->projection_count++;
    *map = (iso_map){0};
    set_name(map, name);
    return map;
}

iso_multilink iso_multilink_begin(iso_link_kind kind, int32_t size, int dimension) {
    iso_multilink link = iso_multilink_view(kind, size, 0, dimension, NULL);
    link.owns = 1;
    return link;
}

int32_t *iso_map_allocate(iso_map *map, int64_t size, int32_t range) {
    int32_t *image;
    if (ISO_ALLOCATE(image, size) != ISO_OK)
        return NULL;
    iso_map_store(map, image, range);
    return image;
}

double *iso_multilink_allocate_g(iso_multilink *link) {
    double *g;
    if (ISO_ALLOCATE(g, (int64_t)link->size * link->dimension) != ISO_OK)
        return NULL;
    link->g = g;
    return g;
}

void iso_multilink_free(iso_multilink *link) {
    if (link->owns) {
        for (int i = 0; i < ISO_LINK_MAPS_MAX; i++) {
            iso_release((void *)link->map[i].image);
            iso_release((void *)link->projection[i].image);
        }
        iso_release((void *)link->g);
    }
    *link = (iso_multilink){0};
}

iso_status iso_multilink_finish(iso_multilink *out, iso_multilink *made, iso_status status) {
    *out = (iso_multilink){0};
    if (status == ISO_OK)
        status = iso_multilink_validate(made);
    if (status == ISO_OK)
        *out = *made;
    else
        iso_multilink_free(made);
    return status;
}

static iso_status copy_map(iso_map *to, const iso_map *from, int32_t size) {
    *to = *from;
    to->image = NULL; /* not ours to release, should this fail */
    if (from->rule != ISO_MAP_STORED)
        return ISO_OK;
    int32_t *image = iso_map_allocate(to, size, from->range);
    if (!image)
        return ISO_NO_MEMORY;
    if (size > 0) /* else there may be no array to copy from */
        memcpy(image, from->image, (size_t)size * sizeof *image);
    return ISO_OK;
}

static iso_status copy_arrays(iso_multilink *to, const iso_multilink *from) {
    for (int i = 0; i < from->map_count; i++)
        ISO_TRY(copy_map(&to->map[i], &from->map[i], from->size));
    for (int i = 0; i < from->projection_count; i++)
        ISO_TRY(copy_map(&to->projection[i], &from->projection[i], from->size));
    if (from->dimension == 0)
        return ISO_OK;
    double *g = iso_multilink_allocate_g(to);
    if (!g)
        return ISO_NO_MEMORY;
    if (from->size > 0)
        memcpy(g, from->g, (size_t)from->size * (size_t)from->dimension * sizeof *g);
    return ISO_OK;
}

iso_status iso_multilink_copy(iso_multilink *out, const iso_multilink *link) {
    iso_multilink made = {.kind = link->kind,
                          .size = link->size,
                          .map_count = link->map_count,
                          .projection_count = link->projection_count,
                          .dimension = link->dimension,
                          .owns = 1};
    *out = (iso_multilink){0};
    ISO_TRY(iso_multilink_validate(link));
    iso_status status = copy_arrays(&made, link);
    if (status != ISO_OK)
        iso_multilink_free(&made);
    else
        *out = made;
    return status;
}

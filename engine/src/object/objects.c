#include <isoslice/object.h>

#include <math.h>
#include <stdio.h>

#include "base/memory.h"

typedef struct maker {
    const iso_object_options *options;
    iso_object *object;
    int64_t count, capacity;
} maker;

/* part.stl and _lower: part_lower.stl. */
static void name_object(char *name, const char *file, const char *suffix) {
    const char *slash = strrchr(file, '/'), *base = slash ? slash + 1 : file;
    const char *dot = strrchr(base, '.'), *ending = dot && dot != base ? dot : "";
    size_t length = strlen(base) - strlen(ending), room = ISO_OBJECT_NAME_SIZE - 1;
    size_t added = strlen(suffix) + strlen(ending);
    if (added > room / 2) /* no ending of a model's name */
        ending = "", added = strlen(suffix);
    snprintf(name, ISO_OBJECT_NAME_SIZE, "%.*s%s%s",
             (int)(length + added > room ? room - added : length), base, suffix, ending);
}

static void find_box(iso_object *object) {
    bool any = false;
    for (int32_t i = 0; i < object->mesh_count; i++) {
        iso_vec3 low = object->mesh[i].min, high = object->mesh[i].max;
        if (object->mesh[i].triangle_count == 0)
            continue;
        iso_vec3 min = any ? object->min : low, max = any ? object->max : high;
        object->min = (iso_vec3){fmin(min.x, low.x), fmin(min.y, low.y), fmin(min.z, low.z)};
        object->max = (iso_vec3){fmax(max.x, high.x), fmax(max.y, high.y), fmax(max.z, high.z)};
        any = true;
    }
}

/* Empty meshes go, the others keep their order. */
static int32_t without_empty(iso_mesh *mesh, int32_t count) {
    int32_t kept = 0;
    for (int32_t i = 0; i < count; i++) {
        if (mesh[i].triangle_count == 0)
            iso_mesh_free(&mesh[i]);
        else if (kept++ != i)
            mesh[kept - 1] = mesh[i], mesh[i] = (iso_mesh){0};
    }
    return kept;
}

/* The meshes become an object; they are empty afterwards if that succeeds. */
static iso_status add_object(maker *m, iso_mesh *mesh, int32_t count, const char *name,
                             const char *suffix) {
    iso_object object = {0};
    ISO_TRY(ISO_GROW(m->object, m->capacity, m->count + 1));
    ISO_TRY(ISO_ALLOCATE(object.mesh, count));
    memcpy(object.mesh, mesh, (size_t)count * sizeof *mesh);
    memset(mesh, 0, (size_t)count * sizeof *mesh);
    object.mesh_count = count;
    name_object(object.name, name, suffix);
    find_box(&object);
    iso_vec3 by = {-(object.min.x + object.max.x) / 2, -(object.min.y + object.max.y) / 2,
                   m->options->float_above ? 0 : -object.min.z};
    object.origin = (iso_vec2){-by.x, -by.y};
    object.floor = -by.z;
    for (int32_t i = 0; i < count; i++)
        iso_mesh_translate(&object.mesh[i], by);
    find_box(&object);
    m->object[m->count++] = object;
    return ISO_OK;
}

static iso_status add_pieces(maker *m, const iso_mesh *mesh, const char *name, const char *part,
                             int32_t *number) {
    iso_mesh *piece;
    int32_t pieces;
    char suffix[24];
    ISO_TRY(iso_mesh_split(&piece, &pieces, mesh));
    iso_status status = ISO_OK;
    for (int32_t i = 0; i < pieces && status == ISO_OK; i++) {
        snprintf(suffix, sizeof suffix, "%s_%d", part, ++*number);
        status = add_object(m, &piece[i], 1, name, suffix);
    }
    iso_meshes_free(piece, pieces);
    return status;
}

/* One group of meshes, whole or a side of a cut. */
static iso_status add_group(maker *m, iso_mesh *mesh, int32_t count, const char *name,
                            const char *part) {
    int32_t number = 0;
    count = without_empty(mesh, count);
    if (count == 0)
        return ISO_OK;
    if (!m->options->split)
        return add_object(m, mesh, count, name, part);
    for (int32_t i = 0; i < count; i++)
        ISO_TRY(add_pieces(m, &mesh[i], name, part, &number));
    return ISO_OK;
}

static double floor_of(const iso_mesh *mesh, int32_t count) {
    double floor = INFINITY;
    for (int32_t i = 0; i < count; i++)
        if (mesh[i].triangle_count > 0)
            floor = fmin(floor, mesh[i].min.z);
    return floor;
}

static iso_status add_cut(maker *m, iso_mesh *mesh, int32_t count, const char *name) {
    const iso_object_options *options = m->options;
    double z = floor_of(mesh, count) + options->cut;
    iso_mesh *side; /* lower ones, then upper ones */
    ISO_TRY(ISO_ALLOCATE(side, 2 * (int64_t)count));
    memset(side, 0, 2 * (size_t)count * sizeof *side);
    iso_status status = ISO_OK;
    for (int32_t i = 0; i < count && status == ISO_OK; i++) {
        status = iso_mesh_cut(options->drop_lower ? NULL : &side[i],
                              options->drop_upper ? NULL : &side[count + i], &mesh[i], z);
        iso_mesh_free(&mesh[i]);
    }
    bool both = !options->drop_lower && !options->drop_upper;
    if (status == ISO_OK)
        status = add_group(m, side, count, name, both ? "_lower" : "");
    if (status == ISO_OK)
        status = add_group(m, side + count, count, name, both ? "_upper" : "");
    iso_meshes_free(side, 2 * count);
    return status;
}

static iso_status make_group(maker *m, iso_mesh *mesh, int32_t count, const char *name) {
    ISO_TRY(iso_meshes_transform(mesh, count, &m->options->transform));
    if (m->options->cut > 0)
        return add_cut(m, mesh, count, name);
    return add_group(m, mesh, count, name, "");
}

iso_status iso_objects_make(iso_objects *objects, iso_mesh *mesh, const char *const *name,
                            int32_t count, const iso_object_options *options) {
    maker m = {.options = options};
    iso_status status = ISO_OK;
    *objects = (iso_objects){0};
    if (options->apart)
        for (int32_t i = 0; i < count && status == ISO_OK; i++)
            status = make_group(&m, &mesh[i], 1, name[i]);
    else if (count > 0)
        status = make_group(&m, mesh, count, name[0]);
    if (status == ISO_OK && m.count == 0)
        status = iso_fail(ISO_OUTSIDE, "nothing is left of the model; see cut and cut_keep");
    for (int32_t i = 0; i < count; i++)
        iso_mesh_free(&mesh[i]);
    *objects = (iso_objects){(int32_t)m.count, m.object};
    if (status != ISO_OK)
        iso_objects_free(objects);
    return status;
}

void iso_objects_free(iso_objects *objects) {
    for (int32_t i = 0; i < objects->count; i++) {
        iso_meshes_free(objects->object[i].mesh, objects->object[i].mesh_count);
        iso_region_free(&objects->object[i].hull);
        iso_region_free(&objects->object[i].foot);
    }
    iso_release(objects->object);
    *objects = (iso_objects){0};
}

iso_status iso_objects_find_feet(iso_objects *objects, double z) {
    for (int32_t i = 0; i < objects->count; i++) {
        iso_object *object = &objects->object[i];
        ISO_TRY(iso_meshes_hull_below(&object->foot, object->mesh, object->mesh_count, z));
    }
    return ISO_OK;
}

iso_status iso_objects_find_hulls(iso_objects *objects) {
    for (int32_t i = 0; i < objects->count; i++) {
        iso_object *object = &objects->object[i];
        if (object->hull.count > 0)
            continue;
        ISO_TRY(iso_meshes_hull(&object->hull, object->mesh, object->mesh_count));
        if (object->hull.count == 0)
            return iso_fail(ISO_OUTSIDE, "%s is seen from above as a line: it can't be placed",
                            object->name);
    }
    return ISO_OK;
}

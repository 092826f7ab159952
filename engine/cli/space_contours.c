#include "space_contours.h"

#include <isoslice/link.h>
#include <isoslice/slice.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/output.h"
#include "config/settings_objects.h"
#include "config/value.h"
#include "curved.h"
#include "slice/range.h"
#include "space_map.h"
#include "verbs.h"

typedef struct cut {
    const iso_options *options;
    const iso_objects *objects;
    const iso_instances *instances;
    iso_field **field; /* [objects] */
    double *low;       /* [objects] its least value */
    double span;       /* the largest range of all */
    double *level;     /* [levels] of the object at hand */
    iso_levels levels; /* above the least value */
    int32_t count;     /* of bodies, and their curves */
    iso_space_body *body;
    iso_curves *each;
    iso_curves all;
} cut;

static void cut_free(cut *c) {
    for (int32_t i = 0; c->field && i < c->objects->count; i++)
        iso_field_free(c->field[i]);
    for (int32_t i = 0; i < c->count; i++)
        iso_curves_free(&c->each[i]);
    iso_release(c->field);
    iso_release(c->low);
    iso_release(c->level);
    iso_release(c->body);
    iso_release(c->each);
    iso_levels_free(&c->levels);
    iso_curves_free(&c->all);
}

/* ---- fields and levels ---- */

static iso_status open_field(cut *c, int32_t i) {
    const iso_object *object = &c->objects->object[i];
    iso_vec3 origin = {object->origin.x, object->origin.y, object->floor};
    double range[2];
    ISO_TRY(iso_field_open(&c->field[i], c->options->field, object->mesh, object->mesh_count,
                           curved_steepest(c->options), origin));
    ISO_TRY(field_range(range, c->field[i], object->mesh, object->mesh_count));
    c->low[i] = range[0];
    c->span = fmax(c->span, range[1] - range[0]);
    return ISO_OK;
}

static iso_status open_fields(cut *c) {
    double height[ISO_NUMBERS_MAX + 1];
    int32_t count = iso_options_heights(height, c->options);
    ISO_TRY(ISO_ALLOCATE(c->low, c->objects->count));
    ISO_TRY(ISO_ALLOCATE(c->field, c->objects->count));
    memset(c->field, 0, (size_t)c->objects->count * sizeof *c->field);
    for (int32_t i = 0; i < c->objects->count; i++)
        ISO_TRY(open_field(c, i));
    if (!(c->span > 0))
        return iso_fail(ISO_BAD_CONFIG, "field: it is the same all over the model");
    return iso_levels_from_heights(&c->levels, height, count, c->span);
}

/* ---- curves ---- */

static iso_status slice_mesh(cut *c, const iso_mesh *mesh, int32_t object, iso_vec3 by) {
    iso_field_slicing slicing = iso_field_slicing_defaults();
    iso_curves *curves = &c->each[c->count];
    slicing.tolerance = c->options->field_tolerance;
    for (int32_t i = 0; i < c->levels.count; i++)
        c->level[i] = c->low[object] + c->levels.cut[i];
    ISO_TRY(iso_slice_field(curves, mesh, c->field[object], c->level, c->levels.count, &slicing));
    c->body[c->count++] = (iso_space_body){mesh, by};
    for (int64_t i = 0; i < curves->crossing_count; i++) {
        curves->point[i].x += by.x;
        curves->point[i].y += by.y;
    }
    return ISO_OK;
}

static iso_status slice_all(cut *c) {
    int64_t count = 0;
    for (int32_t i = 0; i < c->instances->count; i++)
        count += c->objects->object[c->instances->instance[i].object].mesh_count;
    ISO_TRY(ISO_ALLOCATE(c->each, count));
    ISO_TRY(ISO_ALLOCATE(c->body, count));
    ISO_TRY(ISO_ALLOCATE(c->level, c->levels.count));
    for (int32_t i = 0; i < c->instances->count; i++) {
        const iso_instance *instance = &c->instances->instance[i];
        const iso_object *object = &c->objects->object[instance->object];
        iso_vec3 by = {iso_mm(instance->by.x), iso_mm(instance->by.y), 0};
        for (int32_t m = 0; m < object->mesh_count; m++)
            ISO_TRY(slice_mesh(c, &object->mesh[m], instance->object, by));
    }
    return ISO_OK;
}

static void append_level(iso_curves *to, const iso_curves *from, int32_t level) {
    for (int32_t k = from->level_first[level]; k < from->level_first[level + 1]; k++) {
        int64_t first = from->contour_first[k], count = from->contour_first[k + 1] - first;
        memcpy(to->point + to->crossing_count, from->point + first,
               (size_t)count * sizeof *to->point);
        to->crossing_count += count;
        to->contour_first[++to->contour_count] = to->crossing_count;
    }
}

/* As iso_slices_join does. */
static iso_status join(cut *c) {
    iso_curves *all = &c->all;
    int64_t contours = 0, crossings = 0;
    for (int32_t i = 0; i < c->count; i++) {
        contours += c->each[i].contour_count;
        crossings += c->each[i].crossing_count;
    }
    if (contours > INT32_MAX - 1)
        return iso_fail(ISO_UNSLICEABLE, "more than %d contours", INT32_MAX - 1);
    all->level_count = c->levels.count;
    ISO_TRY(ISO_ALLOCATE(all->level_first, (int64_t)all->level_count + 1));
    ISO_TRY(ISO_ALLOCATE(all->contour_first, contours + 1));
    ISO_TRY(ISO_ALLOCATE(all->point, crossings));
    all->level_first[0] = 0;
    all->contour_first[0] = 0;
    for (int32_t l = 0; l < all->level_count; l++) {
        for (int32_t i = 0; i < c->count; i++)
            append_level(all, &c->each[i], l);
        all->level_first[l + 1] = all->contour_count;
    }
    return ISO_OK;
}

/* ---- formats ---- */

static iso_status write_link(const char *path, const iso_curves *curves) {
    iso_coloured_link link;
    ISO_TRY(iso_curves_to_link(&link, curves));
    iso_status status = iso_multilink_write(path, &link.link, ISO_LINK_FLOAT64);
    iso_multilink_free(&link.link);
    return status;
}

static iso_status write_json(iso_output *output, const cut *c) {
    const iso_curves *curves = &c->all;
    char r[32], top[32], x[32], y[32], z[32];
    iso_output_print(output, "{\"unit\": \"mm\", \"levels\": [");
    for (int32_t l = 0; l < curves->level_count; l++) {
        iso_number_write(r, c->levels.cut[l]);
        iso_number_write(top, c->levels.top[l]);
        iso_output_print(output, "%s\n  {\"r\": %s, \"top\": %s, \"contours\": [", l > 0 ? "," : "",
                         r, top);
        for (int32_t k = curves->level_first[l]; k < curves->level_first[l + 1]; k++) {
            iso_output_print(output, k > curves->level_first[l] ? ",\n    [" : "\n    [");
            for (int64_t i = curves->contour_first[k]; i < curves->contour_first[k + 1]; i++) {
                iso_number_write(x, curves->point[i].x);
                iso_number_write(y, curves->point[i].y);
                iso_number_write(z, curves->point[i].z);
                iso_output_print(output, "%s[%s,%s,%s]", i > curves->contour_first[k] ? "," : "", x,
                                 y, z);
            }
            iso_output_print(output, "]");
        }
        iso_output_print(output, "]}");
    }
    return iso_output_print(output, "\n]}\n");
}

static iso_status write_picture(iso_output *output, const cut *c, const iso_arguments *arguments) {
    iso_space_view view = {arguments->view[0], arguments->view[1], c->options->field};
    return iso_space_map(output, &c->all, &c->levels, c->body, c->count, &view);
}

static iso_status write_contours(const char *path, const cut *c, const iso_arguments *arguments) {
    bool json = iso_ends_in(path, ".json"), svg = iso_ends_in(path, ".svg");
    iso_output *output;
    if (!json && !svg)
        return write_link(path, &c->all);
    ISO_TRY(iso_output_open(&output, path));
    iso_status status = json ? write_json(output, c) : write_picture(output, c, arguments);
    if (status == ISO_OK)
        return iso_output_commit(output);
    iso_output_abandon(output);
    return status;
}

iso_status iso_space_contours(const char *path, const iso_objects *objects,
                              const iso_instances *instances, const iso_arguments *arguments) {
    cut c = {.options = &arguments->options, .objects = objects, .instances = instances};
    iso_status status = open_fields(&c);
    if (status == ISO_OK)
        status = slice_all(&c);
    if (status == ISO_OK)
        status = join(&c);
    if (status == ISO_OK)
        status = write_contours(path, &c, arguments);
    cut_free(&c);
    return status;
}

#include "footing.h"

#include <math.h>

#include "base/memory.h"
#include "base/vector.h"

/* What bends by -+A over a height H has a field that rises by 1 -+ 1.5 A / H or so. */
#define HEIGHT_PER_BEND 5.0

/* Places on the bed under the object: corners of its hull seen from above, and a grid within. */
typedef struct footprint {
    iso_vec3 *at; /* [count] */
    double *value;
    int64_t count, capacity;
} footprint;

enum { FOOTPRINT_SIDE = 33 };

static iso_status add_place(footprint *f, iso_point place) {
    ISO_TRY(ISO_GROW(f->at, f->capacity, f->count + 1));
    f->at[f->count++] = vec3(iso_mm(place.x), iso_mm(place.y), 0);
    return ISO_OK;
}

static iso_status gather(footprint *f, const iso_region *hull, const iso_object *object) {
    double width = object->max.x - object->min.x, depth = object->max.y - object->min.y;
    for (int32_t i = 0; i < hull->first[hull->count]; i++)
        ISO_TRY(add_place(f, hull->point[i]));
    for (int j = 0; j < FOOTPRINT_SIDE; j++)
        for (int i = 0; i < FOOTPRINT_SIDE; i++) {
            iso_point place = {iso_units(object->min.x + width * i / (FOOTPRINT_SIDE - 1)),
                               iso_units(object->min.y + depth * j / (FOOTPRINT_SIDE - 1))};
            if (iso_region_locate(hull, place) >= 0)
                ISO_TRY(add_place(f, place));
        }
    return ISO_ALLOCATE(f->value, f->count);
}

static iso_status footprint_new(footprint *f, const iso_object *object) {
    iso_region hull = {0};
    iso_status status = iso_meshes_hull(&hull, object->mesh, object->mesh_count);
    if (status == ISO_OK && hull.count == 0)
        status = iso_fail(ISO_OUTSIDE, "%s is %g mm wide: nothing that could be printed",
                          object->name, object->max.x - object->min.x);
    if (status == ISO_OK)
        status = gather(f, &hull, object);
    iso_region_free(&hull);
    return status;
}

/* Least and greatest of F - z at a height. */
static iso_status find_bend(double bend[2], footprint *f, const iso_field *field, double z) {
    for (int64_t i = 0; i < f->count; i++)
        f->at[i].z = z;
    iso_field_evaluate(f->value, NULL, field, f->at, f->count);
    bend[0] = INFINITY;
    bend[1] = -INFINITY;
    for (int64_t i = 0; i < f->count; i++) {
        if (!isfinite(f->value[i]))
            return iso_fail(ISO_BAD_CONFIG, "field: it has no value at x %g, y %g, z %g",
                            f->at[i].x, f->at[i].y, z);
        bend[0] = fmin(bend[0], f->value[i] - z);
        bend[1] = fmax(bend[1], f->value[i] - z);
    }
    return ISO_OK;
}

/* From where to where layers bend, and what is in the middle of F - z there. */
typedef struct footing {
    double from, to, middle;
} footing;

/* How much it bends depends a little on how high that is. */
static iso_status plan(footing *plan, footprint *f, const iso_field *field,
                       const iso_options *options) {
    double height = options->field_blend, bend[2];
    ISO_TRY(find_bend(bend, f, field, options->field_base + height / 2));
    for (int turn = 0; turn < 2 && !(options->field_blend > 0); turn++) {
        height = fmax(HEIGHT_PER_BEND * (bend[1] - bend[0]) / 2, options->layer_height);
        ISO_TRY(find_bend(bend, f, field, options->field_base + height / 2));
    }
    *plan = (footing){options->field_base, options->field_base + height, (bend[0] + bend[1]) / 2};
    return ISO_OK;
}

static iso_status warn(iso_report *report, const footing *plan, const iso_object *object) {
    if (plan->to <= object->max.z)
        return ISO_OK;
    return iso_report_warn(report, "field-blend",
                           "layers bend from %.2f to %.2f mm, and the part is only %.2f mm high: "
                           "its top isn't as curved as the field is; a field_blend of less bends "
                           "them sooner",
                           plan->from, plan->to, object->max.z);
}

iso_status footing_blend(iso_field **field, iso_report *report, const iso_options *options,
                         const iso_object *object) {
    footprint f = {0};
    footing way;
    iso_field *blended = NULL;
    iso_status status = footprint_new(&f, object);
    if (status == ISO_OK)
        status = plan(&way, &f, *field, options);
    if (status == ISO_OK)
        status = warn(report, &way, object);
    iso_release(f.at);
    iso_release(f.value);
    if (status == ISO_OK)
        status = iso_field_blend(&blended, *field, way.middle, way.from, way.to);
    else
        iso_field_free(*field);
    *field = status == ISO_OK ? blended : NULL;
    return status;
}

#include <isoslice/object.h>

#include <math.h>

#include "base/memory.h"
#include "object/nest.h"
#include "object/outline.h"

void iso_instances_free(iso_instances *instances) {
    iso_release(instances->instance);
    *instances = (iso_instances){0};
}

/* Units that the bed is smaller, so that nothing is rounded beyond its edge. */
enum { ROUNDING = 2 };

/* Share of its hull that an outline fills, from which on the hull is nested. */
#define WORTH_IT 0.9

typedef struct placer {
    const iso_placing *placing;
    iso_objects *objects;
    iso_instances *instances;
    iso_planar_scratch *scratch;
    iso_vec2 middle; /* mm, of everything */
} placer;

static iso_vec2 middle_of_bed(const iso_placing *placing) {
    iso_vec2 low = {INFINITY, INFINITY}, high = {-INFINITY, -INFINITY};
    for (int32_t i = 0; i < placing->bed_count; i++) {
        iso_vec2 p = placing->bed[i];
        low = (iso_vec2){fmin(low.x, p.x), fmin(low.y, p.y)};
        high = (iso_vec2){fmax(high.x, p.x), fmax(high.y, p.y)};
    }
    return (iso_vec2){(low.x + high.x) / 2, (low.y + high.y) / 2};
}

static bool within_kernel(double mm) {
    return mm > -(double)ISO_COORDINATE_MAX / ISO_UNITS_PER_MM &&
           mm < (double)ISO_COORDINATE_MAX / ISO_UNITS_PER_MM;
}

static iso_status check_placing(const iso_placing *placing) {
    if (placing->bed_count < 3)
        return iso_fail(ISO_USAGE, "the bed needs three corners at least; see bed_shape");
    for (int32_t i = 0; i < placing->bed_count; i++)
        if (!within_kernel(placing->bed[i].x) || !within_kernel(placing->bed[i].y))
            return iso_fail(ISO_OUTSIDE, "the bed reaches beyond +-%.1f mm; see bed_shape",
                            iso_mm(ISO_COORDINATE_MAX));
    if (!(placing->distance >= 0 && within_kernel(placing->distance)))
        return iso_fail(ISO_USAGE, "objects can't be arranged %g mm from each other",
                        placing->distance);
    if (!(placing->margin >= 0 && within_kernel(placing->margin)))
        return iso_fail(ISO_USAGE, "a margin of %g mm makes no sense", placing->margin);
    return ISO_OK;
}

static iso_status new_instances(placer *p, int64_t copies) {
    int64_t count = copies * p->objects->count;
    if (count > INT32_MAX)
        return iso_fail(ISO_OUTSIDE, "%lld objects are too many", (long long)count);
    ISO_TRY(ISO_ALLOCATE(p->instances->instance, count));
    p->instances->count = (int32_t)count;
    for (int32_t i = 0; i < count; i++)
        p->instances->instance[i] =
            (iso_instance){.object = (int32_t)(i / copies), .copy = (int32_t)(i % copies)};
    return ISO_OK;
}

/* Rows and columns as far from each other as box and distance say. */
static iso_status place_grid(placer *p) {
    int32_t columns = p->placing->columns, rows = p->placing->rows;
    if (p->objects->count != 1)
        return iso_fail(ISO_BAD_CONFIG,
                        "a grid takes copies of one object, not of %d; see "
                        "duplicate_grid and duplicate",
                        p->objects->count);
    const iso_object *object = &p->objects->object[0];
    double step_x = object->max.x - object->min.x + p->placing->distance;
    double step_y = object->max.y - object->min.y + p->placing->distance;
    double from_x = p->middle.x - step_x * (columns - 1) / 2;
    double from_y = p->middle.y - step_y * (rows - 1) / 2;
    if (!within_kernel(from_x) || !within_kernel(from_y) ||
        !within_kernel(from_x + step_x * (columns - 1)) ||
        !within_kernel(from_y + step_y * (rows - 1)))
        return iso_fail(ISO_OUTSIDE, "a grid of %d x %d is larger than any bed", columns, rows);
    ISO_TRY(new_instances(p, (int64_t)columns * rows));
    for (int32_t i = 0; i < p->instances->count; i++)
        p->instances->instance[i].by = (iso_point){iso_units(from_x + step_x * (i % columns)),
                                                   iso_units(from_y + step_y * (i / columns))};
    return ISO_OK;
}

/* The bed less its margin. Many copies of what fills it by chance still fit: nesting is easy on the
 * distance between them. */
static iso_status make_bed(iso_region *bed, iso_region *raw, const placer *p) {
    iso_point *point;
    ISO_TRY(ISO_ALLOCATE(point, p->placing->bed_count));
    for (int32_t i = 0; i < p->placing->bed_count; i++)
        point[i] = (iso_point){iso_units(p->placing->bed[i].x), iso_units(p->placing->bed[i].y)};
    iso_status status = iso_region_add(raw, point, p->placing->bed_count);
    iso_release(point);
    ISO_TRY(status);
    iso_region whole = {0};
    iso_offset_options options = iso_offset_defaults(-iso_units(p->placing->margin) - ROUNDING);
    status = iso_region_clean(&whole, raw, ISO_FILL_NONZERO, p->scratch);
    if (status == ISO_OK)
        status = iso_offset(bed, &whole, &options, p->scratch);
    iso_region_free(&whole);
    return status;
}

static iso_status fail_to_fit(const placer *p, int32_t placed, int32_t left) {
    const iso_object *object = &p->objects->object[left];
    return iso_fail(ISO_OUTSIDE,
                    "there is no room on the bed for %s, %.2f x %.2f mm: %d of %d objects fit; see "
                    "duplicate_distance, skirt_distance and bed_shape",
                    object->name, object->max.x - object->min.x, object->max.y - object->min.y,
                    placed, p->instances->count);
}

static iso_status nest(placer *p, const iso_nest *nest, iso_point *by) {
    int32_t placed, left;
    ISO_TRY(nest_shapes(by, &placed, &left, nest, p->scratch));
    if (placed < p->instances->count)
        return fail_to_fit(p, placed, left);
    for (int32_t i = 0; i < placed; i++)
        p->instances->instance[i].by = by[i];
    return ISO_OK;
}

/* What the outline leaves free of the hull decides whether it is worth the trouble. */
static iso_status find_shape(iso_nest_shape *shape, iso_region *outline, const placer *p,
                             int32_t number) {
    const iso_object *object = &p->objects->object[number];
    shape->hull = object->hull.point;
    shape->corners = object->hull.first[1];
    if (p->placing->by_hull)
        return ISO_OK;
    ISO_TRY(outline_of(outline, object->mesh, object->mesh_count, p->scratch));
    double covered = (double)iso_region_double_area(outline);
    if (covered > 0 && covered < WORTH_IT * (double)iso_region_double_area(&object->hull))
        shape->outline = outline;
    return ISO_OK;
}

static iso_status find_shapes(iso_nest_shape *shape, iso_region *outline, const placer *p,
                              int32_t copies) {
    for (int32_t i = 0; i < p->objects->count; i++) {
        shape[i] = (iso_nest_shape){.copies = copies};
        ISO_TRY(find_shape(&shape[i], &outline[i], p, i));
    }
    return ISO_OK;
}

static iso_status arrange_shapes(placer *p, iso_nest_shape *shape, iso_region *outline,
                                 int32_t copies) {
    iso_region raw = {0}, bed = {0};
    iso_point *by;
    ISO_TRY(find_shapes(shape, outline, p, copies));
    ISO_TRY(ISO_ALLOCATE(by, p->instances->count));
    iso_status status = make_bed(&bed, &raw, p);
    if (status == ISO_OK) {
        iso_nest all = {.shape = shape,
                        .shapes = p->objects->count,
                        .bed = &bed,
                        .distance = iso_units(p->placing->distance),
                        .target = {iso_units(p->middle.x), iso_units(p->middle.y)}};
        status = nest(p, &all, by);
    }
    iso_release(by);
    iso_region_free(&raw);
    iso_region_free(&bed);
    return status;
}

static iso_status arrange(placer *p, int32_t copies) {
    iso_nest_shape *shape;
    iso_region *outline;
    int32_t count = p->objects->count;
    ISO_TRY(iso_objects_find_hulls(p->objects));
    ISO_TRY(new_instances(p, copies));
    ISO_TRY(ISO_ALLOCATE(shape, count));
    iso_status status = ISO_ALLOCATE(outline, count);
    if (status == ISO_OK) {
        memset(outline, 0, (size_t)count * sizeof *outline);
        status = arrange_shapes(p, shape, outline, copies);
        for (int32_t i = 0; i < count; i++)
            iso_region_free(&outline[i]);
        iso_release(outline);
    }
    iso_release(shape);
    return status;
}

static iso_status keep_places(placer *p) {
    ISO_TRY(new_instances(p, 1));
    for (int32_t i = 0; i < p->objects->count; i++) {
        iso_vec2 at = p->objects->object[i].origin;
        if (!within_kernel(at.x) || !within_kernel(at.y))
            return iso_fail(ISO_OUTSIDE,
                            "%s lies about (%g, %g) mm, beyond any bed; see dont_arrange",
                            p->objects->object[i].name, at.x, at.y);
        p->instances->instance[i].by = (iso_point){iso_units(at.x), iso_units(at.y)};
    }
    return ISO_OK;
}

static iso_status place(placer *p) {
    const iso_placing *placing = p->placing;
    int32_t copies = placing->copies > 1 ? placing->copies : 1;
    if (placing->columns > 0 && placing->rows > 0)
        return place_grid(p);
    if (placing->keep && copies == 1)
        return keep_places(p);
    if (p->objects->count > 1 || copies > 1)
        return arrange(p, copies);
    ISO_TRY(new_instances(p, 1));
    p->instances->instance[0].by = (iso_point){iso_units(p->middle.x), iso_units(p->middle.y)};
    return ISO_OK;
}

iso_status iso_objects_place(iso_instances *instances, iso_objects *objects,
                             const iso_placing *placing, iso_planar_scratch *scratch) {
    *instances = (iso_instances){0};
    ISO_TRY(check_placing(placing));
    placer p = {.placing = placing, .objects = objects, .instances = instances, .scratch = scratch};
    p.middle = placing->has_center ? placing->center : middle_of_bed(placing);
    if (!within_kernel(p.middle.x) || !within_kernel(p.middle.y))
        return iso_fail(ISO_OUTSIDE, "the center (%g, %g) is beyond any bed", p.middle.x,
                        p.middle.y);
    iso_status status = place(&p);
    if (status != ISO_OK)
        iso_instances_free(instances);
    return status;
}

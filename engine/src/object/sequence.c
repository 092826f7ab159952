#include <isoslice/object.h>

#include "base/memory.h"
#include "base/sort.h"
#include "planar/hull.h"
#include "planar/predicate.h"

typedef struct standing {
    double height;
    iso_instance instance;
    iso_box box;
    int32_t first; /* of its corners */
} standing;

/* Print what is low first: nothing tall stands in the way of what moves above. */
#define IS_EARLIER(a, b)                                                                           \
    ((a)->height != (b)->height                     ? (a)->height < (b)->height                    \
     : (a)->instance.object != (b)->instance.object ? (a)->instance.object < (b)->instance.object  \
                                                    : (a)->instance.copy < (b)->instance.copy)

ISO_SORT(sort_standing, standing, IS_EARLIER)

static iso_status check_height(const iso_objects *objects, const standing *stand, int32_t count,
                               double height) {
    if (count < 2 || stand[count - 2].height <= height)
        return ISO_OK;
    const iso_object *tall = &objects->object[stand[count - 2].instance.object];
    const iso_object *next = &objects->object[stand[count - 1].instance.object];
    return iso_fail(ISO_OUTSIDE,
                    "%s, %.2f mm high, can't be complete before %s is printed: the printer clears "
                    "%.2f mm; see extruder_clearance_height",
                    tall->name, tall->max.z, next->name, height);
}

static iso_status check_pair(const iso_objects *objects, const standing *a, const standing *b,
                             const iso_point *corner, double radius) {
    const iso_object *one = &objects->object[a->instance.object];
    const iso_object *other = &objects->object[b->instance.object];
    double distance = hull_distance(corner + a->first, one->hull.first[1], corner + b->first,
                                    other->hull.first[1]);
    if (distance >= radius - 0.001) /* a micrometre is what arranging may lack */
        return ISO_OK;
    return iso_fail(ISO_OUTSIDE,
                    "%s (copy %d) is %.3f mm from %s (copy %d), too near to be printed one after "
                    "the other: the print head needs %.3f mm; see extruder_clearance_radius",
                    one->name, a->instance.copy + 1, distance, other->name, b->instance.copy + 1,
                    radius);
}

/* Every pair, since beds hold some dozens; most are far apart by their boxes. */
static iso_status check_radius(const iso_objects *objects, const standing *stand, int32_t count,
                               const iso_point *corner, double radius) {
    int32_t reach = iso_units(radius);
    for (int32_t i = 0; i < count; i++)
        for (int32_t j = i + 1; j < count; j++) {
            iso_box wide = stand[i].box;
            wide.min.x -= reach, wide.min.y -= reach;
            wide.max.x += reach, wide.max.y += reach;
            if (boxes_meet(&wide, &stand[j].box))
                ISO_TRY(check_pair(objects, &stand[i], &stand[j], corner, radius));
        }
    return ISO_OK;
}

/* Corners of every instance where it stands. */
static void stand_up(standing *stand, iso_point *corner, const iso_instances *instances,
                     const iso_objects *objects) {
    int32_t used = 0;
    for (int32_t i = 0; i < instances->count; i++) {
        iso_instance at = instances->instance[i];
        const iso_object *object = &objects->object[at.object];
        const iso_region *hull = &object->hull;
        iso_box box = {{INT32_MAX, INT32_MAX}, {INT32_MIN, INT32_MIN}};
        stand[i] = (standing){object->max.z, at, box, used};
        for (int32_t k = 0; k < hull->first[1]; k++) {
            corner[used] = (iso_point){hull->point[k].x + at.by.x, hull->point[k].y + at.by.y};
            box_add(&stand[i].box, corner[used++]);
        }
    }
}

static int64_t corners_of(const iso_instances *instances, const iso_objects *objects) {
    int64_t corners = 0;
    for (int32_t i = 0; i < instances->count; i++)
        corners += objects->object[instances->instance[i].object].hull.first[1];
    return corners;
}

iso_status iso_objects_sequence(iso_instances *instances, iso_objects *objects,
                                const iso_clearance *clearance) {
    standing *stand;
    iso_point *corner;
    int32_t count = instances->count;
    if (!(clearance->radius >= 0 && clearance->radius < iso_mm(ISO_COORDINATE_MAX)))
        return iso_fail(ISO_USAGE, "a clearance of %g mm makes no sense", clearance->radius);
    ISO_TRY(iso_objects_find_hulls(objects));
    ISO_TRY(ISO_ALLOCATE(stand, count));
    iso_status status = ISO_ALLOCATE(corner, corners_of(instances, objects));
    if (status == ISO_OK) {
        stand_up(stand, corner, instances, objects);
        sort_standing(stand, count);
        status = check_radius(objects, stand, count, corner, clearance->radius);
        if (status == ISO_OK)
            status = check_height(objects, stand, count, clearance->height);
        for (int32_t i = 0; status == ISO_OK && i < count; i++)
            instances->instance[i] = stand[i].instance;
        iso_release(corner);
    }
    iso_release(stand);
    return status;
}

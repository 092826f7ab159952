#include "plate.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "config/settings_objects.h"
#include "object/transform.h"

bool plate_on_bed(const iso_points *bed, double x, double y) {
    bool inside = false;
    for (int32_t i = 0; i < bed->count; i++) {
        iso_vec2 a = bed->point[i], b = bed->point[i + 1 == bed->count ? 0 : i + 1];
        double side = (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
        bool within = fmin(a.x, b.x) <= x && x <= fmax(a.x, b.x) && fmin(a.y, b.y) <= y &&
                      y <= fmax(a.y, b.y);
        if (side == 0 && within)
            return true;
        if ((a.y <= y) != (b.y <= y) && (side > 0) == (b.y > a.y))
            inside = !inside;
    }
    return inside;
}

static iso_status read_models(iso_mesh *mesh, iso_report *report, const iso_options *options,
                              const char *const *input, int32_t count) {
    iso_mesh_options reading = settings_of_reading(options);
    for (int32_t i = 0; i < count; i++) {
        ISO_TRY(iso_mesh_read_with(&mesh[i], input[i], &reading));
        ISO_TRY(iso_report_add_input(report, input[i], &mesh[i]));
    }
    return ISO_OK;
}

static const char *name_of(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* Modifiers are drawn around the models, so that whatever moves those moves them. They are the last
 * of the meshes; the first `count` are gone afterwards. */
static iso_status make_with_modifiers(iso_plate *plate, iso_mesh *mesh, const char *const *name,
                                      int32_t count, const iso_object_options *object) {
    iso_object_options rest = *object;
    rest.transform = (iso_transform){0};
    ISO_TRY(
        meshes_transform_along(mesh, count + plate->modifiers.count, count, &object->transform));
    iso_vec3 from = mesh[0].min;
    ISO_TRY(iso_objects_make(&plate->objects, mesh, name, count, &rest));
    iso_vec3 to = plate->objects.object[0].mesh[0].min;
    for (int32_t i = 0; i < plate->modifiers.count; i++) {
        iso_mesh *moved = &plate->modifiers.modifier[i].mesh;
        *moved = mesh[count + i];
        mesh[count + i] = (iso_mesh){0};
        iso_mesh_translate(moved, (iso_vec3){to.x - from.x, to.y - from.y, to.z - from.z});
    }
    return ISO_OK;
}

static iso_status make_objects(iso_plate *plate, iso_report *report, const iso_options *options,
                               const char *const *input, int32_t count) {
    iso_object_options object = settings_of_objects(options);
    int32_t modifiers = plate->modifiers.count, all = count + modifiers;
    iso_mesh *mesh;
    const char **name;
    ISO_TRY(ISO_ALLOCATE(mesh, all));
    memset(mesh, 0, (size_t)all * sizeof *mesh);
    iso_status status = ISO_ALLOCATE(name, count);
    if (status == ISO_OK) {
        for (int32_t i = 0; i < count; i++)
            name[i] = name_of(input[i]);
        status = read_models(mesh, report, options, input, count);
        if (status == ISO_OK)
            status = modifiers_load(mesh + count, &plate->modifiers, report);
        if (status == ISO_OK && modifiers > 0)
            status = make_with_modifiers(plate, mesh, name, count, &object);
        else if (status == ISO_OK)
            status = iso_objects_make(&plate->objects, mesh, name, count, &object);
        iso_release(name);
    }
    for (int32_t i = 0; i < all; i++)
        iso_mesh_free(&mesh[i]);
    iso_release(mesh);
    return status;
}

static bool box_on_bed(const iso_points *bed, const iso_object *object, iso_vec2 by,
                       double growth) {
    double x[2] = {object->min.x + by.x - growth, object->max.x + by.x + growth};
    double y[2] = {object->min.y + by.y - growth, object->max.y + by.y + growth};
    bool on = true;
    for (int i = 0; i < 4; i++)
        on = on && plate_on_bed(bed, x[i & 1], y[i >> 1]);
    return on;
}

/* Placing rounds to a unit; half of that may stick out. */
static bool nearly_on_bed(const iso_points *bed, double x, double y) {
    static const double slack = 1e-4;
    return plate_on_bed(bed, x, y) || plate_on_bed(bed, x - slack, y - slack) ||
           plate_on_bed(bed, x + slack, y - slack) || plate_on_bed(bed, x - slack, y + slack) ||
           plate_on_bed(bed, x + slack, y + slack);
}

static bool fits_on_bed(const iso_points *bed, double x, double y, double growth) {
    return nearly_on_bed(bed, x, y) &&
           (growth == 0 ||
            (nearly_on_bed(bed, x - growth, y) && nearly_on_bed(bed, x + growth, y) &&
             nearly_on_bed(bed, x, y - growth) && nearly_on_bed(bed, x, y + growth)));
}

/* Outlines may be printed that much larger than they are. */
static iso_status check_instance(const iso_points *bed, const iso_object *object, iso_vec2 by,
                                 double growth) {
    if (box_on_bed(bed, object, by, growth))
        return ISO_OK;
    for (int32_t m = 0; m < object->mesh_count; m++)
        for (int32_t v = 0; v < object->mesh[m].vertex_count; v++) {
            iso_vec3 p = object->mesh[m].position[v];
            if (!fits_on_bed(bed, p.x + by.x, p.y + by.y, growth))
                return iso_fail(ISO_OUTSIDE,
                                "%s, %.2f x %.2f mm, reaches beyond the bed at (%.2f, %.2f); see "
                                "bed_shape, center and arrange",
                                object->name, object->max.x - object->min.x,
                                object->max.y - object->min.y, p.x + by.x, p.y + by.y);
        }
    return ISO_OK;
}

static iso_status check_volume(const iso_plate *plate, const iso_options *options) {
    for (int32_t i = 0; i < plate->objects.count; i++) {
        const iso_object *object = &plate->objects.object[i];
        if (object->max.z <= 0)
            return iso_fail(ISO_OUTSIDE, "%s lies below the bed, up to %.2f mm; see ensure_on_bed",
                            object->name, object->max.z);
        if (object->max.z > options->max_print_height)
            return iso_fail(ISO_OUTSIDE, "%s is %.2f mm high, max_print_height is %.2f mm",
                            object->name, object->max.z, options->max_print_height);
    }
    for (int32_t i = 0; i < plate->instances.count; i++) {
        const iso_instance *instance = &plate->instances.instance[i];
        iso_vec2 by = {iso_mm(instance->by.x), iso_mm(instance->by.y)};
        ISO_TRY(check_instance(&options->bed_shape, &plate->objects.object[instance->object], by,
                               settings_of_growth(options)));
    }
    return ISO_OK;
}

static iso_status place(iso_plate *plate, const iso_options *options) {
    iso_planar_scratch *scratch;
    iso_placing placing = settings_of_placing(options);
    ISO_TRY(iso_planar_scratch_new(&scratch));
    iso_status status = iso_objects_place(&plate->instances, &plate->objects, &placing, scratch);
    iso_planar_scratch_free(scratch);
    return status;
}

/* The nearest copy next, from the bed's origin on. A bed holds few enough for all pairs. */
static void chain(iso_instances *instances) {
    iso_point at = {0, 0};
    for (int32_t i = 0; i < instances->count; i++) {
        int64_t least = INT64_MAX;
        int32_t nearest = i;
        for (int32_t k = i; k < instances->count; k++) {
            int64_t dx = (int64_t)instances->instance[k].by.x - at.x;
            int64_t dy = (int64_t)instances->instance[k].by.y - at.y;
            if (dx * dx + dy * dy < least) {
                least = dx * dx + dy * dy;
                nearest = k;
            }
        }
        iso_instance next = instances->instance[nearest];
        instances->instance[nearest] = instances->instance[i];
        instances->instance[i] = next;
        at = next.by;
    }
}

static iso_status make_labels(iso_plate *plate) {
    int64_t points = 0;
    int32_t count = plate->instances.count;
    ISO_TRY(iso_objects_find_hulls(&plate->objects));
    for (int32_t i = 0; i < count; i++)
        points += plate->objects.object[plate->instances.instance[i].object].hull.first[1];
    ISO_TRY(ISO_ALLOCATE(plate->label, count));
    ISO_TRY(ISO_ALLOCATE(plate->outline, points));
    iso_vec2 *outline = plate->outline;
    for (int32_t i = 0; i < count; i++) {
        const iso_instance *instance = &plate->instances.instance[i];
        const iso_object *object = &plate->objects.object[instance->object];
        plate->label[i] =
            (iso_gcode_object){.name = object->name,
                               .model = instance->object,
                               .copy = instance->copy,
                               .center = {iso_mm(instance->by.x), iso_mm(instance->by.y)},
                               .outline = outline,
                               .outline_count = object->hull.first[1]};
        for (int32_t p = 0; p < object->hull.first[1]; p++)
            *outline++ = (iso_vec2){iso_mm(object->hull.point[p].x + instance->by.x),
                                    iso_mm(object->hull.point[p].y + instance->by.y)};
    }
    return ISO_OK;
}

/* No layer is thicker than the nozzle's diameter. */
static double top_of_skirt(const iso_options *options) {
    double step = options->layer_height;
    if (step < options->nozzle_diameter)
        step = options->nozzle_diameter;
    return options->draft_shield == ISO_SHIELD_ENABLED
               ? INFINITY
               : iso_options_first_height(options) + (options->skirt_height - 1) * step;
}

iso_status plate_load(iso_plate *plate, iso_report *report, const iso_options *options,
                      const char *const *input, int32_t input_count) {
    ISO_TRY(modifiers_parse(&plate->modifiers, options, input_count));
    ISO_TRY(make_objects(plate, report, options, input, input_count));
    ISO_TRY(place(plate, options));
    ISO_TRY(check_volume(plate, options));
    if (options->skirts > 0 &&
        (options->skirt_height > 1 || options->draft_shield == ISO_SHIELD_ENABLED))
        ISO_TRY(iso_objects_find_feet(&plate->objects, top_of_skirt(options)));
    iso_clearance clearance = settings_of_clearance(options);
    if (options->complete_objects)
        ISO_TRY(iso_objects_sequence(&plate->instances, &plate->objects, &clearance));
    else
        chain(&plate->instances);
    return options->gcode_label_objects == ISO_LABELS_DISABLED ? ISO_OK : make_labels(plate);
}

void plate_free(iso_plate *plate) {
    iso_release(plate->label);
    iso_release(plate->outline);
    iso_instances_free(&plate->instances);
    iso_objects_free(&plate->objects);
    modifiers_free(&plate->modifiers);
}

#include "bend.h"

#include <string.h>

#include "base/vector.h"
#include "config/settings.h"
#include "config/settings_machine.h"
#include "field/field.h"
#include "gentle.h"

/* ---- the tool ---- */

static iso_status watch(void *payload, const iso_gcode_move *move) {
    iso_bend *bend = payload;
    clearance_move next = {.from = move->from,
                           .to = move->to,
                           .from_normal = move->from_normal,
                           .to_normal = move->to_normal,
                           .width = move->width,
                           .height = move->height};
    return clearance_add(bend->clearance, &next);
}

/* The mandrel's axis is the field's, if the user says nothing else. */
static void find_pivot(iso_bend *bend, const iso_curved *curved, iso_point by) {
    bool mandrel = bend->machine.kinematics == ISO_KINEMATICS_ROTARY_A ||
                   bend->machine.kinematics == ISO_KINEMATICS_ROTARY_B;
    if (!mandrel || bend->options->kinematics_pivot.count > 0 ||
        iso_field_kind_of(curved->field) != ISO_FIELD_CYLINDER)
        return;
    field_shape shape = field_shape_of(curved->field);
    bend->machine.pivot = vec3_plus(shape.center, vec3(iso_mm(by.x), iso_mm(by.y), 0));
}

/* Of what is around a print only what lies on the bed is sure to be low. */
static bool is_low(const iso_options *options) {
    return options->draft_shield == ISO_SHIELD_DISABLED && options->skirt_height <= 1;
}

/* Around a mandrel there is nothing anyway. */
static bool is_bare(const iso_options *options) {
    return options->kinematics == ISO_KINEMATICS_ROTARY_A ||
           options->kinematics == ISO_KINEMATICS_ROTARY_B ||
           (options->skirts == 0 &&
            (options->brim_type == ISO_BRIM_NONE || !(options->brim_width > 0)));
}

iso_status bend_begin(iso_bend *bend, iso_gcode_options *gcode, const iso_options *options,
                      const iso_curved *curved, iso_point by, bool alone) {
    bend->on = true;
    bend->options = options;
    bend->copy = -1;
    ISO_TRY(settings_of_machine(&bend->machine, options));
    find_pivot(bend, curved, by);
    gcode->machine = &bend->machine;
    if (!options->check_clearance)
        return ISO_OK;
    bend->tool = settings_of_tool(options);
    if (alone && is_low(options) &&
        gentle_is_free(curved, &bend->tool, options->field_tolerance, is_bare(options)))
        return ISO_OK;
    gcode->watch = watch;
    gcode->watch_payload = bend;
    return clearance_new(&bend->clearance, &bend->tool);
}

void bend_free(iso_bend *bend) {
    iso_paths_free(&bend->part);
    iso_paths_free(&bend->lifted);
    iso_release(bend->vertex);
    iso_release(bend->travel);
    clearance_free(bend->clearance);
}

iso_status bend_check(iso_bend *bend, bool last) {
    clearance_hit hit;
    bool found = false;
    if (!bend->clearance)
        return ISO_OK;
    ISO_TRY(clearance_check(&hit, &found, bend->clearance, last));
    return found ? clearance_refuse(&hit) : ISO_OK;
}

/* ---- paths ---- */

/* Flat ones among curved ones. */
static iso_status stand_flat(iso_paths *paths, int32_t height) {
    const iso_frame frame = {.normal = {0, 0, 1}, .height = height};
    ISO_TRY(ISO_GROW(paths->frame, paths->frame_capacity, paths->vertex_count));
    ISO_TRY(ISO_GROW(paths->travel_frame, paths->travel_frame_capacity, paths->travel_count));
    for (int32_t i = 0; i < paths->vertex_count; i++)
        paths->frame[i] = frame;
    for (int32_t i = 0; i < paths->travel_count; i++)
        paths->travel_frame[i] = frame;
    return ISO_OK;
}

iso_status bend_lift(iso_paths **made, iso_bend *bend, iso_paths *flat, const iso_bend_layer *layer,
                     iso_arena *scratch) {
    *made = flat;
    if (!bend->on || flat->count == 0)
        return ISO_OK;
    bool follows = bend->copy == layer->copy;
    bend->copy = layer->copy;
    if (!layer->curved || curved_is_flat(layer->curved))
        return stand_flat(flat, layer->height);
    lift_options lift = curved_lift_options(layer->curved, bend->options, layer->levels,
                                            layer->level, layer->merged);
    lift.from = follows ? &layer->from : NULL;
    *made = &bend->lifted;
    return curved_lift(&bend->lifted, layer->curved, flat, &lift, scratch);
}

iso_status bend_pose(iso_gcode_layer_info *info, iso_bend *bend) {
    if (!bend->on)
        return ISO_OK;
    const iso_paths *paths = info->paths;
    int32_t z = info->z - iso_units(bend->options->z_offset);
    if (!pose_turns(&bend->machine))
        return ISO_OK;
    ISO_TRY(ISO_GROW(bend->vertex, bend->vertex_capacity, paths->vertex_count));
    ISO_TRY(ISO_GROW(bend->travel, bend->travel_capacity, paths->travel_count));
    ISO_TRY(pose_paths(bend->vertex, bend->travel, &bend->last, paths, z, &bend->machine));
    info->pose = bend->vertex;
    info->travel_pose = bend->travel;
    return ISO_OK;
}

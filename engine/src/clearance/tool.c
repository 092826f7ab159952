#include "clearance/tool.h"

#include "base/angle.h"

const char *tool_part_name(tool_part part) {
    static const char *const names[TOOL_PARTS] = {"nozzle", "heater block", "carriage", "gantry"};
    return names[part];
}

/* NaN isn't. */
static bool is_length(double mm) {
    return mm >= 0 && mm <= 1e5;
}

static bool is_box(iso_vec2 low, iso_vec2 high) {
    return fabs(low.x) <= 1e5 && fabs(low.y) <= 1e5 && fabs(high.x) <= 1e5 && fabs(high.y) <= 1e5;
}

iso_status tool_init(tool_body *made, const clearance_tool *model) {
    if (!is_length(model->tip_diameter) || !is_length(model->cone_height) ||
        !is_length(model->carriage_height) || !is_length(model->gantry_height) ||
        !is_box(model->block_low, model->block_high) ||
        !is_box(model->carriage_low, model->carriage_high))
        return iso_fail(ISO_BAD_CONFIG, "the tool has a length that is negative or no number: see "
                                        "the options clearance_*");
    if (!(model->cone_angle > 0 && model->cone_angle < 90))
        return iso_fail(ISO_BAD_CONFIG,
                        "the nozzle's cone at %g degrees to its axis makes no sense: it must be "
                        "above 0 and below 90 (clearance_cone)",
                        model->cone_angle);
    double sine, cosine;
    iso_sine_cosine(&sine, &cosine, model->cone_angle);
    *made = (tool_body){*model, sine / cosine, 1 / cosine};
    return ISO_OK;
}

static bool nozzle(tool_shape *shape, const tool_body *tool, double raise, double shrink) {
    double radius = tool->model.tip_diameter / 2 - shrink * tool->secant;
    double low = raise + shrink, high = tool->model.cone_height;
    if (radius + shrink * tool->tangent < 0) /* what is left is pointed */
        low = raise - radius / tool->tangent;
    *shape = (tool_shape){.low = low,
                          .high = high,
                          .round = true,
                          .radius_low = most_of(0, radius + (low - raise) * tool->tangent),
                          .radius_high = radius + (high - raise) * tool->tangent};
    return low < high;
}

static bool column(tool_shape *shape, double low, double high, const iso_vec2 box[2]) {
    *shape = (tool_shape){.low = low, .high = high, .box_low = box[0], .box_high = box[1]};
    return low < high && box[0].x < box[1].x && box[0].y < box[1].y;
}

/* A box from low to high as a disc around the axis, if it may stand in any direction. */
static bool boxed(tool_shape *shape, const tool_body *tool, const iso_vec2 box[2],
                  const double between_shrink[3]) {
    double low = between_shrink[0], high = between_shrink[1], shrink = between_shrink[2];
    iso_vec2 shrunk[2] = {{box[0].x + shrink, box[0].y + shrink},
                          {box[1].x - shrink, box[1].y - shrink}};
    if (!column(shape, low + shrink, high, shrunk))
        return false;
    if (tool->model.turning == CLEARANCE_ABOUT_ALL) {
        double x = most_of(fabs(box[0].x), fabs(box[1].x)),
               y = most_of(fabs(box[0].y), fabs(box[1].y));
        shape->round = true;
        shape->radius_low = shape->radius_high = sqrt(x * x + y * y) - shrink;
    }
    return true;
}

bool tool_shape_of(tool_shape *shape, const tool_body *tool, tool_part part,
                   const double raise_shrink[2], double reach) {
    const clearance_tool *model = &tool->model;
    double raise = raise_shrink[0], shrink = raise_shrink[1];
    switch (part) {
    case TOOL_NOZZLE:
        return nozzle(shape, tool, raise, shrink);
    case TOOL_BLOCK:
        return boxed(shape, tool, (iso_vec2[]){model->block_low, model->block_high},
                     (double[]){model->cone_height, reach, shrink});
    case TOOL_CARRIAGE:
        return boxed(shape, tool, (iso_vec2[]){model->carriage_low, model->carriage_high},
                     (double[]){model->carriage_height, reach, shrink});
    default:
        return model->gantry_height > 0 && column(shape, model->gantry_height + shrink, reach,
                                                  (iso_vec2[]){{-reach, -reach}, {reach, reach}});
    }
}

/* What of `along` is square to a unit axis, of length 1; where that is nothing, any such. */
static iso_vec3 square_to(iso_vec3 axis, iso_vec3 along) {
    iso_vec3 rest = vec3_along(along, -vec3_dot(along, axis), axis);
    if (vec3_dot(rest, rest) < 1e-12) {
        along = fabs(axis.z) < 0.5 ? vec3(0, 0, 1) : vec3(along.y, along.x, 0);
        rest = vec3_along(along, -vec3_dot(along, axis), axis);
    }
    return vec3_unit(rest);
}

tool_pose tool_pose_at(const tool_body *tool, iso_vec3 tip, iso_vec3 normal) {
    if (tool->model.turning == CLEARANCE_UPRIGHT)
        return (tool_pose){tip, vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)};
    tool_pose pose = {.tip = tip, .axis = vec3_unit(normal)};
    if (tool->model.turning == CLEARANCE_ABOUT_Y) {
        pose.y = square_to(pose.axis, vec3(0, 1, 0));
        pose.x = vec3_cross(pose.y, pose.axis);
    } else {
        pose.x = square_to(pose.axis, vec3(1, 0, 0));
        pose.y = vec3_cross(pose.axis, pose.x);
    }
    return pose;
}

iso_vec3 tool_support(const tool_shape *shape, const tool_pose *pose, iso_vec3 direction) {
    double x = vec3_dot(direction, pose->x), y = vec3_dot(direction, pose->y);
    double z = vec3_dot(direction, pose->axis), height = z > 0 ? shape->high : shape->low;
    if (shape->round) {
        double across = sqrt(x * x + y * y);
        bool high =
            z * (shape->high - shape->low) + across * (shape->radius_high - shape->radius_low) > 0;
        double radius = high ? shape->radius_high : shape->radius_low;
        height = high ? shape->high : shape->low;
        x = across > 0 ? x / across * radius : radius;
        y = across > 0 ? y / across * radius : 0;
    } else {
        x = x > 0 ? shape->box_high.x : shape->box_low.x;
        y = y > 0 ? shape->box_high.y : shape->box_low.y;
    }
    iso_vec3 at = vec3_along(pose->tip, height, pose->axis);
    return vec3_along(vec3_along(at, x, pose->x), y, pose->y);
}

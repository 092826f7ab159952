/* The tool's parts as convex shapes, and where they stand along a piece of a move. */
#ifndef ISO_CLEARANCE_TOOL_H
#define ISO_CLEARANCE_TOOL_H

#include "base/vector.h"
#include "clearance/clearance.h"

typedef enum tool_part {
    TOOL_NOZZLE,
    TOOL_BLOCK,
    TOOL_CARRIAGE,
    TOOL_GANTRY,
    TOOL_PARTS
} tool_part;

const char *tool_part_name(tool_part part);

enum { TOOL_ALL = (1 << TOOL_PARTS) - 1 };

/* C's own are calls of a library here, for what they do with NaN. */
static inline double least_of(double a, double b) {
    return a < b ? a : b;
}
static inline double most_of(double a, double b) {
    return a > b ? a : b;
}

typedef struct tool_body {
    clearance_tool model;
    double tangent, secant; /* of the cone's angle */
} tool_body;

/* ISO_BAD_CONFIG */
iso_status tool_init(tool_body *made, const clearance_tool *model) ISO_MUST_CHECK;

/* Between two heights above the tip a frustum, or a box if `round` is false. */
typedef struct tool_shape {
    double low, high;
    bool round;
    double radius_low, radius_high;
    iso_vec2 box_low, box_high;
} tool_shape;

/* A part without what is less than `shrink` under its surface; the nozzle higher by `raise`. What
 * has no end ends at `reach` above the tip. false: nothing is left. */
bool tool_shape_of(tool_shape *shape, const tool_body *tool, tool_part part,
                   const double raise_shrink[2], double reach);

typedef struct tool_pose {
    iso_vec3 tip, x, y, axis;
} tool_pose;

tool_pose tool_pose_at(const tool_body *tool, iso_vec3 tip, iso_vec3 normal);

/* The point of the shape that is farthest in a direction. */
iso_vec3 tool_support(const tool_shape *shape, const tool_pose *pose, iso_vec3 direction);

#endif

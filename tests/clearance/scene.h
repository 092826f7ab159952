/* Moves for tests of clearance. */
#ifndef TESTS_CLEARANCE_SCENE_H
#define TESTS_CLEARANCE_SCENE_H

#include "clearance/clearance.h"
#include "base/vector.h"

enum { SCENE_MOST = 400000 };

typedef struct scene_plan {
    int count;
    clearance_move move[SCENE_MOST];
    double width, height;
    iso_vec3 normal; /* of what comes next */
    iso_vec3 at;
} scene_plan;

void scene_start(scene_plan *scene, double width, double height);
void scene_jump(scene_plan *scene, double x, double y,
                double z); /* the tool is there, by no move */
void scene_travel(scene_plan *scene, double x, double y, double z);
void scene_print(scene_plan *scene, double x, double y, double z);

/* A wall of lines from (x, y0) to (x, y1), its layers' tops at height, 2 height, ... up to z; by
 * jumps. */
void scene_wall(scene_plan *scene, double x, double y0, double y1, double z);

/* About the x axis, by the angle with this sine and cosine. */
void scene_turn(scene_plan *scene, double sine, double cosine);

clearance_tool scene_tool(void); /* as the options' defaults have it */

/* All moves from `first` on in one go, `every` moves a check; true: found. */
bool scene_check(clearance_hit *hit, const scene_plan *scene, const clearance_tool *tool,
                 int every);

#endif

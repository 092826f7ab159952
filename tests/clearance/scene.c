#include "scene.h"

#include "check.h"

void scene_start(scene_plan *scene, double width, double height) {
    scene->count = 0;
    scene->width = width;
    scene->height = height;
    scene->normal = vec3(0, 0, 1);
    scene->at = vec3(0, 0, 100);
}

static void add(scene_plan *scene, iso_vec3 to, double width) {
    if (scene->count < SCENE_MOST)
        scene->move[scene->count++] = (clearance_move){
            scene->at, to, scene->normal, scene->normal, width, width > 0 ? scene->height : 0};
    scene->at = to;
}

void scene_jump(scene_plan *scene, double x, double y, double z) {
    scene->at = vec3(x, y, z);
}

void scene_travel(scene_plan *scene, double x, double y, double z) {
    add(scene, vec3(x, y, z), 0);
}

void scene_print(scene_plan *scene, double x, double y, double z) {
    add(scene, vec3(x, y, z), scene->width);
}

void scene_wall(scene_plan *scene, double x, double y0, double y1, double z) {
    for (int i = 1; i * scene->height <= z + 1e-9; i++) {
        scene_jump(scene, x, i % 2 ? y0 : y1, i * scene->height);
        scene_print(scene, x, i % 2 ? y1 : y0, i * scene->height);
    }
}

static void turn(iso_vec3 *at, double sine, double cosine) {
    *at = vec3(at->x, cosine * at->y - sine * at->z, sine * at->y + cosine * at->z);
}

void scene_turn(scene_plan *scene, double sine, double cosine) {
    for (int i = 0; i < scene->count; i++) {
        turn(&scene->move[i].from, sine, cosine);
        turn(&scene->move[i].to, sine, cosine);
        turn(&scene->move[i].from_normal, sine, cosine);
        turn(&scene->move[i].to_normal, sine, cosine);
    }
}

clearance_tool scene_tool(void) {
    return (clearance_tool){.tip_diameter = 0.8,
                            .cone_angle = 45,
                            .cone_height = 6,
                            .block_low = {-10, -10},
                            .block_high = {10, 10},
                            .carriage_height = 20,
                            .carriage_low = {-30, -30},
                            .carriage_high = {30, 30},
                            .gantry_height = 40};
}

bool scene_check(clearance_hit *hit, const scene_plan *scene, const clearance_tool *tool,
                 int every) {
    clearance *check;
    bool found = false;
    memset(hit, 0, sizeof *hit);
    if (!CHECK_OK(clearance_new(&check, tool)))
        return false;
    for (int i = 0; i < scene->count; i++) {
        CHECK_OK(clearance_add(check, &scene->move[i]));
        if (i % every == every - 1)
            CHECK_OK(clearance_check(hit, &found, check, false));
    }
    CHECK_OK(clearance_check(hit, &found, check, true));
    clearance_free(check);
    return found;
}

/* Random scenes against points of the tool and of the beads, and what the ground proves free
 * against what is decided without it. */
#include "check.h"

#include "base/random.h"
#include "clearance/exact.h"
#include "scene.h"

static scene_plan plan;

static double between(uint64_t *state, double low, double high) {
    return low + (high - low) * random_unit(state);
}

/* ---- points ---- */

/* How deep a point is inside a part, by halfspaces: of the cone, block, carriage, gantry. At most
 * 0: it isn't. The nozzle is higher by `raise`. */
static double depth_at(const clearance_tool *tool, const double at[3], double raise) {
    double r = sqrt(at[0] * at[0] + at[1] * at[1]), z = at[2];
    double angle = tool->cone_angle * 3.14159265358979 / 180;
    double side = (tool->tip_diameter / 2 - r) * cos(angle) + (z - raise) * sin(angle);
    double deepest = fmin(z - raise, fmin(side, z < tool->cone_height ? 1 : -1));
    const iso_vec2 low[2] = {tool->block_low, tool->carriage_low};
    const iso_vec2 high[2] = {tool->block_high, tool->carriage_high};
    const double from[2] = {tool->cone_height, tool->carriage_height};
    for (int i = 0; i < 2; i++) {
        double in_x = fmin(at[0] - low[i].x, high[i].x - at[0]);
        double in_y = fmin(at[1] - low[i].y, high[i].y - at[1]);
        if (tool->turning == CLEARANCE_ABOUT_ALL)
            in_x = in_y =
                sqrt(pow(fmax(-low[i].x, high[i].x), 2) + pow(fmax(-low[i].y, high[i].y), 2)) - r;
        deepest = fmax(deepest, fmin(z - from[i], fmin(in_x, in_y)));
    }
    return fmax(deepest, z - tool->gantry_height);
}

/* The tool's own coordinates of a place. */
static void seen(double at[3], const clearance_tool *tool, iso_vec3 tip, iso_vec3 normal,
                 iso_vec3 place) {
    iso_vec3 z = tool->turning == CLEARANCE_UPRIGHT ? vec3(0, 0, 1) : vec3_unit(normal), x, y;
    if (tool->turning == CLEARANCE_ABOUT_Y) {
        y = vec3_unit(vec3_along(vec3(0, 1, 0), -z.y, z));
        x = vec3_cross(y, z);
    } else {
        x = vec3_unit(vec3_along(vec3(1, 0, 0), -z.x, z));
        y = vec3_cross(z, x);
    }
    iso_vec3 from = vec3_minus(place, tip);
    at[0] = vec3_dot(from, x);
    at[1] = vec3_dot(from, y);
    at[2] = vec3_dot(from, z);
}

/* The point of a bead's skin that is farthest in a direction, between its ends at `t`: an end is a
 * disc with a ball rolled around it. */
static iso_vec3 skin(const clearance_move *bead, double t, iso_vec3 out, bool upright) {
    iso_vec3 at[2];
    for (int end = 0; end < 2; end++) {
        iso_vec3 normal = end ? bead->to_normal : bead->from_normal;
        iso_vec3 way = vec3_unit(vec3_minus(bead->to, bead->from));
        iso_vec3 side = vec3_unit(vec3_cross(way, normal));
        iso_vec3 on = vec3_times(way, end ? 1 : -1);
        on = vec3_unit(vec3(on.x, on.y, upright ? fmin(0, on.z) : on.z));
        on = vec3_unit(vec3_along(on, -vec3_dot(on, side), side));
        double u = vec3_dot(out, side), v = fmax(0, vec3_dot(out, on)), size = sqrt(u * u + v * v);
        iso_vec3 flat =
            vec3_along(vec3_times(side, size > 0 ? u / size : 0), size > 0 ? v / size : 0, on);
        if (fabs(vec3_dot(normal, way)) > 1e-3) /* no end: a whole disc */
            flat = vec3_unit(vec3_along(out, -vec3_dot(out, normal), normal));
        at[end] = vec3_along(end ? bead->to : bead->from, -bead->height / 2, normal);
        at[end] = vec3_along(at[end], (bead->width - bead->height) / 2, flat);
        at[end] = vec3_along(at[end], bead->height / 2, out);
    }
    return vec3_between(at[0], at[1], t);
}

/* A bead's normals without what of them is along its line, unless that is most. */
static clearance_move straightened(const clearance_move *move) {
    clearance_move bead = *move;
    iso_vec3 way = vec3_unit(vec3_minus(move->to, move->from));
    for (int end = 0; end < 2; end++) {
        iso_vec3 *normal = end ? &bead.to_normal : &bead.from_normal;
        double along = vec3_dot(*normal, way);
        if (along * along < 0.75)
            *normal = vec3_unit(vec3_along(*normal, -along, way));
    }
    return bead;
}

/* The most that points of a bead are inside the tool along a move. */
static double deepest(const clearance_tool *tool, const clearance_move *move, const way_run *run,
                      const clearance_move *printed) {
    const clearance_move straight = straightened(printed), *bead = &straight;
    enum { ALONG = 12, OUT = 120, POINTS = (ALONG + 1) * OUT };
    iso_vec3 point[POINTS];
    for (int i = 0; i < POINTS; i++) {
        double z = 1 - (i % OUT * 2 + 1) / (double)OUT, turn = i % OUT * 2.39996322972865;
        double r = sqrt(1 - z * z);
        point[i] = skin(bead, i / OUT / (double)ALONG, vec3(r * cos(turn), r * sin(turn), z),
                        tool->turning == CLEARANCE_UPRIGHT);
    }
    double most = -1;
    const double way = vec3_distance(move->from, move->to);
    const int steps = 1 + (int)(way / 0.05);
    for (int k = 0; k <= steps; k++) {
        double t = (double)k / steps, raise = move->height;
        iso_vec3 tip = vec3_between(move->from, move->to, t);
        iso_vec3 normal = vec3_between(move->from_normal, move->to_normal, t);
        if (!is_bead(move)) {
            raise = 0;
            if (vec3_distance(tip, run->begin) <= tool->tip_diameter)
                raise = run->begin_height;
            if (vec3_distance(tip, run->end) <= tool->tip_diameter)
                raise = fmax(raise, run->end_height);
        }
        for (int i = 0; i < POINTS; i++) {
            double at[3];
            seen(at, tool, tip, normal, point[i]);
            most = fmax(most, depth_at(tool, at, raise));
        }
    }
    return most;
}

/* ---- scenes ---- */

static way_run run_at(int at) {
    way_run run = {.begin_height = 0};
    for (int i = at - 1; i >= 0; i--)
        if (is_bead(&plan.move[i])) {
            run.begin = plan.move[i].to;
            run.begin_height = plan.move[i].height;
            break;
        }
    for (int i = at + 1; i < plan.count; i++)
        if (is_bead(&plan.move[i])) {
            run.end = plan.move[i].from;
            run.end_height = plan.move[i].height;
            break;
        }
    return run;
}

static clearance_tool small_tool(uint64_t *state, clearance_turning turning) {
    clearance_tool tool = {.tip_diameter = between(state, 0.2, 1.2),
                           .cone_angle = between(state, 20, 70),
                           .cone_height = between(state, 0.8, 2),
                           .block_low = {-between(state, 1, 3), -between(state, 1, 3)},
                           .block_high = {between(state, 1, 3), between(state, 1, 3)},
                           .carriage_height = between(state, 2.2, 3),
                           .carriage_low = {-between(state, 3, 5), -between(state, 3, 5)},
                           .carriage_high = {between(state, 3, 5), between(state, 3, 5)},
                           .gantry_height = between(state, 3.2, 4),
                           .turning = turning};
    return tool;
}

static iso_vec3 lean(uint64_t *state, double most) {
    return vec3_unit(vec3(between(state, -most, most), between(state, -most, most), 1));
}

/* Beads and travels within a few mm: the later ones higher. */
static void random_scene(uint64_t *state, int count, double most) {
    scene_start(&plan, between(state, 0.3, 0.9), between(state, 0.1, 0.3));
    double size = between(state, 3, 9);
    scene_jump(&plan, 0, 0, 0);
    for (int i = 0; i < count; i++) {
        double low = 2.0 * i / count, high = low + 1;
        iso_vec3 normal = lean(state, most);
        if (random_next(state) % 3 == 0)
            scene_jump(&plan, between(state, 0, size), between(state, 0, size),
                       between(state, low, high));
        if (random_next(state) % 3 == 0)
            scene_travel(&plan, between(state, 0, size), between(state, 0, size),
                         between(state, low, high));
        else
            scene_print(&plan, fmin(size, fmax(0, plan.at.x + between(state, -2, 2))),
                        fmin(size, fmax(0, plan.at.y + between(state, -2, 2))),
                        between(state, low, high));
        plan.move[plan.count - 1].from_normal = plan.normal;
        plan.move[plan.count - 1].to_normal = plan.normal = normal;
    }
}

/* Points say less than what is exact, by their distance: `slack` mm. */
static void check_scene(const clearance_tool *tool, int *hits, int *free) {
    const double slack = 0.03;
    clearance_hit hit;
    bool found = scene_check(&hit, &plan, tool, 5);
    int64_t first = found ? hit.move : plan.count;
    for (int64_t i = 0; i < first; i++) {
        way_run run = run_at((int)i);
        for (int64_t j = 0; j < i; j++)
            if (is_bead(&plan.move[j]))
                CHECK(deepest(tool, &plan.move[i], &run, &plan.move[j]) <
                      CLEARANCE_TOLERANCE + 0.005);
    }
    *free += !found;
    if (!found)
        return;
    way_run run = run_at((int)hit.move);
    double depth = deepest(tool, &plan.move[hit.move], &run, &plan.move[hit.bead]);
    *hits += hit.depth > CLEARANCE_TOLERANCE + slack;
    if (hit.depth > CLEARANCE_TOLERANCE + slack)
        CHECK(depth > CLEARANCE_TOLERANCE - slack / 2);
    CHECK(hit.bead < hit.move);
}

static void test_points(clearance_turning turning) {
    uint64_t state = 10 + turning;
    int hits = 0, free = 0;
    for (int i = 0; i < 30; i++) {
        clearance_tool tool = small_tool(&state, turning);
        random_scene(&state, 4 + (int)(random_next(&state) % 6), turning ? 0.5 : 0.3);
        check_scene(&tool, &hits, &free);
    }
    CHECK(hits > 4);
    CHECK(free > 4);
}

static void test_points_upright(void) {
    test_points(CLEARANCE_UPRIGHT);
}
static void test_points_about_x(void) {
    test_points(CLEARANCE_ABOUT_X);
}
static void test_points_about_y(void) {
    test_points(CLEARANCE_ABOUT_Y);
}
static void test_points_table(void) {
    test_points(CLEARANCE_ABOUT_ALL);
}

/* ---- the ground ---- */

/* Without it. */
static bool decide(clearance_hit *hit, const clearance_tool *model) {
    tool_body tool;
    bead_store beads = {0};
    static exact_move move[SCENE_MOST];
    bool found = false;
    CHECK_OK(tool_init(&tool, model));
    for (int i = 0; i < plan.count; i++) {
        move[i] = (exact_move){
            plan.move[i],
            run_at(i),
            i,
            {TOOL_ALL, {-INFINITY, -INFINITY, -INFINITY}, {INFINITY, INFINITY, INFINITY}}};
        clearance_move bead = way_bead(&plan.move[i]);
        if (is_bead(&bead))
            CHECK_OK(beads_add(&beads, &bead, i));
    }
    memset(hit, 0, sizeof *hit);
    CHECK_OK(exact_check(hit, &found, &tool, &beads, move, plan.count));
    beads_free(&beads);
    return found;
}

static void same_hit(bool found, const clearance_hit *a, const clearance_hit *b) {
    if (!found)
        return;
    CHECK_EQUAL(a->move, b->move);
    CHECK_EQUAL(a->bead, b->bead);
    /* Normals were brought to length 1 for one of them. */
    CHECK_NEAR(a->depth, b->depth, 1e-9);
    CHECK_NEAR(a->place.x, b->place.x, 1e-9);
    CHECK_NEAR(a->tip.z, b->tip.z, 1e-9);
    CHECK(strcmp(a->part, b->part) == 0);
}

/* Layers of a curved surface, printed in stripes: many moves that all but touch. */
static void layers(uint64_t *state) {
    double a = between(state, -0.02, 0.02), b = between(state, -0.02, 0.02);
    double c = between(state, -0.2, 0.2), d = between(state, -0.2, 0.2);
    scene_start(&plan, 0.45, 0.2);
    for (int layer = 0; layer < 3; layer++)
        for (int i = 0; i < 16; i++)
            for (int k = 0; k <= 6; k++) {
                double x = (i % 2 ? 6 - k : k) * 1.2 - 3.6, y = i * 0.4 - 3.2;
                double z = 5 + layer * 0.2 + a * x * x + b * y * y + c * x + d * y;
                iso_vec3 normal = vec3_unit(vec3(-2 * a * x - c, -2 * b * y - d, 1));
                if (k == 0)
                    i == 0 ? scene_jump(&plan, x, y, z) : scene_travel(&plan, x, y, z + 0.2);
                else
                    scene_print(&plan, x, y, z);
                if (plan.count > 0) {
                    plan.move[plan.count - 1].from_normal = plan.normal;
                    plan.move[plan.count - 1].to_normal = plan.normal = normal;
                }
            }
}

/* Around a mandrel along x: lines along it, two layers. What is sticks out a little at times. */
static void mandrel(uint64_t *state) {
    double radius = between(state, 2, 5), width = 0.5;
    scene_start(&plan, width, 0.2);
    for (int layer = 0; layer < 2; layer++)
        for (int i = 0; i < 40; i++) {
            double r = radius + 0.2 * layer, angle = i * width * 0.9 / radius;
            r += random_next(state) % 40 == 0 ? between(state, 0, 1) : 0;
            for (int k = 0; k <= 3; k++) {
                iso_vec3 normal = vec3(0, sin(angle), cos(angle));
                double x = 3 * (i % 2 ? 3 - k : k), lift = k == 0 && i > 0 ? 0.4 : 0;
                iso_vec3 at = vec3_times(normal, r + lift);
                if (i + layer == 0 && k == 0)
                    scene_jump(&plan, x, at.y, at.z);
                else if (k == 0)
                    scene_travel(&plan, x, at.y, at.z);
                else
                    scene_print(&plan, x, at.y, at.z);
                if (plan.count > 0) {
                    plan.move[plan.count - 1].from_normal = plan.normal;
                    plan.move[plan.count - 1].to_normal = normal;
                }
                plan.normal = normal;
            }
        }
}

/* What is proven free is free, and hits are the same, in however many parts the print comes. */
static void test_proofs(clearance_turning turning) {
    uint64_t state = 77 + turning;
    int hits = 0, free = 0, late = 0;
    for (int i = 0; i < (turning ? 100 : 240); i++) {
        clearance_tool tool = small_tool(&state, turning);
        if (i % 2) {
            tool.cone_height += 1;
            tool.carriage_height += 1;
            tool.gantry_height += 1;
            if (turning && i % 4 == 1)
                mandrel(&state);
            else
                layers(&state);
        } else {
            random_scene(&state, 3 + (int)(random_next(&state) % 30), 0.5);
        }
        clearance_hit hit, other, again;
        bool found = scene_check(&hit, &plan, &tool, 1000);
        CHECK_EQUAL(decide(&other, &tool), found);
        same_hit(found, &other, &hit);
        CHECK_EQUAL(found, scene_check(&again, &plan, &tool, 1 + i % 9));
        same_hit(found, &again, &hit);
        hits += found;
        free += !found;
        late += found && hit.move > 20;
    }
    CHECK(hits > (turning ? 50 : 100));
    CHECK(free > (turning ? 8 : 40));
    CHECK(late > 3);
}

static void test_ground(void) {
    test_proofs(CLEARANCE_UPRIGHT);
}
static void test_room_about_x(void) {
    test_proofs(CLEARANCE_ABOUT_X);
}
static void test_room_about_y(void) {
    test_proofs(CLEARANCE_ABOUT_Y);
}
static void test_room_table(void) {
    test_proofs(CLEARANCE_ABOUT_ALL);
}

int main(void) {
    RUN(test_points_upright);
    RUN(test_points_about_x);
    RUN(test_points_about_y);
    RUN(test_points_table);
    RUN(test_ground);
    RUN(test_room_about_x);
    RUN(test_room_about_y);
    RUN(test_room_table);
    return check_verdict();
}

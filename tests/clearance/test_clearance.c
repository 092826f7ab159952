/* Known walls at known distances of the tool. */
#include "check.h"

#include "base/memory.h"
#include "scene.h"

static scene_plan plan;

static const double margin = 0.02; /* mm, to either side of where the touch begins */

/* Is there a hit with the tool's way along y, x mm from a wall as high as z, at `tip`? */
static bool beside(clearance_hit *hit, const clearance_tool *tool, double wall, double x,
                   double tip) {
    scene_start(&plan, 0.4, 0.2);
    scene_wall(&plan, 0, -20, 20, wall);
    scene_jump(&plan, x, -5, tip);
    scene_travel(&plan, x, 5, tip);
    return scene_check(hit, &plan, tool, 1000);
}

static void check_limit(const char *part, double wall, double limit, double tip) {
    clearance_tool tool = scene_tool();
    clearance_hit hit;
    for (int side = -1; side < 2; side += 2) {
        CHECK(!beside(&hit, &tool, wall, side * (limit + margin), tip));
        if (!CHECK(beside(&hit, &tool, wall, side * (limit - margin), tip)))
            continue;
        CHECK(strcmp(hit.part, part) == 0);
        CHECK_EQUAL(plan.count - 1, hit.move);
        CHECK_NEAR(CLEARANCE_TOLERANCE + margin / 2, hit.depth, margin / 2 + 0.003);
        CHECK_NEAR(0, fabs(hit.place.x) - 0.2, 0.15);
        CHECK_NEAR(limit, fabs(hit.tip.x), margin + 0.001);
    }
}

/* The wall's upper edge is round, of a radius of 0.1; the cone's side comes at 45 degrees. */
static void test_cone(void) {
    double edge = 0.1 + 0.4 + (5.1 - 1); /* of the edge's middle to the axis when on the cone */
    check_limit("nozzle", 5.2, edge + sqrt(2) * (0.1 - CLEARANCE_TOLERANCE), 1);
}

static void test_block(void) {
    check_limit("heater block", 8, 10 + 0.2 - CLEARANCE_TOLERANCE, 0.2);
}

static void test_carriage(void) {
    check_limit("carriage", 25, 30 + 0.2 - CLEARANCE_TOLERANCE, 0.2);
}

static void test_gantry(void) {
    clearance_tool tool = scene_tool();
    clearance_hit hit;
    CHECK(!beside(&hit, &tool, 45, 80, 5 - CLEARANCE_TOLERANCE + margin));
    CHECK(beside(&hit, &tool, 45, 80, 5 - CLEARANCE_TOLERANCE - margin));
    CHECK(hit.part && strcmp(hit.part, "gantry") == 0);
    CHECK_NEAR(45, hit.place.z, 0.21);
    tool.gantry_height = 0;
    CHECK(!beside(&hit, &tool, 45, 80, 1));
}

/* What isn't there can't be hit. */
static void test_absent_boxes(void) {
    clearance_tool tool = scene_tool();
    clearance_hit hit;
    CHECK(beside(&hit, &tool, 8, 9, 0.2));
    tool.block_low = tool.block_high = (iso_vec2){0, 0};
    CHECK(!beside(&hit, &tool, 8, 9, 0.2));
    CHECK(beside(&hit, &tool, 25, 9, 0.2));
    tool.carriage_low = tool.carriage_high = (iso_vec2){0, 0};
    CHECK(!beside(&hit, &tool, 25, 9, 0.2));
    CHECK(beside(&hit, &tool, 5, 4, 0.2));
}

/* Everything turned about x: the same answers. */
static void test_tilted(void) {
    for (int i = 0; i < 16; i++) {
        double angle = 0.4 * i, limit = 10 + 0.2 - CLEARANCE_TOLERANCE;
        clearance_tool tool = scene_tool();
        tool.turning = CLEARANCE_ABOUT_X;
        clearance_hit hit;
        for (int far = 0; far < 2; far++) {
            double x = limit + (far ? margin : -margin);
            scene_start(&plan, 0.4, 0.2);
            scene_wall(&plan, 0, -20, 20, 8);
            scene_jump(&plan, x, -5, 0.2);
            scene_travel(&plan, x, 5, 0.2);
            scene_turn(&plan, sin(angle), cos(angle));
            CHECK_EQUAL(!far, scene_check(&hit, &plan, &tool, 1000));
        }
    }
}

/* The tool turns above a pole: the carriage's edge comes down on it between the two poses. */
static void test_turning(void) {
    clearance_tool tool = scene_tool();
    tool.turning = CLEARANCE_ABOUT_Y;
    clearance_hit hit;
    for (int low = 0; low < 2; low++) {
        /* Turned by a about y the carriage's lower edge is 30 and 20 mm from the tip along axes
         * that are turned, lowest when a is largest. */
        double a = 0.3, x = 20 * sin(a) + 30 * cos(a), z = 20 * cos(a) - 30 * sin(a);
        double pole = floor((z + 2) / 0.2) * 0.2, tip = pole - z + (low ? -0.1 : 0.1);
        scene_start(&plan, 0.4, 0.2);
        scene_wall(&plan, x - 0.25, -2, 2, pole);
        scene_jump(&plan, 0, 0, tip);
        scene_travel(&plan, 0, 0, tip);
        plan.move[plan.count - 1].to_normal = vec3(sin(a), 0, cos(a));
        CHECK_EQUAL(low, scene_check(&hit, &plan, &tool, 1000));
        if (low)
            CHECK(strcmp(hit.part, "carriage") == 0);
    }
}

/* Boxes of a machine whose table turns are taken for round. */
static void test_table(void) {
    clearance_tool tool = scene_tool();
    tool.turning = CLEARANCE_ABOUT_ALL;
    clearance_hit hit;
    double limit = 10 * sqrt(2) + 0.2 - CLEARANCE_TOLERANCE;
    CHECK(beside(&hit, &tool, 8, limit - margin, 0.2));
    CHECK(!beside(&hit, &tool, 8, limit + margin, 0.2));
}

/* Wide lines side by side on a slope, printed upwards or downwards: the tip's rim lies on the flat
 * of the one uphill. */
static bool on_slope(clearance_hit *hit, double degrees, double height, bool down) {
    double angle = degrees * 3.14159265358979 / 180;
    clearance_tool tool = scene_tool();
    scene_start(&plan, 1, height);
    plan.normal = vec3(-sin(angle), 0, cos(angle));
    for (int layer = 0; layer < 3; layer++)
        for (int i = 0; i < 9; i++) {
            double along = 0.8 * (down ? 8 - i : i), up = layer * height;
            double x = along * cos(angle) - up * sin(angle);
            double z = along * sin(angle) + up * cos(angle);
            scene_jump(&plan, x, i % 2 ? -3 : 3, z);
            scene_print(&plan, x, i % 2 ? 3 : -3, z);
        }
    return scene_check(hit, &plan, &tool, 10);
}

/* The rim of the tip presses by 0.4 tan(slope), no more than the layer's height. */
static void test_slope(void) {
    clearance_hit hit;
    double heights[] = {0.1, 0.2, 0.3};
    for (int i = 0; i < 3; i++) {
        double limit = atan((heights[i] + CLEARANCE_TOLERANCE) / 0.4) * 180 / 3.14159265358979;
        for (int down = 0; down < 2; down++) {
            CHECK(!on_slope(&hit, limit - 0.3, heights[i], down));
            CHECK_EQUAL(down, on_slope(&hit, limit + 2, heights[i], down));
            CHECK(!down || strcmp(hit.part, "nozzle") == 0);
        }
    }
    CHECK(!on_slope(&hit, 0, 0.2, true));
}

/* At the top of a roof the normal may be of anything: no bead stands above the nozzle's own way for
 * that. */
static void test_ridge(void) {
    clearance_tool tool = scene_tool();
    clearance_hit hit;
    scene_start(&plan, 0.45, 0.114);
    plan.normal = vec3_unit(vec3(-0.19, 0, 1));
    scene_jump(&plan, -2, 0, 9.62);
    scene_print(&plan, 0, 0, 10);
    scene_print(&plan, 0.35, 0, 9.9335);
    plan.move[1].from_normal = vec3_unit(vec3(-0.5, 0, 1));
    plan.move[1].to_normal = plan.normal = vec3_unit(vec3(0.19, 0, 1));
    scene_print(&plan, 2, 0, 9.62);
    CHECK(!scene_check(&hit, &plan, &tool, 1000));
}

static void print_hill(double top) {
    scene_start(&plan, 0.4, 0.2);
    for (int i = 1; i <= 10; i++) {
        scene_jump(&plan, -i, 0, 0.2);
        scene_print(&plan, -i, 10, 0.2);
    }
    scene_wall(&plan, 5, 0, 10, top);
}

/* From one side of a hill to the other, through it or above. */
static void test_travel(void) {
    clearance_tool tool = scene_tool();
    clearance_hit hit;
    for (int above = 0; above < 2; above++) {
        print_hill(1);
        scene_jump(&plan, 0, 5, 0.2);
        scene_print(&plan, 1, 5, 0.2);
        double z = 1 - CLEARANCE_TOLERANCE + (above ? 0.02 : -0.02);
        scene_travel(&plan, 1, 5, z);
        scene_travel(&plan, 8, 5, z);
        scene_travel(&plan, 9, 5, 0.2);
        scene_print(&plan, 9, 8, 0.2);
        CHECK_EQUAL(!above, scene_check(&hit, &plan, &tool, 1000));
        if (!above) {
            CHECK_NEAR(5, hit.tip.x, 1.2);
            CHECK_EQUAL(plan.count - 3, hit.move);
            CHECK_EQUAL(14, hit.bead);
        }
    }
}

/* A travel may press where it begins and ends, by the height of the beads there; no farther. The
 * tip's rim is over the wall, 1 mm high, from x = 4.4 on. */
static void test_ends_of_travel(void) {
    clearance_tool tool = scene_tool();
    clearance_hit hit;
    for (int far = 0; far < 2; far++) {
        for (int deep = 0; deep < 2; deep++) {
            double z = deep ? 0.75 : 0.85, end = far ? 3.4 : 4.2;
            scene_start(&plan, 0.4, 0.2);
            scene_wall(&plan, 5, -5, 5, 1);
            scene_jump(&plan, 2, 0, z);
            scene_print(&plan, end, 0, z);
            scene_travel(&plan, 4.3, 0, z);
            scene_travel(&plan, 4.6, 0, z);
            CHECK_EQUAL(far || deep, scene_check(&hit, &plan, &tool, 1000));

            scene_start(&plan, 0.4, 0.2);
            scene_wall(&plan, 5, -5, 5, 1);
            scene_jump(&plan, 4.6, 0, z);
            scene_travel(&plan, 4.3, 0, z);
            scene_travel(&plan, end, 0, z);
            scene_print(&plan, 2, 0, z);
            CHECK_EQUAL(far || deep, scene_check(&hit, &plan, &tool, 1));
            CHECK_EQUAL(far || deep, scene_check(&hit, &plan, &tool, 1000));
        }
    }
}

/* What is printed later is not there yet, whether there is a check between or not. */
static void test_order(void) {
    clearance_tool tool = scene_tool();
    clearance_hit hit;
    int every[] = {1, 7, 1000};
    for (int i = 0; i < 3; i++) {
        scene_start(&plan, 0.4, 0.2);
        scene_jump(&plan, 9, -5, 0.2);
        scene_print(&plan, 9, 5, 0.2);
        scene_wall(&plan, 0, -20, 20, 8);
        CHECK(!scene_check(&hit, &plan, &tool, every[i]));
        scene_jump(&plan, 9, -5, 0.4);
        scene_print(&plan, 9, 5, 0.4);
        scene_jump(&plan, 8, -5, 0.4);
        scene_print(&plan, 8, 5, 0.4);
        CHECK(scene_check(&hit, &plan, &tool, every[i]));
        CHECK_EQUAL(41, hit.move);
    }
}

/* Nothing was added. */
static void test_nothing(void) {
    clearance *check;
    clearance_hit hit;
    bool found = true;
    clearance_tool tool = scene_tool();
    CHECK_OK(clearance_new(&check, &tool));
    CHECK_OK(clearance_check(&hit, &found, check, true));
    CHECK(!found);
    CHECK_OK(clearance_check(&hit, &found, check, false));
    clearance_free(check);
    clearance_free(NULL);
}

static void test_message(void) {
    clearance_tool tool = scene_tool();
    clearance_hit hit;
    CHECK(beside(&hit, &tool, 8, 9, 0.2));
    CHECK_STATUS(ISO_NOT_VERIFIED, clearance_refuse(&hit));
    CHECK(strstr(iso_error_message(), "heater block") != NULL);
    CHECK(strstr(iso_error_message(), "(9.000, ") != NULL);
}

static void test_bad_tools(void) {
    clearance *check;
    clearance_tool tool = scene_tool();
    tool.cone_angle = 90;
    CHECK_STATUS(ISO_BAD_CONFIG, clearance_new(&check, &tool));
    tool = scene_tool();
    tool.tip_diameter = NAN;
    CHECK_STATUS(ISO_BAD_CONFIG, clearance_new(&check, &tool));
    tool = scene_tool();
    tool.block_low.x = INFINITY;
    CHECK_STATUS(ISO_BAD_CONFIG, clearance_new(&check, &tool));
}

static void test_outside(void) {
    clearance *check;
    clearance_tool tool = scene_tool();
    clearance_hit hit;
    bool found;
    CHECK_OK(clearance_new(&check, &tool));
    scene_start(&plan, 0.4, 0.2);
    scene_print(&plan, 2000, 0, 1);
    CHECK_OK(clearance_add(check, &plan.move[0]));
    CHECK_STATUS(ISO_OUTSIDE, clearance_check(&hit, &found, check, true));
    clearance_free(check);
}

/* Every allocation fails once; then the answer is the same as ever. */
static void test_allocations(void) {
    clearance_tool tool = scene_tool();
    scene_start(&plan, 0.4, 0.2);
    scene_wall(&plan, 0, -20, 20, 8);
    scene_wall(&plan, 40, -20, 20, 8);
    scene_jump(&plan, 9, -5, 0.2);
    scene_print(&plan, 9, 5, 0.2);
    for (int64_t n = 0;; n++) {
        clearance *check;
        clearance_hit hit;
        bool found = false;
        iso_fail_allocation_after(n);
        iso_status status = clearance_new(&check, &tool);
        if (status == ISO_OK) {
            for (int i = 0; i < plan.count && status == ISO_OK; i++)
                status = clearance_add(check, &plan.move[i]);
            if (status == ISO_OK)
                status = clearance_check(&hit, &found, check, true);
            clearance_free(check);
        }
        iso_fail_allocation_after(-1);
        if (status == ISO_OK) {
            CHECK(found);
            CHECK(n > 8);
            break;
        }
        CHECK_EQUAL(ISO_NO_MEMORY, status);
    }
}

int main(void) {
    RUN(test_cone);
    RUN(test_block);
    RUN(test_carriage);
    RUN(test_gantry);
    RUN(test_absent_boxes);
    RUN(test_tilted);
    RUN(test_turning);
    RUN(test_table);
    RUN(test_slope);
    RUN(test_ridge);
    RUN(test_travel);
    RUN(test_ends_of_travel);
    RUN(test_order);
    RUN(test_nothing);
    RUN(test_message);
    RUN(test_bad_tools);
    RUN(test_outside);
    RUN(test_allocations);
    return check_verdict();
}

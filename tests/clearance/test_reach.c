/* Orders of islands, against every pair looked at by itself. */
#include "check.h"

#include "base/random.h"
#include "clearance/reach.h"

#include "scene.h"

enum { MOST = 200 };

static reach_group group[MOST];
static int32_t order[MOST];
static iso_arena scratch;

static void set(int i, double x, double y, double size, double low, double high) {
    group[i] = (reach_group){vec3(x, y, low), vec3(x + size, y + size, high)};
}

/* Where each group is in the order; every one is there once. */
static void places(int32_t *place, int count) {
    for (int i = 0; i < count; i++)
        place[i] = -1;
    for (int i = 0; i < count; i++)
        if (CHECK(order[i] >= 0 && order[i] < count))
            place[order[i]] = i;
    for (int i = 0; i < count; i++)
        CHECK(place[i] >= 0);
}

static void test_low_first(void) {
    clearance_tool tool = scene_tool();
    /* 4 mm beside an island that stands 5 mm higher: the cone is 5.4 mm wide there. */
    set(0, 0, 0, 10, 6, 6);
    set(1, 14, 0, 10, 1, 1);
    CHECK_OK(reach_order(order, group, 2, &tool, &scratch));
    CHECK_EQUAL(1, order[0]);
    CHECK_EQUAL(0, order[1]);
    set(1, 15.5, 0, 10, 1, 1);
    CHECK_OK(reach_order(order, group, 2, &tool, &scratch));
    CHECK_EQUAL(0, order[0]);
}

/* 8 mm higher it is the block's turn, 10 mm to the side; 45 mm higher the gantry's. */
static void test_boxes(void) {
    clearance_tool tool = scene_tool();
    set(0, 0, 0, 10, 9, 9);
    set(1, 19.9, 0, 10, 1, 1);
    CHECK_OK(reach_order(order, group, 2, &tool, &scratch));
    CHECK_EQUAL(1, order[0]);
    set(1, 20.1, 0, 10, 1, 1);
    CHECK_OK(reach_order(order, group, 2, &tool, &scratch));
    CHECK_EQUAL(0, order[0]);
    set(0, 0, 0, 10, 22, 22);
    CHECK_OK(reach_order(order, group, 2, &tool, &scratch));
    CHECK_EQUAL(1, order[0]);
    set(1, 300, 0, 10, 1, 1);
    CHECK_OK(reach_order(order, group, 2, &tool, &scratch));
    CHECK_EQUAL(0, order[0]);
    set(0, 0, 0, 10, 46, 46);
    CHECK_OK(reach_order(order, group, 2, &tool, &scratch));
    CHECK_EQUAL(1, order[0]);
}

/* Flat layers stay as they are, and so do those of tools that turn. */
static void test_stable(void) {
    clearance_tool tool = scene_tool();
    for (int i = 0; i < 50; i++)
        set(i, 3 * (i * 7 % 50), 0, 2, 5, 5);
    CHECK_OK(reach_order(order, group, 50, &tool, &scratch));
    for (int i = 0; i < 50; i++)
        CHECK_EQUAL(i, order[i]);
    tool.turning = CLEARANCE_ABOUT_X;
    for (int i = 0; i < 50; i++)
        set(i, 3 * i, 0, 2, 50 - i, 50 - i);
    CHECK_OK(reach_order(order, group, 50, &tool, &scratch));
    for (int i = 0; i < 50; i++)
        CHECK_EQUAL(i, order[i]);
}

/* A chain down a hill is turned round. */
static void test_chain(void) {
    clearance_tool tool = scene_tool();
    for (int i = 0; i < MOST; i++)
        set(i, 3 * i, 0, 2.9, 500 - 2 * i, 500 - 2 * i);
    CHECK_OK(reach_order(order, group, MOST, &tool, &scratch));
    for (int i = 0; i < MOST; i++)
        CHECK_EQUAL(MOST - 1 - i, order[i]);
}

/* The tool over the lower island, seen as a stack of thin slices, meets the higher one's top. */
static bool meets(const clearance_tool *tool, const reach_group *at, const reach_group *other) {
    double height = other->high.z - at->low.z;
    if (at->low.z >= other->low.z)
        return false;
    double dx = fmax(0, fmax(other->low.x - at->high.x, at->low.x - other->high.x));
    double dy = fmax(0, fmax(other->low.y - at->high.y, at->low.y - other->high.y));
    for (double h = 0.02; h < height; h += 0.02) {
        double cone = h < tool->cone_height ? tool->tip_diameter / 2 +
                                                  h * tan(tool->cone_angle * 3.14159265358979 / 180)
                                            : 0;
        double box = h < tool->cone_height ? 0 : h < tool->carriage_height ? 10 : 30;
        if (sqrt(dx * dx + dy * dy) < cone || (dx < box && dy < box) || h > tool->gantry_height)
            return true;
    }
    return false;
}

static void test_random(void) {
    uint64_t state = 5;
    clearance_tool tool = scene_tool();
    int32_t place[MOST], turned = 0, kept = 0;
    for (int round = 0; round < 200; round++) {
        int count = 2 + (int)(random_next(&state) % 12);
        for (int i = 0; i < count; i++) {
            double z = 25 * random_unit(&state);
            set(i, 60 * random_unit(&state), 60 * random_unit(&state), 8 * random_unit(&state), z,
                z + 2 * random_unit(&state));
        }
        CHECK_OK(reach_order(order, group, count, &tool, &scratch));
        places(place, count);
        for (int i = 0; i < count; i++)
            for (int k = 0; k < count; k++)
                if (meets(&tool, &group[i], &group[k])) {
                    CHECK(place[i] < place[k]);
                    turned += i > k;
                    kept += i < k;
                }
    }
    CHECK(turned > 500 && kept > 500);
}

static void test_allocations(void) {
    clearance_tool tool = scene_tool();
    for (int i = 0; i < 50; i++)
        set(i, 3 * i, 0, 2.9, 100 - 2 * i, 100 - 2 * i);
    for (int64_t n = 0;; n++) {
        iso_arena arena = {0};
        iso_fail_allocation_after(n);
        iso_status status = reach_order(order, group, 50, &tool, &arena);
        iso_fail_allocation_after(-1);
        iso_arena_free(&arena);
        if (status == ISO_OK) {
            CHECK(n > 2);
            CHECK_EQUAL(49, order[0]);
            break;
        }
        CHECK_EQUAL(ISO_NO_MEMORY, status);
    }
}

int main(void) {
    RUN(test_low_first);
    RUN(test_boxes);
    RUN(test_stable);
    RUN(test_chain);
    RUN(test_random);
    RUN(test_allocations);
    iso_arena_free(&scratch);
    return check_verdict();
}

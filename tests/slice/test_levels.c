/* Layers of an object: how many, how thick, where they are cut. */
#include "check.h"

#include "base/memory.h"
#include "slice/search.h"

#include <isoslice/slice.h>

static void check_levels(const iso_levels *levels, double object_height) {
    double bottom = 0;
    for (int32_t i = 0; i < levels->count; i++) {
        CHECK_NEAR(bottom + levels->height[i], levels->top[i], 1e-9);
        CHECK_NEAR(bottom + levels->height[i] / 2, levels->cut[i], 1e-9);
        CHECK(levels->cut[i] < object_height);
        CHECK(i == 0 || levels->cut[i - 1] < levels->cut[i]);
        bottom = levels->top[i];
    }
}

static int32_t count_of(double object_height, double first, double height) {
    iso_levels levels;
    if (!CHECK_OK(iso_levels_uniform(&levels, object_height, first, height)))
        return -1;
    check_levels(&levels, object_height);
    int32_t count = levels.count;
    iso_levels_free(&levels);
    return count;
}

/* PrusaSlicer's rule: a layer is printed if its middle is below the top of the object. */
static void test_count(void) {
    CHECK_EQUAL(100, count_of(20, 0.2, 0.2));
    CHECK_EQUAL(50, count_of(10, 0.2, 0.2));
    CHECK_EQUAL(50, count_of(10.05, 0.2, 0.2));
    CHECK_EQUAL(51, count_of(10.15, 0.2, 0.2));
    CHECK_EQUAL(1, count_of(0.2, 0.2, 0.2));
    CHECK_EQUAL(1, count_of(0.11, 0.2, 0.2));
    CHECK_EQUAL(0, count_of(0.1, 0.2, 0.2)); /* the middle is not below, but at the top */
    CHECK_EQUAL(0, count_of(0.05, 0.2, 0.2));
    CHECK_EQUAL(2, count_of(1, 0.5, 0.5));
    CHECK_EQUAL(1, count_of(0.75, 0.5, 0.5));
    CHECK_EQUAL(99, count_of(19.95, 0.35, 0.2));
}

static void test_no_drift(void) {
    iso_levels levels;
    if (!CHECK_OK(iso_levels_uniform(&levels, 1000, 0.3, 0.1)))
        return;
    CHECK_EQUAL(9998, levels.count);
    CHECK_NEAR(0.3 + 9997 * 0.1, levels.top[9997], 0);
    CHECK_NEAR(0.3 + 4999 * 0.1, levels.top[4999], 0);
    iso_levels_free(&levels);
}

static void test_list_of_heights(void) {
    static const double height[] = {0.3, 0.1, 0.2, 0.25};
    iso_levels levels;
    if (CHECK_OK(iso_levels_from_heights(&levels, height, 4, 2))) {
        static const double top[] = {0.3, 0.4, 0.6, 0.85, 1.1, 1.35, 1.6, 1.85, 2.1};
        check_levels(&levels, 2);
        CHECK_EQUAL(9, levels.count);
        for (int i = 0; i < 9 && i < levels.count; i++)
            CHECK_NEAR(top[i], levels.top[i], 1e-12);
        iso_levels_free(&levels);
    }
    if (CHECK_OK(iso_levels_from_heights(&levels, height, 4, 0.45))) {
        CHECK_EQUAL(2, levels.count); /* the third's middle is at 0.5 */
        iso_levels_free(&levels);
    }
    if (CHECK_OK(iso_levels_from_heights(&levels, height, 1, 2))) {
        CHECK_EQUAL(7, levels.count);
        check_levels(&levels, 2);
        iso_levels_free(&levels);
    }
}

/* Whatever their spacing: even none that a proportion could be made of. */
static void test_search(void) {
    static const double even[] = {0, 1, 2, 3, 4}, uneven[] = {-1e9, 0, 1e-9, 7, 1e12},
                        same[] = {1, 1, 1, 1, 1}, next[] = {0, 5e-324, 1e-323, 1.5e-323, 2e-323};
    static const double *const levels[] = {even, uneven, same, next};
    static const double at[] = {-INFINITY, -1e9, -1,  0,   5e-324, 1e-323, 1e-9,
                                0.5,       1,    2.5, 6.9, 1e12,   2e12,   INFINITY};
    for (size_t k = 0; k < sizeof levels / sizeof *levels; k++)
        for (size_t i = 0; i < sizeof at / sizeof *at; i++) {
            int32_t first = 0;
            while (first < 5 && levels[k][first] < at[i])
                first++;
            CHECK_EQUAL(first, levels_first_at(levels[k], 5, levels_scale(levels[k], 5), at[i]));
        }
}

static void test_nonsense(void) {
    static const double bad[] = {0, -1, NAN, INFINITY};
    iso_levels levels;
    for (int i = 0; i < 4; i++) {
        CHECK_STATUS(ISO_USAGE, iso_levels_uniform(&levels, bad[i], 0.2, 0.2));
        CHECK_STATUS(ISO_USAGE, iso_levels_uniform(&levels, 10, bad[i], 0.2));
        CHECK_STATUS(ISO_USAGE, iso_levels_uniform(&levels, 10, 0.2, bad[i]));
        CHECK(levels.cut == NULL && levels.count == 0);
    }
    CHECK_STATUS(ISO_USAGE, iso_levels_uniform(&levels, 1e7, 0.2, 1e-9));
    CHECK_STATUS(ISO_USAGE, iso_levels_from_heights(&levels, bad, 0, 1));
}

static void test_allocation_failures(void) {
    for (int n = 0; n < 3; n++) {
        iso_levels levels;
        iso_fail_allocation_after(n);
        CHECK_STATUS(ISO_NO_MEMORY, iso_levels_uniform(&levels, 10, 0.2, 0.2));
        iso_fail_allocation_after(-1);
        CHECK(levels.cut == NULL);
    }
}

int main(void) {
    RUN(test_count);
    RUN(test_no_drift);
    RUN(test_list_of_heights);
    RUN(test_search);
    RUN(test_nonsense);
    RUN(test_allocation_failures);
    return check_verdict();
}

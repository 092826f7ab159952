/* One object after the other: order, and room for the print head. */
#include "object/solid.h"

static int make(iso_objects *objects, const double *height, int count) {
    static const char *const name[] = {"a", "b", "c"};
    iso_mesh mesh[3];
    for (int i = 0; i < count; i++) {
        shape s = {0};
        shape_box(&s, 0, 0, 0, 10, 20, height[i]);
        if (!solid_made(&mesh[i], &s))
            return 0;
    }
    return CHECK_OK(
        iso_objects_make(objects, mesh, name, count, &(iso_object_options){.apart = true}));
}

static void test_order(void) {
    const double height[] = {15, 5, 10};
    iso_objects objects;
    iso_instance instance[6];
    iso_instances all = {6, instance};
    if (!make(&objects, height, 3))
        return;
    for (int i = 0; i < 6; i++)
        instance[i] = (iso_instance){i / 2, i % 2, {iso_units(50.0 * i), 0}};
    if (CHECK_OK(iso_objects_sequence(&all, &objects, &(iso_clearance){30, 20}))) {
        static const int object[] = {1, 1, 2, 2, 0, 0};
        for (int i = 0; i < 6; i++) {
            CHECK_EQUAL(object[i], instance[i].object);
            CHECK_EQUAL(i % 2, instance[i].copy);
        }
    }
    iso_objects_free(&objects);
}

/* 10 mm wide, side by side and corner to corner. */
static void test_radius(void) {
    const double height[] = {5, 5};
    iso_objects objects;
    iso_instance instance[2];
    iso_instances all = {2, instance};
    const iso_clearance clearance = {25, 20};
    if (!make(&objects, height, 2))
        return;
    for (int i = 0; i < 40; i++) {
        double x = 15 + i, y = i % 3 * 16, gap_x = x - 10, gap_y = y > 20 ? y - 20 : 0;
        bool near = sqrt(gap_x * gap_x + gap_y * gap_y) < 25 - 1e-9;
        instance[0] = (iso_instance){0, 0, {0, 0}};
        instance[1] = (iso_instance){1, 0, {iso_units(x), iso_units(y)}};
        CHECK_STATUS(near ? ISO_OUTSIDE : ISO_OK, iso_objects_sequence(&all, &objects, &clearance));
    }
    instance[0] = (iso_instance){0, 0, {0, 0}};
    instance[1] = (iso_instance){1, 0, {iso_units(22), 0}};
    CHECK_STATUS(ISO_OUTSIDE, iso_objects_sequence(&all, &objects, &clearance));
    CHECK(strstr(iso_error_message(), "a (copy 1) is 12.000 mm from b (copy 1)"));
    iso_objects_free(&objects);
}

/* All but the last must pass below what moves across the bed. */
static void test_height(void) {
    const double height[] = {25, 30};
    iso_objects objects;
    iso_instance instance[2] = {{0, 0, {0, 0}}, {1, 0, {iso_units(100), 0}}};
    iso_instances all = {2, instance};
    if (!make(&objects, height, 2))
        return;
    CHECK_STATUS(ISO_OUTSIDE, iso_objects_sequence(&all, &objects, &(iso_clearance){20, 20}));
    CHECK(strstr(iso_error_message(), "a, 25.00 mm high"));
    CHECK_OK(iso_objects_sequence(&all, &objects, &(iso_clearance){20, 25}));
    all.count = 1;
    CHECK_OK(iso_objects_sequence(&all, &objects, &(iso_clearance){20, 20}));
    iso_objects_free(&objects);
}

/* What is arranged with the radius for a distance can be printed so. */
static void test_arranged(void) {
    const double height[] = {5, 12, 8};
    static const iso_vec2 bed[] = {{0, 0}, {250, 0}, {250, 210}, {0, 210}};
    iso_objects objects;
    iso_instances all;
    iso_planar_scratch *scratch;
    if (!make(&objects, height, 3) || !CHECK_OK(iso_planar_scratch_new(&scratch)))
        return;
    iso_placing placing = {.bed = bed, .bed_count = 4, .copies = 4, .distance = 20};
    if (CHECK_OK(iso_objects_place(&all, &objects, &placing, scratch))) {
        CHECK_OK(iso_objects_sequence(&all, &objects, &(iso_clearance){20, 20}));
        iso_instances_free(&all);
    }
    iso_planar_scratch_free(scratch);
    iso_objects_free(&objects);
}

int main(void) {
    RUN(test_order);
    RUN(test_radius);
    RUN(test_height);
    RUN(test_arranged);
    return check_verdict();
}

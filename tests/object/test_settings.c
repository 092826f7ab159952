/* Options turned into what objects are made and placed with. */
#include "check.h"

#include "config/settings_objects.h"

static iso_options options;

static void set(const char *key, const char *value) {
    CHECK_OK(iso_options_set(&options, key, value, "test"));
}

static void test_nothing_by_itself(void) {
    iso_options_defaults(&options);
    iso_object_options made = settings_of_objects(&options);
    CHECK(!made.apart && !made.split && !made.float_above && made.cut == 0);
    CHECK(made.transform.scale == 1 && !made.transform.inches);
    iso_placing placing = settings_of_placing(&options);
    CHECK_EQUAL(1, placing.copies);
    CHECK_EQUAL(0, placing.columns);
    CHECK_EQUAL(4, placing.bed_count);
    CHECK(!placing.keep && !placing.has_center);
    CHECK_NEAR(6, placing.distance, 0);
    CHECK(placing.margin > 6 && placing.margin < 7.5); /* one skirt, 6 mm away */
}

static void test_transform(void) {
    iso_options_defaults(&options);
    set("scale", "250%");
    set("mirror", "z");
    set("rotate", "10");
    set("rotate_x", "20");
    set("rotate_y", "30");
    set("scale_to_fit", "1,2,3");
    set("cut", "4");
    set("cut_keep", "lower");
    set("ensure_on_bed", "0");
    CHECK_OK(iso_options_check(&options));
    iso_object_options made = settings_of_objects(&options);
    const iso_transform *t = &made.transform;
    CHECK_NEAR(2.5, t->scale, 1e-15);
    CHECK(!t->mirror[0] && !t->mirror[1] && t->mirror[2]);
    CHECK(t->rotate[0] == 20 && t->rotate[1] == 30 && t->rotate[2] == 10);
    CHECK(t->fit.x == 1 && t->fit.y == 2 && t->fit.z == 3);
    CHECK(made.cut == 4 && made.drop_upper && !made.drop_lower && made.float_above);
}

/* What tells models apart, and how far from each other they stand then. */
static void test_apart(void) {
    static const char *const apart[][2] = {
        {"arrange", "1"}, {"duplicate", "2"}, {"split", "1"}, {"complete_objects", "1"}};
    for (int i = 0; i < 4; i++) {
        iso_options_defaults(&options);
        set(apart[i][0], apart[i][1]);
        CHECK(settings_of_objects(&options).apart);
        CHECK_NEAR(i == 3 ? 20 : 6, settings_of_placing(&options).distance, 0);
    }
    iso_options_defaults(&options);
    set("duplicate_grid", "3,2");
    set("brim_width", "4");
    set("skirts", "0");
    CHECK(!settings_of_objects(&options).apart);
    iso_placing placing = settings_of_placing(&options);
    CHECK_EQUAL(3, placing.columns);
    CHECK_EQUAL(2, placing.rows);
    CHECK_NEAR(6 + 2 * 4, placing.distance, 0);
    CHECK_NEAR(4, placing.margin, 0);
}

static void test_adaptive(void) {
    iso_options_defaults(&options);
    iso_adaptive_options made = settings_of_adaptive(&options);
    CHECK_NEAR(0.35, made.first, 1e-12);
    CHECK_NEAR(0.07, made.min, 0);
    CHECK_NEAR(0.3, made.max, 1e-12); /* 75 % of 0.4 */
    set("max_layer_height", "0.2");
    CHECK_NEAR(0.2, settings_of_adaptive(&options).max, 0);
}

static void test_wrong(void) {
    static const char *const wrong[][2] = {{"scale_to_fit", "1,2"},
                                           {"duplicate_grid", "3"},
                                           {"duplicate_grid", "3,1.5"},
                                           {"min_layer_height", "0.31"},
                                           {"max_layer_height", "0.41"}};
    for (int i = 0; i < 5; i++) {
        iso_options_defaults(&options);
        set("adaptive_layers", "1");
        CHECK_OK(iso_options_check(&options));
        set(wrong[i][0], wrong[i][1]);
        CHECK_STATUS(ISO_BAD_CONFIG, iso_options_check(&options));
        CHECK(strstr(iso_error_message(), wrong[i][0]));
    }
}

int main(void) {
    RUN(test_nothing_by_itself);
    RUN(test_transform);
    RUN(test_apart);
    RUN(test_adaptive);
    RUN(test_wrong);
    return check_verdict();
}

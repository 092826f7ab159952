/* The machine that the options speak of. */
#include <string.h>

#include "check.h"
#include "config/settings.h"

static iso_options options;

static void set(const char *key, const char *value) {
    CHECK_OK(iso_options_set(&options, key, value, "test"));
}

static void test_machine_of_options(void) {
    pose_machine machine;
    iso_options_defaults(&options);
    CHECK_OK(settings_of_machine(&machine, &options));
    CHECK(!pose_turns(&machine));
    set("kinematics", "table_bc");
    set("bed_shape", "-20x10,180x10,180x130,-20x130");
    set("center", "7,8"); /* where parts stand moves no axis */
    set("tilt_limits", "-30,110");
    set("turn_limits", "-720,360");
    set("tilt_speed", "45");
    set("turn_speed", "90");
    set("rotary_feed", "inverse_time");
    CHECK_OK(settings_of_machine(&machine, &options));
    CHECK_EQUAL(ISO_KINEMATICS_TABLE_BC, machine.kinematics);
    CHECK(machine.pivot.x == 80 && machine.pivot.y == 70 && machine.pivot.z == 0);
    CHECK(machine.low[0] == -30 && machine.high[0] == 110);
    CHECK(machine.low[1] == -720 && machine.high[1] == 360);
    CHECK(machine.fastest[0] == 45 && machine.fastest[1] == 90);
    CHECK_EQUAL(ISO_FEED_INVERSE_TIME, settings_of_gcode(&options, NULL, 0).rotary_feed);
    set("kinematics_pivot", "1,2,3.5");
    CHECK_OK(settings_of_machine(&machine, &options));
    CHECK(machine.pivot.x == 1 && machine.pivot.y == 2 && machine.pivot.z == 3.5);
}

static void test_lists_of_the_wrong_length(void) {
    pose_machine machine = {.fastest = {1, 2}};
    iso_options_defaults(&options);
    set("kinematics_pivot", "1,2");
    CHECK_STATUS(ISO_BAD_CONFIG, settings_of_machine(&machine, &options));
    CHECK(strstr(iso_error_message(), "kinematics_pivot: give X,Y,Z"));
    iso_options_defaults(&options);
    set("turn_limits", "5,5");
    CHECK_STATUS(ISO_BAD_CONFIG, settings_of_machine(&machine, &options));
    CHECK(strstr(iso_error_message(), "turn_limits: give the least and the greatest"));
    CHECK(machine.fastest[1] == 2); /* untouched */
}

int main(void) {
    RUN(test_machine_of_options);
    RUN(test_lists_of_the_wrong_length);
    return check_verdict();
}

#include "gcode/cooling.h"

#include "check.h"

enum {
    OUTER = 2 * ISO_ROLE_EXTERNAL_PERIMETER,
    INNER = 2 * ISO_ROLE_PERIMETER,
    BRIDGE = 2 * ISO_ROLE_BRIDGE_INFILL
};

static iso_gcode_options usual(void) {
    iso_gcode_options o = iso_gcode_defaults();
    o.speed[ISO_ROLE_EXTERNAL_PERIMETER] = 30;
    o.speed[ISO_ROLE_PERIMETER] = 60;
    o.speed[ISO_ROLE_BRIDGE_INFILL] = 20;
    o.small_perimeter_speed = 15;
    for (int role = 0; role < ISO_ROLE_COUNT; role++)
        o.first_layer_speed[role] = 25;
    o.first_layer_small_perimeter_speed = 25;
    o.slowdown_below_layer_time = 5;
    o.fan_below_layer_time = 65;
    o.min_print_speed = 10;
    o.min_fan_speed = 40;
    o.max_fan_speed = 100;
    o.disable_fan_first_layers = 3;
    return o;
}

static void test_speeds_of_long_layers(void) {
    iso_gcode_options o = usual();
    iso_layer_work work = {.length = {[OUTER] = 3000, [INNER] = 3000}};
    iso_layer_pace pace;
    iso_cooling_pace(&pace, &work, &o, 7);
    CHECK_EQUAL(1800, pace.feed[OUTER]);
    CHECK_EQUAL(900, pace.feed[OUTER + 1]);
    CHECK_EQUAL(3600, pace.feed[INNER]);
    CHECK_NEAR(150, pace.time, 1e-9);
    CHECK_EQUAL(0, pace.fan);
    iso_cooling_pace(&pace, &work, &o, 0);
    for (int s = 0; s < ISO_SPEED_SLOTS; s++)
        CHECK_EQUAL(1500, pace.feed[s]);
}

static void test_speeds_of_the_first_layer_role_by_role(void) {
    iso_gcode_options o = usual();
    iso_layer_work work = {.length = {[OUTER] = 3000, [INNER] = 3000}};
    iso_layer_pace pace;
    o.first_layer_speed[ISO_ROLE_EXTERNAL_PERIMETER] = 12;
    o.first_layer_small_perimeter_speed = 6;
    iso_cooling_pace(&pace, &work, &o, 0);
    CHECK_EQUAL(720, pace.feed[OUTER]);
    CHECK_EQUAL(360, pace.feed[OUTER + 1]);
    CHECK_EQUAL(1500, pace.feed[INNER]);
    CHECK_EQUAL(360, pace.feed[INNER + 1]);
    iso_cooling_pace(&pace, &work, &o, 1);
    CHECK_EQUAL(1800, pace.feed[OUTER]);
}

static void test_short_layers_take_the_least_time(void) {
    iso_gcode_options o = usual();
    iso_layer_work work = {.length = {[OUTER] = 30, [INNER] = 60}, .other_time = 1};
    iso_layer_pace pace;
    iso_cooling_pace(&pace, &work, &o, 7); /* 90 mm in 4 s */
    CHECK_EQUAL(1350, pace.feed[OUTER]);
    CHECK_EQUAL(1350, pace.feed[INNER]);
    CHECK_NEAR(5, pace.time, 1e-9);
    CHECK_EQUAL(100, pace.fan);
}

static void test_no_slower_than_the_least_speed(void) {
    iso_gcode_options o = usual();
    iso_layer_work work = {.length = {[OUTER] = 30, [INNER] = 6}};
    iso_layer_pace pace;
    iso_cooling_pace(&pace, &work, &o, 7);
    CHECK_EQUAL(600, pace.feed[OUTER]);
    CHECK_EQUAL(600, pace.feed[INNER]);
    CHECK_NEAR(3.6, pace.time, 1e-9);
    work.length[INNER] = 40;
    iso_cooling_pace(&pace, &work, &o, 7);
    CHECK_EQUAL(840, pace.feed[OUTER]);
    CHECK_EQUAL(840, pace.feed[INNER]);
    CHECK_NEAR(5, pace.time, 1e-9);
}

/* What is slow already waits until the others are as slow. */
static void test_the_fastest_are_slowed_first(void) {
    iso_gcode_options o = usual();
    iso_layer_work work = {.length = {[OUTER] = 60, [INNER] = 100}};
    iso_layer_pace pace;
    iso_cooling_pace(&pace, &work, &o, 7); /* 2 s and 3 s at 33.3 mm/s */
    CHECK_EQUAL(1800, pace.feed[OUTER]);
    CHECK_EQUAL(2000, pace.feed[INNER]);
    CHECK_NEAR(5, pace.time, 1e-9);
}

/* From stop to stop: 10 mm at 60 mm/s and 1000 mm/s^2 take 10 / 60 + 60 / 1000 s, and 1 mm, too
 * short to reach it, 2 sqrt(1 / 1000). */
static void test_ramps_count(void) {
    iso_gcode_options o = usual();
    iso_layer_work work = {.length = {[INNER] = 1000}, .stops = {[INNER] = 100}};
    iso_layer_pace pace;
    iso_cooling_pace(&pace, &work, &o, 7);
    CHECK_NEAR(100 * (10 / 60.0 + 60 / 1000.0), pace.time, 1e-9);
    work.length[INNER] = 400;
    work.stops[INNER] = 400;
    iso_cooling_pace(&pace, &work, &o, 7);
    CHECK_NEAR(400 * 2 * sqrt(1 / 1000.0), pace.time, 1e-9);
    o.default_acceleration = 500;
    o.role_acceleration[ISO_ROLE_PERIMETER] = 250;
    iso_cooling_pace(&pace, &work, &o, 7);
    CHECK_NEAR(400 * 2 * sqrt(1 / 250.0), pace.time, 1e-9);
}

/* 5 mm^3/s through 0.25 mm^2 are 20 mm/s; 0.05 mm^2 are free up to 100 mm/s. */
static void test_flow_limits_beads_by_their_section(void) {
    iso_gcode_options o = usual();
    iso_layer_pace pace;
    o.max_volumetric_speed = 5;
    iso_cooling_begin(&pace, &o, 7);
    CHECK_EQUAL(3600, pace.feed[INNER]);
    CHECK_NEAR(5 / 60.0 * 1e8, pace.most_area[INNER], 1);
    CHECK_EQUAL(1200, iso_pace_limited_feed(&pace, INNER, 0.25e8));
    CHECK_EQUAL(3600, iso_pace_limited_feed(&pace, INNER, 0.05e8));
    o.speed[ISO_ROLE_PERIMETER] = 0; /* as fast as 4 mm^3/s allow, at most 90 mm/s */
    o.auto_flow = 4;
    o.max_print_speed = 90;
    iso_cooling_begin(&pace, &o, 7);
    CHECK_EQUAL(5400, pace.feed[INNER]);
    CHECK_EQUAL(2400, iso_pace_limited_feed(&pace, INNER, 0.1e8));
    o.first_layer_speed[ISO_ROLE_PERIMETER] = 0;
    o.first_layer_share = 0.5;
    iso_cooling_begin(&pace, &o, 0);
    CHECK_EQUAL(2700, pace.feed[INNER]);
    CHECK_EQUAL(1200, iso_pace_limited_feed(&pace, INNER, 0.1e8));
    o.max_volumetric_speed = 3;
    iso_cooling_begin(&pace, &o, 7);
    CHECK_EQUAL(1800, iso_pace_limited_feed(&pace, INNER, 0.1e8));
}

/* Beads that the flow holds back are slowed once the others are as slow. */
static void test_limited_beads_are_slowed_with_the_others(void) {
    iso_gcode_options o = usual();
    iso_layer_work work = {.length = {[INNER] = 60}};
    iso_layer_pace pace;
    work.limited_length[1200 / ISO_FEED_BIN] = 40; /* 2 s at 20 mm/s */
    work.limited_time[1200 / ISO_FEED_BIN] = 2;
    iso_cooling_pace(&pace, &work, &o, 7);
    CHECK_EQUAL(1200, pace.feed[INNER]);
    CHECK_NEAR(5, pace.time, 1e-9);
    work.length[INNER] = 20;
    iso_cooling_pace(&pace, &work, &o, 7);
    CHECK_EQUAL(720, pace.feed[INNER]); /* 60 mm in 5 s */
    CHECK_NEAR(5, pace.time, 1e-9);
}

/* PrusaSlicer 2.5 with these options, layer by layer: M106 S25.5 and S66.3 on the third and fourth
 * layer at min_fan_speed 40 of long layers: a quarter of the way up and so on. */
static void test_fan_ramp(void) {
    iso_gcode_options o = usual();
    static const int fan[] = {0, 0, 10, 20, 30, 40, 40}, bridge[] = {0, 0, 20, 40, 60, 80, 80};
    iso_layer_work work = {.length = {[INNER] = 60 * 70}};
    iso_layer_pace pace;
    o.fan_always_on = 1;
    o.disable_fan_first_layers = 2;
    o.full_fan_speed_layer = 6;
    o.bridge_fan_speed = 80;
    for (int layer = 0; layer < 7; layer++) {
        iso_cooling_pace(&pace, &work, &o, layer);
        CHECK_EQUAL(fan[layer], pace.fan);
        CHECK_EQUAL(bridge[layer], pace.bridge_fan);
    }
    o.disable_fan_first_layers = 0; /* the first layer goes without, all the same */
    iso_cooling_pace(&pace, &work, &o, 0);
    CHECK_EQUAL(0, pace.fan);
    o.bridge_fan_speed = 20; /* never less than elsewhere */
    iso_cooling_pace(&pace, &work, &o, 9);
    CHECK_EQUAL(40, pace.bridge_fan);
}

static void test_bridges_and_slow_roles_stay(void) {
    iso_gcode_options o = usual();
    o.speed[ISO_ROLE_EXTERNAL_PERIMETER] = 8;
    iso_layer_work work = {.length = {[OUTER] = 8, [BRIDGE] = 20, [INNER] = 60}};
    iso_layer_pace pace;
    iso_cooling_pace(&pace, &work, &o, 7);
    CHECK_EQUAL(480, pace.feed[OUTER]);
    CHECK_EQUAL(1200, pace.feed[BRIDGE]);
    CHECK_EQUAL(1200, pace.feed[INNER]);
    CHECK_NEAR(5, pace.time, 1e-9);
}

static void test_never_shorter_than_asked(void) {
    iso_gcode_options o = usual();
    uint64_t seed = 9;
    for (int i = 0; i < 5000; i++) {
        iso_layer_work work = {0};
        for (int s = 0; s < ISO_SPEED_SLOTS; s++) {
            seed = seed * 6364136223846793005u + 1442695040888963407u;
            work.length[s] = seed >> 60 < 4 ? (double)(seed >> 20 & 0xffff) / 2500 : 0;
        }
        iso_layer_pace pace, plain;
        o.cooling = 0;
        iso_cooling_pace(&plain, &work, &o, 7);
        o.cooling = 1;
        iso_cooling_pace(&pace, &work, &o, 7);
        int free_slots = 0;
        for (int s = 0; s < ISO_SPEED_SLOTS; s++) {
            CHECK(pace.feed[s] <= plain.feed[s]);
            CHECK(pace.feed[s] >= 600 || pace.feed[s] == plain.feed[s]);
            int bridge = s / 2 == ISO_ROLE_BRIDGE_INFILL || s / 2 == ISO_ROLE_OVERHANG_PERIMETER;
            CHECK(!bridge || pace.feed[s] == plain.feed[s]);
            free_slots += work.length[s] > 0 && pace.feed[s] > 600 && !bridge;
        }
        if (plain.time < 5 && free_slots > 0)
            CHECK(pace.time >= 5 - 1e-9 && pace.time < 5.02);
        if (plain.time >= 5)
            CHECK(pace.time == plain.time);
    }
}

static void test_fan_by_layer_time(void) {
    iso_gcode_options o = usual();
    iso_layer_work work = {.length = {[INNER] = 60 * 35}};
    iso_layer_pace pace;
    iso_cooling_pace(&pace, &work, &o, 3);
    CHECK_EQUAL(70, pace.fan); /* half way between 5 and 65 s */
    iso_cooling_pace(&pace, &work, &o, 2);
    CHECK_EQUAL(0, pace.fan);
    o.fan_always_on = 1;
    work.length[INNER] = 60 * 70;
    iso_cooling_pace(&pace, &work, &o, 3);
    CHECK_EQUAL(40, pace.fan);
    o.cooling = 0;
    work.length[INNER] = 60;
    iso_cooling_pace(&pace, &work, &o, 3);
    CHECK_EQUAL(40, pace.fan);
    CHECK_EQUAL(3600, pace.feed[INNER]);
}

static void test_empty_layer(void) {
    iso_gcode_options o = usual();
    iso_layer_work work = {0};
    iso_layer_pace pace;
    iso_cooling_pace(&pace, &work, &o, 5);
    CHECK_NEAR(0, pace.time, 0);
}

int main(void) {
    RUN(test_speeds_of_long_layers);
    RUN(test_speeds_of_the_first_layer_role_by_role);
    RUN(test_short_layers_take_the_least_time);
    RUN(test_no_slower_than_the_least_speed);
    RUN(test_the_fastest_are_slowed_first);
    RUN(test_ramps_count);
    RUN(test_flow_limits_beads_by_their_section);
    RUN(test_limited_beads_are_slowed_with_the_others);
    RUN(test_fan_ramp);
    RUN(test_bridges_and_slow_roles_stay);
    RUN(test_never_shorter_than_asked);
    RUN(test_fan_by_layer_time);
    RUN(test_empty_layer);
    return check_verdict();
}

/* What can't be made is refused, and the message says why and where. */
#include <isoslice/channel.h>

#include <stdbool.h>

#include "check.h"
#include "shapes.h"

static const shape post = {cylinder_radius, 0, 40, 1, 1, 0, 60, 2};

static bool says(const char *word) {
    return strstr(iso_error_message(), word) != NULL;
}

/* Made and checked. */
static iso_status try_it(const shape *s, const iso_channel_options *options) {
    iso_mesh mesh;
    iso_channels *channels;
    shape_mesh(&mesh, s);
    iso_status status = iso_channels_new(&channels, &mesh, options);
    CHECK((status == ISO_OK) == (channels != NULL));
    if (status == ISO_OK)
        status = iso_channels_check(channels);
    iso_channels_free(channels);
    iso_mesh_free(&mesh);
    return status;
}

static void test_sections(void) {
    static const char *const wrong[] = {"",          "round",         "round:",       "round:8x5",
                                        "rect:8",    "square:8x8",    "polygon:6",    "polygon:2:8",
                                        "oval:8",    "polygon:5.5:8", "round:0.05",   "round:2000",
                                        "square:8 ", "star:5:8",      "polygon:300:8"};
    iso_channel_section section;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        CHECK_STATUS(ISO_USAGE, iso_channel_section_parse(&section, wrong[i], 32));
        CHECK(says("section"));
    }
    CHECK_STATUS(ISO_USAGE, iso_channel_section_parse(&section, "round:8", 2));
    CHECK_OK(iso_channel_section_parse(&section, "round:8", 256));
    CHECK_NEAR(16 * 3.14159265, iso_channel_section_area(&section), 0.01);
    CHECK_NEAR(4, iso_channel_section_reach(&section), 1e-12);
    CHECK_OK(iso_channel_section_parse(&section, "rect:8x5", 32));
    CHECK_NEAR(40, iso_channel_section_area(&section), 1e-12);
    CHECK_NEAR(sqrt(16 + 6.25), iso_channel_section_reach(&section), 1e-12);
    CHECK_OK(iso_channel_section_parse(&section, "square:3.5", 32));
    CHECK_NEAR(12.25, iso_channel_section_area(&section), 1e-12);
    CHECK_OK(iso_channel_section_parse(&section, "polygon:6:8", 32));
    CHECK_NEAR(24 * sqrt(3), iso_channel_section_area(&section), 1e-12);
    CHECK_OK(iso_channel_section_parse(&section, "oval:9x5", 200));
    CHECK_NEAR(11.25 * 3.14159265, iso_channel_section_area(&section), 0.01);
}

static void test_options_out_of_range(void) {
    iso_channel_options good = iso_channel_defaults(), options;
#define REFUSED(field, value)                                                                      \
    do {                                                                                           \
        options = good;                                                                            \
        options.field = (value);                                                                   \
        CHECK_STATUS(ISO_BAD_CONFIG, try_it(&post, &options));                                     \
        CHECK(says(#field));                                                                       \
    } while (0)
    REFUSED(pitch, 0);
    REFUSED(pitch, NAN);
    REFUSED(depth, 1001);
    REFUSED(depth, 4); /* not more than the section's reach */
    REFUSED(start, 1e5);
    REFUSED(margin, INFINITY);
    REFUSED(wall, -1);
    REFUSED(bend, 1e4);
    REFUSED(levels, 1);
    REFUSED(samples, 7);
    REFUSED(mode, (iso_channel_mode)7);
    REFUSED(ports, (iso_channel_ports)3);
    REFUSED(side, (iso_channel_side)4);
    REFUSED(section, (iso_channel_section){0});
    CHECK_OK(try_it(&post, &good));
}

static void test_a_part_that_is_too_low(void) {
    iso_channel_options options = iso_channel_defaults();
    options.pitch = 90;
    CHECK_STATUS(ISO_UNSLICEABLE, try_it(&post, &options));
    CHECK(says("45 mm up"));
}

static void test_walls(void) {
    iso_channel_options options = iso_channel_defaults();
    options.ports = ISO_CHANNEL_CLOSED;
    options.wall = 6.5; /* depth 10 leaves 6 */
    CHECK_STATUS(ISO_NOT_VERIFIED, try_it(&post, &options));
    CHECK(says("to the part at ("));
    options.wall = 5.9;
    CHECK_OK(try_it(&post, &options));
    options.pitch = 13; /* 5 mm between skins */
    CHECK_STATUS(ISO_NOT_VERIFIED, try_it(&post, &options));
    CHECK(says("channels 1 and 2 leave 5.0") || says("channels 2 and 1 leave 5.0"));
    options.pitch = 20;
    options.margin = 19; /* 5 outside */
    CHECK_STATUS(ISO_NOT_VERIFIED, try_it(&post, &options));
    CHECK(says("5.0"));
    CHECK(says("outside at ("));
    options.margin = 19.95;
    CHECK_OK(try_it(&post, &options));
}

static void test_bends(void) {
    iso_channel_options options = iso_channel_defaults();
    options.ports = ISO_CHANNEL_CLOSED;
    options.bend = 29.5; /* rings have 30 */
    CHECK_OK(try_it(&post, &options));
    options.bend = 30.5;
    CHECK_STATUS(ISO_NOT_VERIFIED, try_it(&post, &options));
    CHECK(says("bends by a radius of 29.9") || says("bends by a radius of 30.0"));
}

/* A hole of 15 mm has no room for a channel 10 mm off its wall, but for one 6 mm off it. */
static double hole_radius(double z) {
    (void)z;
    return 15;
}
static void test_depth_times_curvature(void) {
    static const shape tube = {hole_radius, 0, 40, 1, 1, 0, 60, 2};
    iso_channel_options options = iso_channel_defaults();
    iso_mesh mesh;
    iso_channels *channels;
    CHECK_OK(iso_channel_section_parse(&options.section, "round:4", 32));
    options.ports = ISO_CHANNEL_CLOSED;
    options.holes = 1;
    options.bend = 3;
    options.depth = 15.5;
    ring_mesh(&mesh, 40, &tube);
    CHECK_STATUS(ISO_NOT_VERIFIED, iso_channels_new(&channels, &mesh, &options));
    CHECK(says("(") && says("15.5 mm off"));
    options.depth = 8;
    CHECK_OK(iso_channels_new(&channels, &mesh, &options));
    CHECK_OK(iso_channels_check(channels));
    CHECK_EQUAL(4, iso_channels_figures(channels)->ring_count); /* two outside, two within */
    iso_channels_free(channels);
    options.holes = 0;
    CHECK_OK(iso_channels_new(&channels, &mesh, &options));
    CHECK_EQUAL(2, iso_channels_figures(channels)->ring_count);
    iso_channels_free(channels);
    iso_mesh_free(&mesh);
}

static void test_ports_need_room(void) {
    iso_channel_options options = iso_channel_defaults();
    options.wall = 60;
    options.margin = 200;
    options.depth = 90;
    options.side = ISO_CHANNEL_LEFT;
    CHECK_STATUS(ISO_NOT_VERIFIED, try_it(&post, &options));
    options.wall = 300;
    options.margin = 600;
    CHECK_STATUS(ISO_NOT_VERIFIED, try_it(&post, &options));
    CHECK(says("no room for an inlet"));
}

int main(void) {
    RUN(test_sections);
    RUN(test_options_out_of_range);
    RUN(test_a_part_that_is_too_low);
    RUN(test_walls);
    RUN(test_bends);
    RUN(test_depth_times_curvature);
    RUN(test_ports_need_room);
    return check_verdict();
}

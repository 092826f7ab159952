/* Layers that aren't flat, on machines of three axes. */
#define SMALL_FILE "test-gcode-space.gcode"
#include "space_print.h"

/* Three turns of a helix of radius 15 mm that rises by 12 mm: E is the bead's area by the length in
 * space, F the speed of the role, and each Z is the curve's. */
static void test_helix(void) {
    enum { COUNT = 721 };
    static iso_vec3 place[COUNT], normal[COUNT];
    double slope = 12 / (6 * pi * 15);
    for (int i = 0; i < COUNT; i++) {
        double t = 6 * pi * i / (COUNT - 1);
        place[i] = vec3(50 + 15 * cos(t), 50 + 15 * sin(t), 1 + 12 * t / (6 * pi));
        normal[i] = vec3(0, 0, 1);
    }
    iso_paths layer = {0};
    add_path(&layer, &(iso_path){.role = ISO_ROLE_PERIMETER}, place, normal, COUNT, 0.2);
    iso_gcode_options o = bare();
    iso_gcode_totals totals;
    free(print_layers(&totals, &o, &layer, 1, "XYZAB"));
    double mm = 6 * pi * 15 * sqrt(1 + slope * slope);
    double area = iso_bead_of(4500, 2000).area * 1e-8, section = pi / 4 * 1.75 * 1.75;
    CHECK_NEAR(mm * area / section, read_back.drawn, 1e-4 * mm * area / section);
    CHECK_NEAR(mm, totals.bead_mm, 1e-4 * mm);
    int beads = 0;
    for (int i = 0; i < read_back.count; i++) {
        const line_move *m = &read_back.move[i];
        if (m->e <= 0)
            continue;
        beads++;
        CHECK_NEAR(60 * 60, m->f, 0);
        CHECK_NEAR(place[beads].z, m->to[2], 0.00056);
        CHECK_NEAR(place[beads].x, m->to[0], 0.00056);
    }
    CHECK_EQUAL(COUNT - 1, beads);
    iso_paths_free(&layer);
}

/* A bead whose section is larger than the flow allows slows down by its own section. */
static void test_flow_is_limited_by_the_section_in_space(void) {
    iso_vec3 place[3] = {{10, 10, 1}, {13, 10, 5}, {16, 10, 5}};
    iso_vec3 normal[3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    iso_paths layer = {0};
    add_path(&layer, &(iso_path){.role = ISO_ROLE_PERIMETER}, place, normal, 3, 0.2);
    layer.vertex[0].area = 12000000; /* 0.12 mm^2 */
    iso_gcode_options o = bare();
    o.max_volumetric_speed = 5;
    iso_gcode_totals totals;
    free(print_layers(&totals, &o, &layer, 1, "XYZAB"));
    const line_move *m = &read_back.move[read_back.count - 2];
    CHECK_NEAR(floor(5 / 0.12 * 60), m->f, 0);
    CHECK_NEAR(5 * 0.12 / (pi / 4 * 1.75 * 1.75), m->e, 1e-5); /* 5 mm in space */
    CHECK_NEAR(3600, m[1].f, 0);
    iso_paths_free(&layer);
}

/* Heights from 0.1 to 0.3 mm in 400 steps are said when they are 5 % off: about ln 3 / ln 1.05. */
static void test_heights_are_said_in_steps(void) {
    enum { COUNT = 401 };
    static iso_vec3 place[COUNT], normal[COUNT];
    for (int i = 0; i < COUNT; i++) {
        place[i] = vec3(10 + 0.25 * i, 10, 1 + 0.01 * i);
        normal[i] = vec3(0, 0, 1);
    }
    iso_paths layer = {0};
    add_path(&layer, &(iso_path){.role = ISO_ROLE_PERIMETER}, place, normal, COUNT, 0.2);
    for (int i = 0; i < COUNT; i++)
        layer.frame[i].height = 1000 + 5 * i;
    iso_gcode_options o = bare();
    iso_gcode_totals totals;
    free(print_layers(&totals, &o, &layer, 1, "XYZAB"));
    CHECK(read_back.heights >= 18 && read_back.heights <= 26);
    CHECK_EQUAL(1, read_back.widths);
    int bead = 0;
    for (int i = 0; i < read_back.count; i++) {
        const line_move *m = &read_back.move[i];
        double height = (1000 + 5 * bead) / 1e4;
        if (m->e > 0 && ++bead)
            CHECK(fabs(m->height - height) <= 0.0501 * m->height);
    }
    iso_paths_free(&layer);
}

/* Every byte of what moves: the first path is reached from nowhere, the second along its points,
 * with no lift but theirs. */
static void test_travel_follows_its_points(void) {
    iso_paths layer = two_lines(true);
    iso_gcode_options o = plain();
    iso_gcode_totals totals;
    o.retract_lift = 0.4;
    o.wipe = 1;
    char *text = print_layers(&totals, &o, &layer, 1, "XYZAB");
    if (!CHECK(strstr(text, "G1 E-2 F2400\n"
                            "G1 Z1.4 F7800\n"
                            "G1 X10 Y10\n"
                            "G1 Z1\n"
                            "G1 E2 F2400\n"
                            ";TYPE:Perimeter\n"
                            ";WIDTH:0.45\n"
                            "G1 X20 Y10 Z7 E.39474 F3600\n"
                            "G1 E-2 F2400\n"
                            "G1 Z8 F7800\n"
                            "G1 X20 Y20 Z9\n"
                            "G1 X20 Y30 Z4\n"
                            "G1 Z3\n"
                            "G1 E2 F2400\n"
                            "G1 X10 Y30 E.33849 F3600\n"
                            "G1 E-2 F2400\n")))
        fputs(text, stderr);
    CHECK_NEAR(0.4 + 1 + sqrt(101) + sqrt(125) + 1, totals.travel_mm + 0, 1e-6);
    free(text);
    iso_paths_free(&layer);
}

/* Up by 1 mm, along by 1.5 mm and down again is no more than 2 mm along the layer. */
static void test_short_ways_dont_retract(void) {
    iso_vec3 up[3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    iso_vec3 low[2] = {{10, 10, 1}, {20, 10, 7}}, high[2] = {{20, 11.5, 7}, {10, 11.5, 3}};
    iso_vec3 way[2] = {{20, 10, 8}, {20, 11.5, 8}};
    iso_paths layer = {0};
    add_path(&layer, &(iso_path){.role = ISO_ROLE_PERIMETER}, low, up, 2, 0.2);
    add_path(&layer, &(iso_path){.role = ISO_ROLE_PERIMETER}, high, up, 2, 0.2);
    add_travel(&layer, way, up, 2, 0.2);
    iso_gcode_options o = plain();
    iso_gcode_totals totals;
    free(print_layers(&totals, &o, &layer, 1, "XYZAB"));
    CHECK_EQUAL(2, totals.retractions); /* of the beginning and the end */
    o.retract_before_travel = 1.4;
    free(print_layers(&totals, &o, &layer, 1, "XYZAB"));
    CHECK_EQUAL(3, totals.retractions);
    iso_paths_free(&layer);
}

/* Nobody knows a way: over all that is printed (7 mm), and straight down. */
static void test_unknown_ways_go_over_all(void) {
    iso_paths layer = two_lines(false);
    iso_gcode_options o = bare();
    iso_gcode_totals totals;
    char *text = print_layers(&totals, &o, &layer, 1, "XYZAB");
    CHECK(strstr(text, "G1 Z8 F7800\nG1 X20 Y30\nG1 Z3\n"));
    free(text);
    iso_paths_free(&layer);
}

/* A flat layer after one that isn't is reached over all of it; then flat travels are flat. */
static void test_flat_layers_after_curved_ones(void) {
    iso_paths layer[2] = {two_lines(true), {0}};
    add_square(&layer[1], 100000, 100000, 100000, ISO_ROLE_PERIMETER, 4500);
    add_square(&layer[1], 300000, 100000, 100000, ISO_ROLE_PERIMETER, 4500);
    iso_gcode_options o = bare();
    iso_gcode_totals totals;
    char *text = print_layers(&totals, &o, layer, 2, "XYZAB");
    CHECK(strstr(text, "G1 Z8 F7800\nG1 X10 Y10\nG1 Z.4\n"));
    CHECK(strstr(text, "G1 X30 Y10 F7800\n;") || strstr(text, "G1 X30 Y10 F7800\nG1 X40"));
    free(text);
    iso_paths_free(&layer[0]);
    iso_paths_free(&layer[1]);
}

static void test_watch_sees_the_file(void) {
    iso_paths layer[3] = {two_lines(true), {0}, two_lines(false)};
    add_square(&layer[1], 100000, 100000, 100000, ISO_ROLE_PERIMETER, 4500);
    add_square(&layer[1], 300000, 100000, 100000, ISO_ROLE_PERIMETER, 4500);
    layer[0].frame[0].normal = vec3(-0.6, 0, 0.8);
    layer[0].frame[0].height = 1500;
    iso_gcode_options o = plain();
    iso_gcode_totals totals;
    o.watch = watch;
    o.watch_payload = &seen;
    o.wipe = 1;
    o.retract_lift = 0.4;
    o.z_offset = 0.125;
    seen = (watched){.fail_at = -1};
    free(print_layers(&totals, &o, layer, 3, "XYZAB"));
    check_watched(NULL, o.z_offset);
    CHECK(vec3_distance(seen.move[1].from, vec3(10, 10, 1)) < 1e-9);
    CHECK(vec3_distance(seen.move[1].to, vec3(20, 10, 7)) < 1e-9);
    CHECK_NEAR(0.45, seen.move[1].width, 1e-9);
    CHECK_NEAR(0.15, seen.move[1].height, 1e-9);
    CHECK_NEAR(-0.6, seen.move[1].from_normal.x, 1e-12);
    CHECK_NEAR(0, seen.move[1].to_normal.x, 1e-12);
    CHECK_NEAR(0, seen.move[2].width, 0);
    int all = seen.count;
    for (int i = 0; i < all; i++) {
        seen = (watched){.fail_at = i};
        CHECK_STATUS(ISO_OUTSIDE, write_layers(&totals, &o, layer, 3));
        CHECK_EQUAL(i, seen.count);
        CHECK(access(SMALL_FILE, F_OK) != 0);
    }
    for (int i = 0; i < 3; i++)
        iso_paths_free(&layer[i]);
}

/* Arcs of a flat layer are told chord by chord. */
static void test_watch_sees_arcs(void) {
    enum { COUNT = 60 };
    iso_point at[COUNT];
    for (int i = 0; i < COUNT; i++)
        at[i] = (iso_point){iso_units(50 + 9 * cos(2 * pi * i / COUNT)),
                            iso_units(50 + 9 * sin(2 * pi * i / COUNT))};
    iso_paths layer = {0};
    iso_bead bead = iso_bead_of(4500, 2000);
    CHECK_OK(iso_paths_add(&layer, &(iso_path){.role = ISO_ROLE_PERIMETER, .closed = 1}, at, COUNT,
                           bead.width, bead.area));
    iso_arena arena = {0};
    iso_arc *arc;
    iso_arc_options arcs = iso_arc_defaults();
    iso_gcode_layer_info info = {.z = 2000, .height = 2000, .paths = &layer};
    arcs.tolerance = 1000;
    CHECK_OK(iso_paths_find_arcs(&arc, &info.arc_count, &layer, &arcs, &arena));
    CHECK(info.arc_count > 0);
    info.arc = arc;
    iso_gcode_options o = bare();
    o.watch = watch;
    o.watch_payload = &seen;
    seen = (watched){.fail_at = -1};
    iso_output *output;
    iso_gcode_writer *writer;
    CHECK_OK(iso_output_open(&output, SMALL_FILE));
    CHECK_OK(iso_gcode_writer_new(&writer, output, &o));
    CHECK_OK(iso_gcode_begin(writer));
    CHECK_OK(iso_gcode_layer(writer, &info));
    iso_gcode_writer_free(writer);
    iso_output_abandon(output);
    CHECK_EQUAL(COUNT, seen.count);
    for (int i = 0; i < seen.count; i++) {
        int next = (i + 1) % COUNT;
        iso_vec3 to = {iso_mm(at[next].x), iso_mm(at[next].y), 0.2};
        CHECK(vec3_distance(seen.move[i].to, to) < 0.001);
        CHECK_NEAR(0.45, seen.move[i].width, 1e-12);
        CHECK_NEAR(0.2, seen.move[i].height, 1e-12);
    }
    iso_arena_free(&arena);
    iso_paths_free(&layer);
}

int main(void) {
    RUN(test_helix);
    RUN(test_flow_is_limited_by_the_section_in_space);
    RUN(test_heights_are_said_in_steps);
    RUN(test_travel_follows_its_points);
    RUN(test_short_ways_dont_retract);
    RUN(test_unknown_ways_go_over_all);
    RUN(test_flat_layers_after_curved_ones);
    RUN(test_watch_sees_the_file);
    RUN(test_watch_sees_arcs);
    return check_verdict();
}

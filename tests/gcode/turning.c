/* Machines that turn the part. */
#define SMALL_FILE "test-gcode-turning.gcode"
#include "space_print.h"

static pose_machine mandrel(void) {
    return (pose_machine){.kinematics = ISO_KINEMATICS_ROTARY_A,
                          .pivot = {0, 100, 30},
                          .low = {-90, -360000},
                          .high = {90, 360000},
                          .fastest = {60, 180}};
}

static pose_machine table(iso_kinematics kinematics) {
    return (pose_machine){.kinematics = kinematics,
                          .pivot = {100, 100, 0},
                          .low = {-90, -360000},
                          .high = {90, 360000},
                          .fastest = {60, 180}};
}

/* `turns` around the mandrel at a radius, x from 20 mm on. */
static void add_coil(iso_paths *paths, const pose_machine *machine, double radius, double turns,
                     double pitch, int count) {
    static iso_vec3 place[2048], normal[2048];
    for (int i = 0; i < count; i++) {
        double t = 2 * pi * turns * i / (count - 1);
        normal[i] = vec3(0, sin(t), cos(t));
        place[i] = vec3_along(machine->pivot, radius, normal[i]);
        place[i].x = 20 + pitch * t / (2 * pi);
    }
    add_path(paths, &(iso_path){.role = ISO_ROLE_PERIMETER}, place, normal, count, 0.2);
}

/* A ring in 72 chords at a radius of 12 mm and 30 mm/s: each takes 24 sin(2.5 deg) / 30 s, and F
 * is one over its minutes. Filament moves by G94. */
static void test_inverse_time(void) {
    pose_machine machine = mandrel();
    iso_paths layer = {0};
    add_coil(&layer, &machine, 12, 1, 0, 73);
    iso_gcode_options o = plain();
    iso_gcode_totals totals;
    o.machine = &machine;
    o.rotary_feed = ISO_FEED_INVERSE_TIME;
    o.flavour = ISO_FLAVOUR_REPRAPFIRMWARE;
    o.speed[ISO_ROLE_PERIMETER] = o.first_layer_speed[ISO_ROLE_PERIMETER] = 30;
    char *text = print_layers(&totals, &o, &layer, 1, "XYZQA");
    double seconds = 24 * sin(2.5 * pi / 180) / 30;
    int beads = 0;
    for (int i = 0; i < read_back.count; i++) {
        const line_move *m = &read_back.move[i];
        if (m->e <= 0)
            continue;
        CHECK(m->inverse);
        CHECK_NEAR(60 / seconds, m->f, 0.002 * 60 / seconds); /* 1 um of 2 mm, rounded down */
        CHECK_NEAR(5 * ++beads, m->to[4], 1e-3);
        CHECK_NEAR(42, m->to[2], 1e-3);
    }
    CHECK_EQUAL(72, beads);
    if (!CHECK_EQUAL(4, read_back.modes))
        fputs(text, stderr);
    CHECK(strstr(text, "\nG93\nG1 "));
    CHECK(strstr(text, "\nG94\nG1 E-2 F2400\n"));
    free(text);
    iso_paths_free(&layer);
}

/* What the tip does over the part, by the file alone: as fast as the role, unless an axis is too
 * slow; never off the path by more than the tolerance. */
static void check_tip(const pose_machine *machine, double speed, bool exact) {
    for (int i = 0; i < read_back.count; i++) {
        const line_move *m = &read_back.move[i];
        if (m->e <= 0)
            continue;
        double mm = vec3_distance(tip_of(m->from, machine), tip_of(m->to, machine));
        double seconds = seconds_of(m);
        CHECK(mm / seconds <= speed * 1.0001);
        CHECK(!exact || mm / seconds >= speed * 0.99);
        for (int k = 0; k < 2; k++)
            CHECK(fabs(m->to[3 + k] - m->from[3 + k]) / seconds <= machine->fastest[k] * 1.0001);
    }
}

/* At 3 mm a radian's 180 deg/s give but 9.4 mm/s: the mandrel is the slower one there. */
static void test_compensated_feed(void) {
    for (int slow = 0; slow < 2; slow++) {
        pose_machine machine = mandrel();
        iso_paths layer = {0};
        add_coil(&layer, &machine, slow ? 3 : 25, 3, 0.5, 3 * 72 + 1);
        iso_gcode_options o = plain();
        iso_gcode_totals totals;
        o.machine = &machine;
        free(print_layers(&totals, &o, &layer, 1, "XYZQA"));
        check_tip(&machine, 60, !slow);
        CHECK_EQUAL(0, read_back.modes);
        const line_move *m = &read_back.move[read_back.count / 2];
        if (slow)
            CHECK_NEAR(180, fabs(m->to[4] - m->from[4]) / seconds_of(m), 2);
        iso_paths_free(&layer);
    }
}

/* A zigzag over a dome of 20 mm on a tilting table, so coarse that the axes have to be led between
 * vertices, and over its top; and a way around to its other side. */
static void add_dome(iso_paths *paths, const pose_machine *machine, iso_vec3 *place) {
    static iso_vec3 normal[400];
    int count = 0;
    for (int row = -4; row <= 4; row++)
        for (int k = -10; k <= 10; k++) {
            double x = 1.2 * (row % 2 ? -k : k), y = 0.4 + row;
            normal[count] = vec3_unit(vec3(x, y, sqrt(400 - x * x - y * y)));
            place[count] = vec3_along(machine->pivot, 20, normal[count]);
            count++;
        }
    add_path(paths, &(iso_path){.role = ISO_ROLE_SOLID_INFILL}, place, normal, count, 0.2);
    place += count;
    for (int k = 0; k < 2; k++) {
        normal[k] = vec3_unit(vec3(-1, 0.1 * k, 0.5));
        place[k] = vec3_along(machine->pivot, 20, normal[k]);
    }
    add_path(paths, &(iso_path){.role = ISO_ROLE_SOLID_INFILL}, place, normal, 2, 0.2);
}

static double to_segment(iso_vec3 p, iso_vec3 a, iso_vec3 b) {
    iso_vec3 ab = vec3_minus(b, a);
    double t = vec3_dot(vec3_minus(p, a), ab) / vec3_dot(ab, ab);
    return vec3_distance(p, vec3_along(a, t < 0 ? 0 : t > 1 ? 1 : t, ab));
}

/* Each move of the axes, sampled: how far the tip is off the segment that is being drawn; and E
 * by how far it has come. */
static void check_tip_stays(const pose_machine *machine, const iso_vec3 *place, int count) {
    int segment = 0;
    double worst = 0, done = 0, area = iso_bead_of(4500, 2000).area * 1e-8;
    for (int i = 0; i < read_back.count && segment + 1 < count; i++) {
        const line_move *m = &read_back.move[i];
        if (m->e <= 0)
            continue;
        for (int k = 0; k <= 8; k++) {
            double at[5];
            for (int n = 0; n < 5; n++)
                at[n] = m->from[n] + k / 8. * (m->to[n] - m->from[n]);
            double off = to_segment(tip_of(at, machine), place[segment], place[segment + 1]);
            worst = off > worst ? off : worst;
        }
        done += m->e;
        if (vec3_distance(tip_of(m->to, machine), place[segment + 1]) > 0.002)
            continue;
        double mm = vec3_distance(place[segment], place[segment + 1]);
        CHECK_NEAR(mm * area / (pi / 4 * 1.75 * 1.75), done, 3e-5);
        done = 0;
        segment++;
    }
    CHECK_EQUAL(count - 1, segment);
    CHECK(worst < 0.03);  /* half the tolerance again: pieces aren't all of a length */
    CHECK(worst > 0.004); /* the test would see it */
}

static void test_tip_stays_on_its_path(void) {
    for (int k = ISO_KINEMATICS_TABLE_AC; k <= ISO_KINEMATICS_TABLE_BC; k++) {
        pose_machine machine = table((iso_kinematics)k);
        static iso_vec3 place[400];
        iso_paths layer = {0};
        add_dome(&layer, &machine, place);
        print_watched(&machine, &layer, k == ISO_KINEMATICS_TABLE_AC ? "XYZAC" : "XYZBC");
        check_tip_stays(&machine, place, 189);
        check_tip(&machine, 20, false);
        check_watched(&machine, 0);
        iso_paths_free(&layer);
    }
}

/* To the other side of the dome the nozzle goes around it: all of the way is outside. */
static void test_large_turns_go_around(void) {
    pose_machine machine = table(ISO_KINEMATICS_TABLE_BC);
    static iso_vec3 place[400];
    iso_paths layer = {0};
    add_dome(&layer, &machine, place);
    print_watched(&machine, &layer, "XYZBC");
    int travels = 0;
    for (int i = 1; i < seen.count; i++) { /* the first comes down */
        if (seen.move[i].width > 0)
            continue;
        travels++;
        for (int k = 0; k <= 4; k++) {
            iso_vec3 at = vec3_between(seen.move[i].from, seen.move[i].to, k / 4.);
            CHECK(vec3_distance(at, machine.pivot) > 19.999);
        }
        CHECK(vec3_dot(seen.move[i].from_normal, seen.move[i].to_normal) > cos(40 * pi / 180));
    }
    CHECK(travels > 4);
    iso_paths_free(&layer);
}

/* With points to go by, too; and what is printed may reach further out than both ends. */
static void test_large_turns_clear_what_reaches_out(void) {
    pose_machine machine = table(ISO_KINEMATICS_TABLE_BC);
    iso_paths layer = {0};
    iso_vec3 east = {1, 0, 0.2}, west = {-1, 0, 0.2}, up = {0, 0, 1}, place[2], normal[2];
    east = vec3_unit(east);
    west = vec3_unit(west);
    for (int i = 0; i < 3; i++) {
        iso_vec3 n = i == 0 ? up : i == 1 ? east : west;
        for (int k = 0; k < 2; k++) {
            normal[k] = n;
            place[k] = vec3_along(machine.pivot, i == 0 ? 35 : 20, n);
            place[k].y += k;
        }
        add_path(&layer, &(iso_path){.role = ISO_ROLE_PERIMETER}, place, normal, 2, 0.2);
        iso_vec3 above = vec3_along(place[0], 1, n);
        if (i > 0)
            add_travel(&layer, &above, normal, 1, 0.2);
    }
    print_watched(&machine, &layer, "XYZBC");
    double least = 1e9;
    for (int i = 1; i < seen.count; i++) {
        const iso_gcode_move *m = &seen.move[i];
        double turn = vec3_dot(m->from_normal, m->to_normal);
        iso_vec3 middle = vec3_between(m->from, m->to, 0.5);
        if (m->width > 0 || turn > cos(1 * pi / 180))
            continue;
        least = fmin(least, vec3_distance(middle, machine.pivot));
    }
    CHECK(least > 35 && least < 1e9);
    iso_paths_free(&layer);
}

/* Around a mandrel, points 40 degrees apart: up once, at the same height all the way, down once. */
static void test_travels_around_a_mandrel_stay_up(void) {
    pose_machine machine = mandrel();
    iso_paths layer = {0};
    iso_vec3 way[6], normal[6];
    add_coil(&layer, &machine, 12, 1, 0, 73);
    add_coil(&layer, &machine, 12, 1, 0, 73);
    for (int i = 0; i < 73; i++) { /* begins at 200 degrees */
        double t = (200 + 5 * i) * pi / 180;
        layer.frame[73 + i].normal = vec3(0, sin(t), cos(t));
        layer.vertex[73 + i].at.y = iso_units(machine.pivot.y + 12 * sin(t));
        layer.vertex[73 + i].z = iso_units(machine.pivot.z + 12 * cos(t) - 0.2);
    }
    for (int i = 0; i < 6; i++) {
        normal[i] = vec3(0, sin(i * 40 * pi / 180), cos(i * 40 * pi / 180));
        way[i] = vec3_along(machine.pivot, 13, normal[i]);
        way[i].x = 20;
    }
    add_travel(&layer, way, normal, 6, 0.2);
    iso_gcode_options o = bare();
    iso_gcode_totals totals;
    o.machine = &machine;
    o.watch = watch;
    o.watch_payload = &seen;
    seen = (watched){.fail_at = -1};
    char *text = print_layers(&totals, &o, &layer, 1, "XYZQA");
    CHECK(strstr(text, "\nG1 Z43 F720\nG1 A400 F10800\nG1 A440\nG1 A480\nG1 A520\nG1 A560\n"
                       "G1 Z42 F720\n"));
    for (int i = 1; i < seen.count; i++) {
        iso_vec3 at =
            vec3_minus(vec3_between(seen.move[i].from, seen.move[i].to, 0.5), machine.pivot);
        CHECK(seen.move[i].width > 0 || hypot(at.y, at.z) > 11.97);
    }
    free(text);
    iso_paths_free(&layer);
}

/* A tool is changed without a retraction: where the nozzle is then is said by G94. */
static void test_tools_change_on_machines_that_turn(void) {
    pose_machine machine = mandrel();
    iso_paths layer = {0};
    add_coil(&layer, &machine, 12, 1, 3, 73);
    add_coil(&layer, &machine, 14, 1, 0, 73);
    layer.path[1].tool = 1;
    iso_gcode_options o = bare();
    iso_gcode_totals totals;
    o.machine = &machine;
    o.rotary_feed = ISO_FEED_INVERSE_TIME;
    o.flavour = ISO_FLAVOUR_REPRAPFIRMWARE;
    o.tools = 2;
    char *text = print_layers(&totals, &o, &layer, 1, "XYZQA");
    if (!CHECK(strstr(text, "\nT1\nG94\nG1 Z45 F7800\nG1 X20 Y100\n")))
        fputs(text, stderr);
    CHECK(totals.time > 2 && totals.time < 20);
    free(text);
    iso_paths_free(&layer);
}

/* Without bounds of acceleration a print takes what F says, whichever way it is said. */
static void test_time_is_that_of_the_file(void) {
    double time[2];
    for (int inverse = 0; inverse < 2; inverse++) {
        pose_machine machine = table(ISO_KINEMATICS_TABLE_BC);
        static iso_vec3 place[400];
        iso_paths layer = {0};
        add_dome(&layer, &machine, place);
        iso_gcode_options o = bare();
        iso_gcode_totals totals;
        o.machine = &machine;
        o.flavour = ISO_FLAVOUR_REPRAPFIRMWARE;
        o.rotary_feed = inverse ? ISO_FEED_INVERSE_TIME : ISO_FEED_COMPENSATED;
        for (int i = 0; i < 4; i++)
            o.limits.acceleration[i] = 1e9;
        o.limits.extruding = o.limits.travel = o.limits.retracting = 1e9;
        o.limits.junction_deviation = 1e9;
        free(print_layers(&totals, &o, &layer, 1, "XYZBC"));
        /* the way from nowhere is in neither */
        double first = 0;
        for (int i = 1; i < 2; i++)
            first += seconds_of(&read_back.move[i]);
        CHECK_NEAR(read_back.seconds - first, totals.time, 0.003 * totals.time);
        time[inverse] = totals.time;
        o.limits.extruding = o.limits.travel = 1000;
        o.limits.junction_deviation = 0.013;
        free(print_layers(&totals, &o, &layer, 1, "XYZBC"));
        CHECK(totals.time > time[inverse] * 1.01);
        iso_paths_free(&layer);
    }
    CHECK_NEAR(time[0], time[1], 1e-3 * time[0]);
}

/* An offset of Z moves the machine, not the part. */
static void test_z_offset_is_the_machines(void) {
    pose_machine machine = mandrel();
    iso_paths layer = {0};
    add_coil(&layer, &machine, 12, 355. / 360, 0, 72);
    layer.path[0].closed = 1;
    iso_gcode_options o = bare();
    iso_gcode_totals totals;
    o.machine = &machine;
    o.z_offset = 0.25;
    free(print_layers(&totals, &o, &layer, 1, "XYZQA"));
    for (int i = 0; i < read_back.count; i++)
        if (read_back.move[i].e > 0)
            CHECK_NEAR(42.25, read_back.move[i].to[2], 1e-3);
    iso_paths_free(&layer);
}

/* A ring is closed: the mandrel goes on to 360 degrees, and the next ring begins there. */
static void test_closed_rings_go_on(void) {
    pose_machine machine = mandrel();
    iso_paths layer = {0};
    for (int i = 0; i < 2; i++) {
        add_coil(&layer, &machine, 12, 350. / 360, 0, 36);
        layer.path[i].closed = 1;
    }
    iso_gcode_options o = bare();
    iso_gcode_totals totals;
    o.machine = &machine;
    free(print_layers(&totals, &o, &layer, 1, "XYZQA"));
    CHECK_NEAR(720, read_back.move[read_back.count - 1].to[4], 1e-3);
    CHECK(read_back.move[read_back.count - 1].e > 0);
    CHECK_EQUAL(72, (int)(read_back.drawn * pi / 4 * 1.75 * 1.75 /
                              (iso_bead_of(4500, 2000).area * 1e-8 * 24 * sin(5 * pi / 180)) +
                          0.5));
    iso_paths_free(&layer);
}

static void test_flavours_that_cant(void) {
    pose_machine machine = mandrel();
    iso_gcode_options o = plain();
    iso_gcode_totals totals;
    o.machine = &machine;
    o.flavour = ISO_FLAVOUR_MAKERWARE;
    CHECK_STATUS(ISO_BAD_CONFIG, write_layers(&totals, &o, NULL, 0));
    CHECK(strstr(iso_error_message(), "makerware has no axis A that turns the part; see docs"));
    o.flavour = ISO_FLAVOUR_MACH3;
    CHECK_STATUS(ISO_BAD_CONFIG, write_layers(&totals, &o, NULL, 0));
    CHECK(strstr(iso_error_message(), "A is its filament"));
    machine = table(ISO_KINEMATICS_TABLE_BC);
    CHECK_OK(write_layers(&totals, &o, NULL, 0));
    o.flavour = ISO_FLAVOUR_MARLIN2;
    o.rotary_feed = ISO_FEED_INVERSE_TIME;
    CHECK_STATUS(ISO_BAD_CONFIG, write_layers(&totals, &o, NULL, 0));
    CHECK(strstr(iso_error_message(), "marlin2 has no G93"));
    machine.kinematics = ISO_KINEMATICS_CARTESIAN;
    CHECK_OK(write_layers(&totals, &o, NULL, 0));
    unlink(SMALL_FILE);
}

/* Layers without poses on such a machine are a defect of the caller. */
static void test_poses_are_needed(void) {
    pose_machine machine = mandrel();
    iso_paths layer = two_lines(true);
    iso_gcode_options o = plain();
    iso_gcode_totals totals;
    o.machine = &machine;
    CHECK_STATUS(ISO_BUG, write_file(&totals, &o, &layer, 1));
    iso_paths_free(&layer);
}

static void test_memory_runs_out(void) {
    pose_machine machine = mandrel();
    iso_paths layer = {0};
    add_coil(&layer, &machine, 12, 1, 0, 37);
    iso_gcode_options o = plain();
    iso_gcode_totals totals;
    o.machine = &machine;
    iso_status status = ISO_NO_MEMORY;
    int n = 0;
    for (; n < 100 && status != ISO_OK; n++) {
        iso_fail_allocation_after(n);
        status = write_layers(&totals, &o, &layer, 1);
        iso_fail_allocation_after(-1);
        CHECK(status == ISO_OK || status == ISO_NO_MEMORY);
    }
    CHECK(n > 3 && status == ISO_OK);
    unlink(SMALL_FILE);
    iso_paths_free(&layer);
}

int main(void) {
    RUN(test_inverse_time);
    RUN(test_compensated_feed);
    RUN(test_tip_stays_on_its_path);
    RUN(test_large_turns_go_around);
    RUN(test_large_turns_clear_what_reaches_out);
    RUN(test_travels_around_a_mandrel_stay_up);
    RUN(test_tools_change_on_machines_that_turn);
    RUN(test_time_is_that_of_the_file);
    RUN(test_z_offset_is_the_machines);
    RUN(test_closed_rings_go_on);
    RUN(test_flavours_that_cant);
    RUN(test_poses_are_needed);
    RUN(test_memory_runs_out);
    return check_verdict();
}

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "base/vector.h"
#include "check.h"
#include "pose/pose.h"

static const double pi = 3.14159265358979323846;

static pose_machine machine_of(iso_kinematics kinematics) {
    return (pose_machine){.kinematics = kinematics,
                          .pivot = {103, 97.5, 12.25},
                          .low = {-180, -360000},
                          .high = {180, 360000},
                          .fastest = {60, 180}};
}

/* ---- by matrices, with the C library's angles ---- */

typedef struct matrix {
    double m[3][3];
} matrix;

static matrix turning(int axis, double degrees) {
    double s = sin(degrees * pi / 180), c = cos(degrees * pi / 180);
    int a = (axis + 1) % 3, b = (axis + 2) % 3;
    matrix r = {0};
    r.m[axis][axis] = 1;
    r.m[a][a] = r.m[b][b] = c;
    r.m[a][b] = -s;
    r.m[b][a] = s;
    return r;
}

static matrix product(matrix a, matrix b) {
    matrix r = {0};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            for (int n = 0; n < 3; n++)
                r.m[i][k] += a.m[i][n] * b.m[n][k];
    return r;
}

static iso_vec3 times(matrix r, iso_vec3 v) {
    return vec3(r.m[0][0] * v.x + r.m[0][1] * v.y + r.m[0][2] * v.z,
                r.m[1][0] * v.x + r.m[1][1] * v.y + r.m[1][2] * v.z,
                r.m[2][0] * v.x + r.m[2][1] * v.y + r.m[2][2] * v.z);
}

static matrix rotation_of(const iso_pose *pose, const pose_machine *machine) {
    double tilt = pose->angle[0], turn = pose->angle[1];
    switch (machine->kinematics) {
    case ISO_KINEMATICS_ROTARY_A:
        return turning(0, turn);
    case ISO_KINEMATICS_ROTARY_B:
        return turning(1, turn);
    case ISO_KINEMATICS_TABLE_AC:
        return product(turning(0, tilt), turning(2, turn));
    case ISO_KINEMATICS_TABLE_BC:
        return product(turning(1, tilt), turning(2, turn));
    default:
        return turning(0, 0);
    }
}

static double any(uint64_t *random, double low, double high) {
    return low + (high - low) * random_unit(random);
}

static iso_vec3 any_normal(uint64_t *random) {
    iso_vec3 v;
    do
        v = vec3(any(random, -1, 1), any(random, -1, 1), any(random, -1, 1));
    while (vec3_length(v) > 1 || vec3_length(v) < 0.1);
    return vec3_unit(v);
}

/* mm of the machine's place by matrices; and what remains of the normal across the tool. */
static void check_pose(const iso_pose *pose, iso_vec3 at, iso_vec3 normal,
                       const pose_machine *machine, double steepest) {
    matrix r = rotation_of(pose, machine);
    iso_vec3 place = vec3_plus(machine->pivot, times(r, vec3_minus(at, machine->pivot)));
    iso_vec3 up = times(r, normal), back, from;
    CHECK(vec3_distance(place, pose->at) < 1e-9);
    pose_place(&back, &from, pose, machine);
    CHECK(vec3_distance(at, back) < 1e-9); /* 1 um is asked for */
    CHECK(vec3_distance(times(r, from), vec3(0, 0, 1)) < 1e-12);
    if (machine->kinematics == ISO_KINEMATICS_ROTARY_A)
        up.x = 0;
    if (machine->kinematics == ISO_KINEMATICS_ROTARY_B)
        up.y = 0;
    CHECK(up.z > 0 || steepest > 1);
    CHECK(sqrt(up.x * up.x + up.y * up.y) <= steepest);
    for (int i = 0; i < 2; i++)
        CHECK_NEAR(0, remainder(pose->angle[i] / POSE_ANGLE, 1), 1e-4);
}

/* Thousands of places and normals, forwards by matrices and back. */
static void test_round_trip(void) {
    uint64_t random = 6;
    for (int k = ISO_KINEMATICS_ROTARY_A; k <= ISO_KINEMATICS_TABLE_BC; k++) {
        pose_machine machine = machine_of((iso_kinematics)k);
        iso_pose last = {0};
        for (int i = 0; i < 5000; i++) {
            iso_vec3 normal = any_normal(&random);
            iso_vec3 at = vec3(any(&random, 0, 250), any(&random, 0, 210), any(&random, 0, 200));
            iso_pose pose;
            CHECK_OK(pose_at(&pose, &last, at, normal, &machine));
            bool table = k >= ISO_KINEMATICS_TABLE_AC;
            double across = table                          ? hypot(normal.x, normal.y)
                            : k == ISO_KINEMATICS_ROTARY_A ? hypot(normal.y, normal.z)
                                                           : hypot(normal.x, normal.z);
            bool pole = across < POSE_POLE * pi / 180;
            check_pose(&pose, at, normal, &machine, pole ? 2 : 3e-6);
            CHECK(fabs(pose.angle[1] - last.angle[1]) <= 180.001);
            last = pose;
        }
    }
}

static void test_cartesian_stays(void) {
    iso_pose pose, last = {{1, 2, 3}, {4, 5}};
    CHECK_OK(pose_at(&pose, &last, vec3(7, 8, 9), vec3(1, 0, 0), NULL));
    CHECK(pose.at.x == 7 && pose.at.y == 8 && pose.at.z == 9);
    CHECK(pose.angle[0] == 0 && pose.angle[1] == 0);
    CHECK(!pose_turns(NULL));
    CHECK_EQUAL(0, strcmp("", pose_letter(NULL, 1)));
}

/* A table's arm (10, 0, 20) with the normal along x: B = -90 lays it to (-20, 0, 10). A mandrel's
 * arm (5, 10, 0) with the normal along y: A = 90 takes it to (5, 0, 10). With A and C, a normal
 * along -x turns by C = -90 to +y, and A = 90 lifts that up; the arm (-10, 3, 20) turns to
 * (3, 10, 20), and on to (3, -20, 10). */
static void test_by_hand(void) {
    pose_machine machine = machine_of(ISO_KINEMATICS_TABLE_BC);
    iso_pose pose, last = {0};
    machine.pivot = vec3(100, 100, 0);
    CHECK_OK(pose_at(&pose, &last, vec3(110, 100, 20), vec3(1, 0, 0), &machine));
    CHECK_EQUAL(-900000, lround(pose.angle[0] / POSE_ANGLE));
    CHECK_EQUAL(0, lround(pose.angle[1] / POSE_ANGLE));
    CHECK(vec3_distance(vec3(80, 100, 10), pose.at) < 1e-12);
    machine = machine_of(ISO_KINEMATICS_ROTARY_A);
    machine.pivot = vec3(0, 50, 30);
    CHECK_OK(pose_at(&pose, &last, vec3(5, 60, 30), vec3(0, 1, 0), &machine));
    CHECK_EQUAL(900000, lround(pose.angle[1] / POSE_ANGLE));
    CHECK(vec3_distance(vec3(5, 50, 40), pose.at) < 1e-12);
    machine = machine_of(ISO_KINEMATICS_TABLE_AC);
    machine.pivot = vec3(0, 0, 0);
    CHECK_OK(pose_at(&pose, &last, vec3(-10, 3, 20), vec3(-1, 0, 0), &machine));
    CHECK_EQUAL(900000, lround(pose.angle[0] / POSE_ANGLE));
    CHECK_EQUAL(-900000, lround(pose.angle[1] / POSE_ANGLE));
    CHECK(vec3_distance(vec3(3, -20, 10), pose.at) < 1e-12);
    CHECK_EQUAL(0, strcmp("A", pose_letter(&machine, 0)));
    CHECK_EQUAL(0, strcmp("C", pose_letter(&machine, 1)));
}

/* Up a dome in a spiral of ten turns: no axis jumps, and C counts all turns. */
static void test_spiral_is_continuous(void) {
    for (int k = ISO_KINEMATICS_TABLE_AC; k <= ISO_KINEMATICS_TABLE_BC; k++) {
        pose_machine machine = machine_of((iso_kinematics)k);
        iso_pose pose, last = {0};
        double begun = 0;
        for (int i = 0; i <= 3600; i++) {
            double turn = i * pi / 180, slope = (80 - 70. * i / 3600) * pi / 180;
            iso_vec3 normal = vec3(sin(slope) * cos(turn), sin(slope) * sin(turn), cos(slope));
            CHECK_OK(
                pose_at(&pose, &last, vec3_along(machine.pivot, 40, normal), normal, &machine));
            if (i == 0)
                begun = pose.angle[1];
            else
                CHECK(fabs(pose.angle[1] - last.angle[1]) < 1.001 &&
                      fabs(pose.angle[0] - last.angle[0]) < 0.03);
            last = pose;
        }
        CHECK_NEAR(3600, fabs(last.angle[1] - begun), 1e-3);
    }
}

/* Straight over the top of a dome: it tilts through 0 and doesn't turn half around. A little beside
 * it turns, but not within half a degree of the top. */
static void test_over_the_pole(void) {
    for (int beside = 0; beside < 2; beside++) {
        pose_machine machine = machine_of(ISO_KINEMATICS_TABLE_BC);
        iso_pose pose, last = {0};
        double turned = 0, off = beside ? 0.3 * pi / 180 : 0;
        for (int i = -400; i <= 400; i++) {
            iso_vec3 normal = vec3_unit(vec3(sin(i * 1e-3), sin(off), cos(i * 1e-3)));
            CHECK_OK(pose_at(&pose, &last, vec3(0, 0, 0), normal, &machine));
            if (i > -400)
                turned += fabs(pose.angle[1] - last.angle[1]);
            if (fabs(i * 1e-3) < 0.006) {
                CHECK(pose.angle[1] == last.angle[1]);
                check_pose(&pose, vec3(0, 0, 0), normal, &machine, POSE_POLE * pi / 180);
            }
            last = pose;
        }
        CHECK(turned < (beside ? 181 : 1e-9));
    }
}

static void test_limits_are_named(void) {
    pose_machine machine = machine_of(ISO_KINEMATICS_TABLE_BC);
    iso_pose pose = {.at = {1, 0, 0}}, last = {0};
    machine.low[0] = -30;
    machine.high[0] = 45;
    iso_vec3 steep = vec3(sin(1), 0, cos(1)); /* 57 degrees */
    CHECK_STATUS(ISO_OUTSIDE, pose_at(&pose, &last, vec3(12, 34.5, 6), steep, &machine));
    CHECK(strstr(iso_error_message(), "x = 12.000, y = 34.500, z = 6.000 mm"));
    CHECK(strstr(iso_error_message(), "B = -57.30 degrees"));
    CHECK(strstr(iso_error_message(), "tilt_limits is from -30 to 45"));
    CHECK(pose.at.x == 1);                        /* untouched */
    iso_vec3 other = vec3(sin(0.7), 0, cos(0.7)); /* 40 degrees: only the far branch can */
    CHECK_OK(pose_at(&pose, &last, vec3(0, 0, 0), other, &machine));
    CHECK_NEAR(0.7 * 180 / pi, pose.angle[0], 1e-4);
    CHECK_NEAR(180, fabs(pose.angle[1]), 1e-4);
    machine = machine_of(ISO_KINEMATICS_ROTARY_A);
    machine.low[1] = 10;
    machine.high[1] = 100;
    CHECK_STATUS(ISO_OUTSIDE, pose_at(&pose, &last, vec3(0, 0, 0), vec3(0, -1, 0), &machine));
    CHECK(strstr(iso_error_message(), "turn_limits is from 10 to 100"));
    CHECK_OK(pose_at(&pose, &last, vec3(0, 0, 0), vec3(0, 1, 1), &machine));
    CHECK_NEAR(45, pose.angle[1], 1e-9);
}

/* ---- paths ---- */

/* An arc around a mandrel along x, radius 20 mm, from one angle to another in steps of 10. */
static void add_arc(iso_paths *paths, const pose_machine *machine, int from, int to, bool closed) {
    enum { MOST = 400 };
    static iso_point at[MOST];
    int step = to > from ? 10 : -10, count = abs(to - from) / 10 + !closed;
    for (int i = 0; i < count; i++)
        at[i] = (iso_point){iso_units(50),
                            iso_units(machine->pivot.y + 20 * sin((from + i * step) * pi / 180))};
    int32_t first = paths->vertex_count;
    CHECK_OK(iso_paths_add(paths, &(iso_path){.closed = closed}, at, count, 4000, 800));
    CHECK_OK(ISO_GROW(paths->frame, paths->frame_capacity, paths->vertex_count));
    for (int i = 0; i < count; i++) {
        double angle = (from + i * step) * pi / 180;
        paths->vertex[first + i].z = iso_units(machine->pivot.z + 20 * cos(angle));
        paths->frame[first + i] = (iso_frame){.normal = {0, sin(angle), cos(angle)}};
    }
}

static void test_paths_go_around(void) {
    pose_machine machine = machine_of(ISO_KINEMATICS_ROTARY_A);
    iso_paths paths = {0};
    static iso_pose pose[400];
    iso_pose last = {0};
    add_arc(&paths, &machine, 0, 360, true);
    add_arc(&paths, &machine, 0, 720, false);
    CHECK_OK(pose_paths(pose, NULL, &last, &paths, 0, &machine));
    for (int i = 0; i < paths.vertex_count; i++) {
        CHECK_NEAR(i < 36 ? 10 * i : 360 + 10 * (i - 36), pose[i].angle[1], 1e-3);
        CHECK_NEAR(machine.pivot.z + 20, pose[i].at.z, 1e-4);
        CHECK_NEAR(machine.pivot.y, pose[i].at.y, 1e-4);
    }
    CHECK_NEAR(1080, last.angle[1], 1e-3);
    iso_paths_clear(&paths);
    add_arc(&paths, &machine, 0, -360, true);
    CHECK_OK(pose_paths(pose, NULL, &last, &paths, 0, &machine));
    CHECK_NEAR(720, last.angle[1], 1e-3); /* where it closes */
    iso_paths_free(&paths);
}

/* 0 to 180, then 170 to 330 with limits of +-200: the second begins at -190. Round and round can't
 * be wound back in its middle. */
static void test_turns_are_wound_back_between_paths(void) {
    pose_machine machine = machine_of(ISO_KINEMATICS_ROTARY_A);
    machine.low[1] = -200;
    machine.high[1] = 200;
    iso_paths paths = {0};
    static iso_pose pose[400];
    iso_pose last = {0}, before;
    add_arc(&paths, &machine, 0, 180, false);
    add_arc(&paths, &machine, 170, 330, false);
    CHECK_OK(pose_paths(pose, NULL, &last, &paths, 0, &machine));
    CHECK_NEAR(180, pose[18].angle[1], 1e-3);
    CHECK_NEAR(-190, pose[19].angle[1], 1e-3);
    CHECK_NEAR(-30, last.angle[1], 1e-3);
    iso_paths_clear(&paths);
    add_arc(&paths, &machine, 0, 720, false);
    before = last;
    CHECK_STATUS(ISO_OUTSIDE, pose_paths(pose, NULL, &last, &paths, 0, &machine));
    CHECK(strstr(iso_error_message(), "A is turned as far as turn_limits allow, -200 to 200"));
    CHECK(memcmp(&before, &last, sizeof last) == 0);
    iso_paths_free(&paths);
}

static void test_layers_that_lean_along_a_mandrel(void) {
    for (int k = ISO_KINEMATICS_ROTARY_A; k <= ISO_KINEMATICS_TABLE_BC; k++) {
        pose_machine machine = machine_of((iso_kinematics)k);
        bool x = k == ISO_KINEMATICS_ROTARY_A, mandrel = k <= ISO_KINEMATICS_ROTARY_B;
        for (int lean = -50; lean <= 50; lean += 2) {
            double s = sin(lean * pi / 180), c = cos(lean * pi / 180);
            iso_paths paths = {0};
            iso_pose pose[37], last = {0};
            add_arc(&paths, &machine, 0, 40, false);
            for (int i = 0; i < paths.vertex_count; i++)
                paths.frame[i].normal = (iso_vec3){x ? s : 0, x ? 0 : s, c};
            iso_status status = pose_paths(pose, NULL, &last, &paths, 0, &machine);
            CHECK_EQUAL(mandrel && abs(lean) > 45 ? ISO_OUTSIDE : ISO_OK, status);
            if (lean == 50 && mandrel)
                CHECK(strstr(iso_error_message(), "leans by 50 degrees along the mandrel"));
            iso_paths_free(&paths);
        }
    }
}

/* A flat layer leaves a table level and turned as it is; nobody goes to single points. */
static void test_flat_layers(void) {
    pose_machine machine = machine_of(ISO_KINEMATICS_TABLE_BC);
    iso_paths paths = {0};
    iso_pose pose[3], last = {.angle = {20, 77}};
    iso_point at[2] = {{10000, 20000}, {30000, 40000}};
    CHECK_OK(iso_paths_add(&paths, &(iso_path){0}, at, 1, 4000, 800));
    CHECK_OK(iso_paths_add(&paths, &(iso_path){0}, at, 2, 4000, 800));
    CHECK_OK(pose_paths(pose, NULL, &last, &paths, 2000, &machine));
    CHECK(last.angle[0] == 0 && last.angle[1] == 77);
    iso_vec3 place, normal;
    pose_place(&place, &normal, &pose[2], &machine);
    CHECK(vec3_distance(vec3(3, 4, 0.2), place) < 1e-12);
    iso_paths_free(&paths);
}

int main(void) {
    RUN(test_round_trip);
    RUN(test_cartesian_stays);
    RUN(test_by_hand);
    RUN(test_spiral_is_continuous);
    RUN(test_over_the_pole);
    RUN(test_limits_are_named);
    RUN(test_paths_go_around);
    RUN(test_turns_are_wound_back_between_paths);
    RUN(test_layers_that_lean_along_a_mandrel);
    RUN(test_flat_layers);
    return check_verdict();
}

/* The planner's times against the closed formulas of trapezoids and corners; arcs against circles.
 */
#include "rig.h"

#define PI 3.14159265358979323846
#define HOT "M109 S200\nM83\n"

/* Seconds of motion of `text` on a homed printer. */
static double time_of(const fio_virtual_options *options, const char *text) {
    fio_virtual_printer *printer = rig_make(options, NULL);
    rig_run(printer, "G28\n" HOT "G92 E0\n");
    double before = rig_state(printer).time;
    rig_run(printer, text);
    rig_run(printer, "M400");
    double seconds = rig_state(printer).time - before;
    CHECK_EQUAL(0, rig_statistics(printer)->fault_count);
    fio_virtual_printer_free(printer);
    return seconds;
}

/* A way of `length` from speed `entry` to `exit`, reaching `nominal` in between. */
static double ramp(double length, double entry, double nominal, double exit, double acceleration) {
    double ramps = (2 * nominal * nominal - entry * entry - exit * exit) / (2 * acceleration);
    return (2 * nominal - entry - exit) / acceleration + (length - ramps) / nominal;
}

static void test_long_line(void) {
    CHECK_NEAR(200. / 100 + 100. / 1500, time_of(NULL, "G1 X200 F6000"), 1e-12);
    CHECK_NEAR(150. / 80 + 80. / 1500, time_of(NULL, "G1 X90 Y120 F4800"), 1e-12);
    CHECK_NEAR(200. / 100 + 100. / 800, time_of(NULL, "M204 P800\nG1 X200 E5 F6000"), 1e-9);
    CHECK_NEAR(200. / 100 + 100. / 700, time_of(NULL, "M204 T700\nG1 X200 F6000"), 1e-12);
    CHECK_NEAR(10. / 12 + 12. / 500, time_of(NULL, "G1 Z10 F6000"), 1e-12); /* z's own limits */
    CHECK_NEAR(2. / 40 + 40. / 900, time_of(NULL, "M204 R900\nG1 E-2 F2400"), 1e-12);
}

/* F counts X, Y and Z; degrees if none of them moves; by G93 it is one over the minutes. */
static void test_turning(void) {
    CHECK_NEAR(90. / 100 + 100. / 1500, time_of(NULL, "G1 A90 F6000"), 1e-12);
    CHECK_NEAR(90. / 100 + 100. / 1500, time_of(NULL, "G1 A-45 F6000\nG1 A-90"), 1e-9);
    CHECK_NEAR(50. / 100 + 100. / 1500, time_of(NULL, "G1 B30 C-40 F6000"), 1e-12);
    CHECK_NEAR(200. / 100 + 100. / 1500, time_of(NULL, "G1 X200 C720 F6000"), 1e-12);
    CHECK_NEAR(2 + 50. / 1500, time_of(NULL, "G93\nG1 X100 A30 F30\nG94"), 1e-12);
    CHECK_NEAR(2 + 45. / 1500, time_of(NULL, "G93\nG1 A90 E1 F30\nG94\nM204 R900"), 1e-9);
    CHECK_NEAR(1 + 2. / 500, time_of(NULL, "G93\nG1 Z2 F60\nG94"), 1e-12);
    fio_virtual_printer *printer = rig_make(NULL, NULL);
    rig_run(printer, "G28\n" HOT "G92 E0\nG92 A10\nG1 A100 F600\nG91\nG1 A-30 C5\nG90");
    CHECK_NEAR(70, rig_state(printer).angle[0], 0);
    CHECK_NEAR(5, rig_state(printer).angle[2], 0);
    CHECK_NEAR(120, rig_statistics(printer)->turned[0], 0);
    CHECK_EQUAL(0, rig_statistics(printer)->fault_count);
    CHECK_EQUAL(0, rig_statistics(printer)->unknown_commands);
    rig_run(printer, "M83\nG93\nG1 A80 E.1 F60\nG1 A90 E.1 F30\n");
    CHECK(rig_state(printer).inverse_time);
    CHECK_EQUAL(2, rig_statistics(printer)->extrusion_moves);
    CHECK_NEAR(0.2, rig_statistics(printer)->extruded_along_paths, 1e-12);
    CHECK_EQUAL(0, rig_statistics(printer)->fault_count + rig_statistics(printer)->warning_count);
    rig_run(printer, "G1 A95");
    CHECK_EQUAL(1, rig_statistics(printer)->count[FIO_FAULT_BAD_FEEDRATE]);
    rig_run(printer, "G94\nG1 A96\nG1 X1 B F600");
    CHECK_EQUAL(1, rig_statistics(printer)->count[FIO_FAULT_BAD_FEEDRATE]);
    CHECK_EQUAL(1, rig_statistics(printer)->count[FIO_FAULT_BAD_WORD]);
    fio_virtual_printer_free(printer);
}

static void test_short_line(void) {
    CHECK_NEAR(2 * sqrt(1. / 1500), time_of(NULL, "G1 X1 F30000"), 1e-12);
    CHECK_NEAR(0, time_of(NULL, "G1 X0 F30000\nG1 F600"), 0);
}

static void test_collinear_lines_join(void) {
    double whole = 200. / 100 + 100. / 1500;
    CHECK_NEAR(whole, time_of(NULL, "G1 X50 F6000\nG1 X200"), 1e-9);
    char text[4000] = "";
    size_t used = 0;
    for (int i = 1; i <= 100; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, "G1 X%d F6000\n", 2 * i);
    CHECK_NEAR(whole, time_of(NULL, text), 1e-9);
    /* The slower of two speeds holds at the joint. */
    CHECK_NEAR(ramp(100, 0, 100, 50, 1500) + ramp(100, 50, 50, 0, 1500),
               time_of(NULL, "G1 X100 F6000\nG1 X200 F3000"), 1e-9);
}

static void test_lookahead_bounds_the_speed(void) {
    /* 4000 pieces of 0.01 mm: it must be able to stop within the blocks it knows, 15 or 16. */
    static char text[120000];
    size_t used = 0;
    for (int i = 1; i <= 4000; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, "G1 X%.2f F30000\n", i * 0.01);
    double speed = 40 / time_of(NULL, text);
    CHECK(speed < sqrt(2 * 1500 * 0.16) && speed > 0.95 * sqrt(2 * 1500 * 0.14));
    fio_virtual_options options = fio_virtual_options_defaults();
    options.planner_blocks = 64;
    speed = 40 / time_of(&options, text);
    CHECK(speed < sqrt(2 * 1500 * 0.64) && speed > 0.95 * sqrt(2 * 1500 * 0.60));
}

static void test_right_angle_by_junction_deviation(void) {
    /* v² = a·d·sin(θ/2) / (1 − sin(θ/2)) with θ = 90° between the legs */
    double half_sine = sqrt(0.5);
    double corner = sqrt(1500 * 0.013 * half_sine / (1 - half_sine));
    double expected = ramp(100, 0, 100, corner, 1500) + ramp(100, corner, 100, 0, 1500);
    CHECK_NEAR(expected, time_of(NULL, "G1 X100 F6000\nG1 Y100"), 1e-9);
    fio_virtual_options options = fio_virtual_options_defaults();
    options.junction_deviation = 0.1;
    corner = sqrt(1500 * 0.1 * half_sine / (1 - half_sine));
    expected = ramp(100, 0, 100, corner, 1500) + ramp(100, corner, 100, 0, 1500);
    CHECK_NEAR(expected, time_of(&options, "G1 X100 F6000\nG1 Y100"), 1e-9);
    CHECK_NEAR(expected, time_of(NULL, "M205 J0.1\nG1 X100 F6000\nG1 Y100"), 1e-9);
}

static void test_other_angles(void) {
    for (int degrees = 30; degrees <= 150; degrees += 30) {
        double turn = degrees * PI / 180, half_sine = cos(turn / 2); /* θ = π − turn */
        double corner = sqrt(1500 * 0.013 * half_sine / (1 - half_sine));
        char text[120];
        double y = 50 * sin(turn), x = 100 + 50 * cos(turn);
        snprintf(text, sizeof text, "G1 X100 F3000\nG1 X%.9f Y%.9f", x, y);
        corner = fmin(corner, 50);
        CHECK_NEAR(ramp(100, 0, 50, corner, 1500) + ramp(50, corner, 50, 0, 1500),
                   time_of(NULL, text), 1e-7);
    }
    /* Turning back is a stop. */
    CHECK_NEAR(2 * (100. / 50 + 50. / 1500), time_of(NULL, "G1 X100 F3000\nG1 X0"), 1e-9);
}

static void test_classic_jerk(void) {
    fio_virtual_options options = fio_virtual_options_defaults();
    options.classic_jerk = true;
    /* A start and a stop at the jerk itself, a right angle at it too. */
    CHECK_NEAR(ramp(100, 10, 100, 10, 1500), time_of(&options, "G1 X100 F6000"), 1e-9);
    CHECK_NEAR(2 * ramp(100, 10, 100, 10, 1500), time_of(&options, "G1 X100 F6000\nG1 Y100"), 1e-9);
    /* 45 degrees: y jumps by 0.7071 v; the last leg may stop from 10 / 0.7071. */
    double corner = 10 / sqrt(0.5), leg = sqrt(2) * 50;
    CHECK_NEAR(ramp(100, 10, 100, corner, 1500) + ramp(leg, corner, 100, corner, 1500),
               time_of(&options, "G1 X100 F6000\nG1 X150 Y50"), 1e-9);
    /* An axis that turns back may still do what a stop and a start would do. */
    CHECK_NEAR(2 * ramp(100, 10, 50, 10, 1500), time_of(&options, "G1 X100 F3000\nG1 X0"), 1e-9);
    CHECK_NEAR(100. / 5, time_of(&options, "G1 X100 F300"), 1e-9); /* slower than the jerk */
}

static void test_curve_of_short_chords(void) {
    /* The centripetal acceleration bounds the speed on a circle: v² = a·r. */
    double speed = sqrt(1500 * 10.), length = 2 * PI * 10;
    CHECK_NEAR(length / speed + speed / 1500,
               time_of(NULL, "G1 X50 Y50 F30000\nM400\nG2 I10 J0 F30000") -
                   time_of(NULL, "G1 X50 Y50 F30000"),
               0.01);
}

static void test_minimum_feedrates(void) {
    CHECK_NEAR(ramp(100, 0, 20, 0, 1500), time_of(NULL, "M205 T20\nG1 X100 F60"), 1e-9);
    CHECK_NEAR(ramp(100, 0, 20, 0, 1500), time_of(NULL, "M205 S20\nG1 X100 E1 F60"), 1e-9);
}

static void test_activities(void) {
    fio_virtual_printer *printer = rig_make(NULL, NULL);
    rig_run(printer, "G28\nM109 S200\nM83\nG1 Z5 F600\nM400\nG1 X100 F6000\nM400\n"
                     "G1 X200 E4\nM400\nG1 E-2 F2400\nM400\nG4 S3");
    const fio_statistics *statistics = rig_statistics(printer);
    CHECK_NEAR(5. / 10 + 10. / 500, statistics->time[FIO_LIFTING], 1e-9);
    CHECK_NEAR(1 + 100. / 1500, statistics->time[FIO_TRAVELLING], 1e-9);
    CHECK_NEAR(1 + 100. / 1500, statistics->time[FIO_EXTRUDING], 1e-9);
    CHECK_NEAR(2. / 40 + 40. / 1500, statistics->time[FIO_RETRACTING], 1e-9);
    CHECK_NEAR(3, statistics->time[FIO_DWELLING], 1e-9);
    double sum = 0;
    for (int i = 0; i < FIO_ACTIVITIES; i++) {
        sum += statistics->time[i];
        CHECK(strlen(fio_activity_name(i)) > 5);
    }
    CHECK_NEAR(sum, statistics->total_time, 1e-9);
    CHECK_NEAR(sum, rig_state(printer).time, 1e-9);
    fio_virtual_printer_free(printer);
}

/* An extruding arc after a start at (50, 50): its length, its box, its end and its filament. */
static void expect_arc(const char *text, double length, const double box[4]) {
    fio_virtual_printer *printer = rig_make(NULL, NULL);
    rig_run(printer, "G28\n" HOT "G1 X50 Y50 Z1 F6000\n");
    rig_run(printer, text);
    const fio_statistics *statistics = rig_statistics(printer);
    bool good = CHECK_NEAR(length, statistics->extrusion_length, 4e-4 * length);
    good &= CHECK_NEAR(2, statistics->filament, 1e-9);
    good &= CHECK_EQUAL(1, statistics->arcs);
    good &= CHECK_EQUAL(0, statistics->fault_count);
    for (int i = 0; i < 2; i++) {
        good &= CHECK_NEAR(box[i], statistics->extrusion_minimum[i], 0.02);
        good &= CHECK_NEAR(box[2 + i], statistics->extrusion_maximum[i], 0.02);
    }
    if (!good)
        fprintf(stderr, "    after %s\n", text);
    fio_virtual_printer_free(printer);
}

static void test_arcs(void) {
    double quarter = PI / 2 * 10;
    expect_arc("G3 X60 Y60 I0 J10 E2", quarter, (double[]){50, 50, 60, 60});
    expect_arc("G2 X60 Y60 I10 J0 E2", quarter, (double[]){50, 50, 60, 60});
    expect_arc("G2 X60 Y60 I0 J10 E2", 3 * quarter, (double[]){40, 50, 60, 70});
    expect_arc("G3 X60 Y60 I10 E2", 3 * quarter, (double[]){50, 40, 70, 60});
    expect_arc("G3 X60 Y60 R10 E2", quarter, (double[]){50, 50, 60, 60});
    expect_arc("G3 X60 Y60 R-10 E2", 3 * quarter, (double[]){50, 40, 70, 60});
    expect_arc("G2 X60 Y60 R10 E2", quarter, (double[]){50, 50, 60, 60});
    expect_arc("G2 X60 Y60 R-10 E2", 3 * quarter, (double[]){40, 50, 60, 70});
    expect_arc("G2 X70 Y50 R10 E2", 2 * quarter, (double[]){50, 50, 70, 60});
    expect_arc("G2 I10 E2", 4 * quarter, (double[]){50, 40, 70, 60});
    expect_arc("G3 I10 P2 E2", 12 * quarter, (double[]){50, 40, 70, 60});
    expect_arc("G3 I0 J0.05 E2", 2 * PI * 0.05, (double[]){49.95, 50, 50.05, 50.1});
    expect_arc("G3 Z7.283185307179586 I10 E2", sqrt(2 * PI * 2 * PI + 400 * PI * PI),
               (double[]){50, 40, 70, 60});
    expect_arc("G91\nM83\nG3 X10 Y10 I0 J10 E2", quarter, (double[]){50, 50, 60, 60});
    expect_arc("G92 X0 Y0\nG3 X10 Y10 I0 J10 E2", quarter, (double[]){50, 50, 60, 60});
    expect_arc("G20\nM83\nG3 X2.362204724 Y2.362204724 I0 J0.3937007874 E0.07874015748", quarter,
               (double[]){50, 50, 60, 60});
}

static void test_arc_ends_exactly(void) {
    fio_virtual_printer *printer = rig_after("G28\nG1 X50 Y50 F6000\nG2 X60.123 Y59.999 I10 J0");
    fio_state state = rig_state(printer);
    CHECK(state.machine[0] == 60.123 && state.machine[1] == 59.999);
    fio_virtual_printer_free(printer);
}

int main(void) {
    RUN(test_long_line);
    RUN(test_turning);
    RUN(test_short_line);
    RUN(test_collinear_lines_join);
    RUN(test_lookahead_bounds_the_speed);
    RUN(test_right_angle_by_junction_deviation);
    RUN(test_other_angles);
    RUN(test_classic_jerk);
    RUN(test_curve_of_short_chords);
    RUN(test_minimum_feedrates);
    RUN(test_activities);
    RUN(test_arcs);
    RUN(test_arc_ends_exactly);
    return check_verdict();
}

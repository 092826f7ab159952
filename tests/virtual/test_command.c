/* Each command and each modal rule. */
#include "rig.h"

#define HOT "M104 S200\nM109 S200\n"

static void expect_position(const char *text, double x, double y, double z, double e) {
    fio_virtual_printer *printer = rig_after(text);
    fio_state state = rig_state(printer);
    double expected[4] = {x, y, z, e};
    for (int i = 0; i < 4; i++)
        if (!CHECK_NEAR(expected[i], state.position[i], 1e-9))
            fprintf(stderr, "    axis %d after: %s\n", i, text);
    fio_virtual_printer_free(printer);
}

static void test_words_are_read_in_any_shape(void) {
    expect_position("G28\nG1 X10 Y20 Z5 F3000", 10, 20, 5, 0);
    expect_position("G28\ng1x10y20z5f3000", 10, 20, 5, 0);
    expect_position("G28\n  G1\tX 10  Y 20   Z 5 ; X99", 10, 20, 5, 0);
    expect_position("G28\nG1 X10 (Y99) Y20 (Z99)Z5", 10, 20, 5, 0);
    expect_position("G28\nG1 X10 Y20 Z5 (never closed X99", 10, 20, 5, 0);
    expect_position("G28\r\nG1 X+10 Y20. Z.5\r\n\r\n", 10, 20, 0.5, 0);
    expect_position("G28\nG01 X1 X2 X3", 3, 0, 0, 0); /* the last word of a letter wins */
    expect_position("G28\nG0X7", 7, 0, 0, 0);
    expect_position("; only G1 X5\n(G1 X6)\n\n   \n", 0, 0, 0, 0);
    expect_position("G28\nG1 X5 Y", 5, 0, 0, 0); /* a word without a value is ignored */
}

static void test_absolute_and_relative(void) {
    expect_position("G28\nG91\nG1 X10 Y5\nG1 X-3 Z2", 7, 5, 2, 0);
    expect_position("G28\nG91\nG1 X10\nG90\nG1 X4", 4, 0, 0, 0);
    expect_position("G28\n" HOT "M83\nG1 X10 E1 F600\nG1 X20 E1", 20, 0, 0, 2);
    expect_position("G28\n" HOT "M82\nG1 X10 E1 F600\nG1 X20 E1.5", 20, 0, 0, 1.5);
    /* Marlin's G90 and G91 hold for E too, until M82 or M83. */
    expect_position("G28\n" HOT "G91\nG1 X10 E1 F600\nG1 X10 E1", 20, 0, 0, 2);
    expect_position("G28\n" HOT "M83\nG90\nG1 X10 E1 F600\nG1 X20 E1.5", 20, 0, 0, 1.5);
    expect_position("G28\n" HOT "G91\nM82\nG1 X10 E1 F600\nG1 X10 E1.5", 20, 0, 0, 1.5);
}

static void test_units(void) {
    expect_position("G28\nG20\nG1 X1 Y2", 25.4, 50.8, 0, 0);
    expect_position("G28\nG20\nG21\nG1 X1 Y2", 1, 2, 0, 0);
    expect_position("G28\nG20\nG92 X1", 25.4, 0, 0, 0);
    fio_virtual_printer *printer = rig_after("G20\nG1 F60");
    CHECK_NEAR(25.4, rig_state(printer).feedrate, 1e-9);
    CHECK(rig_state(printer).inches);
    fio_virtual_printer_free(printer);
}

static void test_set_position(void) {
    expect_position("G28\nG1 X50\nG92 X10\nG1 X20", 20, 0, 0, 0);
    expect_position("G28\n" HOT "G1 E5 F600\nG92 E0\nG1 E2", 0, 0, 0, 2);
    expect_position("G28\nG1 X50\nG92 X10\nG92.1", 50, 0, 0, 0);
    expect_position("G28\nG1 X50\nG92 X10\nG28 X\n", 0, 0, 0, 0);
    fio_virtual_printer *printer = rig_after("G28\nG1 X50\nG92 X10\nG1 X20");
    CHECK_NEAR(60, rig_state(printer).machine[0], 1e-12);
    fio_virtual_printer_free(printer);
}

static void test_homing(void) {
    fio_virtual_printer *printer = rig_after("G28 X");
    fio_state state = rig_state(printer);
    CHECK(state.homed[0] && !state.homed[1] && !state.homed[2]);
    CHECK_NEAR(250 / 2 / 50., state.time, 1e-12); /* half the axis at 50 mm/s */
    rig_run(printer, "G28\nG1 X100 F6000\nM400\nG28 O");
    state = rig_state(printer);
    CHECK(state.homed[0] && state.homed[1] && state.homed[2]);
    CHECK_NEAR(100, state.machine[0], 0); /* O leaves homed axes alone */
    rig_run(printer, "G29\nM84 S60");
    CHECK(rig_state(printer).homed[0]);
    rig_run(printer, "M84 X");
    state = rig_state(printer);
    CHECK(!state.homed[0] && state.homed[1]);
    rig_run(printer, "M18");
    CHECK(!rig_state(printer).homed[1]);
    CHECK_EQUAL(0, rig_statistics(printer)->fault_count);
    fio_virtual_printer_free(printer);
}

static void test_dwell(void) {
    fio_virtual_printer *printer = rig_after("G4 S2\nG4 P500\nG4 P100 S1\nG4\nG4 S-5");
    CHECK_NEAR(3.5, rig_state(printer).time, 1e-12);
    CHECK_NEAR(3.5, rig_statistics(printer)->time[FIO_DWELLING], 1e-12);
    fio_virtual_printer_free(printer);
}

static void test_percentages(void) {
    fio_virtual_printer *printer = rig_after("G28\n" HOT "M83\nM221 S50\nG1 X10 E4 F600\nM400");
    CHECK_NEAR(2, rig_statistics(printer)->filament, 1e-12);
    CHECK_NEAR(4, rig_state(printer).position[3], 1e-12); /* E itself counts what was said */
    double before = rig_state(printer).time;
    rig_run(printer, "M220 S200\nG1 X110 F600\nM400");
    /* 100 mm at 20 mm/s with 1500 mm/s² */
    CHECK_NEAR(100. / 20 + 20. / 1500, rig_state(printer).time - before, 1e-9);
    CHECK_NEAR(200, rig_state(printer).feedrate_percent, 0);
    fio_virtual_printer_free(printer);
}

static void test_settings(void) {
    fio_virtual_printer *printer = rig_after("M204 S1000\n");
    fio_state state = rig_state(printer);
    CHECK_NEAR(1000, state.acceleration[0], 0);
    CHECK_NEAR(1000, state.acceleration[2], 0);
    rig_run(printer,
            "M204 P800 R900 T700\nM201 X500 Y500 Z100 E5000\nM203 X100 Y100 Z10 E50\n"
            "M205 S0 T0 X8 Y8 Z0.4 E2 J0.02\nM207 S1 F1800\nM211 S1\nM302 S180\n"
            "M106 S127.5\nM106 P1 S3\nM73 P42 R17\nM17\nM75\nM420 S1\nM486 T3\n"
            "M486 A\"a part: \xe2\x82\xac\"\nM117 Hello, {world}\nM118 hi\nM900 K0.05\nM110 N5\n"
            "M500\nM155 S2\nG17\nT0\nM119\nM400\nM211 S0\n");
    state = rig_state(printer);
    CHECK_NEAR(800, state.acceleration[0], 0);
    CHECK_NEAR(900, state.acceleration[1], 0);
    CHECK_NEAR(700, state.acceleration[2], 0);
    CHECK_NEAR(127.5, state.fan, 0);
    CHECK_EQUAL(42, state.progress_percent);
    CHECK_EQUAL(17, state.minutes_left);
    CHECK_EQUAL(5, state.line_number);
    CHECK_EQUAL(0, rig_statistics(printer)->unknown_commands);
    CHECK_EQUAL(0, rig_statistics(printer)->fault_count);
    rig_run(printer, "M107");
    CHECK_NEAR(0, rig_state(printer).fan, 0);
    fio_virtual_printer_free(printer);
}

static void test_limits_hold(void) {
    /* M203 and M201 bound what F and M204 ask for. */
    fio_virtual_printer *printer = rig_after("G28\nM201 X500\nM203 X50\nG1 X100 F60000\nM400");
    double before = rig_statistics(printer)->time[FIO_TRAVELLING];
    CHECK_NEAR(100. / 50 + 50. / 500, before, 1e-9);
    fio_virtual_printer_free(printer);
}

static void test_filament(void) {
    static const char print[] = "G28\n" HOT "%s\nG1 X10 Y10 Z0.2 F6000\nG1 X30 E%s F1200\n"
                                "G1 E%s F2400\nG1 X10 F6000\nG1 E%s F2400\nG1 X50 E%s F1200\n";
    static const char *const words[2][5] = {{"M82", "1", "0.2", "1", "3"},
                                            {"M83", "1", "-0.8", "0.8", "2"}};
    for (int i = 0; i < 2; i++) {
        char text[400];
        snprintf(text, sizeof text, print, words[i][0], words[i][1], words[i][2], words[i][3],
                 words[i][4]);
        fio_virtual_printer *printer = rig_after(text);
        const fio_statistics *statistics = rig_statistics(printer);
        CHECK_NEAR(3, statistics->filament, 1e-12);
        CHECK_NEAR(3, statistics->extruded_along_paths, 1e-12);
        CHECK_NEAR(3 * acos(-1) / 4 * 1.75 * 1.75, statistics->volume, 1e-9);
        CHECK_NEAR(60, statistics->extrusion_length, 1e-12);
        CHECK_NEAR(20 + sqrt(200.04), statistics->travel_length, 1e-12);
        CHECK_EQUAL(1, statistics->retractions);
        CHECK_EQUAL(1, statistics->unretractions);
        CHECK_NEAR(0.8, statistics->retracted_length, 1e-12);
        CHECK_NEAR(0.8, statistics->unretracted_length, 1e-12);
        CHECK_EQUAL(6, statistics->moves);
        CHECK_EQUAL(2, statistics->extrusion_moves);
        CHECK_EQUAL(1, statistics->layers);
        CHECK_NEAR(10, statistics->extrusion_minimum[0], 0);
        CHECK_NEAR(50, statistics->extrusion_maximum[0], 0);
        CHECK_NEAR(0.2, statistics->extrusion_maximum[2], 0);
        CHECK_EQUAL(0, statistics->warning_count + statistics->fault_count);
        fio_virtual_printer_free(printer);
    }
}

static void test_firmware_retraction(void) {
    fio_virtual_printer *printer =
        rig_after("G28\n" HOT "M83\nG1 X10 E1 F1200\nG10\nG10\nG1 X20\nG11\nG11\nG1 X30 E1\n");
    const fio_statistics *statistics = rig_statistics(printer);
    CHECK_EQUAL(1, statistics->retractions);
    CHECK_EQUAL(1, statistics->unretractions);
    CHECK_NEAR(2, statistics->retracted_length, 1e-12);
    CHECK_NEAR(2, statistics->filament, 1e-12);
    CHECK_EQUAL(0, statistics->warning_count);
    fio_virtual_printer_free(printer);
}

static void test_layers(void) {
    fio_virtual_printer *printer =
        rig_after("G28\n" HOT "M83\nG1 Z0.2 F600\nG1 X10 E1\nG1 Z0.6\nG1 X20\nG1 Z0.2\nG1 X30 E1\n"
                  "G1 Z0.4\nG1 X10 E1\nG1 X20 Z0.5 E1\nG1 X30 Z0.6 E1");
    CHECK_EQUAL(2, rig_statistics(printer)->layers); /* neither the hop nor the spiral */
    fio_virtual_printer_free(printer);
}

static void test_tools(void) {
    fio_virtual_options options = fio_virtual_options_defaults();
    options.tools = 2;
    fio_virtual_printer *printer = rig_make(&options, NULL);
    rig_run(printer, "T1\nM109 S200\nM104 T0 S100");
    fio_state state = rig_state(printer);
    CHECK_EQUAL(1, state.tool);
    CHECK_NEAR(200, state.nozzle[1], 1e-9);
    CHECK_NEAR(100, state.nozzle_target[0], 0);
    rig_run(printer, "T2");
    CHECK_EQUAL(1, rig_statistics(printer)->count[FIO_FAULT_BAD_TOOL]);
    CHECK_EQUAL(1, rig_state(printer).tool);
    fio_virtual_printer_free(printer);
}

/* What is drawn back stays so while another tool prints. */
static void test_tools_keep_their_filament(void) {
    static const char *const back[] = {"G1 E-2 F2400\n", "G10\n"}, *const forth[] = {"G1 E2\n",
                                                                                     "G11\n"};
    for (int k = 0; k < 2; k++) {
        fio_virtual_options options = fio_virtual_options_defaults();
        char text[512];
        options.tools = 2;
        fio_virtual_printer *printer = rig_make(&options, NULL);
        snprintf(text, sizeof text,
                 "M302 P1\nG28\nM83\nG1 Z1 F600\nG1 X10 Y10 E1 F1200\n%sT1\nG1 X20 E1\n%sT0\n%s"
                 "G1 X30 E1\nT1\n",
                 back[k], back[k], forth[k]);
        rig_run(printer, text);
        CHECK_EQUAL(0, rig_statistics(printer)->count[FIO_WARNING_RETRACTED]);
        CHECK_EQUAL(0, rig_statistics(printer)->count[FIO_WARNING_OVERPRIMED]);
        CHECK(rig_statistics(printer)->retracted > 0.5);
        rig_run(printer, "G1 X40 E1");
        CHECK_EQUAL(1, rig_statistics(printer)->count[FIO_WARNING_RETRACTED]);
        fio_virtual_printer_free(printer);
    }
}

static void test_options_are_checked(void) {
    fio_virtual_printer *printer;
    for (int i = 0; i < 8; i++) {
        fio_virtual_options options = fio_virtual_options_defaults();
        double *values[6] = {&options.size[1],           &options.filament_diameter,
                             &options.jerk[3],           &options.maximum_feedrate[0],
                             &options.nozzle.full_power, &options.origin[2]};
        if (i < 6)
            *values[i] = i == 5 ? NAN : 0;
        options.tools = i == 6 ? 9 : 1;
        options.planner_blocks = i == 7 ? 1 : 16;
        printer = (fio_virtual_printer *)&options;
        CHECK_EQUAL(FIO_USAGE, fio_virtual_printer_create(&printer, &options, NULL));
        CHECK(!printer && strlen(fio_error_message()) > 10);
    }
}

int main(void) {
    RUN(test_words_are_read_in_any_shape);
    RUN(test_absolute_and_relative);
    RUN(test_units);
    RUN(test_set_position);
    RUN(test_homing);
    RUN(test_dwell);
    RUN(test_percentages);
    RUN(test_settings);
    RUN(test_limits_hold);
    RUN(test_filament);
    RUN(test_firmware_retraction);
    RUN(test_layers);
    RUN(test_tools);
    RUN(test_tools_keep_their_filament);
    RUN(test_options_are_checked);
    return check_verdict();
}

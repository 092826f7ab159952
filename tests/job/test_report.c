/* The numbers of the report, by other means: the model's own volume, the virtual printer's clock.
 */
#include "checks.h"
#include "solids.h"

/* Sections in the middles of thin slabs, which the print's own layers don't share. */
static double volume_below(const shape *s, double top) {
    enum { SLABS = 4000 };
    double bottom = shape_bounds(s).min[2], sum = 0;
    for (int i = 0; i < SLABS; i++)
        sum += shape_area_at(s, bottom + top * (i + 0.5) / SLABS) * top / SLABS;
    return sum;
}

/* Of what is printed, no more than 0.3 % is lost or won between mesh and slices; flat faces lie
 * between layers here, as else a whole layer would round them. */
static void test_volumes(void) {
    for (int m = 0; m < SOLID_COUNT; m++) {
        shape s = {0};
        print p;
        all_solids[m].make(&s);
        print_shape(&p, &s,
                    "layer_height = 0.1\nfirst_layer_height = 0.1\nfill_density = 0\n"
                    "perimeters = 1\ntop_solid_layers = 0\nbottom_solid_layers = 0");
        print_check(&p, &s);
        double own = volume_below(&s, p.report.printed_height);
        CHECK_NEAR(own, p.report.mesh_volume, 1e-3 * own);
        CHECK_NEAR(p.report.mesh_volume, p.report.sliced_volume, 0.003 * p.report.mesh_volume);
        CHECK_NEAR(shape_volume(&s), p.report.input[0].volume, 1e-6 * shape_volume(&s));
        CHECK_EQUAL(s.count, p.report.input[0].triangle_count);
        CHECK_EQUAL(0, p.report.warning_count);
        print_free(&p);
        shape_free(&s);
    }
}

/* A printer with the accelerations that the options name takes as long as was estimated. */
static void test_time(void) {
    static const char *const settings[] = {
        "", "retract_lift = 0.5\nperimeter_speed = 120\ncooling = 0",
        "machine_max_acceleration_extruding = 400\nmachine_max_acceleration_travel = 3000\n"
        "machine_max_junction_deviation = 0.05\nfill_density = 60%\ncooling = 0",
        "gcode_flavor = marlin\nmachine_limits_usage = emit_to_gcode\nretract_lift = 0.3\n"
        "default_acceleration = 800\nperimeter_acceleration = 500\ntravel_speed = 250",
        "default_acceleration = 900\nexternal_perimeter_acceleration = 300\n"
        "first_layer_acceleration = 200\ntravel_acceleration = 600\ninfill_speed = 150\n"
        "max_volumetric_speed = 6\nmachine_max_acceleration_x = 700\nmachine_max_feedrate_y = 70"};
    for (int m = 0; m < SOLID_COUNT; m++) {
        shape s = {0};
        print p;
        all_solids[m].make(&s);
        print_shape(&p, &s, settings[m % 5]);
        print_check(&p, &s);
        const double *time = p.machine.time;
        double taken =
            time[FIO_EXTRUDING] + time[FIO_TRAVELLING] + time[FIO_RETRACTING] + time[FIO_LIFTING];
        if (!CHECK_NEAR(taken, p.report.print.time, 0.02 * taken + 2))
            fprintf(stderr, "    that was %s\n", all_solids[m].name);
        print_free(&p);
        shape_free(&s);
    }
}

/* Each stage once, in its place, with its memory: the mesh's own for what was read, nothing for
 * what is written. */
static void test_stages(void) {
    static const char *const name[] = {"read",   "slice", "regions", "walls",
                                       "shells", "fill",  "order",   "write"};
    shape s = {0};
    print p;
    solid_torus(&s);
    print_shape(&p, &s, "fill_density = 15%");
    CHECK_EQUAL(8, p.report.stage_count);
    double sum = 0;
    for (int i = 0; i < p.report.stage_count && i < 8; i++) {
        const iso_report_stage *stage = &p.report.stage[i];
        CHECK(strcmp(name[i], stage->name) == 0);
        CHECK(stage->seconds >= 0);
        CHECK(i == 7 ? stage->bytes == 0 : stage->bytes > 0);
        sum += stage->seconds;
    }
    CHECK(sum > 0);
    CHECK_EQUAL(p.report.input[0].mesh_bytes, p.report.stage[0].bytes);
    print_free(&p);
    shape_free(&s);
}

/* A spike that no bead fits into is not printed, and that is said. */
static void test_empty_layers(void) {
    shape s = {0};
    print p;
    shape_box(&s, 0, 0, 0, 10, 10, 2);
    shape_box(&s, 4, 4, 2, 4.1, 4.1, 3);
    print_shape(&p, &s, "layer_height = 0.2\nfirst_layer_height = 0.2");
    if (CHECK_EQUAL(1, p.report.warning_count)) {
        CHECK(strcmp("empty-layers", p.report.warning[0].code) == 0);
        CHECK(strstr(p.report.warning[0].message, "5 of 15 layers") != NULL);
        CHECK(strstr(p.report.warning[0].message, "z = 2.200 mm") != NULL);
    }
    print_free(&p);
    shape_free(&s);
}

/* The first line tells the time that the caller gives, and nothing else does. */
static void test_timestamp(void) {
    const char *path = print_path("model.stl"), *output = print_path("out.gcode");
    shape s = {0};
    char line[128] = "";
    iso_options options;
    iso_report report = {0};
    iso_job_hooks hooks = {.timestamp = 951782400}; /* 2000-02-29 */
    solid_small(&s);
    CHECK(shape_write_binary(&s, path));
    iso_options_defaults(&options);
    CHECK_OK(iso_job_run(&report, &options, &path, 1, output, &hooks));
    FILE *file = fopen(output, "r");
    CHECK(file && fgets(line, sizeof line, file));
    CHECK(strstr(line, "; generated by isoslice ") == line);
    CHECK(strstr(line, " on 2000-02-29 at 00:00:00\n") != NULL);
    if (file)
        fclose(file);
    CHECK(report.threads >= 1);
    iso_report_free(&report);
    shape_free(&s);
}

/* The settings at the end of a G-code, read as a configuration, make the same G-code. */
static void test_settings_come_back(void) {
    const char *output = print_path("again.gcode"), *path = print_path("model.stl");
    shape s = {0};
    print p;
    iso_options options;
    iso_config_notes notes = {0};
    iso_report report = {0};
    solid_cavity(&s);
    print_shape(&p, &s,
                "layer_heights = 0.3,0.2,0.125\nfill_density = 33.3%\nperimeters = 2\n"
                "infill_overlap = 0.07\ncenter = 90.5,110\nextrusion_multiplier = 0.97\n"
                "start_gcode = G28\\n; [layer_height]\nfill_angle = 17.25");
    CHECK(p.text && shape_write(print_path("first.gcode"), p.text, (int64_t)p.size));
    iso_options_defaults(&options);
    CHECK_OK(iso_options_read(&options, print_path("first.gcode"), &notes));
    CHECK(notes.unknown_count == 0 && notes.unused_count == 0);
    CHECK_OK(iso_job_run(&report, &options, &path, 1, output, NULL));
    char *text = malloc(p.size + 2);
    FILE *file = fopen(output, "rb");
    if (CHECK(file != NULL)) {
        CHECK_EQUAL(p.size, fread(text, 1, p.size + 2, file));
        CHECK(memcmp(text, p.text, p.size) == 0);
        fclose(file);
    }
    free(text);
    iso_report_free(&report);
    print_free(&p);
    shape_free(&s);
}

int main(void) {
    RUN(test_volumes);
    RUN(test_time);
    RUN(test_stages);
    RUN(test_empty_layers);
    RUN(test_timestamp);
    RUN(test_settings_come_back);
    CHECK(print_folder_remove());
    return check_verdict();
}

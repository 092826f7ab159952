/* Jobs that have to fail, and jobs that mend: the status, the message, and that nothing is left. */
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"
#include "checks.h"
#include "solids.h"

static const char previous[] = "what was there before\n";

static void expect_failure(iso_status status, const char *word, const char *path,
                           const char *settings) {
    const char *output = print_path("kept.gcode");
    char text[64] = "";
    iso_options options;
    iso_report report = {0};
    iso_job_hooks hooks = {.threads = 2};
    CHECK(print_options(&options, settings));
    CHECK(shape_write(output, previous, sizeof previous - 1));
    CHECK_STATUS(status, iso_job_run(&report, &options, &path, 1, output, &hooks));
    if (!CHECK(strstr(iso_error_message(), word) != NULL))
        fprintf(stderr, "    %s\n", iso_error_message());
    FILE *file = fopen(output, "rb");
    if (CHECK(file != NULL)) {
        CHECK_EQUAL(sizeof previous - 1, fread(text, 1, sizeof text, file));
        CHECK(strcmp(text, previous) == 0);
        fclose(file);
    }
    remove(output);
    iso_report_free(&report);
    report = (iso_report){0};
    CHECK_STATUS(status, iso_job_run(&report, &options, &path, 1, output, &hooks));
    CHECK(access(output, F_OK) != 0);
    iso_report_free(&report);
}

static void expect_shape_failure(iso_status status, const char *word, const shape *s,
                                 const char *settings) {
    const char *path = print_path("model.stl");
    CHECK(shape_write_binary(s, path));
    expect_failure(status, word, path, settings);
}

static void test_too_large(void) {
    shape s = {0};
    shape_box(&s, 0, 0, 0, 200.1, 20, 2);
    expect_shape_failure(ISO_OUTSIDE, "bed", &s, "");
    shape_free(&s);
    shape_box(&s, 0, 0, 0, 20, 20, 2);
    expect_shape_failure(ISO_OUTSIDE, "bed", &s, "center = 195,100");
    expect_shape_failure(ISO_OUTSIDE, "bed", &s, "bed_shape = 0x0,15x0,15x15,0x15");
    expect_shape_failure(ISO_OUTSIDE, "skirt", &s, "skirts = 1\nskirt_distance = 95");
    expect_shape_failure(ISO_OUTSIDE, "skirt", &s,
                         "skirts = 2\nskirt_distance = 6\ncenter = 15,80");
    expect_shape_failure(ISO_OUTSIDE, "max_print_height", &s, "max_print_height = 1.9");
    expect_shape_failure(ISO_OUTSIDE, "low", &s, "layer_heights = 5\nnozzle_diameter = 5");
    shape_free(&s);
}

static void test_below_the_bed(void) {
    shape s = {0};
    shape_box(&s, 0, 0, -5, 20, 20, 0);
    expect_shape_failure(ISO_OUTSIDE, "below the bed", &s, "ensure_on_bed = 0");
    shape_free(&s);
    shape_box(&s, 0, 0, -9, 20, 20, -2);
    expect_shape_failure(ISO_OUTSIDE, "below the bed", &s, "ensure_on_bed = 0");
    shape_free(&s);
}

/* What makes the part larger than its model has to fit as well. */
static void test_grown_beyond_the_bed(void) {
    static const char *const grown[] = {"fuzzy_skin = external", "fuzzy_skin = all",
                                        "xy_size_compensation = 0.3"};
    shape s = {0};
    shape_box(&s, 0.2, 50, 0, 20, 70, 2);
    for (int i = 0; i < 3; i++) {
        char settings[128];
        print p;
        snprintf(settings, sizeof settings, "skirts = 0\ndont_arrange = 1\n%s", grown[i]);
        expect_shape_failure(ISO_OUTSIDE, "bed", &s, settings);
        snprintf(settings, sizeof settings, "skirts = 0\ncenter = 20,60\n%s", grown[i]);
        print_shape(&p, &s, settings);
        CHECK(p.level_count > 0);
        print_free(&p);
    }
    shape_free(&s);
}

/* A grid of two pieces: options at odds, whatever the command line looks like. */
static void test_grid_of_pieces(void) {
    shape s = {0};
    shape_box(&s, 0, 0, 0, 20, 20, 4);
    expect_shape_failure(ISO_BAD_CONFIG, "duplicate_grid", &s, "duplicate_grid = 2,1\ncut = 2");
    shape_free(&s);
}

/* A bed need not be a box: the corners of a cube reach beyond a triangle that its box is in. */
static void test_odd_beds(void) {
    shape s = {0};
    print p;
    shape_box(&s, 0, 0, 0, 100, 100, 1);
    expect_shape_failure(ISO_OUTSIDE, "bed", &s, "bed_shape = 0x0,200x0,100x150");
    print_shape(&p, &s, "skirts = 0\nbed_shape = 0x0,300x0,150x300\ncenter = 150,60");
    print_check(&p, &s);
    print_free(&p);
    shape_free(&s);
    shape_box(&s, 0, 0, 0, 200, 200, 0.5);
    print_shape(&p, &s,
                "skirts = 0\nfill_density = 2%\ntop_solid_layers = 0\n"
                "bottom_solid_layers = 0");
    print_check(&p, &s);
    print_free(&p);
    shape_free(&s);
}

static void test_unreadable(void) {
    const char *path = print_path("broken.stl");
    shape s = {0};
    solid_small(&s);
    s.triangle[4] = NAN;
    expect_shape_failure(ISO_UNREADABLE, "", &s, "");
    s.triangle[4] = INFINITY;
    expect_shape_failure(ISO_UNREADABLE, "", &s, "");
    s.triangle[4] = 2e7f;
    expect_shape_failure(ISO_UNREADABLE, "", &s, "");
    CHECK(shape_write(path, "", 0));
    expect_failure(ISO_UNREADABLE, "", path, "");
    unsigned char *bytes = shape_binary(&s, "cut");
    CHECK(shape_write(path, bytes, 84 + 50 * s.count - 20));
    expect_failure(ISO_UNREADABLE, "", path, "");
    free(bytes);
    remove(path);
    expect_failure(ISO_UNREADABLE, "", path, "");
    shape_free(&s);
}

static void make_moebius(shape *s, int n) {
    for (int i = 0; i < n; i++) {
        shape_point p[2][2];
        for (int k = 0; k < 2; k++) {
            double u = 2 * SHAPE_PI * ((i + k) % n) / n, turn = i + k == n ? 0 : u / 2;
            int other = i + k == n; /* half a turn: the edges change places */
            for (int e = 0; e < 2; e++) {
                double w = ((e ^ other) ? 3 : -3);
                p[k][e] = (shape_point){(10 + w * cos(turn)) * cos(u),
                                        (10 + w * cos(turn)) * sin(u), 5 + w * sin(turn)};
            }
        }
        shape_quad(s, p[0][0], p[1][0], p[1][1], p[0][1]);
    }
}

static void test_unsliceable(void) {
    shape s = {0}, half = {0};
    shape_quad(&s, (shape_point){0, 0, 0}, (shape_point){10, 0, 0}, (shape_point){10, 0, 10},
               (shape_point){0, 0, 10});
    expect_shape_failure(ISO_UNSLICEABLE, "open", &s, "");
    shape_free(&s);
    make_moebius(&s, 24);
    expect_shape_failure(ISO_UNSLICEABLE, "", &s, "");
    shape_free(&s);
    shape_sphere(&s, (shape_point){0, 0, 0}, 10, 24, 48);
    for (int64_t t = 0; t < s.count; t++) {
        const float *f = s.triangle + 9 * t;
        if (f[2] > -1e-4f && f[5] > -1e-4f && f[8] > -1e-4f)
            shape_add(&half, (shape_point){f[0], f[1], f[2]}, (shape_point){f[3], f[4], f[5]},
                      (shape_point){f[6], f[7], f[8]});
    }
    CHECK_EQUAL(s.count / 2, half.count);
    expect_shape_failure(ISO_UNSLICEABLE, "open", &half, "");
    shape_free(&s);
    shape_free(&half);
}

static const char *warning_text(const iso_report *report, const char *code) {
    for (int32_t i = 0; i < report->warning_count; i++)
        if (strcmp(report->warning[i].code, code) == 0)
            return report->warning[i].message;
    return NULL;
}

/* Whichever triangle is missing, the cube prints as the whole one does. */
static void test_cube_without_a_triangle(void) {
    shape whole = {0};
    print good;
    solid_cube(&whole);
    print_shape(&good, &whole, "");
    CHECK_EQUAL(0, good.report.warning_count);
    for (int64_t t = 0; t < whole.count; t++) {
        shape s = {0};
        print p;
        solid_cube(&s);
        shape_remove(&s, t);
        print_shape(&p, &s, "");
        print_check(&p, &whole);
        const char *text = warning_text(&p.report, "mesh-mended");
        CHECK(text && strstr(text, "1 hole"));
        CHECK_EQUAL(1, p.report.input[0].defects.holes_closed);
        CHECK_NEAR(200, p.report.input[0].defects.cap_area, 1e-9);
        CHECK_EQUAL(66, p.level_count);
        CHECK_NEAR(8000, p.report.input[0].volume, 1e-9);
        CHECK_NEAR(print_volume(&good), print_volume(&p), 1e-3 * print_volume(&good));
        print_free(&p);
        shape_free(&s);
    }
    print_free(&good);
    shape_free(&whole);
}

static void test_unwritable(void) {
    const char *folder = print_path("nowhere"), *path = print_path("model.stl");
    const char *output[] = {"/nowhere/at/all/out.gcode", "/proc/out.gcode", folder, "/dev/full"};
    shape s = {0};
    iso_options options;
    solid_small(&s);
    CHECK(shape_write_binary(&s, path));
    iso_options_defaults(&options);
    CHECK(mkdir(folder, 0700) == 0);
    for (int i = 0; i < 4; i++) {
        iso_report report = {0};
        CHECK_STATUS(ISO_NOT_WRITTEN, iso_job_run(&report, &options, &path, 1, output[i], NULL));
        CHECK(strstr(iso_error_message(), output[i]) != NULL);
        iso_report_free(&report);
    }
    CHECK(rmdir(folder) == 0);
    shape_free(&s);
}

/* One bad file of several fails the job; the report says how far it came. */
static void test_second_file_is_bad(void) {
    const char *path[] = {print_path("model.stl"), print_path("missing.stl")};
    shape s = {0};
    iso_options options;
    iso_report report = {0};
    solid_small(&s);
    CHECK(shape_write_binary(&s, path[0]));
    iso_options_defaults(&options);
    const char *output = print_path("swept.gcode");
    CHECK_STATUS(ISO_UNREADABLE, iso_job_run(&report, &options, path, 2, output, NULL));
    CHECK(strstr(iso_error_message(), path[1]) != NULL);
    CHECK(access(output, F_OK) != 0);
    CHECK_EQUAL(1, report.input_count);
    CHECK_EQUAL(0, report.layer_count);
    CHECK_EQUAL(0, report.print.bytes);
    iso_report_free(&report);
    shape_free(&s);
}

static void test_bad_options(void) {
    shape s = {0};
    solid_small(&s);
    expect_shape_failure(ISO_BAD_CONFIG, "nozzle_diameter", &s, "layer_height = 0.45");
    expect_shape_failure(ISO_BAD_CONFIG, "wide", &s, "layer_height = 0.3\nextrusion_width = 0.25");
    expect_shape_failure(ISO_BAD_CONFIG, "min_fan_speed", &s,
                         "min_fan_speed = 60\nmax_fan_speed = 50");
    expect_shape_failure(ISO_BAD_CONFIG, "bed_shape", &s, "bed_shape = 0x0,10x10,20x20");
    expect_shape_failure(ISO_BAD_CONFIG, "no_such_key", &s, "start_gcode = G28 [no_such_key]");
    shape_free(&s);
    iso_report report = {0};
    iso_options options;
    iso_options_defaults(&options);
    CHECK_STATUS(ISO_USAGE, iso_job_run(&report, &options, NULL, 0, print_path("out.gcode"), NULL));
    iso_report_free(&report);
}

/* ---- progress ---- */

typedef struct course {
    double last;
    int calls, backward, named;
} course;

static void follow(void *payload, double done, const char *stage) {
    course *c = payload;
    c->backward += done < c->last || done > 1;
    c->named += stage && *stage;
    c->last = done;
    c->calls++;
}

static void test_progress(void) {
    const char *path[] = {print_path("a.stl"), print_path("b.stl"), print_path("c.stl")};
    for (int i = 0; i < 3; i++) {
        shape s = {0};
        shape_box(&s, 12 * i, 0, 0, 12 * i + 8, 8, 12);
        CHECK(shape_write_binary(&s, path[i]));
        shape_free(&s);
    }
    for (int threads = 1; threads <= 2; threads++) {
        course c = {0};
        iso_report report = {0};
        iso_options options;
        iso_job_hooks hooks = {.threads = threads, .progress = follow, .payload = &c};
        iso_options_defaults(&options);
        CHECK_OK(iso_job_run(&report, &options, path, 3, print_path("out.gcode"), &hooks));
        CHECK(c.calls > 5 && c.named == c.calls && c.backward == 0 && c.last == 1);
        CHECK_EQUAL(8, report.stage_count);
        CHECK(report.seconds > 0 && report.peak_memory_kib > 0);
        iso_report_free(&report);
    }
}

/* ---- memory ---- */

/* Number n and all after it fail, for every n: always the same status, never a file. */
static void sweep(const char *settings, const shape *s) {
    const char *path = print_path("model.stl"), *output = print_path("swept.gcode");
    iso_options options;
    iso_job_hooks hooks = {.threads = 1};
    CHECK(shape_write_binary(s, path));
    CHECK(print_options(&options, settings));
    iso_fail_allocation_after(INT64_MAX);
    iso_report whole = {0};
    CHECK_OK(iso_job_run(&whole, &options, &path, 1, output, &hooks));
    int64_t count = iso_fail_allocation_after(-1);
    iso_report_free(&whole);
    remove(output);
    CHECK(count > 50);
    for (int64_t n = 0; n < count; n++) {
        iso_report report = {0};
        iso_fail_allocation_after(n);
        iso_status status = iso_job_run(&report, &options, &path, 1, output, &hooks);
        iso_fail_allocation_after(-1);
        if (status != ISO_NO_MEMORY || access(output, F_OK) == 0) {
            CHECK_EQUAL(ISO_NO_MEMORY, status);
            CHECK(access(output, F_OK) != 0);
            fprintf(stderr, "    that was allocation %lld of %lld: %s\n", (long long)n,
                    (long long)count, iso_error_message());
            remove(output);
        }
        iso_report_free(&report);
    }
    printf("     %lld allocations\n", (long long)count);
}

static void test_no_memory(void) {
    shape s = {0};
    shape_box(&s, 0, 0, 0, 6, 6, 1.4);
    sweep("", &s);
    shape_free(&s);
    shape_box(&s, 0, 0, 0, 8, 8, 1);
    shape_box(&s, 2, 2, 1, 6, 6, 2);
    sweep("fill_pattern = grid\nlayer_heights = 0.3,0.25\ngcode_resolution = 0", &s);
    shape_free(&s);
}

int main(void) {
    RUN(test_too_large);
    RUN(test_below_the_bed);
    RUN(test_grown_beyond_the_bed);
    RUN(test_grid_of_pieces);
    RUN(test_odd_beds);
    RUN(test_unreadable);
    RUN(test_second_file_is_bad);
    RUN(test_unsliceable);
    RUN(test_cube_without_a_triangle);
    RUN(test_unwritable);
    RUN(test_bad_options);
    RUN(test_progress);
    RUN(test_no_memory);
    CHECK(print_folder_remove());
    return check_verdict();
}

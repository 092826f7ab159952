/* Macros in the texts of a whole job. */
#include <isoslice/job.h>

#include <stdlib.h>
#include <unistd.h>

#include "base/memory.h"
#include "config/foreign.h"
#include "config/texts.h"
#include "check.h"

static iso_options options;
static char model[64], output[64];
static char *gcode;

static void write_model(void) {
    static const int face[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                    {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                    {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    snprintf(model, sizeof model, "test-macro-%d.stl", (int)getpid());
    snprintf(output, sizeof output, "test-macro-%d.gcode", (int)getpid());
    FILE *file = fopen(model, "w");
    if (!CHECK(file != NULL))
        exit(1);
    fprintf(file, "solid box\n");
    for (int f = 0; f < 12; f++) {
        fprintf(file, "facet normal 0 0 0\nouter loop\n");
        for (int k = 0; k < 3; k++)
            fprintf(file, "vertex %d %d %d\n", 20 * (face[f][k] & 1), 10 * (face[f][k] >> 1 & 1),
                    2 * (face[f][k] >> 2));
        fprintf(file, "endloop\nendfacet\n");
    }
    fprintf(file, "endsolid box\n");
    fclose(file);
}

static void set(const char *key, const char *value) {
    CHECK_OK(iso_options_set(&options, key, value, "test"));
}

static iso_status run(int threads) {
    const char *input = model;
    iso_report report = {0};
    iso_job_hooks hooks = {.threads = threads, .timestamp = 86400};
    free(gcode);
    gcode = NULL;
    unlink(output);
    iso_status status = iso_job_run(&report, &options, &input, 1, output, &hooks);
    iso_report_free(&report);
    FILE *file = fopen(output, "rb");
    if (!file)
        return status;
    gcode = calloc(1, 1 << 20);
    size_t length = fread(gcode, 1, (1 << 20) - 1, file);
    CHECK(length > 0);
    fclose(file);
    return status;
}

static bool has(const char *text) {
    return gcode && strstr(gcode, text);
}

static void start_options(void) {
    iso_options_defaults(&options);
    set("layer_height", "0.2");
    set("first_layer_height", "0.2");
}

static void test_values_of_the_job(void) {
    start_options();
    set("skirts", "0");
    CHECK(iso_foreign_set(&options.foreign, "printer_model", "BOX"));
    set("start_gcode", ";<{printer_model} {total_layer_count} {input_filename_base} [year] "
                       "{first_layer_print_min[0]} {first_layer_print_max[1]} "
                       "{size(first_layer_print_convex_hull)}>");
    set("before_layer_gcode", ";before {layer_num}");
    set("layer_gcode", ";{if layer_num > 7}high{else}low{endif} {layer_z}");
    set("start_filament_gcode", ";filament {temperature[0]}");
    set("end_filament_gcode", ";filament ends at {max_layer_z}");
    set("end_gcode", ";<{layer_num} {layer_z} {max_layer_z}>");
    CHECK_OK(run(1));
    char expected[128];
    int length = (int)strlen(model) - 4;
    snprintf(expected, sizeof expected, "\n;<BOX 10 %.*s 1970 90 105 4>\n", length, model);
    CHECK(has(expected));
    CHECK(has(";before 0\n") && has(";before 9\n") && has(";low 0.2\n") && has(";high 2\n"));
    CHECK(has("\n; printer_model = BOX\n")); /* for those who read it back */
    CHECK(has("\n;filament 200\n") && has("\n;filament ends at 2\n") && has("\n;<9 2 2>\n"));
}

/* What PrusaSlicer 2.5 gives for the same: 6 mm, and a line and a half of 0.625 mm. */
static void test_the_skirt_widens_the_first_layer(void) {
    iso_options_defaults(&options);
    set("start_gcode", ";<{first_layer_print_min[0]} {first_layer_print_max[1]} "
                       "{first_layer_print_size[0]}>");
    CHECK_OK(run(1));
    CHECK(has("\n;<83.0627 111.937 33.8747>\n"));
    set("skirts", "2");
    CHECK_OK(run(1));
    CHECK(has("\n;<82.4378 112.562 35.1244>\n"));
    set("skirts", "0");
    set("brim_width", "3");
    CHECK_OK(run(1));
    CHECK(has("\n;<87 108 26>\n"));
}

static void test_globals_count_layers(void) {
    start_options();
    set("start_gcode", "{global count = 0}");
    set("layer_gcode", "{count = count + 1};layer {count}");
    set("end_gcode", ";layers {count}");
    CHECK_OK(run(1));
    CHECK(has(";layer 1\n") && has(";layer 10\n") && has(";layers 10\n"));
    char *one = gcode;
    gcode = NULL;
    CHECK_OK(run(4));
    CHECK(one && gcode && strcmp(one, gcode) == 0);
    free(one);
}

static void test_wrong_texts_end_the_job_before_it_writes(void) {
    static const char *const keys[] = {"start_gcode",          "end_gcode",
                                       "start_filament_gcode", "end_filament_gcode",
                                       "before_layer_gcode",   "layer_gcode"};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        start_options();
        set(keys[i], "G28\nG1 X{nothing}");
        CHECK_STATUS(ISO_BAD_CONFIG, run(1));
        CHECK(gcode == NULL);
        CHECK(strstr(iso_error_message(), keys[i]) == iso_error_message());
        CHECK(strstr(iso_error_message(), "line 2, column 6") != NULL);
    }
    start_options();
    set("color_change_gcode", "{if true}");
    CHECK_STATUS(ISO_BAD_CONFIG, run(1));
    set("color_change_gcode", "{if true}M600{endif}");
    set("layer_gcode", "{global x = 1}{nothing}"); /* found out only as it is written */
    CHECK_STATUS(ISO_BAD_CONFIG, run(1));
    CHECK(gcode == NULL);
}

static void test_every_allocation_may_fail(void) {
    static iso_point point[] = {{0, 0},         {100000, 0}, {100000, 100000},
                                {50000, 50000}, {0, 100000}, {20000, 20000}};
    static int32_t first_point[] = {0, 6};
    const iso_region first = {.count = 1, .first = first_point, .point = point};
    const iso_macro_job job = {.layer_count = 1};
    start_options();
    for (int64_t n = 0; n < 20; n++) {
        iso_texts texts = {0};
        (void)iso_fail_allocation_after(n);
        texts_begin(&texts, &options, &job);
        iso_status status = texts_place(&texts, &first);
        if (status == ISO_OK)
            status = texts_check(&texts, 0.2);
        bool done = iso_fail_allocation_after(-1) <= n;
        CHECK_EQUAL(done ? ISO_OK : ISO_NO_MEMORY, status);
        if (done)
            CHECK_EQUAL(8, texts.job.hull_count); /* four edges, moved outwards */
        texts_free(&texts);
        if (done)
            return;
    }
    CHECK_EQUAL(20, 0); /* more allocations than that? */
}

int main(void) {
    write_model();
    RUN(test_values_of_the_job);
    RUN(test_the_skirt_widens_the_first_layer);
    RUN(test_globals_count_layers);
    RUN(test_wrong_texts_end_the_job_before_it_writes);
    RUN(test_every_allocation_may_fail);
    unlink(model);
    unlink(output);
    free(gcode);
    return check_verdict();
}

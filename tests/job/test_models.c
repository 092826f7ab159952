/* Whole jobs on models of all kinds under many options: every G-code prints without a fault, and
 * holds what the model holds. */
#include "checks.h"
#include "solids.h"

/* Options that stages treat apart, in turns over the models, so that each meets some of all. */
static const char *const settings[] = {
    "layer_height = 0.2\nperimeters = 2\nfill_density = 15%",
    "perimeters = 0\nfill_density = 100%\nuse_relative_e_distances = 0",
    "perimeters = 1\nfill_density = 50%\nfill_pattern = grid\nretract_lift = 0.4",
    "perimeters = 4\nfill_density = 0\nskirts = 3\nskirt_distance = 3\nz_offset = 0.15",
    "external_perimeters_first = 1\nlayer_heights = 0.3,0.2,0.1,0.25\nfill_angle = 30\n"
    "top_solid_layers = 0\nbottom_solid_layers = 0",
    "extrusion_multiplier = 0.9\ninfill_overlap = 0.2\ngcode_resolution = 0.05\ncooling = 0\n"
    "first_layer_height = 60%\nfirst_layer_extrusion_width = 0.5",
    "fill_density = 100%\nlayer_height = 0.15\nuse_relative_e_distances = 0\nretract_length = 0",
    "gcode_resolution = 0\nskirts = 0\ntop_solid_layers = 1\nbottom_solid_layers = 5\n"
    "retract_restart_extra = 0\nretract_before_travel = 0",
    "nozzle_diameter = 0.8\nlayer_height = 0.5\nfirst_layer_height = 0.4\nperimeters = 1\nthin_walls = 0\n"
    "fill_density = 3%",
};

enum { SETTINGS = sizeof settings / sizeof *settings };

static void test_models_under_options(void) {
    for (int m = 0; m < SOLID_COUNT; m++) {
        shape s = {0};
        all_solids[m].make(&s);
        for (int i = 0; i < SETTINGS; i += 1 + (s.count > 300)) {
            print p;
            int before = check_failures;
            print_shape(&p, &s, settings[(i + m) % SETTINGS]);
            print_check(&p, &s);
            if (check_failures > before)
                fprintf(stderr, "    that was %s with\n%s\n", all_solids[m].name,
                        settings[(i + m) % SETTINGS]);
            print_free(&p);
        }
        shape_free(&s);
    }
}

/* At 100 % the print holds as much plastic as the model holds space. */
static void test_full_density_fills_the_model(void) {
    for (int m = 0; m < SOLID_COUNT; m++) {
        shape s = {0};
        print p;
        all_solids[m].make(&s);
        print_shape(&p, &s,
                    "fill_density = 100%\nperimeters = 2\nlayer_height = 0.2\n"
                    "first_layer_height = 0.2\nfirst_layer_extrusion_width = 0");
        print_check(&p, &s);
        double ratio = print_volume(&p) / shape_layered_volume(&s, &p);
        printf("     %-8s %.4f of the model's volume\n", all_solids[m].name, ratio);
        CHECK(all_solids[m].full ? ratio > 0.95 && ratio < 1.05 : ratio > 0.8 && ratio < 1.1);
        print_free(&p);
        shape_free(&s);
    }
}

/* Without overlap, in a part much larger than a bead, nothing is left to be off. */
static void test_full_density_without_overlap(void) {
    shape s = {0};
    print p;
    shape_box(&s, 0, 0, 0, 40, 30, 2);
    print_shape(&p, &s,
                "fill_density = 100%\ninfill_overlap = 0\nlayer_height = 0.2\n"
                "first_layer_height = 0.2\nfirst_layer_extrusion_width = 0");
    print_check(&p, &s);
    CHECK_NEAR(40 * 30 * 2, print_volume(&p), 40 * 30 * 2 * 0.01);
    print_free(&p);
    shape_free(&s);
}

/* Two files keep their places to each other, and the box of both is centred. */
static void test_two_files_in_one_print(void) {
    shape a = {0}, b = {0}, both = {0};
    shape_box(&a, 0, 0, 0, 8, 8, 5.03);
    shape_box(&b, 14, 3, 0, 20, 13, 8);
    solid_two(&both);
    const char *path[] = {print_path("a.stl"), print_path("b.stl")};
    CHECK(shape_write_binary(&a, path[0]));
    CHECK(shape_write_binary(&b, path[1]));
    print apart, together;
    print_files(&apart, path, 2, "", 1);
    print_shape(&together, &both, "");
    print_check(&apart, &both);
    CHECK_EQUAL(2, apart.report.input_count);
    CHECK_EQUAL(12, apart.report.input[1].triangle_count);
    CHECK_NEAR(64 * 5.03, apart.report.input[0].volume, 1e-4);
    CHECK_NEAR(480, apart.report.input[1].volume, 1e-9);
    CHECK(apart.size == together.size && !memcmp(apart.text, together.text, apart.size));
    print_free(&apart);
    print_free(&together);
    shape_free(&a);
    shape_free(&b);
    shape_free(&both);
}

/* Files that overlap are one body: plastic is not put there twice. */
static void test_overlapping_files_are_united(void) {
    shape a = {0}, b = {0}, whole = {0};
    shape_box(&a, 0, 0, 0, 12, 10, 4);
    shape_box(&b, 8, 0, 0, 20, 10, 4);
    shape_box(&whole, 0, 0, 0, 20, 10, 4);
    const char *path[] = {print_path("a.stl"), print_path("b.stl")};
    CHECK(shape_write_binary(&a, path[0]));
    CHECK(shape_write_binary(&b, path[1]));
    print united, one;
    print_files(&united, path, 2, "fill_density = 30%", 1);
    print_shape(&one, &whole, "fill_density = 30%");
    CHECK_EQUAL(ISO_OK, united.status);
    CHECK_NEAR(print_volume(&one), print_volume(&united), 1e-3 * print_volume(&one));
    CHECK_NEAR(one.report.sliced_volume, united.report.sliced_volume, 1e-6);
    print_free(&united);
    print_free(&one);
    shape_free(&a);
    shape_free(&b);
    shape_free(&whole);
}

/* Start each triangle at another corner. */
static void turn_corners(shape *s) {
    for (int64_t t = 0; t < s->count; t++) {
        float turned[9], *f = s->triangle + 9 * t;
        for (int k = 0; k < 9; k++)
            turned[k] = f[(k + 3 * (t % 3)) % 9];
        memcpy(f, turned, sizeof turned);
    }
}

/* Shuffled triangles are the same surface: contours may start elsewhere, volumes may not differ. */
static void test_order_of_triangles(void) {
    static const int chosen[] = {0, 2, 4, 8};
    for (int i = 0; i < 4; i++) {
        shape s = {0};
        print a, b;
        all_solids[chosen[i]].make(&s);
        print_shape(&a, &s, "layer_height = 0.25");
        shape_shuffle(&s, 11 + (uint64_t)i);
        turn_corners(&s);
        print_shape(&b, &s, "layer_height = 0.25");
        print_check(&b, &s);
        CHECK_NEAR(print_volume(&a), print_volume(&b), 1e-3 * print_volume(&a));
        CHECK_NEAR(a.report.sliced_volume, b.report.sliced_volume, 1e-4 * a.report.sliced_volume);
        print_free(&a);
        print_free(&b);
        shape_free(&s);
    }
}

int main(void) {
    RUN(test_models_under_options);
    RUN(test_full_density_fills_the_model);
    RUN(test_full_density_without_overlap);
    RUN(test_two_files_in_one_print);
    RUN(test_overlapping_files_are_united);
    RUN(test_order_of_triangles);
    CHECK(print_folder_remove());
    return check_verdict();
}

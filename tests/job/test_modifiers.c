/* Modifiers: how much is drawn where, in which directions, and what is refused. What a bead holds
 * is spread along its middle, and cut at the border of a box by the tests' own means. */
#include <unistd.h>

#include "base/memory.h"
#include "checks.h"

enum { SPARSE = ISO_ROLE_INTERNAL_INFILL, BRIDGE = ISO_ROLE_BRIDGE_INFILL };

typedef struct box {
    double x0, y0, x1, y1; /* in the model's frame, whose middle lies on the middle of the bed */
} box;

#define WHOLE ((box){-1e3, -1e3, 1e3, 1e3})
#define BARE                                                                                       \
    "skirts = 0\nperimeters = 1\ntop_solid_layers = 0\nbottom_solid_layers = 0\n"                  \
    "solid_infill_below_area = 0\nlayer_height = 0.2\nfirst_layer_height = 0.2\n"

/* The part of a straight move that lies in the box. */
static double share_inside(const print_move *m, const box *b) {
    const double from[2] = {m->ax, m->ay}, to[2] = {m->bx, m->by};
    const double low[2] = {b->x0, b->y0}, high[2] = {b->x1, b->y1};
    double begin = 0, end = 1;
    for (int k = 0; k < 2; k++) {
        double d = to[k] - from[k];
        if (fabs(d) < 1e-9) {
            if (from[k] < low[k] || from[k] > high[k])
                return 0;
            continue;
        }
        double t0 = (low[k] - from[k]) / d, t1 = (high[k] - from[k]) / d;
        begin = fmax(begin, fmin(t0, t1));
        end = fmin(end, fmax(t0, t1));
    }
    return end > begin ? end - begin : 0;
}

static box on_bed(const print *p, const box *b) {
    iso_vec2 c = iso_options_center(&p->options);
    return (box){b->x0 + c.x, b->y0 + c.y, b->x1 + c.x, b->y1 + c.y};
}

/* Filament of a role (-1: all) in a box, on a layer (-1: all). */
static double filament_in(const print *p, int role, int32_t layer, box b) {
    double sum = 0;
    b = on_bed(p, &b);
    for (int32_t i = 0; i < p->move_count; i++)
        if (move_chosen(&p->move[i], role, layer))
            sum += p->move[i].e * share_inside(&p->move[i], &b);
    return sum;
}

static double height_of(const print *p, int32_t layer) {
    double sum = 0;
    for (int32_t i = 0; i < p->level_count; i++)
        sum += layer < 0 || layer == i ? p->level[i].height : 0;
    return sum;
}

/* Part of the box that is filled. */
static double density_in(const print *p, int role, int32_t layer, box b) {
    double d = p->options.filament_diameter, area = (b.x1 - b.x0) * (b.y1 - b.y0);
    double volume = filament_in(p, role, layer, b) * SHAPE_PI / 4 * d * d;
    return volume / (area * height_of(p, layer));
}

/* Length in a direction, as part of all, within a box. */
static double along(const print *p, int32_t layer, box b, double angle) {
    double sum = 0, all = 0, c = cos(angle / 180 * SHAPE_PI), s = sin(angle / 180 * SHAPE_PI);
    b = on_bed(p, &b);
    for (int32_t i = 0; i < p->move_count; i++) {
        const print_move *m = &p->move[i];
        if (!move_chosen(m, SPARSE, layer))
            continue;
        double length = move_length(m), inside = length * share_inside(m, &b);
        all += inside;
        if (fabs((m->bx - m->ax) * s - (m->by - m->ay) * c) < 0.01 * length + 0.002)
            sum += inside;
    }
    return sum / all;
}

static const char *box_file(const char *name, double x0, double y0, double z0, double x1, double y1,
                            double z1) {
    shape s = {0};
    const char *path = print_path(name);
    shape_box(&s, x0, y0, z0, x1, y1, z1);
    CHECK(shape_write_binary(&s, path));
    shape_free(&s);
    return path;
}

/* Print boxes of 60 x 60 mm at (100, 200); %s in the settings is a modifier in their middle, 30 mm
 * wide, from 2 mm below the box to 2 mm above it. */
static void print_block(print *p, double height, const char *settings, int32_t threads) {
    char text[1024];
    const char *path = box_file("block.stl", 100, 200, 5, 160, 260, 5 + height);
    snprintf(text, sizeof text, settings, box_file("core.stl", 115, 215, 3, 145, 245, 7 + height));
    print_files(p, &path, 1, text, threads);
    if (p->status == ISO_OK)
        check_machine(p);
    else
        fprintf(stderr, "    %s\n", p->message);
}

static const box core = {-15, -15, 15, 15}, within = {-13, -13, 13, 13}, left = {-28, -28, -17, 28},
                 right = {17, -28, 28, 28};

static double around(const print *p) {
    return (density_in(p, SPARSE, -1, left) + density_in(p, SPARSE, -1, right)) / 2;
}

/* Away from the borders, with what runs along them left out: the two densities. */
static void test_density(void) {
    print p;
    print_block(&p, 4, BARE "fill_density = 15%%\nmodifiers = %s fill_density=40%%", 1);
    CHECK_NEAR(0.40, density_in(&p, SPARSE, -1, within), 0.03 * 0.40);
    CHECK_NEAR(0.15, around(&p), 0.03 * 0.15);
    print_free(&p);
    print_block(&p, 4, BARE "fill_density = 50%%\nmodifiers = %s fill_density=10%%", 1);
    CHECK_NEAR(0.10, density_in(&p, SPARSE, -1, within), 0.03 * 0.10);
    CHECK_NEAR(0.50, around(&p), 0.03 * 0.50);
    print_free(&p);
}

/* The border belongs to it: nothing beyond, nothing missing. */
static void test_full_and_empty(void) {
    print p;
    print_block(&p, 4, BARE "fill_density = 0\nmodifiers = %s fill_density=100%%", 1);
    double beyond = print_filament(&p, SPARSE, -1) - filament_in(&p, SPARSE, -1, core);
    CHECK(fabs(beyond) < 1e-9);
    CHECK_NEAR(1, density_in(&p, SPARSE, -1, core), 0.005);
    print_free(&p);
    print_block(&p, 4, BARE "fill_density = 20%%\nmodifiers = %s fill_density=0", 1);
    CHECK(filament_in(&p, SPARSE, -1, core) < 1e-9);
    CHECK_NEAR(0.20, around(&p), 0.03 * 0.20);
    print_free(&p);
}

static void test_angle_and_pattern(void) {
    print p;
    print_block(&p, 2, BARE "fill_density = 20%%\nmodifiers = %s fill_angle=20 fill_density=30%%",
                1);
    for (int32_t layer = 4; layer < 6; layer++) {
        CHECK(along(&p, layer, within, 20 + 90 * (layer % 2)) > 0.99);
        CHECK(along(&p, layer, right, 45 + 90 * (layer % 2)) > 0.99);
        CHECK(along(&p, layer, right, 20 + 90 * (layer % 2)) < 0.01);
    }
    print_free(&p);
    print_block(&p, 2, BARE "fill_density = 20%%\nmodifiers = %s fill_pattern=triangles", 1);
    for (int k = 0; k < 3; k++)
        CHECK_NEAR(1.0 / 3, along(&p, 4, within, 45 + 60 * k), 0.05);
    CHECK(along(&p, 4, right, 45) > 0.99);
    print_free(&p);
}

/* Lines join along the border of a modifier as they do along walls, if its own limit allows. */
static void test_anchors(void) {
    print joined, apart;
    print_block(&joined, 1, BARE "fill_density = 0\nmodifiers = %s fill_density=20%%", 1);
    print_block(&apart, 1,
                BARE "fill_density = 0\n"
                     "modifiers = %s fill_density=20%% infill-anchor-max=0 infill_anchor=0",
                1);
    CHECK(print_runs(&joined, SPARSE, 2) <= 2);
    CHECK(print_runs(&apart, SPARSE, 2) > 8);
    print_free(&joined);
    print_free(&apart);
}

/* Beads on both sides of a border touch, and don't overlap. */
static void test_border(void) {
    print p;
    print_block(&p, 1, BARE "fill_density = 20%%\nmodifiers = %s fill_density=30%%", 1);
    double clear = iso_options_width(&p.options, ISO_ROLE_SOLID_INFILL, false, 0.2) / 2 - 0.03;
    CHECK(filament_in(&p, SPARSE, 2, (box){15 - clear, -14, 15 + clear, 14}) < 1e-9);
    CHECK(filament_in(&p, SPARSE, 2, (box){14, -14, 15, 14}) > 0);
    CHECK(filament_in(&p, SPARSE, 2, (box){15, -14, 16, 14}) > 0);
    print_free(&p);
}

/* Three that overlap, written all in one line or one a line. */
static void test_later_wins(void) {
    const char *path = box_file("block.stl", 0, 0, 0, 60, 40, 2);
    const char *a = box_file("a.stl", 10, 0, 0, 40, 40, 2);
    const char *b = box_file("b.stl", 20, 0, 0, 60, 40, 2);
    char settings[1024];
    for (int turned = 0; turned < 2; turned++) {
        print p;
        snprintf(settings, sizeof settings,
                 BARE
                 "fill_density = 0\nmodifiers = %s fill_density=%d%% %s %s  fill_density=%d%%;",
                 turned ? b : a, turned ? 20 : 40, turned ? "; ;" : "\\n", turned ? a : b,
                 turned ? 40 : 20);
        print_files(&p, &path, 1, settings, 1);
        CHECK_EQUAL(ISO_OK, p.status);
        CHECK(density_in(&p, SPARSE, -1, (box){-28, -18, -20.1, 18}) == 0);
        CHECK_NEAR(0.40, density_in(&p, SPARSE, -1, (box){-18, -18, -12, 18}), 0.02);
        CHECK_NEAR(turned ? 0.40 : 0.20, density_in(&p, SPARSE, -1, (box){-8, -18, 8, 18}), 0.01);
        CHECK_NEAR(0.20, density_in(&p, SPARSE, -1, (box){12, -18, 28, 18}), 0.01);
        print_free(&p);
    }
}

/* Only layers whose middles it reaches; a part with a hole, no walls, and an island of it inside.
 */
static void test_layers_and_holes(void) {
    const char *path = box_file("block.stl", 0, 0, 0, 40, 40, 3), *ring = print_path("ring.stl");
    char settings[1024];
    shape s = {0};
    shape_box(&s, 5, 5, 1, 35, 35, 2);
    shape_box(&s, 15, 15, 1, 25, 25, 2);
    shape_turn(&s, 12, 24);
    CHECK(shape_write_binary(&s, ring));
    shape_free(&s);
    print p, plain;
    snprintf(settings, sizeof settings,
             BARE "fill_density = 10%%\nmodifiers = %s fill_density=100%%", ring);
    print_files(&p, &path, 1, settings, 1);
    print_files(&plain, &path, 1, BARE "fill_density = 10%", 1);
    CHECK(p.status == ISO_OK && plain.status == ISO_OK);
    for (int32_t i = 0; i < p.level_count; i++) {
        double top = p.level[i].z, a = print_length(&p, SPARSE, i);
        double b = print_length(&plain, SPARSE, i);
        if (top < 1.05 || top > 2.05) {
            CHECK_NEAR(b, a, 1e-3 * b);
            continue;
        }
        CHECK_NEAR(1, density_in(&p, SPARSE, i, (box){-15, -15, 15, -5}), 0.02);
        CHECK(density_in(&p, SPARSE, i, (box){-4, -4, 4, 4}) < 0.2);
    }
    print_free(&p);
    print_free(&plain);
}

/* What moves the model moves what is drawn around it. The modifier is the quarter with the lowest x
 * and y, and reaches beyond the model. */
static void check_moved(const char *settings, const char *files, box full, box sparse) {
    const char *path = box_file("block.stl", 100, 50, 7, 120, 70, 9);
    const char *quarter = box_file("quarter.stl", 60, 45, 0, 110, 60, 70);
    char text[1024];
    print p;
    snprintf(text, sizeof text, BARE "fill_density = 0\nmodifiers = %s fill_density=100%%\n%s",
             quarter, settings);
    print_files(&p, &path, 1, text, 1);
    if (!CHECK_EQUAL(ISO_OK, p.status))
        fprintf(stderr, "    %s\n", p.message);
    check_machine(&p);
    int before = check_failures;
    CHECK(density_in(&p, SPARSE, -1, full) > 0.98);
    CHECK(density_in(&p, SPARSE, -1, sparse) == 0);
    CHECK_EQUAL(1, p.report.input_count);
    CHECK_EQUAL(0, p.report.warning_count);
    if (check_failures > before)
        fprintf(stderr, "    that was %s%s\n", files, settings);
    print_free(&p);
}

static void test_moves_with_the_model(void) {
    const box low_left = {-8, -8, -1, -1}, right_side = {1, -8, 8, 8}, low_right = {1, -8, 8, -1};
    const box left_side = {-8, -8, -1, 8}, up_left = {-8, 1, -1, 8};
    check_moved("", "as it is", low_left, right_side);
    check_moved("rotate = 90", "", low_right, left_side);
    check_moved("mirror = x", "", low_right, left_side);
    check_moved("mirror = y", "", up_left, right_side);
    check_moved("center = 40,60", "", low_left, right_side);
    check_moved("scale = 200%", "", (box){-16, -16, -2, -2}, (box){2, -16, 16, 16});
    check_moved("scale_to_fit = 10,20,20", "", (box){-3.5, -3.5, -0.5, -0.5},
                (box){0.5, -3.5, 3.5, 3.5});
    check_moved("dont_arrange = 1\nrotate = 90", "", (box){11, -48, 18, -41},
                (box){2, -48, 9, -32});
    check_moved("duplicate_grid = 1,1", "", low_left, right_side);
}

/* The model is as large, lies where it would, and prints as many layers. */
static void test_only_a_modifier(void) {
    const char *path = box_file("block.stl", 100, 50, 7, 120, 70, 9);
    const char *large = box_file("quarter.stl", 0, 0, -100, 1000, 1000, 1000);
    char settings[1024];
    print p, plain;
    const char *others = "scale_to_fit = 15,20,20\nrotate = 30\ndont_arrange = 1\n"
                         "gcode_label_objects = octoprint\n";
    snprintf(settings, sizeof settings, "%sfill_density = 10%%\nmodifiers = %s fill_density=30%%",
             others, large);
    print_files(&p, &path, 1, settings, 1);
    snprintf(settings, sizeof settings, "%sfill_density = 30%%", others);
    print_files(&plain, &path, 1, settings, 1);
    CHECK(p.status == ISO_OK && plain.status == ISO_OK);
    CHECK_EQUAL(plain.level_count, p.level_count);
    CHECK_NEAR(plain.report.mesh_volume, p.report.mesh_volume, 1e-9);
    CHECK(strcmp(p.report.input[0].path, path) == 0 && p.report.input_count == 1);
    double all = print_filament(&plain, -1, -1);
    CHECK_NEAR(all, print_filament(&p, -1, -1), 0.002 * all);
    print_free(&p);
    print_free(&plain);
}

/* Solid shells over what is full already are no bridges; over the rest they are. */
static void test_lids(void) {
    print p;
    print_block(&p, 3, "skirts = 0\nfill_density = 15%%\nmodifiers = %s fill_density=100%%", 1);
    int32_t lid = p.level_count - 3;
    CHECK(density_in(&p, BRIDGE, lid, left) > 0.8);
    CHECK(filament_in(&p, BRIDGE, lid, (box){-11, -11, 11, 11}) == 0);
    CHECK_NEAR(1, density_in(&p, -1, lid, (box){-11, -11, 11, 11}), 0.05);
    print_free(&p);
}

/* A full print has shells where a modifier makes it sparse, and stays full elsewhere. */
static void test_sparse_in_a_full_print(void) {
    print p;
    print_block(&p, 3, "skirts = 0\nfill_density = 100%%\nmodifiers = %s fill_density=10%%", 1);
    for (int32_t i = 0; i < p.level_count; i++) {
        bool shell = i < 3 || i >= p.level_count - 3;
        if (shell)
            CHECK(density_in(&p, -1, i, within) > 0.9);
        else
            CHECK_NEAR(0.1, density_in(&p, -1, i, within), 0.01);
        CHECK_NEAR(1, density_in(&p, -1, i, left), 0.05);
    }
    print_free(&p);
}

/* ---- files, words, others ---- */

static void refused(iso_status status, const char *word, const char *other, const char *modifiers,
                    int models) {
    const char *a = box_file("block.stl", 0, 0, 0, 20, 20, 2);
    const char *path[] = {a, box_file("second.stl", 30, 0, 0, 40, 10, 2)};
    char settings[2048], line[1024];
    print p;
    snprintf(line, sizeof line, modifiers, a);
    snprintf(settings, sizeof settings, "modifiers = %s\n%s", line, other);
    print_files(&p, path, models, settings, 1);
    CHECK_EQUAL(status, p.status);
    if (status != ISO_OK && !CHECK(strstr(p.message, word) != NULL && p.text == NULL))
        fprintf(stderr, "    %s\n", p.message);
    print_free(&p);
}

static void test_refused(void) {
    refused(ISO_UNREADABLE, "/nowhere/core.stl", "", "/nowhere/core.stl fill_density=3%%", 1);
    refused(ISO_UNREADABLE, "with a blank.stl", "", "with a blank.stl  fill_density=3%%", 1);
    refused(ISO_BAD_CONFIG, "line 2: perimeters", "", "%1$s fill_angle=0\\n%1$s perimeters=3", 1);
    refused(ISO_BAD_CONFIG, "line 3: fill_density = 101%", "",
            "%1$s fill_angle=0;;%1$s fill_angle=1 fill_density=101%%", 1);
    refused(ISO_BAD_CONFIG, "is it fill_density?", "", "%s fill_densty=10%%", 1);
    refused(ISO_BAD_CONFIG, "fill_pattern = squares", "", "%s fill_pattern=squares", 1);
    refused(ISO_BAD_CONFIG, "changes nothing", "", "%s", 1);
    refused(ISO_BAD_CONFIG, "30% is no key=value", "", "%s fill_angle=1 30%%", 1);
    refused(ISO_BAD_CONFIG, "line 1: give the file", "", "fill_density=10%%", 1);
    refused(ISO_BAD_CONFIG, "infill_every_layers", "infill_every_layers = 2", "%s fill_angle=1", 1);
    refused(ISO_BAD_CONFIG, "split", "split = 1", "%s fill_angle=1", 1);
    refused(ISO_BAD_CONFIG, "cut", "cut = 1", "%s fill_angle=1", 1);
    refused(ISO_BAD_CONFIG, "arrange", "arrange = 1", "%s fill_angle=1", 2);
    refused(ISO_BAD_CONFIG, "duplicate", "duplicate = 2", "%s fill_angle=1", 2);
    refused(ISO_BAD_CONFIG, "complete_objects", "complete_objects = 1", "%s fill_angle=1", 2);
    refused(ISO_BAD_CONFIG, "spiral_vase",
            "spiral_vase = 1\nperimeters = 1\nfill_density = 0\ntop_solid_layers = 0",
            "%s fill_density=10%%", 1);
    refused(ISO_OK, "", "arrange = 1\nduplicate = 2", "%s fill_angle=1", 1);
    refused(ISO_OK, "", "complete_objects = 1\nduplicate_grid = 2,1", "%s fill_angle=1", 1);
    refused(ISO_OK, "", "", " ; \\n;", 1);
    refused(ISO_OK, "", "", "%s fill_angle=1", 2);
}

static int warned(const print *p, const char *word) {
    for (int32_t i = 0; i < p->report.warning_count; i++)
        if (strcmp(p->report.warning[i].code, "modifier-unused") == 0 &&
            strstr(p->report.warning[i].message, word))
            return 1;
    return 0;
}

static void test_unused(void) {
    const char *path = box_file("block.stl", 0, 0, 0, 20, 20, 4);
    const char *away = box_file("away.stl", 30, 0, 0, 40, 10, 2);
    const char *inside = box_file("inside.stl", 5, 5, 1, 15, 15, 3);
    char settings[1024];
    print p;
    snprintf(settings, sizeof settings, "modifiers = %s fill_angle=1;%s fill_angle=1", away,
             inside);
    print_files(&p, &path, 1, settings, 1);
    CHECK_EQUAL(1, p.report.warning_count);
    CHECK(warned(&p, "line 1") && warned(&p, away) && !warned(&p, inside));
    print_free(&p);
    snprintf(settings, sizeof settings, "modifiers = %s fill_angle=1;%s fill_angle=0", inside,
             path);
    print_files(&p, &path, 1, settings, 2);
    CHECK(warned(&p, inside) && !warned(&p, "block.stl"));
    print_free(&p);
}

static void test_threads(void) {
    print first, p;
    const char *settings = "fill_density = 15%%\nmodifiers = %s fill_pattern=gyroid "
                           "fill_density=40%%";
    print_block(&first, 12, settings, 1);
    for (int32_t threads = 1; threads <= 4; threads *= 2) {
        print_block(&p, 12, settings, threads);
        CHECK(p.size == first.size && memcmp(p.text, first.text, p.size) == 0);
        print_free(&p);
    }
    print_free(&first);
}

/* ---- memory ---- */

static void test_no_memory(void) {
    const char *path = box_file("block.stl", 0, 0, 0, 12, 12, 2.4);
    const char *output = print_path("swept.gcode");
    char settings[1024];
    iso_options options;
    iso_job_hooks hooks = {.threads = 1};
    snprintf(settings, sizeof settings,
             "fill_density = 15%%\nsolid_infill_below_area = 0\n"
             "modifiers = %s fill_density=100%%;%s fill_angle=3",
             box_file("core.stl", 3, 3, 0, 9, 9, 3), box_file("a.stl", 5, 0, 1, 20, 20, 3));
    CHECK(print_options(&options, settings));
    for (int64_t n = 0, count = 1; n <= count; n += n < 200 ? 1 : 7) {
        iso_report report = {0};
        iso_fail_allocation_after(n == 0 ? INT64_MAX : n - 1);
        iso_status status = iso_job_run(&report, &options, &path, 1, output, &hooks);
        if (n == 0) {
            count = iso_fail_allocation_after(-1);
            CHECK_EQUAL(ISO_OK, status);
            remove(output);
        } else {
            iso_fail_allocation_after(-1);
            CHECK(status == ISO_NO_MEMORY && access(output, F_OK) != 0);
        }
        iso_report_free(&report);
    }
}

int main(void) {
    RUN(test_density);
    RUN(test_full_and_empty);
    RUN(test_angle_and_pattern);
    RUN(test_anchors);
    RUN(test_border);
    RUN(test_later_wins);
    RUN(test_layers_and_holes);
    RUN(test_moves_with_the_model);
    RUN(test_only_a_modifier);
    RUN(test_lids);
    RUN(test_sparse_in_a_full_print);
    RUN(test_refused);
    RUN(test_unused);
    RUN(test_threads);
    RUN(test_no_memory);
    CHECK(print_folder_remove());
    return check_verdict();
}

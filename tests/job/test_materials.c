/* Jobs with two materials: shares of the filament in windows, one change a layer. */
#include "base/memory.h"
#include "checks.h"

enum { SPARSE = ISO_ROLE_INTERNAL_INFILL };

#define GYROID                                                                                     \
    "fill_pattern = gyroid_sheet\nfill_density = 30%\nlattice_cell = 1.25\nperimeters = 1\n"       \
    "top_solid_layers = 0\nbottom_solid_layers = 0\nsolid_infill_below_area = 0\n"

static void print_box_of(print *p, double side, double height, const char *settings) {
    shape s = {0};
    shape_box(&s, 0, 0, 0, side, side, height);
    print_shape(p, &s, settings);
    shape_free(&s);
    CHECK_EQUAL(ISO_OK, p->status);
    check_machine(p);
    check_totals(p);
}

static int changes_of(const print *p) {
    int changes = 0;
    for (int32_t i = 1; i < p->move_count; i++)
        changes += p->move[i].layer >= 0 && p->move[i].tool != p->move[i - 1].tool;
    return changes;
}

/* At most one on each layer. */
static void check_changes(const print *p) {
    for (int32_t l = 0; l < p->level_count; l++) {
        int changes = 0;
        for (int32_t i = p->level[l].first + 1; i < p->level[l + 1].first; i++)
            changes += p->move[i].tool != p->move[i - 1].tool;
        CHECK(changes <= 1);
    }
    CHECK_EQUAL(changes_of(p), p->report.print.tool_changes);
}

/* The middles of short moves, which a gyroid's are, by windows of 5 mm. */
static void test_share_of_filament(void) {
    enum { WINDOWS = 4 };
    static double of[2][WINDOWS][WINDOWS][2];
    print one, two;
    memset(of, 0, sizeof of);
    print_box_of(&one, 24, 10, GYROID);
    print_box_of(&two, 24, 10, GYROID "lattice_material = 50+3*x");
    CHECK_NEAR(1, print_filament(&two, -1, -1) / print_filament(&one, -1, -1), 0.002);
    iso_vec2 center = iso_options_center(&two.options);
    for (int32_t i = 0; i < two.move_count; i++) {
        const print_move *m = &two.move[i];
        if (!move_chosen(m, SPARSE, -1))
            continue;
        double x = (m->ax + m->bx) / 2 - center.x + 10, y = (m->ay + m->by) / 2 - center.y + 10;
        int u = (int)floor(x / 5), v = (int)floor(y / 5), w = m->bz > 5;
        if (u >= 0 && u < WINDOWS && v >= 0 && v < WINDOWS)
            of[w][v][u][m->tool] += m->e;
    }
    double sum = 0, worst = 0;
    for (int k = 0; k < 2 * WINDOWS * WINDOWS; k++) {
        const double *window = of[k / (WINDOWS * WINDOWS)][k / WINDOWS % WINDOWS][k % WINDOWS];
        double off =
            window[1] / (window[0] + window[1]) - (50 + 3 * (5 * (k % WINDOWS) - 7.5)) / 100;
        sum += off;
        worst = fmax(worst, fabs(off));
    }
    CHECK_NEAR(0, sum / (2 * WINDOWS * WINDOWS), 0.01);
    CHECK(worst < 0.06);
    check_changes(&two);
    CHECK(changes_of(&two) >= two.level_count - 1);
    print_free(&one);
    print_free(&two);
}

/* All copies take one tool, then the other; also with absolute E, by the firmware, labelled. */
static void test_copies(void) {
    static const char *const settings[] = {
        "duplicate = 3\n", "duplicate = 2\nuse_relative_e_distances = 0\nretract_lift = 0.4\n",
        "duplicate = 2\nuse_firmware_retraction = 1\ngcode_label_objects = firmware\n",
        "duplicate = 2\ncomplete_objects = 1\n",
        "only_retract_when_crossing_perimeters = 1\navoid_crossing_perimeters = 1\n"};
    for (int k = 0; k < 5; k++) {
        char all[1024];
        print p;
        shape s = {0};
        shape_box(&s, 0, 0, 0, 10, 10, 4);
        snprintf(all, sizeof all, "%s%slattice_material = 50", GYROID "lattice_cell = 2\n",
                 settings[k]);
        print_shape(&p, &s, all);
        shape_free(&s);
        CHECK_EQUAL(ISO_OK, p.status);
        check_machine(&p);
        check_changes(&p);
        CHECK(changes_of(&p) > 8);
        CHECK_NEAR(p.report.print.tool_mm[0] + p.report.print.tool_mm[1],
                   p.report.print.filament_mm, 1e-6);
        print_free(&p);
    }
}

static void test_threads(void) {
    shape s = {0};
    const char *path = print_path("model.stl");
    print p[3];
    shape_box(&s, 0, 0, 0, 16, 16, 6);
    CHECK(shape_write_binary(&s, path));
    for (int k = 0; k < 3; k++)
        print_files(&p[k], &path, 1, GYROID "lattice_map = cylinder\nlattice_material = 50+3*x",
                    1 + 3 * k);
    for (int k = 1; k < 3; k++)
        CHECK(p[k].size == p[0].size && !memcmp(p[k].text, p[0].text, p[0].size));
    for (int k = 0; k < 3; k++)
        print_free(&p[k]);
    shape_free(&s);
}

/* Only within the modifier. */
static void test_modifier(void) {
    shape s = {0}, m = {0};
    const char *path = print_path("model.stl"), *inner = print_path("inner.stl");
    char settings[1024];
    print p;
    shape_box(&s, 0, 0, 0, 20, 20, 4);
    shape_box(&m, 10, 0, 0, 20, 20, 4);
    CHECK(shape_write_binary(&s, path) && shape_write_binary(&m, inner));
    snprintf(settings, sizeof settings, "%s%s lattice_material=100",
             GYROID "lattice_cell = 3\nmodifiers = ", inner);
    print_files(&p, &path, 1, settings, 1);
    CHECK_EQUAL(ISO_OK, p.status);
    iso_vec2 center = iso_options_center(&p.options);
    double of[2] = {0, 0};
    for (int32_t i = 0; i < p.move_count; i++) {
        const print_move *d = &p.move[i];
        double x = (d->ax + d->bx) / 2 - center.x;
        if (!move_chosen(d, SPARSE, -1) || fabs(x) < 1)
            continue;
        CHECK_EQUAL(x > 0, d->tool);
        of[d->tool] += d->e;
    }
    CHECK(of[0] > 1 && of[1] > 1);
    check_changes(&p);
    print_free(&p);
    shape_free(&s);
    shape_free(&m);
}

static void test_bad_expression(void) {
    shape s = {0};
    print p;
    shape_box(&s, 0, 0, 0, 10, 10, 4);
    print_shape(&p, &s, GYROID "lattice_material = 50+*x");
    CHECK_EQUAL(ISO_BAD_CONFIG, p.status);
    CHECK(strstr(p.message, "lattice_material"));
    print_free(&p);
    print_shape(&p, &s, "toolchange_gcode = {nonsense");
    CHECK_EQUAL(ISO_BAD_CONFIG, p.status);
    CHECK(strstr(p.message, "toolchange_gcode"));
    print_free(&p);
    shape_free(&s);
}

int main(void) {
    RUN(test_share_of_filament);
    RUN(test_copies);
    RUN(test_threads);
    RUN(test_modifier);
    RUN(test_bad_expression);
    CHECK(print_folder_remove());
    return check_verdict();
}

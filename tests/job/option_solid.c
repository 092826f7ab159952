/* Options that say what is inside, and what becomes of models that have no inside. What they make
 * of a model can't be held against its triangles. */
#include "option_row.h"
#include "solids.h"

#define ONE_WALL "perimeters = 1\nfill_density = 0\ntop_solid_layers = 0\nbottom_solid_layers = 0\n"

/* Two blocks that overlap. */
static void make_pair(shape *s) {
    shape_box(s, 0, 0, 0, 10, 10, 3);
    shape_box(s, 5, 4, 0, 16, 16, 2.4);
}

/* A block without its top: closing it would take a third of its area and more. */
static void make_tray(shape *s) {
    shape_box(s, 0, 0, 0, 16, 12, 3);
    shape_remove(s, 2);
    shape_remove(s, 2);
}

static int has_warning(const print *p, const char *code, const char *part) {
    for (int32_t i = 0; i < p->report.warning_count; i++)
        if (strcmp(p->report.warning[i].code, code) == 0 &&
            strstr(p->report.warning[i].message, part))
            return 1;
    return 0;
}

static void check_solid(const change *c) {
    const iso_report_solid *found = &c->b->report.solid;
    CHECK(same_places(c->a, c->b) && same_filament(c->a, c->b));
    CHECK_EQUAL(0, c->a->report.solid.points);
    CHECK(found->contours > 0);
    CHECK_EQUAL(found->contours, found->contours_checked);
    CHECK_EQUAL(0, found->contours_wrong);
    CHECK_EQUAL(2, found->shells_overlapping);
}

/* A new surface about the same block, on its grid. */
static void repair(const change *c) {
    const iso_mesh_defects *defects = &c->b->report.input[0].defects;
    CHECK_NEAR(0, c->a->report.input[0].defects.voxel, 0);
    CHECK_NEAR(0.25, defects->voxel, 0);
    CHECK(defects->largest_error > 0 && defects->largest_error < 0.25 * 1.8);
    CHECK(c->b->report.input[0].triangle_count > 1000);
    CHECK_NEAR(16 * 16 * 3, c->b->report.input[0].volume, 0.01 * 16 * 16 * 3);
    CHECK_NEAR(c->a->report.sliced_volume, c->b->report.sliced_volume,
               0.01 * c->a->report.sliced_volume);
    CHECK(has_warning(c->b, "mesh-mended", "made anew on a grid of 0.25 mm from 12 triangles"));
}

static void repair_voxel(const change *c) {
    const iso_mesh_defects *a = &c->a->report.input[0].defects;
    const iso_mesh_defects *b = &c->b->report.input[0].defects;
    CHECK_NEAR(0.2, a->voxel, 0);
    CHECK_NEAR(0.4, b->voxel, 0);
    CHECK(b->largest_error > a->largest_error);
    CHECK(4 * c->b->report.input[0].triangle_count < 1.4 * c->a->report.input[0].triangle_count);
    CHECK(has_warning(c->b, "mesh-mended", "0.4 mm"));
}

/* The tray is that much thicker: its floor and its walls grow to both sides. */
static void sheet_thickness(const change *c) {
    const double t[2] = {1, 2};
    const print *p[2] = {c->a, c->b};
    for (int i = 0; i < 2; i++) {
        double outer = (16 + t[i]) * (12 + t[i]) * (3 + t[i] / 2);
        double inner = (16 - t[i]) * (12 - t[i]) * (3 - t[i] / 2);
        double box[4], width = 0;
        CHECK_NEAR(outer - inner, p[i]->report.input[0].volume, 1e-3 * outer);
        CHECK_EQUAL(1, p[i]->report.input[0].defects.sheets);
        CHECK_NEAR(t[i], p[i]->report.input[0].defects.sheet_thickness, 0);
        for (int32_t k = 0; k < p[i]->move_count && width == 0; k++)
            if (move_chosen(&p[i]->move[k], ISO_ROLE_EXTERNAL_PERIMETER, 1))
                width = p[i]->move[k].width;
        CHECK(print_box(box, p[i], ISO_ROLE_EXTERNAL_PERIMETER, 1));
        CHECK_NEAR(16 + t[i], box[2] - box[0] + width, 0.003);
        CHECK_NEAR(12 + t[i], box[3] - box[1] + width, 0.003);
        CHECK(has_warning(p[i], "mesh-mended", "sheets given a thickness"));
    }
}

const option_row option_rows_solid[] = {
    {make_pair, "check_solid", "full", ONE_WALL "check_solid = off", check_solid},
    {make_block, "repair", "volume", ONE_WALL "repair_voxel = 0.25", repair},
    {make_block, "repair_voxel", "0.4", ONE_WALL "repair = volume\nrepair_voxel = 0.2",
     repair_voxel},
    {make_tray, "sheet_thickness", "2", ONE_WALL "sheet_thickness = 1", sheet_thickness},
    {0},
};

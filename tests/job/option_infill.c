/* Options of the infill's patterns. The print lies around the middle of the bed. */
#include "option_row.h"

enum {
    SPARSE = ISO_ROLE_INTERNAL_INFILL,
    SOLID = ISO_ROLE_SOLID_INFILL,
    TOP = ISO_ROLE_TOP_SOLID_INFILL
};

/* Length along a direction, in degrees, as part of all that the role draws on a layer. */
static double along(const print *p, int role, int32_t layer, double angle) {
    double sum = 0, c = cos(angle / 180 * SHAPE_PI), s = sin(angle / 180 * SHAPE_PI);
    for (int32_t i = 0; i < p->move_count; i++) {
        const print_move *m = &p->move[i];
        if (!move_chosen(m, role, layer))
            continue;
        double aside = (m->bx - m->ax) * s - (m->by - m->ay) * c;
        sum += fabs(aside) < 0.01 * move_length(m) + 0.002 ? move_length(m) : 0;
    }
    return sum / print_length(p, role, layer);
}

/* In the first direction and in each of `count` - 1 more, evenly spread. */
static double along_all(const print *p, int role, int32_t layer, double angle, int count) {
    double sum = 0;
    for (int k = 0; k < count; k++) {
        double share = along(p, role, layer, angle + 180.0 * k / count);
        CHECK(share > 0.4 / count);
        sum += share;
    }
    return sum;
}

/* About as much as rectilinear, over all layers. */
static void same_volume(const change *c) {
    double a = print_length(c->a, SPARSE, -1), b = print_length(c->b, SPARSE, -1);
    CHECK_NEAR(a, b, 0.15 * a);
}

static void aligned(const change *c) {
    same_volume(c);
    CHECK(along(c->b, SPARSE, 3, 45) > 0.7 && along(c->b, SPARSE, 4, 45) > 0.7);
}

static void monotonic(const change *c) {
    same_volume(c);
    CHECK(along(c->b, SPARSE, 3, 135) > 0.7 && along(c->b, SPARSE, 4, 45) > 0.7);
}

static void grid(const change *c) {
    same_volume(c);
    CHECK(along_all(c->b, SPARSE, 4, 45, 2) > 0.7);
}

/* Where a layer's sparse lines lie, in a figure: their mean distance from a line through the
 * middle of the bed, squared. */
static double spread(const print *p, int32_t layer) {
    iso_vec2 center = iso_options_center(&p->options);
    double sum = 0;
    for (int32_t i = 0; i < p->move_count; i++) {
        const print_move *m = &p->move[i];
        double off = (m->ax + m->bx) / 2 - center.x + 0.3 * ((m->ay + m->by) / 2 - center.y);
        if (move_chosen(m, SPARSE, layer))
            sum += off * off * move_length(m);
    }
    return sum / print_length(p, SPARSE, layer);
}

static void check_moves_with_height(const print *p) {
    for (int32_t layer = 4; layer < 6; layer++)
        CHECK(fabs(spread(p, layer) / spread(p, layer + 1) - 1) > 0.002);
}

static void triangles(const change *c) {
    same_volume(c);
    CHECK(along_all(c->b, SPARSE, 4, 45, 3) > 0.7);
}

static void cubic(const change *c) {
    triangles(c);
    check_moves_with_height(c->b);
}

/* Neighbours lean to both sides of the direction, by 1/16 of a spacing less a bead's. */
static void line(const change *c) {
    same_volume(c);
    CHECK(along(c->b, SPARSE, 4, 45) < 0.2);
    double lean = atan((1 - 0.3) / 16) * 180 / SHAPE_PI;
    CHECK(along(c->b, SPARSE, 4, 45 + lean) > 0.25 && along(c->b, SPARSE, 4, 45 - lean) > 0.25);
}

static void concentric(const change *c) {
    same_volume(c);
    CHECK(along_all(c->b, SPARSE, 4, 0, 2) > 0.95);
}

static void honeycomb(const change *c) {
    same_volume(c);
    CHECK(along_all(c->b, SPARSE, 4, 15, 3) > 0.6);
    CHECK(along(c->b, SPARSE, 4, 15 + 60) > along(c->b, SPARSE, 4, 15));
    CHECK(along(c->b, SPARSE, 5, 15) > along(c->b, SPARSE, 5, 15 + 60));
}

static void honeycomb_3d(const change *c) {
    same_volume(c);
    CHECK(along(c->b, SPARSE, 4, 45) > 0.03 && along(c->b, SPARSE, 4, 135) > 0.03);
    CHECK(along(c->b, SPARSE, 4, 0) > 0.5 && along(c->b, SPARSE, 5, 90) > 0.5);
}

/* No direction of its own. */
static void gyroid(const change *c) {
    same_volume(c);
    for (int k = 0; k < 12; k++)
        CHECK(along(c->b, SPARSE, 4, 7 + 15 * k) < 0.35);
    check_moves_with_height(c->b);
}

static void hilbert(const change *c) {
    same_volume(c);
    CHECK(along_all(c->b, SPARSE, 4, 45, 2) > 0.6);
    CHECK(along_all(c->b, SPARSE, 5, 45, 2) > 0.6);
}

/* Most of it runs across the direction to the middle. */
static void archimedean(const change *c) {
    iso_vec2 center = iso_options_center(&c->b->options);
    double round = 0;
    same_volume(c);
    for (int32_t i = 0; i < c->b->move_count; i++) {
        const print_move *m = &c->b->move[i];
        double x = (m->ax + m->bx) / 2 - center.x, y = (m->ay + m->by) / 2 - center.y;
        double in = x * (m->bx - m->ax) + y * (m->by - m->ay);
        if (move_chosen(m, SPARSE, 4) && fabs(in) < 0.3 * hypot(x, y) * move_length(m))
            round += move_length(m);
    }
    CHECK(round > 0.6 * print_length(c->b, SPARSE, 4));
}

static void octagram(const change *c) {
    same_volume(c);
    CHECK(along_all(c->b, SPARSE, 4, 0, 4) > 0.95);
}

static void top_fill_pattern(const change *c) {
    int32_t last = c->b->level_count - 1;
    CHECK(along_all(c->b, TOP, last, 0, 2) > 0.95);
    CHECK(along(c->a, TOP, last, 0) + along(c->a, TOP, last, 90) < 0.3);
    double a = print_filament(c->a, TOP, last), b = print_filament(c->b, TOP, last);
    CHECK_NEAR(a, b, 0.05 * a);
}

/* No two lines in one go. */
static void monotonic_lines(const change *c) {
    int32_t last = c->b->level_count - 1;
    CHECK(print_runs(c->b, TOP, last) > 5 * print_runs(c->a, TOP, last));
    CHECK(along(c->b, TOP, last, 45 + 90 * (last % 2)) > 0.99);
}

/* Only the layer on the bed is such a surface; the others inside are as before. */
static void bottom_fill_pattern(const change *c) {
    CHECK(along_all(c->b, SOLID, 0, 0, 2) > 0.95);
    CHECK(along(c->b, SOLID, 1, 135) > 0.7);
    double a = print_filament(c->a, SOLID, 0), b = print_filament(c->b, SOLID, 0);
    CHECK_NEAR(a, b, 0.05 * a);
}

/* At 100 % a pattern that can fill solid does, others give way. */
static void solid_hilbert(const change *c) {
    CHECK(along_all(c->b, SPARSE, 4, 45, 2) > 0.7);
    CHECK(print_runs(c->b, SPARSE, 4) <= 12);
}

static void solid_gyroid(const change *c) {
    CHECK(same_places(c->a, c->b) && same_filament(c->a, c->b));
}

/* Ends that are not joined run on along the wall, 3 mm instead of none. */
static void infill_anchor(const change *c) {
    double a = print_length(c->a, SPARSE, 4), b = print_length(c->b, SPARSE, 4);
    CHECK_EQUAL(print_runs(c->a, SPARSE, 4), print_runs(c->b, SPARSE, 4));
    CHECK(b > a + 2 && b < a + 3 * 2 * print_runs(c->b, SPARSE, 4));
}

static void infill_anchor_max(const change *c) {
    CHECK(print_runs(c->a, SPARSE, 4) <= 3);
    CHECK(print_runs(c->b, SPARSE, 4) > 6);
    CHECK(print_length(c->b, SPARSE, 4) < print_length(c->a, SPARSE, 4));
}

/* From the second layer on pairs of 0.2 mm, drawn on the upper one; a third is too much for the
 * nozzle. */
static void infill_every_layers(const change *c) {
    CHECK_NEAR(print_length(c->a, SPARSE, 0), print_length(c->b, SPARSE, 0), 1e-6);
    for (int32_t layer = 1; layer + 1 < c->b->level_count; layer += 2) {
        double both = print_filament(c->a, SPARSE, layer) + print_filament(c->a, SPARSE, layer + 1);
        CHECK(print_length(c->b, SPARSE, layer) == 0);
        CHECK_NEAR(both, print_filament(c->b, SPARSE, layer + 1), 0.06 * both);
        CHECK(along(c->b, SPARSE, layer + 1, layer % 4 == 1 ? 135 : 45) > 0.7);
    }
}

/* The left half of the block is a modifier of its own. */
static char half_line[256];

static void make_half(shape *s) {
    shape half = {0};
    const char *path = print_path("half.stl");
    make_block(s);
    shape_box3 b = shape_bounds(s);
    shape_box(&half, b.min[0], b.min[1], b.min[2], (b.min[0] + b.max[0]) / 2, b.max[1], b.max[2]);
    CHECK(shape_write_binary(&half, path));
    shape_free(&half);
    snprintf(half_line, sizeof half_line, "%s fill_angle=0 fill_density=60%%", path);
}

static void modifiers(const change *c) {
    CHECK(along(c->a, SPARSE, 4, 45) > 0.7 && along(c->a, SPARSE, 4, 0) < 0.3);
    CHECK(along(c->b, SPARSE, 4, 45) > 0.15 && along(c->b, SPARSE, 4, 0) > 0.4);
    double a = print_filament(c->a, SPARSE, 4), b = print_filament(c->b, SPARSE, 4);
    CHECK_NEAR(1.5 * a, b, 0.15 * a); /* 30 % and 60 % against 30 % */
}

#define PLAIN "perimeters = 1\nfill_density = 30%\nsolid_infill_below_area = 0\n"
#define ROW(word, check)                                                                           \
    { make_block, "fill_pattern", word, PLAIN, check }

const option_row option_rows_infill[] = {
    ROW("alignedrectilinear", aligned),
    ROW("monotonic", monotonic),
    ROW("grid", grid),
    ROW("triangles", triangles),
    ROW("stars", triangles),
    ROW("cubic", cubic),
    ROW("line", line),
    ROW("concentric", concentric),
    ROW("honeycomb", honeycomb),
    ROW("3dhoneycomb", honeycomb_3d),
    ROW("gyroid", gyroid),
    ROW("hilbertcurve", hilbert),
    ROW("archimedeanchords", archimedean),
    ROW("octagramspiral", octagram),
    {make_block, "fill_pattern", "hilbertcurve", "fill_density = 100%", solid_hilbert},
    {make_block, "fill_pattern", "gyroid", "fill_density = 100%", solid_gyroid},
    {make_block, "top_fill_pattern", "concentric", "", top_fill_pattern},
    {make_block, "top_fill_pattern", "monotoniclines", "", monotonic_lines},
    {make_block, "bottom_fill_pattern", "concentric", "", bottom_fill_pattern},
    {make_block, "infill_anchor", "3",
     "fill_pattern = grid\nfill_density = 12%\nsolid_infill_below_area = 0\n"
     "infill_anchor_max = 3\ninfill_anchor = 0\n",
     infill_anchor},
    {make_block, "infill_anchor_max", "0", PLAIN "fill_pattern = grid\n", infill_anchor_max},
    {make_half, "modifiers", half_line, PLAIN, modifiers},
    {make_block, "infill_every_layers", "3",
     PLAIN "layer_height = 0.2\nfirst_layer_height = 0.2\ntop_solid_layers = 0\n"
           "bottom_solid_layers = 0\n",
     infill_every_layers},
    {0},
};

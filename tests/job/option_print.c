/* What the options of layers, walls, infill, speeds and widths do to the paths. */

#include "option_row.h"

static int role_of_walls(const print_move *m) {
    return m->role == ISO_ROLE_EXTERNAL_PERIMETER || m->role == ISO_ROLE_PERIMETER;
}

/* ---- layers ---- */

static void check_heights(const print *p, const double *height, int count) {
    double top = 0;
    for (int32_t i = 0; i < p->level_count; i++) {
        double own = height[i < count ? i : count - 1];
        top += own;
        CHECK_NEAR(own, p->level[i].height, 1e-9);
        CHECK_NEAR(top, p->level[i].z, 1e-9);
    }
}

static void layer_height(const change *c) {
    check_heights(c->b, (const double[]){0.35, 0.2}, 2);
    CHECK_EQUAL(14, c->b->level_count); /* 0.35 + 0.2 n + 0.1 < 3 */
}

static void first_layer_height(const change *c) {
    check_heights(c->b, (const double[]){0.15, 0.3}, 2); /* 50 % of 0.3 */
}

static void layer_heights(const change *c) {
    check_heights(c->b, (const double[]){0.3, 0.2, 0.1, 0.3}, 4);
}

static void gcode_resolution(const change *c) {
    CHECK(c->b->move_count < 0.8 * c->a->move_count);
    CHECK_NEAR(print_length(c->a, ISO_ROLE_EXTERNAL_PERIMETER, -1),
               print_length(c->b, ISO_ROLE_EXTERNAL_PERIMETER, -1),
               0.01 * print_length(c->a, ISO_ROLE_EXTERNAL_PERIMETER, -1));
}

static void z_offset(const change *c) {
    CHECK_EQUAL(c->a->level_count, c->b->level_count);
    for (int32_t i = 0; i < c->a->level_count; i++)
        CHECK_NEAR(c->a->level[i].z, c->b->level[i].z, 1e-9); /* as PrusaSlicer: left out */
    for (int32_t i = 0; i < c->a->move_count; i++)
        if (c->a->move[i].layer >= 0 && c->a->move[i].kind == MOVE_DRAW)
            CHECK_NEAR(c->a->move[i].bz + 0.25, c->b->move[i].bz, 1e-9);
}

/* ---- walls ---- */

static void perimeters(const change *c) {
    for (int32_t i = 0; i < c->b->level_count; i++) {
        double outer = print_length(c->b, ISO_ROLE_EXTERNAL_PERIMETER, i), inner = 0;
        double height = c->b->level[i].height, width = i ? 0.45 : 0.7;
        for (int w = 1; w < 5; w++)
            inner += outer - 8 * w * (width - height * (1 - SHAPE_PI / 4));
        CHECK_NEAR(inner, print_length(c->b, ISO_ROLE_PERIMETER, i), 0.05);
        CHECK_NEAR(print_length(c->a, ISO_ROLE_EXTERNAL_PERIMETER, i), outer, 1e-9);
    }
}

static int first_wall(const print *p, int32_t layer) {
    for (int32_t i = p->level[layer].first; i < p->level[layer + 1].first; i++)
        if (p->move[i].kind == MOVE_DRAW && role_of_walls(&p->move[i]))
            return p->move[i].role;
    return -1;
}

static void external_perimeters_first(const change *c) {
    for (int32_t i = 0; i < c->a->level_count; i++) {
        CHECK_EQUAL(ISO_ROLE_PERIMETER, first_wall(c->a, i));
        CHECK_EQUAL(ISO_ROLE_EXTERNAL_PERIMETER, first_wall(c->b, i));
    }
    CHECK_NEAR(print_length(c->a, -1, -1), print_length(c->b, -1, -1), 0.1);
}

/* ---- infill ---- */

enum { SPARSE = ISO_ROLE_INTERNAL_INFILL, SOLID = ISO_ROLE_SOLID_INFILL };

static void fill_density(const change *c) {
    double ratio = print_length(c->b, SPARSE, -1) / print_length(c->a, SPARSE, -1);
    CHECK(ratio > 1.7 && ratio < 2.3); /* 40 % to 20 % */
    CHECK_NEAR(print_length(c->a, ISO_ROLE_PERIMETER, -1),
               print_length(c->b, ISO_ROLE_PERIMETER, -1), 1e-9);
}

/* Length along a direction, in degrees, of sparse lines on a layer, as part of all of it. */
static double along(const print *p, int32_t layer, double angle) {
    double sum = 0;
    for (int32_t i = 0; i < p->move_count; i++) {
        const print_move *m = &p->move[i];
        if (!move_chosen(m, SPARSE, layer))
            continue;
        double cross = (m->bx - m->ax) * sin(angle / 180 * SHAPE_PI) -
                       (m->by - m->ay) * cos(angle / 180 * SHAPE_PI);
        sum += fabs(cross) < 0.01 * move_length(m) + 0.002 ? move_length(m) : 0;
    }
    return sum / print_length(p, SPARSE, layer);
}

static void fill_pattern(const change *c) {
    for (int32_t i = 3; i < 6; i++) {
        CHECK(along(c->a, i, i % 2 ? 135 : 45) > 0.7);
        CHECK(along(c->a, i, i % 2 ? 45 : 135) < 0.05);
        CHECK(along(c->b, i, 45) > 0.3 && along(c->b, i, 135) > 0.3);
        CHECK_NEAR(print_length(c->a, SPARSE, i), print_length(c->b, SPARSE, i),
                   0.25 * print_length(c->a, SPARSE, i));
    }
}

static void fill_angle(const change *c) {
    for (int32_t i = 3; i < 6; i++)
        CHECK(along(c->b, i, i % 2 ? 110 : 20) > 0.7);
}

static void infill_overlap(const change *c) {
    double a[4], b[4];
    CHECK(print_box(a, c->a, SOLID, 2) && print_box(b, c->b, SOLID, 2));
    double s = 0.45 - 0.3 * (1 - SHAPE_PI / 4); /* ends without a link go to the wall at least */
    for (int k = 0; k < 4; k++)                 /* 0.3 mm against 25 % of 0.45 mm */
        CHECK_NEAR(a[k] + (k < 2 ? -1 : 1) * (0.3 - s / 2), b[k], 0.02);
}

/* Those right over sparse fill are bridges. */
static int32_t solid_layers(const print *p, int32_t from, int32_t to) {
    int32_t count = 0;
    for (int32_t i = from; i < to; i++)
        count += print_length(p, SOLID, i) + print_length(p, ISO_ROLE_TOP_SOLID_INFILL, i) +
                     print_length(p, ISO_ROLE_BRIDGE_INFILL, i) >
                 0;
    return count;
}

static void top_solid_layers(const change *c) {
    CHECK_EQUAL(3, solid_layers(c->a, 5, c->a->level_count));
    CHECK_EQUAL(2, solid_layers(c->b, 5, c->b->level_count));
    CHECK(print_length(c->b, ISO_ROLE_TOP_SOLID_INFILL, c->b->level_count - 1) > 0);
}

static void bottom_solid_layers(const change *c) {
    CHECK_EQUAL(3, solid_layers(c->a, 0, 5));
    CHECK_EQUAL(1, solid_layers(c->b, 0, 5));
}

/* ---- skirt ---- */

static void skirts(const change *c) {
    CHECK_EQUAL(1, print_runs(c->a, ISO_ROLE_SKIRT, -1));
    CHECK_EQUAL(4, print_runs(c->b, ISO_ROLE_SKIRT, -1));
}

static void skirt_distance(const change *c) {
    double a[4], b[4];
    CHECK(print_box(a, c->a, ISO_ROLE_SKIRT, 0) && print_box(b, c->b, ISO_ROLE_SKIRT, 0));
    for (int k = 0; k < 4; k++) /* 2.5 mm against 6 mm */
        CHECK_NEAR(a[k] + (k < 2 ? 3.5 : -3.5), b[k], 0.01);
}

/* ---- speeds ---- */

/* All moves of a role above the first layer, or on it, go at this speed in mm/s. */
static void check_speed(const print *p, int role, int first, double speed) {
    int32_t count = 0, wrong = 0;
    for (int32_t i = 0; i < p->move_count; i++)
        if (move_chosen(&p->move[i], role, -1) && (p->move[i].layer == 0) == first) {
            count++;
            wrong += fabs(p->move[i].f - 60 * speed) > 0.51;
        }
    CHECK(count > 0);
    CHECK_EQUAL(0, wrong);
}

static void perimeter_speed(const change *c) {
    same_places(c->a, c->b);
    check_speed(c->a, ISO_ROLE_PERIMETER, 0, 60);
    check_speed(c->b, ISO_ROLE_PERIMETER, 0, 44);
    check_speed(c->b, ISO_ROLE_EXTERNAL_PERIMETER, 0, 22); /* 50 % of it */
    check_speed(c->b, SPARSE, 0, 80);
}

static void external_perimeter_speed(const change *c) {
    same_places(c->a, c->b);
    check_speed(c->a, ISO_ROLE_EXTERNAL_PERIMETER, 0, 30);
    check_speed(c->b, ISO_ROLE_EXTERNAL_PERIMETER, 0, 25);
    check_speed(c->b, ISO_ROLE_PERIMETER, 0, 60);
}

/* All walls of a part this small are small. */
static void small_perimeter_speed(const change *c) {
    same_places(c->a, c->b);
    check_speed(c->a, ISO_ROLE_EXTERNAL_PERIMETER, 0, 15);
    check_speed(c->b, ISO_ROLE_EXTERNAL_PERIMETER, 0, 24); /* 40 % of 60 */
    check_speed(c->b, ISO_ROLE_PERIMETER, 0, 24);
}

static void infill_speed(const change *c) {
    same_places(c->a, c->b);
    check_speed(c->a, SPARSE, 0, 80);
    check_speed(c->b, SPARSE, 0, 70);
    check_speed(c->b, SOLID, 0, 20);
}

static void solid_infill_speed(const change *c) {
    same_places(c->a, c->b);
    check_speed(c->a, SOLID, 0, 20);
    check_speed(c->b, SOLID, 0, 40); /* 50 % of 80 */
    check_speed(c->b, ISO_ROLE_TOP_SOLID_INFILL, 0, 15);
}

static void top_solid_infill_speed(const change *c) {
    same_places(c->a, c->b);
    check_speed(c->a, ISO_ROLE_TOP_SOLID_INFILL, 0, 15);
    check_speed(c->b, ISO_ROLE_TOP_SOLID_INFILL, 0, 12); /* 60 % of 20 */
}

static void first_layer_speed(const change *c) {
    same_places(c->a, c->b);
    check_speed(c->a, -1, 1, 30);
    check_speed(c->b, -1, 1, 22);
    check_speed(c->b, ISO_ROLE_SKIRT, 1, 22);
    check_speed(c->b, ISO_ROLE_PERIMETER, 0, 60);
}

/* In percent it is of each path's own speed. */
static void first_layer_speed_in_percent(const change *c) {
    check_speed(c->b, ISO_ROLE_PERIMETER, 1, 30);          /* of 60 */
    check_speed(c->b, ISO_ROLE_EXTERNAL_PERIMETER, 1, 15); /* of 30 */
    check_speed(c->b, SOLID, 1, 10);                       /* of 20 */
}

static void check_travel(const print *p, move_kind kind, double speed) {
    int32_t count = 0, wrong = 0;
    for (int32_t i = 0; i < p->move_count; i++)
        if (p->move[i].kind == kind && p->move[i].layer >= 0) {
            count++;
            wrong += p->move[i].f != 60 * speed;
        }
    CHECK(count > 0);
    CHECK_EQUAL(0, wrong);
}

static void travel_speed(const change *c) {
    same_places(c->a, c->b);
    check_travel(c->a, MOVE_TRAVEL, 130);
    check_travel(c->b, MOVE_TRAVEL, 99);
    check_travel(c->b, MOVE_RISE, 99);
}

static void travel_speed_z(const change *c) {
    same_places(c->a, c->b);
    check_travel(c->a, MOVE_RISE, 130);
    check_travel(c->b, MOVE_RISE, 9);
    check_travel(c->b, MOVE_TRAVEL, 130);
}

/* ---- widths ---- */

static void check_width(const print *p, int role, int first, double width) {
    double length = 0, filament = 0;
    int32_t wrong = 0;
    for (int32_t i = 0; i < p->move_count; i++)
        if (move_chosen(&p->move[i], role, -1) && (p->move[i].layer == 0) == first) {
            length += move_length(&p->move[i]);
            filament += p->move[i].e;
            wrong += fabs(p->move[i].width - width) > 5.1e-5;
        }
    double h = first ? 0.35 : 0.3, area = (width - h) * h + SHAPE_PI * h * h / 4;
    CHECK(length > 0);
    CHECK_EQUAL(0, wrong);
    CHECK_NEAR(area * length / (SHAPE_PI / 4 * 1.75 * 1.75), filament, 2e-4 * filament + 1e-4);
}

/* Lines of solid fills are fitted: their widths are near the option's. */
static void check_fitted(const print *p, int role, double width) {
    double sum = 0, length = 0;
    for (int32_t i = 0; i < p->move_count; i++)
        if (move_chosen(&p->move[i], role, -1) && p->move[i].layer > 0) {
            sum += p->move[i].width * move_length(&p->move[i]);
            length += move_length(&p->move[i]);
        }
    CHECK(length > 0);
    CHECK_NEAR(width, sum / length, 0.06 * width);
}

static void extrusion_width(const change *c) {
    check_width(c->a, ISO_ROLE_EXTERNAL_PERIMETER, 0, 0.45);
    check_width(c->b, ISO_ROLE_EXTERNAL_PERIMETER, 0, 0.54); /* 180 % of 0.3 */
    check_width(c->b, ISO_ROLE_PERIMETER, 0, 0.54);
    check_width(c->b, SPARSE, 0, 0.54);
    check_fitted(c->b, SOLID, 0.54);
    check_fitted(c->b, ISO_ROLE_TOP_SOLID_INFILL, 0.54);
}

static void first_layer_extrusion_width(const change *c) {
    check_width(c->a, ISO_ROLE_EXTERNAL_PERIMETER, 1, 0.7); /* 200 % of 0.35 */
    check_width(c->b, ISO_ROLE_EXTERNAL_PERIMETER, 1, 0.5);
    check_width(c->b, ISO_ROLE_PERIMETER, 1, 0.5);
    check_width(c->b, ISO_ROLE_SKIRT, 1, 0.5);
    check_width(c->b, ISO_ROLE_EXTERNAL_PERIMETER, 0, 0.45);
}

static void perimeter_extrusion_width(const change *c) {
    check_width(c->a, ISO_ROLE_PERIMETER, 0, 0.45);
    check_width(c->b, ISO_ROLE_PERIMETER, 0, 0.6);
    check_width(c->b, ISO_ROLE_EXTERNAL_PERIMETER, 0, 0.45);
}

static void external_perimeter_extrusion_width(const change *c) {
    check_width(c->b, ISO_ROLE_EXTERNAL_PERIMETER, 0, 0.4);
    check_width(c->b, ISO_ROLE_PERIMETER, 0, 0.45);
}

static void infill_extrusion_width(const change *c) {
    check_width(c->b, SPARSE, 0, 0.6);
    check_width(c->b, ISO_ROLE_PERIMETER, 0, 0.45);
}

static void solid_infill_extrusion_width(const change *c) {
    check_fitted(c->a, SOLID, 0.45);
    check_fitted(c->b, SOLID, 0.6);
    check_width(c->b, SPARSE, 0, 0.45);
}

static void top_infill_extrusion_width(const change *c) {
    check_fitted(c->a, ISO_ROLE_TOP_SOLID_INFILL, 0.4);
    check_fitted(c->b, ISO_ROLE_TOP_SOLID_INFILL, 0.6);
    check_fitted(c->b, SOLID, 0.45);
}

static void nozzle_diameter(const change *c) {
    check_width(c->b, ISO_ROLE_PERIMETER, 0, 0.6 * 1.125);
    check_width(c->b, SPARSE, 0, 0.6 * 1.125);
    check_fitted(c->b, ISO_ROLE_TOP_SOLID_INFILL, 0.6);
}

/* ---- the rows ---- */

const option_row option_rows_print[] = {
    {make_block, "layer_height", "0.2", "", layer_height},
    {make_block, "first_layer_height", "50%", "", first_layer_height},
    {make_block, "layer_heights", "0.3,0.2,0.1", "", layer_heights},
    {make_part, "gcode_resolution", "0.1", "", gcode_resolution},
    {make_block, "z_offset", "0.25", "", z_offset},
    {make_block, "perimeters", "5", "", perimeters},
    {make_block, "external_perimeters_first", "1", "", external_perimeters_first},
    {make_block, "fill_density", "40%", "perimeters = 1", fill_density},
    {make_block, "fill_pattern", "grid", "perimeters = 1\nfill_density = 30%", fill_pattern},
    {make_block, "fill_angle", "20", "perimeters = 1\nfill_density = 30%", fill_angle},
    {make_block, "infill_overlap", "0.3", "fill_angle = 0\nbottom_solid_layers = 4",
     infill_overlap},
    {make_block, "top_solid_layers", "2", "", top_solid_layers},
    {make_block, "bottom_solid_layers", "1", "", bottom_solid_layers},
    {make_block, "skirts", "4", "", skirts},
    {make_block, "skirt_distance", "2.5", "", skirt_distance},
    {make_block, "perimeter_speed", "44", STEADY, perimeter_speed},
    {make_block, "external_perimeter_speed", "25", STEADY, external_perimeter_speed},
    {make_small, "small_perimeter_speed", "40%", STEADY, small_perimeter_speed},
    {make_block, "infill_speed", "70", STEADY, infill_speed},
    {make_block, "solid_infill_speed", "50%", STEADY "top_solid_infill_speed = 15\n",
     solid_infill_speed},
    {make_block, "top_solid_infill_speed", "60%", STEADY, top_solid_infill_speed},
    {make_block, "first_layer_speed", "22", STEADY, first_layer_speed},
    {make_block, "first_layer_speed", "50%", STEADY, first_layer_speed_in_percent},
    {make_block, "travel_speed", "99", STEADY, travel_speed},
    {make_block, "travel_speed_z", "9", STEADY, travel_speed_z},
    {make_block, "extrusion_width", "180%", "", extrusion_width},
    {make_block, "first_layer_extrusion_width", "0.5", "", first_layer_extrusion_width},
    {make_block, "perimeter_extrusion_width", "200%", "", perimeter_extrusion_width},
    {make_block, "external_perimeter_extrusion_width", "0.4", "",
     external_perimeter_extrusion_width},
    {make_block, "infill_extrusion_width", "0.6", "", infill_extrusion_width},
    {make_block, "solid_infill_extrusion_width", "0.6", "", solid_infill_extrusion_width},
    {make_block, "top_infill_extrusion_width", "0.6", "", top_infill_extrusion_width},
    {make_block, "nozzle_diameter", "0.6", "first_layer_extrusion_width = 0", nozzle_diameter},
    {0},
};

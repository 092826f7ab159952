/* Shells and bridges. */
#include "option_row.h"

enum { SOLID = ISO_ROLE_SOLID_INFILL, SPARSE = ISO_ROLE_INTERNAL_INFILL };
enum { BRIDGE = ISO_ROLE_BRIDGE_INFILL, OVERHANG = ISO_ROLE_OVERHANG_PERIMETER };
enum { TOP = ISO_ROLE_TOP_SOLID_INFILL };

#define BLOCK                                                                                      \
    "layer_height = 0.2\nfirst_layer_height = 0.2\nperimeters = 1\n"                               \
    "solid_infill_below_area = 0\n" STEADY

/* Two pillars and a beam, 14 mm of air between them from z = 4 on: layer 20. */
static void make_portal(shape *s) {
    const uint8_t filled[] = {1, 0, 1, 1, 1, 1};
    const double x[] = {0, 6, 20, 26}, y[] = {0, 10}, z[] = {0, 4, 5};
    shape_cells(s, filled, 3, 1, 2);
    for (int64_t i = 0; i < 3 * s->count; i++) {
        float *p = s->triangle + 3 * i;
        p[0] = (float)x[(int)(p[0] + 0.5)];
        p[1] = (float)y[(int)(p[1] + 0.5)];
        p[2] = (float)z[(int)(p[2] + 0.5)];
    }
}

enum { BEAM = 20 };

/* A broad block and a thin tower. */
static void make_tower(shape *s) {
    shape_box(s, 0, 0, 0, 16, 16, 3);
    shape_box(s, 20, 0, 0, 27, 7, 3);
}

/* Four slopes, so flat that they step back by 1.7 mm a layer, above upright walls. */
static void make_roof(shape *s) {
    const double x[] = {16, 16, 2.5}, z[] = {0, 3, 4.6};
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 4; k++) {
            const double turn[4][2] = {{1, -1}, {1, 1}, {-1, 1}, {-1, -1}};
            const double *a = turn[k], *b = turn[(k + 1) % 4];
            shape_point low[] = {{a[0] * x[i], a[1] * x[i], z[i]},
                                 {b[0] * x[i], b[1] * x[i], z[i]}};
            shape_point high[] = {{b[0] * x[i + 1], b[1] * x[i + 1], z[i + 1]},
                                  {a[0] * x[i + 1], a[1] * x[i + 1], z[i + 1]}};
            shape_quad(s, low[0], low[1], high[0], high[1]);
            shape_point floor = {0, 0, 0}, tip = {0, 0, z[2]};
            if (i == 0)
                shape_add(s, floor, low[1], low[0]);
            else
                shape_add(s, tip, high[1], high[0]);
        }
}

/* Which layers have infill of the role, as a word of bits. */
static uint64_t layers_with(const print *p, int role) {
    uint64_t bits = 0;
    for (int32_t l = 0; l < p->level_count && l < 64; l++)
        if (print_runs(p, role, l) > 0)
            bits |= (uint64_t)1 << l;
    return bits;
}

static uint64_t bits_between(int from, int to) { /* to excluded */
    return (((uint64_t)1 << to) - 1) & ~(((uint64_t)1 << from) - 1);
}

/* 15 layers of 0.2 mm; under the top 0.7 mm take 4 layers, two of which there were anyway. */
static void top_solid_min_thickness(const change *c) {
    CHECK_EQUAL(15, c->a->level_count);
    CHECK(layers_with(c->a, SPARSE) == bits_between(1, 13));
    CHECK(layers_with(c->b, SPARSE) == bits_between(1, 11));
    CHECK(layers_with(c->b, TOP) == bits_between(14, 15));
}

/* Exactly 0.6 mm are 3 layers, however doubles add up. */
static void exact_thickness(const change *c) {
    CHECK(layers_with(c->b, SPARSE) == bits_between(1, 12));
}

/* The layers' own heights count: 0.1 mm each, 0.7 mm are 7. */
static void thickness_of_thin_layers(const change *c) {
    CHECK_EQUAL(30, c->b->level_count);
    CHECK(layers_with(c->b, SPARSE) == bits_between(1, 23));
}

static void bottom_solid_min_thickness(const change *c) {
    CHECK(layers_with(c->a, SPARSE) == bits_between(2, 14));
    CHECK(layers_with(c->b, SPARSE) == bits_between(4, 14));
}

/* 0 layers: no shell, whatever its thickness. */
static void no_shell_no_thickness(const change *c) {
    same_places(c->a, c->b);
    CHECK_EQUAL(0, print_runs(c->b, SOLID, -1) + print_runs(c->b, TOP, -1));
}

/* Strips of 0.04 mm next to the walls are solid only now. */
static void ensure_vertical_shell_thickness(const change *c) {
    CHECK_EQUAL(0, print_runs(c->a, TOP, 17) + print_runs(c->a, SOLID, 17));
    CHECK(print_runs(c->b, TOP, 17) > 0 && print_runs(c->b, BRIDGE, 17) > 0);
    CHECK(print_filament(c->b, SPARSE, 17) < 0.9 * print_filament(c->a, SPARSE, 17));
}

/* Layers 0, 5 and 10 have nothing sparse; they lie on sparse lines, as bridges do. */
static void solid_infill_every_layers(const change *c) {
    uint64_t every = (uint64_t)1 << 5 | (uint64_t)1 << 10;
    CHECK(layers_with(c->a, SPARSE) == bits_between(1, 14));
    CHECK(layers_with(c->b, SPARSE) == (bits_between(1, 14) & ~every));
    CHECK((layers_with(c->b, BRIDGE) & every) == every);
    CHECK((layers_with(c->a, BRIDGE) & every) == 0);
}

/* Within its wall the tower has 6 x 6 mm of infill at most, the block 15 x 15. */
static void solid_infill_below_area(const change *c) {
    double a[4], b[4];
    CHECK(print_box(a, c->a, SPARSE, 7) && print_box(b, c->b, SPARSE, 7));
    CHECK_NEAR(a[0], b[0], 1e-3);
    CHECK(a[2] - a[0] > 25 && b[2] - b[0] < 16);
    CHECK_EQUAL(0, print_runs(c->a, SOLID, 7));
    CHECK(print_box(b, c->b, SOLID, 7) && b[2] - b[0] < 7);
}

static void all_is_below_area(const change *c) {
    CHECK_EQUAL(0, print_runs(c->b, SPARSE, -1));
    CHECK_EQUAL(2, print_runs(c->b, SOLID, 7) > 0 ? 2 : 0);
}

/* The direction of long lines of bridges, from 0 to 180 degrees. */
static void check_direction(const print *p, double degrees) {
    int32_t count = 0, wrong = 0;
    for (int32_t i = 0; i < p->move_count; i++) {
        const print_move *m = &p->move[i];
        if (!move_chosen(m, BRIDGE, BEAM) || move_length(m) < 5)
            continue;
        double x = cos(degrees * SHAPE_PI / 180), y = sin(degrees * SHAPE_PI / 180);
        wrong += fabs((m->bx - m->ax) * y - (m->by - m->ay) * x) > 0.02 * move_length(m);
        count++;
    }
    CHECK(count > 10);
    CHECK_EQUAL(0, wrong);
}

static void bridge_angle(const change *c) {
    check_direction(c->a, 0); /* from pillar to pillar */
    check_direction(c->b, 60);
}

static void bridge_angle_along_x(const change *c) {
    check_direction(c->b, 0);
}

/* mm^2 of the beads of a role. */
static double section_of(const print *p, int role, int32_t layer) {
    double filament = SHAPE_PI / 4 * p->options.filament_diameter * p->options.filament_diameter;
    return print_filament(p, role, layer) * filament / print_length(p, role, layer);
}

static void check_thread(const print *p, double diameter) {
    double section = SHAPE_PI / 4 * diameter * diameter;
    CHECK_NEAR(section, section_of(p, BRIDGE, BEAM), 0.06 * section); /* lines are fitted */
    CHECK_NEAR(section, section_of(p, OVERHANG, BEAM), 0.002 * section);
}

static void bridge_flow_ratio(const change *c) {
    check_thread(c->a, 0.4);
    check_thread(c->b, 0.4 * sqrt(0.8));
    CHECK_NEAR(0.8, section_of(c->b, OVERHANG, BEAM) / section_of(c->a, OVERHANG, BEAM), 1e-3);
}

/* 0.45 mm wide and 0.2 high, as any other bead. */
static void thick_bridges(const change *c) {
    double flat = 0.25 * 0.2 + SHAPE_PI / 4 * 0.2 * 0.2;
    check_thread(c->a, 0.4);
    CHECK_NEAR(flat, section_of(c->b, BRIDGE, BEAM), 0.06 * flat);
    CHECK_NEAR(flat, section_of(c->b, OVERHANG, BEAM), 0.002 * flat);
    CHECK(strstr(c->a->text, "\n;HEIGHT:0.4\n") && !strstr(c->b->text, "\n;HEIGHT:0.4\n"));
}

static void flat_bridges_of_less_flow(const change *c) {
    double flat = 0.25 * 0.2 + SHAPE_PI / 4 * 0.2 * 0.2;
    CHECK_NEAR(flat, section_of(c->a, OVERHANG, BEAM), 0.002 * flat);
    CHECK_NEAR(0.7 * flat, section_of(c->b, OVERHANG, BEAM), 0.002 * flat);
}

/* One wall on both sides of the beam, 0.2 mm out of the pillars. */
static void overhangs(const change *c) {
    CHECK_NEAR(2 * 13.6, print_length(c->a, OVERHANG, BEAM), 0.02);
    CHECK_NEAR(2 * 13.6, print_length(c->a, OVERHANG, -1), 0.02);
    CHECK_EQUAL(0, print_runs(c->b, OVERHANG, -1));
    double walls = print_length(c->b, ISO_ROLE_EXTERNAL_PERIMETER, BEAM);
    CHECK_NEAR(walls, print_length(c->a, ISO_ROLE_EXTERNAL_PERIMETER, BEAM) + 2 * 13.6, 0.02);
}

static void bridge_speed(const change *c) {
    for (int k = 0; k < 2; k++) {
        const print *p = k ? c->b : c->a;
        int32_t count = 0, wrong = 0;
        for (int32_t i = 0; i < p->move_count; i++)
            if (move_chosen(&p->move[i], BRIDGE, -1) || move_chosen(&p->move[i], OVERHANG, -1)) {
                count++;
                wrong += p->move[i].f != 60 * (k ? 33 : 60);
            }
        CHECK(count > 20);
        CHECK_EQUAL(0, wrong);
    }
}

const option_row option_rows_shells[] = {
    {make_block, "top_solid_min_thickness", "0.7",
     BLOCK "top_solid_layers = 2\nbottom_solid_layers = 1", top_solid_min_thickness},
    {make_block, "top_solid_min_thickness", "0.6",
     BLOCK "top_solid_layers = 2\nbottom_solid_layers = 1", exact_thickness},
    {make_block, "top_solid_min_thickness", "0.7",
     BLOCK "top_solid_layers = 2\nbottom_solid_layers = 1\nlayer_height = 0.1\n"
           "first_layer_height = 0.1",
     thickness_of_thin_layers},
    {make_block, "top_solid_min_thickness", "0.7",
     BLOCK "top_solid_layers = 0\nbottom_solid_layers = 0", no_shell_no_thickness},
    {make_block, "bottom_solid_min_thickness", "0.7",
     BLOCK "top_solid_layers = 1\nbottom_solid_layers = 2", bottom_solid_min_thickness},
    {make_block, "bottom_solid_min_thickness", "0.7",
     BLOCK "top_solid_layers = 0\nbottom_solid_layers = 0", no_shell_no_thickness},
    {make_roof, "ensure_vertical_shell_thickness", "1",
     BLOCK "top_solid_layers = 1\nbottom_solid_layers = 1\nperimeters = 4\n"
           "extrusion_width = 0.45\n",
     ensure_vertical_shell_thickness},
    {make_block, "solid_infill_every_layers", "5",
     BLOCK "top_solid_layers = 1\nbottom_solid_layers = 1", solid_infill_every_layers},
    {make_tower, "solid_infill_below_area", "70", BLOCK, solid_infill_below_area},
    {make_tower, "solid_infill_below_area", "1000", BLOCK, all_is_below_area},
    {make_portal, "bridge_angle", "60", BLOCK, bridge_angle},
    {make_portal, "bridge_angle", "180", BLOCK, bridge_angle_along_x},
    {make_portal, "bridge_flow_ratio", "0.8", BLOCK, bridge_flow_ratio},
    {make_portal, "bridge_flow_ratio", "0.7", BLOCK "thick_bridges = 0", flat_bridges_of_less_flow},
    {make_portal, "thick_bridges", "0", BLOCK, thick_bridges},
    {make_portal, "overhangs", "0", BLOCK, overhangs},
    {make_portal, "bridge_speed", "33", BLOCK, bridge_speed},
    {0},
};

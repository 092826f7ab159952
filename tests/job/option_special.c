/* What ironing, the spiral vase, retraction in the finer points, and arcs do. */
#include "option_row.h"
#include "solids.h"

static void ironing(const change *c) {
    CHECK_NEAR(0, print_length(c->a, ISO_ROLE_IRONING, -1), 0);
    int32_t top = c->b->level_count - 1;
    double area = 16 - 2 * 3 * 0.45, length = print_length(c->b, ISO_ROLE_IRONING, top);
    CHECK_NEAR(area * area / 0.1, length, 0.15 * area * area / 0.1);
    CHECK_NEAR(length, print_length(c->b, ISO_ROLE_IRONING, -1), 1e-6);
}

static void ironing_spacing(const change *c) {
    double a = print_length(c->a, ISO_ROLE_IRONING, -1),
           b = print_length(c->b, ISO_ROLE_IRONING, -1);
    CHECK_NEAR(a / 2, b, 0.03 * a);
}

static void ironing_flowrate(const change *c) {
    double a = print_filament(c->a, ISO_ROLE_IRONING, -1);
    CHECK(a > 0);
    CHECK_NEAR(2 * a, print_filament(c->b, ISO_ROLE_IRONING, -1), 1e-3 * a);
}

static void ironing_speed(const change *c) {
    int32_t seen = 0;
    same_places(c->a, c->b);
    for (int32_t i = 0; i < c->b->move_count; i++)
        if (move_chosen(&c->b->move[i], ISO_ROLE_IRONING, -1)) {
            seen++;
            CHECK_NEAR(22 * 60, c->b->move[i].f, 0.5);
            CHECK_NEAR(15 * 60, c->a->move[i].f, 0.5);
        }
    CHECK(seen > 10);
}

/* All tops on the stair; the highest alone; every solid layer. */
static int32_t ironed_layers(const print *p) {
    int32_t n = 0;
    for (int32_t i = 0; i < p->level_count; i++)
        n += print_length(p, ISO_ROLE_IRONING, i) > 1;
    return n;
}

static void make_stair(shape *s) {
    shape_box(s, 0, 0, 0, 12, 12, 1.5);
    shape_box(s, 2, 16, 0, 10, 26, 3);
}

static void ironing_type_topmost(const change *c) {
    CHECK_EQUAL(2, ironed_layers(c->a));
    CHECK_EQUAL(1, ironed_layers(c->b));
    CHECK(print_length(c->b, ISO_ROLE_IRONING, c->b->level_count - 1) > 1);
}

static void ironing_type_solid(const change *c) {
    CHECK_EQUAL(2, ironed_layers(c->a));
    CHECK(ironed_layers(c->b) > 5);
}

/* Above the bottom no travel, no step: z grows along the wall, and the wall's volume is a turn's
 * less half of one at the start. */
static void spiral_vase(const change *c) {
    double z = 0, drawn[2] = {0, 0};
    for (int k = 0; k < 2; k++) {
        const print *p = k ? c->b : c->a;
        for (int32_t i = 0; i < p->move_count; i++) {
            const print_move *m = &p->move[i];
            if (m->layer < 4)
                continue;
            drawn[k] += m->kind == MOVE_DRAW ? m->e : 0;
            if (k == 0)
                continue;
            CHECK(m->kind == MOVE_DRAW || m->bz >= 2.95 || m->layer < 4 || move_length(m) < 0.02);
            if (m->kind == MOVE_DRAW) {
                CHECK(m->bz >= z - 1e-9);
                CHECK(m->bz - m->az < 0.12);
                z = m->bz;
            }
        }
    }
    CHECK_NEAR(drawn[0], drawn[1], 0.02 * drawn[0]);
    CHECK(z > 2.8);
}

/* ---- retraction ---- */

static double pulled_back(const print *p) {
    double sum = 0;
    for (int32_t i = 0; i < p->move_count; i++)
        sum += fmax(0, -p->move[i].e);
    return sum;
}

static int32_t lines_with(const print *p, const char *text) {
    int32_t n = 0;
    for (const char *at = p->text; (at = strstr(at, text)); at++)
        n++;
    return n;
}

/* Every retraction goes along the path just printed, as long as it takes at the speed of a wipe. */
static void wipe(const change *c) {
    CHECK_EQUAL(0, lines_with(c->a, ";WIPE_START"));
    CHECK(lines_with(c->b, ";WIPE_START") > 10);
    CHECK_EQUAL(lines_with(c->b, ";WIPE_START"), lines_with(c->b, ";WIPE_END"));
    CHECK_NEAR(pulled_back(c->a), pulled_back(c->b), 1e-3);
    double length = 0, whole = 2.0 / 40 * 0.8 * 130;
    for (int32_t i = 0; i < c->b->move_count; i++) {
        const print_move *m = &c->b->move[i];
        int wiping = m->kind == MOVE_TRAVEL && m->e < 0;
        length = wiping ? length + move_length(m) : 0;
        CHECK(length < whole + 0.01);
        if (wiping)
            CHECK_NEAR(0.8 * 130 * 60, m->f, 0.5);
    }
}

static void retract_before_wipe(const change *c) {
    int32_t halves[2] = {0, 0};
    for (int k = 0; k < 2; k++) {
        const print *p = k ? c->b : c->a;
        for (int32_t i = 0; i < p->move_count; i++)
            halves[k] += p->move[i].kind == MOVE_FILAMENT && fabs(p->move[i].e + 1) < 1.1e-5;
    }
    CHECK_EQUAL(0, halves[0]);
    CHECK(halves[1] >= lines_with(c->b, ";WIPE_START"));
    CHECK_NEAR(pulled_back(c->a), pulled_back(c->b), 1e-3);
}

static void retract_layer_change(const change *c) {
    for (int32_t i = 1; i < c->b->level_count; i++) {
        int32_t k = c->b->level[i].first, back = 0;
        while (c->b->move[k].kind != MOVE_DRAW)
            k++;
        while (k-- > 0 && c->b->move[k].kind != MOVE_DRAW)
            back = back || c->b->move[k].e < 0;
        CHECK(back);
    }
    CHECK(c->b->report.print.retractions > c->a->report.print.retractions);
}

/* Highest that the nozzle is over each layer's top. */
static double lift_on(const print *p, int32_t layer) {
    double most = 0;
    for (int32_t i = 0; i < p->move_count; i++)
        if (p->move[i].layer == layer && p->move[i].kind == MOVE_TRAVEL)
            most = fmax(most, p->move[i].bz - p->level[layer].z);
    return most;
}

static void check_lifts(const change *c, double low, double high) {
    int32_t some = 0;
    for (int32_t i = 0; i < c->b->level_count; i++) {
        double z = c->b->level[i].z, lift = lift_on(c->b, i);
        CHECK_NEAR(z < low || z > high ? 0 : lift_on(c->a, i), lift, 1e-6);
        some += lift > 0.3;
    }
    CHECK(some > 1);
}

static void retract_lift_above(const change *c) {
    check_lifts(c, 1.5, 1e9);
}

static void retract_lift_below(const change *c) {
    check_lifts(c, 0, 1.5);
}

/* ---- arcs ---- */

static void make_drum(shape *s) {
    const solid_ring ring[] = {{1, 0}, {1, 3}};
    solid_star(s, 9, 9, 0, 0, ring, 2, 180);
}

static void arc_fitting(const change *c) {
    CHECK_EQUAL(0, lines_with(c->a, "\nG2 ") + lines_with(c->a, "\nG3 "));
    CHECK(lines_with(c->b, "\nG2 ") + lines_with(c->b, "\nG3 ") > 3 * c->b->level_count);
    CHECK(c->b->size < 0.8 * (double)c->a->size);
    CHECK_NEAR(c->a->report.print.filament_mm, c->b->report.print.filament_mm,
               1e-3 * c->a->report.print.filament_mm);
    CHECK_NEAR(c->a->machine.extruded_along_paths, c->b->machine.extruded_along_paths,
               1e-3 * c->a->machine.extruded_along_paths);
}

#define VASE "perimeters = 1\nfill_density = 0\ntop_solid_layers = 0\nskirts = 0\n"
#define IRON STEADY "ironing = 1\n"

const option_row option_rows_special[] = {
    {make_block, "ironing", "1", "", ironing},
    {make_block, "ironing_spacing", "0.2", IRON, ironing_spacing},
    {make_block, "ironing_flowrate", "30%", IRON, ironing_flowrate},
    {make_block, "ironing_speed", "22", IRON, ironing_speed},
    {make_stair, "ironing_type", "topmost", IRON, ironing_type_topmost},
    {make_stair, "ironing_type", "solid", IRON, ironing_type_solid},
    {0},
};

/* Moves that the checks of any print have no notion of. */
const option_row option_rows_moved[] = {
    {make_small, "spiral_vase", "1", VASE, spiral_vase},
    {make_part, "wipe", "1", STEADY, wipe},
    {make_part, "retract_before_wipe", "50%", STEADY "wipe = 1\n", retract_before_wipe},
    {make_part, "retract_layer_change", "1", STEADY, retract_layer_change},
    {make_part, "retract_lift_above", "1.5", "retract_lift = 0.5", retract_lift_above},
    {make_part, "retract_lift_below", "1.5", "retract_lift = 0.5", retract_lift_below},
    {make_drum, "arc_fitting", "emit_center", "gcode_resolution = 0.05", arc_fitting},
    {0},
};

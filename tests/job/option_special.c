/* What ironing and the spiral vase do. */
#include "option_row.h"

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

const option_row option_rows_vase[] = {
    {make_small, "spiral_vase", "1", VASE, spiral_vase},
    {0},
};

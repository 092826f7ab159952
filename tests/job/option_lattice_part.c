/* Options of a lattice that is a part of its own, as far as a print follows them. */
#include "option_row.h"

/* From the middle of what is drawn to the nearest bead's middle, on a layer. */
static double opening(const print *p, int32_t layer) {
    double low[2] = {1e9, 1e9}, high[2] = {-1e9, -1e9}, least = 1e9;
    for (int32_t i = 0; i < p->move_count; i++) {
        const print_move *m = &p->move[i];
        if (m->kind != MOVE_DRAW || !move_chosen(m, ISO_ROLE_EXTERNAL_PERIMETER, layer))
            continue;
        low[0] = fmin(low[0], m->bx), high[0] = fmax(high[0], m->bx);
        low[1] = fmin(low[1], m->by), high[1] = fmax(high[1], m->by);
    }
    double x = (low[0] + high[0]) / 2, y = (low[1] + high[1]) / 2;
    for (int32_t i = 0; i < p->move_count; i++) {
        const print_move *m = &p->move[i];
        if (m->kind != MOVE_DRAW || m->layer != layer)
            continue;
        double dx = m->bx - m->ax, dy = m->by - m->ay, square = dx * dx + dy * dy;
        double t = square > 0 ? ((x - m->ax) * dx + (y - m->ay) * dy) / square : 0;
        t = fmin(1, fmax(0, t));
        least = fmin(least, hypot(m->ax + t * dx - x, m->ay + t * dy - y));
    }
    return least;
}

/* Holes of this radius through what is printed below the skin's height, and nowhere else. */
static void check_holes(const print *p, double radius, double skin) {
    for (int32_t i = 0; i < p->level_count; i++) {
        double bottom = i > 0 ? p->level[i - 1].z : 0, open = opening(p, i);
        if (bottom < skin - 1e-6)
            CHECK_NEAR(radius + 0.25, open, 0.2); /* half a bead, more or less by the first layer */
        else
            CHECK(open < 1.2);
    }
}

static void drilled(const change *c) {
    CHECK(opening(c->a, 0) < 1.2);
    check_holes(c->b, 1.5, 1);
}

/* The fourth layer begins where the skin ends. */
static void drilled_to_the_layer(const change *c) {
    CHECK(opening(c->a, 0) < 1.2);
    check_holes(c->b, 1.5, 0.34);
}

static void wider(const change *c) {
    check_holes(c->a, 1.5, 1);
    check_holes(c->b, 3, 1);
}

static void the_same(const change *c) {
    if (same_places(c->a, c->b))
        same_filament(c->a, c->b);
}

#define SKINNED STEADY "skirts = 0\nperimeters = 2\nfill_density = 60%\nlattice_skin = 1\n"

const option_row option_rows_lattice_part[] = {
    {make_block, "lattice_drain", "0,0", SKINNED, drilled},
    {make_block, "lattice_drain_diameter", "6", SKINNED "lattice_drain = 0,0\n", wider},
    {make_block, "lattice_skin", "1",
     STEADY "skirts = 0\nperimeters = 2\nfill_density = 60%\nlattice_drain = 0,0\n", drilled},
    {make_block, "lattice_skin", "0.34",
     STEADY "skirts = 0\nperimeters = 2\nfill_density = 60%\nlattice_drain = 0,0\n"
            "first_layer_height = 0.1\nlayer_height = 0.12\n",
     drilled_to_the_layer},
    {make_block, "lattice_open", "1", SKINNED, the_same},
    {0},
};

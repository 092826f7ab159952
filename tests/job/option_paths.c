/* What the options of seams, order and travel do. */
#include "option_row.h"
#include "solids.h"

/* Lobes with deep notches between them. */
static void make_clover(shape *s) {
    const solid_ring ring[] = {{1, 0}, {1, 3}};
    solid_star(s, 9, 3, 0.65, 0, ring, 2, 96);
}

static int is_wall(const print_move *m) {
    return m->role == ISO_ROLE_EXTERNAL_PERIMETER || m->role == ISO_ROLE_PERIMETER;
}

/* ---- seams ---- */

/* The first external wall of a layer begins there. */
static const print_move *seam_of(const print *p, int32_t layer) {
    for (int32_t i = p->level[layer].first; i < p->level[layer + 1].first; i++)
        if (p->move[i].kind == MOVE_DRAW && p->move[i].role == ISO_ROLE_EXTERNAL_PERIMETER)
            return &p->move[i];
    CHECK(layer < 0);
    return &p->move[0];
}

/* How far apart the seams of a print are, but for the first layer's wider beads. */
static double spread_of_seams(const print *p) {
    double low[2] = {1e9, 1e9}, high[2] = {-1e9, -1e9};
    for (int32_t i = 1; i < p->level_count; i++) {
        const print_move *m = seam_of(p, i);
        double at[2] = {m->ax, m->ay};
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], at[k]);
            high[k] = fmax(high[k], at[k]);
        }
    }
    return hypot(high[0] - low[0], high[1] - low[1]);
}

static void seam_rear(const change *c) {
    double box[4];
    for (int32_t i = 0; i < c->b->level_count; i++) {
        CHECK(print_box(box, c->b, ISO_ROLE_EXTERNAL_PERIMETER, i));
        CHECK_NEAR(box[3], seam_of(c->b, i)->ay, 1e-9);
    }
}

static void seam_random(const change *c) {
    CHECK(spread_of_seams(c->a) < 0.001); /* aligned */
    CHECK(spread_of_seams(c->b) > 5);
    for (int32_t i = 2; i < c->b->level_count; i++)
        CHECK(seam_of(c->b, i)->ax != seam_of(c->b, i - 1)->ax ||
              seam_of(c->b, i)->ay != seam_of(c->b, i - 1)->ay);
    CHECK_NEAR(print_length(c->a, ISO_ROLE_EXTERNAL_PERIMETER, -1),
               print_length(c->b, ISO_ROLE_EXTERNAL_PERIMETER, -1), 0.1);
}

static double travel_length(const print *p) {
    double sum = 0;
    for (int32_t i = 0; i < p->move_count; i++)
        if (p->move[i].kind == MOVE_TRAVEL && p->move[i].layer > 0)
            sum += move_length(&p->move[i]);
    return sum;
}

static void seam_nearest(const change *c) {
    CHECK(travel_length(c->b) < travel_length(c->a));
    CHECK(spread_of_seams(c->a) < 0.1);
    CHECK(spread_of_seams(c->b) > 1);
}

/* ---- order ---- */

static void infill_first(const change *c) {
    for (int32_t l = 0; l < c->a->level_count; l++)
        for (int which = 0; which < 2; which++) {
            const print *p = which ? c->b : c->a;
            int wall = 0, fill = 0, wrong = 0;
            for (int32_t i = p->level[l].first; i < p->level[l + 1].first; i++) {
                const print_move *m = &p->move[i];
                if (m->kind != MOVE_DRAW || m->role == ISO_ROLE_SKIRT)
                    continue;
                wrong += is_wall(m) ? !which && fill : which && wall;
                *(is_wall(m) ? &wall : &fill) = 1;
            }
            CHECK(wall && fill);
            CHECK_EQUAL(0, wrong);
        }
}

/* ---- travel ---- */

/* Does it leave the model's section, or come to its edge? */
static int leaves(const print_move *m, const double (*piece)[4], int64_t count) {
    for (int k = 1; k < 40; k++) {
        double t = k / 40.0, x = m->ax + t * (m->bx - m->ax), y = m->ay + t * (m->by - m->ay);
        if (section_winding(piece, count, x, y) == 0)
            return 1;
    }
    return 0;
}

typedef struct travels {
    int32_t outside;          /* that leave the clover */
    int32_t pulled_inside;    /* retracted though they don't, and are long */
    int32_t unpulled_outside; /* not retracted though they do, and are long */
    int32_t pulled, unpulled; /* long ones in all */
} travels;

static travels travels_of(const print *p) {
    travels sum = {0};
    shape s = {0};
    make_clover(&s);
    double(*piece)[4] = malloc((size_t)s.count * sizeof *piece);
    int64_t count = shape_section(piece, &s, 1.5);
    for (int64_t i = 0; i < count; i++) /* the box around it is centred on the bed */
        for (int k = 0; k < 4; k++) {
            shape_box3 box = shape_bounds(&s);
            piece[i][k] += 100 - (box.min[k % 2] + box.max[k % 2]) / 2;
        }
    int back = 0;
    for (int32_t i = 0; i < p->move_count; i++) {
        const print_move *m = &p->move[i];
        if (m->kind == MOVE_FILAMENT && m->e != 0)
            back = m->e < 0;
        if (m->kind != MOVE_TRAVEL || m->layer < 1)
            continue;
        int out = leaves(m, (const double(*)[4])piece, count), is_long = move_length(m) > 2;
        sum.outside += out;
        sum.pulled += is_long && back;
        sum.unpulled += is_long && !back;
        sum.pulled_inside += is_long && back && !out;
        sum.unpulled_outside += is_long && !back && out;
    }
    free(piece);
    shape_free(&s);
    return sum;
}

/* Off: each long travel retracts. On, as usual: those inside don't. */
static void only_retract_when_crossing(const change *c) {
    travels on = travels_of(c->a), off = travels_of(c->b);
    CHECK(on.unpulled > 0);
    CHECK_EQUAL(0, on.unpulled_outside);
    CHECK_EQUAL(0, off.unpulled);
    CHECK(off.pulled_inside > 0 && off.pulled > on.pulled);
}

static void avoid_crossing(const change *c) {
    CHECK(travels_of(c->a).outside > 0);
    CHECK_EQUAL(0, travels_of(c->b).outside);
    CHECK(travel_length(c->b) > travel_length(c->a));
}

/* None is that short, so all is as if there were no ways around. */
static void no_detour(const change *c) {
    CHECK_EQUAL(0, travels_of(c->a).outside);
    CHECK(travels_of(c->b).outside > 0);
    CHECK(travel_length(c->b) < travel_length(c->a));
}

#define ALWAYS "only_retract_when_crossing_perimeters = 0\n"
#define SPARSE "fill_density = 15%\nperimeters = 1\n"

const option_row option_rows_paths[] = {
    {make_block, "seam_position", "rear", "", seam_rear},
    {make_clover, "seam_position", "rear", "", seam_rear},
    {make_block, "seam_position", "random", "", seam_random},
    {make_clover, "seam_position", "nearest", "", seam_nearest},
    {make_block, "infill_first", "1", "", infill_first},
    {make_clover, "only_retract_when_crossing_perimeters", "0", SPARSE, only_retract_when_crossing},
    {make_clover, "avoid_crossing_perimeters", "1", SPARSE ALWAYS, avoid_crossing},
    {make_clover, "avoid_crossing_perimeters_max_detour", "0.001",
     SPARSE ALWAYS "avoid_crossing_perimeters = 1", no_detour},
    {make_clover, "avoid_crossing_perimeters_max_detour", "0.01%",
     SPARSE ALWAYS "avoid_crossing_perimeters = 1", no_detour},
    {0},
};

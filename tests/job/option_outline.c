/* What the options of outlines and of what is drawn around them do. */
#include "option_row.h"

static double skirt_length(const print *p, int32_t layer) {
    return print_length(p, ISO_ROLE_SKIRT, layer);
}

static void skirt_height(const change *c) {
    for (int32_t i = 0; i < c->b->level_count; i++)
        CHECK_NEAR(i < 4 ? skirt_length(c->b, 0) : 0, skirt_length(c->b, i), 0.01);
    CHECK_NEAR(0, skirt_length(c->a, 1), 0);
}

static void draft_shield(const change *c) {
    for (int32_t i = 0; i < c->b->level_count; i++)
        CHECK_NEAR(skirt_length(c->b, 0), skirt_length(c->b, i), 0.01);
    CHECK(skirt_length(c->b, 0) > 0);
}

static void min_skirt_length(const change *c) {
    double before = print_filament(c->a, ISO_ROLE_SKIRT, 0);
    double after = print_filament(c->b, ISO_ROLE_SKIRT, 0);
    CHECK(before < 20 && after >= 20 && after < 20 + 2 * before);
}

/* The brim's beads reach this far from the block. */
static void check_reach(const print *p, double reach) {
    double skin[4], brim[4];
    CHECK(print_box(skin, p, ISO_ROLE_EXTERNAL_PERIMETER, 0));
    CHECK(print_box(brim, p, ISO_ROLE_SKIRT, 0));
    double half = 0.7 / 2; /* of a bead on the first layer */
    CHECK_NEAR(reach, skin[0] - half - (brim[0] - half), 0.7);
    CHECK_NEAR(reach, brim[3] + half - (skin[3] + half), 0.7);
}

static void brim_width(const change *c) {
    CHECK_NEAR(0, skirt_length(c->a, 0), 0);
    CHECK_NEAR(0, skirt_length(c->b, 1), 0);
    check_reach(c->b, 5);
    double d = 0.7 / 2, expected = 0; /* 64 + 2 pi d each */
    for (int i = 0; i < 8; i++, d += 0.7 - 0.35 * (1 - SHAPE_PI / 4))
        expected += 64 + 2 * SHAPE_PI * d;
    CHECK_NEAR(expected, skirt_length(c->b, 0), 0.005 * expected);
}

static void brim_separation(const change *c) {
    double a[4], b[4];
    CHECK(print_box(a, c->a, ISO_ROLE_SKIRT, 0) && print_box(b, c->b, ISO_ROLE_SKIRT, 0));
    CHECK_NEAR(a[0] - 0.8, b[0], 1e-3);
    CHECK_NEAR(a[3] + 0.8, b[3], 1e-3);
}

/* The block is whole: inside it is no brim. */
static void brim_type(const change *c) {
    CHECK(skirt_length(c->a, 0) > 0);
    CHECK_NEAR(0, skirt_length(c->b, 0), 0);
}

static void check_grown(const change *c, int32_t layer, double by) {
    double a[4], b[4];
    CHECK(print_box(a, c->a, ISO_ROLE_EXTERNAL_PERIMETER, layer));
    CHECK(print_box(b, c->b, ISO_ROLE_EXTERNAL_PERIMETER, layer));
    for (int i = 0; i < 4; i++)
        CHECK_NEAR(a[i] + (i < 2 ? -by : by), b[i], 1e-3);
}

static void xy_size_compensation(const change *c) {
    check_grown(c, 0, 0.2);
    check_grown(c, 5, 0.2);
}

static void elefant_foot_compensation(const change *c) {
    check_grown(c, 0, -0.2);
    check_grown(c, 1, 0);
}

/* A block with a square hole: 16 mm around 6 mm. */
static void make_frame(shape *s) {
    for (int i = 0; i < 4; i++) {
        double x[2][2] = {{0, 16}, {5, 11}};
        shape_point o[4], h[4];
        for (int k = 0; k < 4; k++) {
            o[k] = (shape_point){x[0][k == 1 || k == 2], x[0][k >= 2], 0};
            h[k] = (shape_point){x[1][k == 1 || k == 2], x[1][k >= 2], 0};
        }
        int j = (i + 1) % 4;
        shape_point oi = o[i], oj = o[j], hi = h[i], hj = h[j];
        shape_point Oi = oi, Oj = oj, Hi = hi, Hj = hj;
        Oi.z = Oj.z = Hi.z = Hj.z = 3;
        shape_quad(s, oi, oj, Oj, Oi);
        shape_quad(s, hj, hi, Hi, Hj);
        shape_quad(s, Oi, Oj, Hj, Hi);
        shape_quad(s, oj, oi, hi, hj);
    }
}

static double shortest_loop(const print *p, int32_t layer) {
    double best = 1e9, sum = 0;
    int32_t run = -1;
    for (int32_t i = 0; i < p->move_count; i++) {
        const print_move *m = &p->move[i];
        if (m->kind != MOVE_DRAW || m->layer != layer || m->role != ISO_ROLE_EXTERNAL_PERIMETER)
            continue;
        if (m->run != run && sum > 0) {
            best = fmin(best, sum);
            sum = 0;
        }
        run = m->run;
        sum += move_length(m);
    }
    return fmin(best, sum);
}

static void xy_hole_compensation(const change *c) {
    check_grown(c, 3, 0);
    CHECK_NEAR(shortest_loop(c->a, 3) + 8 * 0.3, shortest_loop(c->b, 3), 0.3);
}

/* Half of the walk along the skin goes across it. */
static double roughness(const print *p, int32_t layer) {
    double box[4], off = 0;
    int32_t n = 0;
    CHECK(print_box(box, p, ISO_ROLE_EXTERNAL_PERIMETER, layer));
    for (int32_t i = 0; i < p->move_count; i++) {
        const print_move *m = &p->move[i];
        if (m->kind != MOVE_DRAW || m->layer != layer || m->role != ISO_ROLE_EXTERNAL_PERIMETER)
            continue;
        double x = fmin(fabs(m->bx - box[0]), fabs(m->bx - box[2]));
        double y = fmin(fabs(m->by - box[1]), fabs(m->by - box[3]));
        off += fmin(x, y);
        n++;
    }
    return n ? off / n : 0;
}

static void fuzzy_skin(const change *c) {
    CHECK_NEAR(0, roughness(c->b, 0), 1e-3);
    CHECK_NEAR(0, roughness(c->a, 4), 1e-3);
    CHECK_NEAR(0.3, roughness(c->b, 4), 0.1);
}

static void fuzzy_skin_thickness(const change *c) {
    CHECK_NEAR(roughness(c->a, 4) / 3, roughness(c->b, 4), 0.05);
}

static void fuzzy_skin_point_dist(const change *c) {
    int32_t count[2] = {0, 0};
    for (int k = 0; k < 2; k++) {
        const print *p = k ? c->b : c->a;
        for (int32_t i = 0; i < p->move_count; i++)
            count[k] += move_chosen(&p->move[i], ISO_ROLE_EXTERNAL_PERIMETER, 4);
    }
    CHECK_NEAR(2.0 * count[0], count[1], 0.3 * count[0]);
}

#define BRIM "skirts = 0\nbrim_width = 4\n"
#define FUZZY "fuzzy_skin = external\n"

const option_row option_rows_outline[] = {
    {make_block, "skirt_height", "4", "skirts = 2", skirt_height},
    {make_block, "draft_shield", "enabled", "", draft_shield},
    {make_block, "min_skirt_length", "20", "", min_skirt_length},
    {make_block, "brim_width", "5", "skirts = 0", brim_width},
    {make_block, "brim_type", "inner_only", BRIM, brim_type},
    {make_block, "brim_separation", "0.8", BRIM, brim_separation},
    {0},
};

/* They move outlines: the prints can't be held against the model. */
const option_row option_rows_bent[] = {
    {make_block, "xy_size_compensation", "0.2", "", xy_size_compensation},
    {make_frame, "xy_hole_compensation", "0.3", "", xy_hole_compensation},
    {make_block, "elefant_foot_compensation", "0.2", "", elefant_foot_compensation},
    {make_block, "fuzzy_skin", "external", "", fuzzy_skin},
    {make_block, "fuzzy_skin_thickness", "0.1", FUZZY, fuzzy_skin_thickness},
    {make_block, "fuzzy_skin_point_dist", "0.4", FUZZY, fuzzy_skin_point_dist},
    {0},
};

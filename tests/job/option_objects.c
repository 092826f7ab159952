/* What the options of objects and of adaptive layers do. What is printed isn't the model as it is,
 * so each row says itself what must come of it. */
#include "option_row.h"

#include "solids.h"

/* ---- models ---- */

static void make_brick(shape *s) {
    shape_box(s, 0, 0, 0, 20, 12, 4.5);
}

static void make_tiny(shape *s) {
    shape_box(s, 0, 0, 0, 4, 3, 0.9);
}

static void make_step(shape *s) {
    const solid_ring ring[] = {{1, 0}, {1, 1.5}, {0.5, 1.5}, {0.5, 3}};
    solid_star(s, 10, 1, 0, 0, ring, 4, 64);
}

static void make_raised(shape *s) {
    shape_box(s, 0, 0, 1.2, 16, 16, 3);
}

/* Sides at 45 degrees: the normal's height is the root of a half. */
static void make_cone(shape *s) {
    const solid_ring ring[] = {{1, 0}, {0.1, 9}};
    solid_star(s, 10, 1, 0, 0, ring, 2, 96);
}

/* ---- where things are ---- */

/* What the outer walls of a layer (-1: all) enclose between -x, -y, x, y. */
static void outline(double box[4], const print *p, int32_t layer) {
    double width = 0;
    for (int32_t i = 0; i < p->move_count && width == 0; i++)
        if (move_chosen(&p->move[i], ISO_ROLE_EXTERNAL_PERIMETER, layer))
            width = p->move[i].width;
    CHECK(print_box(box, p, ISO_ROLE_EXTERNAL_PERIMETER, layer));
    box[0] -= width / 2, box[1] -= width / 2, box[2] += width / 2, box[3] += width / 2;
}

static void check_size(const print *p, double x, double y, double z) {
    double box[4];
    outline(box, p, 1);
    CHECK_NEAR(x, box[2] - box[0], 0.003);
    CHECK_NEAR(y, box[3] - box[1], 0.003);
    CHECK_NEAR(100, (box[0] + box[2]) / 2, 0.003);
    CHECK_NEAR(100, (box[1] + box[3]) / 2, 0.003);
    CHECK_NEAR(z, p->report.printed_height, 0.5 * p->options.layer_height + 1e-9);
    CHECK_NEAR(p->report.mesh_volume, p->report.sliced_volume, 0.08 * p->report.mesh_volume);
}

/* ---- size and attitude ---- */

static void inches(const change *c) {
    check_size(c->a, 4, 3, 0.9);
    check_size(c->b, 4 * 25.4, 3 * 25.4, 0.9 * 25.4);
}

static void scale(const change *c) {
    check_size(c->b, 30, 18, 6.75);
}

static void scale_to_fit(const change *c) {
    check_size(c->b, 25, 15, 5.625);
}

static void rotate(const change *c) {
    double w = SHAPE_PI / 6, box[4], bead;
    CHECK(print_box(box, c->a, ISO_ROLE_EXTERNAL_PERIMETER, 1));
    bead = 20 - (box[2] - box[0]);
    double x = 20 - bead, y = 12 - bead; /* the rectangle that the wall's middle is */
    CHECK(print_box(box, c->b, ISO_ROLE_EXTERNAL_PERIMETER, 1));
    CHECK_NEAR(x * cos(w) + y * sin(w), box[2] - box[0], 0.003);
    CHECK_NEAR(x * sin(w) + y * cos(w), box[3] - box[1], 0.003);
}

static void rotate_x(const change *c) {
    check_size(c->b, 20, 4.5, 12);
}

static void rotate_y(const change *c) {
    check_size(c->b, 4.5, 12, 20);
}

/* How far the filament's middle is beside the print's. */
static double lean(const print *p) {
    double sum = 0, all = 0;
    for (int32_t i = 0; i < p->move_count; i++) {
        const print_move *m = &p->move[i];
        if (!move_chosen(m, -1, -1))
            continue;
        sum += m->e * ((m->ax + m->bx) / 2 - 100);
        all += m->e;
    }
    return sum / all;
}

static void mirror(const change *c) {
    CHECK(fabs(lean(c->a)) > 0.3);
    CHECK_NEAR(-lean(c->a), lean(c->b), 0.02);
    CHECK_NEAR(print_volume(c->a), print_volume(c->b), 0.002 * print_volume(c->a));
}

/* ---- cuts ---- */

/* Loops of outer walls on a layer, each by its box. */
enum { LOOPS = 32 };

static int32_t loops(double box[LOOPS][4], const print *p, int32_t layer) {
    int32_t count = 0, run = -1;
    for (int32_t i = 0; i < p->move_count; i++) {
        const print_move *m = &p->move[i];
        if (!move_chosen(m, ISO_ROLE_EXTERNAL_PERIMETER, layer))
            continue;
        if (m->run != run && count < LOOPS) {
            double *b = box[count++];
            b[0] = b[2] = m->ax, b[1] = b[3] = m->ay;
            run = m->run;
        }
        double *b = box[count - 1], half = m->width / 2;
        b[0] = fmin(b[0], m->bx - half), b[1] = fmin(b[1], m->by - half);
        b[2] = fmax(b[2], m->bx + half), b[3] = fmax(b[3], m->by + half);
    }
    return count;
}

static void cut(const change *c) {
    double box[LOOPS][4], before = c->a->report.mesh_volume;
    CHECK_NEAR(3, c->a->report.printed_height, 0.15);
    CHECK_NEAR(1.5, c->b->report.printed_height, 0.15);
    CHECK_NEAR(before, c->b->report.mesh_volume, 0.06 * before);
    if (CHECK_EQUAL(2, loops(box, c->b, 1))) {
        double wide = box[0][2] - box[0][0], other = box[1][2] - box[1][0];
        CHECK_NEAR(20, fmax(wide, other), 0.02);
        CHECK_NEAR(10, fmin(wide, other), 0.02);
    }
}

static void cut_keep(const change *c) {
    double box[4];
    CHECK_NEAR(2, c->b->report.printed_height, 0.15);
    outline(box, c->b, 0);
    CHECK_NEAR(20, box[2] - box[0], 0.02);
    outline(box, c->b, 4);
    CHECK_NEAR(10, box[2] - box[0], 0.02);
}

static void ensure_on_bed(const change *c) {
    CHECK(print_runs(c->a, -1, 0) > 0);
    for (int32_t i = 0; i < c->b->level_count; i++)
        CHECK(c->b->level[i].z > 1.2 || print_runs(c->b, -1, i) == 0);
    CHECK_NEAR(1.8, c->a->report.printed_height, 0.15);
    CHECK_NEAR(3, c->b->report.printed_height, 0.15);
}

/* ---- several ---- */

/* The smallest gap between boxes. */
static double gap(const print *p, int32_t layer, int32_t expected) {
    double box[LOOPS][4], least = 1e9;
    int32_t count = loops(box, p, layer);
    CHECK_EQUAL(expected, count);
    for (int32_t i = 0; i < count; i++)
        for (int32_t j = 0; j < i; j++) {
            double x = fmax(box[i][0] - box[j][2], box[j][0] - box[i][2]);
            double y = fmax(box[i][1] - box[j][3], box[j][1] - box[i][3]);
            least = fmin(least, x > 0 && y > 0 ? sqrt(x * x + y * y) : fmax(x, y));
        }
    return least;
}

static void split(const change *c) {
    CHECK(gap(c->a, 1, 2) < 5);
    CHECK(gap(c->b, 1, 2) > 5.99);
    double whole = print_filament(c->a, -1, -1);
    CHECK_NEAR(whole, print_filament(c->b, -1, -1), 1e-3 * whole);
}

static void duplicate(const change *c) {
    double once = print_filament(c->a, -1, -1);
    CHECK_NEAR(7 * once, print_filament(c->b, -1, -1), 1e-4 * once);
    CHECK_NEAR(6, gap(c->b, 1, 7), 0.01);
    CHECK_NEAR(7 * c->a->report.mesh_volume, c->b->report.mesh_volume, 1e-6);
}

static void duplicate_grid(const change *c) {
    double box[4];
    CHECK_NEAR(6, gap(c->b, 1, 6), 0.003);
    outline(box, c->b, 1);
    CHECK_NEAR(2 * 9 + 6, box[2] - box[0], 0.003);
    CHECK_NEAR(3 * 9 + 2 * 6, box[3] - box[1], 0.003);
}

static void duplicate_distance(const change *c) {
    CHECK_NEAR(6, gap(c->a, 1, 3), 0.003);
    CHECK_NEAR(17, gap(c->b, 1, 3), 0.003);
}

/* Two files: side by side as they are, or each an object. */
static void arrange(const change *c) {
    const char *path[] = {print_path("left.stl"), print_path("right.stl")};
    print p;
    for (int i = 0; i < 2; i++) {
        shape s = {0};
        shape_box(&s, 20 * i, 0, 0, 20 * i + 10, 10, 2 + i);
        CHECK(shape_write_binary(&s, path[i]));
        shape_free(&s);
    }
    same_places(c->a, c->b); /* one object is where it was */
    print_files(&p, path, 2, "arrange = 0", 1);
    check_machine(&p);
    CHECK_NEAR(10, gap(&p, 1, 2), 0.003);
    print_free(&p);
    print_files(&p, path, 2, "arrange = 1", 1);
    check_machine(&p);
    CHECK_NEAR(6, gap(&p, 1, 2), 0.003);
    print_free(&p);
    print_files(&p, path, 2, "arrange = 1\nbed_shape = 0x0,30x0,30x10,0x10\nskirts = 0", 1);
    CHECK_EQUAL(ISO_OUTSIDE, p.status);
    CHECK(strstr(p.message, "right.stl") || strstr(p.message, "left.stl"));
    print_free(&p);
}

static void make_aside(shape *s) {
    shape_box(s, 31, 40, 0, 47, 52, 3);
    shape_box(s, 60, 40, 0, 76, 52, 3);
}

static void dont_arrange(const change *c) {
    const double place[4] = {31, 40, 76, 52};
    double box[4];
    outline(box, c->b, 1);
    for (int i = 0; i < 4; i++)
        CHECK_NEAR(place[i], box[i], 0.003);
    outline(box, c->a, 1);
    CHECK_NEAR(100, (box[0] + box[2]) / 2, 0.003);
    CHECK_NEAR(13, gap(c->b, 1, 2), 0.003);
    CHECK_NEAR(6, gap(c->a, 1, 2), 0.003);
}

static int32_t descents(const print *p) {
    int32_t count = 0;
    for (int32_t i = 1; i < p->level_count; i++)
        count += p->level[i].z < p->level[i - 1].z;
    return count;
}

static void complete_objects(const change *c) {
    CHECK_EQUAL(0, descents(c->a));
    CHECK_EQUAL(2, descents(c->b));
    CHECK_EQUAL(3 * c->a->level_count, c->b->level_count);
    CHECK(gap(c->a, 1, 3) < 7);
    double once = print_filament(c->a, -1, -1);
    CHECK_NEAR(once, print_filament(c->b, -1, -1), 0.02 * once);
}

/* Of two that are printed one after the other. */
static double reach_of(const print *p) {
    double one[4], other[4];
    outline(one, p, 1);
    outline(other, p, p->level_count / 2 + 1);
    return fmax(fmax(one[2], other[2]) - fmin(one[0], other[0]),
                fmax(one[3], other[3]) - fmin(one[1], other[1]));
}

static void extruder_clearance_radius(const change *c) {
    CHECK_NEAR(16 + 20 + 16, reach_of(c->a), 0.02);
    CHECK_NEAR(16 + 33 + 16, reach_of(c->b), 0.02);
}

/* The block is 3 mm high. */
static void extruder_clearance_height(const change *c) {
    shape s = {0};
    print p;
    same_places(c->a, c->b);
    make_block(&s);
    print_shape(&p, &s, "complete_objects = 1\nduplicate = 2\nextruder_clearance_height = 2.9");
    CHECK_EQUAL(ISO_OUTSIDE, p.status);
    CHECK(strstr(p.message, "3.00 mm high") && strstr(p.message, "extruder_clearance_height"));
    print_free(&p);
    shape_free(&s);
}

/* ---- adaptive layers ---- */

/* The height of the layers in the middle of the print. */
static void check_heights(const print *p, double expected) {
    for (int32_t i = p->level_count / 3; i < p->level_count / 2; i++)
        CHECK_NEAR(expected, p->level[i].height, 2e-4);
    CHECK_NEAR(9, p->report.printed_height, p->options.min_layer_height / 2 + 1e-6);
}

static void adaptive_layers(const change *c) {
    CHECK_NEAR(0.3, c->a->level[9].height, 1e-9);
    check_heights(c->b, 0.05 * sqrt(2));
}

static void cusp_height(const change *c) {
    check_heights(c->b, 0.1 * sqrt(2));
}

static void min_layer_height(const change *c) {
    check_heights(c->b, 0.16);
}

static void max_layer_height(const change *c) {
    check_heights(c->a, 0.2 * sqrt(2));
    check_heights(c->b, 0.22);
}

#define GRID "skirts = 0\n"

const option_row option_rows_objects[] = {
    {make_tiny, "inches", "1", "", inches},
    {make_brick, "scale", "150%", "", scale},
    {make_brick, "scale_to_fit", "25,30,40", "", scale_to_fit},
    {make_brick, "rotate", "30", "", rotate},
    {make_brick, "rotate_x", "90", "", rotate_x},
    {make_brick, "rotate_y", "-90", "", rotate_y},
    {make_part, "mirror", "x", STEADY, mirror},
    {make_step, "cut", "1.5", "", cut},
    {make_step, "cut_keep", "upper", "cut = 1", cut_keep},
    {make_raised, "ensure_on_bed", "0", GRID, ensure_on_bed},
    {make_part, "split", "1", "", split},
    {make_small, "duplicate", "7", "", duplicate},
    {make_small, "duplicate_grid", "2,3", "", duplicate_grid},
    {make_small, "duplicate_distance", "17", "duplicate = 3", duplicate_distance},
    {make_small, "arrange", "1", "", arrange},
    {make_aside, "dont_arrange", "1", "split = 1", dont_arrange},
    {make_small, "complete_objects", "1", "duplicate = 3", complete_objects},
    {make_block, "extruder_clearance_radius", "33", "complete_objects = 1\nduplicate = 2",
     extruder_clearance_radius},
    {make_block, "extruder_clearance_height", "4", "complete_objects = 1\nduplicate = 2",
     extruder_clearance_height},
    {make_cone, "adaptive_layers", "1", "", adaptive_layers},
    {make_cone, "cusp_height", "0.1", "adaptive_layers = 1", cusp_height},
    {make_cone, "min_layer_height", "0.16", "adaptive_layers = 1", min_layer_height},
    {make_cone, "max_layer_height", "0.22", "adaptive_layers = 1\ncusp_height = 0.2",
     max_layer_height},
    {0},
};

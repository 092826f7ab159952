/* Under every top and over every bottom there are as many solid layers as were asked for: sparse
 * infill lies only where the sections of so many layers hold it, looked up one by one. */
#include "checks.h"
#include "solids.h"

static double layer_middle(const print *p, int32_t layer) {
    double top = 0;
    for (int32_t l = 0; l < layer; l++)
        top += p->level[l].height;
    return top + p->level[layer].height / 2;
}

typedef double (*pieces)[4];

/* Is the place surely outside of the layer, its edges not near? */
static int lacks(const pieces *piece, const int64_t *count, int32_t layer, double x, double y,
                 double near) {
    const double(*p)[4] = (const double(*)[4])piece[layer];
    return section_winding(p, count[layer], x, y) <= 0 &&
           section_distance(p, count[layer], x, y) > near;
}

static void check_shells(const print *p, const shape *s, int32_t top, int32_t bottom) {
    pieces *piece = calloc((size_t)p->level_count, sizeof *piece);
    int64_t *count = calloc((size_t)p->level_count, sizeof *count);
    shape_box3 b = shape_bounds(s);
    double dx = 100 - (b.min[0] + b.max[0]) / 2, dy = 100 - (b.min[1] + b.max[1]) / 2;
    for (int32_t l = 0; l < p->level_count; l++) {
        piece[l] = malloc((size_t)(s->count + 1) * sizeof *piece[l]);
        count[l] = shape_section(piece[l], s, b.min[2] + layer_middle(p, l));
    }
    int32_t bare = 0, at_end = 0, looked_at = 0;
    double spacing = 0.45;
    for (int32_t i = 0; i < p->move_count; i++) {
        const print_move *m = &p->move[i];
        if (!move_chosen(m, ISO_ROLE_INTERNAL_INFILL, -1) || m->layer % 3 != i % 3)
            continue;
        double x = (m->ax + m->bx) / 2 - dx, y = (m->ay + m->by) / 2 - dy;
        int32_t l = m->layer;
        looked_at++;
        at_end += l < bottom || l + top >= p->level_count;
        for (int32_t k = 1; k <= top && l + k < p->level_count; k++)
            bare += lacks(piece, count, l + k, x, y, 2 * spacing);
        for (int32_t k = 1; k <= bottom && l - k >= 0; k++)
            bare += lacks(piece, count, l - k, x, y, 2 * spacing);
    }
    CHECK(looked_at > 20);
    CHECK_EQUAL(0, at_end);
    CHECK_EQUAL(0, bare);
    for (int32_t l = 0; l < p->level_count; l++)
        free(piece[l]);
    free(piece);
    free(count);
}

static void test_sparse_is_covered(void) {
    static const struct {
        int32_t top, bottom;
    } shells[] = {{1, 1}, {3, 3}, {5, 2}, {2, 7}, {9, 0}, {0, 6}};
    for (int m = 0; m < SOLID_COUNT; m++) {
        shape s = {0};
        all_solids[m].make(&s);
        double size = shape_bounds(&s).max[2] - shape_bounds(&s).min[2];
        for (int c = 0; c < 6 && size > 4 && all_solids[m].full; c++) {
            char settings[160];
            print p;
            int before = check_failures;
            snprintf(settings, sizeof settings,
                     "top_solid_layers = %d\nbottom_solid_layers = %d\nperimeters = 1\n"
                     "layer_height = 0.2\nfill_density = 40%%\nsolid_infill_below_area = 0",
                     shells[c].top, shells[c].bottom);
            print_shape(&p, &s, settings);
            check_shells(&p, &s, shells[c].top, shells[c].bottom);
            if (check_failures > before)
                fprintf(stderr, "    that was %s with %d and %d\n", all_solids[m].name,
                        shells[c].top, shells[c].bottom);
            print_free(&p);
        }
        shape_free(&s);
    }
}

/* ---- models ---- */

/* Boxes between cuts along x, y and z: cell (i, j, k) is filled if the texts, from the lowest
 * storey up, row by row from the front, have a '#' there. */
typedef struct blocks {
    double x[8], y[8], z[8];
    int nx, ny, nz;
    const char *cell;
} blocks;

static void make_blocks(shape *s, const blocks *b) {
    uint8_t filled[343] = {0};
    for (int i = 0; i < b->nx * b->ny * b->nz; i++)
        filled[i] = b->cell[i] == '#';
    shape_cells(s, filled, b->nx, b->ny, b->nz);
    for (int64_t i = 0; i < 3 * s->count; i++) {
        float *p = s->triangle + 3 * i;
        p[0] = (float)b->x[(int)(p[0] + 0.5)];
        p[1] = (float)b->y[(int)(p[1] + 0.5)];
        p[2] = (float)b->z[(int)(p[2] + 0.5)];
    }
}

static const blocks table = {{0, 6, 20, 26}, {0, 10}, {0, 4, 6}, 3, 1, 2, "#.####"};
static const blocks ledge = {{0, 8, 14}, {0, 20}, {0, 4, 6}, 2, 1, 2, "#.##"};
static const blocks pit = {{0, 3, 21, 24},
                           {0, 3, 11, 14},
                           {0, 2, 4, 6},
                           3,
                           3,
                           3,
                           "####"
                           "#####"
                           "####.####"
                           "#########"};
static const blocks stair = {{0, 10, 20, 30}, {0, 14}, {0, 3, 6, 9}, 3, 1, 3, "#####.#.."};

/* ---- bridges ---- */

typedef struct lines {
    int32_t count, off, unheld; /* long lines; in another direction; with an end over air */
} lines;

static int within(const double box[4], double x, double y) {
    return x > box[0] && x < box[2] && y > box[1] && y < box[3];
}

/* Lines of bridges on a layer that are longer than `least` mm. `air` is the box of what they span,
 * about the middle of the model. */
static lines bridge_lines(const print *p, int32_t layer, double least, const double direction[2],
                          const double air[4]) {
    lines l = {0};
    for (int32_t i = 0; i < p->move_count; i++) {
        const print_move *m = &p->move[i];
        if (!move_chosen(m, ISO_ROLE_BRIDGE_INFILL, layer) || move_length(m) < least)
            continue;
        double dx = (m->bx - m->ax) / move_length(m), dy = (m->by - m->ay) / move_length(m);
        l.count++;
        l.off += fabs(dx * direction[1] - dy * direction[0]) > 0.02;
        l.unheld += within(air, m->ax - 100, m->ay - 100) + within(air, m->bx - 100, m->by - 100);
    }
    return l;
}

#define PLAIN                                                                                      \
    "layer_height = 0.2\nfirst_layer_height = 0.2\nperimeters = 2\nfill_density = 15\n"            \
    "skirts = 0\nsolid_infill_below_area = 0\n"

static void print_blocks(print *p, const blocks *b, const char *settings) {
    shape s = {0};
    make_blocks(&s, b);
    print_shape(p, &s, settings);
    CHECK_EQUAL(ISO_OK, p->status);
    print_check(p, &s);
    shape_free(&s);
}

static void test_bridge_between_pillars(void) {
    const char *const settings[] = {PLAIN, PLAIN "fill_density = 100%\n", PLAIN "thick_bridges = 0",
                                    PLAIN "fill_angle = 0"};
    for (int i = 0; i < 4; i++) {
        print p;
        print_blocks(&p, &table, settings[i]);
        /* 14 mm of air from -7 to 7; nothing may end within, and 0.3 mm further out */
        lines l = bridge_lines(&p, 20, 12, (double[]){1, 0}, (double[]){-7.3, -4.9, 7.3, 4.9});
        CHECK(l.count >= 14 && l.count <= 20);
        CHECK_EQUAL(0, l.off);
        CHECK_EQUAL(0, l.unheld);
        for (int32_t layer = 0; layer < 20; layer++)
            CHECK_EQUAL(0, print_runs(&p, ISO_ROLE_BRIDGE_INFILL, layer));
        CHECK_EQUAL(0, print_runs(&p, ISO_ROLE_BRIDGE_INFILL, 21));
        /* two walls on both sides, over air from 0.2 mm before the one pillar to 0.2 before the
         * other */
        CHECK_NEAR(4 * 13.6, print_length(&p, ISO_ROLE_OVERHANG_PERIMETER, 20), 0.02);
        CHECK_NEAR(4 * 13.6, print_length(&p, ISO_ROLE_OVERHANG_PERIMETER, -1), 0.02);
        print_free(&p);
    }
}

static void test_ledge(void) {
    print p;
    print_blocks(&p, &ledge, PLAIN);
    double area[] = {1.3, -9.9, 6.9, 9.9}; /* of air: held at the wall alone */
    lines l = bridge_lines(&p, 20, 4, (double[]){1, 0}, area);
    CHECK(l.count >= 30);
    CHECK_EQUAL(0, l.off);
    CHECK_EQUAL(l.count, l.unheld);
    print_free(&p);
}

static void test_roof_over_a_pit(void) {
    print p;
    print_blocks(&p, &pit, PLAIN);
    lines l = bridge_lines(&p, 20, 6, (double[]){0, 1}, (double[]){-9.3, -4.3, 9.3, 4.3});
    CHECK(l.count >= 30);
    CHECK_EQUAL(0, l.off);
    CHECK_EQUAL(0, l.unheld);
    CHECK_NEAR(0, print_length(&p, ISO_ROLE_OVERHANG_PERIMETER, -1), 1e-9);
    print_free(&p);
}

/* Under each tread the first solid layer lies on sparse lines, and is printed as a bridge; nothing
 * is over air. */
static void test_stair(void) {
    print p;
    print_blocks(&p, &stair, PLAIN "top_solid_layers = 4\nbottom_solid_layers = 2\n");
    for (int32_t layer = 0; layer < 45; layer++) {
        int lid = layer == 11 || layer == 26 || layer == 41;
        CHECK_EQUAL(lid, print_runs(&p, ISO_ROLE_BRIDGE_INFILL, layer) > 0);
        int top = layer == 14 || layer == 29 || layer == 44;
        CHECK_EQUAL(top, print_runs(&p, ISO_ROLE_TOP_SOLID_INFILL, layer) > 0);
    }
    CHECK_EQUAL(0, print_runs(&p, ISO_ROLE_OVERHANG_PERIMETER, -1));
    print_free(&p);
    print_blocks(&p, &stair, PLAIN "fill_density = 100%\n"); /* nothing sparse to lie on */
    CHECK_EQUAL(0, print_runs(&p, ISO_ROLE_BRIDGE_INFILL, -1));
    print_free(&p);
}

/* ---- how thick shells are ---- */

enum { CELLS = 96 };

typedef struct raster {
    uint8_t cell[CELLS][CELLS];
} raster;

typedef struct rasters {
    raster *part,
        *solid; /* by layer: the model's section, and what beads other than sparse cover */
    double x0, y0, size;
} rasters;

static void stamp(raster *r, const rasters *all, const print_move *m, double radius) {
    double length = move_length(m), ux = (m->bx - m->ax) / length, uy = (m->by - m->ay) / length;
    int low[2], high[2];
    double least[] = {fmin(m->ax, m->bx) - all->x0, fmin(m->ay, m->by) - all->y0};
    double most[] = {fmax(m->ax, m->bx) - all->x0, fmax(m->ay, m->by) - all->y0};
    for (int k = 0; k < 2; k++) {
        low[k] = (int)fmax(0, (least[k] - radius) / all->size - 1);
        high[k] = (int)fmin(CELLS - 1, (most[k] + radius) / all->size + 1);
    }
    for (int j = low[1]; j <= high[1]; j++)
        for (int i = low[0]; i <= high[0]; i++) {
            double x = all->x0 + (i + 0.5) * all->size - m->ax;
            double y = all->y0 + (j + 0.5) * all->size - m->ay;
            double t = fmin(length, fmax(0, x * ux + y * uy));
            if (hypot(x - t * ux, y - t * uy) <= radius)
                r->cell[j][i] = 1;
        }
}

/* Cells right of an odd number of the pieces, which come from the model's place. */
static void fill_row(const rasters *all, uint8_t *cell, const double (*piece)[4], int64_t count,
                     double y, double dx) {
    for (int64_t k = 0; k < count; k++) {
        const double *q = piece[k];
        if ((q[1] <= y) == (q[3] <= y))
            continue;
        double x = q[0] + (y - q[1]) / (q[3] - q[1]) * (q[2] - q[0]) + dx;
        int from = (int)ceil((x - all->x0) / all->size - 0.5);
        for (int i = from < 0 ? 0 : from; i < CELLS; i++)
            cell[i] ^= 1;
    }
}

static rasters rasters_of(const print *p, const shape *s) {
    shape_box3 b = shape_bounds(s);
    double wide = fmax(b.max[0] - b.min[0], b.max[1] - b.min[1]) + 1;
    rasters all = {.x0 = 100 - wide / 2, .y0 = 100 - wide / 2, .size = wide / CELLS};
    double dx = 100 - (b.min[0] + b.max[0]) / 2, dy = 100 - (b.min[1] + b.max[1]) / 2;
    double(*piece)[4] = malloc((size_t)(s->count + 1) * sizeof *piece);
    all.part = calloc((size_t)p->level_count, sizeof *all.part);
    all.solid = calloc((size_t)p->level_count, sizeof *all.solid);
    for (int32_t l = 0; l < p->level_count; l++) {
        int64_t count = shape_section(piece, s, b.min[2] + layer_middle(p, l));
        for (int j = 0; j < CELLS; j++)
            fill_row(&all, all.part[l].cell[j], (const double(*)[4])piece, count,
                     all.y0 + (j + 0.5) * all.size - dy, dx);
    }
    for (int32_t i = 0; i < p->move_count; i++) {
        const print_move *m = &p->move[i];
        if (move_chosen(m, -1, -1) && m->role != ISO_ROLE_INTERNAL_INFILL && m->layer >= 0 &&
            move_length(m) > 0)
            stamp(&all.solid[m->layer], &all, m, m->width / 2 + 0.06);
    }
    free(piece);
    return all;
}

/* Do so many layers from this one on, in that direction, hold the place? */
static int deep(const print *p, const rasters *all, int32_t layer, int32_t layers, int way, int j,
                int i) {
    for (int32_t k = 0; k <= layers; k++) {
        int32_t l = layer + way * k;
        if (l < 0 || l >= p->level_count || !all->part[l].cell[j][i])
            return 0;
    }
    return 1;
}

/* Straight below every top and above every bottom there are as many solid layers as were asked for:
 * the share of places where there are not. */
static double share_missing(const print *p, const shape *s, int32_t top, int32_t bottom) {
    rasters all = rasters_of(p, s);
    long needed = 0, missing = 0, sparse = 0;
    for (int32_t l = 0; l < p->level_count; l++)
        for (int j = 0; j < CELLS; j++)
            for (int i = 0; i < CELLS; i++) {
                if (!all.part[l].cell[j][i])
                    continue;
                if (deep(p, &all, l, top, 1, j, i) && deep(p, &all, l, bottom, -1, j, i)) {
                    sparse += !all.solid[l].cell[j][i];
                    continue;
                }
                needed++;
                missing += !all.solid[l].cell[j][i];
            }
    CHECK(needed > 1000);
    CHECK(top > 10 || sparse > 1000); /* and it is not simply all solid */
    free(all.part);
    free(all.solid);
    return (double)missing / (double)needed;
}

static void make_cone(shape *s) {
    const solid_ring ring[] = {{1, 0}, {0.05, 9}};
    solid_star(s, 14, 1, 0, 0, ring, 2, 72);
}

static void make_funnel(shape *s) {
    const solid_ring ring[] = {{0.5, 0}, {1, 8}, {1, 10}};
    solid_star(s, 14, 1, 0, 0, ring, 3, 72);
}

static void make_dome(shape *s) {
    solid_ring ring[20];
    for (int i = 0; i < 20; i++)
        ring[i] = (solid_ring){cos(i * SHAPE_PI / 2 / 19.5), 11 * sin(i * SHAPE_PI / 2 / 19.5)};
    solid_star(s, 14, 1, 0, 0, ring, 20, 72);
}

static void make_bowl(shape *s) {
    solid_ring ring[20];
    for (int i = 0; i < 20; i++) {
        double w = SHAPE_PI / 2 * (1 - (i + 0.5) / 19.5);
        ring[i] = (solid_ring){cos(w < 0 ? 0 : w), 11 - 11 * sin(w < 0 ? 0 : w)};
    }
    solid_star(s, 14, 1, 0, 0, ring, 20, 72);
}

static void make_steep(shape *s) { /* four sides that slope by 75 degrees */
    const solid_ring ring[] = {{1, 0}, {0.85, 9}};
    solid_star(s, 16, 1, 0, 0, ring, 2, 4);
}

static void make_flat(shape *s) { /* and by 10 */
    const solid_ring ring[] = {{1, 0}, {1, 4}, {0.1, 6.5}};
    solid_star(s, 16, 1, 0, 0, ring, 3, 4);
}

static void test_no_hole_in_slopes(void) {
    static void (*const make[])(shape *) = {make_cone, make_funnel, make_dome,
                                            make_bowl, make_steep,  make_flat};
    static const char *const name[] = {"cone", "funnel", "dome", "bowl", "steep", "flat"};
    static const struct { int32_t top, bottom; } shells[] = {{4, 4}, {2, 3}, {1, 1}};
    for (int m = 0; m < 6; m++)
        for (int c = 0; c < 3; c++)
            for (int exact = 0; exact < 2; exact++) {
                shape s = {0};
                print p;
                char settings[300];
                make[m](&s);
                snprintf(settings, sizeof settings,
                         PLAIN "top_solid_layers = %d\nbottom_solid_layers = %d\n"
                               "ensure_vertical_shell_thickness = %d",
                         shells[c].top, shells[c].bottom, exact);
                print_shape(&p, &s, settings);
                CHECK_EQUAL(ISO_OK, p.status);
                double share = share_missing(&p, &s, shells[c].top, shells[c].bottom);
                if (c == 0 && exact) /* there would be some to find */
                    CHECK(share_missing(&p, &s, 16, 16) > 0.02);
                if (!CHECK(share < (exact ? 0.0005 : 0.004)))
                    fprintf(stderr, "    %.2f %% of the shells of the %s, %d and %d, exact %d\n",
                            100 * share, name[m], shells[c].top, shells[c].bottom, exact);
                print_free(&p);
                shape_free(&s);
            }
}

/* ---- thin parts ---- */

static void test_single_layer(void) {
    shape s = {0};
    print p;
    shape_box(&s, 0, 0, 0, 20, 20, 0.2);
    print_shape(&p, &s, PLAIN);
    CHECK_EQUAL(ISO_OK, p.status);
    CHECK_EQUAL(1, p.level_count);
    CHECK(print_length(&p, ISO_ROLE_TOP_SOLID_INFILL, 0) > 500);
    CHECK_EQUAL(0, print_runs(&p, ISO_ROLE_INTERNAL_INFILL, -1));
    CHECK_EQUAL(0, print_runs(&p, ISO_ROLE_BRIDGE_INFILL, -1));
    CHECK_NEAR(20 * 20 * 0.2, print_volume(&p), 0.04 * 80);
    print_free(&p);
    shape_free(&s);
}

/* A box whose walls are two beads thick: a floor, a roof that spans it all, nothing within. */
static void test_hollow_box(void) {
    const blocks box = {{0, 0.9, 15.1, 16},
                        {0, 0.9, 15.1, 16},
                        {0, 0.8, 5, 5.8},
                        3,
                        3,
                        3,
                        "#########"
                        "####.####"
                        "#########"};
    print p;
    print_blocks(&p, &box,
                 PLAIN "extrusion_width = 0.45\nfirst_layer_extrusion_width = 0.45\n"
                       "top_infill_extrusion_width = 0.45\nthin_walls = 0\ngap_fill_enabled = 0\n");
    for (int32_t layer = 4; layer < 25; layer++)
        CHECK_NEAR(0, print_length(&p, ISO_ROLE_SOLID_INFILL, layer), 1e-9);
    CHECK_EQUAL(0, print_runs(&p, ISO_ROLE_INTERNAL_INFILL, -1));
    lines l = bridge_lines(&p, 25, 13, (double[]){1, 0}, (double[]){-6.9, -6.9, 6.9, 6.9});
    CHECK(l.count >= 25);
    CHECK_EQUAL(0, l.unheld);
    CHECK(l.off == 0 || l.off == l.count); /* either way is as good */
    print_free(&p);
}

int main(void) {
    RUN(test_bridge_between_pillars);
    RUN(test_ledge);
    RUN(test_roof_over_a_pit);
    RUN(test_stair);
    RUN(test_no_hole_in_slopes);
    RUN(test_single_layer);
    RUN(test_hollow_box);
    RUN(test_sparse_is_covered);
    CHECK(print_folder_remove());
    return check_verdict();
}

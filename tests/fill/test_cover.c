/* Solid fill from wall to wall: how much of it there is, and where. A fill is inset as a job does
 * it, so that lines end within a margin of the edge of what is to be full. */
#include <isoslice/fill.h>

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "check.h"
#include "fill/raster.h"
#include "fill/shapes.h"

enum { WIDTH = 4500, HEIGHT = 2000 };

static void make_rectangle(iso_region *region, double degrees) {
    static const double corner[4][2] = {{0, 0}, {11.3, 0}, {11.3, 7.7}, {0, 7.7}};
    add_contour(region, corner, 4, degrees, -1);
}

static void make_round(iso_region *region, double degrees) {
    add_circle(region, 0, 0, 5.2, 240, degrees, -1);
}

static void make_wedge(iso_region *region, double degrees) {
    static const double corner[3][2] = {{0, 0}, {16, 0}, {16, 6}};
    add_contour(region, corner, 3, degrees, -1);
}

static void make_ring(iso_region *region, double degrees) {
    add_circle(region, 0, 0, 7, 300, degrees, -1);
    add_circle(region, 0, 0, 4, 300, degrees, 0);
}

/* Teeth of 2 mm, 1.3 mm apart. */
static void make_comb(iso_region *region, double degrees) {
    double corner[24][2];
    int count = 0;
    corner[count][0] = 16.5, corner[count++][1] = -2;
    for (int tooth = 4; tooth >= 0; tooth--)
        for (int k = 0; k < 4; k++) {
            corner[count][0] = 3.3 * tooth + (k < 2 ? 2 : 0);
            corner[count++][1] = k == 1 || k == 2 ? 6 : 0;
        }
    corner[count][0] = 0, corner[count++][1] = -2;
    corner[0][0] = 15.2;
    add_contour(region, (const double(*)[2])corner, count, degrees, -1);
}

/* At most, at any angle; a fill that draws all links in full has up to 0.069, 0.050, 0.125, 0.089
 * and 0.162 too much, and its volumes are off by 0.05, 0.03, 0.09, 0.05 and 0.11. */
typedef struct cover_case {
    const char *name;
    void (*make)(iso_region *region, double degrees);
    double over, under, volume, mean; /* volume: off by at most, and on average */
} cover_case;

static const cover_case cases[] = {
    {"rectangle", make_rectangle, 0.029, 0.0060, 0.0065, 0.003},
    {"disc", make_round, 0.022, 0.0030, 0.0035, 0.003},
    {"wedge", make_wedge, 0.055, 0.0190, 0.0070, 0.004},
    {"ring", make_ring, 0.041, 0.0050, 0.0055, 0.005},
    {"comb", make_comb, 0.077, 0.0165, 0.0220, 0.010},
};
enum { CASES = sizeof cases / sizeof *cases, ANGLES = 8 };

/* The region filled as solid, its lines' middles `margin` inside. */
static void fill_whole(iso_paths *paths, const iso_region *region, iso_fill_options *options) {
    iso_region inside = {0};
    iso_planar_scratch *planar;
    iso_offset_options inset = iso_offset_defaults(-options->margin);
    inset.join = ISO_JOIN_ROUND;
    CHECK_OK(iso_planar_scratch_new(&planar));
    CHECK_OK(iso_offset(&inside, region, &inset, planar));
    CHECK_OK(iso_fill_rectilinear(paths, &inside, options, NULL));
    iso_planar_scratch_free(planar);
    iso_region_free(&inside);
}

static double drawn_volume(const iso_paths *paths) {
    double volume = 0;
    for (int i = 0; i < paths->count; i++)
        for (int k = 0; k + 1 < paths->path[i].count; k++) {
            const iso_path_vertex *v = paths->vertex + paths->path[i].first + k;
            volume += hypot((double)v[1].at.x - v->at.x, (double)v[1].at.y - v->at.y) * v->area;
        }
    return volume;
}

static void fill_case(iso_paths *paths, iso_region *region, int c, int angle) {
    iso_bead bead = iso_bead_of(WIDTH, HEIGHT);
    iso_fill_options options = iso_fill_defaults(bead, 1);
    options.margin = bead.spacing / 2 - WIDTH / 4;
    options.angle = angle * 180.0 / ANGLES;
    cases[c].make(region, 0);
    fill_whole(paths, region, &options);
}

/* Every place is covered, next to none twice, by just as much as there is room for. */
static void test_cover(void) {
    for (int c = 0; c < CASES; c++) {
        double mean = 0;
        for (int angle = 0; angle < ANGLES; angle++) {
            iso_region region = {0};
            iso_paths paths = {0};
            raster board;
            fill_case(&paths, &region, c, angle);
            raster_new(&board, &region, 200);
            raster_draw(&board, &paths, HEIGHT);
            double over = raster_over(&board), under = raster_under(&board);
            double volume = drawn_volume(&paths) / (region_area(&region) * HEIGHT);
            int good = CHECK(over < cases[c].over);
            good &= CHECK(under < cases[c].under);
            good &= CHECK_NEAR(1, volume, cases[c].volume);
            if (!good)
                printf("     %s, angle %d: over %.4f, under %.4f, volume %.4f\n", cases[c].name,
                       angle, over, under, volume);
            mean += volume / ANGLES;
            raster_free(&board);
            iso_paths_free(&paths);
            drop_region(&region);
        }
        CHECK_NEAR(1, mean, cases[c].mean);
    }
}

/* Beads longer than wide are neither too thin to hold nor too thick to lie flat, and have the area
 * that goes with their width. */
static void test_widths(void) {
    for (int c = 0; c < CASES; c++)
        for (int angle = 0; angle < ANGLES; angle++) {
            iso_region region = {0};
            iso_paths paths = {0};
            int thin = 0, thick = 0, odd = 0;
            fill_case(&paths, &region, c, angle);
            for (int i = 0; i < paths.count; i++)
                for (int k = 0; k + 1 < paths.path[i].count; k++) {
                    const iso_path_vertex *v = paths.vertex + paths.path[i].first + k;
                    double dx = (double)v[1].at.x - v->at.x, dy = (double)v[1].at.y - v->at.y;
                    if (hypot(dx, dy) <= 1.02 * WIDTH)
                        continue;
                    thin += v->width < 0.6 * WIDTH - 2;
                    thick += v->width > 1.4 * WIDTH + 2;
                    odd += abs(v->area - iso_bead_of(v->width, HEIGHT).area) > 4 * HEIGHT;
                }
            CHECK_EQUAL(0, thin);
            CHECK_EQUAL(0, thick);
            CHECK_EQUAL(0, odd);
            iso_paths_free(&paths);
            drop_region(&region);
        }
}

int main(void) {
    RUN(test_cover);
    RUN(test_widths);
    return check_verdict();
}

/* The clipper and the weave: random curves over random regions, and those that meet corners. */
#include "fill/clip.h"

#include <math.h>
#include <stdlib.h>

#include "check.h"
#include "fill/cells.h"
#include "fill/inside.h"
#include "fill/shapes.h"

static unsigned seed;

static int random_below(int n) {
    seed = seed * 1664525u + 1013904223u;
    return (int)((seed >> 8) % (unsigned)n);
}

enum { POINTS = 40 };

static double apart(iso_point a, iso_point b) {
    return hypot(b.x - a.x, b.y - a.y);
}

static double chain_length(const iso_weave *weave, int k) {
    iso_point here = weave->crossing[2 * k].at;
    double length = 0;
    for (int i = weave->inner_first[k]; i < weave->inner_first[k + 1]; i++) {
        length += apart(here, weave->inner[i]);
        here = weave->inner[i];
    }
    return length + apart(here, weave->crossing[2 * k + 1].at);
}

static int compare_doubles(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* How much of a-b lies inside, in doubles: cut it at all edges, ask for the middle of each piece.
 */
static double length_inside(const iso_region *region, iso_point a, iso_point b) {
    double *cut = malloc(((size_t)region->first[region->count] + 2) * sizeof *cut), inside = 0;
    int count = 0;
    cut[count++] = 0;
    cut[count++] = 1;
    for (int m = 0; m < region->count; m++)
        for (int c = region->first[m + 1] - 1, d = region->first[m]; d < region->first[m + 1];
             c = d++) {
            iso_point p = region->point[c], q = region->point[d];
            double ux = b.x - a.x, uy = b.y - a.y, vx = q.x - p.x, vy = q.y - p.y;
            double turn = ux * vy - uy * vx, wx = p.x - a.x, wy = p.y - a.y;
            double t = (wx * vy - wy * vx) / turn, s = (wx * uy - wy * ux) / turn;
            if (turn != 0 && t > 0 && t < 1 && s >= 0 && s <= 1)
                cut[count++] = t;
        }
    qsort(cut, (size_t)count, sizeof *cut, compare_doubles);
    for (int k = 0; k + 1 < count; k++) {
        double t = (cut[k] + cut[k + 1]) / 2;
        if (cut[k + 1] > cut[k] &&
            is_inside(region, a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), 0))
            inside += (cut[k + 1] - cut[k]) * apart(a, b);
    }
    free(cut);
    return inside;
}

static void draw(iso_clip *clip, const iso_point *point, int count) {
    for (int i = 0; i < count; i++)
        (i ? iso_clip_draw : iso_clip_move)(clip, point[i].x, point[i].y);
}

/* Chains begin and end on the edges they name, or at a curve's end. */
static void check_ends(const iso_weave *weave) {
    const iso_region *region = weave->region;
    int astray = 0;
    for (int c = 0; c < weave->count; c++) {
        int i = weave->crossing[c].edge >> 1, m = weave->contour[c];
        if (i < 0)
            continue;
        iso_point a = region->point[i];
        iso_point b = region->point[i + 1 < region->first[m + 1] ? i + 1 : region->first[m]];
        iso_point at = weave->crossing[c].at;
        astray += apart(a, at) + apart(at, b) > apart(a, b) + 2;
    }
    CHECK_EQUAL(0, astray);
}

static void check_curves(const iso_region *region, int curves, int reach, int step) {
    iso_arena scratch = {0};
    iso_clip clip;
    iso_weave weave;
    double expected = 0, length = 0, worst = 0;
    iso_point point[POINTS];
    CHECK_OK(iso_clip_begin(&clip, region, 0, (iso_point){0, 0}, &scratch));
    for (int n = 0; n < curves; n++) {
        for (int i = 0; i < POINTS; i++) {
            int far = i == 0 || step == 0;
            point[i] =
                far ? (iso_point){random_below(2 * reach) - reach, random_below(2 * reach) - reach}
                    : (iso_point){point[i - 1].x + random_below(2 * step) - step,
                                  point[i - 1].y + random_below(2 * step) - step};
        }
        draw(&clip, point, POINTS);
        for (int i = 0; i + 1 < POINTS; i++)
            expected += length_inside(region, point[i], point[i + 1]);
    }
    CHECK_OK(iso_clip_end(&weave, &clip));
    CHECK_OK(iso_weave_validate(&weave));
    check_ends(&weave);
    for (int k = 0; k < weave.count / 2; k++)
        length += chain_length(&weave, k);
    worst = 3.0 * (weave.count + 1);
    CHECK_NEAR(expected, length, worst);
    iso_arena_free(&scratch);
}

static void test_random_curves(void) {
    for (int s = 0; s < shape_count; s++)
        for (int turn = 0; turn < 3; turn++) {
            iso_region region = {0};
            seed = (unsigned)(100 * s + turn);
            shapes[s].make(&region, 33 * turn);
            check_curves(&region, 8, 1300000, 0);
            check_curves(&region, 8, 1000000, 20000);
            check_curves(&region, 4, 1000000, 300);
            drop_region(&region);
        }
}

static void test_random_cells(void) {
    for (unsigned n = 0; n < 60; n++) {
        iso_region region = {0};
        cells grid = cells_random(n, 30 + (int)n);
        seed = n;
        cells_region(&region, &grid, 1000 + (int)n, (int)(n % 7) * 130);
        if (region.count)
            check_curves(&region, 6, 9000, (int)(n % 3) * 1500);
        drop_region(&region);
    }
}

/* Everything on the corners of one lattice: curves pass through corners, along edges, turn on them.
 * What is inside must be drawn; what lies on the boundary may be. */
static void check_lattice(const iso_region *region, int pitch) {
    iso_arena scratch = {0};
    iso_clip clip;
    iso_weave weave;
    iso_point point[POINTS];
    double inside = 0, length = 0;
    CHECK_OK(iso_clip_begin(&clip, region, 0, (iso_point){0, 0}, &scratch));
    for (int n = 0; n < 20; n++) {
        for (int i = 0; i < POINTS; i++)
            point[i] = (iso_point){(random_below(CELLS + 4) - CELLS / 2 - 2) * pitch,
                                   (random_below(CELLS + 4) - CELLS / 2 - 2) * pitch};
        draw(&clip, point, POINTS);
        for (int i = 0; i + 1 < POINTS; i++)
            inside += length_inside(region, point[i], point[i + 1]);
    }
    CHECK_OK(iso_clip_end(&weave, &clip));
    CHECK_OK(iso_weave_validate(&weave));
    check_ends(&weave);
    int outside = 0;
    for (int k = 0; k < weave.count / 2; k++) {
        iso_point here = weave.crossing[2 * k].at;
        for (int i = weave.inner_first[k]; i <= weave.inner_first[k + 1]; i++) {
            iso_point next =
                i < weave.inner_first[k + 1] ? weave.inner[i] : weave.crossing[2 * k + 1].at;
            outside += !is_inside(region, (here.x + next.x) / 2.0, (here.y + next.y) / 2.0, 1.5);
            here = next;
        }
        length += chain_length(&weave, k);
    }
    CHECK_EQUAL(0, outside);
    /* of what runs along the boundary, all of which is_inside counts in, about half is drawn */
    CHECK(length <= inside + 3 * weave.count && length > 0.85 * inside - 3 * weave.count);
    iso_arena_free(&scratch);
}

static void test_curves_through_corners(void) {
    for (unsigned n = 0; n < 60; n++) {
        iso_region region = {0};
        cells grid = cells_random(1000 + n, 55);
        seed = n;
        cells_region(&region, &grid, 1000, 0);
        if (region.count)
            check_lattice(&region, 1000);
        drop_region(&region);
    }
}

/* A curve that begins and ends inside has loose ends, each a contour of its own. */
static void test_loose_ends(void) {
    static const double corner[4][2] = {{0, 0}, {10, 0}, {10, 10}, {0, 10}};
    static const iso_point inside[] = {{20000, 20000}, {50000, 30000}, {70000, 80000}};
    static const iso_point across[] = {{20000, 50000}, {120000, 50000}, {80000, 90000}};
    iso_arena scratch = {0};
    iso_region region = {0};
    iso_clip clip;
    iso_weave weave;
    add_contour(&region, corner, 4, 0, -1);
    CHECK_OK(iso_clip_begin(&clip, &region, 0, (iso_point){0, 0}, &scratch));
    draw(&clip, inside, 3);
    draw(&clip, across, 3);
    CHECK_OK(iso_clip_end(&weave, &clip));
    CHECK_OK(iso_weave_validate(&weave));
    CHECK_EQUAL(6, weave.count);
    CHECK_EQUAL(1, weave.inner_first[1] - weave.inner_first[0]);
    int loose = 0;
    for (int c = 0; c < weave.count; c++)
        loose += weave.crossing[c].edge < 0;
    CHECK_EQUAL(4, loose);
    CHECK_EQUAL(1, weave.arc[0]);
    CHECK_EQUAL(9, weave.arc[7]); /* out and in again on the right side */
    iso_arena_free(&scratch);
    drop_region(&region);
}

static void test_validator(void) {
    iso_arena scratch = {0};
    iso_region region = {0};
    iso_clip clip;
    iso_weave weave;
    shapes[1].make(&region, 0);
    CHECK_OK(iso_clip_begin(&clip, &region, 0, (iso_point){0, 0}, &scratch));
    for (int k = 0; k < 9; k++) {
        iso_clip_move(&clip, -1000, 100000 * k + 50000);
        iso_clip_draw(&clip, 1001000, 100000 * k + 50000);
    }
    CHECK_OK(iso_clip_end(&weave, &clip));
    CHECK_OK(iso_weave_validate(&weave));
    int32_t kept = weave.arc[7];
    weave.arc[7] = weave.arc[9];
    CHECK_STATUS(ISO_BUG, iso_weave_validate(&weave));
    CHECK(strstr(iso_error_message(), "BB = 1"));
    weave.arc[7] = kept;
    weave.contour[3]++;
    CHECK_STATUS(ISO_BUG, iso_weave_validate(&weave));
    CHECK(strstr(iso_error_message(), "pB = p"));
    weave.contour[3]--;
    weave.crossing[2].edge ^= 1;
    CHECK_STATUS(ISO_BUG, iso_weave_validate(&weave));
    iso_arena_free(&scratch);
    drop_region(&region);
}

int main(void) {
    RUN(test_random_curves);
    RUN(test_random_cells);
    RUN(test_curves_through_corners);
    RUN(test_loose_ends);
    RUN(test_validator);
    return check_verdict();
}

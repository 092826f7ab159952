#include "path/seam.h"

#include <stdlib.h>

#include "check.h"

static const double pi = 3.14159265358979323846;

static void add_loop(iso_paths *paths, const double (*mm)[2], int count) {
    iso_point point[512];
    for (int i = 0; i < count; i++)
        point[i] = (iso_point){iso_units(mm[i][0]), iso_units(mm[i][1])};
    CHECK_OK(iso_paths_add(paths, &(iso_path){.closed = 1}, point, count, 4500, 1));
}

static iso_seam_place choose(const iso_paths *paths, iso_seams *seams, int32_t i, iso_seam how,
                             iso_point from) {
    iso_seam_place place = {0};
    const iso_path *path = &paths->path[i];
    CHECK_OK(iso_seam_choose(&place, seams, path, paths->vertex + path->first, i, how, from));
    return place;
}

static double mm_from(iso_point p, double x, double y) {
    return hypot(iso_mm(p.x) - x, iso_mm(p.y) - y);
}

/* A square's corners are all alike, so the rearmost; an L hides its seam in the inner corner. */
static void test_corners(void) {
    static const double square[][2] = {{5, 0}, {10, 0}, {10, 10}, {5, 10}, {0, 10}, {0, 0}};
    static const double ell[][2] = {{0, 0}, {20, 0}, {20, 8}, {8, 8}, {8, 20}, {0, 20}};
    iso_paths paths = {0};
    iso_seams seams = {0};
    add_loop(&paths, square, 6);
    add_loop(&paths, ell, 6);
    CHECK_NEAR(0, mm_from(choose(&paths, &seams, 0, ISO_SEAM_ALIGNED, (iso_point){0}).at, 0, 10),
               0);
    CHECK_NEAR(0, mm_from(choose(&paths, &seams, 1, ISO_SEAM_ALIGNED, (iso_point){0}).at, 8, 8), 0);
    const iso_path_vertex *s = paths.vertex, *l = paths.vertex + paths.path[1].first;
    CHECK_EQUAL(0, iso_seam_corner(s, 6, 0));
    CHECK_EQUAL(8, iso_seam_corner(s, 6, 1)); /* sin^2 45 degrees, of 16 */
    CHECK_EQUAL(24, iso_seam_corner(l, 6, 3));
    CHECK_EQUAL(8, iso_seam_corner(l, 6, 4));
    iso_seams_free(&seams);
    iso_paths_free(&paths);
}

static void circle(iso_paths *paths, double x, double y, double radius, int count, double turn) {
    double mm[512][2];
    for (int i = 0; i < count; i++) {
        double a = 2 * pi * i / count + turn;
        mm[i][0] = x + radius * cos(a);
        mm[i][1] = y + radius * sin(a);
    }
    add_loop(paths, (const double(*)[2])mm, count);
}

/* A square tower that twists by 1 degree a layer: the seam stays on one corner. */
static void test_aligned_follows_a_twist(void) {
    iso_seams seams = {0};
    iso_point below = {0};
    for (int layer = 0; layer < 120; layer++) {
        iso_paths paths = {0};
        circle(&paths, 100, 100, 15, 4, pi / 180 * layer);
        iso_seams_next_layer(&seams);
        iso_seam_place place = choose(&paths, &seams, 0, ISO_SEAM_ALIGNED, (iso_point){0});
        double corner = 1e9;
        for (int i = 0; i < 4; i++)
            corner = fmin(corner, mm_from(place.at, iso_mm(paths.vertex[i].at.x),
                                          iso_mm(paths.vertex[i].at.y)));
        CHECK_NEAR(0, corner, 0);
        if (layer > 0)
            CHECK_NEAR(15 * 2 * sin(pi / 360), mm_from(place.at, iso_mm(below.x), iso_mm(below.y)),
                       0.001);
        below = place.at;
        iso_paths_free(&paths);
    }
    iso_seams_free(&seams);
}

/* Round towers, two of them, whose points are elsewhere on each layer: two straight lines. */
static void test_aligned_runs_up_in_a_line(void) {
    iso_seams seams = {0};
    iso_point first[2] = {{0}};
    for (int layer = 0; layer < 200; layer++) {
        iso_paths paths = {0};
        circle(&paths, 100, 100, 12, 200, 0.013 * layer);
        circle(&paths, 150, 100, 5 + 0.01 * layer, 90, 0.2 - 0.03 * layer);
        iso_seams_next_layer(&seams);
        for (int i = 0; i < 2; i++) {
            int which = layer & 1 ? 1 - i : i; /* in whatever order they come */
            iso_point at = choose(&paths, &seams, which, ISO_SEAM_ALIGNED, (iso_point){0}).at;
            double x = 100 + 50 * which, radius = which ? 5 + 0.01 * layer : 12;
            if (layer == 0)
                first[which] = at;
            double fx = iso_mm(first[which].x) - x, fy = iso_mm(first[which].y) - 100;
            double scale = radius / hypot(fx, fy);
            CHECK_NEAR(0, mm_from(at, x + scale * fx, 100 + scale * fy), 0.1);
            CHECK_NEAR(radius, mm_from(at, x, 100), 0.005);
        }
        iso_paths_free(&paths);
    }
    iso_seams_free(&seams);
}

/* A part that ends, and another that begins elsewhere, doesn't inherit its seam. */
static void test_aligned_begins_anew(void) {
    static const double low[][2] = {{0, 0}, {10, 0}, {10, 10}, {0, 10}};
    static const double high[][2] = {{20, 0}, {30, 0}, {30, 10}, {20, 10}};
    iso_paths paths = {0};
    iso_seams seams = {0};
    add_loop(&paths, low, 4);
    add_loop(&paths, high, 4);
    choose(&paths, &seams, 0, ISO_SEAM_ALIGNED, (iso_point){0});
    iso_seams_next_layer(&seams);
    CHECK_NEAR(0, mm_from(choose(&paths, &seams, 1, ISO_SEAM_ALIGNED, (iso_point){0}).at, 20, 10),
               0);
    iso_seams_free(&seams);
    iso_paths_free(&paths);
}

static void test_rear(void) {
    iso_paths paths = {0};
    iso_seams seams = {0};
    for (int i = 0; i < 50; i++) {
        circle(&paths, 100 + i, 90 - i, 3 + i % 7, 24 + i, 0.1 * i);
        iso_seam_place place = choose(&paths, &seams, i, ISO_SEAM_REAR, (iso_point){0});
        const iso_path *p = &paths.path[i];
        for (int32_t k = 0; k < p->count; k++)
            CHECK(paths.vertex[p->first + k].at.y <= place.at.y);
    }
    iso_seams_free(&seams);
    iso_paths_free(&paths);
}

/* Evenly over the whole length, not over the vertices. */
static void test_random_is_even(void) {
    enum { LAYERS = 4000, BINS = 12 };
    static const double box[][2] = {{0, 0}, {1, 0}, {2, 0}, {40, 0}, {40, 20}, {0, 20}};
    iso_paths paths = {0};
    iso_seams seams = {0}, again = {0};
    int bin[BINS] = {0};
    add_loop(&paths, box, 6);
    for (int layer = 0; layer < LAYERS; layer++) {
        iso_seams_next_layer(&seams);
        iso_seams_next_layer(&again);
        iso_point at = choose(&paths, &seams, 0, ISO_SEAM_RANDOM, (iso_point){0}).at;
        iso_point same = choose(&paths, &again, 0, ISO_SEAM_RANDOM, (iso_point){7, 7}).at;
        double x = iso_mm(at.x), y = iso_mm(at.y);
        double along = y <= 0 ? x : x >= 40 ? 40 + y : y >= 20 ? 100 - x : 120 - y;
        CHECK(at.x == same.x && at.y == same.y);
        CHECK(y == 0 || y == 20 || x == 0 || x == 40);
        bin[(int)(along / 120 * BINS) % BINS]++;
    }
    double chi = 0, expected = (double)LAYERS / BINS;
    for (int i = 0; i < BINS; i++)
        chi += (bin[i] - expected) * (bin[i] - expected) / expected;
    CHECK(chi < 31.3); /* 11 degrees of freedom, 0.1 % */
    iso_seams_free(&seams);
    iso_seams_free(&again);
    iso_paths_free(&paths);
}

/* The rearmost corner hangs over air: another one. */
static void test_not_over_air(void) {
    static const double square[][2] = {{0, 0}, {10, 0}, {10, 10}, {0, 10}};
    iso_paths paths = {0};
    iso_seams seams = {0};
    add_loop(&paths, square, 4);
    paths.vertex[3].role = paths.vertex[2].role = ISO_ROLE_OVERHANG_PERIMETER;
    iso_point at = choose(&paths, &seams, 0, ISO_SEAM_ALIGNED, (iso_point){0}).at;
    CHECK_NEAR(0, mm_from(at, 0, 0), 0);
    at = choose(&paths, &seams, 0, ISO_SEAM_NEAREST, (iso_point){60000, 90000}).at;
    CHECK_NEAR(0, mm_from(at, 10, 0), 0);
    iso_seams_free(&seams);
    iso_paths_free(&paths);
}

/* Hundreds of towers, each with a hole: sorted into cells or not, the seams are the same. */
static void test_many_walls(void) {
    iso_seams seams = {0}, plain = {0};
    iso_arena scratch = {0};
    for (int layer = 0; layer < 3; layer++) {
        iso_paths paths = {0};
        for (int i = 0; i < 300; i++) {
            circle(&paths, 10 * (i % 20), 10 * (i / 20), 4, 30, 0.1 * layer + i);
            circle(&paths, 10 * (i % 20), 10 * (i / 20), 1, 12, 0.2 * layer + i);
        }
        iso_seams_next_layer(&seams);
        iso_seams_next_layer(&plain);
        CHECK_OK(iso_seams_index(&seams, &scratch));
        CHECK_EQUAL(layer > 0, seams.first != NULL);
        for (int i = 0; i < 600; i++) {
            iso_point a = choose(&paths, &seams, i, ISO_SEAM_ALIGNED, (iso_point){0}).at;
            iso_point b = choose(&paths, &plain, i, ISO_SEAM_ALIGNED, (iso_point){0}).at;
            CHECK(a.x == b.x && a.y == b.y);
            if (layer > 0)
                CHECK(hypot((double)a.x - seams.below[i].at.x, (double)a.y - seams.below[i].at.y) <
                      2000);
        }
        iso_paths_free(&paths);
    }
    iso_arena_free(&scratch);
    iso_seams_free(&seams);
    iso_seams_free(&plain);
}

/* Near where the nozzle is, but not on a flat side if a corner is not much farther. */
static void test_nearest_prefers_corners(void) {
    iso_paths paths = {0};
    iso_seams seams = {0};
    double mm[80][2];
    for (int i = 0; i < 80; i++) {
        double t = i % 20;
        mm[i][0] = i < 20 ? t : i < 40 ? 20 : i < 60 ? 20 - t : 0;
        mm[i][1] = i < 20 ? 0 : i < 40 ? t : i < 60 ? 20 : 20 - t;
    }
    add_loop(&paths, (const double(*)[2])mm, 80);
    iso_point close = {iso_units(1.4), iso_units(-1)}, far = {iso_units(10), iso_units(-1)};
    CHECK_NEAR(0, mm_from(choose(&paths, &seams, 0, ISO_SEAM_NEAREST, close).at, 0, 0), 0);
    CHECK_NEAR(0, mm_from(choose(&paths, &seams, 0, ISO_SEAM_NEAREST, far).at, 10, 0), 0);
    CHECK_EQUAL(0, seams.here_count);
    iso_seams_free(&seams);
    iso_paths_free(&paths);
}

static void test_beside(void) {
    static const double box[][2] = {{0, 0}, {40, 0}, {40, 20}, {0, 20}};
    iso_paths paths = {0};
    add_loop(&paths, box, 4);
    iso_seam_place place = iso_seam_beside(paths.path, paths.vertex, (iso_point){300000, -5000});
    CHECK(place.vertex == 0 && place.at.x == 300000 && place.at.y == 0);
    place = iso_seam_beside(paths.path, paths.vertex, (iso_point){-4000, 100000});
    CHECK(place.vertex == 3 && place.at.x == 0 && place.at.y == 100000);
    place = iso_seam_beside(paths.path, paths.vertex, (iso_point){500000, 500000});
    CHECK(place.at.x == 400000 && place.at.y == 200000);
    iso_paths_free(&paths);
}

static void test_without_memory(void) {
    iso_paths paths = {0};
    iso_seams seams = {0};
    iso_seam_place place;
    circle(&paths, 0, 0, 5, 8, 0);
    iso_fail_allocation_after(0);
    iso_status status = iso_seam_choose(&place, &seams, paths.path, paths.vertex, 0,
                                        ISO_SEAM_ALIGNED, (iso_point){0});
    iso_fail_allocation_after(-1);
    CHECK_EQUAL(ISO_NO_MEMORY, status);
    CHECK_EQUAL(0, seams.here_count);
    iso_seams_free(&seams);
    iso_paths_free(&paths);
}

int main(void) {
    RUN(test_corners);
    RUN(test_aligned_follows_a_twist);
    RUN(test_aligned_runs_up_in_a_line);
    RUN(test_aligned_begins_anew);
    RUN(test_rear);
    RUN(test_random_is_even);
    RUN(test_not_over_air);
    RUN(test_many_walls);
    RUN(test_nearest_prefers_corners);
    RUN(test_beside);
    RUN(test_without_memory);
    return check_verdict();
}

/* Bodies whose volume, surface, pieces, pores and sizes are known by formula. */
#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "check.h"
#include "lattice/analysis.h"
#include "lattice/sizes.h"

#define PI 3.14159265358979323846

/* ---- fields: distance to the material, with the part around it ---- */

typedef double field(double x, double y, double z);

typedef struct world {
    field *material, *part;
} world;

static iso_status sample(void *payload, float *material, float *part, const iso_body_row *row,
                         int worker) {
    const world *w = payload;
    (void)worker;
    for (int32_t i = 0; i < row->count; i++) {
        double x = row->first.x + i * row->step, y = row->first.y, z = row->first.z;
        double p = w->part(x, y, z);
        part[i] = (float)p;
        material[i] = (float)fmax(p, w->material(x, y, z));
    }
    return ISO_OK;
}

static double ball(double x, double y, double z, double r) {
    return sqrt(x * x + y * y + z * z) - r;
}

static double box(double x, double y, double z, double half) {
    double qx = fabs(x) - half, qy = fabs(y) - half, qz = fabs(z) - half;
    double out =
        sqrt(fmax(qx, 0) * fmax(qx, 0) + fmax(qy, 0) * fmax(qy, 0) + fmax(qz, 0) * fmax(qz, 0));
    return out + fmin(fmax(qx, fmax(qy, qz)), 0);
}

/* From -extent to extent, off the symmetric places. */
static iso_body body_of(world *w, double extent, double voxel) {
    int32_t n = (int32_t)(2 * extent / voxel) + 4;
    double min = -extent - 1.63 * voxel;
    return (iso_body){
        .min = {min, min, min}, .voxel = voxel, .size = {n, n, n}, .sample = sample, .payload = w};
}

static iso_body_counts count_of(const iso_body *body) {
    iso_body_counts counts = {0};
    CHECK_OK(body_count(&counts, body, NULL, NULL, NULL));
    return counts;
}

/* ---- what is counted ---- */

static double cube10(double x, double y, double z) {
    return box(x, y, z, 10);
}

static double hollow(double x, double y, double z) {
    return -ball(x - 1, y + 2, z - 0.5, 5);
}

static void test_a_cavity_is_a_closed_pore(void) {
    world w = {hollow, cube10};
    iso_body body = body_of(&w, 10, 0.15);
    iso_body_counts c = count_of(&body);
    double v = 0.15 * 0.15 * 0.15;
    CHECK_NEAR(8000, (double)c.part * v, 0.01 * 8000); /* whole voxels on flat sides */
    CHECK_NEAR(8000, c.part_share * v, 0.001 * 8000);
    CHECK_NEAR(4 * PI / 3 * 125, (double)(c.part - c.material) * v, 1);
    CHECK_EQUAL(1, c.closed_pores);
    CHECK_NEAR(4 * PI / 3 * 125, (double)c.closed_voxels * v, 1);
    CHECK_EQUAL(1, c.pieces);
    CHECK_EQUAL(0, c.loose_count);
    CHECK_NEAR(4 * PI * 25, c.pore_surface, 0.006 * 314);
    CHECK_NEAR(4 * PI * 25 + 2400, c.surface, 0.01 * 2714);
    iso_release(c.loose);
}

static double drilled(double x, double y, double z) {
    double hole = fmax(sqrt(x * x + y * y) - 0.5, z);
    return -fmin(ball(x, y, z, 5), hole);
}

static void test_a_drilled_cavity_is_open(void) {
    world w = {drilled, cube10};
    iso_body body = body_of(&w, 10, 0.2);
    iso_body_counts c = count_of(&body);
    CHECK_EQUAL(0, c.closed_pores);
    CHECK_EQUAL(0, c.closed_voxels);
    iso_release(c.loose);
}

static double two_balls(double x, double y, double z) {
    return fmin(ball(x + 4, y, z, 3), ball(x - 4, y, z, 2));
}

static double two_cubes(double x, double y, double z) {
    return fmin(box(x + 5, y, z, 4), box(x - 5, y, z, 4));
}

static void test_of_two_balls_the_smaller_is_loose(void) {
    world w = {two_balls, cube10};
    iso_body body = body_of(&w, 10, 0.1);
    iso_body_counts c = count_of(&body);
    iso_lattice_run *run;
    int64_t count, left, voxels = 0;
    CHECK_EQUAL(2, c.pieces);
    CHECK_EQUAL(1, c.kept);
    if (!CHECK_EQUAL(1, c.loose_count))
        return;
    CHECK_NEAR(4 * PI / 3 * 8, (double)c.loose[0].voxels * 1e-3, 0.2);
    CHECK_OK(body_loose_runs(&run, &count, &left, &body, &c, 1 << 24));
    CHECK_EQUAL(0, left);
    for (int64_t i = 0; i < count; i++) {
        voxels += run[i].end - run[i].first;
        double x = body.min.x + run[i].first * body.voxel;
        CHECK(x > 1.9 && x < 4.1);
        CHECK(i == 0 || run[i - 1].z < run[i].z ||
              (run[i - 1].z == run[i].z && run[i - 1].y < run[i].y));
    }
    CHECK_EQUAL(c.loose[0].voxels, voxels);
    iso_release(run);
    CHECK_OK(body_loose_runs(&run, &count, &left, &body, &c, 100)); /* no room for it */
    CHECK_EQUAL(1, left);
    CHECK_EQUAL(0, count);
    iso_release(run);
    iso_release(c.loose);
}

/* Bodies of a part that don't touch keep a piece each. */
static void test_each_body_of_the_part_keeps_its_piece(void) {
    world w = {two_balls, two_cubes};
    iso_body body = body_of(&w, 10, 0.1);
    iso_body_counts c = count_of(&body);
    CHECK_EQUAL(2, c.pieces);
    CHECK_EQUAL(2, c.kept);
    CHECK_EQUAL(0, c.loose_count);
    iso_release(c.loose);
}

static double slanted(double x, double y, double z) {
    return fabs((x + 2 * y + 3 * z) / sqrt(14)) - 1;
}

static double ball8(double x, double y, double z) {
    return ball(x, y, z, 8);
}

/* A slab through a ball: two discs of sqrt(64 - 1), whatever the slope. */
static void test_the_surface_of_a_slanted_slab(void) {
    world w = {slanted, ball8};
    iso_body body = body_of(&w, 8, 0.1);
    iso_body_counts c = count_of(&body);
    CHECK_NEAR(2 * PI * 63, c.pore_surface, 0.01 * 396); /* the rim's voxels are lost */
    CHECK_NEAR(2 * PI * 63 + 2 * PI * 8 * 2, c.surface, 0.01 * 496);
    iso_release(c.loose);
}

static double cube5(double x, double y, double z) {
    return box(x, y, z, 5);
}

static double gyroid(double x, double y, double z) {
    double k = 2 * PI / 5;
    double g = sin(k * x) * cos(k * y) + sin(k * y) * cos(k * z) + sin(k * z) * cos(k * x);
    double gx = k * (cos(k * x) * cos(k * y) - sin(k * z) * sin(k * x));
    double gy = k * (cos(k * y) * cos(k * z) - sin(k * x) * sin(k * y));
    double gz = k * (cos(k * z) * cos(k * x) - sin(k * y) * sin(k * z));
    return fabs(g) / sqrt(gx * gx + gy * gy + gz * gz + 1e-12) - 0.1;
}

/* A minimal surface of 3.0915 cell^2 a cell, both sides of a wall of 0.2 mm, cells of 5 mm.
 * Steiner: its sides together are 2 A + 2 t^2 pi chi, less than 1 % off. */
static void test_the_specific_surface_of_a_gyroid(void) {
    world w = {gyroid, cube5};
    iso_body body = body_of(&w, 5, 0.08);
    iso_body_counts c = count_of(&body);
    CHECK_NEAR(2 * 3.0915 / 5, c.pore_surface / 1000, 0.02 * 1.2366);
    CHECK_NEAR(0.2 * 3.0915 / 5, (double)c.material / (double)c.part, 0.02 * 0.124);
    CHECK_EQUAL(0, c.closed_pores);
    iso_release(c.loose);
}

/* ---- threads and failures ---- */

static void test_any_number_of_threads_counts_the_same(void) {
    world w = {gyroid, ball8};
    iso_body body = body_of(&w, 8, 0.25);
    iso_body_counts one = count_of(&body), more = {0};
    iso_sizes a, b;
    CHECK_OK(body_sizes(&a, &body, 2, 2, NULL));
    for (int threads = 2; threads < 5; threads++) {
        iso_pool *pool;
        CHECK_OK(iso_pool_new(&pool, threads));
        CHECK_OK(body_count(&more, &body, pool, NULL, NULL));
        CHECK_EQUAL(one.material, more.material);
        CHECK(one.surface == more.surface && one.pore_surface == more.pore_surface);
        CHECK_EQUAL(one.loose_count, more.loose_count);
        CHECK(memcmp(one.loose, more.loose, (size_t)one.loose_count * sizeof *one.loose) == 0);
        iso_release(more.loose);
        if (threads == 2) {
            CHECK_OK(body_sizes(&b, &body, 2, 2, pool));
            CHECK(memcmp(&a, &b, sizeof a) == 0);
        }
        iso_pool_free(pool);
    }
    iso_release(one.loose);
}

static void test_no_memory_is_told(void) {
    world w = {two_balls, cube10};
    iso_body body = body_of(&w, 10, 1);
    iso_status status = ISO_NO_MEMORY;
    int64_t n = 0;
    for (; n < 1000 && status == ISO_NO_MEMORY; n++) {
        iso_body_counts c;
        iso_lattice_run *run;
        int64_t count, left;
        iso_fail_allocation_after(n);
        status = body_count(&c, &body, NULL, NULL, NULL);
        if (status == ISO_OK) {
            status = body_loose_runs(&run, &count, &left, &body, &c, 1 << 20);
            if (status == ISO_OK)
                iso_release(run);
            iso_release(c.loose);
        }
        iso_fail_allocation_after(-1);
    }
    CHECK_OK(status);
    CHECK(n > 20);
}

/* ---- sizes ---- */

static iso_sizes sizes_of(field *material, double cell) {
    world w = {material, cube10};
    iso_body body = body_of(&w, 10, 0.5);
    iso_sizes sizes;
    CHECK_OK(body_sizes(&sizes, &body, cell, 2, NULL));
    return sizes;
}

static double wrapped(double x, double cell) {
    return x - cell * floor(x / cell + 0.5);
}

static double slabs(double x, double y, double z) {
    return fabs(wrapped((x + 2 * y + 2 * z) / 3, 2.5)) - 0.15;
}

static void test_walls_and_the_gaps_between_them(void) {
    iso_sizes s = sizes_of(slabs, 2.5);
    CHECK_NEAR(0.3, s.wall_smallest, 0.01);
    CHECK_NEAR(0.3, s.wall_mean, 0.01);
    CHECK_NEAR(2.2, s.pore_largest, 0.03);
    CHECK_NEAR(2.2, s.pore_mean, 0.05);
    CHECK_NEAR(2.2, s.pore_d10, 0.05);
    CHECK_NEAR(2.2, s.pore_d90, 0.03);
    CHECK_NEAR(2 / 2.5, s.surface, 0.03 * 0.8);
    CHECK_NEAR(0.3 / 2.5, s.material, 0.005);
}

static double bars(double x, double y, double z) {
    double a = wrapped(x, 2.5), b = wrapped(y, 2.5), c = wrapped(z, 2.5);
    double along_x = sqrt(b * b + c * c) - 0.3, along_y = sqrt(a * a + c * c) - 0.4,
           along_z = sqrt(a * a + b * b) - 0.5;
    return fmin(along_x, fmin(along_y, along_z));
}

static void test_the_thinnest_bar_counts(void) {
    iso_sizes s = sizes_of(bars, 2.5);
    CHECK_NEAR(0.6, s.wall_smallest, 0.03);
    CHECK_NEAR(0.85, s.wall_mean, 0.25); /* more where they meet */
}

static double balls(double x, double y, double z) {
    return -ball(wrapped(x, 3), wrapped(y, 3), wrapped(z, 3), 1);
}

static void test_round_pores_are_as_large_as_they_are(void) {
    iso_sizes s = sizes_of(balls, 3);
    CHECK_NEAR(2, s.pore_largest, 0.03);
    CHECK_NEAR(2, s.pore_d50, 0.06);
    CHECK_NEAR(1, s.wall_smallest, 0.05); /* between two balls */
}

static double nothing(double x, double y, double z) {
    (void)x, (void)y, (void)z;
    return 1;
}

static void test_where_nothing_is_nothing_is_found(void) {
    world w = {balls, nothing};
    iso_body body = body_of(&w, 5, 0.5);
    iso_sizes s;
    CHECK_OK(body_sizes(&s, &body, 2, 8, NULL));
    CHECK(s.detail == 0 && s.wall_smallest == 0 && s.pore_d50 == 0);
    iso_body_counts c = count_of(&body);
    CHECK_EQUAL(0, c.part + c.material + c.pieces + c.loose_count + c.closed_pores);
    iso_release(c.loose);
}

int main(void) {
    RUN(test_a_cavity_is_a_closed_pore);
    RUN(test_a_drilled_cavity_is_open);
    RUN(test_of_two_balls_the_smaller_is_loose);
    RUN(test_each_body_of_the_part_keeps_its_piece);
    RUN(test_the_surface_of_a_slanted_slab);
    RUN(test_the_specific_surface_of_a_gyroid);
    RUN(test_any_number_of_threads_counts_the_same);
    RUN(test_no_memory_is_told);
    RUN(test_walls_and_the_gaps_between_them);
    RUN(test_the_thinnest_bar_counts);
    RUN(test_round_pores_are_as_large_as_they_are);
    RUN(test_where_nothing_is_nothing_is_found);
    return check_verdict();
}

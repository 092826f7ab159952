#include <isoslice/skirt.h>

#include <math.h>

#include "base/memory.h"
#include "check.h"

static const double pi = 3.14159265358979323846;
static iso_planar_scratch *scratch;

enum { MM = ISO_UNITS_PER_MM };

static void add_box(iso_region *region, double x0, double y0, double x1, double y1, int hole) {
    iso_point p[4] = {{(int32_t)(x0 * MM), (int32_t)(y0 * MM)},
                      {(int32_t)(x1 * MM), (int32_t)(y0 * MM)},
                      {(int32_t)(x1 * MM), (int32_t)(y1 * MM)},
                      {(int32_t)(x0 * MM), (int32_t)(y1 * MM)}};
    if (hole) {
        iso_point t = p[1];
        p[1] = p[3];
        p[3] = t;
    }
    CHECK_OK(iso_region_add(region, p, 4));
}

/* A frame of 20 mm around a hole of 12 mm, in which a block of 4 mm stands. */
static void make_frame(iso_region *region) {
    add_box(region, 0, 0, 20, 20, 0);
    add_box(region, 4, 4, 16, 16, 1);
    add_box(region, 8, 8, 12, 12, 0);
    region->parent[0] = -1;
    region->parent[1] = 0;
    region->parent[2] = 1;
}

static double length_of(const iso_paths *paths, int32_t i) {
    double sum = 0;
    for (int32_t k = 0; k < paths->path[i].count; k++) {
        iso_point a = paths->vertex[paths->path[i].first + k].at;
        iso_point b = paths->vertex[paths->path[i].first + (k + 1) % paths->path[i].count].at;
        sum += hypot((double)b.x - a.x, (double)b.y - a.y);
    }
    return sum / MM;
}

/* Around a square of side a at distance d: 4 a + 2 pi d. In a hole: 4 (a - 2 d). */
static void test_lengths(void) {
    iso_bead bead = iso_bead_of(4500, 2000);
    for (int type = 1; type < 4; type++) {
        iso_region frame = {0};
        iso_paths paths = {0};
        iso_brim_options options = {.loops = 3,
                                    .distance = 6000,
                                    .outer = type & 1,
                                    .inner = type & 2,
                                    .bead = bead,
                                    .rank = 5};
        double expected = 0, drawn = 0;
        int32_t expected_count = 0;
        make_frame(&frame);
        CHECK_OK(iso_brim(&paths, &frame, &options, scratch));
        for (int i = 0; i < 3; i++) {
            double d = 0.6 + i * bead.spacing / (double)MM;
            if (type & 1)
                expected += 80 + 2 * pi * d, expected_count++;
            if (type & 2)
                expected += 4 * (12 - 2 * d) + 16 + 2 * pi * d, expected_count += 2;
        }
        for (int32_t i = 0; i < paths.count; i++) {
            drawn += length_of(&paths, i);
            CHECK(paths.path[i].closed && paths.path[i].role == ISO_ROLE_SKIRT);
            CHECK(i == 0 || paths.path[i].rank >= paths.path[i - 1].rank);
        }
        CHECK_EQUAL(expected_count, paths.count);
        CHECK_NEAR(expected, drawn, 0.002 * expected);
        CHECK_EQUAL(5, paths.path[0].rank);
        iso_paths_free(&paths);
        iso_region_free(&frame);
    }
}

/* Two blocks 3 mm apart: loops further out than half of that go around both. */
static void test_neighbours_share(void) {
    iso_region blocks = {0};
    iso_paths paths = {0};
    iso_brim_options options = {
        .loops = 8, .distance = 3000, .outer = true, .bead = iso_bead_of(5000, 2000)};
    add_box(&blocks, 0, 0, 10, 10, 0);
    add_box(&blocks, 13, 0, 23, 10, 0);
    blocks.parent[0] = blocks.parent[1] = -1;
    CHECK_OK(iso_brim(&paths, &blocks, &options, scratch));
    int32_t apart = 0;
    for (int i = 0; i < 8; i++)
        apart += 0.3 + i * options.bead.spacing / (double)MM < 1.5;
    CHECK(apart > 1 && apart < 7);
    CHECK_EQUAL(8 + apart, paths.count);
    iso_paths_free(&paths);
    iso_region_free(&blocks);
}

static void test_no_memory(void) {
    iso_status status = ISO_NO_MEMORY;
    iso_brim_options options = {.loops = 2,
                                .distance = 3000,
                                .outer = true,
                                .inner = true,
                                .bead = iso_bead_of(5000, 2000)};
    iso_region frame = {0};
    int64_t n = 0;
    make_frame(&frame);
    for (; status == ISO_NO_MEMORY && n < 1000; n++) {
        iso_paths paths = {0};
        iso_planar_scratch *own;
        CHECK_OK(iso_planar_scratch_new(&own));
        iso_fail_allocation_after(n);
        status = iso_brim(&paths, &frame, &options, own);
        iso_fail_allocation_after(-1);
        if (status != ISO_OK)
            CHECK(paths.count == 0 && paths.vertex_count == 0);
        iso_planar_scratch_free(own);
        iso_paths_free(&paths);
    }
    CHECK_STATUS(ISO_OK, status);
    CHECK(n > 5);
    iso_region_free(&frame);
}

int main(void) {
    CHECK_OK(iso_planar_scratch_new(&scratch));
    RUN(test_lengths);
    RUN(test_neighbours_share);
    RUN(test_no_memory);
    iso_planar_scratch_free(scratch);
    return check_verdict();
}

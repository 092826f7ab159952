#include <isoslice/path.h>

#include "base/memory.h"
#include "check.h"

/* The words PrusaSlicer 2.5 writes behind ";TYPE:". */
static void test_role_names(void) {
    static const char *const name[] = {"External perimeter",
                                       "Perimeter",
                                       "Overhang perimeter",
                                       "Internal infill",
                                       "Solid infill",
                                       "Top solid infill",
                                       "Ironing",
                                       "Bridge infill",
                                       "Gap fill",
                                       "Skirt/Brim",
                                       "Support material",
                                       "Support material interface",
                                       "Custom"};
    CHECK_EQUAL(sizeof name / sizeof *name, ISO_ROLE_COUNT);
    for (int r = 0; r < ISO_ROLE_COUNT; r++)
        CHECK(strcmp(name[r], iso_role_name((iso_role)r)) == 0);
    CHECK(strcmp("Custom", iso_role_name((iso_role)99)) == 0);
}

static void test_bead_is_a_stadium(void) {
    iso_bead bead = iso_bead_of(4500, 2000);
    CHECK_EQUAL(4500, bead.width);
    CHECK_EQUAL(2000, bead.height);
    CHECK_EQUAL(8141593, bead.area); /* 2500 * 2000 + pi * 10^6 */
    CHECK_EQUAL(4071, bead.spacing);
    bead = iso_bead_of(3000, 3000); /* a circle */
    CHECK_EQUAL(7068583, bead.area);
    CHECK_EQUAL(2356, bead.spacing);
}

/* By adding up strips of the stadium's cross-section. */
static void test_bead_area_by_quadrature(void) {
    for (int32_t h = 500; h <= 3000; h += 500)
        for (int32_t w = h; w <= 8000; w += 750) {
            double sum = 0, r = h / 2.0, n = 20000;
            for (int i = 0; i < n; i++) {
                double y = ((i + 0.5) / n - 0.5) * h;
                sum += (w - h + 2 * sqrt(r * r - y * y)) * h / n;
            }
            iso_bead bead = iso_bead_of(w, h);
            CHECK_NEAR(sum, bead.area, 1 + sum * 1e-6);
            CHECK_NEAR(sum / h, bead.spacing, 0.51);
            CHECK_NEAR(h, iso_bead_height(w, bead.area), w - h < h / 4 ? 20 : 1);
        }
}

static void test_paths_grow_and_keep_what_they_got(void) {
    iso_paths paths = {0};
    iso_point point[40];
    for (int n = 0; n < 40; n++) {
        for (int i = 0; i < n; i++)
            point[i] = (iso_point){n, i};
        iso_path like = {.role = (uint8_t)(n % ISO_ROLE_COUNT),
                         .closed = n % 2,
                         .tool = 1,
                         .speed_class = 1,
                         .object = n,
                         .group = 2 * n,
                         .rank = 3 * n};
        CHECK_OK(iso_paths_add(&paths, &like, point, n, 4000 + n, 8000 + n));
    }
    CHECK_EQUAL(40, paths.count);
    CHECK_EQUAL(39 * 40 / 2, paths.vertex_count);
    for (int n = 0; n < 40; n++) {
        const iso_path *path = &paths.path[n];
        CHECK_EQUAL(n, path->count);
        CHECK_EQUAL(n * (n - 1) / 2, path->first);
        CHECK(path->role == n % ISO_ROLE_COUNT && path->closed == n % 2 && path->tool == 1 &&
              path->speed_class == 1);
        CHECK(path->object == n && path->group == 2 * n && path->rank == 3 * n);
        for (int i = 0; i < n; i++) {
            iso_path_vertex v = paths.vertex[path->first + i];
            CHECK(v.at.x == n && v.at.y == i && v.z == 0 && v.width == 4000 + n &&
                  v.area == 8000 + n);
        }
    }
    iso_paths_clear(&paths);
    CHECK(paths.count == 0 && paths.vertex_count == 0 && paths.path_capacity >= 40);
    iso_paths_free(&paths);
    CHECK(!paths.path && !paths.vertex && paths.path_capacity == 0);
}

static void test_paths_without_memory(void) {
    for (int64_t n = 0;; n++) {
        iso_paths paths = {0};
        iso_point point[3] = {{0, 0}, {1, 0}, {0, 1}};
        iso_fail_allocation_after(n);
        iso_status status = ISO_OK;
        int32_t added = 0;
        for (; added < 30 && status == ISO_OK; added += status == ISO_OK)
            status = iso_paths_add(&paths, &(iso_path){0}, point, 3, 1, 1);
        iso_fail_allocation_after(-1);
        CHECK_EQUAL(added, paths.count);
        CHECK_EQUAL(3 * added, paths.vertex_count);
        iso_paths_free(&paths);
        if (status == ISO_OK)
            break;
        CHECK_EQUAL(ISO_NO_MEMORY, status);
    }
}

/* Paths of a curved layer and of a flat one in one: what is flat lies flat. */
static void test_frames_come_along(void) {
    iso_point point[3] = {{1, 2}, {3, 4}, {5, 6}}, by = {10, 20};
    iso_path like = {.role = ISO_ROLE_SKIRT};
    iso_paths flat = {0}, curved = {0}, all = {0};
    CHECK_OK(iso_paths_add(&flat, &like, point, 2, 4000, 800000));
    CHECK_OK(iso_paths_add(&curved, &like, point, 3, 4000, 800000));
    CHECK_OK(ISO_GROW(curved.frame, curved.frame_capacity, 3));
    CHECK_OK(ISO_GROW(curved.travel, curved.travel_capacity, 1));
    CHECK_OK(ISO_GROW(curved.travel_frame, curved.travel_frame_capacity, 1));
    curved.travel[curved.travel_count++] = point[1];
    for (int i = 0; i < 3; i++)
        curved.frame[i] = (iso_frame){.normal = {0.6, 0, 0.8}, .height = 1000 + i};
    curved.travel_frame[0] = (iso_frame){.normal = {0, 0.6, 0.8}, .z = 77};
    curved.path[0].travel_count = 1;

    CHECK_OK(iso_paths_append(&all, &flat, by, 0));
    CHECK(all.frame == NULL);
    CHECK_OK(iso_paths_append(&all, &curved, by, 0));
    CHECK_OK(iso_paths_append(&all, &flat, by, 0));
    CHECK_OK(iso_paths_add(&all, &like, point, 1, 4000, 800000));
    CHECK_EQUAL(8, all.vertex_count);
    for (int i = 0; i < 8; i++) {
        CHECK_EQUAL(i >= 2 && i < 5 ? 998 + i : 0, all.frame[i].height);
        CHECK_NEAR(i >= 2 && i < 5 ? 0.8 : 1, all.frame[i].normal.z, 0);
    }
    CHECK_EQUAL(1, all.travel_count);
    CHECK_EQUAL(13, all.travel[0].x);
    CHECK_EQUAL(77, all.travel_frame[0].z);

    for (int64_t n = 0; n < 2; n++) { /* without room for frames it stays as it was */
        iso_paths small = {0};
        CHECK_OK(iso_paths_append(&small, &flat, by, 0));
        CHECK_OK(ISO_GROW(small.travel, small.travel_capacity, 1));
        iso_fail_allocation_after(n);
        iso_status status = iso_paths_append(&small, &curved, by, 0);
        iso_fail_allocation_after(-1);
        CHECK_EQUAL(ISO_NO_MEMORY, status);
        CHECK(small.frame == NULL && small.count == 1 && small.vertex_count == 2);
        iso_paths_free(&small);
    }
    iso_paths_clear(&all); /* and then anything flat may come */
    CHECK(all.frame == NULL && all.travel_frame == NULL);
    CHECK_OK(iso_paths_append(&all, &flat, by, 0));
    CHECK(all.frame == NULL);
    iso_paths_free(&all);
    iso_paths_free(&curved);
    iso_paths_free(&flat);
}

int main(void) {
    RUN(test_role_names);
    RUN(test_bead_is_a_stadium);
    RUN(test_bead_area_by_quadrature);
    RUN(test_paths_grow_and_keep_what_they_got);
    RUN(test_paths_without_memory);
    RUN(test_frames_come_along);
    return check_verdict();
}

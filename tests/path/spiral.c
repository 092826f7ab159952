#include "path/spiral.h"

#include "check.h"

enum { MM = ISO_UNITS_PER_MM, HEIGHT = 3000 };

static void make_square(iso_paths *paths) {
    static const iso_point p[] = {{0, 0}, {10 * MM, 0}, {10 * MM, 10 * MM}, {0, 10 * MM}};
    iso_path like = {.closed = 1, .role = ISO_ROLE_EXTERNAL_PERIMETER};
    CHECK_OK(iso_paths_add(paths, &like, p, 4, 4500, 1000));
}

static void test_rises_evenly(void) {
    iso_paths paths = {0};
    bool done;
    make_square(&paths);
    CHECK_OK(path_spiral(&done, &paths, NULL, HEIGHT, false));
    CHECK(done);
    CHECK_EQUAL(5, paths.path[0].count);
    CHECK(!paths.path[0].closed);
    for (int32_t i = 0; i < 5; i++) {
        CHECK_EQUAL(HEIGHT * i / 4 - HEIGHT, paths.vertex[i].z);
        CHECK_EQUAL(1000, paths.vertex[i].area);
    }
    CHECK(paths.vertex[4].at.x == 0 && paths.vertex[4].at.y == 0);
    iso_paths_free(&paths);
}

/* The first turn fills a wedge: half of a layer. */
static void test_starts_from_nothing(void) {
    iso_paths paths = {0};
    bool done;
    int64_t area = 0;
    make_square(&paths);
    CHECK_OK(path_spiral(&done, &paths, NULL, HEIGHT, true));
    for (int32_t i = 0; i < 4; i++)
        area += paths.vertex[i].area;
    CHECK_EQUAL(2000, area);
    CHECK_EQUAL(125, paths.vertex[0].area);
    iso_paths_free(&paths);
}

static void test_goes_on_where_the_last_one_ended(void) {
    iso_paths paths = {0};
    bool done;
    iso_point from = {-500, 200};
    make_square(&paths);
    CHECK_OK(path_spiral(&done, &paths, &from, HEIGHT, false));
    CHECK(paths.vertex[0].at.x == -500 && paths.vertex[0].at.y == 200);
    CHECK(paths.vertex[4].at.x == 0 && paths.vertex[4].at.y == 0);
    CHECK_EQUAL(-HEIGHT, paths.vertex[0].z);
    iso_paths_free(&paths);
}

static void test_other_layers_stay(void) {
    iso_paths paths = {0};
    bool done = true;
    CHECK_OK(path_spiral(&done, &paths, NULL, HEIGHT, false));
    CHECK(!done);
    make_square(&paths);
    make_square(&paths);
    CHECK_OK(path_spiral(&done, &paths, NULL, HEIGHT, false));
    CHECK(!done && paths.path[0].closed && paths.vertex_count == 8);
    iso_paths_free(&paths);
}

int main(void) {
    RUN(test_rises_evenly);
    RUN(test_starts_from_nothing);
    RUN(test_goes_on_where_the_last_one_ended);
    RUN(test_other_layers_stay);
    return check_verdict();
}

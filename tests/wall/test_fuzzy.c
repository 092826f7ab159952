#include "wall/fuzzy.h"

#include <math.h>
#include <string.h>

#include "check.h"

enum { MM = ISO_UNITS_PER_MM };

/* A square of 20 mm as outer wall and within it, an inner one, and a hole's outer wall. */
static void make_walls(iso_paths *paths) {
    static const iso_point outer[] = {{0, 0}, {20 * MM, 0}, {20 * MM, 20 * MM}, {0, 20 * MM}};
    static const iso_point inner[] = {{MM, MM}, {19 * MM, MM}, {19 * MM, 19 * MM}, {MM, 19 * MM}};
    static const iso_point hole[] = {
        {5 * MM, 5 * MM}, {5 * MM, 9 * MM}, {9 * MM, 9 * MM}, {9 * MM, 5 * MM}};
    iso_path like = {.closed = 1, .role = ISO_ROLE_EXTERNAL_PERIMETER};
    CHECK_OK(iso_paths_add(paths, &like, outer, 4, 4500, 100));
    CHECK_OK(iso_paths_add(paths, &like, hole, 4, 4500, 100));
    like.role = ISO_ROLE_PERIMETER;
    CHECK_OK(iso_paths_add(paths, &like, inner, 4, 4400, 99));
}

static double to_square(iso_point p, double low, double high) {
    double x = fmin(fabs(p.x - low), fabs(p.x - high)), y = fmin(fabs(p.y - low), fabs(p.y - high));
    return fmin(x, y);
}

static void test_jitter_stays_in_its_band(void) {
    iso_paths paths = {0}, spare = {0};
    iso_fuzzy_options options = {.on = true, .thickness = 3000, .distance = 8000};
    make_walls(&paths);
    CHECK_OK(fuzzy_skin(&paths, &spare, 0, &options, 7));
    CHECK_EQUAL(3, paths.count);
    const iso_path *wall = &paths.path[0];
    CHECK_NEAR(100, wall->count, 5); /* 80 mm at 0.8 */
    double sum = 0, most = 0;
    for (int32_t i = 0; i < wall->count; i++) {
        double off = to_square(paths.vertex[wall->first + i].at, 0, 20 * MM);
        CHECK(off <= 3001);
        sum += off;
        most = fmax(most, off);
        CHECK(paths.vertex[wall->first + i].width == 4500 &&
              paths.vertex[wall->first + i].area == 100);
    }
    CHECK_NEAR(1500, sum / wall->count, 250); /* even over the band */
    CHECK(most > 2700);
    CHECK_EQUAL(4, paths.path[1].count); /* the hole's */
    CHECK_EQUAL(4, paths.path[2].count);
    iso_paths_free(&paths);
    iso_paths_free(&spare);
}

static void test_seed_decides(void) {
    iso_paths a = {0}, b = {0}, c = {0}, spare = {0};
    iso_fuzzy_options options = {.on = true, .holes = true, .thickness = 3000, .distance = 8000};
    make_walls(&a);
    make_walls(&b);
    make_walls(&c);
    CHECK_OK(fuzzy_skin(&a, &spare, 0, &options, 1));
    CHECK_OK(fuzzy_skin(&b, &spare, 0, &options, 1));
    CHECK_OK(fuzzy_skin(&c, &spare, 0, &options, 2));
    CHECK(a.path[1].count > 4);
    CHECK(a.vertex_count == b.vertex_count &&
          memcmp(a.vertex, b.vertex, (size_t)a.vertex_count * sizeof *a.vertex) == 0);
    CHECK(a.vertex_count != c.vertex_count ||
          memcmp(a.vertex, c.vertex, (size_t)a.vertex_count * sizeof *a.vertex) != 0);
    iso_paths_free(&a);
    iso_paths_free(&b);
    iso_paths_free(&c);
    iso_paths_free(&spare);
}

int main(void) {
    RUN(test_jitter_stays_in_its_band);
    RUN(test_seed_decides);
    return check_verdict();
}

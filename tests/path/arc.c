#include <isoslice/arc.h>

#include <math.h>

#include "base/memory.h"
#include "check.h"

static const double pi = 3.14159265358979323846;
static iso_arena arena;

enum { MM = ISO_UNITS_PER_MM };

static void add_circle(iso_paths *paths, double r, int32_t n, double from, double to, int closed) {
    iso_point point[2000];
    iso_path like = {.closed = (uint8_t)closed, .role = ISO_ROLE_EXTERNAL_PERIMETER};
    for (int32_t i = 0; i < n; i++) {
        double a = from + (to - from) * i / (closed ? n : n - 1);
        point[i] =
            (iso_point){(int32_t)lround(3000 + r * cos(a)), (int32_t)lround(-500 + r * sin(a))};
    }
    CHECK_OK(iso_paths_add(paths, &like, point, n, 4500, 800));
}

static int32_t find(iso_arc **arc, const iso_paths *paths) {
    iso_arc_options options = iso_arc_defaults();
    int32_t count;
    CHECK_OK(iso_paths_find_arcs(arc, &count, paths, &options, &arena));
    return count;
}

/* Open arcs of all sizes are found whole. */
static void test_open_arcs(void) {
    for (int k = 0; k < 40; k++) {
        iso_arena_mark mark = iso_arena_get_mark(&arena);
        iso_paths paths = {0};
        iso_arc *arc;
        double r = (0.5 + 2.3 * k) * MM, from = 0.3 * k, by = (k & 1 ? -1 : 1) * (0.4 + 0.14 * k);
        int32_t n = (int32_t)(fabs(by) * sqrt(r / 8 / 60)) + 8; /* chords within 6 um */
        add_circle(&paths, r, n, from, from + by, 0);
        CHECK_EQUAL(1, find(&arc, &paths));
        CHECK_EQUAL(0, arc->first);
        CHECK_EQUAL(n - 1, arc->count);
        CHECK_EQUAL(k & 1, arc->clockwise);
        CHECK_NEAR(3000, arc->center.x, 0.002 * r + 30);
        CHECK_NEAR(-500, arc->center.y, 0.002 * r + 30);
        CHECK_NEAR(r, arc->radius, 0.002 * r + 30);
        iso_paths_free(&paths);
        iso_arena_pop(&arena, mark);
    }
}

/* A full circle is one arc or a few that all but cover it, none of them a whole turn. */
static void test_circle(void) {
    iso_arena_mark mark = iso_arena_get_mark(&arena);
    iso_paths paths = {0};
    iso_arc *arc;
    add_circle(&paths, 10 * MM, 200, 0, 2 * pi, 1);
    int32_t count = find(&arc, &paths), beads = 0;
    CHECK(count >= 1 && count <= 3);
    for (int32_t i = 0; i < count; i++) {
        CHECK_EQUAL(beads, arc[i].first);
        CHECK(arc[i].count < 200);
        beads += arc[i].count;
    }
    CHECK(beads > 195);
    iso_paths_free(&paths);
    iso_arena_pop(&arena, mark);
}

/* Every vertex and the middle of every bead lie within the tolerance of its arc, on a curve that is
 * no circle: an ellipse. */
static void test_tolerance(void) {
    iso_point point[720];
    iso_path like = {.closed = 1};
    iso_paths paths = {0};
    iso_arc *arc;
    for (int i = 0; i < 720; i++)
        point[i] = (iso_point){(int32_t)lround(20 * MM * cos(i * pi / 360)),
                               (int32_t)lround(11 * MM * sin(i * pi / 360))};
    CHECK_OK(iso_paths_add(&paths, &like, point, 720, 4500, 800));
    int32_t count = find(&arc, &paths), beads = 0;
    CHECK(count > 8 && count < 80);
    for (int32_t i = 0; i < count; i++) {
        beads += arc[i].count;
        for (int32_t k = 0; k <= arc[i].count; k++) {
            iso_point a = point[(arc[i].first + k) % 720], b = point[(arc[i].first + k + 1) % 720];
            CHECK(fabs(hypot(a.x - arc[i].center.x, a.y - arc[i].center.y) - arc[i].radius) <=
                  125.01);
            if (k < arc[i].count)
                CHECK(fabs(hypot((a.x + b.x) / 2.0 - arc[i].center.x,
                                 (a.y + b.y) / 2.0 - arc[i].center.y) -
                           arc[i].radius) <= 125.01);
        }
    }
    CHECK(beads > 700);
    iso_paths_free(&paths);
}

/* Straight lines, corners and squares have none; nor do beads of other widths join in. */
static void test_no_arcs(void) {
    static const iso_point line[] = {{0, 0},      {MM, 0},     {2 * MM, 0},
                                     {3 * MM, 0}, {4 * MM, 0}, {5 * MM, 0}};
    static const iso_point square[] = {{0, 0}, {MM, 0}, {MM, MM}, {0, MM}};
    iso_paths paths = {0};
    iso_arc *arc;
    iso_path like = {0};
    CHECK_OK(iso_paths_add(&paths, &like, line, 6, 4500, 800));
    like.closed = 1;
    CHECK_OK(iso_paths_add(&paths, &like, square, 4, 4500, 800));
    CHECK_EQUAL(0, find(&arc, &paths));
    iso_paths_clear(&paths);
    add_circle(&paths, 10 * MM, 40, 0, 2, 0);
    for (int32_t i = 20; i < 40; i++)
        paths.vertex[i].area = 700;
    CHECK_EQUAL(2, find(&arc, &paths));
    CHECK_EQUAL(20, arc[0].count);
    CHECK_EQUAL(19, arc[1].count);
    CHECK_EQUAL(20, arc[1].first);
    iso_paths_free(&paths);
}

int main(void) {
    RUN(test_open_arcs);
    RUN(test_circle);
    RUN(test_tolerance);
    RUN(test_no_arcs);
    iso_arena_free(&arena);
    return check_verdict();
}

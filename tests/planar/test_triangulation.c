#include "planar/triangulation.h"

#include <stdlib.h>

#include "check.h"
#include "planar/predicate.h"
#include "property.h"

static iso_arena arena;

static int64_t inside_double_area(const iso_triangulation *t) {
    int64_t sum = 0;
    for (int32_t k = 0; k < t->triangle_count; k++)
        if (t->inside[k])
            sum += orient2d(t->vertex[t->origin[3 * k]], t->vertex[t->origin[3 * k + 1]],
                            t->vertex[t->origin[3 * k + 2]]);
    return sum;
}

/* Does a straight run of fences lead from a to b? */
static bool has_way(const iso_triangulation *t, iso_point a, iso_point b) {
    double sum = 0, dx = (double)b.x - a.x, dy = (double)b.y - a.y;
    for (int32_t d = 0; d < 3 * t->triangle_count; d++) {
        int32_t u = t->origin[d], v = t->origin[corner_next(d)];
        if (!t->fence[d] || !t->inside[d / 3])
            continue;
        iso_point p = t->vertex[u], q = t->vertex[v];
        if (orient2d(a, b, p) == 0 && orient2d(a, b, q) == 0 && box_holds(a, b, p) &&
            box_holds(a, b, q))
            sum += (((double)q.x - p.x) * dx + ((double)q.y - p.y) * dy);
    }
    return sum == dx * dx + dy * dy;
}

static const char *is_triangulated(const planar_case *c) {
    static iso_region region;
    iso_triangulation t;
    const char *wrong = NULL;
    must(iso_region_clean(&region, &c->a, ISO_FILL_NONZERO, scratch), "clean");
    iso_arena_mark mark = iso_arena_get_mark(&arena);
    must(triangulate(&t, &region, &arena), "triangulate");
    int32_t points = region.count ? region.first[region.count] : 0;
    if (triangulation_validate(&t) != ISO_OK)
        wrong = fault("%s", iso_error_message());
    else if (inside_double_area(&t) != iso_region_double_area(&region))
        wrong = fault("an area of %lld instead of %lld", (long long)inside_double_area(&t),
                      (long long)iso_region_double_area(&region));
    for (int32_t k = 0; k < region.count && !wrong && points < 400; k++)
        for (int32_t i = region.first[k]; i < region.first[k + 1] && !wrong; i++) {
            iso_point a = region.point[i];
            iso_point b = region.point[i + 1 == region.first[k + 1] ? region.first[k] : i + 1];
            if (!has_way(&t, a, b))
                wrong = fault("no edge from (%d, %d) to (%d, %d)", a.x, a.y, b.x, b.y);
        }
    iso_arena_pop(&arena, mark);
    return wrong;
}

static void test_cases(void) {
    CHECK_EQUAL(0, run_cases("triangulate", is_triangulated, 1200, ISO_COORDINATE_MAX));
}

/* 100,000 points on two circles, one within the other. */
static void test_many_points(void) {
    iso_region region = {0};
    iso_triangulation t;
    add_circle(&region, 0, 0, 8e6, 50000);
    add_circle(&region, 1000, 0, 7.9e6, -50000);
    region.parent[1] = 0;
    CHECK_OK(triangulate(&t, &region, &arena));
    CHECK_OK(triangulation_validate(&t));
    CHECK_EQUAL(iso_region_double_area(&region), inside_double_area(&t));
    iso_region_free(&region);
}

/* A square on a grid: every circle has more than three points on it. */
static void test_grid(void) {
    iso_region region = {0};
    iso_triangulation t;
    for (int32_t i = 0; i < 12; i++)
        for (int32_t k = i & 1; k < 12; k += 2)
            add_box(&region, 100 * i, 100 * k, 100 * i + 100, 100 * k + 100);
    CHECK_OK(triangulate(&t, &region, &arena));
    CHECK_OK(triangulation_validate(&t));
    CHECK_EQUAL(2 * 72 * 10000, inside_double_area(&t));
    iso_region_free(&region);
}

static void test_nothing(void) {
    iso_region region = {0};
    iso_triangulation t;
    CHECK_OK(triangulate(&t, &region, &arena));
    CHECK_EQUAL(0, t.triangle_count);
    must_add(&region, (iso_point[]){{0, 0}, {5, 5}, {9, 9}}, 3);
    CHECK_OK(triangulate(&t, &region, &arena));
    CHECK_EQUAL(0, t.triangle_count);
    iso_region_free(&region);
}

static void test_no_memory(void) {
    iso_region region = {0};
    iso_status status = ISO_NO_MEMORY;
    int64_t n = 0;
    add_circle(&region, 0, 0, 1e5, 300);
    for (; status == ISO_NO_MEMORY && n < 100; n++) {
        iso_arena own = {0};
        iso_triangulation t;
        iso_fail_allocation_after(n);
        status = triangulate(&t, &region, &own);
        iso_fail_allocation_after(-1);
        iso_arena_free(&own);
    }
    CHECK_STATUS(ISO_OK, status);
    CHECK(n > 2);
    iso_region_free(&region);
}

int main(void) {
    must(iso_planar_scratch_new(&scratch), "scratch");
    RUN(test_cases);
    RUN(test_many_points);
    RUN(test_grid);
    RUN(test_nothing);
    RUN(test_no_memory);
    iso_arena_free(&arena);
    iso_planar_scratch_free(scratch);
    return check_verdict();
}

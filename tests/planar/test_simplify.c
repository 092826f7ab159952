/* Simplification: fewer points, the same shape up to the tolerance, the same topology. */
#include "check.h"
#include "oracle.h"
#include "property.h"

typedef struct question {
    const iso_region *region;
    int32_t tolerance;
} question;

static int must_be_in(const void *context, iso_point p) {
    const question *q = context;
    if (oracle_near(q->region, p, q->tolerance + 2))
        return 0;
    return oracle_winding(q->region, p, NULL) ? 1 : -1;
}

static const char *simplifies(const planar_case *c) {
    iso_region region = {0}, out = {0};
    if (iso_region_clean(&region, &c->a, ISO_FILL_NONZERO, scratch) != ISO_OK)
        return fault("clean: %s", iso_error_message());
    const char *text = NULL;
    question q = {&region, c->tolerance};
    if (iso_region_simplify(&out, &region, c->tolerance, scratch) != ISO_OK)
        text = fault("iso_region_simplify: %s", iso_error_message());
    if (!text)
        text = region_fault(&out);
    if (!text)
        text = points_fault(&out, &region, must_be_in, &q, c->points);
    if (!text)
        text = settled_fault(&out);
    if (!text && c->tolerance == 0 &&
        iso_region_double_area(&out) != iso_region_double_area(&region))
        text = "tolerance 0 changes the area";
    iso_region_free(&region);
    iso_region_free(&out);
    return text ? fault("tolerance %d: %s", c->tolerance, text) : NULL;
}

static const char *merges(const planar_case *c) {
    planar_case with = *c;
    with.tolerance = 0;
    return simplifies(&with);
}

static void random_tolerances(void) {
    CHECK_EQUAL(0, run_cases("simplify", simplifies, 300, ISO_COORDINATE_MAX));
}

static void random_collinear(void) {
    CHECK_EQUAL(0, run_cases("merge", merges, 100, ISO_COORDINATE_MAX));
}

/* A chord of sagitta t on a circle of radius r spans 2 acos(1 - t / r); a simplifier that walks
 * greedily and rounds to the points it has may need twice as many. */
static void a_circle(void) {
    iso_region circle = {0}, out = {0};
    add_circle(&circle, 0, 0, 1000000, 20000);
    static const int32_t tolerances[] = {5, 50, 500, 5000};
    for (size_t i = 0; i < 4; i++) {
        double t = tolerances[i], most = 2 * 3.1415926536 / (2 * acos(1 - t / 1e6));
        CHECK_OK(iso_region_simplify(&out, &circle, tolerances[i], scratch));
        CHECK_EQUAL(1, out.count);
        CHECK(point_count(&out) <= 2 * most + 4);
        CHECK(point_count(&out) >= most / 2 - 4);
        CHECK_NEAR((double)iso_region_double_area(&circle), (double)iso_region_double_area(&out),
                   2 * 2 * 3.1415926536 * 1e6 * t);
        for (int32_t k = 0; k < point_count(&circle); k++)
            if (!oracle_near(&out, circle.point[k], tolerances[i] + 2)) {
                CHECK_EQUAL(0, k); /* this point was left too far away */
                break;
            }
    }
    iso_region_free(&circle);
    iso_region_free(&out);
}

static void collinear_runs(void) {
    iso_region in = {0}, out = {0};
    iso_point point[400];
    for (int32_t k = 0; k < 100; k++) {
        point[k] = (iso_point){10 * k, 20 * k};
        point[100 + k] = (iso_point){1000 - 20 * k, 2000 + 10 * k};
        point[200 + k] = (iso_point){-1000 - 10 * k, 3000 - 20 * k};
        point[300 + k] = (iso_point){-2000 + 20 * k, 1000 - 10 * k};
    }
    iso_point turned[400];
    for (int32_t k = 0; k < 400; k++)
        turned[k] = point[(k + 50) % 400];
    must_add(&in, turned, 400);
    CHECK_OK(iso_region_simplify(&out, &in, 0, scratch));
    CHECK_EQUAL(4, point_count(&out));
    CHECK_EQUAL(iso_region_double_area(&in), iso_region_double_area(&out));
    iso_region_free(&in);
    iso_region_free(&out);
}

/* Two teeth that would cut into each other if each were thinned alone. */
static void what_would_collide_is_cleaned(void) {
    iso_region in = {0}, region = {0}, out = {0};
    for (int32_t gap = 2; gap < 40; gap += 3) {
        iso_region_clear(&in);
        must_add(&in, (iso_point[]){{0, 0}, {2000, 0}, {2000, 1000}, {1000, 1000 - 30}, {0, 1000}},
                 5);
        must_add(&in,
                 (iso_point[]){{1000, 1000 - 30 + gap},
                               {2000, 1000 + gap},
                               {2000, 2000},
                               {0, 2000},
                               {0, 1000 + gap}},
                 5);
        CHECK_OK(iso_region_clean(&region, &in, ISO_FILL_NONZERO, scratch));
        CHECK_OK(iso_region_simplify(&out, &region, 35, scratch));
        CHECK(region_fault(&out) == NULL);
        CHECK(out.count == 1 || out.count == 2);
    }
    iso_region_free(&in);
    iso_region_free(&region);
    iso_region_free(&out);
}

static void small_things_may_vanish(void) {
    iso_region in = {0}, out = {0};
    CHECK_OK(iso_region_simplify(&out, &in, 50, scratch));
    CHECK_EQUAL(0, out.count);
    add_box(&in, 0, 0, 100000, 100000);
    add_circle(&in, 200000, 0, 20, 12);
    CHECK_OK(iso_region_simplify(&out, &in, 100, scratch));
    CHECK(region_fault(&out) == NULL);
    CHECK(out.count >= 1 && corners(&out, 0) == 4);
    iso_region_free(&in);
    iso_region_free(&out);
}

int main(void) {
    must(iso_planar_scratch_new(&scratch), "iso_planar_scratch_new");
    RUN(a_circle);
    RUN(collinear_runs);
    RUN(what_would_collide_is_cleaned);
    RUN(small_things_may_vanish);
    RUN(random_tolerances);
    RUN(random_collinear);
    iso_planar_scratch_free(scratch);
    return check_verdict();
}

/* Cleaning: any closed contours become the region that the fill rule says. */
#include "check.h"
#include "oracle.h"
#include "property.h"

#include <stdlib.h>

enum { SMALL = 60 };

static int must_be_in(const void *context, iso_point p) {
    const planar_case *c = context;
    if (oracle_near(&c->a, p, 2))
        return 0;
    return oracle_filled(c->rule, oracle_winding(&c->a, p, NULL)) ? 1 : -1;
}

static int filled(const void *context, int winding_a, int winding_b) {
    (void)winding_b;
    return oracle_filled(*(const iso_fill_rule *)context, winding_a);
}

static const char *area_fault(const planar_case *c, const iso_region *out) {
    if (point_count(&c->a) > SMALL)
        return NULL;
    long double area = oracle_area(&c->a, NULL, filled, &c->rule);
    long double slack = oracle_perimeter(&c->a) + 4 * point_count(&c->a);
    long double off = iso_region_double_area(out) / 2.0L - area;
    return off > slack || off < -slack ? fault("area off by %Lg, allowed %Lg", off, slack) : NULL;
}

/* The order, the starts and, as far as the rule does not care, the directions change nothing; nor
 * does where the whole lies. */
static const char *invariance_fault(const planar_case *c, const iso_region *out) {
    iso_region other = {0}, result = {0}, back = {0};
    const char *text = NULL;
    rng r = {(uint64_t)c->index + 99};
    int flip = c->rule == ISO_FILL_EVEN_ODD ? 2 : c->rule == ISO_FILL_NONZERO;
    region_shuffle(&other, &c->a, flip, &r);
    if (iso_region_clean(&result, &other, c->rule, scratch) != ISO_OK)
        text = fault("shuffled: %s", iso_error_message());
    else if (!oracle_same(&result, out))
        text = "written down in another order, it gives another region";
    int32_t room = ISO_COORDINATE_MAX - c->span, dx = rng_between(&r, -room, room), dy = room / 3;
    if (!text && room > 0) {
        region_shift(&other, &c->a, dx, dy);
        must(iso_region_clean(&result, &other, c->rule, scratch), "clean shifted");
        region_shift(&back, &result, -dx, -dy);
        if (!oracle_same(&back, out))
            text = fault("shifted by %d, %d it gives another region", dx, dy);
    }
    iso_region_free(&other);
    iso_region_free(&result);
    iso_region_free(&back);
    return text;
}

static const char *cleans(const planar_case *c) {
    iso_region out = {0};
    const char *text = NULL;
    if (iso_region_clean(&out, &c->a, c->rule, scratch) != ISO_OK)
        return fault("iso_region_clean: %s", iso_error_message());
    if (!text)
        text = region_fault(&out);
    if (!text)
        text = points_fault(&out, &c->a, must_be_in, c, c->points);
    if (!text)
        text = area_fault(c, &out);
    if (!text)
        text = settled_fault(&out);
    if (!text)
        text = invariance_fault(c, &out);
    iso_region_free(&out);
    return text;
}

static const char *cleans_with(const planar_case *c, iso_fill_rule rule) {
    planar_case with = *c;
    with.rule = rule;
    return cleans(&with);
}

static const char *cleans_positive(const planar_case *c) {
    return cleans_with(c, ISO_FILL_POSITIVE);
}

static const char *cleans_nonzero(const planar_case *c) {
    return cleans_with(c, ISO_FILL_NONZERO);
}

static const char *cleans_even_odd(const planar_case *c) {
    return cleans_with(c, ISO_FILL_EVEN_ODD);
}

static void positive(void) {
    CHECK_EQUAL(0, run_cases("positive", cleans_positive, 300, ISO_COORDINATE_MAX));
}

static void nonzero(void) {
    CHECK_EQUAL(0, run_cases("nonzero", cleans_nonzero, 300, ISO_COORDINATE_MAX));
}

static void even_odd(void) {
    CHECK_EQUAL(0, run_cases("even-odd", cleans_even_odd, 300, ISO_COORDINATE_MAX));
}

static int64_t cleaned_double_area(const iso_region *in, iso_fill_rule rule) {
    iso_region out = {0};
    CHECK_OK(iso_region_clean(&out, in, rule, scratch));
    CHECK_OK(iso_region_validate(&out, scratch));
    int64_t area = iso_region_double_area(&out);
    iso_region_free(&out);
    return area;
}

static void bow_tie(void) {
    iso_region in = {0}, out = {0};
    must_add(&in, (iso_point[]){{0, 0}, {100, 100}, {100, 0}, {0, 100}}, 4);
    CHECK_EQUAL(5000, cleaned_double_area(&in, ISO_FILL_POSITIVE));
    CHECK_EQUAL(10000, cleaned_double_area(&in, ISO_FILL_NONZERO));
    CHECK_EQUAL(10000, cleaned_double_area(&in, ISO_FILL_EVEN_ODD));
    CHECK_OK(iso_region_clean(&out, &in, ISO_FILL_NONZERO, scratch));
    CHECK_EQUAL(0, iso_region_locate(&out, (iso_point){50, 50}));
    CHECK_EQUAL(1, iso_region_locate(&out, (iso_point){20, 50}));
    CHECK_EQUAL(-1, iso_region_locate(&out, (iso_point){50, 20}));
    iso_region_free(&in);
    iso_region_free(&out);
}

static void nested_boxes(void) {
    iso_region in = {0}, out = {0};
    for (int32_t k = 0; k < 5; k++) /* innermost first: the parents must still come first */
        add_box(&in, -10 - 10 * k, -10 - 10 * k, 10 + 10 * k, 10 + 10 * k);
    CHECK_OK(iso_region_clean(&out, &in, ISO_FILL_EVEN_ODD, scratch));
    CHECK_EQUAL(5, out.count);
    CHECK(region_fault(&out) == NULL);
    CHECK_EQUAL(2 * (100 * 100 - 80 * 80 + 60 * 60 - 40 * 40 + 20 * 20),
                iso_region_double_area(&out));
    CHECK_EQUAL(2 * 100 * 100, cleaned_double_area(&in, ISO_FILL_NONZERO));
    iso_region_free(&in);
    iso_region_free(&out);
}

static void twice_around(void) {
    iso_region in = {0};
    iso_point box[] = {{0, 0}, {50, 0}, {50, 50}, {0, 50}, {0, 0}, {50, 0}, {50, 50}, {0, 50}};
    must_add(&in, box, 8);
    CHECK_EQUAL(5000, cleaned_double_area(&in, ISO_FILL_POSITIVE));
    CHECK_EQUAL(5000, cleaned_double_area(&in, ISO_FILL_NONZERO));
    CHECK_EQUAL(0, cleaned_double_area(&in, ISO_FILL_EVEN_ODD));
    iso_region_free(&in);
}

static void opposite_copies_cancel(void) {
    iso_region in = {0};
    add_circle(&in, 5, 5, 1000, 77);
    int32_t n = point_count(&in);
    iso_point *reversed = malloc((size_t)n * sizeof *reversed);
    for (int32_t k = 0; k < n; k++)
        reversed[k] = in.point[n - 1 - k];
    must_add(&in, reversed, n);
    CHECK_EQUAL(0, cleaned_double_area(&in, ISO_FILL_NONZERO));
    free(reversed);
    iso_region_free(&in);
}

static void boxes_side_by_side_become_one(void) {
    iso_region in = {0}, out = {0};
    for (int32_t k = 0; k < 100; k++)
        add_box(&in, k % 10 * 30, k / 10 * 30, k % 10 * 30 + 30, k / 10 * 30 + 30);
    CHECK_OK(iso_region_clean(&out, &in, ISO_FILL_NONZERO, scratch));
    CHECK_EQUAL(1, out.count);
    CHECK_EQUAL(2 * 300 * 300, iso_region_double_area(&out));
    iso_region_free(&in);
    iso_region_free(&out);
}

/* Eight triangles with one edge each through the origin: pockets hardly wider than a unit. */
static void a_pencil_of_triangles_has_parents(void) {
    static const iso_point triangle[][3] = {{{53760, -21116}, {-53760, 21116}, {-25336, 8451}},
                                            {{-56744, 78237}, {56744, -78237}, {-56136, -56760}},
                                            {{-42353, -79352}, {42353, 79352}, {59411, -59627}},
                                            {{58097, -79464}, {-58097, 79464}, {70628, 39030}},
                                            {{41292, -21174}, {-41292, 21174}, {45667, 71918}},
                                            {{71916, -27561}, {-71916, 27561}, {67338, -68347}},
                                            {{-49272, 74105}, {49272, -74105}, {76238, 54759}},
                                            {{-45033, 17293}, {45033, -17293}, {37759, -61791}}};
    planar_case c = {.kind = "pencil", .points = 4000, .span = 80000, .rule = ISO_FILL_NONZERO};
    for (int i = 0; i < 8; i++)
        must_add(&c.a, triangle[i], 3);
    CHECK(cleans(&c) == NULL);
    case_free(&c);
}

static void nothing_comes_of_nothing(void) {
    iso_region in = {0}, out = {0};
    add_box(&out, 0, 0, 9, 9); /* what was there before must go */
    CHECK_OK(iso_region_clean(&out, &in, ISO_FILL_NONZERO, scratch));
    CHECK_EQUAL(0, out.count);
    must_add(&in, (iso_point[]){{3, 4}}, 1);
    must_add(&in, (iso_point[]){{3, 4}, {3, 4}, {3, 4}, {3, 4}}, 4);
    must_add(&in, (iso_point[]){{0, 0}, {900, 7}}, 2);
    must_add(&in, (iso_point[]){{0, 0}, {900, 7}, {1800, 14}, {900, 7}}, 4);
    for (int rule = ISO_FILL_POSITIVE; rule <= ISO_FILL_EVEN_ODD; rule++) {
        CHECK_OK(iso_region_clean(&out, &in, (iso_fill_rule)rule, scratch));
        CHECK_EQUAL(0, out.count);
    }
    iso_region_free(&in);
    iso_region_free(&out);
}

static void the_whole_range(void) {
    enum { M = ISO_COORDINATE_MAX };
    iso_region in = {0}, out = {0};
    must_add(&in, (iso_point[]){{-M, -M}, {M, -M}, {M, M}, {-M, M}}, 4);
    CHECK_OK(iso_region_clean(&out, &in, ISO_FILL_NONZERO, scratch));
    CHECK_EQUAL(8 * (int64_t)M * M, iso_region_double_area(&out));
    must_add(&in, (iso_point[]){{-M, -M}, {-M + 1, -M}, {M, M - 1}, {M, M}}, 4);
    must_add(&in, (iso_point[]){{M, -M}, {-M + 1, M}, {-M, M}}, 3);
    CHECK_OK(iso_region_clean(&out, &in, ISO_FILL_EVEN_ODD, scratch));
    CHECK(region_fault(&out) == NULL);
    CHECK_OK(iso_region_clean(&out, &in, ISO_FILL_NONZERO, scratch));
    CHECK_EQUAL(8 * (int64_t)M * M, iso_region_double_area(&out));
    iso_region_free(&in);
    iso_region_free(&out);
}

int main(void) {
    must(iso_planar_scratch_new(&scratch), "iso_planar_scratch_new");
    RUN(bow_tie);
    RUN(nested_boxes);
    RUN(twice_around);
    RUN(opposite_copies_cancel);
    RUN(boxes_side_by_side_become_one);
    RUN(a_pencil_of_triangles_has_parents);
    RUN(nothing_comes_of_nothing);
    RUN(the_whole_range);
    RUN(positive);
    RUN(nonzero);
    RUN(even_odd);
    iso_planar_scratch_free(scratch);
    return check_verdict();
}

/* Regions themselves: storage, location, validation, range, and what happens without memory. */
#include "base/memory.h"
#include "check.h"
#include "oracle.h"
#include "property.h"

#include <stdlib.h>

/* --- storage --- */

static void add_and_clear(void) {
    iso_region region = {0};
    CHECK_EQUAL(0, iso_region_double_area(&region));
    add_box(&region, 0, 0, 10, 20);
    must_add(&region, (iso_point[]){{5, 5}, {5, 6}, {6, 5}}, 3);
    CHECK_EQUAL(2, region.count);
    CHECK_EQUAL(0, region.first[0]);
    CHECK_EQUAL(4, region.first[1]);
    CHECK_EQUAL(7, region.first[2]);
    CHECK_EQUAL(-1, region.parent[0]);
    CHECK_EQUAL(-1, region.parent[1]);
    CHECK_EQUAL(6, region.point[6].x);
    CHECK_EQUAL(2 * 200 - 1, iso_region_double_area(&region));
    iso_region_clear(&region);
    CHECK_EQUAL(0, region.count);
    CHECK_EQUAL(0, iso_region_double_area(&region));
    for (int32_t k = 0; k < 5000; k++)
        add_box(&region, k, k, k + 3, k + 4);
    CHECK_EQUAL(5000, region.count);
    CHECK_EQUAL(20000, region.first[5000]);
    CHECK_EQUAL(5000 * 24, iso_region_double_area(&region));
    iso_region_free(&region);
    CHECK_EQUAL(0, region.count);
    iso_region_free(&region);
}

/* --- location --- */

static const char *locates(const planar_case *c) {
    iso_region region = {0};
    const char *text = NULL;
    if (iso_region_clean(&region, &c->a, c->rule, scratch) != ISO_OK)
        return fault("clean: %s", iso_error_message());
    rng r = {(uint64_t)c->index + 1};
    for (int i = 0; i < c->points && region.count && !text; i++) {
        iso_point p = {rng_between(&r, -c->span, c->span), rng_between(&r, -c->span, c->span)};
        iso_point q = region.point[rng_below(&r, point_count(&region))];
        if (i % 4 == 1)
            p = q;
        else if (i % 4 == 2)
            p = (iso_point){q.x, p.y};
        else if (i % 4 == 3)
            p = (iso_point){p.x, q.y};
        int on_edge, winding = oracle_winding(&region, p, &on_edge);
        int due = on_edge ? 0 : winding ? 1 : -1, got = iso_region_locate(&region, p);
        if (due != got)
            text = fault("(%d, %d) is located at %d, not %d", p.x, p.y, got, due);
    }
    iso_region_free(&region);
    return text;
}

static void locate(void) {
    CHECK_EQUAL(0, run_cases("locate", locates, 120, ISO_COORDINATE_MAX));
    iso_region none = {0};
    CHECK_EQUAL(-1, iso_region_locate(&none, (iso_point){0, 0}));
}

/* --- validation --- */

static void expect_broken(const iso_region *region) {
    CHECK(iso_region_validate(region, scratch) != ISO_OK);
    CHECK(iso_error_message()[0] != 0);
    CHECK(strpbrk(iso_error_message(), "0123456789") != NULL);
}

static void two_contours(iso_region *region, iso_point corner_of_second, int32_t size) {
    iso_region_clear(region);
    add_box(region, 0, 0, 100, 100);
    iso_point p = corner_of_second;
    add_box(region, p.x, p.y, p.x + size, p.y + size);
}

static void valid_regions_pass(void) {
    iso_region region = {0};
    CHECK_OK(iso_region_validate(&region, scratch));
    two_contours(&region, (iso_point){200, 0}, 50);
    CHECK_OK(iso_region_validate(&region, scratch));
    two_contours(&region, (iso_point){100, 100}, 50); /* touching in a corner */
    CHECK_OK(iso_region_validate(&region, scratch));
    iso_region_clear(&region);
    add_box(&region, 0, 0, 100, 100);
    must_add(&region, (iso_point[]){{10, 10}, {10, 90}, {90, 90}, {90, 10}}, 4);
    region.parent[1] = 0;
    CHECK_OK(iso_region_validate(&region, scratch));
    add_box(&region, 20, 20, 80, 80);
    region.parent[2] = 1;
    CHECK_OK(iso_region_validate(&region, scratch));
    iso_region_free(&region);
}

static void contours_that_cross(void) {
    iso_region region = {0};
    two_contours(&region, (iso_point){50, 50}, 100);
    expect_broken(&region);
    iso_region_clear(&region); /* through a vertex only */
    must_add(&region, (iso_point[]){{0, 0}, {100, 0}, {0, 100}}, 3);
    must_add(&region, (iso_point[]){{100, 0}, {10, 110}, {-20, 130}, {-20, -20}}, 4);
    expect_broken(&region);
    iso_region_free(&region);
}

static void a_contour_that_crosses_itself(void) {
    iso_region region = {0};
    must_add(&region, (iso_point[]){{0, 0}, {100, 0}, {20, 100}, {80, 100}}, 4);
    expect_broken(&region);
    iso_region_free(&region);
}

static void contours_that_overlap(void) {
    iso_region region = {0};
    two_contours(&region, (iso_point){100, 20}, 50); /* part of an edge */
    expect_broken(&region);
    two_contours(&region, (iso_point){100, 0}, 100); /* a whole edge */
    expect_broken(&region);
    iso_region_free(&region);
}

static void a_contour_twice(void) {
    iso_region region = {0};
    two_contours(&region, (iso_point){0, 0}, 100);
    expect_broken(&region);
    region.parent[1] = 0;
    expect_broken(&region);
    iso_region_free(&region);
}

static void an_outer_contour_turned_around(void) {
    iso_region region = {0};
    must_add(&region, (iso_point[]){{0, 0}, {0, 100}, {100, 100}, {100, 0}}, 4);
    expect_broken(&region);
    iso_region_free(&region);
}

static void a_hole_turned_around(void) {
    iso_region region = {0};
    two_contours(&region, (iso_point){20, 20}, 50);
    region.parent[1] = 0;
    expect_broken(&region);
    iso_region_free(&region);
}

static void a_wrong_parent(void) {
    iso_region region = {0};
    two_contours(&region, (iso_point){200, 0}, 50);
    region.parent[1] = 0; /* lies beside it */
    expect_broken(&region);
    iso_region_clear(&region);
    add_box(&region, 0, 0, 100, 100);
    must_add(&region, (iso_point[]){{10, 10}, {10, 90}, {90, 90}, {90, 10}}, 4);
    expect_broken(&region); /* none */
    region.parent[1] = 0;
    add_box(&region, 20, 20, 80, 80);
    region.parent[2] = -1;
    expect_broken(&region);
    region.parent[2] = 0; /* skips a generation */
    expect_broken(&region);
    region.parent[2] = 2; /* itself */
    expect_broken(&region);
    region.parent[2] = 7; /* nobody */
    expect_broken(&region);
    region.parent[2] = -2;
    expect_broken(&region);
    iso_region_free(&region);
}

static void a_parent_after_its_child(void) {
    iso_region region = {0};
    must_add(&region, (iso_point[]){{10, 10}, {10, 90}, {90, 90}, {90, 10}}, 4);
    add_box(&region, 0, 0, 100, 100);
    region.parent[0] = 1;
    expect_broken(&region);
    iso_region_free(&region);
}

static void contours_without_area(void) {
    iso_region region = {0};
    must_add(&region, (iso_point[]){{0, 0}, {100, 0}}, 2);
    expect_broken(&region);
    iso_region_clear(&region);
    must_add(&region, (iso_point[]){{0, 0}, {100, 0}, {200, 0}}, 3);
    expect_broken(&region);
    iso_region_clear(&region);
    must_add(&region, (iso_point[]){{0, 0}, {100, 0}, {100, 0}, {100, 100}}, 4); /* repeated */
    expect_broken(&region);
    iso_region_clear(&region);
    must_add(&region, (iso_point[]){{0, 0}, {100, 0}, {200, 0}, {100, 0}, {100, 100}}, 5);
    expect_broken(&region); /* a spike */
    iso_region_free(&region);
}

/* Break a large random region in one place. */
static void one_broken_point_in_thousands(void) {
    iso_region raw = {0}, region = {0};
    add_circle(&raw, 0, 0, 1000000, 6000);
    add_circle(&raw, 0, 0, 500000, -3000);
    CHECK_OK(iso_region_clean(&region, &raw, ISO_FILL_POSITIVE, scratch));
    CHECK_OK(iso_region_validate(&region, scratch));
    iso_point *p = &region.point[4321];
    iso_point kept = *p;
    *p = (iso_point){-kept.x, -kept.y};
    expect_broken(&region);
    *p = region.point[4320];
    expect_broken(&region);
    *p = kept;
    CHECK_OK(iso_region_validate(&region, scratch));
    iso_region_free(&raw);
    iso_region_free(&region);
}

/* --- range --- */

static void out_of_range(void) {
    enum { M = ISO_COORDINATE_MAX };
    static const iso_point beyond[][3] = {{{0, -100}, {M + 1, 0}, {0, 100}},
                                          {{100, 0}, {-100, 0}, {0, -M - 1}},
                                          {{100, 0}, {INT32_MAX, INT32_MAX}, {0, 100}},
                                          {{0, 100}, {INT32_MIN, 0}, {0, -100}},
                                          {{0, 100}, {INT32_MIN, INT32_MIN}, {100, 0}},
                                          {{-100, 0}, {100, 0}, {0, INT32_MAX}}};
    iso_region in = {0}, out = {0}, good = {0};
    iso_offset_options options = iso_offset_defaults(100);
    add_box(&good, 0, 0, 100, 100);
    for (size_t i = 0; i < sizeof beyond / sizeof *beyond; i++) {
        iso_region_clear(&in);
        must_add(&in, beyond[i], 3);
        CHECK_STATUS(ISO_OUTSIDE, iso_region_clean(&out, &in, ISO_FILL_NONZERO, scratch));
        CHECK_EQUAL(0, out.count);
        CHECK_STATUS(ISO_OUTSIDE, iso_boolean(&out, ISO_UNION, &good, &in, scratch));
        CHECK_STATUS(ISO_OUTSIDE, iso_boolean(&out, ISO_INTERSECTION, &in, &good, scratch));
        CHECK_EQUAL(0, out.count);
        CHECK_STATUS(ISO_OUTSIDE, iso_offset(&out, &in, &options, scratch));
        CHECK_EQUAL(0, out.count);
        CHECK_STATUS(ISO_OUTSIDE, iso_region_simplify(&out, &in, 10, scratch));
        CHECK_EQUAL(0, out.count);
        expect_broken(&in);
    }
    iso_region_free(&in);
    iso_region_free(&out);
    iso_region_free(&good);
}

/* --- no memory --- */

typedef iso_status operation(iso_region *out, const iso_region *a, const iso_region *b,
                             iso_planar_scratch *own);

static iso_status clean_it(iso_region *out, const iso_region *a, const iso_region *b,
                           iso_planar_scratch *own) {
    (void)b;
    return iso_region_clean(out, a, ISO_FILL_NONZERO, own);
}

static iso_status unite(iso_region *out, const iso_region *a, const iso_region *b,
                        iso_planar_scratch *own) {
    return iso_boolean(out, ISO_UNION, a, b, own);
}

static iso_status exclude(iso_region *out, const iso_region *a, const iso_region *b,
                          iso_planar_scratch *own) {
    return iso_boolean(out, ISO_EXCLUSIVE, a, b, own);
}

static iso_status offset_with(iso_region *out, const iso_region *a, iso_planar_scratch *own,
                              int32_t distance, iso_join join) {
    iso_region region = {0};
    iso_offset_options options = iso_offset_defaults(distance);
    options.join = join;
    iso_status status = iso_region_clean(&region, a, ISO_FILL_NONZERO, own);
    if (status == ISO_OK)
        status = iso_offset(out, &region, &options, own);
    iso_region_free(&region);
    return status;
}

static iso_status grow(iso_region *out, const iso_region *a, const iso_region *b,
                       iso_planar_scratch *own) {
    (void)b;
    return offset_with(out, a, own, 900, ISO_JOIN_ROUND);
}

static iso_status shrink(iso_region *out, const iso_region *a, const iso_region *b,
                         iso_planar_scratch *own) {
    (void)b;
    return offset_with(out, a, own, -900, ISO_JOIN_MITRE);
}

static iso_status thin(iso_region *out, const iso_region *a, const iso_region *b,
                       iso_planar_scratch *own) {
    (void)b;
    iso_region region = {0};
    iso_status status = iso_region_clean(&region, a, ISO_FILL_NONZERO, own);
    if (status == ISO_OK)
        status = iso_region_simplify(out, &region, 300, own);
    if (status == ISO_OK)
        status = iso_region_validate(out, own);
    if (status != ISO_OK)
        iso_region_clear(out); /* validation failed, not the operation */
    iso_region_free(&region);
    return status;
}

static iso_status copy_by_adding(iso_region *out, const iso_region *a, const iso_region *b,
                                 iso_planar_scratch *own) {
    (void)b;
    (void)own;
    for (int32_t i = 0; i < a->count; i++)
        ISO_TRY(iso_region_add(out, a->point + a->first[i], corners(a, i)));
    return ISO_OK;
}

/* Every allocation fails once; `step` > 1 tries some of them. Afterwards the same scratch and the
 * same output still work. */
static void starve(operation *operate, const planar_case *c, int clears, int64_t step) {
    iso_region out = {0}, whole = {0};
    iso_status status = ISO_NO_MEMORY;
    CHECK_OK(operate(&whole, &c->a, &c->b, scratch));
    for (int64_t n = 0; n < 10000 && status != ISO_OK; n += step) {
        iso_planar_scratch *own = NULL;
        iso_fail_allocation_after(n);
        status = iso_planar_scratch_new(&own);
        int made = status == ISO_OK;
        if (made)
            status = operate(&out, &c->a, &c->b, own);
        iso_fail_allocation_after(-1);
        if (status != ISO_OK && !CHECK_EQUAL(ISO_NO_MEMORY, status))
            break;
        if (status != ISO_OK && clears && !CHECK_EQUAL(0, out.count))
            break;
        if (made && status != ISO_OK && n % (3 * step) == 0) {
            iso_region_clear(&out);
            CHECK_OK(operate(&out, &c->a, &c->b, own));
        }
        if (made && n % (3 * step) == 0)
            CHECK(oracle_same(&out, &whole));
        iso_planar_scratch_free(own);
        iso_region_free(&out);
    }
    CHECK_EQUAL(ISO_OK, status); /* or the allocations never end */
    iso_region_free(&whole);
}

static void starve_all(const planar_case *c, int64_t step) {
    starve(clean_it, c, 1, step);
    starve(unite, c, 1, step);
    starve(exclude, c, 1, step);
    starve(grow, c, 1, step);
    starve(shrink, c, 1, step);
    starve(thin, c, 1, step);
    starve(copy_by_adding, c, 0, 1);
}

static void without_memory(void) {
    planar_case c = {0};
    for (int64_t i = 0; i < 9; i++) {
        case_make(&c, i, 1 << 22);
        starve_all(&c, 1);
    }
    case_make(&c, 19, 100000); /* too large for the first page of scratch */
    starve_all(&c, 3);
    case_free(&c);
    iso_planar_scratch_free(NULL);
}

static void counts_add_up(void) {
    iso_planar_scratch *own = NULL;
    CHECK_OK(iso_planar_scratch_new(&own));
    iso_region in = {0}, out = {0};
    add_box(&in, 0, 0, 1000, 1000);
    CHECK_OK(iso_region_clean(&out, &in, ISO_FILL_NONZERO, own));
    add_box(&in, 500, 500, 1500, 1500);
    CHECK_OK(iso_region_clean(&out, &in, ISO_FILL_NONZERO, own));
    iso_planar_counts counts = iso_planar_get_counts(own);
    CHECK_EQUAL(2, counts.operations);
    CHECK_EQUAL(2, counts.untouched + counts.arranged);
    CHECK_EQUAL(1, counts.arranged);
    CHECK(counts.collisions >= 2);
    iso_region_free(&in);
    iso_region_free(&out);
    iso_planar_scratch_free(own);
}

int main(void) {
    must(iso_planar_scratch_new(&scratch), "iso_planar_scratch_new");
    RUN(add_and_clear);
    RUN(locate);
    RUN(valid_regions_pass);
    RUN(contours_that_cross);
    RUN(a_contour_that_crosses_itself);
    RUN(contours_that_overlap);
    RUN(a_contour_twice);
    RUN(an_outer_contour_turned_around);
    RUN(a_hole_turned_around);
    RUN(a_wrong_parent);
    RUN(a_parent_after_its_child);
    RUN(contours_without_area);
    RUN(one_broken_point_in_thousands);
    RUN(out_of_range);
    RUN(without_memory);
    RUN(counts_add_up);
    iso_planar_scratch_free(scratch);
    return check_verdict();
}

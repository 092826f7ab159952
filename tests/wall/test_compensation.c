#include "wall/compensation.h"

#include "check.h"

static iso_planar_scratch *scratch;

enum { MM = ISO_UNITS_PER_MM };

static void add_box(iso_region *region, double x0, double y0, double x1, double y1) {
    iso_point p[4] = {{(int32_t)(x0 * MM), (int32_t)(y0 * MM)},
                      {(int32_t)(x1 * MM), (int32_t)(y0 * MM)},
                      {(int32_t)(x1 * MM), (int32_t)(y1 * MM)},
                      {(int32_t)(x0 * MM), (int32_t)(y1 * MM)}};
    CHECK_OK(iso_region_add(region, p, 4));
}

/* mm^2 of a block of 20 mm, with a hole of 8 mm in it that a post of 2 mm stands in, compensated.
 */
static double area_after(iso_compensation c) {
    iso_region raw = {0}, region = {0}, spare[2] = {0};
    add_box(&raw, 0, 0, 20, 20);
    add_box(&raw, 6, 6, 14, 14);
    add_box(&raw, 9, 9, 11, 11);
    CHECK_OK(iso_region_clean(&region, &raw, ISO_FILL_EVEN_ODD, scratch));
    CHECK_OK(compensate(&region, (iso_region *[2]){&spare[0], &spare[1]}, &c, scratch));
    CHECK_OK(iso_region_validate(&region, scratch));
    double area = (double)iso_region_double_area(&region) / 2 / ((double)MM * MM);
    iso_region_free(&raw);
    iso_region_free(&region);
    iso_region_free(&spare[0]);
    iso_region_free(&spare[1]);
    return area;
}

static void test_areas(void) {
    CHECK_NEAR(400 - 64 + 4, area_after((iso_compensation){0}), 1e-9);
    CHECK_NEAR(20.4 * 20.4 - 7.6 * 7.6 + 2.4 * 2.4, area_after((iso_compensation){.all = 2000}),
               1e-3);
    CHECK_NEAR(19.4 * 19.4 - 8.6 * 8.6 + 1.4 * 1.4, area_after((iso_compensation){.all = -3000}),
               1e-3);
    CHECK_NEAR(400 - 8.5 * 8.5 + 4, area_after((iso_compensation){.holes = 2500}), 1e-3);
    CHECK_NEAR(400 - 7.5 * 7.5 + 4, area_after((iso_compensation){.holes = -2500}), 1e-3);
    CHECK_NEAR(20.2 * 20.2 - 8.2 * 8.2 + 2.2 * 2.2,
               area_after((iso_compensation){.all = 1000, .holes = 2000}), 1e-3);
    CHECK_NEAR(19.6 * 19.6 - 8.4 * 8.4 + 1.6 * 1.6,
               area_after((iso_compensation){.foot = 2000, .narrowest = 4500}), 1e-3);
}

/* A blade that a bead just fits into keeps its width; the block it stands on shrinks. */
static void test_foot_spares_narrow_places(void) {
    iso_region raw = {0}, region = {0}, spare[2] = {0};
    iso_compensation c = {.foot = 2000, .narrowest = 4500};
    add_box(&raw, 0, 0, 10, 10);
    add_box(&raw, 9, 4, 20, 4.5);
    CHECK_OK(iso_region_clean(&region, &raw, ISO_FILL_NONZERO, scratch));
    CHECK_OK(compensate(&region, (iso_region *[2]){&spare[0], &spare[1]}, &c, scratch));
    CHECK_OK(iso_region_validate(&region, scratch));
    CHECK_EQUAL(1, iso_region_locate(&region, (iso_point){15 * MM, 4 * MM + 100}));
    CHECK_EQUAL(1, iso_region_locate(&region, (iso_point){15 * MM, 4 * MM + 4900}));
    CHECK_EQUAL(-1, iso_region_locate(&region, (iso_point){5 * MM, 1900}));
    CHECK_EQUAL(1, iso_region_locate(&region, (iso_point){5 * MM, 2100}));
    CHECK_EQUAL(1, region.count);
    iso_region_free(&raw);
    iso_region_free(&region);
    iso_region_free(&spare[0]);
    iso_region_free(&spare[1]);
}

int main(void) {
    CHECK_OK(iso_planar_scratch_new(&scratch));
    RUN(test_areas);
    RUN(test_foot_spares_narrow_places);
    iso_planar_scratch_free(scratch);
    return check_verdict();
}

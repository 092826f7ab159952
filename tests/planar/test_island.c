/* Islands of a region, and which of them holds a point. */
#include "planar/island.h"

#include "check.h"

static iso_planar_scratch *scratch;

static void add_box(iso_region *region, int32_t x, int32_t y, int32_t size) {
    const iso_point corner[] = {{x, y}, {x + size, y}, {x + size, y + size}, {x, y + size}};
    CHECK_OK(iso_region_add(region, corner, 4));
}

/* A field of frames, every other one with a core in its hole, which holds a frame of its own. */
static void make_field(iso_region *field, int32_t side) {
    iso_region raw = {0};
    for (int32_t i = 0; i < side * side; i++) {
        int32_t x = i % side * 1100, y = i / side * 1100;
        add_box(&raw, x, y, 1000);
        add_box(&raw, x + 100, y + 100, 800);
        if (i % 2 == 0)
            continue;
        add_box(&raw, x + 200, y + 200, 600);
        add_box(&raw, x + 300, y + 300, 400);
        add_box(&raw, x + 450, y + 450, 100);
    }
    CHECK_OK(iso_region_clean(field, &raw, ISO_FILL_EVEN_ODD, scratch));
    iso_region_free(&raw);
}

static void test_islands_take_their_holes(void) {
    iso_region field = {0}, island = {0};
    iso_arena arena = {0};
    iso_islands islands;
    make_field(&field, 6);
    CHECK_OK(islands_of(&islands, &field, &arena));
    CHECK_EQUAL(36 + 2 * 18, islands.count);
    int64_t area = 0;
    for (int32_t i = 0; i < islands.count; i++) {
        CHECK_OK(island_copy(&island, &field, &islands, i));
        CHECK_OK(iso_region_validate(&island, scratch));
        area += iso_region_double_area(&island);
    }
    CHECK_EQUAL(iso_region_double_area(&field), area);
    iso_arena_free(&arena);
    iso_region_free(&field);
    iso_region_free(&island);
}

static void test_the_island_at_a_point(void) {
    iso_region field = {0}, island = {0};
    iso_arena arena = {0};
    iso_islands islands;
    iso_island_search search;
    make_field(&field, 9);
    CHECK_OK(islands_of(&islands, &field, &arena));
    CHECK_OK(island_search_new(&search, &field, &islands, &arena));
    for (int32_t i = 0; i < islands.count; i++) {
        CHECK_OK(island_copy(&island, &field, &islands, i));
        int32_t points = island.first[1]; /* corners of the outer contour, and points within */
        for (int32_t k = 0; k < points; k++) {
            iso_point p = island.point[k], next = island.point[(k + 1) % points];
            iso_point inner = {
                p.x + (next.x > p.x) - (next.x < p.x) - (next.y > p.y) + (next.y < p.y),
                p.y + (next.y > p.y) - (next.y < p.y) + (next.x > p.x) - (next.x < p.x)};
            CHECK_EQUAL(1, iso_region_locate(&island, inner));
            CHECK_EQUAL(i, island_at(&search, p));
            CHECK_EQUAL(i, island_at(&search, inner));
        }
    }
    CHECK_EQUAL(-1, island_at(&search, (iso_point){1050, 50}));
    CHECK_EQUAL(-1, island_at(&search, (iso_point){-1, 500}));
    iso_arena_free(&arena);
    iso_region_free(&field);
    iso_region_free(&island);
}

int main(void) {
    CHECK_OK(iso_planar_scratch_new(&scratch));
    RUN(test_islands_take_their_holes);
    RUN(test_the_island_at_a_point);
    iso_planar_scratch_free(scratch);
    return check_verdict();
}

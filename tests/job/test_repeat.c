/* Walls of upright parts, kept and copied. */
#include <stdlib.h>

#include "base/memory.h"
#include "check.h"
#include "repeat.h"

typedef struct drawn {
    iso_paths paths;
    iso_region area;
    int32_t *group;
    int64_t group_capacity;
} drawn;

static iso_walled walled_of(drawn *d) {
    return (iso_walled){&d->paths, &d->area, &d->group, &d->group_capacity, {.operations = 7}};
}

static void drawn_free(drawn *d) {
    iso_paths_free(&d->paths);
    iso_region_free(&d->area);
    iso_release(d->group);
}

static void add_square(iso_region *region, int32_t low, int32_t high) {
    iso_point corner[] = {{low, low}, {high, low}, {high, high}, {low, high}};
    CHECK_OK(iso_region_add(region, corner, 4));
}

/* Two squares, one in a hole of the other: three contours of two islands. */
static void draw(drawn *d, const iso_wall_options *wall) {
    iso_point corner[] = {{1, 1}, {99, 1}, {99, 99}, {1, 99}};
    iso_path like = wall->like;
    like.closed = 1;
    for (like.group = 0; like.group < 2; like.group++)
        CHECK_OK(iso_paths_add(&d->paths, &like, corner, 4, 45, 80));
    add_square(&d->area, 0, 900);
    add_square(&d->area, 100, 800);
    add_square(&d->area, 200, 700);
    d->area.parent[1] = 0;
    d->area.parent[2] = 1;
    CHECK_OK(ISO_GROW(d->group, d->group_capacity, 3));
    d->group[0] = d->group[1] = 0;
    d->group[2] = 1;
}

static void check_same(const drawn *a, const drawn *b) {
    CHECK_EQUAL(a->paths.count, b->paths.count);
    CHECK_EQUAL(a->paths.vertex_count, b->paths.vertex_count);
    for (int32_t i = 0; i < a->paths.count && i < b->paths.count; i++) {
        CHECK_EQUAL(a->paths.path[i].first, b->paths.path[i].first);
        CHECK_EQUAL(a->paths.path[i].group, b->paths.path[i].group);
        CHECK_EQUAL(a->paths.path[i].object, b->paths.path[i].object);
    }
    for (int32_t v = 0; v < a->paths.vertex_count && v < b->paths.vertex_count; v++) {
        CHECK_EQUAL(a->paths.vertex[v].at.x, b->paths.vertex[v].at.x);
        CHECK_EQUAL(a->paths.vertex[v].width, b->paths.vertex[v].width);
    }
    CHECK_EQUAL(a->area.count, b->area.count);
    for (int32_t c = 0; c < a->area.count && c < b->area.count; c++) {
        CHECK_EQUAL(a->area.parent[c], b->area.parent[c]);
        CHECK_EQUAL(a->area.first[c + 1], b->area.first[c + 1]);
        CHECK_EQUAL(a->group[c], b->group[c]);
    }
}

static void test_the_second_time_is_kept(void) {
    iso_wall_options wall = {.count = 2, .like = {.object = 3}};
    iso_repeat repeat = {0};
    iso_region outline = {0}, other = {0};
    drawn d = {0}, copy = {0};
    iso_walled from = walled_of(&d), to = walled_of(&copy);
    to.cost.operations = 0;
    add_square(&outline, -10, 910);
    add_square(&other, -10, 911);
    draw(&d, &wall);
    CHECK(!repeat_has(&repeat, &outline, &wall));
    CHECK_OK(repeat_keep(&repeat, &outline, &wall, &from));
    CHECK(!repeat_has(&repeat, &outline, &wall));
    CHECK_OK(repeat_keep(&repeat, &outline, &wall, &from));
    CHECK(repeat_has(&repeat, &outline, &wall));
    CHECK(!repeat_has(&repeat, &other, &wall));
    for (int round = 0; round < 2; round++) {
        CHECK_OK(repeat_copy(&to, &repeat));
        check_same(&d, &copy);
        CHECK_EQUAL(7, to.cost.operations);
    }
    CHECK_OK(repeat_keep(&repeat, &other, &wall, &from)); /* once: what was kept stays */
    CHECK(repeat_has(&repeat, &outline, &wall));
    repeat_free(&repeat);
    iso_region_free(&outline);
    iso_region_free(&other);
    drawn_free(&d);
    drawn_free(&copy);
}

/* Each option on which walls depend. */
static void test_other_walls_are_not_kept(void) {
    iso_wall_options wall = {.count = 2}, other;
    iso_repeat repeat = {0};
    iso_region outline = {0};
    drawn d = {0};
    iso_walled from = walled_of(&d);
    add_square(&outline, 0, 1000);
    draw(&d, &wall);
    for (int round = 0; round < 2; round++)
        CHECK_OK(repeat_keep(&repeat, &outline, &wall, &from));
    int32_t *const field[] = {&other.count,          &other.external.width, &other.external.height,
                              &other.external.area,  &other.inner.width,    &other.inner.spacing,
                              &other.external_first, &other.small_length,   &other.fill_inset,
                              &other.arc_tolerance,  &other.thin_least,     &other.gap_least,
                              &other.like.object};
    for (int i = 0; i < (int)(sizeof field / sizeof *field); i++) {
        other = wall;
        CHECK(repeat_has(&repeat, &outline, &other));
        ++*field[i];
        CHECK(!repeat_has(&repeat, &outline, &other));
    }
    other = wall;
    other.like.tool = 1;
    CHECK(!repeat_has(&repeat, &outline, &other));
    repeat_free(&repeat);
    iso_region_free(&outline);
    drawn_free(&d);
}

static void test_failing_allocations(void) {
    iso_wall_options wall = {.count = 2};
    iso_region outline = {0};
    drawn d = {0};
    iso_walled from = walled_of(&d);
    add_square(&outline, 0, 1000);
    draw(&d, &wall);
    iso_status status = ISO_NO_MEMORY;
    for (int after = 0; status != ISO_OK && CHECK(after < 100); after++) {
        iso_repeat repeat = {0};
        CHECK_OK(repeat_keep(&repeat, &outline, &wall, &from));
        iso_fail_allocation_after(after);
        status = repeat_keep(&repeat, &outline, &wall, &from);
        iso_fail_allocation_after(-1);
        CHECK_EQUAL(status == ISO_OK, repeat_has(&repeat, &outline, &wall));
        repeat_free(&repeat);
    }
    iso_region_free(&outline);
    drawn_free(&d);
}

int main(void) {
    RUN(test_the_second_time_is_kept);
    RUN(test_other_walls_are_not_kept);
    RUN(test_failing_allocations);
    return check_verdict();
}

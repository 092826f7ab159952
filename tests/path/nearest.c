#include "path/nearest.h"

#include <stdlib.h>

#include "check.h"

static uint64_t seed;

static int32_t random_below(int32_t n) {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (int32_t)((seed >> 33) % (uint64_t)n);
}

static int64_t distance(iso_point a, iso_point b) {
    int64_t dx = (int64_t)a.x - b.x, dy = (int64_t)a.y - b.y;
    return dx * dx + dy * dy;
}

/* The nearest living candidate, by looking at all of them. */
static iso_candidate plain(const iso_candidate *all, int32_t count, const uint8_t *taken,
                           iso_point from) {
    iso_candidate best = {.owner = -1};
    for (int32_t i = 0; i < count; i++) {
        iso_candidate c = all[i];
        if (taken[c.owner])
            continue;
        int64_t d = distance(c.at, from), e = best.owner < 0 ? INT64_MAX : distance(best.at, from);
        if (d < e ||
            (d == e && (c.owner < best.owner || (c.owner == best.owner && c.name < best.name))))
            best = c;
    }
    return best;
}

/* Points spread over `width` by `height`; `clumps` > 0 puts them into as many places instead. */
static void check_emptying(int32_t count, int32_t owners, int32_t width, int32_t height,
                           int32_t clumps) {
    iso_arena scratch = {0};
    iso_nearest nearest;
    iso_candidate *all = calloc((size_t)count, sizeof *all), *given;
    uint8_t *taken = calloc((size_t)owners, 1);
    CHECK_OK(ISO_PUSH(given, &scratch, count));
    for (int32_t i = 0; i < count; i++) {
        int32_t clump = clumps ? random_below(clumps) : 0;
        iso_point at = {random_below(width) - width / 2, random_below(height) - height / 2};
        if (clumps)
            at = (iso_point){clump * 7919 % width + at.x % 4, clump * 104729 % height + at.y % 4};
        all[i] = given[i] = (iso_candidate){at, random_below(owners), i};
    }
    CHECK_OK(iso_nearest_build(&nearest, given, count, owners, &scratch));
    for (int32_t left = owners; left > 0;) {
        iso_point from = {random_below(3 * width) - width, random_below(3 * height) - height};
        iso_candidate expected = plain(all, count, taken, from);
        const iso_candidate *found = iso_nearest_find(&nearest, from);
        if (!CHECK((found != NULL) == (expected.owner >= 0)) || !found)
            break;
        CHECK(found->owner == expected.owner && found->name == expected.name);
        int32_t go = random_below(2) ? found->owner : random_below(owners);
        left -= !taken[go];
        taken[go] = 1;
        iso_nearest_take(&nearest, go);
        iso_nearest_take(&nearest, go); /* twice is once */
    }
    CHECK(plain(all, count, taken, (iso_point){0, 0}).owner >= 0 ||
          !iso_nearest_find(&nearest, (iso_point){0, 0}));
    free(all);
    free(taken);
    iso_arena_free(&scratch);
}

static void test_against_looking_at_all(void) {
    for (int turn = 0; turn < 6; turn++) {
        seed = (uint64_t)turn;
        check_emptying(1, 1, 10, 10, 0);
        check_emptying(48, 48, 1000, 1000, 0);
        check_emptying(49, 20, 1000, 1000, 0);
        check_emptying(900, 900, 9, 9, 0);
        check_emptying(900, 300, 2000000, 30, 0);
        check_emptying(900, 450, 1, 4000000, 0);
        check_emptying(1500, 700, ISO_COORDINATE_MAX / 2, ISO_COORDINATE_MAX / 2, 0);
        check_emptying(1200, 600, 5000000, 5000000, 5);
    }
}

static void test_none(void) {
    iso_arena scratch = {0};
    iso_nearest nearest;
    CHECK_OK(iso_nearest_build(&nearest, NULL, 0, 0, &scratch));
    CHECK(!iso_nearest_find(&nearest, (iso_point){1, 2}));
    iso_arena_free(&scratch);
}

int main(void) {
    RUN(test_against_looking_at_all);
    RUN(test_none);
    return check_verdict();
}

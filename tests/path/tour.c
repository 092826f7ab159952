#include "path/tour.h"

#include <stdlib.h>

#include "check.h"

static uint64_t seed;

static int32_t random_below(int32_t n) {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (int32_t)((seed >> 33) % (uint64_t)n);
}

static const iso_travel_cost usual = {150e4, 1000e4, 0.18, 2e4, 130};

static iso_point random_point(int32_t span) {
    return (iso_point){random_below(span) - span / 2, random_below(span)};
}

static void make_stops(iso_stop *stop, int32_t count, int32_t span, int32_t length) {
    for (int32_t i = 0; i < count; i++) {
        stop[i].a = random_point(span);
        stop[i].b = (iso_point){stop[i].a.x + random_below(length), stop[i].a.y};
    }
}

static void check_visits_all(const int32_t *tour, int32_t count) {
    uint8_t *seen = calloc((size_t)count, 1);
    for (int32_t k = 0; k < count; k++) {
        if (CHECK(tour[k] >= 0 && tour[k] < 2 * count))
            CHECK_EQUAL(0, seen[tour[k] / 2]++);
    }
    free(seen);
}

static double plain_seconds(const int32_t *tour, const iso_stop *stop, int32_t count,
                            iso_point at) {
    double sum = 0;
    for (int32_t k = 0; k < count; k++) {
        iso_stop s = stop[tour[k] / 2];
        iso_point in = tour[k] % 2 ? s.b : s.a;
        double mm = hypot((double)in.x - at.x, (double)in.y - at.y) / 1e4;
        sum += mm < 22.5 ? 2 * sqrt(mm / 1000) : mm / 150 + 0.15;
        sum += mm > 2 ? 0.18 : 0;
        at = tour[k] % 2 ? s.a : s.b;
    }
    return sum;
}

static void test_never_dearer_than_the_nearest(void) {
    static const int32_t counts[] = {1, 2, 3, 8, 9, 20, 70, 300, 1500};
    iso_arena scratch = {0};
    double saved = 0, all = 0;
    for (int n = 0; n < 9; n++)
        for (int turn = 0; turn < (counts[n] > 100 ? 3 : 30); turn++) {
            int32_t count = counts[n];
            iso_stop *stop = malloc((size_t)count * sizeof *stop);
            int32_t *tour = malloc((size_t)count * sizeof *tour);
            seed = (uint64_t)(1000 * n + turn);
            make_stops(stop, count, 600000, turn % 3 ? 50000 : 1);
            iso_point from = random_point(900000);
            CHECK_OK(iso_tour_nearest(tour, stop, count, from, &scratch));
            check_visits_all(tour, count);
            double before =
                iso_tour_seconds(tour, stop, count, &(iso_tour_frame){.from = from}, &usual);
            CHECK_NEAR(plain_seconds(tour, stop, count, from), before, 1e-9 * before);
            CHECK_OK(iso_tour_improve(tour, stop, count, &(iso_tour_frame){.from = from}, &usual,
                                      &scratch));
            check_visits_all(tour, count);
            double after = plain_seconds(tour, stop, count, from);
            CHECK(after <= before + 1e-9);
            if (count > 50) {
                saved += before - after;
                all += before;
            }
            free(stop);
            free(tour);
        }
    CHECK(saved > 0.08 * all);
    iso_arena_free(&scratch);
}

static double with_end(const int32_t *tour, const iso_stop *stop, int32_t count,
                       const iso_tour_frame *frame) {
    iso_stop all[16];
    int32_t longer[16];
    double best = INFINITY;
    if (frame->ends == 0)
        return plain_seconds(tour, stop, count, frame->from);
    memcpy(all, stop, (size_t)count * sizeof *all);
    memcpy(longer, tour, (size_t)count * sizeof *longer);
    longer[count] = 2 * count;
    for (int32_t i = 0; i < frame->ends; i++) {
        all[count] = (iso_stop){frame->end[i], frame->end[i]};
        best = fmin(best, plain_seconds(longer, all, count + 1, frame->from));
    }
    return best;
}

static double cheapest(const iso_stop *stop, int32_t count, int32_t *tour, int32_t fixed,
                       const iso_tour_frame *frame) {
    if (fixed == count)
        return with_end(tour, stop, count, frame);
    double best = INFINITY;
    for (int32_t k = fixed; k < count; k++) {
        int32_t kept = tour[fixed];
        tour[fixed] = tour[k];
        tour[k] = kept;
        for (int flip = 0; flip < 2; flip++) {
            tour[fixed] ^= 1;
            best = fmin(best, cheapest(stop, count, tour, fixed + 1, frame));
        }
        kept = tour[fixed];
        tour[fixed] = tour[k];
        tour[k] = kept;
    }
    return best;
}

/* Local moves get stuck now and then, but not far from the best of all tours. */
static void test_against_all_tours(void) {
    enum { COUNT = 6, TURNS = 60 };
    iso_arena scratch = {0};
    double sum = 0, least = 0;
    for (int turn = 0; turn < TURNS; turn++) {
        iso_stop stop[COUNT];
        int32_t tour[COUNT], all[COUNT];
        seed = (uint64_t)(77 + turn);
        make_stops(stop, COUNT, 300000, turn % 2 ? 80000 : 1);
        iso_point end[3] = {random_point(300000), random_point(300000), random_point(300000)};
        iso_tour_frame frame = {random_point(300000), end, turn % 4};
        CHECK_OK(iso_tour_nearest(tour, stop, COUNT, frame.from, &scratch));
        double before = with_end(tour, stop, COUNT, &frame);
        CHECK_OK(iso_tour_improve(tour, stop, COUNT, &frame, &usual, &scratch));
        for (int i = 0; i < COUNT; i++)
            all[i] = 2 * i;
        double best = cheapest(stop, COUNT, all, 0, &frame);
        double found = with_end(tour, stop, COUNT, &frame);
        CHECK_NEAR(found, iso_tour_seconds(tour, stop, COUNT, &frame, &usual), 1e-9);
        CHECK(found <= before + 1e-9);
        CHECK(found >= best - 1e-9);
        CHECK(found <= 1.25 * best);
        sum += found;
        least += best;
    }
    CHECK(sum <= 1.03 * least);
    iso_arena_free(&scratch);
}

/* A crossing, and a stop left behind on the way: each is one move from the best. */
static void test_moves(void) {
    iso_arena scratch = {0};
    iso_stop cross[4] = {{{0, 0}, {0, 0}},
                         {{100000, 100000}, {100000, 100000}},
                         {{100000, 0}, {100000, 0}},
                         {{0, 100000}, {0, 100000}}};
    int32_t tour[5] = {0, 2, 4, 6};
    CHECK_OK(iso_tour_improve(tour, cross, 4, &(iso_tour_frame){0}, &usual, &scratch));
    CHECK_NEAR(3 * (2 * sqrt(0.01) + 0.18), plain_seconds(tour, cross, 4, (iso_point){0, 0}), 1e-9);
    iso_stop row[5];
    for (int i = 0; i < 5; i++)
        row[i] = (iso_stop){{30000 * i, 0}, {30000 * i + 10000, 0}};
    int32_t late[5] = {0, 2, 6, 8, 5};
    CHECK_OK(iso_tour_improve(late, row, 5, &(iso_tour_frame){0}, &usual, &scratch));
    for (int i = 0; i < 5; i++)
        CHECK_EQUAL(2 * i, late[i]);
    iso_arena_free(&scratch);
}

/* Everything in a place, and in a line: no cell is divided further. */
static void test_crowds(void) {
    enum { COUNT = 3000 };
    static iso_stop stop[COUNT];
    static int32_t tour[COUNT];
    iso_arena scratch = {0};
    for (int turn = 0; turn < 2; turn++) {
        seed = 3;
        for (int32_t i = 0; i < COUNT; i++)
            stop[i].a = stop[i].b = (iso_point){turn ? random_below(1 << 24) : 5, 5};
        CHECK_OK(iso_tour_nearest(tour, stop, COUNT, (iso_point){0, 0}, &scratch));
        CHECK_OK(iso_tour_improve(tour, stop, COUNT, &(iso_tour_frame){0}, &usual, &scratch));
        check_visits_all(tour, COUNT);
    }
    iso_arena_free(&scratch);
}

static void test_without_memory(void) {
    iso_stop stop[50];
    int32_t tour[50];
    seed = 9;
    make_stops(stop, 50, 100000, 1000);
    for (int64_t n = 0;; n++) {
        iso_arena scratch = {0};
        iso_fail_allocation_after(n);
        iso_status status = iso_tour_nearest(tour, stop, 50, stop[0].a, &scratch);
        if (status == ISO_OK)
            status = iso_tour_improve(tour, stop, 50, &(iso_tour_frame){.from = stop[0].a}, &usual,
                                      &scratch);
        iso_fail_allocation_after(-1);
        iso_arena_free(&scratch);
        if (status == ISO_OK)
            break;
        CHECK_EQUAL(ISO_NO_MEMORY, status);
    }
    check_visits_all(tour, 50);
}

int main(void) {
    RUN(test_never_dearer_than_the_nearest);
    RUN(test_against_all_tours);
    RUN(test_moves);
    RUN(test_crowds);
    RUN(test_without_memory);
    return check_verdict();
}

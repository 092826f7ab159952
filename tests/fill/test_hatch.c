/* The contour-filling multi-link of hatched regions: equations, orbits, crossings. */
#include "fill/hatch.h"

#include <math.h>
#include <stdlib.h>

#include "check.h"
#include "fill/cells.h"
#include "fill/shapes.h"

static const double pi = 3.14159265358979323846;

typedef struct trial { /* a hatch and what it lives in */
    iso_arena arena;
    iso_sweep sweep;
    iso_hatch hatch;
} trial;

/* Hatch the whole region at once: with islands in holes it is a part of more than one piece. */
static void hatch_region(trial *bench, const iso_region *region, double angle, double spacing,
                         int fit) {
    int32_t *member;
    iso_cut *room;
    CHECK_OK(ISO_PUSH(member, &bench->arena, region->count));
    CHECK_OK(ISO_PUSH(room, &bench->arena, region->first[region->count]));
    for (int32_t i = 0; i < region->count; i++)
        member[i] = i;
    iso_fill_part part = {region, member, region->count};
    bench->sweep = iso_sweep_of(angle);
    iso_extent extent;
    int64_t step = (int64_t)(spacing * 256) << 23;
    iso_hatch_extent(&extent, &part, &bench->sweep, spacing);
    if (fit)
        iso_sweep_fit(&bench->sweep, step, step / 2, &extent);
    else
        iso_sweep_repeat(&bench->sweep, step, 0, &extent);
    CHECK_OK(iso_hatch_build(&bench->hatch, &part, &bench->sweep, room, &bench->arena));
}

static void check_equations(trial *bench) {
    const iso_hatch *hatch = &bench->hatch;
    CHECK_OK(iso_fill_link_validate(&hatch->link));
    iso_fill_census census;
    CHECK_OK(iso_fill_link_count(&census, &hatch->link, &bench->arena));
    CHECK(iso_fill_census_is_plane(&census));
    CHECK_EQUAL(census.cells, census.regular + census.extrema + census.saddles);
    int wrong = 0;
    for (int32_t c = 0; c < hatch->link.count; c++) /* down on the left, up on the right */
        wrong += (hatch->crossing[c].edge & 1) != (c & 1);
    CHECK_EQUAL(0, wrong);
}

static int compare_doubles(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Every line crossed again, in long doubles: as many crossings, at the same places. */
static void check_crossings(const trial *bench, const iso_region *region) {
    const iso_sweep *sweep = &bench->sweep;
    int32_t points = region->first[region->count], c = 0, wrong = 0;
    double *along = malloc((size_t)points * sizeof *along);
    for (int32_t l = 0; l < sweep->count; l++) {
        long double level = (long double)sweep->first + (long double)l * sweep->step;
        int count = 0;
        for (int32_t i = 0; i < region->count; i++)
            for (int32_t j = region->first[i], k = region->first[i + 1] - 1;
                 j < region->first[i + 1]; k = j++) {
                iso_point a = region->point[k], b = region->point[j];
                long double va =
                    2.0L * ((long double)a.y * sweep->cosine - (long double)a.x * sweep->sine);
                long double vb =
                    2.0L * ((long double)b.y * sweep->cosine - (long double)b.x * sweep->sine);
                if ((va < level) == (vb < level))
                    continue;
                long double t = (level - va) / (vb - va);
                along[count++] = (double)((a.x + t * (b.x - a.x)) * sweep->cosine +
                                          (a.y + t * (b.y - a.y)) * sweep->sine) /
                                 (1 << 30);
            }
        qsort(along, (size_t)count, sizeof *along, compare_doubles);
        for (int i = 0; i < count; i++, c++) {
            if (c >= bench->hatch.link.count || bench->hatch.link.line[c] != l) {
                wrong++;
                break;
            }
            iso_point at = bench->hatch.crossing[c].at;
            double here = ((double)at.x * sweep->cosine + (double)at.y * sweep->sine) / (1 << 30);
            double off = (2.0 * at.y * sweep->cosine - 2.0 * at.x * sweep->sine - (double)level) /
                         (double)ISO_SWEEP_ONE;
            wrong += fabs(here - along[i]) > 0.75 || fabs(off) > 0.75;
        }
    }
    CHECK_EQUAL(0, wrong);
    CHECK_EQUAL(bench->hatch.link.count, c);
    free(along);
}

static void test_shapes_at_many_angles(void) {
    for (int i = 0; i < shape_count; i++)
        for (double angle = 0; angle < 180; angle += 11.25) {
            iso_region region = {0};
            trial bench = {0};
            shapes[i].make(&region, 3 * angle);
            hatch_region(&bench, &region, angle, 9000, (int)angle % 2);
            check_equations(&bench);
            check_crossings(&bench, &region);
            iso_arena_free(&bench.arena);
            drop_region(&region);
        }
}

/* Vertices on the lines, edges along them, contours that touch: spacings that divide the cells. */
static void test_degenerate_regions(void) {
    static const double angles[] = {0, 45, 90, 135, 26.565051177077990, 71};
    for (unsigned seed = 0; seed < 120; seed++) {
        cells grid = cells_random(seed, 35 + (int)(seed % 5) * 10);
        iso_region region = {0};
        trial bench = {0};
        int turned = seed % 3 == 0;
        cells_region(&region, &grid, turned ? 4096 : 4000, turned ? 2048 : 0);
        hatch_region(&bench, &region, angles[seed % 6], seed % 2 ? 1000 : 4000, seed % 7 == 0);
        check_equations(&bench);
        check_crossings(&bench, &region);
        iso_arena_free(&bench.arena);
        drop_region(&region);
    }
}

/* A square, one hole in the middle, lines along x: cells by hand. Below and above the hole a split
 * and a merge, at the bottom and the top an end. */
static void test_orbits_of_a_square_with_a_hole(void) {
    static const iso_point outer[] = {{0, 0}, {10000, 0}, {10000, 10000}, {0, 10000}};
    static const iso_point hole[] = {{4000, 4000}, {4000, 6000}, {6000, 6000}, {6000, 4000}};
    iso_region region = {0};
    trial bench = {0};
    add_points(&region, outer, 4, -1);
    add_points(&region, hole, 4, 0);
    hatch_region(&bench, &region, 0, 1000, 0); /* just above 0, 1000, ... 9000 */
    iso_fill_census census;
    CHECK_OK(iso_fill_link_count(&census, &bench.hatch.link, &bench.arena));
    CHECK_EQUAL(12, census.segments);
    CHECK_EQUAL(2, census.extrema);
    CHECK_EQUAL(2, census.saddles);
    CHECK_EQUAL(12, census.cells); /* segments + 1 - 1 hole */
    CHECK_EQUAL(8, census.regular);
    CHECK_EQUAL(1, census.parts);
    CHECK_EQUAL(2, census.contours);
    iso_arena_free(&bench.arena);
    drop_region(&region);
}

/* Sixty holes, thin triangles that meet in one point: near it they are less than a unit apart. */
static void test_order_of_edges_closer_than_a_unit(void) {
    static const iso_point outer[] = {
        {-90000, -90000}, {90000, -90000}, {90000, 90000}, {-90000, 90000}};
    iso_region region = {0};
    add_points(&region, outer, 4, -1);
    for (int i = 0; i < 60; i++) {
        double a = (i + 0.25) * pi / 30, b = (i + 0.75) * pi / 30;
        iso_point hole[3] = {{17, 29},
                             {(int32_t)(80000 * cos(b)), (int32_t)(80000 * sin(b))},
                             {(int32_t)(80000 * cos(a)), (int32_t)(80000 * sin(a))}};
        add_points(&region, hole, 3, 0);
    }
    for (double angle = 0; angle < 180; angle += 7.5) {
        trial bench = {0};
        hatch_region(&bench, &region, angle, 100, 0);
        check_equations(&bench);
        iso_arena_free(&bench.arena);
    }
    drop_region(&region);
}

/* More crossings on a line than the insertion sort takes, in no order. */
static void test_long_lines(void) {
    static const iso_point outer[] = {{-1000, 0}, {300000, 0}, {300000, 10000}, {-1000, 10000}};
    iso_region region = {0};
    add_points(&region, outer, 4, -1);
    for (int i = 0; i < 293; i++) {
        int x = i * 100 % 293 * 1000;
        iso_point hole[4] = {{x, 100}, {x, 9900}, {x + 500, 9900}, {x + 500, 100}};
        add_points(&region, hole, 4, 0);
    }
    trial bench = {0};
    hatch_region(&bench, &region, 0, 997, 1);
    check_equations(&bench);
    check_crossings(&bench, &region);
    CHECK_EQUAL(2 * 2 + (bench.sweep.count - 2) * 588, bench.hatch.link.count);
    iso_arena_free(&bench.arena);
    drop_region(&region);
}

static void test_sweep_directions(void) {
    for (int i = -2000; i <= 2000; i++) {
        double degrees = i * 0.271828, half = fmod(fmod(degrees, 180) + 180, 180) * pi / 180;
        iso_sweep sweep = iso_sweep_of(degrees);
        CHECK_NEAR(cos(half) * (1 << 30), (double)sweep.cosine, 1);
        CHECK_NEAR(sin(half) * (1 << 30), (double)sweep.sine, 1);
        CHECK(sweep.sine >= 0);
        CHECK(sweep.along_x * cos(half) + sweep.along_y * sin(half) >= 0.7071);
    }
    iso_sweep diagonal = iso_sweep_of(45), back = iso_sweep_of(-45), up = iso_sweep_of(90);
    CHECK(diagonal.cosine == diagonal.sine && back.cosine == -back.sine);
    CHECK(up.cosine == 0 && up.sine == 1 << 30);
    CHECK_EQUAL(0, iso_sweep_of(180).sine);
    CHECK_EQUAL(0, iso_sweep_of(-1e-300).sine);
}

/* The validator names what is broken. */
static void test_validator(void) {
    iso_region region = {0};
    trial bench = {0};
    shapes[1].make(&region, 0);
    hatch_region(&bench, &region, 30, 50000, 0);
    iso_fill_link *link = &bench.hatch.link;
    CHECK_OK(iso_fill_link_validate(link));
    int32_t kept = link->arc[7];
    link->arc[7] = link->arc[9];
    CHECK_STATUS(ISO_BUG, iso_fill_link_validate(link));
    CHECK(strstr(iso_error_message(), "BB = 1") && strstr(iso_error_message(), "dart"));
    link->arc[7] = 2 * link->count;
    CHECK_STATUS(ISO_BUG, iso_fill_link_validate(link));
    link->arc[7] = kept;
    link->line[3]++;
    CHECK_STATUS(ISO_BUG, iso_fill_link_validate(link));
    CHECK(strstr(iso_error_message(), "qF = q fails at crossing 2"));
    link->line[3]--;
    link->contour[5] ^= 1;
    CHECK_STATUS(ISO_BUG, iso_fill_link_validate(link));
    CHECK(strstr(iso_error_message(), "pB = p"));
    link->contour[5] ^= 1;
    for (int32_t d = 0; d < 2 * link->count; d++) /* swap two arcs' ends across strips */
        if (iso_fill_link_strip(link, d) != iso_fill_link_strip(link, 7) &&
            link->contour[d >> 1] == link->contour[3]) {
            int32_t a = link->arc[d], b = link->arc[7];
            link->arc[d] = b, link->arc[b] = d, link->arc[7] = a, link->arc[a] = 7;
            break;
        }
    CHECK_STATUS(ISO_BUG, iso_fill_link_validate(link));
    CHECK(strstr(iso_error_message(), "strip"));
    iso_arena_free(&bench.arena);
    drop_region(&region);
}

/* z = SBF is a bijection, and on a convex part it draws everything in one go. */
static void test_zigzag_is_a_bijection(void) {
    iso_region region = {0};
    trial bench = {0};
    shapes[3].make(&region, 0);
    hatch_region(&bench, &region, 20, 4500, 0);
    int32_t darts = 2 * bench.hatch.link.count;
    char *hit = calloc((size_t)darts, 1);
    for (int32_t d = 0; d < darts; d++)
        hit[iso_fill_link_zigzag(&bench.hatch.link, d)]++;
    int32_t wrong = 0;
    for (int32_t d = 0; d < darts; d++)
        wrong += hit[d] != 1;
    CHECK_EQUAL(0, wrong);
    free(hit);
    iso_arena_free(&bench.arena);
    drop_region(&region);
}

static int32_t count_orbits(const iso_filling_link *filling, const char *words) {
    int32_t count = 0;
    int32_t *orbit = malloc((size_t)filling->link.size * sizeof *orbit);
    CHECK_OK(iso_multilink_orbits(orbit, &count, &filling->link, words));
    free(orbit);
    return count;
}

/* The library's own validator and orbits, which run the equations as text, agree. */
static void test_general_validator_and_orbits_agree(void) {
    for (int i = 0; i < shape_count; i++) {
        iso_region region = {0};
        trial bench = {0};
        iso_filling_link filling;
        iso_fill_census census;
        shapes[i].make(&region, 10);
        hatch_region(&bench, &region, 50, 12345, i % 2);
        iso_fill_options options = iso_fill_defaults(iso_bead_of(4500, 2000), 1);
        options.spacing = 12345;
        options.angle = 50;
        options.fit = i % 2;
        CHECK_OK(iso_fill_link_count(&census, &bench.hatch.link, &bench.arena));
        CHECK_OK(iso_fill_to_link(&filling, &region, &options, &bench.arena));
        CHECK_OK(iso_multilink_validate(&filling.link));
        CHECK_EQUAL(4 * census.segments, filling.link.size);
        CHECK_EQUAL(census.segments, count_orbits(&filling, "r s"));
        CHECK_EQUAL(census.cells, count_orbits(&filling, "r g"));
        CHECK_EQUAL(census.contours, count_orbits(&filling, "s g"));
        CHECK_EQUAL(census.parts, count_orbits(&filling, "r s g"));
        iso_multilink_free(&filling.link);
        iso_arena_free(&bench.arena);
        drop_region(&region);
    }
    iso_region none = {0};
    iso_arena scratch = {0};
    iso_filling_link filling;
    iso_fill_options options = iso_fill_defaults(iso_bead_of(4500, 2000), 1);
    CHECK_OK(iso_fill_to_link(&filling, &none, &options, &scratch));
    CHECK_EQUAL(0, filling.link.size);
    iso_multilink_free(&filling.link);
    iso_arena_free(&scratch);
}

int main(void) {
    RUN(test_shapes_at_many_angles);
    RUN(test_degenerate_regions);
    RUN(test_orbits_of_a_square_with_a_hole);
    RUN(test_order_of_edges_closer_than_a_unit);
    RUN(test_long_lines);
    RUN(test_sweep_directions);
    RUN(test_validator);
    RUN(test_zigzag_is_a_bijection);
    RUN(test_general_validator_and_orbits_agree);
    return check_verdict();
}

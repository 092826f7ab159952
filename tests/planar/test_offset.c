/* Offsets, against the exact distance to the region and the shape of its joins. */
#include "check.h"
#include "oracle.h"
#include "property.h"

#include <stdlib.h>

enum { LARGEST = 1 << 22 }; /* grown by more than its own size it stays in range */

typedef struct question {
    const iso_region *region;
    const iso_offset_options *options;
} question;

static int must_be_in(const void *context, iso_point p) {
    const question *q = context;
    return oracle_offset(q->region, q->options, p);
}

/* From one unit to more than the shape. Large cases keep to what a printer would ask for. */
static iso_offset_options options_of(const planar_case *c, const iso_region *region, int sign) {
    rng r = {(uint64_t)c->index * 31 + 7};
    int32_t n = point_count(region) ? point_count(region) : 1;
    int32_t mean = (int32_t)(oracle_perimeter(region) / n) + 1, distance = 1;
    switch (rng_below(&r, n > 2000 ? 2 : 6)) {
    case 0:
        distance = rng_between(&r, 1, 5);
        break;
    case 1:
        distance = rng_between(&r, 1, n > 2000 ? 1 + c->span / 2000 : mean);
        break;
    case 2:
        distance = rng_between(&r, 1, 1 + c->span / 50);
        break;
    case 3:
        distance = rng_between(&r, 1, 1 + c->span / 4);
        break;
    default:
        distance = rng_between(&r, 1, c->span + c->span / 5);
    }
    iso_offset_options options = iso_offset_defaults(sign * distance);
    options.mitre_limit = rng_below(&r, 2) ? 2 : rng_between(&r, 110, 250) / 100.0;
    int32_t finest = 1 + distance / 2000;
    options.arc_tolerance = rng_below(&r, 2) && finest <= 50 ? 50 : finest + rng_below(&r, 60);
    return options;
}

static const char *offset_fault(const planar_case *c, const iso_region *region, iso_region *out) {
    if (iso_offset(out, region, &c->offset, scratch) != ISO_OK)
        return fault("iso_offset: %s", iso_error_message());
    const char *text = region_fault(out);
    question q = {region, &c->offset};
    if (!text)
        text = points_fault(out, region, must_be_in, &q, c->points / 2);
    return text ? text : settled_fault(out);
}

static const char *offsets(const planar_case *c, iso_join join, int sign) {
    iso_region region = {0}, out = {0};
    planar_case with = *c;
    const char *text = NULL;
    if (iso_region_clean(&region, &c->a, ISO_FILL_NONZERO, scratch) != ISO_OK)
        return fault("clean: %s", iso_error_message());
    if (!c->offset.distance)
        with.offset = options_of(c, &region, sign);
    with.offset.join = join;
    text = offset_fault(&with, &region, &out);
    if (text)
        text = fault("distance %d, join %d, mitre %g, arc %d: %s", with.offset.distance, join,
                     with.offset.mitre_limit, with.offset.arc_tolerance, text);
    iso_region_free(&region);
    iso_region_free(&out);
    return text;
}

static const char *grows_round(const planar_case *c) {
    return offsets(c, ISO_JOIN_ROUND, 1);
}

static const char *grows_mitred(const planar_case *c) {
    return offsets(c, ISO_JOIN_MITRE, 1);
}

static const char *grows_square(const planar_case *c) {
    return offsets(c, ISO_JOIN_SQUARE, 1);
}

static const char *shrinks_round(const planar_case *c) {
    return offsets(c, ISO_JOIN_ROUND, -1);
}

static const char *shrinks_mitred(const planar_case *c) {
    return offsets(c, ISO_JOIN_MITRE, -1);
}

static const char *shrinks_square(const planar_case *c) {
    return offsets(c, ISO_JOIN_SQUARE, -1);
}

static void random_round(void) {
    CHECK_EQUAL(0, run_cases("grown round", grows_round, 80, LARGEST));
    CHECK_EQUAL(0, run_cases("shrunk round", shrinks_round, 80, LARGEST));
}

static void random_mitred(void) {
    CHECK_EQUAL(0, run_cases("grown mitred", grows_mitred, 100, LARGEST));
    CHECK_EQUAL(0, run_cases("shrunk mitred", shrinks_mitred, 100, LARGEST));
}

static void random_square(void) {
    CHECK_EQUAL(0, run_cases("grown square", grows_square, 60, LARGEST));
    CHECK_EQUAL(0, run_cases("shrunk square", shrinks_square, 60, LARGEST));
}

/* --- by hand --- */

static const double pi = 3.14159265358979323846;

static double offset_area(const iso_region *in, int32_t distance, iso_join join, int32_t *count) {
    iso_region out = {0};
    iso_offset_options options = iso_offset_defaults(distance);
    options.join = join;
    options.arc_tolerance = 1;
    CHECK_OK(iso_offset(&out, in, &options, scratch));
    CHECK(region_fault(&out) == NULL);
    double area = (double)iso_region_double_area(&out) / 2;
    if (count)
        *count = out.count;
    iso_region_free(&out);
    return area;
}

static void a_box(void) {
    enum { S = 100000, D = 10000 };
    iso_region box = {0};
    int32_t count;
    add_box(&box, 0, 0, S, S);
    double s = S, d = D;
    CHECK_NEAR((s + 2 * d) * (s + 2 * d), offset_area(&box, D, ISO_JOIN_MITRE, &count), 0);
    CHECK_EQUAL(1, count);
    CHECK_NEAR(s * s + 4 * s * d + pi * d * d, offset_area(&box, D, ISO_JOIN_ROUND, NULL),
               2 * pi * d * 2);
    /* squared corners are octagonal: d^2 tan(pi / 8) * 2 each */
    CHECK_NEAR(s * s + 4 * s * d + 8 * d * d * (sqrt(2) - 1),
               offset_area(&box, D, ISO_JOIN_SQUARE, NULL), 8 * d);
    for (int join = ISO_JOIN_ROUND; join <= ISO_JOIN_SQUARE; join++) {
        CHECK_NEAR((s - 2 * d) * (s - 2 * d), offset_area(&box, -D, (iso_join)join, NULL), 0);
        CHECK_NEAR(4, offset_area(&box, -(S / 2 - 1), (iso_join)join, &count), 0);
        CHECK_EQUAL(1, count);
        CHECK_NEAR(0, offset_area(&box, -S / 2, (iso_join)join, &count), 0);
        CHECK_EQUAL(0, count);
        CHECK_NEAR(0, offset_area(&box, -2 * S, (iso_join)join, NULL), 0);
        CHECK_NEAR(s * s, offset_area(&box, 0, (iso_join)join, NULL), 0);
    }
    iso_region_free(&box);
}

/* Inside out, the same: a hole's corners open up when the region shrinks. */
static void a_hole(void) {
    iso_region frame = {0}, region = {0};
    int32_t count;
    add_box(&frame, -1000, -1000, 1000, 1000);
    add_box(&frame, -400, -400, 400, 400);
    CHECK_OK(iso_region_clean(&region, &frame, ISO_FILL_EVEN_ODD, scratch));
    CHECK_NEAR(1800. * 1800 - 1000. * 1000, offset_area(&region, -100, ISO_JOIN_MITRE, &count), 0);
    CHECK_EQUAL(2, count);
    CHECK_NEAR(1800. * 1800 - 800. * 800 - 4 * 800. * 100 - pi * 1e4,
               offset_area(&region, -100, ISO_JOIN_ROUND, NULL), 1300);
    CHECK_NEAR(2200. * 2200 - 600. * 600, offset_area(&region, 100, ISO_JOIN_MITRE, &count), 0);
    CHECK_NEAR(2800. * 2800, offset_area(&region, 400, ISO_JOIN_MITRE, &count), 0);
    CHECK_EQUAL(1, count);
    CHECK_NEAR(0, offset_area(&region, -300, ISO_JOIN_MITRE, &count), 0);
    CHECK_EQUAL(0, count);
    iso_region_free(&frame);
    iso_region_free(&region);
}

static void a_dumb_bell_parts(void) {
    iso_region bell = {0};
    int32_t count;
    must_add(&bell,
             (iso_point[]){{0, 0},
                           {1000, 0},
                           {1000, 450},
                           {2000, 450},
                           {2000, 0},
                           {3000, 0},
                           {3000, 1000},
                           {2000, 1000},
                           {2000, 550},
                           {1000, 550},
                           {1000, 1000},
                           {0, 1000}},
             12);
    CHECK_NEAR(2 * 980. * 980 + 1020. * 80, offset_area(&bell, -10, ISO_JOIN_MITRE, &count), 0);
    CHECK_EQUAL(1, count);
    CHECK_NEAR(2 * 880. * 880, offset_area(&bell, -60, ISO_JOIN_MITRE, &count), 0);
    CHECK_EQUAL(2, count);
    iso_region_free(&bell);
}

static void two_boxes_grow_together(void) {
    iso_region boxes = {0};
    int32_t count;
    add_box(&boxes, 0, 0, 1000, 1000);
    add_box(&boxes, 1200, 0, 2200, 1000);
    CHECK_NEAR(2 * 1198. * 1198, offset_area(&boxes, 99, ISO_JOIN_MITRE, &count), 0);
    CHECK_EQUAL(2, count);
    CHECK_NEAR(2402. * 1202, offset_area(&boxes, 101, ISO_JOIN_MITRE, &count), 0);
    CHECK_EQUAL(1, count);
    CHECK_NEAR(2400. * 1200, offset_area(&boxes, 100, ISO_JOIN_MITRE, &count), 0);
    CHECK_EQUAL(1, count);
    iso_region_free(&boxes);
}

/* A sharp tip: with limit 2, anything under 60 degrees is cut off at the distance. */
static void the_mitre_limit(void) {
    iso_region tip = {0}, out = {0};
    must_add(&tip, (iso_point[]){{0, 0}, {-100000, 10000}, {-100000, -10000}}, 3);
    iso_offset_options options = iso_offset_defaults(1000);
    CHECK_EQUAL(1000, options.distance);
    CHECK_EQUAL(ISO_JOIN_MITRE, options.join);
    CHECK_EQUAL(50, options.arc_tolerance);
    CHECK_NEAR(2, options.mitre_limit, 0);
    CHECK_OK(iso_offset(&out, &tip, &options, scratch));
    CHECK_EQUAL(1, iso_region_locate(&out, (iso_point){998, 0}));
    CHECK_EQUAL(-1, iso_region_locate(&out, (iso_point){1002, 0}));
    options.mitre_limit = 11; /* 1 / sin(half the angle) = 10.05 */
    CHECK_OK(iso_offset(&out, &tip, &options, scratch));
    CHECK_EQUAL(1, iso_region_locate(&out, (iso_point){10030, 0}));
    CHECK_EQUAL(-1, iso_region_locate(&out, (iso_point){10060, 0}));
    iso_region_free(&tip);
    iso_region_free(&out);
}

static void a_circle(void) {
    iso_region circle = {0};
    add_circle(&circle, 70, -3, 100000, 700);
    for (int join = ISO_JOIN_ROUND; join <= ISO_JOIN_SQUARE; join++)
        for (int32_t d = -90000; d <= 90000; d += 60000) {
            double radius = 100000. + d, area = pi * radius * radius;
            CHECK_NEAR(area, offset_area(&circle, d, (iso_join)join, NULL), 2 * pi * radius * 2);
        }
    iso_region_free(&circle);
}

/* A closing corner too sharp to be cut alone, and behind it an edge that runs through the circle
 * which touches the edges next to both: no fillet. The shrunk quadrilateral is the one between its
 * four lines. */
static void a_long_edge_is_no_fillet(void) {
    static const iso_point corner[] = {
        {-10000, -10000}, {-20000, -80000}, {10000, -80000}, {70000, 50000}};
    iso_region kite = {0}, out = {0};
    must_add(&kite, corner, 4);
    for (int join = ISO_JOIN_ROUND; join <= ISO_JOIN_SQUARE; join++) {
        iso_offset_options options = iso_offset_defaults(-15615);
        options.join = (iso_join)join;
        CHECK_OK(iso_offset(&out, &kite, &options, scratch));
        CHECK_EQUAL(-1, iso_region_locate(&out, (iso_point){-1073, -66730}));
        CHECK_EQUAL(-1, iso_region_locate(&out, (iso_point){-2890, -70666}));
        for (int32_t i = 0; i < (out.count ? out.first[out.count] : 0); i++)
            for (int k = 0; k < 4; k++) {
                iso_point a = corner[k], b = corner[(k + 1) % 4];
                double dx = (double)b.x - a.x, dy = (double)b.y - a.y;
                double left =
                    dx * ((double)out.point[i].y - a.y) - dy * ((double)out.point[i].x - a.x);
                CHECK(left / sqrt(dx * dx + dy * dy) >= 15615 - 2);
            }
    }
    iso_region_free(&kite);
    iso_region_free(&out);
}

/* Long round offsets go in steps. */
static void a_long_round_offset_of_short_edges(void) {
    iso_region circle = {0};
    add_circle(&circle, 70, -3, 100000, 3000);
    for (int32_t d = -90000; d <= 900000; d += 330000) {
        double radius = 100000. + d, area = pi * radius * radius;
        CHECK_NEAR(area, offset_area(&circle, d, ISO_JOIN_ROUND, NULL), 2 * pi * radius * 8);
    }
    iso_region_free(&circle);
}

/* The arcs around the corners of a comb's teeth all cross each other, but for the gaps between them
 * being closed first. It grows as its box does. */
static void a_long_round_offset_of_a_comb(void) {
    enum { TEETH = 300, PITCH = 5000, GAP = 500, LONG = 100000, FAR = 60000 };
    iso_region comb = {0};
    iso_point *point = malloc((4 * TEETH + 2) * sizeof *point);
    int32_t count = 2;
    point[0] = (iso_point){0, 0};
    point[1] = (iso_point){TEETH * PITCH - GAP, 0};
    for (int32_t k = TEETH; k-- > 0;) {
        point[count++] = (iso_point){(k + 1) * PITCH - GAP, LONG};
        point[count++] = (iso_point){k * PITCH, LONG};
        if (k > 0) {
            point[count++] = (iso_point){k * PITCH, LONG / 4};
            point[count++] = (iso_point){k * PITCH - GAP, LONG / 4};
        }
    }
    must_add(&comb, point, count);
    double width = TEETH * PITCH - GAP, around = 2 * (width + LONG);
    double area = width * LONG + around * FAR + pi * FAR * (double)FAR;
    int64_t before = iso_planar_get_counts(scratch).collisions;
    CHECK_NEAR(area, offset_area(&comb, FAR, ISO_JOIN_ROUND, NULL), around * 8);
    CHECK(iso_planar_get_counts(scratch).collisions - before < 100 * TEETH);
    iso_region_free(&comb);
    free(point);
}

/* Arcs almost as coarse as the distance: what a chord leaves out, no other winding may count in. */
static void coarse_arcs(void) {
    static const struct coarse {
        int32_t distance, arc_tolerance, count;
        iso_point point[6];
    } coarse[] = {{62, 50, 4, {{-60, 2}, {-53, -1}, {-60, 29}, {-58, 2}}},
                  {-101,
                   50,
                   6,
                   {{-303, 680}, {-247, 407}, {-157, 463}, {-152, 471}, {-149, 468}, {-82, 534}}},
                  {-142, 50, 5, {{-502, 74}, {650, -60}, {249, 313}, {239, 300}, {234, 304}}}};
    for (size_t i = 0; i < sizeof coarse / sizeof *coarse; i++) {
        iso_region region = {0}, out = {0};
        planar_case c = {.offset = iso_offset_defaults(coarse[i].distance), .points = 10000};
        c.offset.join = ISO_JOIN_ROUND;
        c.offset.arc_tolerance = coarse[i].arc_tolerance;
        must_add(&region, coarse[i].point, coarse[i].count);
        const char *text = offset_fault(&c, &region, &out);
        if (!CHECK(text == NULL))
            fprintf(stderr, "distance %d: %s\n", coarse[i].distance, text);
        iso_region_free(&region);
        iso_region_free(&out);
    }
}

static void out_of_range(void) {
    enum { M = ISO_COORDINATE_MAX };
    iso_region box = {0}, out = {0};
    add_box(&box, M - 1000, 0, M, 1000);
    iso_offset_options options = iso_offset_defaults(-10);
    CHECK_OK(iso_offset(&out, &box, &options, scratch));
    CHECK_EQUAL(2 * 980 * 980, iso_region_double_area(&out));
    for (int join = ISO_JOIN_ROUND; join <= ISO_JOIN_SQUARE; join++) {
        options = iso_offset_defaults(10);
        options.join = (iso_join)join;
        CHECK_STATUS(ISO_OUTSIDE, iso_offset(&out, &box, &options, scratch));
        CHECK_EQUAL(0, out.count);
        options.distance = INT32_MAX;
        CHECK_STATUS(ISO_OUTSIDE, iso_offset(&out, &box, &options, scratch));
        options.distance = -M;
        CHECK_OK(iso_offset(&out, &box, &options, scratch));
        CHECK_EQUAL(0, out.count);
    }
    iso_region_free(&box);
    iso_region_free(&out);
}

/* The hole, grown, would leave the range; the result does not. */
static void a_hole_at_the_end_of_the_range(void) {
    enum { M = ISO_COORDINATE_MAX };
    iso_region frame = {0}, region = {0}, out = {0};
    add_box(&frame, M - 1000, 0, M, 1000);
    add_box(&frame, M - 900, 100, M - 100, 900);
    CHECK_OK(iso_region_clean(&region, &frame, ISO_FILL_EVEN_ODD, scratch));
    for (int join = ISO_JOIN_ROUND; join <= ISO_JOIN_SQUARE; join++) {
        iso_offset_options options = iso_offset_defaults(-500);
        options.join = (iso_join)join;
        CHECK_OK(iso_offset(&out, &region, &options, scratch));
        CHECK_EQUAL(0, out.count);
    }
    iso_region_free(&frame);
    iso_region_free(&region);
    iso_region_free(&out);
}

static void of_nothing(void) {
    iso_region none = {0}, out = {0};
    iso_offset_options options = iso_offset_defaults(500);
    add_box(&out, 0, 0, 9, 9);
    CHECK_OK(iso_offset(&out, &none, &options, scratch));
    CHECK_EQUAL(0, out.count);
    iso_region_free(&out);
}

int main(void) {
    must(iso_planar_scratch_new(&scratch), "iso_planar_scratch_new");
    RUN(a_box);
    RUN(a_hole);
    RUN(a_dumb_bell_parts);
    RUN(two_boxes_grow_together);
    RUN(the_mitre_limit);
    RUN(a_circle);
    RUN(a_long_edge_is_no_fillet);
    RUN(a_long_round_offset_of_short_edges);
    RUN(a_long_round_offset_of_a_comb);
    RUN(coarse_arcs);
    RUN(out_of_range);
    RUN(a_hole_at_the_end_of_the_range);
    RUN(of_nothing);
    RUN(random_mitred);
    RUN(random_round);
    RUN(random_square);
    iso_planar_scratch_free(scratch);
    return check_verdict();
}

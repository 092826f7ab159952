/* Curves, and sections swept along them. */
#include <stdbool.h>
#include <stdlib.h>

#include "base/random.h"
#include "channel/polyline.h"
#include "channel/sweep.h"
#include "check.h"

#define PI 3.14159265358979323846

static curve circle(double radius, int count) {
    curve c = {.closed = true};
    for (int i = 0; i < count; i++) {
        double a = 2 * PI * i / count;
        CHECK_OK(curve_add(&c, vec3(radius * cos(a), radius * sin(a), 0)));
    }
    return c;
}

static void test_lengths_and_radii(void) {
    curve c = circle(10, 1000), even;
    int32_t at;
    CHECK_NEAR(20 * PI, curve_length(&c), 20 * PI * 2e-6);
    CHECK_NEAR(10, curve_least_radius(&at, &c), 1e-9);
    CHECK_OK(curve_resample(&even, &c, 1));
    CHECK_EQUAL(63, even.count);
    for (int i = 0; i < even.count; i++)
        CHECK_NEAR(20 * PI / 63, vec3_distance(even.point[i], even.point[(i + 1) % 63]), 0.001);
    curve_free(&c);
    curve_free(&even);
    curve line = {0};
    for (int i = 0; i < 3; i++)
        CHECK_OK(curve_add(&line, vec3(i, 2 * i, 3 * i)));
    CHECK(isinf(curve_least_radius(&at, &line)));
    CHECK_OK(curve_resample(&even, &line, 0.5));
    CHECK_NEAR(0, vec3_distance(even.point[0], line.point[0]), 0);
    CHECK_NEAR(0, vec3_distance(even.point[even.count - 1], line.point[2]), 0);
    curve_free(&line);
    curve_free(&even);
}

/* A corner becomes about the arc that touches both of its sides. */
static void test_corners_are_relaxed(void) {
    for (double angle = 30; angle < 180; angle += 30) {
        double turn = angle * PI / 180, radius = 6;
        curve c = {0};
        int32_t at;
        CHECK_OK(curve_add(&c, vec3(-60, 0, 5)));
        CHECK_OK(curve_add(&c, vec3(0, 0, 5)));
        CHECK_OK(curve_add(&c, vec3(60 * cos(turn), 60 * sin(turn), 5)));
        CHECK_OK(curve_relax(&c, radius, 1.2, 2));
        double least = curve_least_radius(&at, &c);
        CHECK(least >= radius * 0.999);
        CHECK_NEAR(0, vec3_distance(vec3(-60, 0, 5), c.point[0]), 0);
        CHECK_NEAR(0, c.point[1].y, 1e-12);
        double nearest = INFINITY, arc = radius / cos(turn / 2) - radius;
        for (int i = 0; i < c.count; i++) {
            nearest = fmin(nearest, vec3_distance(c.point[i], vec3(0, 0, 5)));
            CHECK_NEAR(5, c.point[i].z, 1e-12);
        }
        CHECK(nearest < 1.3 * arc + 0.2 && nearest > 0.7 * arc - 0.2);
        curve_free(&c);
    }
}

/* What has no room for the radius stays, and doesn't shrink to nothing. */
static void test_a_ring_too_small_stays(void) {
    curve c = circle(5, 100);
    int32_t at;
    CHECK_OK(curve_relax(&c, 6, 0.5, 0));
    CHECK(curve_least_radius(&at, &c) > 4.4); /* points of a polygon */
    CHECK_NEAR(10 * PI, curve_length(&c), 0.05);
    curve_free(&c);
}

static void test_the_nearest_place_of_a_polyline(void) {
    enum { SIDES = 300, ASKED = 500 };
    static iso_vec3 point[SIDES];
    iso_arena arena = {0};
    polyline line;
    uint64_t seed = 3;
    for (int i = 0; i < SIDES; i++) {
        double a = 2 * PI * i / SIDES, r = 10 + 6 * random_unit(&seed);
        point[i] = vec3(r * cos(a), r * sin(a), random_unit(&seed));
    }
    CHECK_OK(polyline_new(&line, point, SIDES, &arena));
    int32_t guess = 0;
    for (int k = 0; k < ASKED; k++) {
        iso_vec3 p = vec3(40 * random_unit(&seed) - 20, 40 * random_unit(&seed) - 20, 2);
        double at, best = INFINITY, found = polyline_nearest(&at, &line, p, &guess);
        for (int i = 0; i < SIDES; i++)
            for (int t = 0; t <= 64; t++)
                best = fmin(best, vec3_distance(
                                      p, vec3_between(point[i], point[(i + 1) % SIDES], t / 64.0)));
        CHECK(found <= best + 1e-12 && found > best - 0.01);
        CHECK_NEAR(found, vec3_distance(p, polyline_at(&line, at)), 1e-9);
    }
    iso_arena_free(&arena);
}

static double volume_of(const skin *s) {
    double six = 0;
    for (int32_t r = 0; r < skin_steps(s); r++)
        for (int32_t k = 0; k < s->sides; k++) {
            iso_vec3 c[6];
            skin_square(c, s, r, k);
            six += vec3_dot(c[0], vec3_cross(c[1], c[2])) + vec3_dot(c[3], vec3_cross(c[4], c[5]));
        }
    return six / 6;
}

/* A curve in space whose frame comes back turned: no seam, no twist, and the volume of a prism. */
static void test_a_frame_closes(void) {
    static const char *const section[] = {"round:4", "square:4", "rect:5x2"};
    for (int i = 0; i < 3; i++) {
        iso_channel_section shape;
        iso_arena arena = {0};
        curve c = {.closed = true};
        skin s;
        CHECK_OK(iso_channel_section_parse(&shape, section[i], 32));
        for (int k = 0; k < 400; k++) {
            double t = 2 * PI * k / 400;
            CHECK_OK(
                curve_add(&c, vec3(20 * cos(t) + 3 * cos(3 * t), 14 * sin(t), 5 * sin(2 * t))));
        }
        CHECK_OK(sweep(&s, &c, &shape, 100, vec3(0, 1, 0), vec3(0, -1, 0), &arena));
        CHECK(fabs(s.twist) > 0.01);
        CHECK_NEAR(1, volume_of(&s) / (curve_length(&c) * iso_channel_section_area(&shape)), 2e-4);
        /* from row to row corners go no farther than the bend takes them: the twist is spread */
        double most = 0, mean = curve_length(&c) / 400;
        for (int32_t r = 0; r < s.rows; r++)
            for (int32_t k = 0; k < s.sides; k++)
                most = fmax(most, vec3_distance(s.point[s.sides * r + k],
                                                s.point[s.sides * ((r + 1) % s.rows) + k]));
        CHECK(most < 2 * mean);
        /* x of the section points where it is to */
        iso_vec3 x = {0, 0, 0};
        for (int32_t k = 0; k < s.sides; k++)
            x = vec3_along(x, shape.corner[k].x,
                           vec3_minus(s.point[s.sides * 100 + k], c.point[100]));
        CHECK(vec3_unit(x).y > 0.99);
        curve_free(&c);
        iso_arena_free(&arena);
    }
}

/* The ends of an open one lie in the side of the mould, to the bit. */
static void test_ends_are_flat(void) {
    iso_channel_section shape;
    iso_arena arena = {0};
    curve c = {0};
    skin s;
    CHECK_OK(iso_channel_section_parse(&shape, "round:4", 32));
    for (int k = 0; k <= 20; k++)
        CHECK_OK(curve_add(&c, vec3(3.3, -50.1 + k, 7.7)));
    for (int k = 20; k >= 0; k--)
        CHECK_OK(curve_add(&c, vec3(13.3, -50.1 + k, 7.7)));
    CHECK_OK(sweep(&s, &c, &shape, 20, vec3(0, 0, 1), vec3(0, -1, 0), &arena));
    for (int32_t k = 0; k < s.sides; k++) {
        CHECK(s.point[k].y == -50.1);
        CHECK(s.point[s.sides * (s.rows - 1) + k].y == -50.1);
        CHECK_NEAR(2, hypot(s.point[k].x - 3.3, s.point[k].z - 7.7), 1e-4);
    }
    curve_free(&c);
    iso_arena_free(&arena);
}

int main(void) {
    RUN(test_lengths_and_radii);
    RUN(test_corners_are_relaxed);
    RUN(test_a_ring_too_small_stays);
    RUN(test_the_nearest_place_of_a_polyline);
    RUN(test_a_frame_closes);
    RUN(test_ends_are_flat);
    return check_verdict();
}

#include "gcode/planner.h"

#include <stdlib.h>

#include "check.h"

static const double acceleration = 1000, deviation = 0.013;

/* Axes that object to nothing. */
static iso_machine_limits limits_of(double junction_deviation) {
    return (iso_machine_limits){.feedrate = {1e6, 1e6, 1e6, 1e6},
                                .acceleration = {1e6, 1e6, 1e6, 1e6},
                                .jerk = {10, 10, 0.2, 2.5},
                                .junction_deviation = junction_deviation};
}

static iso_planner_move along(double dx, double dy, double speed) {
    return (iso_planner_move){.dx = dx,
                              .dy = dy,
                              .length = sqrt(dx * dx + dy * dy),
                              .speed = speed,
                              .acceleration = acceleration,
                              .extrudes = 1};
}

static double time_of(const iso_planner_move *move, int count) {
    static iso_planner planner;
    iso_machine_limits limits = limits_of(deviation);
    iso_planner_start(&planner, &limits);
    for (int i = 0; i < count; i++)
        iso_planner_add(&planner, &move[i]);
    iso_planner_stop(&planner);
    return planner.time;
}

static void test_trapezoid_and_triangle(void) {
    iso_planner_move move = along(100, 0, 100); /* 10 mm and 0.1 s of ramp on each side less 5 mm */
    CHECK_NEAR(1.1, time_of(&move, 1), 1e-12);
    move = along(0, 1, 100);
    CHECK_NEAR(2 * sqrt(1 / acceleration), time_of(&move, 1), 1e-12);
    move = along(6, 8, 100); /* just reaches it: 5 mm up, 5 mm down */
    CHECK_NEAR(0.2, time_of(&move, 1), 1e-12);
}

static void test_straight_on_costs_nothing(void) {
    enum { N = 20000 };
    static iso_planner_move move[N];
    for (int i = 0; i < N; i++)
        move[i] = along(0.03, 0.04, 100);
    iso_planner_move whole = along(0.03 * N, 0.04 * N, 100);
    CHECK_NEAR(time_of(&whole, 1), time_of(move, N), 1e-6);
}

static void test_corner(void) {
    iso_planner_move move[2] = {along(20, 0, 50), along(0, 20, 50)};
    double s = sqrt(0.5), v = sqrt(acceleration * deviation * s / (1 - s));
    double ramp = 50 / acceleration, brake = (50 - v) / acceleration;
    double cruise = 20 - 50 * ramp / 2 - (50 + v) / 2 * brake;
    CHECK_NEAR(2 * (ramp + brake + cruise / 50), time_of(move, 2), 1e-12);
}

static void test_reversal_and_filament_stop(void) {
    iso_planner_move there = along(5, 0, 60), back = along(-5, 0, 60);
    iso_planner_move pull = {.length = 2, .speed = 40, .acceleration = acceleration};
    iso_planner_move both[2] = {there, back}, pulled[3] = {there, pull, there};
    CHECK_NEAR(2 * time_of(&there, 1), time_of(both, 2), 1e-12);
    CHECK_NEAR(2 * time_of(&there, 1) + time_of(&pull, 1), time_of(pulled, 3), 1e-12);
    static iso_planner planner;
    iso_machine_limits limits = limits_of(deviation);
    iso_planner_start(&planner, &limits);
    for (int i = 0; i < 3; i++)
        iso_planner_add(&planner, &pulled[i]);
    iso_planner_stop(&planner);
    CHECK_NEAR(time_of(&pull, 1), planner.idle_time, 1e-12);
}

/* The same physics with the whole job in sight, speeds first and then the time by the area under
 * each ramp. */
static double plan_whole(const iso_planner_move *m, int n) {
    double *v = calloc((size_t)n + 1, sizeof *v), time = 0;
    for (int i = 1; i < n; i++) {
        double dot =
            (m[i - 1].dx * m[i].dx + m[i - 1].dy * m[i].dy) / m[i - 1].length / m[i].length;
        double half = sqrt(0.5 * (1 + dot)), limit = fmin(m[i - 1].speed, m[i].speed);
        if (dot < -0.999999)
            limit = 0;
        else if (dot < 0.999999)
            limit = fmin(limit, sqrt(acceleration * deviation * half / (1 - half)));
        if (m[i].length < 1 && dot > sqrt(0.5) && dot < 1) /* chords of a curve */
            limit = fmin(limit, sqrt(acceleration * m[i].length / acos(dot)));
        v[i] = limit;
    }
    for (int i = n; i-- > 0;)
        v[i] = fmin(v[i], sqrt(v[i + 1] * v[i + 1] + 2 * acceleration * m[i].length));
    for (int i = 0; i < n; i++) {
        v[i + 1] = fmin(v[i + 1], sqrt(v[i] * v[i] + 2 * acceleration * m[i].length));
        double a = v[i], b = v[i + 1];
        double top = fmin(m[i].speed, sqrt(acceleration * m[i].length + (a * a + b * b) / 2));
        double up = (top - a) / acceleration, down = (top - b) / acceleration;
        time += up + down + (m[i].length - up * (a + top) / 2 - down * (b + top) / 2) / top;
    }
    free(v);
    return time;
}

static void test_window_agrees_with_whole_view(void) {
    enum { N = 60000 };
    iso_planner_move *move = calloc(N, sizeof *move);
    uint64_t seed = 3;
    for (int kind = 0; kind < 4; kind++) {
        double heading = 0;
        for (int i = 0; i < N; i++) {
            seed = seed * 6364136223846793005u + 1442695040888963407u;
            double u = (double)(seed >> 40) / (1 << 24), w = (double)(seed >> 16 & 0xffff) / 65536;
            heading += kind == 0 ? (u - 0.5) * 0.2 : kind == 1 ? u < 0.1 ? 3 * u : 0.01 : 6.3 * u;
            double length = kind == 3 ? 20 * w + 0.01 : 0.02 + 0.3 * w;
            move[i] = along(length * cos(heading), length * sin(heading), 20 + 100 * u);
        }
        double whole = plan_whole(move, N);
        CHECK_NEAR(whole, time_of(move, N), 1e-4 * whole);
    }
    free(move);
}

/* A circle of short chords: the pull to its middle is the acceleration, v^2 = a r. */
static void test_curve(void) {
    enum { N = 4000 };
    static iso_planner_move move[N];
    double radius = 5, step = 2 * 3.14159265358979 * 20 / N; /* 20 rounds */
    for (int i = 0; i < N; i++)
        move[i] = along(radius * (cos((i + 1) * step) - cos(i * step)),
                        radius * (sin((i + 1) * step) - sin(i * step)), 200);
    double speed = sqrt(acceleration * radius), length = N * 2 * radius * sin(step / 2);
    CHECK_NEAR(length / speed + speed / acceleration, time_of(move, N), 0.01 * length / speed);
}

static double jerk_time_of(const iso_planner_move *move, int count) {
    static iso_planner planner;
    iso_machine_limits limits = limits_of(0);
    iso_planner_start(&planner, &limits);
    for (int i = 0; i < count; i++)
        iso_planner_add(&planner, &move[i]);
    iso_planner_stop(&planner);
    return planner.time;
}

/* From 10 mm/s at once, and down to it: 90 mm/s of ramp on each side. */
static void test_jerk_at_the_ends(void) {
    iso_planner_move move = along(100, 0, 100);
    double ramp = 90 / acceleration, way = ramp * 55;
    CHECK_NEAR(2 * ramp + (100 - 2 * way) / 100, jerk_time_of(&move, 1), 1e-12);
    move = along(60, 80, 100); /* both axes: 10 / 0.8 mm/s */
    ramp = 87.5 / acceleration, way = ramp * 56.25;
    CHECK_NEAR(2 * ramp + (100 - 2 * way) / 100, jerk_time_of(&move, 1), 1e-12);
    move = (iso_planner_move){.length = 2, .speed = 40, .acceleration = acceleration};
    ramp = 37.5 / acceleration, way = ramp * 21.25;
    CHECK_NEAR(2 * ramp + (2 - 2 * way) / 40, jerk_time_of(&move, 1), 1e-12);
}

/* Round a right corner each axis jumps by the whole speed: 10 mm/s. By 30 degrees at 15 mm/s the y
 * axis jumps by 7.5 and the x axis by 2: nothing is lost. */
static void test_jerk_at_corners(void) {
    iso_planner_move right[2] = {along(20, 0, 50), along(0, 20, 50)};
    double ramp = 40 / acceleration, way = ramp * 30;
    CHECK_NEAR(2 * (2 * ramp + (20 - 2 * way) / 50), jerk_time_of(right, 2), 1e-12);
    double c = cos(3.14159265358979 / 6);
    iso_planner_move gentle[2] = {along(20, 0, 15), along(20 * c, 10, 15)};
    double in = 5 / acceleration, last = 10 / c, out = (15 - last) / acceleration;
    double cruise = 40 - in * 12.5 - out * (15 + last) / 2;
    CHECK_NEAR(in + out + cruise / 15, jerk_time_of(gentle, 2), 1e-9);
}

/* The slowest axis decides: 12 mm/s up, 500 mm/s^2. */
static void test_limits_of_axes(void) {
    static iso_planner planner;
    iso_machine_limits limits = {.feedrate = {60, 500, 12, 120},
                                 .acceleration = {9000, 400, 500, 10000},
                                 .junction_deviation = deviation};
    iso_planner_move move[] = {{.dz = 12, .length = 12, .speed = 130, .acceleration = 1000},
                               {.dx = 60, .length = 60, .speed = 130, .acceleration = 1000},
                               {.dy = -50, .length = 50, .speed = 100, .acceleration = 1000}};
    double expected[] = {1 + 12 / 500.0, 1 + 60 / 1000.0, 0.5 + 100 / 400.0};
    for (int i = 0; i < 3; i++) {
        iso_planner_start(&planner, &limits);
        iso_planner_add(&planner, &move[i]);
        iso_planner_stop(&planner);
        CHECK_NEAR(expected[i], planner.time, 1e-12);
    }
}

static void test_mark(void) {
    static iso_planner planner;
    iso_machine_limits limits = limits_of(deviation);
    iso_planner_start(&planner, &limits);
    double first = 0;
    for (int i = 0; i < 1000; i++) {
        iso_planner_move move = along(i % 2 ? -10 : 10, 0, 50); /* there and back: stops */
        if (i == 100 || i == 800)
            iso_planner_set_mark(&planner);
        iso_planner_add(&planner, &move);
        first = i == 0 ? time_of(&move, 1) : first;
    }
    iso_planner_stop(&planner);
    CHECK_NEAR(1000 * first, planner.time, 1e-9);
    CHECK_NEAR(800 * first, planner.mark_time, 1e-9);
}

static void test_nonsense_is_passed_over(void) {
    iso_planner_move move[2] = {{.length = 0, .speed = 10, .acceleration = 1000},
                                {.length = 1, .speed = 0, .acceleration = 1000}};
    CHECK_NEAR(0, time_of(move, 2), 0);
}

int main(void) {
    RUN(test_trapezoid_and_triangle);
    RUN(test_straight_on_costs_nothing);
    RUN(test_corner);
    RUN(test_reversal_and_filament_stop);
    RUN(test_window_agrees_with_whole_view);
    RUN(test_curve);
    RUN(test_jerk_at_the_ends);
    RUN(test_jerk_at_corners);
    RUN(test_limits_of_axes);
    RUN(test_mark);
    RUN(test_nonsense_is_passed_over);
    return check_verdict();
}

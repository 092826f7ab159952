#include "path/ways.h"

#include <math.h>
#include <stdlib.h>

#include "check.h"

static const double pi = 3.14159265358979323846;
static uint64_t seed;

static int32_t random_below(int32_t n) {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (int32_t)((seed >> 33) % (uint64_t)n);
}

enum { EDGES_MAX = 4000 };

/* Closed contours with the inside to their left. */
typedef struct maze {
    iso_path_edge edge[EDGES_MAX];
    iso_point before[EDGES_MAX];
    int32_t count;
    iso_edge_grid grid;
    iso_ways ways;
    iso_arena scratch;
} maze;

static void add_contour(maze *m, const iso_point *p, int32_t count) {
    for (int32_t i = 0; i < count; i++) {
        m->before[m->count] = p[(i + count - 1) % count];
        m->edge[m->count++] = (iso_path_edge){p[i], p[(i + 1) % count], -1};
    }
}

static void finish(maze *m) {
    CHECK_OK(iso_edge_grid_build(&m->grid, m->edge, m->count, &m->scratch));
    CHECK_OK(iso_ways_new(&m->ways, &m->grid, m->count, &m->scratch));
    m->ways.begin = -1;
    m->ways.end = 0;
    for (int32_t i = 0; i < m->count; i++)
        iso_ways_add(&m->ways, m->before[i], m->edge[i].a, m->edge[i].b);
}

/* A ragged star with holes of any shape in it. */
static void make_star(maze *m, int corners, int holes) {
    iso_point p[512];
    for (int i = 0; i < corners; i++) {
        double a = 2 * pi * i / corners, r = 300000 + random_below(500000);
        p[i] = (iso_point){(int32_t)(r * cos(a)), (int32_t)(r * sin(a))};
    }
    add_contour(m, p, corners);
    for (int h = 0; h < holes; h++) {
        double angle = 2 * pi * h / holes, x = 190000 * cos(angle), y = 190000 * sin(angle);
        int n = 3 + random_below(6);
        for (int i = 0; i < n; i++) {
            double a = -2 * pi * i / n, r = 20000 + random_below(50000);
            p[i] = (iso_point){(int32_t)(x + r * cos(a)), (int32_t)(y + r * sin(a))};
        }
        add_contour(m, p, n);
    }
    finish(m);
}

static double turn(iso_point a, iso_point b, iso_point c) {
    return ((double)b.x - a.x) * ((double)c.y - a.y) - ((double)b.y - a.y) * ((double)c.x - a.x);
}

static int is_inside(const maze *m, double x, double y) {
    int odd = 0;
    for (int32_t i = 0; i < m->count; i++) {
        iso_point a = m->edge[i].a, b = m->edge[i].b;
        if ((a.y <= y) != (b.y <= y))
            odd ^= a.x + (y - a.y) / ((double)b.y - a.y) * ((double)b.x - a.x) > x;
    }
    return odd;
}

/* Free of proper crossings, and its middle inside; touching allowed. */
static int plainly_sees(const maze *m, iso_point a, iso_point b) {
    for (int32_t i = 0; i < m->count; i++) {
        iso_point c = m->edge[i].a, d = m->edge[i].b;
        if (turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0)
            return 0;
    }
    for (int k = 1; k < 8; k++)
        if (!is_inside(m, a.x + ((double)b.x - a.x) * k / 8, a.y + ((double)b.y - a.y) * k / 8)) {
            /* on the boundary both answers are right */
            int on = 0;
            for (int32_t i = 0; i < m->count; i++)
                on |= fabs(turn(m->edge[i].a, m->edge[i].b, a)) < 1 &&
                      fabs(turn(m->edge[i].a, m->edge[i].b, b)) < 1;
            if (!on)
                return 0;
        }
    return 1;
}

static double between(iso_point a, iso_point b) {
    return hypot((double)a.x - b.x, (double)a.y - b.y);
}

/* Dijkstra over all vertices, whatever they are like. */
static double shortest(const maze *m, iso_point from, iso_point to) {
    int32_t n = m->count + 2;
    double *length = malloc((size_t)n * sizeof *length);
    uint8_t *done = calloc((size_t)n, 1);
    for (int32_t i = 0; i < n; i++)
        length[i] = i ? INFINITY : 0;
    for (;;) {
        int32_t u = -1;
        for (int32_t i = 0; i < n; i++)
            if (!done[i] && length[i] < INFINITY && (u < 0 || length[i] < length[u]))
                u = i;
        if (u < 0 || u == n - 1)
            break;
        done[u] = 1;
        iso_point p = u ? m->edge[u - 1].a : from;
        for (int32_t v = 1; v < n; v++) {
            iso_point q = v == n - 1 ? to : m->edge[v - 1].a;
            if (!done[v] && length[u] + between(p, q) < length[v] && plainly_sees(m, p, q))
                length[v] = length[u] + between(p, q);
        }
    }
    double found = length[n - 1];
    free(length);
    free(done);
    return found;
}

static double length_of(const maze *m, iso_point from, iso_point to) {
    double sum = 0;
    for (int32_t i = 0; i < m->ways.points; i++) {
        sum += between(from, m->ways.point[i]);
        from = m->ways.point[i];
    }
    return sum + between(from, to);
}

static int stays_inside(const maze *m, iso_point from, iso_point to) {
    int inside = 1;
    for (int32_t i = 0; i <= m->ways.points; i++) {
        iso_point next = i < m->ways.points ? m->ways.point[i] : to;
        inside &= plainly_sees(m, from, next);
        from = next;
    }
    return inside;
}

static iso_point random_inside(const maze *m) {
    for (;;) {
        iso_point p = {random_below(1600000) - 800000, random_below(1600000) - 800000};
        if (is_inside(m, p.x, p.y))
            return p;
    }
}

static void test_shortest_of_all(void) {
    int bent = 0;
    for (int turn_ = 0; turn_ < 60; turn_++) {
        maze *m = calloc(1, sizeof *m);
        seed = (uint64_t)turn_;
        make_star(m, 5 + random_below(30), turn_ % 4 * 2);
        for (int k = 0; k < 6; k++) {
            iso_point a = random_inside(m), b = random_inside(m);
            double best = shortest(m, a, b);
            int straight = iso_ways_is_inside(&m->ways, a, b);
            CHECK_EQUAL(plainly_sees(m, a, b), straight);
            CHECK_EQUAL(1, iso_ways_find(&m->ways, a, b, INFINITY));
            CHECK(stays_inside(m, a, b));
            CHECK_NEAR(best, length_of(m, a, b), 1e-6 * best);
            bent += m->ways.points > 0;
            CHECK_EQUAL(1, iso_ways_find(&m->ways, a, b, best * 1.0001));
            CHECK_NEAR(best, length_of(m, a, b), 1e-6 * best);
            CHECK_EQUAL(0, iso_ways_find(&m->ways, a, b, best * 0.999));
        }
        iso_arena_free(&m->scratch);
        free(m);
    }
    CHECK(bent > 60);
}

/* From a vertex of the walls themselves, as seams are. */
static void test_between_walls(void) {
    for (int turn_ = 0; turn_ < 30; turn_++) {
        maze *m = calloc(1, sizeof *m);
        seed = (uint64_t)(500 + turn_);
        make_star(m, 8 + random_below(12), 4);
        for (int k = 0; k < 6; k++) {
            iso_point a = m->edge[random_below(m->count)].a, b = m->edge[random_below(m->count)].a;
            if (a.x == b.x && a.y == b.y)
                continue;
            double best = shortest(m, a, b);
            CHECK_EQUAL(1, iso_ways_find(&m->ways, a, b, INFINITY));
            CHECK(stays_inside(m, a, b));
            CHECK_NEAR(best, length_of(m, a, b), 1e-6 * best);
        }
        iso_arena_free(&m->scratch);
        free(m);
    }
}

/* Around a round hole: the tangents and the arc between them, as Pythagoras has it. */
static void test_around_a_hole(void) {
    enum { ARC = 360 };
    maze *m = calloc(1, sizeof *m);
    iso_point box[4] = {{-900000, -900000}, {900000, -900000}, {900000, 900000}, {-900000, 900000}};
    iso_point hole[ARC];
    for (int i = 0; i < ARC; i++)
        hole[i] = (iso_point){(int32_t)lround(300000 * cos(-2 * pi * i / ARC)),
                              (int32_t)lround(300000 * sin(-2 * pi * i / ARC))};
    add_contour(m, box, 4);
    add_contour(m, hole, ARC);
    finish(m);
    iso_point a = {-500000, 0}, b = {500000, 1000};
    double tangent = sqrt(25e10 - 9e10), arc = pi - 2 * acos(0.6);
    CHECK_EQUAL(0, iso_ways_is_inside(&m->ways, a, b));
    CHECK_EQUAL(1, iso_ways_find(&m->ways, a, b, INFINITY));
    CHECK_NEAR(2 * tangent + 300000 * arc, length_of(m, a, b), 1200);
    /* and none into it, nor out of the box */
    CHECK_EQUAL(0, iso_ways_find(&m->ways, a, (iso_point){0, 0}, INFINITY));
    CHECK_EQUAL(0, iso_ways_find(&m->ways, a, (iso_point){0, 950000}, INFINITY));
    iso_arena_free(&m->scratch);
    free(m);
}

/* ---- edges ---- */

static int proper_or_touch(iso_point a, iso_point b, iso_point c, iso_point d) {
    double p = turn(a, b, c), q = turn(a, b, d), r = turn(c, d, a), s = turn(c, d, b);
    if (p == 0 && q == 0)
        return fmax(fmin(a.x, b.x), fmin(c.x, d.x)) <= fmin(fmax(a.x, b.x), fmax(c.x, d.x)) &&
               fmax(fmin(a.y, b.y), fmin(c.y, d.y)) <= fmin(fmax(a.y, b.y), fmax(c.y, d.y));
    return p * q <= 0 && r * s <= 0;
}

static double distance_to(iso_point p, iso_point a, iso_point b) {
    double dx = (double)b.x - a.x, dy = (double)b.y - a.y, all = dx * dx + dy * dy;
    double t = all > 0 ? (((double)p.x - a.x) * dx + ((double)p.y - a.y) * dy) / all : 0;
    t = fmin(1, fmax(0, t));
    return hypot(a.x + t * dx - p.x, a.y + t * dy - p.y);
}

static int same(iso_point a, iso_point b) {
    return a.x == b.x && a.y == b.y;
}

static void check_queries(const iso_edge_grid *grid, const iso_path_edge *edge, int32_t count,
                          int32_t span) {
    for (int k = 0; k < 200; k++) {
        iso_point a = {random_below(2 * span) - span / 2, random_below(2 * span) - span / 2};
        iso_point b = {random_below(span), random_below(span)};
        int32_t begin = random_below(3), end = begin + 1 + random_below(3);
        int meets = 0;
        double closest = INFINITY;
        for (int32_t i = 0; i < count; i++) {
            const iso_path_edge *e = &edge[i];
            if (e->owner < begin || e->owner >= end)
                continue;
            closest = fmin(closest, distance_to(a, e->a, e->b));
            if (!same(e->a, a) && !same(e->a, b) && !same(e->b, a) && !same(e->b, b))
                meets |= proper_or_touch(a, b, e->a, e->b);
        }
        if (!same(a, b))
            CHECK_EQUAL(meets, iso_edge_grid_meets(grid, a, b, begin, end));
        int32_t reach = 1 + random_below(span);
        int32_t found = iso_edge_grid_nearest(grid, a, reach, begin, end);
        if (closest > reach + 1)
            CHECK_EQUAL(-1, found);
        else if (closest < reach - 1 && CHECK(found >= 0))
            CHECK_NEAR(closest, distance_to(a, edge[found].a, edge[found].b), 1.5);
        CHECK_EQUAL(1, iso_edge_grid_has(grid, edge[k % count].b, edge[k % count].a));
    }
}

static void test_grid_against_looking_at_all(void) {
    static iso_path_edge edge[1000];
    static const int32_t counts[] = {1, 2, 5, 40, 1000}, spans[] = {8, 3000, 8000000};
    for (int n = 0; n < 5; n++)
        for (int s = 0; s < 3; s++) {
            iso_arena scratch = {0};
            iso_edge_grid grid;
            seed = (uint64_t)(10 * n + s);
            for (int32_t i = 0; i < counts[n]; i++) {
                int32_t reach = i % 5 ? spans[s] / 8 + 1 : spans[s];
                iso_point a = {random_below(spans[s]), random_below(spans[s])};
                edge[i] = (iso_path_edge){
                    a, {a.x + random_below(reach), a.y - random_below(reach)}, random_below(5)};
            }
            CHECK_OK(iso_edge_grid_build(&grid, edge, counts[n], &scratch));
            check_queries(&grid, edge, counts[n], spans[s]);
            iso_arena_free(&scratch);
        }
}

static void test_contains(void) {
    for (int t = 0; t < 20; t++) {
        maze *m = calloc(1, sizeof *m);
        seed = (uint64_t)(900 + t);
        make_star(m, 3 + random_below(100), 6);
        for (int k = 0; k < 500; k++) {
            iso_point p = {random_below(1800000) - 900000, random_below(1800000) - 900000};
            CHECK_EQUAL(is_inside(m, p.x, p.y), iso_edge_grid_contains(&m->grid, p, -1, 0));
        }
        iso_arena_free(&m->scratch);
        free(m);
    }
}

int main(void) {
    RUN(test_grid_against_looking_at_all);
    RUN(test_contains);
    RUN(test_shortest_of_all);
    RUN(test_between_walls);
    RUN(test_around_a_hole);
    return check_verdict();
}

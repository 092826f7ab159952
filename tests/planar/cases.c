#include "cases.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#ifdef __SANITIZE_ADDRESS__
enum { SLOWER = 4 };
#else
enum { SLOWER = 1 };
#endif

static const double pi = 3.14159265358979323846;

uint64_t rng_next(rng *r) {
    r->state ^= r->state >> 12;
    r->state ^= r->state << 25;
    r->state ^= r->state >> 27;
    return r->state * 0x2545F4914F6CDD1Dull;
}

int32_t rng_below(rng *r, int32_t n) {
    return (int32_t)((rng_next(r) >> 32) * (uint64_t)n >> 32);
}

int32_t rng_between(rng *r, int32_t low, int32_t high) {
    uint64_t width = (uint64_t)((int64_t)high - low + 1);
    return (int32_t)(low + (int64_t)((rng_next(r) >> 32) * width >> 32));
}

void must(iso_status status, const char *what) {
    if (status == ISO_OK)
        return;
    fprintf(stderr, "%s: status %d: %s\n", what, status, iso_error_message());
    exit(1);
}

void must_add(iso_region *region, const iso_point *point, int32_t count) {
    must(iso_region_add(region, point, count), "iso_region_add");
}

int64_t case_count(int64_t usual) {
    const char *asked = getenv("ISO_TEST_CASES");
    return asked ? atoll(asked) : usual / SLOWER;
}

int case_points(void) {
    return 1000 / SLOWER;
}

void case_free(planar_case *c) {
    iso_region_free(&c->a);
    iso_region_free(&c->b);
}

void region_shuffle(iso_region *out, const iso_region *in, int flip, rng *r) {
    iso_region_clear(out);
    iso_point *point = malloc(((size_t)(in->count ? in->first[in->count] : 0) + 1) * sizeof *point);
    for (int32_t i = in->count - 1; i >= 0; i--) {
        int32_t n = in->first[i + 1] - in->first[i], start = n ? rng_below(r, n) : 0;
        int back = flip == 1 || (flip == 2 && rng_below(r, 2));
        for (int32_t k = 0; k < n; k++)
            point[k] = in->point[in->first[i] + (start + (back ? n - k : k)) % n];
        must_add(out, point, n);
    }
    free(point);
}

void region_shift(iso_region *out, const iso_region *in, int32_t dx, int32_t dy) {
    iso_region_clear(out);
    for (int32_t i = 0; i < in->count; i++)
        must_add(out, in->point + in->first[i], in->first[i + 1] - in->first[i]);
    for (int32_t k = 0; k < (out->count ? out->first[out->count] : 0); k++)
        out->point[k] = (iso_point){out->point[k].x + dx, out->point[k].y + dy};
}

void add_circle(iso_region *region, int32_t x, int32_t y, double radius, int32_t n) {
    int32_t count = n < 0 ? -n : n;
    iso_point *point = malloc((size_t)count * sizeof *point);
    for (int32_t k = 0; k < count; k++) {
        double angle = 2 * pi * k / n;
        point[k] = (iso_point){x + (int32_t)lround(radius * cos(angle)),
                               y + (int32_t)lround(radius * sin(angle))};
    }
    must_add(region, point, count);
    free(point);
}

void add_box(iso_region *region, int32_t x0, int32_t y0, int32_t x1, int32_t y1) {
    must_add(region, (iso_point[]){{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, 4);
}

/* --- generators: each adds contours within -span .. span --- */

static iso_point random_point(rng *r, int32_t span) {
    return (iso_point){rng_between(r, -span, span), rng_between(r, -span, span)};
}

/* Degenerate by design; places are multiples of span / 8. */
static void make_grid(iso_region *region, rng *r, int32_t span) {
    int32_t contours = rng_between(r, 1, 4), step = span / 8 ? span / 8 : 1;
    iso_point point[64];
    for (int32_t i = 0; i < contours; i++) {
        int32_t n = 0, length = rng_between(r, 3, 14);
        while (n < length) {
            point[n] = (iso_point){rng_between(r, -8, 7) * step, rng_between(r, -8, 7) * step};
            int choice = n ? rng_below(r, 10) : 9;
            if (choice == 0) /* repeat: an edge without length */
                point[n] = point[n - 1];
            else if (choice == 1 && n > 1) /* there and back: a spike */
                point[n] = point[n - 2];
            else if (choice == 2) /* a place that was there before */
                point[n] = point[rng_below(r, n)];
            else if (choice <= 5) /* along an axis */
                *(choice & 1 ? &point[n].x : &point[n].y) =
                    choice & 1 ? point[n - 1].x : point[n - 1].y;
            n++;
        }
        must_add(region, point, n);
        if (rng_below(r, 5) == 0)
            must_add(region, point, n); /* all of it twice */
    }
    if (rng_below(r, 6) == 0)
        must_add(region, point, rng_between(r, 1, 2)); /* a point, a line */
}

static void make_tangle(iso_region *region, rng *r, int32_t span) {
    iso_point point[40];
    for (int32_t i = rng_between(r, 1, 3); i > 0; i--) {
        int32_t n = rng_between(r, 3, 40);
        for (int32_t k = 0; k < n; k++)
            point[k] = random_point(r, span);
        must_add(region, point, n);
    }
}

static void add_star(iso_region *region, rng *r, iso_point middle, double outer, int32_t n) {
    iso_point *point = malloc((size_t)n * sizeof *point);
    double inner = rng_between(r, 300, 980) / 1000.0;
    for (int32_t k = 0; k < n; k++) {
        double angle = 2 * pi * k / n;
        double radius = outer * (inner + (1 - inner) * rng_between(r, 0, 1000) / 1000.0);
        point[k] = (iso_point){middle.x + (int32_t)lround(radius * cos(angle)),
                               middle.y + (int32_t)lround(radius * sin(angle))};
    }
    must_add(region, point, n);
    free(point);
}

static void make_star(iso_region *region, rng *r, int32_t span) {
    iso_point middle = random_point(r, span / 4);
    add_star(region, r, middle, span * 0.7, rng_between(r, 5, 300));
    if (rng_below(r, 2)) /* a hole, perhaps through the wall */
        add_circle(region, middle.x, middle.y, span * (rng_between(r, 5, 60) / 100.0), -37);
}

static void make_slivers(iso_region *region, rng *r, int32_t span) {
    for (int32_t i = rng_between(r, 1, 8); i > 0; i--) {
        iso_point a = random_point(r, span - 4), b = random_point(r, span - 4), c = b;
        c.x += rng_between(r, -3, 3);
        c.y += rng_between(r, -3, 3);
        must_add(region, (iso_point[]){a, b, c}, 3);
    }
}

/* Long edges that cross each other at almost no angle. */
static void make_near_parallel(iso_region *region, rng *r, int32_t span) {
    int32_t height = rng_between(r, 1, 12);
    for (int32_t i = rng_between(r, 2, 8); i > 0; i--) {
        int32_t left = rng_between(r, -height, height), right = rng_between(r, -height, height);
        int32_t thick = rng_between(r, 0, 1) ? span / 2 : rng_between(r, 1, 6);
        must_add(region,
                 (iso_point[]){{-span + rng_below(r, 9), left},
                               {span - rng_below(r, 9), right},
                               {span, right + thick},
                               {-span, left + thick}},
                 4);
    }
}

static void make_pencil(iso_region *region, rng *r, int32_t span) {
    for (int32_t i = rng_between(r, 4, 24); i > 0; i--) {
        iso_point a = random_point(r, span), c = random_point(r, span);
        must_add(region, (iso_point[]){a, {-a.x, -a.y}, c}, 3); /* all through the origin */
    }
}

static void make_comb(iso_region *region, rng *r, int32_t span) {
    iso_point point[400];
    int32_t teeth = rng_between(r, 3, 90), n = 0, pitch = span / teeth > 4 ? span / teeth : 4;
    int32_t gap = rng_between(r, 1, pitch - 1);
    point[n++] = (iso_point){-span / 2, -span / 2};
    point[n++] = (iso_point){-span / 2 + teeth * pitch, -span / 2};
    for (int32_t k = teeth - 1; k >= 0; k--) {
        int32_t x = -span / 2 + k * pitch, top = rng_between(r, 0, span / 2);
        point[n++] = (iso_point){x + gap + (pitch - gap + 1) / 2, top};
        point[n++] = (iso_point){x + gap, top};
        point[n++] = (iso_point){x + gap, -span / 2 + 3};
        point[n++] = (iso_point){x, -span / 2 + 3};
    }
    must_add(region, point, n);
}

static void make_rings(iso_region *region, rng *r, int32_t span) {
    for (int32_t i = rng_between(r, 2, 12); i > 0; i--) {
        iso_point at = random_point(r, span / 2);
        int32_t n = rng_between(r, 3, 60);
        double radius = span * (rng_between(r, 1, 48) / 100.0);
        add_circle(region, at.x, at.y, radius, n);
        if (rng_below(r, 3))
            add_circle(region, at.x, at.y, radius * (rng_between(r, 10, 99) / 100.0), -n);
    }
}

/* --- more than 5,000 vertices --- */

static void make_large_star(iso_region *region, rng *r, int32_t span) {
    add_star(region, r, random_point(r, span / 8), span * 0.8, rng_between(r, 5001, 7000));
}

static void make_large_tiles(iso_region *region, rng *r, int32_t span) {
    int32_t side = span / 20, odd = rng_below(r, 3);
    for (int32_t i = -18; i < 18; i++)
        for (int32_t k = -18; k < 18; k++)
            if (rng_below(r, 50))
                add_box(region, i * side, k * side, (i + 1) * side + odd, (k + 1) * side - odd);
}

static void make_large_crowd(iso_region *region, rng *r, int32_t span) {
    for (int32_t i = 0; i < 900; i++) {
        iso_point at = random_point(r, span - span / 16);
        add_circle(region, at.x, at.y, span * (rng_between(r, 2, 30) / 1000.0) + 1,
                   rng_below(r, 4) ? 6 : -6);
    }
}

static void make_large_walk(iso_region *region, rng *r, int32_t span) {
    iso_point *point = malloc(5200 * sizeof *point);
    int32_t step = span / 60 + 1;
    iso_point at = {0, 0};
    for (int32_t k = 0; k < 5200; k++) {
        point[k] = at;
        at.x += rng_between(r, -step, step);
        at.y += rng_between(r, -step, step);
        at.x = at.x > span ? span : at.x < -span ? -span : at.x;
        at.y = at.y > span ? span : at.y < -span ? -span : at.y;
    }
    must_add(region, point, 5200);
    free(point);
}

typedef struct generator {
    const char *name;
    void (*make)(iso_region *region, rng *r, int32_t span);
} generator;

static const generator grid[] = {{"grid", make_grid}};
static const generator general[] = {
    {"tangle", make_tangle},   {"star", make_star},
    {"slivers", make_slivers}, {"near-parallel", make_near_parallel},
    {"pencil", make_pencil},   {"comb", make_comb},
    {"rings", make_rings}};
static const generator large[] = {{"large star", make_large_star},
                                  {"large tiles", make_large_tiles},
                                  {"large crowd", make_large_crowd},
                                  {"large walk", make_large_walk}};

enum { GENERAL = sizeof general / sizeof *general, LARGE = sizeof large / sizeof *large };

void case_make(planar_case *c, int64_t index, int32_t largest) {
    static const int32_t spans[] = {8, 60, 1000, 80000, 2000000, ISO_COORDINATE_MAX};
    rng r = {0x9E3779B97F4A7C15ull * (uint64_t)(index + 1)};
    rng_next(&r);
    const generator *g = grid;
    int span = rng_below(&r, 6);
    if (index % 10 == 9) {
        g = &large[index / 10 % LARGE];
        span = rng_between(&r, 3, 5);
    } else if (index & 1) {
        g = &general[index / 2 % GENERAL];
        span = rng_between(&r, 1, 5);
    }
    c->kind = g->name;
    c->index = index;
    c->span = spans[span] < largest ? spans[span] : largest;
    c->points = case_points();
    iso_region_clear(&c->a);
    iso_region_clear(&c->b);
    g->make(&c->a, &r, c->span);
    if (g == grid || rng_below(&r, 4))
        g->make(&c->b, &r, c->span);
    else
        make_star(&c->b, &r, c->span);
    c->rule = (iso_fill_rule)(index / 10 % 3);
    c->tolerance = rng_below(&r, 3) ? rng_below(&r, 1 + c->span / 20) : 0;
}

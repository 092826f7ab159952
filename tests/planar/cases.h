/* Random input for the planar kernel, the same on every machine and run.
 *
 * Half of the cases lie on a grid of 16 x 16 places, so that edges overlap, vertices meet edges and
 * contours repeat; one in ten has more than 5,000 vertices. ISO_TEST_CASES=n sets the number of
 * cases of every test. */
#ifndef TESTS_PLANAR_CASES_H
#define TESTS_PLANAR_CASES_H

#include <isoslice/planar.h>

typedef struct rng { /* xorshift64* */
    uint64_t state;
} rng;

uint64_t rng_next(rng *r);
int32_t rng_below(rng *r, int32_t n);                   /* 0 .. n - 1 */
int32_t rng_between(rng *r, int32_t low, int32_t high); /* both included */

typedef struct planar_case {
    const char *kind; /* the generator's name */
    int64_t index;    /* with the kind of the test, this repeats the case */
    iso_region a, b;
    int32_t span; /* coordinates are about -span .. span */
    /* what to do with it; each test uses its own */
    iso_fill_rule rule;
    iso_offset_options offset;
    int32_t tolerance;
    int points; /* samples */
} planar_case;

/* Case `index`, replacing what was in it. `largest` bounds the coordinates. */
void case_make(planar_case *c, int64_t index, int32_t largest);
void case_free(planar_case *c);

/* How many cases and points a test takes: fewer under the sanitizers. */
int64_t case_count(int64_t usual);
int case_points(void);

/* Add a contour, or give up the test program. */
void must_add(iso_region *region, const iso_point *point, int32_t count);
void must(iso_status status, const char *what);

/* The same contours otherwise written down: last first, started elsewhere, and those that `flip`
 * picks (all: 1, at random: 2) turned around. */
void region_shuffle(iso_region *out, const iso_region *in, int flip, rng *r);
void region_shift(iso_region *out, const iso_region *in, int32_t dx, int32_t dy);

/* A circle of n vertices, counter-clockwise for n > 0. */
void add_circle(iso_region *region, int32_t x, int32_t y, double radius, int32_t n);
void add_box(iso_region *region, int32_t x0, int32_t y0, int32_t x1, int32_t y1);

#endif

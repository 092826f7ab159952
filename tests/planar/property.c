#include "property.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "oracle.h"

enum { SMALL = 400, SHRINK_TRIES = 4000, SHRINK_SECONDS = 20 };

iso_planar_scratch *scratch;

const char *fault(const char *format, ...) {
    static char text[1024];
    char fresh[sizeof text]; /* arguments may point into the old text */
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(fresh, sizeof fresh, format, arguments);
    va_end(arguments);
    memcpy(text, fresh, sizeof text);
    return text;
}

/* --- points --- */

static int32_t clamped(int64_t value) {
    int64_t limit = ISO_COORDINATE_MAX + 40;
    return (int32_t)(value > limit ? limit : value < -limit ? -limit : value);
}

static iso_point near_an_edge(const iso_region *around, rng *r) {
    int32_t i = rng_below(r, around->count);
    while (corners(around, i) == 0)
        i = (i + 1) % around->count;
    int32_t k = rng_below(r, corners(around, i));
    iso_point a = corner(around, i, k), b = corner(around, i, k + 1);
    int64_t part = rng_below(r, 3) ? rng_between(r, 0, 1 << 20) : 0; /* often the vertex itself */
    return (iso_point){
        clamped(a.x + ((int64_t)b.x - a.x) * part / (1 << 20) + rng_between(r, -20, 20)),
        clamped(a.y + ((int64_t)b.y - a.y) * part / (1 << 20) + rng_between(r, -20, 20))};
}

static iso_box box_around(const iso_region *region) {
    iso_box box = {region->point[0], region->point[0]};
    for (int32_t k = 1; k < point_count(region); k++) {
        iso_point p = region->point[k];
        box.min.x = p.x < box.min.x ? p.x : box.min.x;
        box.min.y = p.y < box.min.y ? p.y : box.min.y;
        box.max.x = p.x > box.max.x ? p.x : box.max.x;
        box.max.y = p.y > box.max.y ? p.y : box.max.y;
    }
    return box;
}

const char *points_fault(const iso_region *result, const iso_region *around, expectation *expected,
                         const void *context, int count) {
    if (point_count(around) == 0)
        return NULL;
    iso_box box = box_around(around);
    int32_t wide_by = (box.max.x - box.min.x) / 4 + 5, high_by = (box.max.y - box.min.y) / 4 + 5;
    rng r = {(uint64_t)point_count(around) * 7919 + 1};
    for (int i = 0; i < count; i++) {
        iso_point p = {clamped(rng_between(&r, box.min.x - wide_by, box.max.x + wide_by)),
                       clamped(rng_between(&r, box.min.y - high_by, box.max.y + high_by))};
        if (i & 1)
            p = near_an_edge(i & 2 && result->count ? result : around, &r);
        int on_edge, winding = oracle_winding(result, p, &on_edge);
        if (!on_edge && winding != 0 && winding != 1)
            return fault("winding %d of the result around (%d, %d)", winding, p.x, p.y);
        int due = expected(context, p);
        if (due && on_edge)
            return fault("the boundary strays to (%d, %d), which must be %s", p.x, p.y,
                         due > 0 ? "inside" : "outside");
        if (due && winding != (due > 0))
            return fault("(%d, %d) must be %s the result", p.x, p.y, due > 0 ? "in" : "out of");
    }
    return NULL;
}

const char *region_fault(const iso_region *region) {
    if (iso_region_validate(region, scratch) != ISO_OK)
        return fault("iso_region_validate: %s", iso_error_message());
    const char *text = point_count(region) <= SMALL ? oracle_region_fault(region) : NULL;
    return text ? fault("invalid by the oracle, not by iso_region_validate: %s", text) : NULL;
}

const char *settled_fault(const iso_region *region) {
    iso_region again = {0};
    const char *text = NULL;
    if (iso_region_clean(&again, region, ISO_FILL_NONZERO, scratch) != ISO_OK)
        text = fault("cleaning it again: %s", iso_error_message());
    else if (iso_region_double_area(region) != iso_region_double_area(&again))
        text = "cleaning it again changes its area";
    else if (!oracle_same(region, &again))
        text = "cleaning it again changes its contours";
    iso_region_free(&again);
    return text;
}

/* --- shrinking --- */

static void copy_without(iso_region *out, const iso_region *in, int32_t contour, int32_t from,
                         int32_t count) {
    iso_region_clear(out);
    iso_point *point = malloc(((size_t)point_count(in) + 1) * sizeof *point);
    for (int32_t i = 0; i < in->count; i++) {
        int32_t n = 0;
        for (int32_t k = 0; k < corners(in, i); k++)
            if (i != contour || k < from || k >= from + count)
                point[n++] = corner(in, i, k);
        if (n)
            must_add(out, point, n);
    }
    free(point);
}

static time_t deadline;

/* Drop runs of points, long ones first, from one operand. Returns whether anything went. */
static int shrink_operand(planar_case *c, iso_region *operand, property *holds, int *tries) {
    iso_region fewer = {0}, kept = *operand;
    int shrunk = 0;
    for (int32_t i = 0; i<kept.count && * tries> 0; i++)
        for (int32_t run = corners(&kept, i); run > 0; run /= 2)
            for (int32_t k = 0; i < kept.count && k < corners(&kept, i) && *tries > 0;) {
                if (time(NULL) > deadline)
                    *tries = 1;
                --*tries;
                copy_without(&fewer, &kept, i, k, run);
                *operand = fewer;
                int fails = holds(c) != NULL;
                *operand = kept;
                if (!fails) {
                    k += run;
                    continue;
                }
                iso_region swap = kept;
                kept = fewer;
                fewer = swap;
                *operand = kept;
                shrunk = 1;
            }
    *operand = kept;
    iso_region_free(&fewer);
    return shrunk;
}

static void print_region(const char *name, const iso_region *region) {
    for (int32_t i = 0; i < region->count; i++) {
        fprintf(stderr, "  %s", name);
        for (int32_t k = 0; k < corners(region, i) && k < 60; k++)
            fprintf(stderr, " %d,%d", corner(region, i, k).x, corner(region, i, k).y);
        fprintf(stderr, corners(region, i) > 60 ? " ... (%d points)\n" : "\n", corners(region, i));
        if (i == 40) {
            fprintf(stderr, "  ... (%d contours)\n", region->count);
            return;
        }
    }
}

static void report(const char *name, planar_case *c, property *holds) {
    fprintf(stderr, "%s, case %lld (%s, %d + %d points): %s\n", name, (long long)c->index, c->kind,
            point_count(&c->a), point_count(&c->b), holds(c));
    int tries = SHRINK_TRIES;
    deadline = time(NULL) + SHRINK_SECONDS;
    while (tries > 0 &&
           (shrink_operand(c, &c->a, holds, &tries) | shrink_operand(c, &c->b, holds, &tries))) {
    }
    const char *text = holds(c);
    fprintf(stderr,
            "  shrunk: %s\n  rule %d, distance %d, join %d, mitre %g, arc %d, tolerance %d\n",
            text ? text : "(holds again)", c->rule, c->offset.distance, c->offset.join,
            c->offset.mitre_limit, c->offset.arc_tolerance, c->tolerance);
    print_region("a", &c->a);
    print_region("b", &c->b);
}

int run_cases(const char *name, property *holds, int64_t usual_count, int32_t largest) {
    const char *only = getenv("ISO_TEST_ONLY");
    int64_t begin = only ? atoll(only) : 0, end = only ? begin + 1 : case_count(usual_count);
    planar_case c = {0};
    int failed = 0;
    if (!scratch)
        must(iso_planar_scratch_new(&scratch), "iso_planar_scratch_new");
    for (int64_t i = begin; i < end; i++) {
        case_make(&c, i, largest);
        if (getenv("ISO_TEST_TRACE"))
            fprintf(stderr, "%s, case %lld (%s)\n", name, (long long)i, c.kind);
        if (holds(&c) && ++failed <= 5)
            report(name, &c, holds);
    }
    case_free(&c);
    if (failed)
        fprintf(stderr, "%s: %d of %lld cases failed\n", name, failed, (long long)(end - begin));
    return failed;
}

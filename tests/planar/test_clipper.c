/* Areas beside Clipper 6. Where the two disagree an exact answer decides: only our error counts. */
#include "check.h"
#include "clipper_shim.h"
#include "oracle.h"
#include "property.h"

enum { SMALL = 160, THOROUGH = 20000 };

static int64_t compared, disagreed, undecided;

typedef struct question {
    const planar_case *c;
    const iso_region *region;
    iso_boolean_kind kind;
} question;

static int in_boolean(const void *context, iso_point p) {
    const question *q = context;
    if (oracle_near(&q->c->a, p, 2) || oracle_near(&q->c->b, p, 2))
        return 0;
    int in_a = oracle_winding(&q->c->a, p, NULL) != 0,
        in_b = oracle_winding(&q->c->b, p, NULL) != 0;
    return oracle_boolean(q->kind, in_a, in_b) ? 1 : -1;
}

static int in_offset(const void *context, iso_point p) {
    const question *q = context;
    return oracle_offset(q->region, &q->c->offset, p);
}

static int in_result(const void *context, int winding_a, int winding_b) {
    const question *q = context;
    return oracle_boolean(q->kind, winding_a != 0, winding_b != 0);
}

static double area_and_free(clipper_paths *paths) {
    double area = paths ? clipper_area(paths) : NAN;
    clipper_free(paths);
    return area;
}

static int agree(const iso_region *ours, double theirs, long double slack) {
    long double off = iso_region_double_area(ours) / 2.0L - theirs;
    compared++;
    return off <= slack && off >= -slack;
}

static const char *decide_boolean(const question *q, const iso_region *out, long double slack) {
    disagreed++;
    const char *text = points_fault(out, &q->c->a, in_boolean, q, THOROUGH);
    if (!text)
        text = points_fault(out, &q->c->b, in_boolean, q, THOROUGH);
    if (text)
        return text;
    if (point_count(&q->c->a) + point_count(&q->c->b) > SMALL) {
        undecided++; /* no sample speaks against us */
        return NULL;
    }
    long double off =
        iso_region_double_area(out) / 2.0L - oracle_area(&q->c->a, &q->c->b, in_result, q);
    return off > slack || off < -slack ? fault("kind %d: area off by %Lg", q->kind, off) : NULL;
}

static const char *booleans_agree(const planar_case *c) {
    iso_region out = {0};
    clipper_paths *a = clipper_from_region(&c->a), *b = clipper_from_region(&c->b);
    long double slack = oracle_perimeter(&c->a) + oracle_perimeter(&c->b) +
                        4 * (point_count(&c->a) + point_count(&c->b));
    const char *text = NULL;
    for (int kind = ISO_UNION; kind <= ISO_EXCLUSIVE && !text; kind++) {
        question q = {c, NULL, (iso_boolean_kind)kind};
        must(iso_boolean(&out, q.kind, &c->a, &c->b, scratch), "iso_boolean");
        if (!agree(&out, area_and_free(clipper_boolean(q.kind, a, b)), slack))
            text = decide_boolean(&q, &out, slack);
    }
    clipper_free(a);
    clipper_free(b);
    iso_region_free(&out);
    return text;
}

static const char *offsets_agree(const planar_case *c) {
    iso_region region = {0}, out = {0};
    planar_case with = *c;
    must(iso_region_clean(&region, &c->a, ISO_FILL_NONZERO, scratch), "clean");
    clipper_paths *paths = clipper_from_region(&region);
    const char *text = NULL;
    rng r = {(uint64_t)c->index + 5};
    int large = point_count(&region) > 2000;
    for (int i = 0; i < (large ? 2 : 6) && !text; i++) {
        int32_t distance = rng_between(&r, 1, 2 + c->span / (large ? 2000 : 30));
        with.offset = iso_offset_defaults(i & 1 ? distance : -distance);
        with.offset.join = (iso_join)(i / 2);
        with.offset.arc_tolerance = 1 + distance / 200;
        must(iso_offset(&out, &region, &with.offset, scratch), "iso_offset");
        long double reach = 4 + with.offset.arc_tolerance;
        long double slack = reach * (oracle_perimeter(&region) + oracle_perimeter(&out) + 50);
        if (agree(&out, area_and_free(clipper_offset(paths, &with.offset)), slack))
            continue;
        disagreed++;
        question q = {&with, &region, ISO_UNION};
        text = points_fault(&out, &region, in_offset, &q, THOROUGH);
    }
    clipper_free(paths);
    iso_region_free(&region);
    iso_region_free(&out);
    return text;
}

static void compare(const char *name, property *holds) {
    compared = disagreed = undecided = 0;
    CHECK_EQUAL(0, run_cases(name, holds, 60, 1 << 22));
    printf("     %s: %lld areas, %lld disagreements, %lld of them settled by samples alone\n", name,
           (long long)compared, (long long)disagreed, (long long)undecided);
    CHECK(compared > 0);
    CHECK(4 * disagreed <= compared); /* or the comparison says nothing */
}

static void booleans(void) {
    compare("booleans beside Clipper", booleans_agree);
}

static void offsets(void) {
    compare("offsets beside Clipper", offsets_agree);
}

int main(void) {
    must(iso_planar_scratch_new(&scratch), "iso_planar_scratch_new");
    RUN(booleans);
    RUN(offsets);
    iso_planar_scratch_free(scratch);
    return check_verdict();
}

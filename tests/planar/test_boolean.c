/* Union, intersection, difference and exclusive or, against winding numbers of the operands. */
#include "check.h"
#include "oracle.h"
#include "property.h"

enum { SMALL = 60 };

typedef struct question {
    const planar_case *c;
    iso_boolean_kind kind;
} question;

static const iso_region empty;

static int must_be_in(const void *context, iso_point p) {
    const question *q = context;
    if (oracle_near(&q->c->a, p, 2) || oracle_near(&q->c->b, p, 2))
        return 0;
    int in_a = oracle_winding(&q->c->a, p, NULL) != 0,
        in_b = oracle_winding(&q->c->b, p, NULL) != 0;
    return oracle_boolean(q->kind, in_a, in_b) ? 1 : -1;
}

static int in_result(const void *context, int winding_a, int winding_b) {
    return oracle_boolean(*(const iso_boolean_kind *)context, winding_a != 0, winding_b != 0);
}

static long double slack_of(const planar_case *c) {
    return oracle_perimeter(&c->a) + oracle_perimeter(&c->b) +
           4 * (point_count(&c->a) + point_count(&c->b));
}

static const char *kind_fault(const planar_case *c, iso_boolean_kind kind, iso_region *out) {
    if (iso_boolean(out, kind, &c->a, &c->b, scratch) != ISO_OK)
        return fault("kind %d: %s", kind, iso_error_message());
    const char *text = region_fault(out);
    question q = {c, kind};
    if (!text)
        text = points_fault(out, &c->a, must_be_in, &q, c->points / 4);
    if (!text)
        text = points_fault(out, &c->b, must_be_in, &q, c->points / 4);
    if (!text)
        text = settled_fault(out);
    if (!text && point_count(&c->a) + point_count(&c->b) <= SMALL) {
        long double area = oracle_area(&c->a, &c->b, in_result, &kind);
        long double off = iso_region_double_area(out) / 2.0L - area;
        if (off > slack_of(c) || off < -slack_of(c))
            text = fault("area off by %Lg, allowed %Lg", off, slack_of(c));
    }
    return text ? fault("kind %d: %s", kind, text) : NULL;
}

static const char *areas_fault(const planar_case *c, const long double *area) {
    iso_region a = {0}, b = {0};
    must(iso_boolean(&a, ISO_UNION, &c->a, &empty, scratch), "a");
    must(iso_boolean(&b, ISO_UNION, &empty, &c->b, scratch), "b");
    long double slack = 4 * slack_of(c); /* each doubled, on either side */
    long double area_a = iso_region_double_area(&a), area_b = iso_region_double_area(&b);
    iso_region_free(&a);
    iso_region_free(&b);
    long double off = area[ISO_UNION] + area[ISO_INTERSECTION] - area_a - area_b;
    if (off > slack || off < -slack)
        return fault("|A u B| + |A n B| is %Lg more than |A| + |B|", off / 2);
    off = area[ISO_DIFFERENCE] + area[ISO_INTERSECTION] - area_a;
    if (off > slack || off < -slack)
        return fault("|A - B| + |A n B| is %Lg more than |A|", off / 2);
    off = area[ISO_EXCLUSIVE] + area[ISO_INTERSECTION] - area[ISO_UNION];
    if (off > slack || off < -slack)
        return fault("|A xor B| + |A n B| is %Lg more than |A u B|", off / 2);
    return NULL;
}

static const char *combines(const planar_case *c) {
    iso_region out = {0};
    long double area[4];
    const char *text = NULL;
    for (int kind = ISO_UNION; kind <= ISO_EXCLUSIVE && !text; kind++) {
        text = kind_fault(c, (iso_boolean_kind)kind, &out);
        area[kind] = iso_region_double_area(&out);
    }
    iso_region_free(&out);
    return text ? text : areas_fault(c, area);
}

/* What an operand gives with itself, with nothing, and in the other order. */
static const char *obeys_laws(const planar_case *c) {
    iso_region clean = {0}, out = {0}, other = {0};
    const char *text = NULL;
    must(iso_region_clean(&clean, &c->a, ISO_FILL_NONZERO, scratch), "clean");
    static const struct law {
        iso_boolean_kind kind;
        int with_itself, is_empty;
        const char *broken;
    } laws[] = {
        {ISO_UNION, 1, 0, "A u A is not A"},      {ISO_INTERSECTION, 1, 0, "A n A is not A"},
        {ISO_DIFFERENCE, 1, 1, "A - A is left"},  {ISO_EXCLUSIVE, 1, 1, "A xor A is left"},
        {ISO_UNION, 0, 0, "A u 0 is not A"},      {ISO_INTERSECTION, 0, 1, "A n 0 is left"},
        {ISO_DIFFERENCE, 0, 0, "A - 0 is not A"}, {ISO_EXCLUSIVE, 0, 0, "A xor 0 is not A"}};
    for (size_t i = 0; i < sizeof laws / sizeof *laws && !text; i++) {
        must(iso_boolean(&out, laws[i].kind, &c->a, laws[i].with_itself ? &c->a : &empty, scratch),
             "law");
        /* with itself every edge collides, and what was thinner than a unit may close */
        long double off = iso_region_double_area(&out) - iso_region_double_area(&clean);
        int same = laws[i].with_itself ? fabsl(off) <= 2 * slack_of(c) : oracle_same(&out, &clean);
        if (laws[i].is_empty ? out.count != 0 : !same)
            text = laws[i].broken;
    }
    for (int kind = ISO_UNION; kind <= ISO_EXCLUSIVE && !text; kind++) {
        if (kind == ISO_DIFFERENCE)
            continue;
        must(iso_boolean(&out, (iso_boolean_kind)kind, &c->a, &c->b, scratch), "a with b");
        must(iso_boolean(&other, (iso_boolean_kind)kind, &c->b, &c->a, scratch), "b with a");
        if (!oracle_same(&out, &other))
            text = fault("kind %d: not the same with the operands exchanged", kind);
    }
    iso_region_free(&clean);
    iso_region_free(&out);
    iso_region_free(&other);
    return text;
}

static void random_operands(void) {
    CHECK_EQUAL(0, run_cases("booleans", combines, 240, ISO_COORDINATE_MAX));
}

static void laws(void) {
    CHECK_EQUAL(0, run_cases("laws", obeys_laws, 200, ISO_COORDINATE_MAX));
}

static void two_boxes(void) {
    iso_region a = {0}, b = {0}, out = {0};
    add_box(&a, 0, 0, 100, 100);
    add_box(&b, 50, 50, 150, 150);
    static const int64_t area[] = {17500, 2500, 7500, 15000};
    for (int kind = ISO_UNION; kind <= ISO_EXCLUSIVE; kind++) {
        CHECK_OK(iso_boolean(&out, (iso_boolean_kind)kind, &a, &b, scratch));
        CHECK_EQUAL(2 * area[kind], iso_region_double_area(&out));
        CHECK(region_fault(&out) == NULL);
    }
    iso_region_free(&a);
    iso_region_free(&b);
    iso_region_free(&out);
}

static void boxes_that_share_an_edge(void) {
    iso_region a = {0}, b = {0}, out = {0};
    add_box(&a, 0, 0, 100, 100);
    add_box(&b, 100, 20, 200, 120);
    CHECK_OK(iso_boolean(&out, ISO_UNION, &a, &b, scratch));
    CHECK_EQUAL(1, out.count);
    CHECK_EQUAL(8, point_count(&out));
    CHECK_OK(iso_boolean(&out, ISO_INTERSECTION, &a, &b, scratch));
    CHECK_EQUAL(0, out.count);
    CHECK_OK(iso_boolean(&out, ISO_DIFFERENCE, &a, &b, scratch));
    CHECK_EQUAL(20000, iso_region_double_area(&out));
    iso_region_free(&a);
    iso_region_free(&b);
    iso_region_free(&out);
}

static void a_box_in_a_box_leaves_a_hole(void) {
    iso_region a = {0}, b = {0}, out = {0};
    add_box(&a, 0, 0, 100, 100);
    add_box(&b, 30, 30, 60, 60);
    CHECK_OK(iso_boolean(&out, ISO_DIFFERENCE, &a, &b, scratch));
    CHECK_EQUAL(2, out.count);
    CHECK_EQUAL(-1, out.parent[0]);
    CHECK_EQUAL(0, out.parent[1]);
    CHECK_EQUAL(-1, iso_region_locate(&out, (iso_point){45, 45}));
    CHECK_EQUAL(2 * (10000 - 900), iso_region_double_area(&out));
    iso_region_free(&a);
    iso_region_free(&b);
    iso_region_free(&out);
}

/* Areas of a circle's two parts sum up, whichever way it is cut. */
static void a_cut_circle(void) {
    iso_region disc = {0}, cut = {0}, one = {0}, other = {0};
    add_circle(&disc, 1000, -2000, 5000000, 12345);
    for (int32_t k = 0; k < 5; k++) {
        iso_region_clear(&cut);
        must_add(&cut,
                 (iso_point[]){{-9000000, -9000000 + k * 5},
                               {9000000, 8000000 - k * 1999999},
                               {-9000000, 8000000}},
                 3);
        CHECK_OK(iso_boolean(&one, ISO_DIFFERENCE, &disc, &cut, scratch));
        CHECK_OK(iso_boolean(&other, ISO_INTERSECTION, &disc, &cut, scratch));
        CHECK(region_fault(&one) == NULL && region_fault(&other) == NULL);
        CHECK_NEAR((double)iso_region_double_area(&disc),
                   (double)iso_region_double_area(&one) + (double)iso_region_double_area(&other),
                   4 * 2.5e7);
    }
    iso_region_free(&disc);
    iso_region_free(&cut);
    iso_region_free(&one);
    iso_region_free(&other);
}

int main(void) {
    must(iso_planar_scratch_new(&scratch), "iso_planar_scratch_new");
    RUN(two_boxes);
    RUN(boxes_that_share_an_edge);
    RUN(a_box_in_a_box_leaves_a_hole);
    RUN(a_cut_circle);
    RUN(random_operands);
    RUN(laws);
    iso_planar_scratch_free(scratch);
    return check_verdict();
}

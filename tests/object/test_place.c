/* Places on the bed: all on it, all far enough apart, by brute force on the hulls. */
#include "object/solid.h"

#include "base/memory.h"
#include "planar/hull.h"

static const iso_vec2 bed_250x210[] = {{0, 0}, {250, 0}, {250, 210}, {0, 210}};

static double side_of(iso_vec2 a, iso_vec2 b, double x, double y) {
    double dx = b.x - a.x, dy = b.y - a.y;
    return (dx * (y - a.y) - dy * (x - a.x)) / sqrt(dx * dx + dy * dy);
}

/* Every corner on the bed, which is convex and counter-clockwise, every pair far enough apart. */
static void check_places(const iso_instances *instances, const iso_objects *objects,
                         const iso_placing *placing) {
    iso_point *corner[400];
    int32_t bad = 0, near = 0;
    for (int32_t i = 0; i < instances->count; i++) {
        const iso_region *hull = &objects->object[instances->instance[i].object].hull;
        corner[i] = malloc((size_t)hull->first[1] * sizeof(iso_point));
        for (int32_t k = 0; k < hull->first[1]; k++) {
            iso_point p = {hull->point[k].x + instances->instance[i].by.x,
                           hull->point[k].y + instances->instance[i].by.y};
            corner[i][k] = p;
            for (int32_t e = 0; e < placing->bed_count; e++)
                bad += side_of(placing->bed[e], placing->bed[(e + 1) % placing->bed_count],
                               iso_mm(p.x), iso_mm(p.y)) < placing->margin;
        }
    }
    for (int32_t i = 0; i < instances->count; i++)
        for (int32_t j = 0; j < i; j++) {
            const iso_region *a = &objects->object[instances->instance[i].object].hull;
            const iso_region *b = &objects->object[instances->instance[j].object].hull;
            near += hull_distance(corner[i], a->first[1], corner[j], b->first[1]) <
                    placing->distance - 0.001;
        }
    CHECK_EQUAL(0, bad);
    CHECK_EQUAL(0, near);
    for (int32_t i = 0; i < instances->count; i++)
        free(corner[i]);
}

static int objects_of(iso_objects *objects, shape *s, int count) {
    static const char *const name[] = {"a", "b", "c", "d", "e", "f", "g", "h", "i", "j"};
    iso_mesh mesh[10];
    for (int i = 0; i < count; i++)
        if (!solid_made(&mesh[i], &s[i]))
            return 0;
    return CHECK_OK(
        iso_objects_make(objects, mesh, name, count, &(iso_object_options){.apart = true}));
}

/* Do so many copies fit? Checks the places if they do. */
static int fits(iso_objects *objects, const iso_placing *placing) {
    iso_planar_scratch *scratch;
    iso_instances instances;
    if (!CHECK_OK(iso_planar_scratch_new(&scratch)))
        return 0;
    iso_status status = iso_objects_place(&instances, objects, placing, scratch);
    if (status == ISO_OK) {
        check_places(&instances, objects, placing);
        iso_instances_free(&instances);
    } else {
        CHECK_EQUAL(ISO_OUTSIDE, status);
    }
    iso_planar_scratch_free(scratch);
    return status == ISO_OK;
}

static int most_copies(shape *s, iso_placing placing) {
    iso_objects objects;
    int most = 0;
    if (!objects_of(&objects, s, 1))
        return 0;
    for (placing.copies = 2; fits(&objects, &placing); placing.copies++)
        most = placing.copies;
    iso_objects_free(&objects);
    return most;
}

/* Boxes fill the bed to the last one: nine by seven of 22.4 x 24.8, 6 mm apart, 0.2 to spare in
 * neither direction. */
static void test_boxes_fill_the_bed(void) {
    shape s = {0};
    iso_placing placing = {.bed = bed_250x210, .bed_count = 4, .distance = 6};
    shape_box(&s, 0, 0, 0, (250 - 8 * 6) / 9.0, (210 - 6 * 6) / 7.0, 3);
    CHECK_EQUAL(63, most_copies(&s, placing));
}

/* Discs: hexagonal rows hold more than squares. 250 x 210 with 30 mm discs 6 mm apart: in rows of
 * seven and six, 36 sqrt(3) / 2 apart, six rows. */
static void test_discs(void) {
    shape s = {0};
    iso_placing placing = {.bed = bed_250x210, .bed_count = 4, .distance = 6};
    shape_sphere(&s, (shape_point){0, 0, 0}, 15, 32, 64);
    int most = most_copies(&s, placing);
    printf("     %d discs\n", most);
    CHECK(most >= 39);
}

static void test_nothing_between(void) {
    shape s = {0};
    iso_placing placing = {.bed = bed_250x210, .bed_count = 4};
    shape_box(&s, 0, 0, 0, 50, 70, 3);
    CHECK_EQUAL(15, most_copies(&s, placing));
}

/* A round bed, and one with a slanted side. */
static void test_beds(void) {
    iso_vec2 disc[72];
    shape s = {0};
    for (int i = 0; i < 72; i++)
        disc[i] = (iso_vec2){100 * cos(i * SHAPE_PI / 36), 100 * sin(i * SHAPE_PI / 36)};
    iso_placing placing = {.bed = disc, .bed_count = 72, .distance = 5, .margin = 3};
    shape_box(&s, 0, 0, 0, 30, 30, 3);
    int most = most_copies(&s, placing);
    printf("     %d boxes on a disc\n", most);
    CHECK(most >= 16);
    static const iso_vec2 wedge[] = {{0, 0}, {200, 0}, {0, 200}};
    placing = (iso_placing){.bed = wedge, .bed_count = 3, .distance = 5};
    shape_box(&s, 0, 0, 0, 30, 30, 3);
    most = most_copies(&s, placing);
    CHECK(most >= 10 && most <= 16);
}

/* Different ones at random; and the same places every time. */
static void test_mixed(void) {
    uint64_t state = 3;
    for (int turn = 0; turn < 12; turn++) {
        shape s[10] = {{0}};
        iso_objects objects;
        for (int i = 0; i < 10; i++) {
            double w = 4 + shape_random(&state) % 300 / 10.0;
            double d = 4 + shape_random(&state) % 300 / 10.0;
            if (i % 3 == 0)
                shape_sphere(&s[i], (shape_point){5, 5, 5}, w / 2, 10, 20);
            else if (i % 3 == 1)
                shape_box(&s[i], 0, 0, 0, w, d, 5);
            else
                shape_tetrahedron(&s[i], w);
        }
        if (!objects_of(&objects, s, 10))
            continue;
        iso_placing placing = {.bed = bed_250x210, .bed_count = 4, .distance = turn / 2.0};
        placing.copies = 2;
        placing.margin = turn % 4;
        CHECK(fits(&objects, &placing));
        iso_objects_free(&objects);
    }
}

/* An angle of two legs, 12 mm wide, without their common corner twice. */
static void angle(shape *s) {
    shape_box(s, 0, 0, 0, 50, 12, 3);
    shape_box(s, 0, 12, 0, 12, 40, 3);
}

static double box_gap(const double a[4], const double b[4]) {
    double x = fmax(a[0] - b[2], b[0] - a[2]), y = fmax(a[1] - b[3], b[1] - a[3]);
    return x > 0 && y > 0 ? sqrt(x * x + y * y) : fmax(x, y);
}

/* The smallest distance between the legs of two angles. */
static double angle_gap(const iso_instances *all) {
    static const double leg[2][4] = {{-25, -20, 25, -8}, {-25, -8, -13, 20}};
    double least = INFINITY, a[4], b[4];
    for (int32_t i = 0; i < 4 * all->count * all->count; i++) {
        int32_t one = i / 4 / all->count, other = i / 4 % all->count;
        if (one >= other)
            continue;
        for (int k = 0; k < 4; k++) {
            iso_point p = all->instance[one].by, q = all->instance[other].by;
            a[k] = leg[i & 1][k] + iso_mm(k % 2 ? p.y : p.x);
            b[k] = leg[i / 2 & 1][k] + iso_mm(k % 2 ? q.y : q.x);
        }
        least = fmin(least, box_gap(a, b));
    }
    return least;
}

/* Angles go into each other: more fit than by their hulls, and none is nearer than asked for. */
static void test_angles(void) {
    shape s[1] = {{0}};
    iso_objects objects;
    iso_planar_scratch *scratch;
    int most[2] = {0};
    angle(&s[0]);
    if (!objects_of(&objects, s, 1) || !CHECK_OK(iso_planar_scratch_new(&scratch)))
        return;
    for (int by_hull = 0; by_hull < 2; by_hull++)
        for (int copies = 2; copies < 60; copies++) {
            iso_placing placing = {.bed = bed_250x210, .bed_count = 4, .distance = 4};
            iso_instances all;
            placing.copies = copies;
            placing.by_hull = by_hull;
            if (iso_objects_place(&all, &objects, &placing, scratch) != ISO_OK)
                break;
            most[by_hull] = copies;
            CHECK(angle_gap(&all) > 4 - 0.001);
            iso_instances_free(&all);
        }
    printf("     %d angles, %d by their hulls\n", most[0], most[1]);
    CHECK(most[0] > most[1] + 4);
    iso_planar_scratch_free(scratch);
    iso_objects_free(&objects);
}

static void box_of_all(iso_vec2 *low, iso_vec2 *high, const iso_instances *instances,
                       const iso_objects *objects) {
    *low = (iso_vec2){INFINITY, INFINITY};
    *high = (iso_vec2){-INFINITY, -INFINITY};
    for (int32_t i = 0; i < instances->count; i++) {
        const iso_object *o = &objects->object[instances->instance[i].object];
        double x = iso_mm(instances->instance[i].by.x), y = iso_mm(instances->instance[i].by.y);
        *low = (iso_vec2){fmin(low->x, o->min.x + x), fmin(low->y, o->min.y + y)};
        *high = (iso_vec2){fmax(high->x, o->max.x + x), fmax(high->y, o->max.y + y)};
    }
}

/* One at the centre, a grid about it, a few around it. */
static void test_middle(void) {
    shape s[1] = {{0}};
    iso_objects objects;
    iso_instances instances;
    iso_planar_scratch *scratch;
    iso_vec2 low, high;
    shape_box(&s[0], 0, 0, 0, 20, 10, 5);
    if (!objects_of(&objects, s, 1) || !CHECK_OK(iso_planar_scratch_new(&scratch)))
        return;
    const iso_placing list[] = {
        {.bed = bed_250x210, .bed_count = 4},
        {.bed = bed_250x210, .bed_count = 4, .distance = 6, .copies = 7},
        {.bed = bed_250x210, .bed_count = 4, .distance = 4, .columns = 3, .rows = 4},
        {.bed = bed_250x210,
         .bed_count = 4,
         .distance = 6,
         .copies = 5,
         .has_center = true,
         .center = {100, 90}}};
    for (int i = 0; i < 4; i++) {
        if (!CHECK_OK(iso_objects_place(&instances, &objects, &list[i], scratch)))
            continue;
        box_of_all(&low, &high, &instances, &objects);
        CHECK_NEAR(i == 3 ? 100 : 125, (low.x + high.x) / 2, 0.0002);
        CHECK_NEAR(i == 3 ? 90 : 105, (low.y + high.y) / 2, 0.0002);
        if (i == 1)
            CHECK(high.x - low.x < 100 && high.y - low.y < 100);
        if (i == 2) {
            CHECK_EQUAL(12, instances.count);
            CHECK_NEAR(3 * 20 + 2 * 4, high.x - low.x, 0.0002);
            CHECK_NEAR(4 * 10 + 3 * 4, high.y - low.y, 0.0002);
        }
        iso_instances_free(&instances);
    }
    iso_planar_scratch_free(scratch);
    iso_objects_free(&objects);
}

/* The message says what is left over. */
static void test_no_room(void) {
    shape s[2] = {{0}};
    iso_objects objects;
    iso_instances instances;
    iso_planar_scratch *scratch;
    shape_box(&s[0], 0, 0, 0, 240, 200, 5);
    shape_box(&s[1], 0, 0, 0, 30, 20, 5);
    if (!objects_of(&objects, s, 2) || !CHECK_OK(iso_planar_scratch_new(&scratch)))
        return;
    iso_placing placing = {.bed = bed_250x210, .bed_count = 4, .distance = 6};
    CHECK_STATUS(ISO_OUTSIDE, iso_objects_place(&instances, &objects, &placing, scratch));
    CHECK(strstr(iso_error_message(), "no room on the bed for b, 30.00 x 20.00 mm: 1 of 2"));
    placing.bed_count = 2;
    CHECK_STATUS(ISO_USAGE, iso_objects_place(&instances, &objects, &placing, scratch));
    placing = (iso_placing){.bed = bed_250x210, .bed_count = 4, .columns = 2, .rows = 2};
    CHECK_STATUS(ISO_BAD_CONFIG, iso_objects_place(&instances, &objects, &placing, scratch));
    iso_planar_scratch_free(scratch);
    iso_objects_free(&objects);
}

static void test_no_memory(void) {
    shape s[2] = {{0}};
    iso_objects objects;
    iso_placing placing = {.bed = bed_250x210, .bed_count = 4, .distance = 6, .copies = 3};
    shape_box(&s[0], 0, 0, 0, 40, 20, 5);
    shape_tetrahedron(&s[1], 30);
    if (!objects_of(&objects, s, 2))
        return;
    for (int64_t n = 0;; n++) {
        iso_planar_scratch *scratch;
        iso_instances instances;
        if (!CHECK_OK(iso_planar_scratch_new(&scratch)))
            break;
        iso_fail_allocation_after(n);
        iso_status status = iso_objects_place(&instances, &objects, &placing, scratch);
        iso_fail_allocation_after(-1);
        iso_planar_scratch_free(scratch);
        if (status == ISO_OK) {
            iso_instances_free(&instances);
            break;
        }
        CHECK_STATUS(ISO_NO_MEMORY, status);
    }
    iso_objects_free(&objects);
}

int main(void) {
    RUN(test_boxes_fill_the_bed);
    RUN(test_discs);
    RUN(test_nothing_between);
    RUN(test_beds);
    RUN(test_mixed);
    RUN(test_angles);
    RUN(test_middle);
    RUN(test_no_room);
    RUN(test_no_memory);
    return check_verdict();
}

/* From meshes to objects: grouping, cutting, splitting, names, and where they come to lie. */
#include "object/solid.h"

#include "base/memory.h"

static int make(iso_objects *objects, shape *s, int count, const iso_object_options *options) {
    static const char *const name[3] = {"/tmp/a.b/one.stl", "two.stl", "three"};
    iso_mesh mesh[3];
    for (int i = 0; i < count; i++)
        if (!solid_made(&mesh[i], &s[i]))
            return 0;
    return CHECK_OK(iso_objects_make(objects, mesh, name, count, options));
}

static void check_lies(const iso_object *object, double x, double y, double z) {
    CHECK_NEAR(0, object->min.x + object->max.x, 1e-9);
    CHECK_NEAR(0, object->min.y + object->max.y, 1e-9);
    CHECK_NEAR(0, object->min.z, 1e-12);
    CHECK_NEAR(x, object->max.x - object->min.x, 1e-9);
    CHECK_NEAR(y, object->max.y - object->min.y, 1e-9);
    CHECK_NEAR(z, object->max.z, 1e-9);
    for (int32_t i = 0; i < object->mesh_count; i++)
        CHECK_OK(iso_mesh_validate(&object->mesh[i]));
}

static void two_boxes(shape *s) {
    s[0] = s[1] = (shape){0};
    shape_box(&s[0], 10, 20, 30, 11, 22, 33);
    shape_box(&s[1], 15, 20, 31, 16, 26, 36);
}

static void test_together_and_apart(void) {
    shape s[3];
    iso_objects objects;
    two_boxes(s);
    if (make(&objects, s, 2, &(iso_object_options){0})) {
        if (CHECK_EQUAL(1, objects.count)) {
            CHECK_EQUAL(2, objects.object[0].mesh_count);
            CHECK(strcmp(objects.object[0].name, "one.stl") == 0);
            check_lies(&objects.object[0], 6, 6, 6);
            CHECK_NEAR(1, objects.object[0].mesh[1].min.z, 1e-12);
        }
        iso_objects_free(&objects);
    }
    two_boxes(s);
    if (make(&objects, s, 2, &(iso_object_options){.apart = true})) {
        if (CHECK_EQUAL(2, objects.count)) {
            CHECK(strcmp(objects.object[1].name, "two.stl") == 0);
            check_lies(&objects.object[0], 1, 2, 3);
            check_lies(&objects.object[1], 1, 6, 5);
        }
        iso_objects_free(&objects);
    }
    two_boxes(s);
    if (make(&objects, s, 2, &(iso_object_options){.apart = true, .float_above = true})) {
        CHECK_NEAR(31, objects.object[1].min.z, 0);
        iso_objects_free(&objects);
    }
}

static void test_cut(void) {
    shape s[3];
    iso_objects objects;
    two_boxes(s);
    if (make(&objects, s, 2, &(iso_object_options){.cut = 2})) {
        if (CHECK_EQUAL(2, objects.count)) {
            CHECK(strcmp(objects.object[0].name, "one_lower.stl") == 0);
            CHECK(strcmp(objects.object[1].name, "one_upper.stl") == 0);
            check_lies(&objects.object[0], 6, 6, 2);
            check_lies(&objects.object[1], 6, 6, 4);
        }
        iso_objects_free(&objects);
    }
    two_boxes(s);
    if (make(&objects, s, 2, &(iso_object_options){.cut = 4, .drop_lower = true})) {
        if (CHECK_EQUAL(1, objects.count)) {
            CHECK_EQUAL(1, objects.object[0].mesh_count);
            CHECK(strcmp(objects.object[0].name, "one.stl") == 0);
            check_lies(&objects.object[0], 1, 6, 2);
        }
        iso_objects_free(&objects);
    }
    two_boxes(s);
    iso_mesh mesh;
    static const char *const name[1] = {"one.stl"};
    if (solid_made(&mesh, &s[0]))
        CHECK_STATUS(ISO_OUTSIDE,
                     iso_objects_make(&objects, &mesh, name, 1,
                                      &(iso_object_options){.cut = 4, .drop_lower = true}));
    CHECK(!mesh.position);
    shape_free(&s[1]);
}

/* Two bodies, one of them with a cavity in which a third one floats. */
static void nest(shape *s) {
    *s = (shape){0};
    shape_box(s, 0, 0, 0, 24, 24, 12);
    int64_t from = s->count;
    shape_box(s, 4, 4, 3, 20, 20, 9);
    shape_turn(s, from, s->count);
    shape_box(s, 8, 8, 5, 16, 16, 7);
    shape_box(s, 30, 0, 0, 32, 3, 4);
}

static void test_split(void) {
    shape s[1];
    iso_mesh mesh, *piece;
    int32_t count;
    nest(s);
    if (!solid_made(&mesh, &s[0]))
        return;
    if (CHECK_OK(iso_mesh_split(&piece, &count, &mesh))) {
        if (CHECK_EQUAL(3, count)) {
            CHECK_NEAR(24 * 24 * 12 - 16 * 16 * 6, iso_mesh_volume(&piece[0]), 1e-9);
            CHECK_NEAR(8 * 8 * 2, iso_mesh_volume(&piece[1]), 1e-9);
            CHECK_NEAR(24, iso_mesh_volume(&piece[2]), 1e-9);
            CHECK_EQUAL(2, piece[0].defects.shells);
            CHECK_EQUAL(8, piece[2].vertex_count);
            for (int i = 0; i < 3; i++)
                CHECK_OK(iso_mesh_validate(&piece[i]));
        }
        iso_meshes_free(piece, count);
    }
    iso_mesh_free(&mesh);
    iso_objects objects;
    nest(s);
    if (make(&objects, s, 1, &(iso_object_options){.split = true})) {
        if (CHECK_EQUAL(3, objects.count)) {
            CHECK(strcmp(objects.object[2].name, "one_3.stl") == 0);
            check_lies(&objects.object[0], 24, 24, 12);
            check_lies(&objects.object[1], 8, 8, 2);
            check_lies(&objects.object[2], 2, 3, 4);
        }
        iso_objects_free(&objects);
    }
}

static void test_hull(void) {
    shape s = {0};
    iso_mesh mesh;
    iso_region hull = {0};
    shape_box(&s, 0, 0, 0, 4, 3, 1);
    shape_sphere(&s, (shape_point){2, 1.5, 5}, 1, 16, 32);
    shape_box(&s, 1, 5, 0, 3, 6, 1);
    if (!solid_made(&mesh, &s))
        return;
    if (CHECK_OK(iso_meshes_hull(&hull, &mesh, 1))) {
        CHECK_EQUAL(1, hull.count);
        CHECK_EQUAL(6, hull.first[1]);
        CHECK_NEAR(2 * (12 + 9) * 1e8, (double)iso_region_double_area(&hull), 0);
    }
    if (CHECK_OK(iso_meshes_hull_below(&hull, &mesh, 1, -0.5)))
        CHECK_EQUAL(0, hull.count);
    iso_mesh_translate(&mesh, (iso_vec3){2000, 0, 0});
    CHECK_STATUS(ISO_OUTSIDE, iso_meshes_hull(&hull, &mesh, 1));
    iso_region_free(&hull);
    iso_mesh_free(&mesh);
}

/* A canopy casts no shadow on a skirt below it: a cone standing on its tip, cut at a third. */
static void test_hull_of_a_foot(void) {
    static const shape_point corner[] = {{0, 0, 0}, {3, 3, 3}, {-3, 3, 3}, {-3, -3, 3}, {3, -3, 3}};
    static const int side[][3] = {{0, 2, 1}, {0, 3, 2}, {0, 4, 3}, {0, 1, 4}, {1, 2, 3}, {1, 3, 4}};
    shape s = {0};
    iso_mesh mesh;
    iso_region hull = {0};
    for (int i = 0; i < 6; i++)
        shape_add(&s, corner[side[i][0]], corner[side[i][1]], corner[side[i][2]]);
    if (!solid_made(&mesh, &s))
        return;
    if (CHECK_OK(iso_meshes_hull_below(&hull, &mesh, 1, mesh.min.z + 1)))
        CHECK_NEAR(2 * 4 * 1e8, (double)iso_region_double_area(&hull), 0);
    if (CHECK_OK(iso_meshes_hull_below(&hull, &mesh, 1, mesh.max.z)))
        CHECK_NEAR(2 * 36 * 1e8, (double)iso_region_double_area(&hull), 0);
    iso_region_free(&hull);
    iso_mesh_free(&mesh);
}

/* Against all points: each is on the left of each side. */
static void test_hull_at_random(void) {
    uint64_t state = 11;
    for (int turn = 0; turn < 50; turn++) {
        shape s = {0};
        iso_mesh mesh;
        iso_region hull = {0};
        for (int i = 0; i < 20; i++) {
            double x = shape_random(&state) % 1000 / 10.0, y = shape_random(&state) % 1000 / 10.0;
            shape_box(&s, x, y, i * 3, x + 5, y + 2, i * 3 + 2);
        }
        if (!solid_made(&mesh, &s) || !CHECK_OK(iso_meshes_hull(&hull, &mesh, 1)))
            continue;
        int32_t corners = hull.first[1], outside = 0, flat = 0;
        for (int32_t i = 0; i < corners; i++) {
            iso_point a = hull.point[i], b = hull.point[(i + 1) % corners];
            iso_point c = hull.point[(i + 2) % corners];
            flat += ((int64_t)b.x - a.x) * (c.y - b.y) - ((int64_t)b.y - a.y) * (c.x - b.x) <= 0;
            for (int32_t v = 0; v < mesh.vertex_count; v++) {
                int32_t x = iso_units(mesh.position[v].x), y = iso_units(mesh.position[v].y);
                outside += ((int64_t)b.x - a.x) * (y - a.y) - ((int64_t)b.y - a.y) * (x - a.x) < 0;
            }
        }
        CHECK_EQUAL(0, outside);
        CHECK_EQUAL(0, flat);
        iso_region_free(&hull);
        iso_mesh_free(&mesh);
    }
}

static iso_status make_nest(iso_objects *objects) {
    static const char *const name[1] = {"nest.stl"};
    shape s;
    iso_mesh mesh;
    nest(&s);
    iso_status status = iso_mesh_from_triangles(&mesh, s.triangle, s.count);
    shape_free(&s);
    if (status != ISO_OK)
        return status;
    return iso_objects_make(objects, &mesh, name, 1,
                            &(iso_object_options){.split = true, .cut = 6});
}

static void test_no_memory(void) {
    iso_objects objects;
    iso_fail_allocation_after(-1);
    if (CHECK_OK(make_nest(&objects)))
        iso_objects_free(&objects);
    int64_t count = iso_fail_allocation_after(-1);
    for (int64_t n = 0; n < count; n++) {
        iso_fail_allocation_after(n);
        iso_status status = make_nest(&objects);
        iso_fail_allocation_after(-1);
        CHECK_STATUS(ISO_NO_MEMORY, status);
    }
}

int main(void) {
    RUN(test_together_and_apart);
    RUN(test_cut);
    RUN(test_split);
    RUN(test_hull);
    RUN(test_hull_of_a_foot);
    RUN(test_hull_at_random);
    RUN(test_no_memory);
    return check_verdict();
}

/* Splitting edges keeps a mesh a double-link, and every place of it where it was. */
#include "check.h"

#include "base/memory.h"
#include "models/shapes.h"
#include "slice/fields.h"
#include "slice/refine.h"

/* What there is now, by the checks that meshes of files go through. */
static void check_link(const refined *r, double volume) {
    iso_mesh view = {.triangle_count = r->triangle_count,
                     .vertex_count = r->vertex_count,
                     .origin = (int32_t *)r->origin,
                     .opposite = (int32_t *)r->opposite,
                     .position = (iso_vec3 *)r->position,
                     .min = r->mesh->min,
                     .max = r->mesh->max};
    CHECK_OK(iso_mesh_validate(&view));
    CHECK_NEAR(volume, iso_mesh_volume(&view), 1e-9 * fabs(volume));
}

static void check_random_marks(shape *s, uint64_t seed) {
    iso_mesh mesh;
    refined r;
    refined_queue queue = {0};
    test_field f = test_plane(0, 0, 1);
    CHECK_OK(iso_mesh_from_triangles(&mesh, s->triangle, s->count));
    double volume = iso_mesh_volume(&mesh);
    CHECK_OK(refined_begin(&r, &mesh, &f.field));
    for (int round = 0; round < 8; round++) {
        int32_t marks = r.triangle_count / 4 + 1, before = r.triangle_count, edges = 0;
        for (int32_t i = 0; i < marks; i++) {
            int32_t made = r.new_vertices;
            int32_t dart = (int32_t)(shape_random(&seed) % (uint32_t)(3 * before));
            CHECK_OK(refined_mark(&r, dart));
            edges += r.new_vertices > made;
        }
        queue.count = 0;
        CHECK_OK(refined_split(&r, &queue));
        CHECK_EQUAL(before + 2 * edges, r.triangle_count);
        check_link(&r, volume);
        for (int32_t v = 0; v < r.vertex_count; v++)
            CHECK(r.value[v] == r.position[v].z);
        for (int64_t i = 0; i < queue.count; i++)
            CHECK(queue.face[i] >= 0 && queue.face[i] < r.triangle_count);
    }
    iso_release(queue.face);
    refined_free(&r);
    iso_mesh_free(&mesh);
    shape_free(s);
}

static void test_random_marks(void) {
    shape box = {0}, torus = {0};
    shape_box(&box, 0, 0, 0, 3, 4, 5);
    shape_torus(&torus, (shape_point){0, 0, 0}, 5, 2, 5, 4);
    check_random_marks(&box, 1);
    check_random_marks(&torus, 2);
}

/* Every edge of every face at once: four times as many. */
static void test_all_edges(void) {
    shape s = {0};
    iso_mesh mesh;
    refined r;
    refined_queue queue = {0};
    test_field f = test_plane(0, 0, 1);
    shape_tetrahedron(&s, 6);
    CHECK_OK(iso_mesh_from_triangles(&mesh, s.triangle, s.count));
    CHECK_OK(refined_begin(&r, &mesh, &f.field));
    for (int round = 1; round < 5; round++) {
        for (int32_t a = 3 * r.triangle_count; a-- > 0;)
            CHECK_OK(refined_mark(&r, a));
        queue.count = 0;
        CHECK_OK(refined_split(&r, &queue));
        CHECK_EQUAL(4 << 2 * round, r.triangle_count);
        CHECK_EQUAL(r.triangle_count, queue.count);
        check_link(&r, 36);
    }
    iso_release(queue.face);
    refined_free(&r);
    iso_mesh_free(&mesh);
    shape_free(&s);
}

/* Only what a level needs is split: a small circle on a large cube leaves most of it alone. */
static void test_only_where_needed(void) {
    shape s = {0};
    iso_mesh mesh;
    refined r;
    test_field f = test_round(4, -4, 0, (iso_vec3){1, 1, 0});
    const double level[] = {2};
    iso_field_slicing options = iso_field_slicing_defaults();
    shape_box(&s, -100, -100, -100, 100, 100, 100);
    CHECK_OK(iso_mesh_from_triangles(&mesh, s.triangle, s.count));
    CHECK_OK(refined_begin(&r, &mesh, &f.field));
    CHECK_OK(refine(&r, level, 1, &options));
    check_link(&r, 8e6);
    CHECK(r.triangle_count > 100 && r.triangle_count < 1200);
    refined_free(&r);
    CHECK_OK(refined_begin(&r, &mesh, &f.field));
    const double far[] = {1000};
    CHECK_OK(refine(&r, far, 1, &options));
    CHECK_EQUAL(12, r.triangle_count);
    CHECK(r.origin == mesh.origin);
    refined_free(&r);
    iso_mesh_free(&mesh);
    shape_free(&s);
}

int main(void) {
    RUN(test_random_marks);
    RUN(test_all_edges);
    RUN(test_only_where_needed);
    return check_verdict();
}

/* Volumes against closed forms. */
#include "check.h"

#include "models/shapes.h"

#include <isoslice/mesh.h>

static int made(iso_mesh *mesh, shape *s) {
    int good = CHECK_OK(iso_mesh_from_triangles(mesh, s->triangle, s->count));
    shape_free(s);
    return good;
}

static void test_box(void) {
    shape s = {0};
    iso_mesh mesh;
    shape_box(&s, -3, 5, 7, 4, 9, 17);
    if (!made(&mesh, &s))
        return;
    CHECK_NEAR(280, iso_mesh_volume(&mesh), 1e-12);
    CHECK_NEAR(280, iso_mesh_volume_between(&mesh, 0, 100), 1e-12);
    CHECK_NEAR(28 * 2.5, iso_mesh_volume_between(&mesh, 8, 10.5), 1e-12);
    CHECK_NEAR(28, iso_mesh_volume_between(&mesh, 7, 8), 1e-12);
    CHECK_NEAR(28, iso_mesh_volume_between(&mesh, 6, 8), 1e-12);
    CHECK_NEAR(28, iso_mesh_volume_between(&mesh, 16, 18), 1e-12);
    CHECK_NEAR(0, iso_mesh_volume_between(&mesh, 17, 18), 0);
    CHECK_NEAR(0, iso_mesh_volume_between(&mesh, 0, 7), 1e-12);
    CHECK_NEAR(0, iso_mesh_volume_between(&mesh, 9, 9), 0);
    CHECK_NEAR(0, iso_mesh_volume_between(&mesh, 10, 9), 0);
    iso_mesh_free(&mesh);
}

static void test_tetrahedron(void) {
    shape s = {0};
    iso_mesh mesh;
    shape_tetrahedron(&s, 6);
    if (!made(&mesh, &s))
        return;
    CHECK_NEAR(36, iso_mesh_volume(&mesh), 1e-13);
    for (int i = 0; i <= 60; i++) { /* what is above z is a tetrahedron too */
        double z = i / 10.0;
        CHECK_NEAR((6 - z) * (6 - z) * (6 - z) / 6, iso_mesh_volume_between(&mesh, z, 10), 1e-12);
    }
    iso_mesh_free(&mesh);
}

static double cap(double r, double height) {
    return SHAPE_PI * height * height * (r - height / 3);
}

static void test_sphere(void) {
    shape s = {0};
    iso_mesh mesh;
    shape_sphere(&s, (shape_point){100, -50, 10}, 10, 200, 400);
    if (!made(&mesh, &s))
        return;
    double all = iso_mesh_volume(&mesh);
    CHECK_NEAR(4.0 / 3 * SHAPE_PI * 1000, all, 0.5);
    for (int i = 1; i < 20; i++)
        CHECK_NEAR(cap(10, i), iso_mesh_volume_between(&mesh, -1, i), 0.5);
    double parts = 0;
    for (int i = 0; i < 70; i++)
        parts += iso_mesh_volume_between(&mesh, 0.3 * i, 0.3 * (i + 1));
    CHECK_NEAR(all, parts, 1e-9 * all);
    iso_mesh_free(&mesh);
}

static void test_translation_changes_nothing(void) {
    shape s = {0};
    iso_mesh mesh;
    shape_torus(&s, (shape_point){0, 0, 0}, 30, 10, 80, 60);
    if (!made(&mesh, &s))
        return;
    double before = iso_mesh_volume(&mesh), part = iso_mesh_volume_between(&mesh, -3, 4);
    iso_mesh_translate(&mesh, (iso_vec3){1000, -2000, 512});
    CHECK_OK(iso_mesh_validate(&mesh));
    CHECK_NEAR(522, mesh.max.z, 1e-5);
    CHECK_NEAR(before, iso_mesh_volume(&mesh), 1e-8 * before);
    CHECK_NEAR(part, iso_mesh_volume_between(&mesh, 509, 516), 1e-8 * before);
    iso_mesh_free(&mesh);
}

static void test_models_are_placed_together(void) {
    shape s[2] = {{0}, {0}};
    iso_mesh mesh[2];
    shape_box(&s[0], 0, 0, -7, 10, 20, 1);
    shape_box(&s[1], 30, -5, -3, 50, 5, 4);
    if (!made(&mesh[0], &s[0]) || !made(&mesh[1], &s[1]))
        return;
    iso_meshes_place(mesh, 2, (iso_vec2){100, 60});
    CHECK_NEAR(75, mesh[0].min.x, 0);
    CHECK_NEAR(125, mesh[1].max.x, 0);
    CHECK_NEAR(47.5, mesh[1].min.y, 0);
    CHECK_NEAR(72.5, mesh[0].max.y, 0);
    CHECK_NEAR(0, mesh[0].min.z, 0);
    CHECK_NEAR(4, mesh[1].min.z, 0);
    iso_mesh_free(&mesh[0]);
    iso_mesh_free(&mesh[1]);
    iso_meshes_place(mesh, 0, (iso_vec2){0, 0});
}

static void test_clipping_is_exact_at_corners(void) {
    uint64_t state = 3;
    for (int round = 0; round < 30; round++) {
        uint8_t filled[64];
        int layer[4] = {0};
        for (int i = 0; i < 64; i++)
            layer[i / 16] += filled[i] = shape_random(&state) % 2;
        shape s = {0};
        iso_mesh mesh;
        shape_cells(&s, filled, 4, 4, 4);
        if (!made(&mesh, &s))
            continue;
        for (int z = 0; z < 4; z++) {
            CHECK_NEAR(layer[z], iso_mesh_volume_between(&mesh, z, z + 1), 1e-12);
            CHECK_NEAR(0.25 * layer[z], iso_mesh_volume_between(&mesh, z + 0.5, z + 0.75), 1e-12);
        }
        iso_mesh_free(&mesh);
    }
}

int main(void) {
    RUN(test_box);
    RUN(test_tetrahedron);
    RUN(test_sphere);
    RUN(test_translation_changes_nothing);
    RUN(test_models_are_placed_together);
    RUN(test_clipping_is_exact_at_corners);
    return check_verdict();
}

/* Transforms: closed forms, and the C library's sine for what the engine computes itself. */
#include "object/solid.h"

#include "base/angle.h"

static void test_sine_cosine(void) {
    for (int i = -7300; i <= 7300; i++) {
        double degrees = i / 10.0, s, c;
        iso_sine_cosine(&s, &c, degrees);
        CHECK_NEAR(sin(degrees * SHAPE_PI / 180), s, 4e-15); /* libm's argument is rounded */
        CHECK_NEAR(cos(degrees * SHAPE_PI / 180), c, 4e-15);
        CHECK_NEAR(1, s * s + c * c, 5e-16);
    }
    static const double exact[5][3] = {
        {0, 0, 1}, {90, 1, 0}, {180, 0, -1}, {270, -1, 0}, {-90, -1, 0}};
    for (int i = 0; i < 5; i++) {
        double s, c;
        iso_sine_cosine(&s, &c, exact[i][0]);
        CHECK(s == exact[i][1] && c == exact[i][2]);
    }
}

static int box(iso_mesh *mesh) {
    shape s = {0};
    shape_box(&s, 10, 20, 30, 11, 22, 33);
    return solid_made(mesh, &s);
}

static void check_size(const iso_mesh *mesh, double x, double y, double z, double tolerance) {
    CHECK_NEAR(x, mesh->max.x - mesh->min.x, tolerance);
    CHECK_NEAR(y, mesh->max.y - mesh->min.y, tolerance);
    CHECK_NEAR(z, mesh->max.z - mesh->min.z, tolerance);
    CHECK_NEAR(10.5, (mesh->max.x + mesh->min.x) / 2, 1e-12);
    CHECK_NEAR(21, (mesh->max.y + mesh->min.y) / 2, 1e-12);
    CHECK_NEAR(31.5, (mesh->max.z + mesh->min.z) / 2, 1e-12);
    CHECK_OK(iso_mesh_validate(mesh));
}

/* What a transform makes of a box of 1 x 2 x 3. */
static void check_box(const iso_transform *t, iso_vec3 size, double volume, double tolerance) {
    iso_mesh mesh;
    if (!box(&mesh))
        return;
    if (CHECK_OK(iso_meshes_transform(&mesh, 1, t))) {
        check_size(&mesh, size.x, size.y, size.z, tolerance);
        CHECK_NEAR(volume, iso_mesh_volume(&mesh), 1e-12 * volume);
    }
    iso_mesh_free(&mesh);
}

static void test_sizes(void) {
    check_box(&(iso_transform){0}, (iso_vec3){1, 2, 3}, 6, 0);
    check_box(&(iso_transform){.scale = 2}, (iso_vec3){2, 4, 6}, 48, 0);
    check_box(&(iso_transform){.inches = true}, (iso_vec3){25.4, 50.8, 76.2},
              6 * 25.4 * 25.4 * 25.4, 1e-13);
    check_box(&(iso_transform){.fit = {10, 10, 10}}, (iso_vec3){10 / 3.0, 20 / 3.0, 10}, 6e3 / 27,
              1e-13);
    check_box(&(iso_transform){.fit = {0, 1, 0}}, (iso_vec3){0.5, 1, 1.5}, 0.75, 0);
    for (int axis = 0; axis < 3; axis++) {
        iso_transform t = {0};
        t.mirror[axis] = true;
        check_box(&t, (iso_vec3){1, 2, 3}, 6, 0);
    }
}

/* Quarter turns are exact; others have the box of turned corners. */
static void test_turns(void) {
    check_box(&(iso_transform){.rotate = {0, 0, 90}}, (iso_vec3){2, 1, 3}, 6, 0);
    check_box(&(iso_transform){.rotate = {90, 0, 0}}, (iso_vec3){1, 3, 2}, 6, 0);
    check_box(&(iso_transform){.rotate = {0, -90, 0}}, (iso_vec3){3, 2, 1}, 6, 0);
    check_box(&(iso_transform){.rotate = {180, 180, 180}}, (iso_vec3){1, 2, 3}, 6, 0);
    check_box(&(iso_transform){.rotate = {90, 90, 0}}, (iso_vec3){2, 3, 1}, 6, 0);
    for (int i = 1; i < 90; i++) {
        double a = i * SHAPE_PI / 180, c = cos(a), s = sin(a);
        iso_vec3 size = {c + 2 * s, s + 2 * c, 3};
        check_box(&(iso_transform){.rotate = {0, 0, i}}, size, 6, 1e-13);
        size = (iso_vec3){1, 2 * c + 3 * s, 2 * s + 3 * c};
        check_box(&(iso_transform){.rotate = {i, 0, 0}}, size, 6, 1e-13);
    }
    check_box(&(iso_transform){.rotate = {0, 0, 90}, .fit = {4, 0, 0}}, (iso_vec3){4, 2, 6}, 48, 0);
}

/* Counter-clockwise about Z, and X before Z. */
static void test_sense(void) {
    shape s = {0};
    iso_mesh mesh;
    shape_tetrahedron(&s, 6); /* its right angle at the lowest corner of its box */
    if (!solid_made(&mesh, &s))
        return;
    CHECK_OK(iso_meshes_transform(&mesh, 1, &(iso_transform){.rotate = {90, 0, 90}}));
    /* (0,0,0) turns to (0,6,0) about X, and on to (0,0,0) about Z, within the cube of 6 */
    bool found[8] = {0};
    for (int32_t v = 0; v < mesh.vertex_count; v++) {
        iso_vec3 p = mesh.position[v];
        found[(p.x > 3) + 2 * (p.y > 3) + 4 * (p.z > 3)] = true;
    }
    /* x axis: (6,0,0) -> (6,6,0) -> (0,6,0); y: (0,6,0) -> (0,6,6) -> (0,0,6); z: (0,0,6) ->
     * (0,0,0) -> (6,0,0) */
    CHECK(found[0] && found[2] && found[4] && found[1]);
    CHECK(!found[3] && !found[5] && !found[6] && !found[7]);
    iso_mesh_free(&mesh);
}

/* Meshes go together: their places to each other turn with them. */
static void test_together(void) {
    iso_mesh mesh[2];
    shape s = {0};
    shape_box(&s, 0, 0, 0, 2, 2, 2);
    if (!solid_made(&mesh[0], &s))
        return;
    shape_box(&s, 8, 0, 0, 10, 2, 2);
    if (!solid_made(&mesh[1], &s))
        return;
    CHECK_OK(iso_meshes_transform(mesh, 2, &(iso_transform){.rotate = {0, 0, 90}}));
    CHECK_NEAR(-4, mesh[0].min.y, 0);
    CHECK_NEAR(4, mesh[1].min.y, 0);
    CHECK_NEAR(4, mesh[0].min.x, 0);
    CHECK_OK(iso_meshes_transform(mesh, 2, &(iso_transform){.scale = 0.5}));
    CHECK_NEAR(-1.5, mesh[0].min.y, 0);
    CHECK_NEAR(-0.5, mesh[0].max.y, 0);
    iso_mesh_free(&mesh[0]);
    iso_mesh_free(&mesh[1]);
}

static void test_nonsense(void) {
    iso_mesh mesh;
    if (!box(&mesh))
        return;
    CHECK_STATUS(ISO_USAGE, iso_meshes_transform(&mesh, 1, &(iso_transform){.scale = -1}));
    CHECK_STATUS(ISO_USAGE, iso_meshes_transform(&mesh, 1, &(iso_transform){.scale = NAN}));
    CHECK_STATUS(ISO_USAGE, iso_meshes_transform(&mesh, 1, &(iso_transform){.fit = {-1, 0, 0}}));
    CHECK_STATUS(ISO_USAGE,
                 iso_meshes_transform(&mesh, 1, &(iso_transform){.rotate = {0, INFINITY, 0}}));
    CHECK_STATUS(ISO_OUTSIDE, iso_meshes_transform(&mesh, 1, &(iso_transform){.scale = 1e8}));
    check_size(&mesh, 1, 2, 3, 0);
    iso_mesh_free(&mesh);
    CHECK_OK(iso_meshes_transform(NULL, 0, &(iso_transform){.scale = 2}));
}

/* A mirrored mesh is closed, right side out, and the mirror image. */
static void test_mirror(void) {
    shape s = {0};
    iso_mesh mesh, image;
    shape_torus(&s, (shape_point){5, 6, 7}, 9, 4, 24, 12);
    shape_box(&s, 30, 0, 0, 31, 2, 3);
    shape copy = s;
    if (!CHECK_OK(iso_mesh_from_triangles(&image, copy.triangle, copy.count)) ||
        !solid_made(&mesh, &s))
        return;
    CHECK_OK(iso_meshes_transform(&image, 1, &(iso_transform){.mirror = {true, false, false}}));
    CHECK_OK(iso_mesh_validate(&image));
    CHECK_NEAR(iso_mesh_volume(&mesh), iso_mesh_volume(&image), 1e-9);
    for (int32_t v = 0; v < mesh.vertex_count; v++) {
        CHECK_NEAR(mesh.min.x + mesh.max.x, mesh.position[v].x + image.position[v].x, 1e-12);
        CHECK(mesh.position[v].y == image.position[v].y);
    }
    iso_mesh_free(&mesh);
    iso_mesh_free(&image);
}

int main(void) {
    RUN(test_sine_cosine);
    RUN(test_sizes);
    RUN(test_turns);
    RUN(test_sense);
    RUN(test_together);
    RUN(test_nonsense);
    RUN(test_mirror);
    return check_verdict();
}

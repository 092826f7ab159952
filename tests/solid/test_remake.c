/* Surfaces made anew where they are open: the winding number of a half tells the side. */
#include "check.h"

#include "models/shapes.h"

#include <isoslice/mesh.h>

enum { AROUND = 96, UP = 24 };

static shape_point on_ball(double radius, int i, int j) {
    double a = 2 * SHAPE_PI * (i % AROUND) / AROUND, b = SHAPE_PI / 2 * j / UP;
    double r = j == UP ? 0 : radius * cos(b);
    return (shape_point){r * cos(a), r * sin(a), radius * sin(b)};
}

/* The upper half of a ball, without its floor or with it. */
static void add_half_ball(shape *s, double radius, int closed) {
    for (int i = 0; i < AROUND; i++) {
        for (int j = 0; j + 1 < UP; j++)
            shape_quad(s, on_ball(radius, i, j), on_ball(radius, i + 1, j),
                       on_ball(radius, i + 1, j + 1), on_ball(radius, i, j + 1));
        shape_add(s, on_ball(radius, i, UP - 1), on_ball(radius, i + 1, UP - 1),
                  on_ball(radius, i, UP));
        if (closed)
            shape_add(s, (shape_point){0, 0, 0}, on_ball(radius, i + 1, 0), on_ball(radius, i, 0));
    }
}

/* From anywhere in the plane of its rim an open half ball takes up half of all directions, as its
 * mirror image takes up the others: so the floor that it gets is flat, but for what the sums are
 * off by: a hundredth of the winding number is 0.2 mm there. A cube below makes room for it to
 * bulge. */
static void test_floor_of_a_half_ball(void) {
    iso_mesh_options options = {.volume = 1, .voxel = 0.25};
    double volume[2] = {0};
    for (int closed = 0; closed < 2; closed++) {
        shape s = {0};
        iso_mesh mesh;
        add_half_ball(&s, 10, closed);
        shape_box(&s, 12, 0, -8, 14, 2, -6);
        if (CHECK_OK(iso_mesh_from_triangles_with(&mesh, s.triangle, s.count,
                                                  closed ? NULL : &options))) {
            CHECK_OK(iso_mesh_validate(&mesh));
            volume[closed] = iso_mesh_volume(&mesh);
            double above = iso_mesh_volume_between(&mesh, 0, 20);
            CHECK_NEAR(volume[closed] - 8, above, 60);
            iso_mesh_free(&mesh);
        }
        shape_free(&s);
    }
    CHECK_NEAR(2.0 / 3 * SHAPE_PI * 1000, volume[1] - 8, 10);
    CHECK_NEAR(volume[1], volume[0], 0.03 * volume[1]);
}

int main(void) {
    RUN(test_floor_of_a_half_ball);
    return check_verdict();
}

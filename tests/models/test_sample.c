/* The sample part is what its maker says: closed, with its handles and its cavity. */
#include "check.h"

#include <isoslice/mesh.h>

static void test_sample_is_closed(void) {
    iso_mesh mesh = {0};
    if (!CHECK_OK(iso_mesh_read(&mesh, "sample.stl")))
        return;
    CHECK_OK(iso_mesh_validate(&mesh));
    CHECK_EQUAL(0, mesh.defects.bad_edges);
    CHECK_EQUAL(0, mesh.defects.degenerate);
    CHECK_EQUAL(0, mesh.defects.flipped_triangles);
    CHECK_EQUAL(0, mesh.defects.inverted_shells);
    CHECK_EQUAL(2, mesh.defects.shells);
    /* 6 drain holes and 18 windows are 24 handles; the cavity is a torus: 2 - 2 * 24 + 0 */
    CHECK_EQUAL(-46, mesh.vertex_count - mesh.triangle_count / 2);
    CHECK_NEAR(23931.7789, iso_mesh_volume(&mesh), 1e-3); /* by numpy, from the file */
    CHECK_NEAR(0, mesh.min.z, 0);
    CHECK_NEAR(50, mesh.max.z, 0);
    iso_mesh_free(&mesh);
}

int main(void) {
    RUN(test_sample_is_closed);
    return check_verdict();
}

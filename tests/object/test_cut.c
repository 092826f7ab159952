/* Cuts: both halves closed, their volumes add up, the caps are what the section is. */
#include "object/solid.h"

#include "base/memory.h"

#include <isoslice/slice.h>

typedef struct halves {
    iso_mesh lower, upper;
} halves;

static void halves_free(halves *h) {
    iso_mesh_free(&h->lower);
    iso_mesh_free(&h->upper);
}

static void check_half(const iso_mesh *half, double volume, double scale) {
    CHECK_OK(iso_mesh_validate(half));
    CHECK_NEAR(volume, iso_mesh_volume(half), 1e-10 * scale); /* the closed form's rounding */
}

/* Cuts, checks and leaves the halves to the caller. */
static int cut(halves *h, const iso_mesh *mesh, double z) {
    double all = iso_mesh_volume(mesh), below = iso_mesh_volume_between(mesh, -1e6, z);
    if (!CHECK_OK(iso_mesh_cut(&h->lower, &h->upper, mesh, z)))
        return 0;
    check_half(&h->lower, below, all);
    check_half(&h->upper, all - below, all);
    CHECK_NEAR(all, iso_mesh_volume(&h->lower) + iso_mesh_volume(&h->upper), 1e-12 * all);
    if (h->lower.triangle_count)
        CHECK(h->lower.max.z <= z && h->lower.min.z == mesh->min.z);
    if (h->upper.triangle_count)
        CHECK(h->upper.min.z >= z && h->upper.max.z == mesh->max.z);
    return 1;
}

/* The cap's triangles don't overlap: none is turned over, and together they are the section. */
static void check_caps(const halves *h, double z, double section) {
    double wrong;
    CHECK_NEAR(section, solid_flat(&h->lower, z, 1, &wrong), 1e-9 * section + 1e-9);
    CHECK_NEAR(0, wrong, 1e-5);
    CHECK_NEAR(section, solid_flat(&h->upper, z, -1, &wrong), 1e-9 * section + 1e-9);
    CHECK_NEAR(0, wrong, 1e-5);
}

static void test_box(void) {
    shape s = {0};
    iso_mesh mesh;
    halves h;
    shape_box(&s, -3, 5, 7, 4, 9, 17);
    if (!solid_made(&mesh, &s))
        return;
    for (int i = 1; i < 10; i++)
        if (cut(&h, &mesh, 7 + i)) {
            check_caps(&h, 7 + i, 28);
            CHECK_NEAR(2 * 28 + 22.0 * i, solid_area(&h.lower), 1e-12);
            CHECK_EQUAL(8 + 2, h.lower.vertex_count - 2); /* 4 corners, 8 crossings */
            halves_free(&h);
        }
    if (cut(&h, &mesh, 7)) {
        CHECK_EQUAL(0, h.lower.triangle_count);
        CHECK_EQUAL(12, h.upper.triangle_count);
        halves_free(&h);
    }
    if (cut(&h, &mesh, 17)) {
        CHECK_EQUAL(12, h.lower.triangle_count);
        CHECK_EQUAL(0, h.upper.triangle_count);
        halves_free(&h);
    }
    if (cut(&h, &mesh, 99)) {
        CHECK_EQUAL(0, h.upper.triangle_count);
        halves_free(&h);
    }
    CHECK_STATUS(ISO_USAGE, iso_mesh_cut(&h.lower, &h.upper, &mesh, NAN));
    iso_mesh_free(&mesh);
}

/* A step, cut at its flat: the flat belongs to the lower half alone. */
static void test_step(void) {
    static const uint8_t filled[] = {1, 1, 1, 0}; /* x fastest, then y, then z */
    shape s = {0};
    iso_mesh mesh;
    halves h;
    shape_cells(&s, filled, 2, 1, 2);
    if (!solid_made(&mesh, &s))
        return;
    if (cut(&h, &mesh, 1)) {
        double wrong;
        CHECK_NEAR(2, solid_flat(&h.lower, 1, 1, &wrong), 1e-12);
        CHECK_NEAR(1, solid_flat(&h.upper, 1, -1, &wrong), 1e-12);
        CHECK_NEAR(2 * 2 + 6, solid_area(&h.lower), 1e-12);
        CHECK_NEAR(6, solid_area(&h.upper), 1e-12);
        halves_free(&h);
    }
    iso_mesh_free(&mesh);
}

static void test_torus_lying(void) {
    shape s = {0};
    iso_mesh mesh;
    halves h;
    shape_torus(&s, (shape_point){30, -4, 9}, 9, 4, 48, 25);
    if (!solid_made(&mesh, &s))
        return;
    for (int i = 1; i < 40; i++) {
        double z = mesh.min.z + (mesh.max.z - mesh.min.z) * i / 40;
        if (!cut(&h, &mesh, z))
            continue;
        double wrong, section = solid_flat(&h.lower, z, 1, &wrong);
        check_caps(&h, z, section);
        CHECK(section > 0);
        halves_free(&h);
    }
    iso_mesh_free(&mesh);
}

/* Cells at random: sections with holes in holes, corners that touch, cuts at all flats. */
static void test_cells(void) {
    uint64_t state = 7;
    for (int turn = 0; turn < 60; turn++) {
        uint8_t filled[7 * 7 * 3];
        shape s = {0};
        iso_mesh mesh;
        halves h;
        int32_t section[3] = {0};
        for (int i = 0; i < 7 * 7 * 3; i++) {
            filled[i] = shape_random(&state) % 5 < 3;
            section[i / 49] += filled[i];
        }
        shape_cells(&s, filled, 7, 7, 3);
        if (!solid_made(&mesh, &s))
            continue;
        for (int level = 0; level < 3; level++) {
            if (cut(&h, &mesh, level + 0.25)) {
                check_caps(&h, level + 0.25, section[level]);
                halves_free(&h);
            }
            if (cut(&h, &mesh, level)) {
                double wrong;
                CHECK_NEAR(section[level], solid_flat(&h.upper, level, -1, &wrong), 1e-9);
                halves_free(&h);
            }
        }
        iso_mesh_free(&mesh);
    }
}

/* Vertices on the plane: ridges, tips and pits that touch it. */
static void test_touching(void) {
    shape s = {0};
    iso_mesh mesh;
    halves h;
    shape_sphere(&s, (shape_point){0, 0, 0}, 8, 12, 16);   /* vertices on z = 0 */
    shape_box(&s, 20, 0, -3, 25, 5, 0);                    /* ends at the plane */
    shape_box(&s, 30, 0, 0, 35, 5, 2);                     /* begins there */
    shape_sphere(&s, (shape_point){50, 0, -8}, 8, 12, 16); /* its tip is on the plane */
    shape_sphere(&s, (shape_point){70, 0, 8}, 8, 12, 16);
    if (!solid_made(&mesh, &s))
        return;
    if (cut(&h, &mesh, 0)) {
        CHECK(h.lower.max.z == 0 && h.upper.min.z == 0);
        halves_free(&h);
    }
    iso_mesh_free(&mesh);
    /* a roof whose ridge is in the plane, upright and overhead */
    shape_point a[6] = {{0, 0, -4}, {8, 0, -4}, {8, 6, -4}, {0, 6, -4}, {0, 3, 0}, {8, 3, 0}};
    shape_quad(&s, a[3], a[2], a[1], a[0]);
    shape_quad(&s, a[0], a[1], a[5], a[4]);
    shape_quad(&s, a[2], a[3], a[4], a[5]);
    shape_add(&s, a[1], a[2], a[5]);
    shape_add(&s, a[3], a[0], a[4]);
    if (!solid_made(&mesh, &s))
        return;
    if (cut(&h, &mesh, 0)) {
        CHECK_EQUAL(8, h.lower.triangle_count);
        CHECK_EQUAL(0, h.upper.triangle_count);
        halves_free(&h);
    }
    if (cut(&h, &mesh, -1))
        halves_free(&h);
    iso_mesh_free(&mesh);
}

/* What is cut slices as the whole did. */
static void test_slices(void) {
    shape s = {0};
    iso_mesh mesh;
    halves h;
    iso_levels levels = {0};
    iso_slices whole = {0}, part = {0};
    shape_torus(&s, (shape_point){0, 0, 4}, 9, 4, 60, 31);
    if (!solid_made(&mesh, &s))
        return;
    if (cut(&h, &mesh, 5.001)) {
        if (CHECK_OK(iso_levels_uniform(&levels, 5, 0.2, 0.2)) &&
            CHECK_OK(iso_slice_planar(&whole, &mesh, &levels)) &&
            CHECK_OK(iso_slice_planar(&part, &h.lower, &levels))) {
            CHECK_EQUAL(whole.contour_count, part.contour_count);
            CHECK(part.crossing_count >= whole.crossing_count);
        }
        halves_free(&h);
    }
    iso_slices_free(&whole);
    iso_slices_free(&part);
    iso_levels_free(&levels);
    iso_mesh_free(&mesh);
}

static void test_no_memory(void) {
    shape s = {0};
    iso_mesh mesh;
    halves h;
    shape_torus(&s, (shape_point){0, 0, 4}, 9, 4, 24, 12);
    if (!solid_made(&mesh, &s))
        return;
    iso_fail_allocation_after(-1);
    if (CHECK_OK(iso_mesh_cut(&h.lower, &h.upper, &mesh, 4.1)))
        halves_free(&h);
    int64_t count = iso_fail_allocation_after(-1);
    for (int64_t n = 0; n < count; n++) {
        iso_fail_allocation_after(n);
        iso_status status = iso_mesh_cut(&h.lower, &h.upper, &mesh, 4.1);
        iso_fail_allocation_after(-1);
        CHECK_STATUS(ISO_NO_MEMORY, status);
        CHECK(!h.lower.position && !h.upper.position);
    }
    iso_mesh_free(&mesh);
}

int main(void) {
    RUN(test_box);
    RUN(test_step);
    RUN(test_torus_lying);
    RUN(test_cells);
    RUN(test_touching);
    RUN(test_slices);
    RUN(test_no_memory);
    return check_verdict();
}

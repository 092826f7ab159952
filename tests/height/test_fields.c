/* Fields of models: what they say at points against closed forms, their gradients against
 * differences, their bounds against thousands of points. */
#include "height/fields.h"

#include <stdlib.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/vector.h"
#include "check.h"
#include "models/shapes.h"
#include "solid/volume.h"

static const iso_vec3 nowhere = {0, 0, 0};
static uint64_t seed = 11;

static double uniform(double low, double high) {
    return low + (high - low) * shape_random(&seed) / 0x1p31;
}

static iso_vec3 any_point(double reach) {
    double x = uniform(-reach, reach), y = uniform(-reach, reach);
    return (iso_vec3){x, y, uniform(-reach, reach)};
}

/* Every point of small and large boxes keeps to the bound; says how often it was of use. */
static int check_bounds(const iso_field *field, double reach, int boxes) {
    int useful = 0, broken = 0;
    for (int i = 0; i < boxes; i++) {
        iso_vec3 low = any_point(reach), size = vec3_times(any_point(1), i % 3 ? 0.2 : 3);
        iso_vec3 high = vec3_plus(low, vec3(fabs(size.x), fabs(size.y), fabs(size.z)));
        iso_field_bound b;
        iso_field_bound_over(&b, field, low, high);
        useful += b.gradient_low.z > 0 || b.gradient_high.z < 0;
        for (int k = 0; k < 40; k++) {
            iso_vec3 p = {uniform(low.x, high.x), uniform(low.y, high.y), uniform(low.z, high.z)};
            if (k == 0)
                p = low;
            iso_vec3 g;
            double value;
            iso_field_evaluate(&value, &g, field, &p, 1);
            broken +=
                !(value >= b.low && value <= b.high && g.x >= b.gradient_low.x &&
                  g.x <= b.gradient_high.x && g.y >= b.gradient_low.y && g.y <= b.gradient_high.y &&
                  g.z >= b.gradient_low.z && g.z <= b.gradient_high.z);
        }
    }
    CHECK_EQUAL(0, broken);
    printf("     %d of %d bounds tell the slope's sign\n", useful, boxes);
    return useful;
}

/* Smooth at nearly every point: rises by what the gradient says. */
static void check_gradients(const iso_field *field, double reach) {
    int off = 0;
    for (int i = 0; i < 2000; i++) {
        iso_vec3 p = any_point(reach), way = any_point(1e-6), q = vec3_plus(p, way), g;
        double value[2];
        iso_field_evaluate(&value[0], &g, field, &p, 1);
        iso_field_evaluate(&value[1], NULL, field, &q, 1);
        off += fabs(value[1] - value[0] - vec3_dot(g, way)) > 1e-9;
    }
    CHECK(off < 20);
}

static int open_shape(iso_field **field, shape *s, iso_vec3 origin) {
    iso_mesh mesh;
    *field = NULL;
    int made = CHECK_OK(iso_mesh_from_triangles(&mesh, s->triangle, s->count));
    shape_free(s);
    if (!made)
        return 0;
    made = CHECK_OK(height_new_distance_to(field, &mesh, origin));
    iso_mesh_free(&mesh);
    return made;
}

/* Outside of a box, past its sides, edges and corners, and inside. */
static double box_distance(iso_vec3 p, iso_vec3 low, iso_vec3 high) {
    double x = fmax(low.x - p.x, p.x - high.x), y = fmax(low.y - p.y, p.y - high.y);
    double z = fmax(low.z - p.z, p.z - high.z), most = fmax(x, fmax(y, z));
    if (most <= 0)
        return most;
    return sqrt(pow(fmax(x, 0), 2) + pow(fmax(y, 0), 2) + pow(fmax(z, 0), 2));
}

static void test_box(void) {
    shape s = {0};
    iso_field *field;
    shape_box(&s, 10, 0, 0, 14, 6, 5);
    if (!open_shape(&field, &s, (iso_vec3){12, 3, 2}))
        return;
    CHECK_EQUAL(ISO_FIELD_DISTANCE, iso_field_kind_of(field));
    CHECK(!iso_field_is_z(field));
    double worst = 0, longest = 0;
    for (int i = 0; i < 20000; i++) {
        iso_vec3 p = any_point(8), g;
        double value;
        iso_field_evaluate(&value, &g, field, &p, 1);
        worst =
            fmax(worst, fabs(value - box_distance(p, (iso_vec3){-2, -3, -2}, (iso_vec3){2, 3, 3})));
        longest = fmax(longest, fabs(vec3_length(g) - 1));
    }
    CHECK_NEAR(0, worst, 1e-12);
    CHECK_NEAR(0, longest, 1e-12);
    /* on the surface itself, its normals */
    const iso_vec3 at[] = {{0, 0, 3}, {2, 0, 0}, {2, 0, 3}, {2, 3, 3}};
    const iso_vec3 normal[] = {{0, 0, 1},
                               {1, 0, 0},
                               {sqrt(0.5), 0, sqrt(0.5)},
                               {sqrt(1.0 / 3), sqrt(1.0 / 3), sqrt(1.0 / 3)}};
    for (int i = 0; i < 4; i++) {
        double value;
        iso_vec3 g;
        iso_field_evaluate(&value, &g, field, &at[i], 1);
        CHECK_NEAR(0, value, 1e-15);
        CHECK_NEAR(0, vec3_distance(g, normal[i]), 1e-12);
    }
    check_gradients(field, 8);
    CHECK(check_bounds(field, 8, 600) > 300);
    iso_field_free(field);
}

static void test_ball_and_ring(void) {
    shape s = {0};
    iso_field *field;
    shape_torus(&s, (shape_point){0, 0, 0}, 6, 2, 96, 48);
    if (!open_shape(&field, &s, nowhere))
        return;
    double worst = 0;
    for (int i = 0; i < 4000; i++) {
        iso_vec3 p = any_point(9);
        double value, around = sqrt(p.x * p.x + p.y * p.y) - 6;
        iso_field_evaluate(&value, NULL, field, &p, 1);
        worst = fmax(worst, fabs(value - (sqrt(around * around + p.z * p.z) - 2)));
    }
    CHECK(worst < 0.02); /* how far its sides are off a ring */
    check_gradients(field, 9);
    CHECK(check_bounds(field, 9, 400) > 150);
    iso_field_free(field);
}

/* Corners where sides outward and inward meet: a wrong normal would tell the wrong side. */
static void test_sides_at_corners(void) {
    shape s = {0};
    iso_field *field;
    uint8_t filled[27];
    for (int i = 0; i < 27; i++)
        filled[i] = i != 26 && i != 13 && i != 9 && i != 4;
    shape_cells(&s, filled, 3, 3, 3);
    if (!open_shape(&field, &s, nowhere))
        return;
    int wrong = 0;
    for (int i = 0; i < 20000; i++) {
        iso_vec3 p = {uniform(-1, 4), uniform(-1, 4), uniform(-1, 4)};
        double value;
        iso_field_evaluate(&value, NULL, field, &p, 1);
        int x = (int)floor(p.x), y = (int)floor(p.y), z = (int)floor(p.z);
        int within =
            x >= 0 && x < 3 && y >= 0 && y < 3 && z >= 0 && z < 3 && filled[x + 3 * (y + 3 * z)];
        wrong += within != (value < 0);
    }
    CHECK_EQUAL(0, wrong);
    iso_field_free(field);
}

static double volume_of(iso_vec3 a, iso_vec3 b, iso_vec3 c, iso_vec3 d) {
    return vec3_dot(vec3_cross(vec3_minus(b, a), vec3_minus(c, a)), vec3_minus(d, a));
}

/* Past the tip of a needle, from where some of its sides are seen from behind. */
static void test_side_at_tip(void) {
    const iso_vec3 v[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {6, 7, 8}};
    const int side[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    shape s = {0};
    iso_field *field;
    for (int i = 0; i < 4; i++) {
        shape_point p[3];
        for (int k = 0; k < 3; k++)
            p[k] = (shape_point){v[side[i][k]].x, v[side[i][k]].y, v[side[i][k]].z};
        shape_add(&s, p[0], p[1], p[2]);
    }
    if (!open_shape(&field, &s, nowhere))
        return;
    int wrong = 0;
    for (int i = 0; i < 20000; i++) {
        iso_vec3 p = i % 2 ? vec3_plus(v[3], any_point(2)) : vec3_times(any_point(4), 2);
        double value;
        int within = 1;
        iso_field_evaluate(&value, NULL, field, &p, 1);
        for (int k = 0; k < 4; k++)
            within &= volume_of(v[side[k][0]], v[side[k][1]], v[side[k][2]], p) < 0;
        wrong += within != (value < 0);
    }
    CHECK_EQUAL(0, wrong);
    iso_field_free(field);
}

static void test_geodesic_field(void) {
    shape s = {0};
    iso_mesh mesh;
    iso_field *field;
    shape_sphere(&s, (shape_point){0, 0, 0}, 10, 48, 96);
    if (!CHECK_OK(iso_mesh_from_triangles(&mesh, s.triangle, s.count)))
        return;
    shape_free(&s);
    if (CHECK_OK(iso_field_open(&field, " geodesic\n", &mesh, 1, 40, nowhere))) {
        CHECK_EQUAL(ISO_FIELD_GEODESIC, iso_field_kind_of(field));
        double worst = 0, steep = 0, apart = 0;
        for (int i = 0; i < 4000; i++) {
            iso_vec3 p = vec3_times(vec3_unit(any_point(1)), uniform(9.7, 10.3)), g;
            double value;
            iso_field_evaluate(&value, &g, field, &p, 1);
            double exact = 10 * acos(fmax(-1, fmin(1, -p.z / vec3_length(p))));
            worst = fmax(worst, fabs(value - exact));
            if (exact > 3 && exact < 28) {
                steep = fmax(steep, fabs(vec3_length(g) - 1));
                apart = fmax(apart, fabs(vec3_dot(g, vec3_unit(p))));
            }
        }
        printf("     geodesic: worst %.4f mm of 31.4\n", worst);
        CHECK(worst < 0.03);
        CHECK(steep < 0.02);
        CHECK(apart < 0.1); /* along the surface */
        check_bounds(field, 8, 200);
        double *height = malloc(sizeof *height * (size_t)mesh.vertex_count);
        double *other = malloc(sizeof *height * (size_t)mesh.vertex_count);
        height_of_vertices(height, field, &mesh);
        CHECK_OK(height_geodesic_rise(other, &mesh, mesh.min.z));
        CHECK(memcmp(height, other, sizeof *height * (size_t)mesh.vertex_count) == 0);
        iso_mesh_translate(&mesh, (iso_vec3){1e-12, 0, 0}); /* no longer the same */
        height_of_vertices(height, field, &mesh);
        for (int32_t v = 0; v < mesh.vertex_count; v++)
            CHECK_NEAR(other[v], height[v], 1e-10);
        free(height);
        free(other);
        iso_field_free(field);
    }
    iso_mesh_free(&mesh);
}

static void test_files(void) {
    char path[] = "/tmp/isoslice-height-XXXXXX", text[200], grid[100];
    int file = mkstemp(path);
    iso_field *field = NULL;
    shape s = {0};
    shape_box(&s, 0, 0, 0, 4, 6, 8);
    if (!CHECK(file >= 0) || !CHECK(shape_write_binary(&s, path)))
        return;
    close(file);
    snprintf(text, sizeof text, "  distance: %s ", path);
    if (CHECK_OK(iso_field_open(&field, text, NULL, 0, 40, (iso_vec3){2, 3, 0}))) {
        const iso_vec3 p = {5, 0, 4};
        double value;
        iso_field_evaluate(&value, NULL, field, &p, 1);
        CHECK_NEAR(3, value, 1e-12);
        iso_field_free(field);
    }
    CHECK_STATUS(ISO_UNREADABLE,
                 iso_field_open(&field, "distance:/nowhere/x.stl", NULL, 0, 40, nowhere));
    CHECK_STATUS(ISO_BAD_CONFIG, iso_field_open(&field, "distance:", NULL, 0, 40, nowhere));
    CHECK_STATUS(ISO_USAGE, iso_field_open(&field, "geodesic", NULL, 0, 40, nowhere));
    CHECK(field == NULL);

    iso_vec3 corner[36];
    for (int i = 0; i < 36; i++)
        corner[i] = (iso_vec3){s.triangle[3 * i], s.triangle[3 * i + 1], s.triangle[3 * i + 2]};
    const iso_volume_surface surface = {
        .corner = corner, .count = 12, .voxel = 0.25, .outer = 1, .inner = 1};
    iso_volume *volume = NULL;
    snprintf(grid, sizeof grid, "%s.vdb", path);
    if (volume_from_surface(&volume, &surface) == ISO_BAD_CONFIG) {
        printf("     without isoslice-volume.so: %s\n", iso_error_message());
    } else if (CHECK_OK(volume_write(volume, grid))) {
        snprintf(text, sizeof text, "distance:%s", grid);
        if (CHECK_OK(iso_field_open(&field, text, NULL, 0, 40, (iso_vec3){2, 3, 0}))) {
            double worst = 0;
            for (int i = 0; i < 3000; i++) {
                iso_vec3 p = any_point(20);
                double value;
                iso_field_evaluate(&value, NULL, field, &p, 1);
                worst =
                    fmax(worst,
                         fabs(value - box_distance(p, (iso_vec3){-2, -3, 0}, (iso_vec3){2, 3, 8})));
            }
            printf("     grid: worst %.4f mm\n", worst);
            CHECK(worst < 0.3); /* corners are as round as voxels make them */
            iso_field_free(field);
        }
        remove(grid);
    }
    volume_free(volume);
    remove(path);
    shape_free(&s);
}

static void test_memory(void) {
    iso_mesh mesh;
    shape s = {0};
    shape_box(&s, 0, 0, 0, 4, 6, 8);
    if (!CHECK_OK(iso_mesh_from_triangles(&mesh, s.triangle, s.count)))
        return;
    shape_free(&s);
    for (int kind = 0; kind < 2; kind++) {
        iso_status status = ISO_NO_MEMORY;
        int64_t n = 0;
        for (; n < 200 && status != ISO_OK; n++) {
            iso_field *field = NULL;
            iso_fail_allocation_after(n);
            status = kind ? height_new_distance_to(&field, &mesh, nowhere)
                          : height_new_geodesic(&field, &mesh, 1);
            iso_fail_allocation_after(-1);
            CHECK_EQUAL(status == ISO_OK, field != NULL);
            iso_field_free(field);
        }
        CHECK(n > 8 && status == ISO_OK);
    }
    iso_mesh_free(&mesh);
}

int main(void) {
    RUN(test_box);
    RUN(test_ball_and_ring);
    RUN(test_sides_at_corners);
    RUN(test_side_at_tip);
    RUN(test_geodesic_field);
    RUN(test_files);
    RUN(test_memory);
    return check_verdict();
}

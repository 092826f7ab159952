/* Lattices that follow a part's skin, against parts whose distance is known. */
#include "check.h"

#include <stdbool.h>
#include <stdlib.h>

#include "base/memory.h"
#include "lattice/lattice.h"
#include "lattice/space.h"
#include "part.h"
#include "solid/volume.h"

enum { POINTS = 20000 };

static iso_mesh ball, tube, pair[2];
static const double radius = 20;

static uint64_t state = 88172645463325252u;

static double uniform(double low, double high) {
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return low + (high - low) * (double)(state >> 11) * 0x1p-53;
}

static void make_parts(void) {
    static double curve[33][2];
    for (int i = 0; i <= 32; i++) { /* from pole to pole */
        double angle = 3.14159265358979323846 * (i / 32.0 - 0.5);
        curve[i][0] = i % 32 ? radius * cos(angle) : 0;
        curve[i][1] = radius + radius * sin(angle);
    }
    CHECK_OK(part_turned(&ball, curve, 33, 96, 50, 60));
    const double wall[4][2] = {{20, 0}, {30, 0}, {30, 40}, {20, 40}};
    CHECK_OK(part_turned(&tube, wall, 4, 256, 50, 60));
    const double side[3] = {30, 20, 20}, at[3] = {0, 0, 0}, beside[3] = {20, 0, 0};
    CHECK_OK(part_box(&pair[0], side, at));
    CHECK_OK(part_box(&pair[1], side, beside));
}

/* The variable at places in the frame. */
static double skin_at(const iso_space *space, double x, double y, double z) {
    static iso_places places;
    places.value[GRADING_X][0] = x;
    places.value[GRADING_Y][0] = y;
    places.value[GRADING_Z][0] = z;
    space_know(&places, space, 1 << GRADING_SKIN, 1);
    return places.value[GRADING_SKIN][0];
}

static iso_space made_space(const iso_mesh *mesh, int32_t count) {
    iso_space space = {0};
    iso_lattice_options options = iso_lattice_defaults();
    options.skin_voxel = 0.8;
    CHECK_OK(space_make(&space, &options, 1 << GRADING_SKIN, mesh, count));
    return space;
}

static void test_distance_in_a_ball(void) {
    iso_space space = made_space(&ball, 1);
    double worst = 0;
    for (int i = 0; i < POINTS; i++) {
        double x = uniform(-20, 20), y = uniform(-20, 20), z = uniform(0, 40);
        double depth = radius - sqrt(x * x + y * y + (z - radius) * (z - radius));
        if (depth > -0.3 && depth < radius - 2) /* in the middle is a kink */
            worst = fmax(worst, fabs(skin_at(&space, x, y, z) - depth));
    }
    CHECK_NEAR(0, worst, 0.1);
    CHECK_NEAR(10, skin_at(&space, 10, 0, 20), 0.02);
    CHECK_NEAR(1, skin_at(&space, 0, -19, 20), 0.02);
    CHECK(skin_at(&space, 20, 20, 0) < 0);
    space_free(&space);
}

/* Of two boxes that overlap, the inside is inside once; of a tube the hole is outside. */
static void test_sides(void) {
    iso_space space = made_space(pair, 2);
    CHECK(skin_at(&space, 0, 0, 10) > 0 && skin_at(&space, -24, 0, 10) > 0);
    CHECK_NEAR(1, skin_at(&space, -24, 0, 10), 0.02);
    CHECK(skin_at(&space, -26, 0, 10) < 0);
    space_free(&space);
    space = made_space(&tube, 1);
    CHECK_NEAR(5, skin_at(&space, 25, 0, 20), 0.4); /* a kink, and voxels of 0.8 mm */
    CHECK_NEAR(3, skin_at(&space, 23, 0, 20), 0.02);
    CHECK_NEAR(2, skin_at(&space, 0, -22, 20), 0.02);
    CHECK_NEAR(3, skin_at(&space, 25, 0, 37), 0.02);
    CHECK(skin_at(&space, 0, 0, 20) < 0 && skin_at(&space, 19, 0, 20) < 0);
    space_free(&space);
}

/* The share in material of what lies so deep in the ball, less what was asked, percent. */
static double excess_at_depth(const iso_lattice *lattice, double low, double high) {
    static iso_vec3 point[POINTS];
    static double value[POINTS];
    double in = 0;
    for (int i = 0; i < POINTS;) {
        double x = uniform(-20, 20), y = uniform(-20, 20), z = uniform(-20, 20);
        double depth = radius - sqrt(x * x + y * y + z * z);
        if (depth < low || depth > high)
            continue;
        point[i++] = (iso_vec3){50 + x, 60 + y, 20 + z};
        in -= depth < 2 ? 1 : fmax(0.8 - 0.06 * (depth - 2), 0.2);
    }
    lattice_sample(value, lattice, point, POINTS);
    for (int i = 0; i < POINTS; i++)
        in += value[i] <= 0;
    return 100 * in / POINTS;
}

static void test_density_by_skin(void) {
    iso_lattice_options options = iso_lattice_defaults();
    iso_lattice *lattice = NULL;
    options.skin_voxel = 1;
    options.cell = "2.5";
    options.density = "skin < 2 ? 100 : ramp(skin, 2, 12, 80, 20)";
    CHECK_OK(lattice_new(&lattice, &options, &ball, 1));
    CHECK_NEAR(0, excess_at_depth(lattice, 0, 1.95), 0.5);
    CHECK_NEAR(0, excess_at_depth(lattice, 2, 7), 2);
    CHECK_NEAR(0, excess_at_depth(lattice, 7, 12), 2);
    CHECK_NEAR(0, excess_at_depth(lattice, 13, 17), 2);
    lattice_free(lattice);
}

/* Layers along the skin: x, y and depth on the ball's cap; arc, z and depth in the tube's wall. */
static void test_maps_of_skin(void) {
    static iso_vec3 point[POINTS];
    static double value[POINTS];
    for (int map = ISO_LATTICE_MAP_SKIN; map <= ISO_LATTICE_MAP_SKIN_CYLINDER; map++) {
        for (int pattern = 0; pattern < 2; pattern++) {
            iso_lattice_options options = iso_lattice_defaults();
            iso_lattice *lattice = NULL;
            bool cap = map == ISO_LATTICE_MAP_SKIN;
            options.skin_voxel = 1;
            options.cell = "1.25";
            options.density = "30";
            options.map = map;
            options.pattern = pattern ? ISO_LATTICE_PRIMITIVE_SHEET : ISO_LATTICE_GYROID_SHEET;
            CHECK_OK(lattice_new(&lattice, &options, cap ? &ball : &tube, 1));
            int64_t in = 0;
            for (int i = 0; i < POINTS;) {
                double x = uniform(-30, 30), y = uniform(-30, 30), z = uniform(6, 34);
                double r = sqrt(x * x + y * y), depth = radius - sqrt(r * r + (z - 20) * (z - 20));
                if (cap ? r < 8 && z > 25 && depth > 0.5 && depth < 10.5 : r > 20.1 && r < 24.9)
                    point[i++] = (iso_vec3){50 + x, 60 + y, z};
            }
            lattice_sample(value, lattice, point, POINTS);
            for (int i = 0; i < POINTS; i++)
                in += value[i] <= 0;
            CHECK_NEAR(30, 100.0 * (double)in / POINTS, 2);
            lattice_free(lattice);
        }
    }
}

/* Cells that grow with depth are counted along it, as long as that is the map's. */
static void test_cells_by_skin(void) {
    iso_lattice_options options = iso_lattice_defaults();
    iso_lattice *lattice = NULL;
    options.skin_voxel = 2;
    options.cell = "ramp(skin, 0, 10, 1, 2)";
    options.map = ISO_LATTICE_MAP_SKIN;
    CHECK_OK(lattice_new(&lattice, &options, &ball, 1));
    CHECK_NEAR(1, lattice_smallest_cell(lattice), 0.05);
    lattice_free(lattice);
    options.cell = "skin - 1"; /* at the skin there's none */
    CHECK_STATUS(ISO_BAD_CONFIG, lattice_new(&lattice, &options, &ball, 1));
    CHECK(strstr(iso_error_message(), "lattice_cell is") != NULL);
    CHECK(lattice == NULL);
}

static iso_status slope(void *payload, float *value, iso_vec3 corner) {
    const double *voxel = payload;
    for (int z = 0; z < ISO_VOLUME_BLOCK; z++)
        for (int y = 0; y < ISO_VOLUME_BLOCK; y++)
            for (int x = 0; x < ISO_VOLUME_BLOCK; x++)
                value[x + 8 * (y + 8 * z)] =
                    (float)(-1 + 0.05 * (corner.x + x * *voxel) + 0 * (y + z));
    return ISO_OK;
}

/* A grid from a file, in the part's frame: the surface x = 20 as a distance. */
static void test_grid(void) {
    const char *path = "test_lattice_skin.vdb";
    double voxel = 1;
    iso_volume *volume = NULL;
    iso_volume_plan plan = {.min = {-40, -40, -8},
                            .max = {40, 40, 48},
                            .voxel = voxel,
                            .kind = ISO_VOLUME_DISTANCE,
                            .name = "field",
                            .fill = slope,
                            .payload = &voxel};
    CHECK_OK(volume_build(&volume, &plan));
    CHECK_OK(volume_write(volume, path));
    volume_free(volume);
    iso_lattice_options options = iso_lattice_defaults();
    iso_lattice *lattice = NULL;
    options.grid = path;
    options.density = "grid < 0 ? 100 : 0";
    CHECK_OK(lattice_new(&lattice, &options, &tube, 1));
    iso_vec3 point[2] = {{50 + 18.5, 60, 10}, {50 + 21.5, 60, 10}};
    double value[2];
    lattice_sample(value, lattice, point, 2);
    CHECK(value[0] < 0 && value[1] > 0);
    lattice_free(lattice);
    remove(path);
    CHECK_STATUS(ISO_UNREADABLE, lattice_new(&lattice, &options, &tube, 1));
    options.grid = "";
    CHECK_STATUS(ISO_BAD_CONFIG, lattice_new(&lattice, &options, &tube, 1));
    CHECK(strstr(iso_error_message(), "lattice_grid") != NULL);
    options.density = "20";
    CHECK_OK(lattice_new(&lattice, &options, &tube, 1)); /* not asked for, not looked at */
    lattice_free(lattice);
}

int main(void) {
    make_parts();
    RUN(test_distance_in_a_ball);
    RUN(test_sides);
    RUN(test_density_by_skin);
    RUN(test_maps_of_skin);
    RUN(test_cells_by_skin);
    RUN(test_grid);
    iso_mesh_free(&ball);
    iso_mesh_free(&tube);
    iso_mesh_free(&pair[0]);
    iso_mesh_free(&pair[1]);
    return check_verdict();
}

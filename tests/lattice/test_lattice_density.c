/* Density asked and density had, counted by points: where it varies, where cells vary, and around
 * axes.
 *
 * A window of 5 mm has few cells, and where their size varies not a whole number of them; what is
 * asked of a lattice holds for whole ones. So where sizes vary windows have soft ends, as long as a
 * cell: each cell then counts as often in one phase as in another. */
#include "check.h"

#include <stdbool.h>

#include "base/series.h"
#include "lattice/lattice.h"
#include "part.h"

static iso_mesh box, tube;

static uint64_t state;

static double uniform(double low, double high) {
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return low + (high - low) * (double)(state >> 11) * 0x1p-53;
}

static iso_lattice *made(const iso_lattice_options *options, const iso_mesh *mesh) {
    iso_lattice *lattice = NULL;
    state = 88172645463325252u;
    CHECK_OK(lattice_new(&lattice, options, mesh, 1));
    return lattice;
}

enum { BATCH = 1000 };

/* Of `batches` thousand points from low to high, in the meshes' coordinates, the share in material,
 * percent. The ends along z are soft by so many mm. */
static double counted(const iso_lattice *lattice, iso_vec3 low, iso_vec3 high, double soft,
                      int batches) {
    static iso_vec3 point[BATCH];
    static double value[BATCH];
    int64_t in = 0;
    for (int b = 0; b < batches; b++) {
        for (int i = 0; i < BATCH; i++) /* z in layers, for less scatter */
            point[i] = (iso_vec3){uniform(low.x, high.x), uniform(low.y, high.y),
                                  low.z + (high.z - low.z) * (i + uniform(0, 1)) / BATCH +
                                      uniform(-soft / 2, soft / 2)};
        lattice_sample(value, lattice, point, BATCH);
        for (int i = 0; i < BATCH; i++)
            in += value[i] <= 0;
    }
    return 100.0 * (double)in / BATCH / batches;
}

/* The same in the round: r and z from low to high about the middle at x, y. */
static double counted_around(const iso_lattice *lattice, const double r[2], const double z[2],
                             int batches) {
    static iso_vec3 point[BATCH];
    static double value[BATCH];
    int64_t in = 0;
    for (int b = 0; b < batches; b++) {
        for (int i = 0; i < BATCH; i++) {
            double sine, cosine, at = sqrt(uniform(r[0] * r[0], r[1] * r[1]));
            series_sine_cosine(&sine, &cosine, 6.283185307179586 * (i + uniform(0, 1)) / BATCH);
            point[i] = (iso_vec3){30 + at * cosine, 40 + at * sine, uniform(z[0], z[1])};
        }
        lattice_sample(value, lattice, point, BATCH);
        for (int i = 0; i < BATCH; i++)
            in += value[i] <= 0;
    }
    return 100.0 * (double)in / BATCH / batches;
}

/* Windows of 5 mm with 8 cells each; of random patterns, with a whole box that repeats. */
static void test_density_ramp(void) {
    for (int32_t pattern = 0; pattern < ISO_LATTICE_VOXEL_FILE; pattern++) {
        if (pattern > ISO_LATTICE_PRIMITIVE_SOLID && pattern < ISO_LATTICE_BCC_STRUTS &&
            pattern % 2)
            continue; /* the other sides of sheets tell no more */
        iso_lattice_options options = iso_lattice_defaults();
        bool random = pattern >= ISO_LATTICE_FOAM_STRUTS && pattern <= ISO_LATTICE_BONE_SOLID;
        options.pattern = pattern;
        options.cell = pattern == ISO_LATTICE_VOXEL_RANDOM ? "0.625" : random ? "1.25" : "2.5";
        options.density = "ramp(z, 0, 40, 10, 90)";
        iso_lattice *lattice = made(&options, &box);
        CHECK(!lattice_is_uniform(lattice));
        for (int k = 0; k < 8; k++) {
            iso_vec3 low = {-7.5 + 1.3 * k, 3.1 - k, 5 * k},
                     high = {low.x + 5, low.y + 5, low.z + 5};
            double share = counted(lattice, low, high, 0, 12);
            if (!CHECK_NEAR(15 + 10 * k, share, 2))
                fprintf(stderr, "%s\n", iso_lattice_name(pattern));
        }
        lattice_free(lattice);
    }
}

static const int32_t some[] = {ISO_LATTICE_GYROID_SHEET, ISO_LATTICE_PRIMITIVE_SOLID,
                               ISO_LATTICE_BCC_STRUTS};

/* Where sizes jump no window has cells of one size at both ends: there all that matters is all. */
static void test_ramps_of_cells(void) {
    static const char *const cell[] = {
        "ramp(z, 0, 40, 2, 3)", "ramp(x, -20, 20, 2, 3)",           "2.5 + 0.5 * sin(y / 4)",
        "ramp(r, 0, 20, 2, 3)", "2.5 + x / 80 + y / 160 - z / 200", "z < 20 ? 2 : 3"};
    for (int i = 0; i < 6; i++) {
        for (int p = 0; p < 3; p++) {
            iso_lattice_options options = iso_lattice_defaults();
            options.pattern = some[p];
            options.cell = cell[i];
            options.density = "30";
            iso_lattice *lattice = made(&options, &box);
            /* divided, not counted, they are shorter than asked outside: 1.925^2 / 2.5 */
            CHECK_NEAR(i == 4 ? 1.482 : 2, lattice_smallest_cell(lattice), 1e-3);
            const iso_vec3 min = {-20, -20, 0}, max = {20, 20, 40};
            CHECK_NEAR(30, counted(lattice, min, max, 2.5, 60), 1);
            for (int k = 0; k < 8 && i < 5; k++) {
                iso_vec3 low = {-20, -20, 5 * k}, high = {20, 20, 5 * k + 5};
                if (!CHECK_NEAR(30, counted(lattice, low, high, 2.5, 10), 2))
                    fprintf(stderr, "%s %s %d\n", cell[i], iso_lattice_name(some[p]), k);
            }
            lattice_free(lattice);
        }
    }
}

/* Cells counted along z are as high as was asked: the same phase comes again after the integral of
 * 1 / size has grown by 1. */
static void test_counted_cells(void) {
    iso_lattice_options options = iso_lattice_defaults();
    options.cell = "ramp(z, 0, 40, 2, 4)";
    iso_lattice *lattice = made(&options, &box);
    /* size = 2 + z / 20; its integral is 20 ln(1 + z / 40) */
    for (int k = 0; k < 13; k++) {
        double z = 40 * (series_exp((k + 0.3) / 20) - 1),
               again = 40 * (series_exp((k + 1.3) / 20) - 1);
        iso_vec3 point[2] = {{0, 0, z}, {0, 0, again}};
        double value[2], size[2] = {2 + z / 20, 2 + again / 20};
        lattice_sample(value, lattice, point, 2);
        CHECK_NEAR(value[0] / size[0], value[1] / size[1], 1e-5);
    }
    lattice_free(lattice);
}

/* Windows of 5 mm in r and z have two cells each way, all around. */
static void test_round_maps(void) {
    static const int32_t pattern[] = {ISO_LATTICE_GYROID_SHEET, ISO_LATTICE_PRIMITIVE_SOLID,
                                      ISO_LATTICE_OCTET_STRUTS, ISO_LATTICE_FOAM_SHEET,
                                      ISO_LATTICE_BONE_SOLID,   ISO_LATTICE_VOXEL_CUBIC};
    for (int32_t map = ISO_LATTICE_MAP_CYLINDER; map <= ISO_LATTICE_MAP_SPHERE; map++) {
        for (int p = 0; p < 6; p++) {
            iso_lattice_options options = iso_lattice_defaults();
            options.pattern = pattern[p];
            options.map = map;
            options.cell = "2.5";
            options.density = "35";
            iso_lattice *lattice = made(&options, &tube);
            CHECK(!lattice_is_uniform(lattice));
            double r[2] = {20, 30}, z[2] = {0, 40};
            CHECK_NEAR(35, counted_around(lattice, r, z, 20), 1);
            bool whole = p < 3 && map == ISO_LATTICE_MAP_CYLINDER;
            for (int k = 0; k < 4 && whole; k++) {
                r[0] = 20 + 1.7 * k, r[1] = r[0] + 5, z[0] = 3 + 7 * k, z[1] = z[0] + 5;
                CHECK_NEAR(35, counted_around(lattice, r, z, 12), 2);
            }
            lattice_free(lattice);
        }
    }
}

/* Turns have a whole number of cells, as many as fit at the volume's mean radius: 25 1/3 mm of the
 * tube make 63.67 of 2.5 mm. */
static void test_cells_around(void) {
    iso_lattice_options options = iso_lattice_defaults();
    options.map = ISO_LATTICE_MAP_CYLINDER;
    options.cell = "2.5";
    iso_lattice *lattice = made(&options, &tube);
    for (int cells = 63; cells <= 65; cells++) {
        double worst = 0;
        for (int k = 0; k < 100; k++) {
            double sine[2], cosine[2], value[2], angle = 6.283185307179586 * (k + 0.3) / 100;
            iso_vec3 point[2];
            for (int i = 0; i < 2; i++) {
                series_sine_cosine(&sine[i], &cosine[i], angle + i * 6.283185307179586 / cells);
                point[i] = (iso_vec3){30 + 27 * cosine[i], 40 + 27 * sine[i], 3.3};
            }
            lattice_sample(value, lattice, point, 2);
            worst = fmax(worst, fabs(value[0] - value[1]));
        }
        CHECK(cells == 64 ? worst < 1e-4 : worst > 0.01);
    }
    lattice_free(lattice);
}

/* Around an axis cells are longer outside and shorter inside, and at a globe's height shorter
 * still: distances are mm for all that, so they change by 1 mm a mm near the surface. */
static void test_lengths_around(void) {
    for (int32_t map = ISO_LATTICE_MAP_CYLINDER; map <= ISO_LATTICE_MAP_SPHERE; map++)
        for (int outer = 0; outer < 2; outer++) {
            iso_lattice_options options = iso_lattice_defaults();
            options.map = map;
            options.cell = "2.5";
            options.pattern = ISO_LATTICE_GYROID_SOLID;
            options.density = "50";
            iso_lattice *lattice = made(&options, &tube);
            double sum = 0, r = outer ? 30 : 18;
            int count = 0;
            for (int k = 0; k < 20000; k++) {
                double sine, cosine, value[7], step = 0.05, square = 0;
                series_sine_cosine(&sine, &cosine, uniform(0, 6.283185307179586));
                iso_vec3 at = {30 + r * cosine, 40 + r * sine, uniform(15, 25)};
                iso_vec3 point[7] = {at, at, at, at, at, at, at};
                point[1].x -= step, point[2].x += step, point[3].y -= step;
                point[4].y += step, point[5].z -= step, point[6].z += step;
                lattice_sample(value, lattice, point, 7);
                if (fabs(value[0]) > 0.1)
                    continue;
                for (int a = 1; a < 7; a += 2) {
                    double slope = (value[a + 1] - value[a]) / (2 * step);
                    square += slope * slope;
                }
                sum += sqrt(square);
                count++;
            }
            CHECK(count > 1000);
            CHECK_NEAR(1, sum / count, 0.03);
            lattice_free(lattice);
        }
}

/* A part's cells begin where x, y and z are 0, in its middle, also where they are counted. */
static void test_origin_of_counted_cells(void) {
    iso_lattice_options options = iso_lattice_defaults();
    options.pattern = ISO_LATTICE_BCC_STRUTS;
    options.cell = "ramp(x, -20, 20, 2, 3)";
    iso_lattice *lattice = made(&options, &box);
    iso_vec3 node = {0, 0, 0};
    double value;
    lattice_sample(&value, lattice, &node, 1); /* as deep in a strut as one can be */
    CHECK_NEAR(-cell_level(lattice_cell(lattice), 0.2) * 2.5, value, 1e-3);
    lattice_free(lattice);
}

/* Walls that stand upright on a line through the axis don't reach it: these boxes come within 10 mm
 * of it, and are 15 or so away on the whole. */
static void test_walls_along_radii(void) {
    const double side[3] = {10, 10, 10}, at[2][3] = {{10, 0, 0}, {-20, -10, 0}};
    iso_mesh part[2];
    CHECK_OK(part_box(&part[0], side, at[0]));
    CHECK_OK(part_box(&part[1], side, at[1]));
    iso_lattice_options options = iso_lattice_defaults();
    options.map = ISO_LATTICE_MAP_CYLINDER;
    options.cell = "2";
    iso_lattice *lattice;
    CHECK_OK(lattice_new(&lattice, &options, part, 2));
    double smallest = lattice_smallest_cell(lattice);
    CHECK(smallest > 1.2 && smallest < 1.3);
    lattice_free(lattice);
    iso_mesh_free(&part[0]);
    iso_mesh_free(&part[1]);
}

/* Nothing is torn where the angle jumps, neither cells that repeat by themselves nor boxes of
 * several. The length that distances are told in goes by the slope, which jumps a little where
 * samples meet; the surface doesn't. */
static void test_seam(void) {
    static const int32_t pattern[] = {ISO_LATTICE_GYROID_SHEET, ISO_LATTICE_BONE_SHEET};
    for (int32_t map = ISO_LATTICE_MAP_CYLINDER; map <= ISO_LATTICE_MAP_SPHERE; map++) {
        for (int p = 0; p < 2; p++) {
            iso_lattice_options options = iso_lattice_defaults();
            options.pattern = pattern[p];
            options.map = map;
            options.cell = "3.1";
            iso_lattice *lattice = made(&options, &tube);
            for (int k = 0; k < 50; k++) {
                double x = 30 - 20 - 0.2 * k, z = 0.7 * k, value[2];
                iso_vec3 point[2] = {{x, 40 - 1e-9, z}, {x, 40 + 1e-9, z}};
                lattice_sample(value, lattice, point, 2);
                CHECK_NEAR(value[0], value[1], 1e-5 + 0.2 * fabs(value[0]));
            }
            lattice_free(lattice);
        }
    }
}

int main(int count, char **argument) {
    if (count != 2)
        return 2;
    const double side[3] = {40, 40, 40}, at[3] = {-20, -20, 0};
    const double wall[4][2] = {{20, 0}, {30, 0}, {30, 40}, {20, 40}};
    CHECK_OK(part_box(&box, side, at));
    CHECK_OK(part_turned(&tube, wall, 4, 256, 30, 40));
    if (strcmp(argument[1], "cells")) {
        RUN(test_density_ramp);
        RUN(test_counted_cells);
        RUN(test_seam);
        RUN(test_cells_around);
        RUN(test_lengths_around);
        RUN(test_origin_of_counted_cells);
        RUN(test_walls_along_radii);
    } else {
        RUN(test_ramps_of_cells);
        RUN(test_round_maps);
    }
    iso_mesh_free(&box);
    iso_mesh_free(&tube);
    return check_verdict();
}

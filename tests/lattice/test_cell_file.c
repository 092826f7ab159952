/* Cells out of files: grids of OpenVDB and stacks of pictures. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "cells.h"
#include "check.h"
#include "solid/volume.h"

static char folder[256];

static const char *in_folder(const char *name) {
    static char path[400];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static int make(iso_lattice_cell *cell, const char *path) {
    iso_lattice_options options = iso_lattice_defaults();
    options.pattern = ISO_LATTICE_VOXEL_FILE;
    options.file = path;
    return CHECK_OK(cell_make(cell, &options));
}

/* ---- Pictures, written here: grey PNG, stored blocks ---- */

static uint32_t crc_of(const uint8_t *bytes, size_t size) {
    uint32_t crc = 0xffffffff;
    for (size_t i = 0; i < size; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc & 1 ? crc >> 1 ^ 0xedb88320 : crc >> 1;
    }
    return ~crc;
}

static void put32(uint8_t *to, uint32_t value) {
    for (int i = 0; i < 4; i++)
        to[i] = (uint8_t)(value >> (24 - 8 * i));
}

static void put_chunk(FILE *file, const char *type, const uint8_t *data, uint32_t size) {
    uint8_t *bytes = malloc(size + 12);
    put32(bytes, size);
    memcpy(bytes + 4, type, 4);
    if (size)
        memcpy(bytes + 8, data, size);
    put32(bytes + 8 + size, crc_of(bytes + 4, size + 4));
    fwrite(bytes, 1, size + 12, file);
    free(bytes);
}

static void write_picture(const char *path, const uint8_t *grey, int width, int height) {
    uint8_t head[13] = {0}, *data = malloc((size_t)(width + 1) * height + 11);
    uint32_t size = (uint32_t)((width + 1) * height), a = 1, b = 0;
    FILE *file = fopen(path, "wb");
    fwrite("\x89PNG\r\n\x1a\n", 1, 8, file);
    put32(head, (uint32_t)width);
    put32(head + 4, (uint32_t)height);
    head[8] = 8;
    put_chunk(file, "IHDR", head, 13);
    data[0] = 0x78, data[1] = 1, data[2] = 1;
    data[3] = (uint8_t)size, data[4] = (uint8_t)(size >> 8);
    data[5] = (uint8_t)~size, data[6] = (uint8_t)(~size >> 8);
    for (int y = 0; y < height; y++) {
        data[7 + y * (width + 1)] = 0;
        memcpy(data + 8 + y * (width + 1), grey + y * width, (size_t)width);
    }
    for (uint32_t i = 0; i < size; i++) {
        a = (a + data[7 + i]) % 65521;
        b = (b + a) % 65521;
    }
    put32(data + 7 + size, b << 16 | a);
    put_chunk(file, "IDAT", data, size + 11);
    put_chunk(file, "IEND", NULL, 0);
    fclose(file);
    free(data);
}

/* A white ball in the middle of a black box, 24 x 24 x 24; one bar of a single voxel along x. */
static void write_ball(double radius) {
    uint8_t grey[24 * 24];
    for (int z = 0; z < 24; z++) {
        char name[40];
        for (int y = 0; y < 24; y++)
            for (int x = 0; x < 24; x++) {
                double dx = x - 11.5, dy = y - 11.5, dz = z - 11.5;
                int white = dx * dx + dy * dy + dz * dz <= radius * radius || (y == 20 && z == 3);
                grey[(23 - y) * 24 + x] = white ? 255 : 0; /* the last row is at y = 0 */
            }
        snprintf(name, sizeof name, "slice%03d.png", z);
        write_picture(in_folder(name), grey, 24, 24);
    }
}

static void remove_ball(void) {
    for (int z = 0; z < 24; z++) {
        char name[40];
        snprintf(name, sizeof name, "slice%03d.png", z);
        remove(in_folder(name));
    }
}

static void test_pictures(void) {
    iso_lattice_cell cell;
    write_ball(8);
    if (!make(&cell, in_folder("slice%03d.png")))
        return;
    remove_ball();
    CHECK_EQUAL(64, cell.size[0]);
    CHECK_EQUAL(1, cell.repeat[0]);
    CHECK(!cell.has_sides);
    /* the ball's middle is that of voxels 11 and 12: samples start at a voxel's lower side */
    CHECK_NEAR(-8.0 / 24, cell_distance(&cell, 0.5, 0.5, 0.5), 0.6 / 24);
    for (int i = 0; i < 40; i++) {
        double angle = 0.157 * i, r = (6 + 0.1 * i) / 24;
        double g = cell_distance(&cell, 0.5 + r * cos(angle), 0.5, 0.5 + r * sin(angle));
        CHECK_NEAR(r - 8.0 / 24, g, 0.6 / 24);
    }
    /* bars of one voxel stay, all along x and across the box's end, and where they belong */
    for (double u = -0.2; u < 1.2; u += 0.03) {
        CHECK(cell_distance(&cell, u, 20.5 / 24, 3.5 / 24) < -0.1 / 24);
        CHECK(cell_distance(&cell, u, 3.5 / 24, 3.5 / 24) > 1.0 / 24);
    }
    double ball = 4.0 / 3 * 3.14159265 * 512 + 24;
    CHECK_NEAR(ball / (24 * 24 * 24), cell_density(&cell, 0), 0.01);
    double level[3] = {cell_level(&cell, 0.05), cell_level(&cell, 0.5), cell_level(&cell, 0.9)};
    double found[3];
    sampled_densities(found, &cell, level, 3, 200000);
    CHECK_NEAR(0.05, found[0], 0.003);
    CHECK_NEAR(0.5, found[1], 0.003);
    CHECK_NEAR(0.9, found[2], 0.003);
    cell_free(&cell);
}

/* ---- Grids ---- */

enum { BLOCK = ISO_VOLUME_BLOCK, VALUES = BLOCK * BLOCK * BLOCK };

/* A ball of 5 mm around (8, 8, 8). */
static iso_status fill_ball(void *payload, float *value, iso_vec3 corner) {
    for (int i = 0; i < VALUES; i++) {
        double x = corner.x + 0.5 * (i % BLOCK) - 8, y = corner.y + 0.5 * (i / BLOCK % BLOCK) - 8;
        double z = corner.z + 0.5 * (i / BLOCK / BLOCK) - 8;
        value[i] = (float)(sqrt(x * x + y * y + z * z) - 5);
    }
    return ISO_OK;
}

/* One period of a gyroid, 16 mm. */
static iso_status fill_gyroid(void *payload, float *value, iso_vec3 corner) {
    for (int i = 0; i < VALUES; i++) {
        double k = 6.28318530717958647692 / 16, x = k * (corner.x + 0.5 * (i % BLOCK));
        double y = k * (corner.y + 0.5 * (i / BLOCK % BLOCK));
        double z = k * (corner.z + 0.5 * (i / BLOCK / BLOCK));
        value[i] = (float)(sin(x) * cos(y) + sin(y) * cos(z) + sin(z) * cos(x));
    }
    return ISO_OK;
}

static int write_grid(iso_volume_info *info, volume_fill *fill, iso_volume_kind kind) {
    iso_volume_plan plan = {.min = {0, 0, 0},
                            .max = {15.5, 15.5, 15.5},
                            .voxel = 0.5,
                            .kind = kind,
                            .name = "grid",
                            .fill = fill};
    iso_volume *volume;
    if (!CHECK_OK(volume_build(&volume, &plan)))
        return 0;
    volume_info(info, volume);
    int written = CHECK_OK(volume_write(volume, in_folder("grid.vdb")));
    volume_free(volume);
    return written;
}

/* Its box is that of the voxels stored, whose values are as they are. */
static void test_distance_grid(void) {
    iso_volume_info info;
    iso_lattice_cell cell;
    if (!write_grid(&info, fill_ball, ISO_VOLUME_DISTANCE) || !make(&cell, in_folder("grid.vdb")))
        return;
    remove(in_folder("grid.vdb"));
    double edge = info.max.x - info.min.x + info.voxel;
    uint64_t seed = 8;
    int near = 0;
    for (int i = 0; i < 3000; i++) {
        double u[3], square = 0;
        const double low[3] = {info.min.x, info.min.y, info.min.z};
        for (int a = 0; a < 3; a++) {
            u[a] = random_number(&seed);
            double way = low[a] - info.voxel / 2 + u[a] * edge - 8;
            square += way * way;
        }
        double d = sqrt(square) - 5;
        if (d > 1.4 || d < -4)
            continue;
        CHECK_NEAR(d / edge, cell_distance(&cell, u[0], u[1], u[2]), 0.02 / edge);
        near++;
    }
    CHECK(near > 1000);
    CHECK_NEAR(4.0 / 3 * 3.14159265 * 125 / (edge * edge * edge), cell_density(&cell, 0), 0.002);
    cell_free(&cell);
}

/* Voxels that are on or off give the surface between them, to about half a voxel. */
static void test_mask(void) {
    iso_volume_info info;
    iso_lattice_cell cell, gyroid;
    iso_lattice_options options = iso_lattice_defaults();
    options.pattern = ISO_LATTICE_GYROID_SOLID;
    if (!write_grid(&info, fill_gyroid, ISO_VOLUME_SOLID) || !make(&cell, in_folder("grid.vdb")) ||
        !CHECK_OK(cell_make(&gyroid, &options)))
        return;
    remove(in_folder("grid.vdb"));
    double worst = 0, sum = 0;
    uint64_t seed = 17;
    for (int i = 0; i < 4000; i++) {
        double u[3];
        for (int a = 0; a < 3; a++)
            u[a] = random_number(&seed);
        /* what was sampled is in the middle of voxels */
        double g = cell_distance(&cell, u[0] + 0.5 / 32, u[1] + 0.5 / 32, u[2] + 0.5 / 32);
        double error = fabs(g - cell_distance(&gyroid, u[0], u[1], u[2]));
        worst = error > worst ? error : worst;
        sum += error;
    }
    printf("    %.5f voxels off, %.5f at worst\n", 32 * sum / 4000, 32 * worst);
    CHECK(worst < 1.0 / 32 && sum / 4000 < 0.25 / 32);
    CHECK_NEAR(0.5, cell_density(&cell, 0), 0.01);
    cell_free(&cell);
    cell_free(&gyroid);
}

/* Made of one picture that has these greys in two halves, or a stripe of the second one. */
static int make_of_greys(iso_lattice_cell *cell, uint8_t left, uint8_t right, int first, int end) {
    uint8_t grey[8 * 8];
    for (int i = 0; i < 8 * 8; i++)
        grey[i] = i % 8 >= first && i % 8 < end ? right : left;
    write_picture(in_folder("greys.png"), grey, 8, 8);
    int made = make(cell, in_folder("greys.png"));
    remove(in_folder("greys.png"));
    return made;
}

/* What is lighter than half grey is solid, by however little. */
static void test_half_grey(void) {
    iso_lattice_cell cell;
    if (!make_of_greys(&cell, 125, 130, 4, 8))
        return;
    CHECK_NEAR(0.5, cell_density(&cell, 0), 0.02);
    CHECK(cell_distance(&cell, 0.25, 0, 0) > 0.1 && cell_distance(&cell, 0.75, 0, 0) < -0.1);
    cell_free(&cell);
}

/* A stripe at the box's end is as near from beyond it, where the next box begins. */
static void test_end_of_the_box(void) {
    iso_lattice_cell cell;
    if (!make_of_greys(&cell, 0, 255, 7, 8))
        return;
    CHECK_NEAR(1.0 / 8, cell_density(&cell, 0), 0.02);
    for (double d = 0; d < 0.5; d += 0.01)
        CHECK_NEAR(cell_distance(&cell, 7.5 / 8 - d, 0, 0), cell_distance(&cell, 7.5 / 8 + d, 0, 0),
                   1e-3);
    cell_free(&cell);
}

static void test_missing(void) {
    iso_lattice_cell cell;
    iso_lattice_options options = iso_lattice_defaults();
    options.pattern = ISO_LATTICE_VOXEL_FILE;
    CHECK_STATUS(ISO_BAD_CONFIG, cell_make(&cell, &options));
    options.file = NULL;
    CHECK_STATUS(ISO_BAD_CONFIG, cell_make(&cell, &options));
    options.file = in_folder("none.vdb");
    CHECK_STATUS(ISO_UNREADABLE, cell_make(&cell, &options));
    options.file = in_folder("none%03d.png");
    CHECK_STATUS(ISO_UNREADABLE, cell_make(&cell, &options));
    uint8_t black[64] = {0};
    write_picture(in_folder("slice000.png"), black, 8, 8);
    options.file = in_folder("slice%03d.png");
    CHECK_STATUS(ISO_BAD_CONFIG, cell_make(&cell, &options)); /* all void */
    CHECK(cell.distance == NULL);
    remove(in_folder("slice000.png"));
}

int main(void) {
    snprintf(folder, sizeof folder, "/tmp/isoslice-cells-XXXXXX");
    if (!CHECK(mkdtemp(folder) != NULL))
        return 1;
    RUN(test_pictures);
    RUN(test_distance_grid);
    RUN(test_mask);
    RUN(test_half_grey);
    RUN(test_end_of_the_box);
    RUN(test_missing);
    rmdir(folder);
    return check_verdict();
}

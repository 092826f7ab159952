/* Lattices in parts: what is sampled is what was asked. */
#include "check.h"

#include <stdlib.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "lattice/lattice.h"
#include "part.h"

static iso_mesh box;

static iso_lattice *made(const iso_lattice_options *options) {
    iso_lattice *lattice = NULL;
    CHECK_OK(lattice_new(&lattice, options, &box, 1));
    return lattice;
}

static void test_frame(void) {
    iso_lattice_options options = iso_lattice_defaults();
    iso_lattice *lattice = made(&options);
    CHECK(lattice_is_uniform(lattice));
    CHECK(lattice_smallest_cell(lattice) == 5);
    /* the box is 40 by 30 by 20 from (100, 50, 7): its middle and floor are the cell's corner */
    const iso_lattice_cell *cell = lattice_cell(lattice);
    double half = cell_level(cell, 0.2) * 5;
    for (int i = 0; i < 500; i++) {
        iso_vec3 p = {100 + 0.087 * i, 50 + 0.0731 * i, 7 + 0.0411 * i};
        double value, u = (p.x - 120) / 5, v = (p.y - 65) / 5, w = (p.z - 7) / 5;
        lattice_sample(&value, lattice, &p, 1);
        CHECK_NEAR(fabs(cell_distance(cell, u, v, w)) * 5 - half, value, 1e-5);
    }
    lattice_free(lattice);
}

/* Pieces of a row agree to the bit with the row, and with points. */
static void test_rows(void) {
    static double whole[3000], half[3000], piece[3000];
    const char *const cells[] = {"5", "0.7", "23"};
    for (int k = 0; k < 3; k++) {
        for (int32_t pattern = ISO_LATTICE_GYROID_SHEET; pattern <= ISO_LATTICE_DIAMOND_SOLID;
             pattern++) {
            iso_lattice_options options = iso_lattice_defaults();
            options.pattern = pattern;
            options.cell = cells[k];
            iso_lattice *lattice = made(&options);
            iso_lattice_plane plane = {{93.1, 41.7}, k == 1 ? 0.4 : 0.031, 11.3, 3000, 700};
            const int32_t row = 311;
            lattice_sample_row(whole, half, lattice, &plane, row, 0, 3000);
            for (int32_t first = 0, n; first < 3000; first += n) {
                n = 1 + (first * 7 + k) % 211;
                n = n < 3000 - first ? n : 3000 - first;
                lattice_sample_row(piece + first, half, lattice, &plane, row, first, n);
            }
            CHECK(!memcmp(whole, piece, sizeof whole));
            double worst = 0, value;
            for (int32_t i = 0; i < 3000; i++) {
                iso_vec3 p = {93.1 + plane.step * i, 41.7 + plane.step * row, plane.z};
                lattice_sample(&value, lattice, &p, 1);
                double of_row = lattice_cell(lattice)->has_sides ? fabs(whole[i]) : whole[i];
                worst = fmax(worst, fabs(of_row - half[i] - value));
            }
            CHECK_NEAR(0, worst, 1e-5);
            lattice_free(lattice);
        }
    }
}

/* Void and solid by density, and where there is none. */
static void test_void_and_solid(void) {
    iso_lattice_options options = iso_lattice_defaults();
    options.density = "x < -10 ? 0 : x < 0 ? -5 : x < 10 ? 100 : log(-1)";
    iso_lattice *lattice = made(&options);
    iso_lattice_plane plane = {{100, 50}, 1, 17, 41, 31};
    double distance[41], half[41];
    lattice_sample_row(distance, half, lattice, &plane, 9, 0, 41);
    for (int i = 0; i < 40; i++) {
        CHECK(half[i] == (i >= 20 && i < 30 ? HUGE_VAL : -HUGE_VAL));
        CHECK(fabs(distance[i]) < 5);
    }
    lattice_free(lattice);
}

static void test_mistakes(void) {
    static const struct {
        const char *cell, *density, *message;
    } mistake[] = {
        {"", "20", "lattice_cell, column 1: expected a number, a name or '(', not the end"},
        {"5", "20 +", "lattice_density, column 5: expected a number, a name or '(', not the end"},
        {"5", "20 * foo",
         "lattice_density, column 6: there is no variable 'foo'; there are pi, x, y, "
         "z, skin, r, grid"},
        {"0", "20", "lattice_cell is 0 mm; it must be 0.2 to 100000 mm"},
        {"-1", "20", "lattice_cell is -1 mm; it must be 0.2 to 100000 mm"},
        {"0.1", "20", "lattice_cell is 0.1 mm; it must be 0.2 to 100000 mm"},
        {"1 / 0", "20", "lattice_cell is no number: 1 / 0"},
        {"5", "0 / 0", "lattice_density is no number: 0 / 0"},
        {"5", "grid", "an expression has grid in it, but lattice_grid names no .vdb file"},
        {"x", "20",
         "lattice_cell is -20 mm at x = -20, y = -15, z = 0; it must be 0.2 to 100000 mm"},
        {"sqrt(x)", "20", "lattice_cell is "},
        {"0.3 + 0.1 * hypot(x, z)", "20", "lattice_cell grows too fast at x = -20, y = -15, z = "},
        {"z > 3.001 ? z < 3.1 ? 0 : 2 : 2", "20", "lattice_cell is 0 mm at z = 3.0"},
    };
    for (int i = 0; i < (int)(sizeof mistake / sizeof *mistake); i++) {
        iso_lattice_options options = iso_lattice_defaults();
        iso_lattice *lattice = NULL;
        options.cell = mistake[i].cell;
        options.density = mistake[i].density;
        CHECK_STATUS(ISO_BAD_CONFIG, lattice_new(&lattice, &options, &box, 1));
        CHECK(lattice == NULL);
        if (!CHECK(!strncmp(mistake[i].message, iso_error_message(), strlen(mistake[i].message))))
            fprintf(stderr, "%s\n", iso_error_message());
    }
    iso_lattice_options options = iso_lattice_defaults();
    iso_lattice *lattice = NULL;
    options.map = ISO_LATTICE_MAP_COUNT;
    CHECK_STATUS(ISO_BAD_CONFIG, lattice_new(&lattice, &options, &box, 1));
    options = iso_lattice_defaults();
    CHECK_STATUS(ISO_UNSLICEABLE, lattice_new(&lattice, &options, &box, 0));
    options.cell = "z <= 10 ? 2 : x < 0 ? 3 : 4"; /* steps are no growth */
    CHECK_OK(lattice_new(&lattice, &options, &box, 1));
    lattice_free(lattice);
}

static void test_no_memory(void) {
    iso_lattice_options options = iso_lattice_defaults();
    options.cell = "ramp(z, 0, 20, 4, 5)";
    options.map = ISO_LATTICE_MAP_CYLINDER;
    iso_lattice *lattice = NULL;
    iso_status status = ISO_NO_MEMORY;
    for (int i = 0; i < 200 && status == ISO_NO_MEMORY; i++) {
        iso_fail_allocation_after(i);
        status = lattice_new(&lattice, &options, &box, 1);
        iso_fail_allocation_after(-1);
        CHECK((lattice != NULL) == (status == ISO_OK));
    }
    CHECK_OK(status);
    lattice_free(lattice);
}

enum { ROWS = 64, COLUMNS = 200 };

typedef struct rows_of_plane {
    const iso_lattice *lattice;
    double distance[ROWS][COLUMNS], half[ROWS][COLUMNS];
} rows_of_plane;

static iso_status sample_task(void *payload, int64_t index, int worker) {
    rows_of_plane *rows = payload;
    const iso_lattice_plane plane = {{100, 50}, 0.2, 12.34, COLUMNS, ROWS};
    (void)worker;
    lattice_sample_row(rows->distance[index], rows->half[index], rows->lattice, &plane,
                       (int32_t)index, 0, COLUMNS);
    return ISO_OK;
}

/* The same from any number of threads, and from a lattice made anew. */
static void test_threads(void) {
    static rows_of_plane first, again;
    iso_lattice_options options = iso_lattice_defaults();
    options.cell = "ramp(r, 0, 20, 3, 5)";
    options.density = "30 + 20 * sin(x / 3) * cos(y / 4)";
    options.map = ISO_LATTICE_MAP_CYLINDER;
    for (int threads = 1; threads <= 8; threads *= 2) {
        rows_of_plane *rows = threads == 1 ? &first : &again;
        iso_lattice *lattice = made(&options);
        iso_pool *pool = NULL;
        rows->lattice = lattice;
        CHECK_OK(iso_pool_new(&pool, threads));
        CHECK_OK(iso_parallel_for(pool, ROWS, sample_task, rows));
        CHECK(!memcmp(first.distance, rows->distance, sizeof first.distance));
        CHECK(!memcmp(first.half, rows->half, sizeof first.half));
        iso_pool_free(pool);
        lattice_free(lattice);
    }
}

/* What is cut is void, in rows and at points, and nothing else is. Runs may touch. */
static void test_cut(void) {
    static const iso_lattice_run run[] = {
        {3, 2, 1, 3}, {3, 2, 3, 4}, {3, 2, 7, 8}, {3, 5, 0, 2}, {4, 2, 0, 99}};
    const iso_lattice_cut cut = {{-20, -15, 0.5}, 1, 5, run};
    iso_lattice_options options = iso_lattice_defaults();
    options.density = "100";
    options.cut = &cut;
    iso_lattice *lattice = made(&options);
    CHECK(!lattice_is_uniform(lattice));
    /* z = 3.6 and y = -13.2 in the frame: voxel 3 and 2 */
    const iso_lattice_plane plane = {{99, 51.8}, 0.25, 10.6, 60, 20};
    double distance[60], half[60], value;
    for (int row = 0; row < 20; row++) {
        lattice_sample_row(distance, half, lattice, &plane, row, 0, 60);
        int y = (int)floor((plane.origin.y + 0.25 * row - 65 + 15) + 0.5);
        for (int i = 0; i < 60; i++) {
            int x = (int)floor(plane.origin.x + 0.25 * i - 120 + 20 + 0.5);
            int is_cut = (y == 2 && ((x >= 1 && x < 4) || x == 7)) || (y == 5 && x >= 0 && x < 2);
            CHECK(half[i] == (is_cut ? -1 : HUGE_VAL));
            iso_vec3 point = {99 + 0.25 * i, 51.8 + 0.25 * row, 10.6};
            lattice_sample(&value, lattice, &point, 1);
            CHECK(value == (is_cut ? 1 : -HUGE_VAL));
        }
    }
    lattice_free(lattice);
}

/* Nodes on the edge of what is cut fall to one side, whichever piece of the row they are in. */
static void test_pieces_of_cut_rows(void) {
    static const iso_lattice_run run[] = {{0, 0, 10, 20}, {0, 0, 31, 77}, {0, 0, 150, 301}};
    const iso_lattice_cut cut = {{-19.95, 0, 0}, 0.1, 3, run};
    static double distance[401], half[401], piece[2];
    for (int graded = 0; graded < 2; graded++) {
        iso_lattice_options options = iso_lattice_defaults();
        options.density = graded ? "x + 50" : "50";
        options.cut = &cut;
        iso_lattice *lattice = made(&options);
        const iso_lattice_plane plane = {{100, 65}, 0.1, 7, 401, 1};
        lattice_sample_row(distance, half, lattice, &plane, 0, 0, 401);
        for (int first = 0; first < 401; first++) {
            lattice_sample_row(piece, piece + 1, lattice, &plane, 0, first, 1);
            CHECK(distance[first] == piece[0] && half[first] == piece[1]);
        }
        lattice_free(lattice);
    }
}

int main(void) {
    const double side[3] = {40, 30, 20}, at[3] = {100, 50, 7};
    CHECK_OK(part_box(&box, side, at));
    RUN(test_frame);
    RUN(test_rows);
    RUN(test_void_and_solid);
    RUN(test_mistakes);
    RUN(test_no_memory);
    RUN(test_threads);
    RUN(test_cut);
    RUN(test_pieces_of_cut_rows);
    iso_mesh_free(&box);
    return check_verdict();
}

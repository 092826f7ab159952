/* Lattices in parts: what is sampled is what was asked. */
#include "check.h"

#include <time.h>

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

int main(void) {
    const double side[3] = {40, 30, 20}, at[3] = {100, 50, 7};
    CHECK_OK(part_box(&box, side, at));
    RUN(test_frame);
    RUN(test_rows);
    iso_mesh_free(&box);
    return check_verdict();
}

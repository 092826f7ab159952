/* What holds for the cell of every pattern. */
#include <math.h>

#include "cells.h"
#include "check.h"

static iso_lattice_options pattern_options(int32_t pattern) {
    iso_lattice_options options = iso_lattice_defaults();
    options.pattern = pattern;
    options.seed = 7;
    return options;
}

static void test_names(void) {
    CHECK(strcmp(iso_lattice_name(ISO_LATTICE_GYROID_SHEET), "gyroid_sheet") == 0);
    CHECK(strcmp(iso_lattice_name(ISO_LATTICE_VOXEL_FILE), "voxel_file") == 0);
    CHECK(iso_lattice_name(-1) == NULL && iso_lattice_name(ISO_LATTICE_COUNT) == NULL);
    for (int32_t p = 0; p < ISO_LATTICE_COUNT; p++)
        for (int32_t q = 0; q < p; q++)
            CHECK(strcmp(iso_lattice_name(p), iso_lattice_name(q)) != 0);
    iso_lattice_options options = iso_lattice_defaults();
    CHECK_EQUAL(ISO_LATTICE_GYROID_SHEET, options.pattern);
    CHECK(strcmp(options.cell, "5") == 0 && strcmp(options.density, "20") == 0);
}

static void test_refused(void) {
    iso_lattice_cell cell;
    iso_lattice_options options = pattern_options(ISO_LATTICE_COUNT);
    CHECK_STATUS(ISO_USAGE, cell_make(&cell, &options));
    CHECK(cell.distance == NULL);
    options.pattern = -1;
    CHECK_STATUS(ISO_USAGE, cell_make(&cell, &options));
    options.pattern = ISO_LATTICE_VOXEL_RANDOM;
    const double pores[] = {0, 0.049, 1.001, -1, NAN, INFINITY};
    for (size_t i = 0; i < sizeof pores / sizeof *pores; i++) {
        options.pore = pores[i];
        CHECK_STATUS(ISO_BAD_CONFIG, cell_make(&cell, &options));
        CHECK(cell.distance == NULL);
    }
}

/* A density asked for is what random points in the cell find. */
static void check_densities(const iso_lattice_cell *cell, const char *name) {
    static const double asked[5] = {0.05, 0.2, 0.5, 0.8, 0.95};
    double level[5], found[5];
    for (int i = 0; i < 5; i++) {
        level[i] = cell_level(cell, asked[i]);
        CHECK_NEAR(asked[i], cell_density(cell, level[i]), 1e-6);
    }
    sampled_densities(found, cell, level, 5, 300000);
    for (int i = 0; i < 5; i++)
        if (!CHECK_NEAR(asked[i], found[i], 0.003))
            fprintf(stderr, "    %s\n", name);
}

static void check_levels(const iso_lattice_cell *cell) {
    int64_t count = (int64_t)cell->size[0] * cell->size[1] * cell->size[2], beyond = 0;
    for (int32_t k = 0; k < ISO_CELL_LEVELS; k++)
        CHECK(cell->level[k] <= cell->level[k + 1]);
    for (int64_t i = 0; i < count; i++) {
        float g = cell->has_sides ? fabsf(cell->distance[i]) : cell->distance[i];
        if (!(g > cell->level[0] && g < cell->level[ISO_CELL_LEVELS]))
            beyond++;
    }
    CHECK(cell_level(cell, 0) == cell->level[0] && cell_level(cell, -1) == cell->level[0]);
    CHECK(cell_level(cell, 1) == cell->level[ISO_CELL_LEVELS]);
    CHECK(cell_level(cell, NAN) == cell->level[0]);
    CHECK(cell_density(cell, -10) == 0 && cell_density(cell, 10) == 1);
    CHECK_EQUAL(0, beyond);
    for (double d = 0.001; d < 1; d += 0.0137)
        CHECK_NEAR(d, cell_density(cell, cell_level(cell, d)), 1e-4);
}

/* No two points differ by more than `steepest` says, and some differ by nearly that. */
static void check_steepest(const iso_lattice_cell *cell) {
    uint64_t seed = 3;
    double most = 0;
    for (int i = 0; i < 50000; i++) {
        double at[3], to[3], square = 0;
        for (int a = 0; a < 3; a++) {
            at[a] = cell->repeat[a] * random_number(&seed);
            to[a] = at[a] + 0.002 * (random_number(&seed) - 0.5);
            square += (to[a] - at[a]) * (to[a] - at[a]);
        }
        double rise =
            cell_distance(cell, to[0], to[1], to[2]) - cell_distance(cell, at[0], at[1], at[2]);
        double slope = fabs(rise) / sqrt(square);
        most = slope > most ? slope : most;
    }
    CHECK(most <= cell->steepest);
    CHECK(most > 0.5 * cell->steepest);
}

/* Samples are hit exactly, the box repeats, and places in samples are those in cells. */
static void check_samples(const iso_lattice_cell *cell) {
    uint64_t seed = 5;
    const int32_t *n = cell->size, *r = cell->repeat;
    for (int i = 0; i < 300; i++) {
        int32_t at[3];
        double u[3], step[3];
        for (int a = 0; a < 3; a++) {
            at[a] = (int32_t)(random_number(&seed) * n[a]);
            step[a] = (double)r[a] / n[a];
            u[a] = at[a] * step[a];
        }
        double g = cell->distance[at[0] + (int64_t)n[0] * (at[1] + (int64_t)n[1] * at[2])];
        CHECK_NEAR(g, cell_distance(cell, u[0], u[1], u[2]), 1e-7);
        for (int a = 0; a < 3; a++)
            u[a] = r[a] * random_number(&seed);
        g = cell_distance(cell, u[0], u[1], u[2]);
        CHECK_NEAR(g, cell_distance(cell, u[0] - 3 * r[0], u[1] + r[1], u[2] + 1000 * r[2]), 1e-6);
        CHECK_NEAR(g, cell_at(cell, u[0] / step[0] - n[0], u[1] / step[1], u[2] / step[2]), 1e-6);
    }
    CHECK(isfinite(cell_distance(cell, 1e300, -1e300, 1e17)));
}

/* Walking across the box's end no step is larger than elsewhere. */
static void check_wrap(const iso_lattice_cell *cell) {
    uint64_t seed = 11;
    for (int axis = 0; axis < 3; axis++)
        for (int i = 0; i < 500; i++) {
            double u[3], last = 0, step = 0.25 * cell->repeat[axis] / cell->size[axis];
            for (int a = 0; a < 3; a++)
                u[a] = cell->repeat[a] * random_number(&seed);
            for (int s = -6; s <= 6; s++) {
                u[axis] = cell->repeat[axis] + s * step;
                double g = cell_distance(cell, u[0], u[1], u[2]);
                if (s > -6)
                    CHECK(fabs(g - last) <= cell->steepest * step + 1e-6);
                last = g;
            }
        }
}

static void check_link(const iso_lattice_cell *cell) {
    iso_cubic_link link;
    if (!CHECK_OK(cell_link(&link, cell)))
        return;
    CHECK_OK(iso_multilink_validate(&link.link));
    CHECK_EQUAL(ISO_KIND_CUBIC_LINK, link.link.kind);
    CHECK_EQUAL((int64_t)cell->size[0] * cell->size[1] * cell->size[2], link.link.size);
    for (int axis = 0; axis < 3; axis++) { /* a step along each axis, size times, comes back */
        int32_t a = 1234;
        for (int32_t i = 0; i < cell->size[axis]; i++)
            a = iso_map_at(&link.link.map[axis], a);
        CHECK_EQUAL(1234, a);
    }
    CHECK(link.link.g[77] == cell->distance[77]);
    iso_multilink_free(&link.link);
}

static void test_every_pattern(void) {
    for (int32_t p = 0; p < ISO_LATTICE_VOXEL_FILE; p++) {
        iso_lattice_options options = pattern_options(p);
        iso_lattice_cell cell;
        if (!CHECK_OK(cell_make(&cell, &options)))
            continue;
        for (int a = 0; a < 3; a++)
            CHECK(cell.size[a] > 0 && (cell.size[a] & (cell.size[a] - 1)) == 0);
        check_densities(&cell, iso_lattice_name(p));
        check_levels(&cell);
        check_steepest(&cell);
        check_samples(&cell);
        check_wrap(&cell);
        if (cell.size[0] <= 64)
            check_link(&cell);
        cell_free(&cell);
        CHECK(cell.distance == NULL);
    }
}

int main(void) {
    RUN(test_names);
    RUN(test_refused);
    RUN(test_every_pattern);
    return check_verdict();
}

/* What is random: foams, bone, voxels. */
#include <math.h>

#include "cells.h"
#include "check.h"
#include "lattice/voronoi.h"

static int make(iso_lattice_cell *cell, int32_t pattern, uint64_t seed, double pore) {
    iso_lattice_options options = iso_lattice_defaults();
    options.pattern = pattern;
    options.seed = seed;
    options.pore = pore;
    return CHECK_OK(cell_make(cell, &options));
}

/* ---- Foam ---- */

enum { NEAREST = 40 };

/* Squares of the ways from p to the sites, the nearest images, ascending; and where these are. */
static void nearest_sites(double *square, double (*at)[3], const iso_voronoi *v, const double *p,
                          double size) {
    for (int k = 0; k < NEAREST; k++)
        square[k] = HUGE_VAL;
    for (int32_t s = 0; s < v->count; s++)
        for (int image = 0; image < 27; image++) {
            const int step[3] = {image % 3 - 1, image / 3 % 3 - 1, image / 9 - 1};
            double q[3], d = 0;
            for (int a = 0; a < 3; a++) {
                q[a] = v->site[s][a] + size * step[a];
                d += (q[a] - p[a]) * (q[a] - p[a]);
            }
            if (d >= square[NEAREST - 1])
                continue;
            int k = NEAREST - 1;
            for (; k > 0 && square[k - 1] > d; k--) {
                square[k] = square[k - 1];
                memcpy(at[k], at[k - 1], sizeof at[k]);
            }
            square[k] = d;
            memcpy(at[k], q, sizeof q);
        }
}

/* Every corner has four edges and every edge three faces, so that in space without a boundary
 * (corners - edges + faces - cells = 0) faces are half the edges and the cells. */
static void test_partition(void) {
    for (uint64_t seed = 0; seed < 5; seed++) {
        iso_voronoi v;
        double square[NEAREST], at[NEAREST][3];
        if (!CHECK_OK(voronoi_make(&v, 4, 128, 0.8, seed)))
            return;
        CHECK_EQUAL(64, v.count);
        CHECK_EQUAL(0, v.first[v.count] % 2);
        CHECK_NEAR(v.edge_count / 2.0 + v.count, v.first[v.count] / 2.0,
                   2); /* tiny edges left out */
        for (int32_t e = 0; e < v.edge_count; e++)
            for (double t = 0.1; t < 1; t += 0.4) {
                double p[3];
                for (int a = 0; a < 3; a++)
                    p[a] = v.edge[e].from[a] + t * v.edge[e].way[a];
                nearest_sites(square, at, &v, p, 128);
                CHECK_NEAR(sqrt(square[0]), sqrt(square[2]), 1e-4);
            }
        voronoi_free(&v);
    }
}

/* On every sample: half the difference of squares by the way between two sites is the way to
 * their bisector; the least of these for the nearest site is the way to the foam's walls. */
static void test_foam_sheet(void) {
    iso_lattice_cell cell;
    iso_voronoi v;
    uint64_t seed = 31;
    if (!make(&cell, ISO_LATTICE_FOAM_SHEET, 3, 0.4) ||
        !CHECK_OK(voronoi_make(&v, cell.repeat[0], cell.size[0], 0.8, 3)))
        return;
    for (int i = 0; i < 300; i++) {
        double p[3], square[NEAREST], at[NEAREST][3], best = HUGE_VAL;
        int32_t n = cell.size[0], place[3];
        for (int a = 0; a < 3; a++)
            p[a] = place[a] = (int32_t)(random_number(&seed) * n);
        nearest_sites(square, at, &v, p, n);
        for (int k = 1; k < NEAREST; k++) {
            double way = 0;
            for (int a = 0; a < 3; a++)
                way += (at[k][a] - at[0][a]) * (at[k][a] - at[0][a]);
            double d = 0.5 * (square[k] - square[0]) / sqrt(way);
            best = d < best ? d : best;
        }
        double g = cell.distance[place[0] + n * (place[1] + (int64_t)n * place[2])];
        CHECK_NEAR(best * cell.repeat[0] / n, g, 1e-5);
    }
    CHECK(!cell.has_sides);
    cell_free(&cell);
    voronoi_free(&v);
}

static void test_foam_struts(void) {
    iso_lattice_cell cell;
    iso_voronoi v;
    uint64_t seed = 32;
    if (!make(&cell, ISO_LATTICE_FOAM_STRUTS, 3, 0.4) ||
        !CHECK_OK(voronoi_make(&v, cell.repeat[0], cell.size[0], 0.8, 3)))
        return;
    for (int i = 0; i < 300; i++) {
        int32_t n = cell.size[0], place[3];
        double p[3], best = HUGE_VAL;
        for (int a = 0; a < 3; a++)
            p[a] = place[a] = (int32_t)(random_number(&seed) * n);
        for (int32_t e = 0; e < v.edge_count; e++)
            for (int image = 0; image < 27; image++) {
                const int step[3] = {image % 3 - 1, image / 3 % 3 - 1, image / 9 - 1};
                double along = 0, square = 0, rest = 0, q[3];
                for (int a = 0; a < 3; a++) {
                    q[a] = p[a] - v.edge[e].from[a] + n * step[a];
                    along += q[a] * v.edge[e].way[a];
                    square += (double)v.edge[e].way[a] * v.edge[e].way[a];
                }
                double t = along / square;
                t = t < 0 ? 0 : t > 1 ? 1 : t;
                for (int a = 0; a < 3; a++)
                    rest += (q[a] - t * v.edge[e].way[a]) * (q[a] - t * v.edge[e].way[a]);
                best = rest < best ? rest : best;
            }
        double g = cell.distance[place[0] + n * (place[1] + (int64_t)n * place[2])];
        CHECK_NEAR(sqrt(best) * cell.repeat[0] / n, g, 1e-5);
    }
    cell_free(&cell);
    voronoi_free(&v);
}

/* ---- Bone ---- */

/* A Gaussian field of waves one cell long has a surface of 4 / sqrt(3) cells^2 a cell at its
 * middle level (Rice 1944, in space), half the volume on each side, and the same along all axes. */
static void test_bone(void) {
    for (uint64_t seed = 1; seed <= 2; seed++) {
        iso_lattice_cell cell;
        surface_figures f;
        if (!make(&cell, ISO_LATTICE_BONE_SOLID, seed, 0.4))
            return;
        measure_surface(&f, &cell, 0);
        double cells = pow(cell.repeat[0], 3);
        printf("    surface %.4f, solid %.4f at 0\n", f.area / cells, f.volume / cells);
        CHECK_NEAR(4 / sqrt(3), f.area / cells, 0.05 * 4 / sqrt(3));
        CHECK_NEAR(0.5, f.volume / cells, 0.03);
        CHECK_NEAR(f.volume / cells, cell_density(&cell, 0), 0.001);
        double half = 0.02, walls = cell_density(&cell, half) - cell_density(&cell, -half);
        CHECK_NEAR(2 * half * f.area / cells, walls, 0.02 * walls);
        cell_free(&cell);
    }
}

/* ---- Voxels ---- */

/* How often the sign changes along each axis, per cell. */
static void count_changes(double *changes, const iso_lattice_cell *cell) {
    int32_t n = cell->size[0];
    for (int a = 0; a < 3; a++)
        changes[a] = 0;
    for (int32_t k = 0; k < n; k++)
        for (int32_t j = 0; j < n; j++)
            for (int32_t i = 0; i < n; i++) {
                const int32_t to[3][3] = {{i + 1, j, k}, {i, j + 1, k}, {i, j, k + 1}};
                int side = cell->distance[i + n * (j + (int64_t)n * k)] < 0;
                for (int a = 0; a < 3; a++)
                    changes[a] +=
                        side !=
                        (cell->distance[to[a][0] % n +
                                        n * (to[a][1] % n + (int64_t)n * (to[a][2] % n))] < 0);
            }
    for (int a = 0; a < 3; a++)
        changes[a] /= (double)n * n * cell->repeat[0];
}

/* Pores and walls are as wide as asked where half is solid, along every axis. */
static void test_pores(void) {
    static const double pores[] = {0.2, 1};
    for (size_t i = 0; i < sizeof pores / sizeof *pores; i++) {
        iso_lattice_cell cell;
        double changes[3];
        if (!make(&cell, ISO_LATTICE_VOXEL_RANDOM, 5, pores[i]))
            return;
        count_changes(changes, &cell);
        printf("    pores of %g: %.4f %.4f %.4f, box of %d cells\n", pores[i], 1 / changes[0],
               1 / changes[1], 1 / changes[2], cell.repeat[0]);
        for (int a = 0; a < 3; a++)
            CHECK_NEAR(pores[i], 1 / changes[a], 0.08 * pores[i]);
        CHECK_NEAR(0.5, cell_density(&cell, 0), 0.05);
        cell_free(&cell);
    }
}

int main(void) {
    RUN(test_partition);
    RUN(test_foam_sheet);
    RUN(test_foam_struts);
    RUN(test_bone);
    RUN(test_pores);
    return check_verdict();
}

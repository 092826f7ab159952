/* Struts: distances against all bars around, lengths by the volume of thin ones. Bars of square
 * section by their formula. */
#include <math.h>

#include "cells.h"
#include "check.h"

#define PI 3.14159265358979323846

typedef struct bars {
    double from[8000][3], to[8000][3];
    int count;
} bars;

static bars all;

static void add(const double *from, const double *way) {
    double *p = all.from[all.count], *q = all.to[all.count++];
    for (int a = 0; a < 3; a++) {
        p[a] = from[a];
        q[a] = from[a] + way[a];
    }
}

/* From a node to all neighbours that lie (x, y, z) away, signs and order free; `even`: only those
 * with an even number of minus signs. */
static void add_star(const double *from, const double *way, int even) {
    static const int order[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1},
                                    {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    for (int o = 0; o < 6; o++)
        for (int sign = 0; sign < 8; sign++) {
            int minus = (sign & 1) + (sign >> 1 & 1) + (sign >> 2), again = 0;
            double to[3];
            for (int a = 0; a < 3; a++) {
                double w = way[order[o][a]];
                again |= w == 0 && (sign >> a & 1);
                to[a] = sign >> a & 1 ? -w : w;
            }
            if (!again && !(even && minus % 2))
                add(from, to);
        }
}

/* A truncated octahedron: corners are (0, 1/4, 1/2), signs and order free; edges join those that
 * are sqrt(2) / 4 apart. */
static void add_octahedron(const double *middle) {
    static const double unit[3] = {0, 0.25, 0.5};
    int first = all.count;
    add_star(middle, unit, 0);
    int last = all.count;
    for (int i = first; i < last; i++)
        for (int j = first; j < i; j++) {
            double way[3], square = 0;
            for (int a = 0; a < 3; a++) {
                way[a] = all.to[j][a] - all.to[i][a];
                square += way[a] * way[a];
            }
            if (fabs(square - 0.125) < 1e-9)
                add(all.to[i], way);
        }
    for (int i = first; i < last; i++) /* the spokes were but a means */
        for (int a = 0; a < 3; a++)
            all.from[i][a] = all.to[i][a] = 1e9;
}

static void make_bars(int32_t pattern) {
    static const double diagonal[3] = {0.5, 0.5, 0.5}, face[3] = {0, 0.5, 0.5},
                        bond[3] = {0.25, 0.25, 0.25};
    all.count = 0;
    for (int i = 0; i < 27; i++) {
        double node[3] = {i % 3 - 1.0, i / 3 % 3 - 1.0, i / 9 - 1.0};
        double middle[3] = {node[0] + 0.5, node[1] + 0.5, node[2] + 0.5};
        if (pattern == ISO_LATTICE_KELVIN_STRUTS) {
            add_octahedron(node);
            add_octahedron(middle);
            continue;
        }
        if (pattern == ISO_LATTICE_BCC_STRUTS)
            add_star(node, diagonal, 0), add_star(middle, diagonal, 0);
        if (pattern == ISO_LATTICE_FCC_STRUTS)
            add_star(node, face, 0);
        for (int f = 0; f < 4; f++) { /* face-centred nodes */
            double at[3] = {node[0] + (f == 1 || f == 2 ? 0.5 : 0),
                            node[1] + (f == 2 || f == 3 ? 0.5 : 0),
                            node[2] + (f == 1 || f == 3 ? 0.5 : 0)};
            if (pattern == ISO_LATTICE_OCTET_STRUTS)
                add_star(at, face, 0);
            if (pattern == ISO_LATTICE_DIAMOND_STRUTS)
                add_star(at, bond, 1);
        }
    }
}

static double nearest_bar(const double *p) {
    double best = HUGE_VAL;
    for (int i = 0; i < all.count; i++) {
        double along = 0, square = 0, rest = 0, t;
        for (int a = 0; a < 3; a++) {
            double way = all.to[i][a] - all.from[i][a];
            along += (p[a] - all.from[i][a]) * way;
            square += way * way;
        }
        t = square > 0 ? along / square : 0;
        t = t < 0 ? 0 : t > 1 ? 1 : t;
        for (int a = 0; a < 3; a++) {
            double way = p[a] - all.from[i][a] - t * (all.to[i][a] - all.from[i][a]);
            rest += way * way;
        }
        best = rest < best ? rest : best;
    }
    return sqrt(best);
}

static int make(iso_lattice_cell *cell, int32_t pattern) {
    iso_lattice_options options = iso_lattice_defaults();
    options.pattern = pattern;
    return CHECK_OK(cell_make(cell, &options));
}

static void test_distances(void) {
    for (int32_t p = ISO_LATTICE_BCC_STRUTS; p <= ISO_LATTICE_DIAMOND_STRUTS; p++) {
        iso_lattice_cell cell;
        uint64_t seed = 12;
        if (!make(&cell, p))
            return;
        make_bars(p);
        for (int i = 0; i < 500; i++) {
            int32_t at[3];
            double u[3];
            for (int a = 0; a < 3; a++) {
                at[a] = (int32_t)(random_number(&seed) * cell.size[a]);
                u[a] = (double)at[a] / cell.size[a];
            }
            double g = cell.distance[at[0] + cell.size[0] * (at[1] + cell.size[1] * at[2])];
            if (!CHECK_NEAR(nearest_bar(u), g, 1e-5))
                fprintf(stderr, "    %s at %g %g %g\n", iso_lattice_name(p), u[0], u[1], u[2]);
        }
        CHECK(!cell.has_sides);
        cell_free(&cell);
    }
}

/* Thin bars are cylinders, less what meets in nodes, which grows by the third power, less what the
 * interpolant cuts off a circle, which is even: volume / (pi r^2) = length - a r - b / r^2. */
static double length_of(const iso_lattice_cell *cell) {
    static const double r[3] = {0.05, 0.08, 0.12};
    double y[3], s[3];
    for (int i = 0; i < 3; i++) {
        s[i] = 1 / (r[i] * r[i]);
        y[i] = cell_density(cell, r[i]) / (PI * r[i] * r[i]);
    }
    double p = r[1] - r[0], q = s[1] - s[0], t = r[2] - r[0], u = s[2] - s[0];
    double a = ((y[0] - y[1]) * u - (y[0] - y[2]) * q) / (p * u - t * q);
    double b = ((y[0] - y[2]) * p - (y[0] - y[1]) * t) / (p * u - t * q);
    return y[0] + a * r[0] + b * s[0];
}

static void test_lengths(void) {
    const double length[] = {4 * sqrt(3), 6 * sqrt(2), 12 * sqrt(2), 6 * sqrt(2), 4 * sqrt(3)};
    for (int32_t p = ISO_LATTICE_BCC_STRUTS; p <= ISO_LATTICE_DIAMOND_STRUTS; p++) {
        iso_lattice_cell cell;
        if (!make(&cell, p))
            return;
        double found = length_of(&cell);
        printf("    %s: %.4f long, not %.4f\n", iso_lattice_name(p), found,
               length[p - ISO_LATTICE_BCC_STRUTS]);
        CHECK_NEAR(length[p - ISO_LATTICE_BCC_STRUTS], found,
                   0.02 * length[p - ISO_LATTICE_BCC_STRUTS]);
        cell_free(&cell);
    }
}

static void test_cubic(void) {
    iso_lattice_cell cell;
    if (!make(&cell, ISO_LATTICE_VOXEL_CUBIC))
        return;
    for (double half = 0.01; half < 0.5; half += 0.013)
        CHECK_NEAR(12 * half * half - 16 * half * half * half, cell_density(&cell, half), 0.001);
    for (double u = 0; u < 1; u += 0.07) {
        double x = u < 0.5 ? u : 1 - u; /* along an axis through the cell, between its middles */
        CHECK_NEAR(x, cell_distance(&cell, u, 0.5, 0), 0.5 / 64);
        CHECK_NEAR(0, cell_distance(&cell, u, 0, 0), 1e-6);
        CHECK_NEAR(0.5, cell_distance(&cell, u, 0.5, 0.5), 1e-6);
    }
    cell_free(&cell);
}

int main(void) {
    RUN(test_distances);
    RUN(test_lengths);
    RUN(test_cubic);
    return check_verdict();
}

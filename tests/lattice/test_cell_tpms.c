/* Minimal surfaces: true distances, areas, topology, sides. */
#include <math.h>
#include <stdlib.h>

#include "cells.h"
#include "check.h"

#define TURN 6.28318530717958647692

/* The fields by themselves, with the C library's sines; gradients by central differences. */
static double field(int which, const double *p) {
    double x = TURN * p[0], y = TURN * p[1], z = TURN * p[2];
    switch (which) {
    case 0:
        return sin(x) * cos(y) + sin(y) * cos(z) + sin(z) * cos(x);
    case 1:
        return cos(x) + cos(y) + cos(z);
    case 2:
        return sin(x) * sin(y) * sin(z) + sin(x) * cos(y) * cos(z) + cos(x) * sin(y) * cos(z) +
               cos(x) * cos(y) * sin(z);
    case 3:
        return cos(2 * x) + cos(2 * y) + cos(2 * z) -
               2 * (cos(x) * cos(y) + cos(y) * cos(z) + cos(z) * cos(x));
    case 4:
        return 3 * (cos(x) + cos(y) + cos(z)) + 4 * cos(x) * cos(y) * cos(z);
    default:
        return cos(2 * x) * sin(y) * cos(z) + cos(x) * cos(2 * y) * sin(z) +
               sin(x) * cos(y) * cos(2 * z);
    }
}

static void gradient(double *out, int which, const double *p) {
    const double h = 1e-5;
    for (int a = 0; a < 3; a++) {
        double q[3] = {p[0], p[1], p[2]};
        q[a] = p[a] + h;
        out[a] = field(which, q);
        q[a] = p[a] - h;
        out[a] = (out[a] - field(which, q)) / (2 * h);
    }
}

static double dot(const double *p, const double *q) {
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}

/* Onto the surface, along the gradient. */
static void project(double *p, int which) {
    for (int turn = 0; turn < 8; turn++) {
        double g[3], value = field(which, p);
        gradient(g, which, p);
        double square = dot(g, g);
        for (int a = 0; a < 3 && square > 1e-12; a++)
            p[a] -= value * g[a] / square;
    }
}

/* Slide a point of the surface to where its normal leads through p; the distance there. */
static double slide(const double *from, const double *p, int which) {
    double q[3] = {from[0], from[1], from[2]}, way[3], best = HUGE_VAL, step = 1;
    for (int turn = 0; turn < 200; turn++) {
        double g[3], try[3];
        gradient(g, which, q);
        for (int a = 0; a < 3; a++)
            way[a] = p[a] - q[a];
        double length = sqrt(dot(way, way)), along = dot(way, g) / dot(g, g);
        if (length < best - 1e-13)
            best = length;
        for (int a = 0; a < 3; a++)
            try[a] = q[a] + step * (way[a] - along * g[a]);
        project(try, which);
        for (int a = 0; a < 3; a++)
            way[a] = p[a] - try[a];
        if (dot(way, way) < length * length)
            memcpy(q, try, sizeof q);
        else if ((step *= 0.5) < 1e-4)
            break;
    }
    return best;
}

enum { COARSE = 40, NEAREST = 6 };

typedef struct cloud {
    double (*at)[3];
    int count;
} cloud;

/* Points all over the surface: every node of a coarse grid that is near to it. */
static void make_cloud(cloud *out, int which) {
    out->count = 0;
    out->at = malloc(sizeof *out->at * COARSE * COARSE * COARSE);
    for (int i = 0; i < COARSE * COARSE * COARSE; i++) {
        double p[3] = {(i % COARSE + 0.5) / COARSE, (i / COARSE % COARSE + 0.5) / COARSE,
                       (i / COARSE / COARSE + 0.5) / COARSE};
        double q[3] = {p[0], p[1], p[2]}, way = 0;
        project(q, which);
        for (int a = 0; a < 3; a++)
            way += (q[a] - p[a]) * (q[a] - p[a]);
        if (way < 1.0 / (COARSE * COARSE) && fabs(field(which, q)) < 1e-9)
            memcpy(out->at[out->count++], q, sizeof q);
    }
}

/* By the nearest few of the cloud, each slid to its foot. */
static double true_distance(const cloud *c, const double *p, int which) {
    double square[NEAREST], best = HUGE_VAL;
    double at[NEAREST][3];
    for (int k = 0; k < NEAREST; k++)
        square[k] = HUGE_VAL;
    for (int i = 0; i < c->count; i++) {
        double q[3], d = 0;
        for (int a = 0; a < 3; a++) {
            double way = c->at[i][a] - p[a];
            way -= floor(way + 0.5);
            q[a] = p[a] + way;
            d += way * way;
        }
        for (int k = 0; k < NEAREST; k++)
            if (d < square[k]) {
                for (int m = NEAREST - 1; m > k; m--) {
                    square[m] = square[m - 1];
                    memcpy(at[m], at[m - 1], sizeof at[m]);
                }
                square[k] = d;
                memcpy(at[k], q, sizeof q);
                break;
            }
    }
    for (int k = 0; k < NEAREST; k += NEAREST - 1) {
        double d = slide(at[k], p, which);
        best = d < best ? d : best;
    }
    return best;
}

static int make(iso_lattice_cell *cell, int which, int is_solid) {
    iso_lattice_options options = iso_lattice_defaults();
    options.pattern = ISO_LATTICE_GYROID_SHEET + 2 * which + is_solid;
    return CHECK_OK(cell_make(cell, &options));
}

/* At the surface within 0.001 cell; where walls may end, up to 0.15 cell away, within 0.5 % on the
 * whole, and within a quarter of a sample's step anywhere: so much the interpolant rounds the
 * ridges off that are equally far from two parts of the surface. */
static void test_distances(void) {
    for (int which = 0; which < 6; which++) {
        iso_lattice_cell cell;
        cloud c;
        uint64_t seed = 21;
        double worst_on = 0, worst = 0, squares = 0;
        int far = 0;
        if (!make(&cell, which, 0))
            return;
        make_cloud(&c, which);
        for (int i = 0; i < 200; i++) { /* points on the surface */
            const double *p = c.at[(int)(random_number(&seed) * c.count)];
            double g = fabs(cell_distance(&cell, p[0], p[1], p[2]));
            worst_on = g > worst_on ? g : worst_on;
        }
        for (int i = 0; i < 200; i++) {
            double p[3];
            for (int a = 0; a < 3; a++)
                p[a] = random_number(&seed);
            double g = cell_distance(&cell, p[0], p[1], p[2]), d = true_distance(&c, p, which);
            if (d > 0.002)
                CHECK((g < 0) == (field(which, p) < 0));
            if (d < 0.02 || d > 0.15)
                continue;
            double error = fabs(fabs(g) - d);
            worst = error > worst ? error : worst;
            squares += error * error / (d * d);
            far++;
        }
        printf("    %s: %d points, %.5f cells off on it, %.5f beside, %.3f %%\n",
               iso_lattice_name(2 * which), c.count, worst_on, worst, 100 * sqrt(squares / far));
        CHECK(far > 50);
        CHECK(worst_on < 0.001);
        CHECK(worst < 0.25 / 64);
        CHECK(sqrt(squares / far) < 0.005);
        free(c.at);
        cell_free(&cell);
    }
}

/* Of the minimal surfaces themselves, which these fields come near to (I-WP's the least), in one
 * period: areas (Schoen 1970; Fogden and Hyde 1992), and Euler numbers, from their genus. A cubic
 * cell of gyroid has two of its primitive ones, of diamond four, of I-WP two. */
static void test_surfaces(void) {
    static const double area[5] = {3.0914, 2.3451, 3.8377, 3.4641, 3.5105};
    static const int euler[6] = {-8, -4, -16, -12, -16, -40};
    for (int which = 0; which < 6; which++) {
        iso_lattice_cell cell;
        surface_figures f;
        if (!make(&cell, which, 1))
            return;
        measure_surface(&f, &cell, 0);
        printf("    %s: area %.4f, Euler number %lld, %.4f solid at 0\n",
               iso_lattice_name(2 * which), f.area, (long long)f.euler, f.volume);
        if (which < 5)
            CHECK_NEAR(area[which], f.area, (which == 3 ? 0.03 : 0.005) * area[which]);
        CHECK_EQUAL(euler[which], f.euler);
        if (which != 3)
            CHECK_NEAR(0.5, f.volume, 0.0005);
        CHECK_NEAR(f.volume, cell_density(&cell, 0), 0.001);
        cell_free(&cell);
    }
}

/* A thin wall's density is its thickness times the area; what curves both ways alike takes nothing
 * away to the second order but 4/3 pi times the Euler number to the third (Steiner). */
static void test_walls(void) {
    for (int which = 0; which < 6; which++) {
        iso_lattice_cell cell;
        surface_figures f;
        if (!make(&cell, which, 0))
            return;
        measure_surface(&f, &cell, 0);
        for (double half = 0.005; half < 0.04; half += 0.005) {
            double steiner = 2 * half * f.area + TURN / 1.5 * half * half * half * (double)f.euler;
            CHECK_NEAR(steiner, cell_density(&cell, half), 0.01 * steiner);
        }
        cell_free(&cell);
    }
}

/* Close to the surface the distance grows by one. */
static void test_gradient(void) {
    for (int which = 0; which < 6; which++) {
        iso_lattice_cell cell;
        uint64_t seed = 4;
        double squares = 0;
        int count = 0;
        if (!make(&cell, which, 0))
            return;
        for (int i = 0; i < 4000; i++) {
            double p[3], square = 0, h = 0.5 / cell.size[0];
            for (int a = 0; a < 3; a++)
                p[a] = random_number(&seed);
            if (fabs(cell_distance(&cell, p[0], p[1], p[2])) > 0.05)
                continue;
            for (int a = 0; a < 3; a++) {
                double q[3] = {p[0], p[1], p[2]}, r[3] = {p[0], p[1], p[2]};
                q[a] += h, r[a] -= h;
                double slope = (cell_distance(&cell, q[0], q[1], q[2]) -
                                cell_distance(&cell, r[0], r[1], r[2])) /
                               (2 * h);
                square += slope * slope;
            }
            squares += (sqrt(square) - 1) * (sqrt(square) - 1);
            count++;
        }
        CHECK(count > 500 && sqrt(squares / count) < 0.01);
        cell_free(&cell);
    }
}

/* One side alone, the other way round: gyroid and diamond have two alike, mirrored or moved. */
static void test_solid(void) {
    for (int which = 0; which < 6; which++) {
        iso_lattice_cell sheet, solid;
        if (!make(&sheet, which, 0) || !make(&solid, which, 1))
            return;
        CHECK(sheet.has_sides && !solid.has_sides);
        size_t bytes = (size_t)sheet.size[0] * sheet.size[1] * sheet.size[2] * sizeof(float);
        CHECK(memcmp(sheet.distance, solid.distance, bytes) == 0);
        CHECK(cell_level(&solid, 0.2) < 0 && cell_level(&solid, 0.8) > 0);
        if (which != 3)
            CHECK_NEAR(cell_level(&solid, 0.2), -cell_level(&solid, 0.8), 0.001);
        cell_free(&sheet);
        cell_free(&solid);
    }
}

int main(void) {
    RUN(test_distances);
    RUN(test_surfaces);
    RUN(test_walls);
    RUN(test_gradient);
    RUN(test_solid);
    return check_verdict();
}

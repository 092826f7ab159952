#include "cells.h"

#include <math.h>

double random_number(uint64_t *state) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) * 0x1p-53;
}

void sampled_densities(double *share, const iso_lattice_cell *cell, const double *level,
                       int32_t levels, int64_t points) {
    uint64_t seed = 99;
    for (int32_t i = 0; i < levels; i++)
        share[i] = 0;
    for (int64_t p = 0; p < points; p++) {
        double u = cell->repeat[0] * random_number(&seed);
        double v = cell->repeat[1] * random_number(&seed);
        double w = cell->repeat[2] * random_number(&seed);
        double g = cell_distance(cell, u, v, w);
        for (int32_t i = 0; i < levels; i++)
            share[i] += (cell->has_sides ? fabs(g) : g) <= level[i];
    }
    for (int32_t i = 0; i < levels; i++)
        share[i] /= (double)points;
}

typedef struct corner {
    double at[3], g;
} corner;

static void between(double *out, const corner *p, const corner *q) {
    double t = p->g / (p->g - q->g);
    for (int a = 0; a < 3; a++)
        out[a] = p->at[a] + t * (q->at[a] - p->at[a]);
}

static double triangle(const double *p, const double *q, const double *r) {
    double u[3], v[3], n[3];
    for (int a = 0; a < 3; a++)
        u[a] = q[a] - p[a], v[a] = r[a] - p[a];
    for (int a = 0; a < 3; a++)
        n[a] = u[(a + 1) % 3] * v[(a + 2) % 3] - u[(a + 2) % 3] * v[(a + 1) % 3];
    return 0.5 * sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
}

/* Share of a tetrahedron below 0, its corners' values ascending, `below` of them under it. */
static double share_below(const corner *c, int below) {
    double v[4] = {c[0].g, c[1].g, c[2].g, c[3].g};
    if (below == 0 || below == 4)
        return below == 4;
    if (below == 1)
        return -v[0] * v[0] * v[0] / ((v[1] - v[0]) * (v[2] - v[0]) * (v[3] - v[0]));
    if (below == 3)
        return 1 - v[3] * v[3] * v[3] / ((v[3] - v[0]) * (v[3] - v[1]) * (v[3] - v[2]));
    double a = v[0] / (v[0] - v[2]), b = v[0] / (v[0] - v[3]);
    double p = v[1] / (v[1] - v[2]), q = v[1] / (v[1] - v[3]);
    /* a wedge, as three tetrahedra */
    return a * b + (1 - a) * b * p + p * q * (1 - b);
}

static void add_tetrahedron(surface_figures *out, int64_t *halves, corner c[4], double volume) {
    for (int i = 0; i < 4; i++)
        for (int j = i; j > 0 && c[j].g < c[j - 1].g; j--) {
            corner swap = c[j];
            c[j] = c[j - 1], c[j - 1] = swap;
        }
    int below = 0;
    for (int i = 0; i < 4; i++)
        below += c[i].g < 0;
    out->volume += volume * share_below(c, below);
    double p[4][3];
    if (below == 1 || below == 3) {
        int lone = below == 1 ? 0 : 3;
        for (int i = 0, k = 0; i < 4; i++)
            if (i != lone)
                between(p[k++], &c[lone], &c[i]);
        out->area += triangle(p[0], p[1], p[2]);
        *halves -= 1;
    } else if (below == 2) {
        between(p[0], &c[0], &c[2]);
        between(p[1], &c[0], &c[3]);
        between(p[2], &c[1], &c[3]);
        between(p[3], &c[1], &c[2]);
        out->area += triangle(p[0], p[1], p[2]) + triangle(p[0], p[2], p[3]);
        *halves -= 2;
    }
}

void measure_surface(surface_figures *out, const iso_lattice_cell *cell, double level) {
    static const int ways[6][2] = {{1, 3}, {1, 5}, {2, 3}, {2, 6}, {4, 5}, {4, 6}};
    int64_t halves = 0; /* twice (corners - edges + faces) */
    const int32_t *n = cell->size;
    double step[3], volume = 1.0 / 6;
    *out = (surface_figures){0};
    for (int a = 0; a < 3; a++) {
        step[a] = (double)cell->repeat[a] / n[a];
        volume *= step[a];
    }
    for (int32_t k = 0; k < n[2]; k++)
        for (int32_t j = 0; j < n[1]; j++)
            for (int32_t i = 0; i < n[0]; i++) {
                corner box[8];
                for (int c = 0; c < 8; c++) {
                    int32_t x = i + (c & 1), y = j + (c >> 1 & 1), z = k + (c >> 2);
                    box[c] = (corner){
                        {x * step[0], y * step[1], z * step[2]},
                        cell->distance[x % n[0] +
                                       (int64_t)n[0] * (y % n[1] + (int64_t)n[1] * (z % n[2]))] -
                            level};
                    halves += c > 0 && (box[c].g < 0) != (box[0].g < 0) ? 2 : 0;
                }
                for (int t = 0; t < 6; t++) {
                    corner c[4] = {box[0], box[ways[t][0]], box[ways[t][1]], box[7]};
                    add_tetrahedron(out, &halves, c, volume);
                }
            }
    out->euler = halves / 2;
}

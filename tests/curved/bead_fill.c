#include "beads.h"

#include <stddef.h>

/* Narrow [range[0], range[1]] of x to where low <= slope x + at <= high. */
static void narrow(double range[2], double slope, double at, double low, double high) {
    if (fabs(slope) < 1e-12) {
        if (at < low || at > high)
            range[1] = -1e30;
        return;
    }
    double a = (low - at) / slope, b = (high - at) / slope;
    range[0] = fmax(range[0], fmin(a, b));
    range[1] = fmin(range[1], fmax(a, b));
}

/* To where x, rel.y, rel.z is within `radius` of the line along `up` through 0. */
static void narrow_round(double range[2], vec up, vec rel, double radius) {
    double k = up.y * rel.y + up.z * rel.z, a = 1 - up.x * up.x, b = -up.x * k;
    double c = rel.y * rel.y + rel.z * rel.z - k * k - radius * radius;
    if (a < 1e-12) {
        if (c > 0)
            range[1] = -1e30;
        return;
    }
    double root = b * b - a * c;
    if (root < 0) {
        range[1] = -1e30;
        return;
    }
    range[0] = fmax(range[0], (-b - sqrt(root)) / a);
    range[1] = fmin(range[1], (-b + sqrt(root)) / a);
}

/* One row of voxels, whose y and z are rel.y, rel.z away from the bead's beginning. */
static void fill_row(uint64_t *row, const grid *g, const bead *b, vec rel, double width, int round,
                     double slack) {
    const double touch = 1e-6;
    double slab[2] = {-1e30, 1e30}, straight[2];
    double depth = b->height + slack, half = width / 2;
    narrow(slab, b->up.x, b->up.y * rel.y + b->up.z * rel.z, -depth - touch, touch);
    if (slab[0] > slab[1])
        return;
    straight[0] = slab[0], straight[1] = slab[1];
    narrow(straight, b->along.x, b->along.y * rel.y + b->along.z * rel.z, -touch,
           b->length + touch);
    narrow(straight, b->side.x, b->side.y * rel.y + b->side.z * rel.z, -half - touch, half + touch);
    double x = b->from.x - g->low.x;
    if (straight[0] <= straight[1])
        grid_span(row, g, x + straight[0], x + straight[1]);
    for (int end = 0; round && end < 2; end++) {
        vec by = end ? minus(b->to, b->from) : (vec){0, 0, 0};
        double ball[2] = {slab[0] - by.x, slab[1] - by.x};
        narrow_round(ball, b->up, (vec){0, rel.y - by.y, rel.z - by.z}, half);
        if (ball[0] <= ball[1])
            grid_span(row, g, x + by.x + ball[0], x + by.x + ball[1]);
    }
}

void bead_range(double range[2], const bead *b, double slack) {
    double sideways = b->width / 2 * sqrt(fmax(0, 1 - b->up.z * b->up.z));
    double down = (b->height + slack) * b->up.z;
    range[0] = fmin(b->from.z, b->to.z) - sideways - fmax(0, down);
    range[1] = fmax(b->from.z, b->to.z) + sideways + fmax(0, -down);
}

void bead_fill(uint64_t *bits, const grid *g, const bead *b, double width, int round, double slack,
               int z0, int z1) {
    double range[2], sideways = width / 2 + (b->height + slack) * fabs(b->up.y);
    bead_range(range, b, slack);
    int k0 = (int)floor((range[0] - g->low.z) / g->voxel - 0.5);
    int k1 = (int)ceil((range[1] - g->low.z) / g->voxel - 0.5) + 1;
    int j0 = (int)floor((fmin(b->from.y, b->to.y) - sideways - g->low.y) / g->voxel - 0.5);
    int j1 = (int)ceil((fmax(b->from.y, b->to.y) + sideways - g->low.y) / g->voxel - 0.5) + 1;
    k0 = k0 < z0 ? z0 : k0, k1 = k1 > z1 ? z1 : k1;
    j0 = j0 < 0 ? 0 : j0, j1 = j1 > g->ny ? g->ny : j1;
    size_t slice = (size_t)g->ny * (size_t)g->words;
    for (int k = k0; k < k1; k++)
        for (int j = j0; j < j1; j++) {
            vec rel = {0, g->low.y + (j + 0.5) * g->voxel - b->from.y,
                       g->low.z + (k + 0.5) * g->voxel - b->from.z};
            fill_row(bits + (size_t)(k - z0) * slice + (size_t)j * (size_t)g->words, g, b, rel,
                     width, round, slack);
        }
}

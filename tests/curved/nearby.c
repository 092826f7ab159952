#include "nearby.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define CELL 1.0 /* mm */

typedef struct sample {
    vec at;
    int32_t layer;
} sample;

/* Points of beads, sorted into cells by a hash. */
typedef struct cells {
    sample *point;
    int64_t count, buckets;
    int64_t *first; /* [buckets + 1] */
} cells;

static int64_t bucket(const cells *c, int32_t layer, int x, int y, int z) {
    uint64_t h = (uint64_t)(uint32_t)layer * 0x9e3779b97f4a7c15u;
    h ^= (uint64_t)(uint32_t)x * 0xc2b2ae3d27d4eb4fu;
    h ^= (uint64_t)(uint32_t)y * 0x165667b19e3779f9u;
    h ^= (uint64_t)(uint32_t)z * 0x27d4eb2f165667c5u;
    return (int64_t)((h ^ h >> 29) % (uint64_t)c->buckets);
}

static int64_t bucket_of(const cells *c, const sample *s) {
    return bucket(c, s->layer, (int)floor(s->at.x / CELL), (int)floor(s->at.y / CELL),
                  (int)floor(s->at.z / CELL));
}

static void sort_in(cells *c, const beads *b) {
    int64_t n = 0, fill = 0;
    for (int64_t i = 0; i < b->count; i++)
        n += 1 + (int64_t)(b->at[i].length / 0.4);
    c->buckets = n + 1;
    c->point = malloc((size_t)n * sizeof *c->point);
    c->first = calloc((size_t)c->buckets + 1, sizeof *c->first);
    sample *all = malloc((size_t)n * sizeof *all);
    for (int64_t i = 0; i < b->count; i++) {
        int pieces = 1 + (int)(b->at[i].length / 0.4);
        for (int k = 0; k < pieces; k++)
            all[c->count++] =
                (sample){mix(b->at[i].from, b->at[i].to, (k + 0.5) / pieces), b->at[i].layer};
    }
    for (int64_t i = 0; i < c->count; i++)
        c->first[bucket_of(c, &all[i])]++;
    for (int64_t i = 0; i <= c->buckets; i++) {
        int64_t here = c->first[i];
        c->first[i] = fill;
        fill += here;
    }
    for (int64_t i = 0; i < c->count; i++)
        c->point[c->first[bucket_of(c, &all[i])]++] = all[i];
    memmove(c->first + 1, c->first, (size_t)c->buckets * sizeof *c->first);
    c->first[0] = 0;
    free(all);
}

/* Sums over points near a place, of which a plane is made. */
typedef struct cloud {
    double weight;
    vec sum, row[3];
    double nearest;
} cloud;

static void gather(cloud *g, const cells *c, int32_t layer, vec at, double radius) {
    *g = (cloud){.nearest = 1e30};
    int low[3], high[3];
    const double place[3] = {at.x, at.y, at.z};
    for (int k = 0; k < 3; k++) {
        low[k] = (int)floor((place[k] - radius) / CELL);
        high[k] = (int)floor((place[k] + radius) / CELL);
    }
    for (int x = low[0]; x <= high[0]; x++)
        for (int y = low[1]; y <= high[1]; y++)
            for (int z = low[2]; z <= high[2]; z++) {
                int64_t k = bucket(c, layer, x, y, z);
                for (int64_t i = c->first[k]; i < c->first[k + 1]; i++) {
                    const sample *s = &c->point[i];
                    vec d = minus(s->at, at);
                    double far = length(d), w = 1 - far * far / (radius * radius);
                    /* another cell's, with the same hash */
                    if (s->layer != layer || w <= 0 || (int)floor(s->at.x / CELL) != x ||
                        (int)floor(s->at.y / CELL) != y || (int)floor(s->at.z / CELL) != z)
                        continue;
                    w *= w;
                    g->weight += w;
                    g->sum = plus(g->sum, times(d, w));
                    g->row[0] = plus(g->row[0], times(d, w * d.x));
                    g->row[1] = plus(g->row[1], times(d, w * d.y));
                    g->row[2] = plus(g->row[2], times(d, w * d.z));
                    g->nearest = fmin(g->nearest, far);
                }
            }
}

/* The direction that the points spread least in, and how much they spread in the middle one, mm^2:
 * the other two by power iteration. */
static vec flat_normal(const cloud *g, double *second) {
    vec mean = times(g->sum, 1 / g->weight), row[3];
    for (int k = 0; k < 3; k++)
        row[k] = times(g->row[k], 1 / g->weight);
    row[0] = minus(row[0], times(mean, mean.x));
    row[1] = minus(row[1], times(mean, mean.y));
    row[2] = minus(row[2], times(mean, mean.z));
    vec axis[2];
    for (int a = 0; a < 2; a++) {
        vec v = a == 0 ? (vec){0.8, 0.6, 0.1} : cross(axis[0], (vec){0.3, 0.2, 0.9});
        *second = 0;
        for (int i = 0; i < 60; i++) {
            vec w = {dot(row[0], v), dot(row[1], v), dot(row[2], v)};
            if (a == 1)
                w = minus(w, times(axis[0], dot(axis[0], w)));
            *second = length(w);
            if (*second < 1e-12)
                break;
            v = times(w, 1 / *second);
        }
        axis[a] = unit(v);
    }
    vec n = cross(axis[0], axis[1]);
    if (length(n) < 1e-6)
        return (vec){0, 0, 1};
    n = unit(n);
    return n.z < 0 ? times(n, -1) : n;
}

/* Across the layer's points around; upwards where they all lie on one line. */
static vec normal_at(const cells *c, int32_t layer, vec at) {
    for (double radius = 1; radius < 5; radius *= 2) {
        cloud g;
        double second;
        gather(&g, c, layer, at, radius);
        if (g.weight <= 0)
            continue;
        vec n = flat_normal(&g, &second);
        if (second > 0.02)
            return n;
    }
    return (vec){0, 0, 1};
}

/* How far below along `up` another layer is, or the bed. */
static double height_at(const cells *c, int32_t layer, vec at, vec up) {
    double bed = at.z / fmax(up.z, 0.1);
    for (int32_t below = layer - 1; below >= 0 && below > layer - 40; below--) {
        cloud g;
        double second;
        gather(&g, c, below, minus(at, times(up, fmin(bed, 0.3))), 1);
        if (g.weight <= 0)
            continue;
        vec n = flat_normal(&g, &second);
        if (second < 0.005)
            n = up;
        /* the plane through the points' middle, which is counted from 0.3 mm down */
        vec from = plus(times(up, fmin(bed, 0.3)), times(g.sum, -1 / g.weight));
        double height = dot(from, n) / fmax(0.2, dot(up, n));
        if (height > 0.01)
            return fmin(height, bed);
    }
    return bed;
}

void nearby_frames(beads *b, int told) {
    cells c = {0};
    sort_in(&c, b);
    for (int64_t i = 0; i < b->count; i++) {
        bead *one = &b->at[i];
        vec at = mix(one->from, one->to, 0.5);
        one->up = normal_at(&c, one->layer, at);
        double height = told ? one->height : height_at(&c, one->layer, at, one->up);
        if (one->height > 0) /* more is a layer that is missing */
            height = fmin(height, 1.05 * one->height);
        one->height = height;
    }
    free(c.point);
    free(c.first);
}

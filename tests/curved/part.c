#include "part.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct crossing {
    double x;
    int sign;
} crossing;

typedef struct row {
    crossing *at;
    int count, capacity;
} row;

static void measure(part *p) {
    p->low = (vec){1e30, 1e30, 1e30}, p->high = (vec){-1e30, -1e30, -1e30};
    p->volume = 0;
    for (int64_t i = 0; i < p->count; i++) {
        vec c[3];
        for (int k = 0; k < 3; k++) {
            const float *f = p->triangle[i] + 3 * k;
            c[k] = (vec){f[0], f[1], f[2]};
            p->low = (vec){fmin(p->low.x, f[0]), fmin(p->low.y, f[1]), fmin(p->low.z, f[2])};
            p->high = (vec){fmax(p->high.x, f[0]), fmax(p->high.y, f[1]), fmax(p->high.z, f[2])};
        }
        p->volume += dot(c[0], cross(c[1], c[2])) / 6;
    }
}

static int load(part *p, const char *path) {
    FILE *file = fopen(path, "rb");
    unsigned char head[84], record[50];
    if (!file) {
        perror(path);
        return 0;
    }
    int good = fread(head, 1, 84, file) == 84;
    for (int k = 3; k >= 0 && good; k--)
        p->count = p->count << 8 | head[80 + k];
    p->triangle = malloc(((size_t)p->count + 1) * sizeof *p->triangle);
    for (int64_t i = 0; i < p->count && good && p->triangle; i++) {
        good = fread(record, 1, 50, file) == 50;
        memcpy(p->triangle[i], record + 12, 36);
    }
    fclose(file);
    if (!good || !p->triangle || p->count == 0)
        fprintf(stderr, "%s: no binary STL\n", path);
    return good && p->triangle && p->count > 0;
}

int part_read(part *p, const char *path, double x, double y) {
    *p = (part){0};
    if (!load(p, path))
        return 0;
    measure(p);
    vec by = {x - (p->low.x + p->high.x) / 2, y - (p->low.y + p->high.y) / 2, -p->low.z};
    for (int64_t i = 0; i < p->count; i++)
        for (int k = 0; k < 9; k++)
            p->triangle[i][k] += (float)(k % 3 == 0 ? by.x : k % 3 == 1 ? by.y : by.z);
    measure(p);
    return 1;
}

void part_free(part *p) {
    free(p->triangle);
    *p = (part){0};
}

void grid_span(uint64_t *bits, const grid *g, double a, double b) {
    int first = (int)ceil(a / g->voxel - 0.5), end = (int)floor(b / g->voxel - 0.5) + 1;
    first = first < 0 ? 0 : first, end = end > g->nx ? g->nx : end;
    if (first >= end)
        return;
    int w0 = first / 64, w1 = (end - 1) / 64;
    uint64_t left = ~0ull << first % 64, right = ~0ull >> (63 - (end - 1) % 64);
    if (w0 == w1) {
        bits[w0] |= left & right;
        return;
    }
    bits[w0] |= left;
    for (int w = w0 + 1; w < w1; w++)
        bits[w] = ~0ull;
    bits[w1] |= right;
}

/* Where a triangle cuts the plane at z, from one crossing to the other; inside is left of it. */
static int cut(vec end[2], const float *t, double z) {
    int count = 0, up = 0;
    for (int k = 0; k < 3; k++) {
        const float *a = t + 3 * k, *b = t + 3 * ((k + 1) % 3);
        if ((a[2] > z) == (b[2] > z))
            continue;
        double u = (z - a[2]) / ((double)b[2] - a[2]);
        if (b[2] > z)
            up = count;
        end[count++] = (vec){a[0] + u * ((double)b[0] - a[0]), a[1] + u * ((double)b[1] - a[1]), z};
    }
    if (count == 2 && up == 0) {
        vec swap = end[0];
        end[0] = end[1], end[1] = swap;
    }
    return count == 2;
}

static void cross_rows(row *rows, const grid *g, const vec end[2]) {
    double y0 = end[0].y, y1 = end[1].y;
    int first = (int)ceil((fmin(y0, y1) - g->low.y) / g->voxel - 0.5);
    int last = (int)ceil((fmax(y0, y1) - g->low.y) / g->voxel - 0.5);
    for (int j = first < 0 ? 0 : first; j < last && j < g->ny; j++) {
        row *r = &rows[j];
        if (r->count == r->capacity) {
            r->capacity = r->capacity ? 2 * r->capacity : 8;
            r->at = realloc(r->at, (size_t)r->capacity * sizeof *r->at);
            if (!r->at)
                abort();
        }
        double t = (g->low.y + (j + 0.5) * g->voxel - y0) / (y1 - y0);
        r->at[r->count++] =
            (crossing){end[0].x + t * (end[1].x - end[0].x) - g->low.x, y1 > y0 ? 1 : -1};
    }
}

static int by_x(const void *a, const void *b) {
    double d = ((const crossing *)a)->x - ((const crossing *)b)->x;
    return d < 0 ? -1 : d > 0;
}

void part_fill(uint64_t *bits, const part *p, const grid *g, int z0, int z1) {
    size_t slice = (size_t)g->ny * (size_t)g->words;
    memset(bits, 0, slice * (size_t)(z1 - z0) * sizeof *bits);
    row *rows = calloc((size_t)g->ny, sizeof *rows);
    for (int k = z0; k < z1 && rows; k++) {
        double z = g->low.z + (k + 0.5) * g->voxel;
        for (int j = 0; j < g->ny; j++)
            rows[j].count = 0;
        for (int64_t i = 0; i < p->count; i++) {
            vec end[2];
            if (cut(end, p->triangle[i], z))
                cross_rows(rows, g, end);
        }
        for (int j = 0; j < g->ny; j++) {
            if (rows[j].count > 1)
                qsort(rows[j].at, (size_t)rows[j].count, sizeof(crossing), by_x);
            int winding = 0;
            for (int i = 0; i + 1 < rows[j].count; i++) {
                winding += rows[j].at[i].sign;
                if (winding != 0)
                    grid_span(bits + (size_t)(k - z0) * slice + (size_t)j * (size_t)g->words, g,
                              rows[j].at[i].x, rows[j].at[i + 1].x);
            }
        }
    }
    for (int j = 0; rows && j < g->ny; j++)
        free(rows[j].at);
    free(rows);
}

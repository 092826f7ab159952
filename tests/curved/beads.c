#include "beads.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "nearby.h"

static int by_value(const void *a, const void *b) {
    double d = *(const double *)a - *(const double *)b;
    return d < 0 ? -1 : d > 0;
}

/* The lowest value of the field on the part: on its surface, unless the field has a lowest point
 * inside; triangles are sampled as finely as `step`. */
static double lowest(const part *p, const heights *field, vec middle) {
    const double step = 1;
    double least = 1e30;
    for (int64_t i = 0; i < p->count; i++) {
        vec c[3];
        for (int k = 0; k < 3; k++)
            c[k] = minus(
                (vec){p->triangle[i][3 * k], p->triangle[i][3 * k + 1], p->triangle[i][3 * k + 2]},
                middle);
        double edge = fmax(length(minus(c[1], c[0])),
                           fmax(length(minus(c[2], c[1])), length(minus(c[0], c[2]))));
        int n = 1 + (int)(edge / step);
        for (int u = 0; u <= n; u++)
            for (int v = 0; u + v <= n; v++) {
                vec q = plus(c[0], plus(times(minus(c[1], c[0]), (double)u / n),
                                        times(minus(c[2], c[0]), (double)v / n)));
                least = fmin(least, heights_at(field, q));
            }
    }
    return least;
}

/* The field at the top of each layer: the median over its beads, which lie there within the
 * tolerance that they were cut to. */
static void find_tops(beads *b, const heights *field, const part *p) {
    double *value = malloc(((size_t)b->count + 1) * sizeof *value);
    int32_t layers = b->layers;
    b->top = calloc((size_t)layers + 1, sizeof *b->top);
    b->level = malloc(((size_t)layers + 1) * sizeof *b->level);
    b->bottom = lowest(p, field, b->middle);
    int32_t levels = 0;
    for (int64_t i = 0; i < b->count;) {
        int64_t n = 0;
        int32_t layer = b->at[i].layer;
        for (; i + n < b->count && b->at[i + n].layer == layer; n++)
            value[n] = heights_at(field, minus(b->at[i + n].from, b->middle));
        qsort(value, (size_t)n, sizeof *value, by_value);
        b->level[layer] = levels;
        b->top[levels++] = value[n / 2];
        i += n;
    }
    b->layers = levels;
    free(value);
}

static vec upright(vec up, vec along) {
    vec u = minus(up, times(along, dot(up, along)));
    return length(u) > 1e-6 ? unit(u) : up;
}

static void field_frame(bead *one, const beads *b, const heights *field) {
    int32_t level = b->level[one->layer];
    double below = level > 0 ? b->top[level - 1] : b->bottom, dr = b->top[level] - below;
    double told = one->height > 0 ? 1.05 * one->height : 1e30; /* more is a layer that is missing */
    vec middle = minus(mix(one->from, one->to, 0.5), b->middle);
    vec g = heights_gradient(field, middle);
    one->up = unit(g);
    one->height = dr / length(g);
    g = heights_gradient(field, minus(middle, times(one->up, one->height / 2)));
    one->height = fmin(told, dr / length(g));
}

static void section(bead *one) {
    one->up = upright(one->up, one->along);
    one->side = cross(one->up, one->along);
    one->area = one->volume / one->length;
    one->width = one->area / one->height + one->height * (1 - PI / 4);
}

int beads_make(beads *b, const moves *m, const heights *field, const part *p, int told) {
    *b = (beads){.layers = m->layers};
    b->at = calloc((size_t)m->count + 1, sizeof *b->at);
    b->middle = (vec){(p->low.x + p->high.x) / 2, (p->low.y + p->high.y) / 2, 0};
    for (int64_t i = 0; i < m->count; i++) {
        const move *from = &m->at[i];
        double far = length(minus(from->to, from->from));
        if (from->volume <= 0 || far < 1e-6 || from->layer < 0)
            continue;
        b->at[b->count++] = (bead){.from = from->from,
                                   .to = from->to,
                                   .along = times(minus(from->to, from->from), 1 / far),
                                   .length = far,
                                   .volume = from->volume,
                                   .height = from->height,
                                   .layer = from->layer,
                                   .line = from->line};
    }
    if (b->count == 0) {
        fprintf(stderr, "nothing is printed\n");
        return 0;
    }
    if (field)
        find_tops(b, field, p);
    else
        nearby_frames(b, told);
    for (int64_t i = 0; i < b->count; i++) {
        if (field)
            field_frame(&b->at[i], b, field);
        if (!(b->at[i].height > 1e-6)) {
            fprintf(stderr, "line %d: a bead of no height\n", b->at[i].line);
            return 0;
        }
        section(&b->at[i]);
    }
    return 1;
}

void beads_free(beads *b) {
    free(b->at);
    free(b->top);
    free(b->level);
    *b = (beads){0};
}

int32_t beads_layer(vec *middle, const beads *b, const heights *field, vec place) {
    vec q = minus(place, b->middle);
    double r = heights_at(field, q);
    int32_t low = 0, high = b->layers - 1;
    while (low < high) {
        int32_t k = (low + high) / 2;
        if (b->top[k] < r)
            low = k + 1;
        else
            high = k;
    }
    double want = (b->top[low] + (low > 0 ? b->top[low - 1] : b->bottom)) / 2;
    vec g = heights_gradient(field, q);
    q = plus(q, times(g, (want - r) / dot(g, g)));
    q = plus(q, times(g, (want - heights_at(field, q)) / dot(g, g)));
    *middle = plus(q, b->middle);
    return low;
}

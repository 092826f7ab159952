#include "front.h"

#include <math.h>
#include <stdlib.h>

typedef struct entry {
    double way;
    int vertex;
} entry;

typedef struct heap {
    entry *at;
    int count, capacity;
} heap;

static void push(heap *h, double way, int vertex) {
    if (h->count == h->capacity) {
        h->capacity = 2 * h->capacity + 1024;
        h->at = realloc(h->at, (size_t)h->capacity * sizeof *h->at);
        if (!h->at)
            exit(1);
    }
    int i = h->count++;
    for (; i > 0 && h->at[(i - 1) / 2].way > way; i = (i - 1) / 2)
        h->at[i] = h->at[(i - 1) / 2];
    h->at[i] = (entry){way, vertex};
}

static entry pop(heap *h) {
    entry top = h->at[0], last = h->at[--h->count];
    int i = 0;
    for (int child; (child = 2 * i + 1) < h->count; i = child) {
        if (child + 1 < h->count && h->at[child + 1].way < h->at[child].way)
            child++;
        if (h->at[child].way >= last.way)
            break;
        h->at[i] = h->at[child];
    }
    h->at[i] = last;
    return top;
}

static iso_vec3 minus(iso_vec3 a, iso_vec3 b) {
    return (iso_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}
static double dot(iso_vec3 a, iso_vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* At c, from a and b: a plane front over the triangle, if it comes from between them. */
static double over(iso_vec3 c, iso_vec3 a, double ua, iso_vec3 b, double ub) {
    iso_vec3 e = minus(a, c), f = minus(b, c);
    double ee = dot(e, e), ff = dot(f, f), ef = dot(e, f), det = ee * ff - ef * ef;
    double best = fmin(ua + sqrt(ee), ub + sqrt(ff));
    if (!(det > 0) || isinf(ua) || isinf(ub))
        return best;
    double q11 = ff / det, q12 = -ef / det, q22 = ee / det;
    double A = q11 + 2 * q12 + q22, B = -2 * (ua * (q11 + q12) + ub * (q12 + q22));
    double C = q11 * ua * ua + 2 * q12 * ua * ub + q22 * ub * ub - 1, D = B * B - 4 * A * C;
    if (D < 0)
        return best;
    double u = (-B + sqrt(D)) / (2 * A);
    double w1 = q11 * (ua - u) + q12 * (ub - u), w2 = q12 * (ua - u) + q22 * (ub - u);
    return w1 < 0 && w2 < 0 && u >= fmax(ua, ub) ? fmin(best, u) : best;
}

double *march(const shape *s) {
    int n = s->sides, count = n * s->rings;
    double *way = malloc((size_t)count * sizeof *way);
    char *done = calloc((size_t)count, 1);
    heap h = {0};
    if (!way || !done)
        exit(1);
    for (int v = 0; v < count; v++) {
        way[v] = v < n ? 0 : INFINITY;
        if (v < n)
            push(&h, 0, v);
    }
    while (h.count > 0) {
        entry e = pop(&h);
        if (done[e.vertex])
            continue;
        done[e.vertex] = 1;
        /* both diagonals of each square: the front crosses them either way. Grid neighbours in
         * circular order; c is any of them, its other partner the next in the circle. */
        int i = e.vertex % n, j = e.vertex / n;
        for (int k = 0; k < 8; k++) {
            static const int di[8] = {1, 1, 0, -1, -1, -1, 0, 1};
            static const int dj[8] = {0, 1, 1, 1, 0, -1, -1, -1};
            int cj = j + dj[k], ci = (i + di[k] + n) % n, c = ci + n * cj;
            if (cj < 0 || cj >= s->rings || done[c])
                continue;
            for (int turn = 1; turn < 8; turn += 6) {
                int m = (k + turn) % 8, bj = j + dj[m], bi = (i + di[m] + n) % n, b = bi + n * bj;
                if (bj < 0 || bj >= s->rings)
                    continue;
                double u = over(shape_point(s, ci, cj), shape_point(s, i, j), e.way,
                                shape_point(s, bi, bj), way[b]);
                if (u < way[c] - 1e-12) {
                    way[c] = u;
                    push(&h, u, c);
                }
            }
        }
    }
    free(h.at);
    free(done);
    return way;
}

double way_at(const shape *s, const double *way, iso_vec3 p) {
    double y = p.y / s->stretch_y, x = (p.x - s->slant * p.z) / s->stretch_x;
    double around = atan2(y, x) / (2 * 3.14159265358979323846) * s->sides;
    double up = (p.z - s->low) / (s->high - s->low) * (s->rings - 1);
    around += around < 0 ? s->sides : 0;
    up = fmin(fmax(up, 0), s->rings - 1 - 1e-9);
    int i = (int)around % s->sides, j = (int)up, k = (i + 1) % s->sides;
    double t = around - floor(around), r = up - j;
    const double *low = way + s->sides * j, *high = low + s->sides;
    return (1 - r) * ((1 - t) * low[i] + t * low[k]) + r * ((1 - t) * high[i] + t * high[k]);
}

/* Foams: the faces or the edges of the Voronoi partition of one point in each cell. */
#include "lattice/family.h"

#include <math.h>

#include "base/memory.h"
#include "lattice/voronoi.h"

/* Points range over so much of their cell: less than all, so that none come too near. */
#define JITTER 0.8

enum { BLOCK = 4, ROWS = BLOCK * BLOCK };

/* From a block's middle to its outermost samples, a little rounded up. */
#define BLOCK_REACH 2.5981

typedef float four __attribute__((vector_size(16)));
typedef int32_t four_bits __attribute__((vector_size(16)));

typedef struct candidate { /* a site that some of the block's samples may belong to */
    float way[3];          /* from the block's first sample to it */
    int32_t site;
} candidate;

typedef struct plane {
    float normal[3], offset;
} plane;

static four choose(four_bits which, four a, four b) {
    return (four)(((four_bits)a & which) | ((four_bits)b & ~which));
}

static int32_t find_sites(candidate *out, const iso_voronoi *v, const int32_t *first, double size) {
    double nearest = HUGE_VAL, most;
    int32_t kept = 0;
    for (int turn = 0; turn < 2; turn++) {
        most = sqrt(nearest) + 2 * BLOCK_REACH;
        for (int32_t s = 0; s < v->count; s++) {
            double square = 0, way[3];
            for (int a = 0; a < 3; a++) {
                double middle = 0.5 * (BLOCK - 1), to = v->site[s][a] - first[a] - middle;
                to -= to > 0.5 * size ? size : to < -0.5 * size ? -size : 0;
                way[a] = to + middle;
                square += to * to;
            }
            nearest = square < nearest ? square : nearest;
            if (turn == 0 || square > most * most)
                continue;
            out[kept].site = s;
            for (int a = 0; a < 3; a++)
                out[kept].way[a] = (float)way[a];
            kept++;
        }
    }
    return kept;
}

/* Within a site's cell the least distance from its faces is the distance from all faces; outside
 * it, that is negative. So the largest over all sites is what is asked. */
static void fill_row(float *row, const iso_voronoi *v, const plane *planes,
                     const candidate *candidates, int32_t count, const int32_t *at) {
    four largest = {0, 0, 0, 0};
    for (int32_t c = 0; c < count; c++) {
        const float *way = candidates[c].way;
        const four x = {0 - way[0], 1 - way[0], 2 - way[0], 3 - way[0]};
        float y = (float)at[0] - way[1], z = (float)at[1] - way[2];
        four least = {HUGE_VALF, HUGE_VALF, HUGE_VALF, HUGE_VALF};
        for (int32_t f = v->first[candidates[c].site]; f < v->first[candidates[c].site + 1]; f++) {
            const plane *p = &planes[f];
            four d = (p->offset - p->normal[1] * y - p->normal[2] * z) - p->normal[0] * x;
            least = choose(d < least, d, least);
        }
        largest = choose(least > largest, least, largest);
    }
    for (int i = 0; i < BLOCK; i++)
        row[i] = largest[i];
}

static iso_status fill_sheet(iso_lattice_cell *cell, const iso_voronoi *v) {
    int32_t n = cell->size[0], first[3], faces = v->first[v->count];
    plane *planes;
    candidate *candidates;
    ISO_TRY(ISO_ALLOCATE(planes, faces));
    iso_status status = ISO_ALLOCATE(candidates, v->count);
    if (status != ISO_OK) {
        iso_release(planes);
        return status;
    }
    for (int32_t f = 0; f < faces; f++) {
        for (int a = 0; a < 3; a++)
            planes[f].normal[a] = (float)v->face[f].normal[a];
        planes[f].offset = (float)v->face[f].offset;
    }
    for (first[2] = 0; first[2] < n; first[2] += BLOCK)
        for (first[1] = 0; first[1] < n; first[1] += BLOCK)
            for (first[0] = 0; first[0] < n; first[0] += BLOCK) {
                int32_t count = find_sites(candidates, v, first, n);
                for (int32_t row = 0; row < ROWS; row++) {
                    int32_t at[2] = {row % BLOCK, row / BLOCK};
                    int64_t start = first[1] + at[0] + (int64_t)n * (first[2] + at[1]);
                    fill_row(cell->distance + first[0] + n * start, v, planes, candidates, count,
                             at);
                }
            }
    iso_release(candidates);
    iso_release(planes);
    return ISO_OK;
}

iso_status foam_fill(iso_lattice_cell *cell, const iso_lattice_options *options) {
    int32_t size = cell->size[0];
    iso_voronoi v;
    ISO_TRY(voronoi_make(&v, cell->repeat[0], size, JITTER, options->seed));
    iso_status status = options->pattern == ISO_LATTICE_FOAM_SHEET
                            ? fill_sheet(cell, &v)
                            : distance_from_segments(cell->distance, size, v.edge, v.edge_count);
    voronoi_free(&v);
    float step = (float)cell->repeat[0] / (float)size;
    for (int64_t i = 0; status == ISO_OK && i < (int64_t)size * size * size; i++)
        cell->distance[i] *= step;
    return status;
}

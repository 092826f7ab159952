#include "lattice/analysis.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/memory.h"

enum {
    IN_MATERIAL = 1,
    IN_PART = 2,
    IN_CORE = 4,
    IN_PIECE = 8,   /* material, swollen */
    PORE_LEAST = 8, /* voxels: a cube of two a side */
    ROWS_A_TASK = 8 /* so that taking a task costs nothing beside doing it */
};

/* Of the rows of one task; added up in their order, so that any number of threads gives the same
 * sums. */
typedef struct sums {
    int64_t part, material, core, core_material;
    double part_share; /* voxels of the border as far as they are in the part */
    double surface, pore_surface;
} sums;

typedef struct counting {
    const iso_body *body;
    iso_pool *pool;
    int32_t columns, rows, k;
    float *material[2]; /* of this plane and the one below: [columns rows] */
    float *part[2];
    uint8_t *voxel; /* of this plane */
    sums *sum;      /* [tasks] */
    int64_t tasks;
    sums total;
    iso_labels solids, airs, parts;
} counting;

static void counting_free(counting *c) {
    for (int i = 0; i < 2; i++) {
        iso_release(c->material[i]);
        iso_release(c->part[i]);
    }
    iso_release(c->voxel);
    iso_release(c->sum);
    labels_free(&c->solids);
    labels_free(&c->airs);
    labels_free(&c->parts);
}

static iso_status counting_new(counting *c, const iso_body *body, iso_pool *pool) {
    int32_t columns = body->size[0], rows = body->size[1], planes = body->size[2];
    int64_t plane = (int64_t)columns * rows;
    c->body = body, c->pool = pool;
    c->columns = columns, c->rows = rows;
    c->tasks = (rows + ROWS_A_TASK - 1) / ROWS_A_TASK;
    for (int i = 0; i < 2; i++) {
        ISO_TRY(ISO_ALLOCATE(c->material[i], plane));
        ISO_TRY(ISO_ALLOCATE(c->part[i], plane));
    }
    ISO_TRY(ISO_ALLOCATE(c->voxel, plane));
    ISO_TRY(ISO_ALLOCATE(c->sum, c->tasks));
    ISO_TRY(labels_begin(&c->solids, ISO_JOIN_FACES, columns, rows, planes));
    ISO_TRY(labels_begin(&c->airs, ISO_JOIN_FACES, columns, rows, planes));
    ISO_TRY(labels_begin(&c->parts, ISO_JOIN_CORNERS, columns, rows, planes));
    c->parts.keep_all = 1;
    return ISO_OK;
}

/* ---- a plane of voxels ---- */

static void classify(uint8_t *voxel, sums *sum, const float *material, const float *part,
                     int32_t count, const iso_body *body) {
    int64_t n[4] = {0, 0, 0, 0};
    float depth = (float)-body->skin, swell = (float)body->swell, each = (float)(1 / body->voxel);
    double share = 0;
    for (int32_t i = 0; i < count; i++) {
        share += fminf(1, fmaxf(0, 0.5f - part[i] * each));
        int in_part = part[i] <= 0, in_material = material[i] <= 0;
        int in_core = part[i] <= depth && in_part;
        voxel[i] = (uint8_t)(in_material * IN_MATERIAL + in_part * IN_PART + in_core * IN_CORE +
                             (material[i] <= swell && in_part) * IN_PIECE);
        n[0] += in_part, n[1] += in_material, n[2] += in_core, n[3] += in_core && in_material;
    }
    sum->part_share += share;
    sum->part += n[0], sum->material += n[1], sum->core += n[2], sum->core_material += n[3];
}

static iso_status sample_rows(void *payload, int64_t task, int worker) {
    counting *c = payload;
    const iso_body *body = c->body;
    int32_t last = (int32_t)(task + 1) * ROWS_A_TASK;
    sums *sum = &c->sum[task];
    *sum = (sums){0};
    for (int32_t j = (int32_t)task * ROWS_A_TASK; j < last && j < c->rows; j++) {
        int64_t at = (int64_t)j * c->columns;
        iso_body_row row = {
            .first = {body->min.x, body->min.y + j * body->voxel, body->min.z + c->k * body->voxel},
            .step = body->voxel,
            .count = c->columns,
            .j = j,
            .k = c->k};
        ISO_TRY(body->sample(body->payload, c->material[0] + at, c->part[0] + at, &row, worker));
        classify(c->voxel + at, sum, c->material[0] + at, c->part[0] + at, c->columns, body);
    }
    return ISO_OK;
}

/* A pair of neighbours with the surface between them. As many as v^2 |n_a| of them meet an area
 * along axis a, and a distance changes by v |n_a| from one to the next: so v |change| a pair adds
 * up to n_x^2 + n_y^2 + n_z^2 = 1 times the area, whatever its slope. */
static void cross(sums *sum, const float *material, const float *part, const float *other_material,
                  const float *other_part, int32_t count, double voxel) {
    for (int32_t i = 0; i < count; i++) {
        double a = material[i], b = other_material[i];
        if ((a <= 0) == (b <= 0))
            continue;
        double change = fmin(fabs(a - b), voxel); /* where it isn't quite a distance */
        sum->surface += change;
        if ((a > 0 ? part[i] : other_part[i]) <= 0)
            sum->pore_surface += change;
    }
}

static iso_status cross_rows(void *payload, int64_t task, int worker) {
    counting *c = payload;
    (void)worker;
    int32_t last = (int32_t)(task + 1) * ROWS_A_TASK, columns = c->columns;
    sums *sum = &c->sum[task];
    double voxel = c->body->voxel;
    for (int32_t j = (int32_t)task * ROWS_A_TASK; j < last && j < c->rows; j++) {
        int64_t at = (int64_t)j * columns;
        const float *material = c->material[0] + at, *part = c->part[0] + at;
        cross(sum, material, part, material + 1, part + 1, columns - 1, voxel);
        if (j > 0)
            cross(sum, material, part, material - columns, part - columns, columns, voxel);
        if (c->k > 0)
            cross(sum, material, part, c->material[1] + at, c->part[1] + at, columns, voxel);
    }
    sum->surface *= voxel;
    sum->pore_surface *= voxel;
    return ISO_OK;
}

static void swap(float **a, float **b) {
    float *t = *a;
    *a = *b, *b = t;
}

static iso_status count_plane(counting *c) {
    swap(&c->material[0], &c->material[1]);
    swap(&c->part[0], &c->part[1]);
    ISO_TRY(iso_parallel_for(c->pool, c->tasks, sample_rows, c));
    ISO_TRY(iso_parallel_for(c->pool, c->tasks, cross_rows, c));
    for (int64_t t = 0; t < c->tasks; t++) {
        c->total.part_share += c->sum[t].part_share;
        c->total.part += c->sum[t].part, c->total.material += c->sum[t].material;
        c->total.core += c->sum[t].core, c->total.core_material += c->sum[t].core_material;
        c->total.surface += c->sum[t].surface, c->total.pore_surface += c->sum[t].pore_surface;
    }
    ISO_TRY(labels_plane(&c->parts, c->voxel, IN_PART, IN_PART, NULL));
    ISO_TRY(labels_plane(&c->solids, c->voxel, IN_PIECE, IN_PIECE, &c->parts.at));
    return labels_plane(&c->airs, c->voxel, IN_PIECE, 0, NULL);
}

/* ---- pieces ---- */

/* A body of the part keeps its largest piece: of equal ones, the one that comes first. */
static iso_status find_loose(iso_body_counts *counts, counting *c) {
    iso_labels *solids = &c->solids;
    int64_t *largest;
    ISO_TRY(ISO_ALLOCATE(largest, c->parts.count));
    for (int64_t i = 0; i < c->parts.count; i++)
        largest[i] = -1;
    for (int64_t i = 0; i < solids->done_count; i++) {
        iso_piece *piece = &solids->done[i];
        piece->owner = labels_find(&c->parts, piece->owner);
        int64_t *most = &largest[piece->owner];
        if (*most < 0 || solids->done[*most].voxels < piece->voxels)
            *most = i;
    }
    counts->kept = 0;
    for (int64_t i = 0; i < c->parts.count; i++) {
        if (largest[i] >= 0)
            solids->done[largest[i]].voxels = 0, counts->kept++; /* marked */
    }
    iso_release(largest);
    int64_t count = 0;
    for (int64_t i = 0; i < solids->done_count; i++)
        if (solids->done[i].voxels > 0)
            solids->done[count++] = solids->done[i];
    counts->loose = solids->done;
    counts->loose_count = count;
    counts->unlisted = solids->lost, counts->unlisted_voxels = solids->lost_voxels;
    solids->done = NULL;
    return ISO_OK;
}

/* Pores of a few voxels aren't told from what voxels make of sharp corners. */
static void find_closed(iso_body_counts *counts, const iso_labels *airs) {
    bool lost = airs->smallest > PORE_LEAST;
    counts->closed_pores = lost ? airs->lost_inner : 0;
    counts->closed_voxels = lost ? airs->lost_inner_voxels : 0;
    for (int64_t i = 0; i < airs->done_count; i++) {
        if (airs->done[i].on_border || airs->done[i].voxels < PORE_LEAST)
            continue;
        counts->closed_pores++;
        counts->closed_voxels += airs->done[i].voxels;
    }
}

static iso_status finish(iso_body_counts *counts, counting *c) {
    ISO_TRY(labels_end(&c->solids));
    ISO_TRY(labels_end(&c->airs));
    *counts = (iso_body_counts){.part = c->total.part,
                                .part_share = c->total.part_share,
                                .material = c->total.material,
                                .core = c->total.core,
                                .core_material = c->total.core_material,
                                .surface = c->total.surface,
                                .pore_surface = c->total.pore_surface,
                                .pieces = c->solids.done_count + c->solids.lost};
    find_closed(counts, &c->airs);
    return find_loose(counts, c);
}

iso_status body_count(iso_body_counts *counts, const iso_body *body, iso_pool *pool,
                      body_progress *progress, void *payload) {
    counting c = {0};
    iso_status status = counting_new(&c, body, pool);
    for (; status == ISO_OK && c.k < body->size[2]; c.k++) {
        status = count_plane(&c);
        if (progress)
            progress(payload, (double)c.k / body->size[2]);
    }
    if (status == ISO_OK)
        status = finish(counts, &c);
    counting_free(&c);
    return status;
}

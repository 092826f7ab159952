/* A porous part as a mesh or a volume. */
#include <math.h>

#include "base/memory.h"
#include "lattice/part.h"
#include "mesh/stl_write.h"

/* Blocks come along x: rows of whole width are sampled ahead for all of them, by all threads. */
typedef struct strip {
    iso_porous *porous;
    int32_t j, k;           /* first row and plane; -1: none yet */
    float *material, *part; /* [8 8 columns] */
} strip;

static iso_status sample_row(void *payload, int64_t task, int worker) {
    strip *s = payload;
    const iso_body *b = &s->porous->body;
    int32_t j = s->j + (int32_t)task % ISO_VOLUME_BLOCK,
            k = s->k + (int32_t)task / ISO_VOLUME_BLOCK;
    int64_t at = task * b->size[0];
    const iso_body_row row = {.first = {b->min.x, b->min.y + j * b->voxel, b->min.z + k * b->voxel},
                              .step = b->voxel,
                              .count = b->size[0],
                              .j = j,
                              .k = k};
    return part_sample(s->porous, s->material + at, s->part + at, &row, worker);
}

static int32_t index_of(double at, double min, double voxel) {
    return (int32_t)floor((at - min) / voxel + 0.5);
}

static iso_status fill_block(void *payload, float *value, iso_vec3 corner) {
    enum { N = ISO_VOLUME_BLOCK };
    strip *s = payload;
    const iso_body *b = &s->porous->body;
    int32_t i = index_of(corner.x, b->min.x, b->voxel), j = index_of(corner.y, b->min.y, b->voxel),
            k = index_of(corner.z, b->min.z, b->voxel);
    if (i < 0 || j < 0 || k < 0 || i + N > b->size[0] || j + N > b->size[1] || k + N > b->size[2]) {
        for (int32_t n = 0; n < N * N * N; n++)
            value[n] = (float)(N * b->voxel); /* far outside the part */
        return ISO_OK;
    }
    if (s->j != j || s->k != k) {
        s->j = j, s->k = k;
        ISO_TRY(iso_parallel_for(s->porous->pool, (int64_t)N * N, sample_row, s));
        part_progress(s->porous, (double)k / b->size[2]);
    }
    for (int32_t row = 0; row < N * N; row++)
        memcpy(value + N * row, s->material + i + (int64_t)b->size[0] * row, N * sizeof *value);
    return ISO_OK;
}

static iso_status build(iso_volume **volume, iso_porous *p, iso_volume_kind kind) {
    strip s = {.porous = p, .j = -1, .k = -1};
    int64_t points = (int64_t)ISO_VOLUME_BLOCK * ISO_VOLUME_BLOCK * p->body.size[0];
    const iso_body *b = &p->body;
    iso_vec3 max = {b->min.x + (b->size[0] - 1) * b->voxel, b->min.y + (b->size[1] - 1) * b->voxel,
                    b->min.z + (b->size[2] - 1) * b->voxel};
    iso_volume_plan plan = {.min = b->min,
                            .max = max,
                            .voxel = b->voxel,
                            .kind = kind,
                            .name = "lattice",
                            .fill = fill_block,
                            .payload = &s};
    p->stage = "volume";
    p->stage_from = 0.5, p->stage_to = 0.9;
    iso_status status = ISO_ALLOCATE(s.material, points);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(s.part, points);
    if (status == ISO_OK)
        status = volume_build(volume, &plan);
    iso_release(s.material);
    iso_release(s.part);
    return status;
}

iso_status iso_porous_write_vdb(iso_porous_kind *kind, iso_porous *porous, const char *path) {
    iso_volume *volume;
    *kind = porous->kind;
    ISO_TRY(
        build(&volume, porous, *kind == ISO_POROUS_MASK ? ISO_VOLUME_SOLID : ISO_VOLUME_DISTANCE));
    porous->stage = "write";
    part_progress(porous, 1);
    iso_status status = volume_write(volume, path);
    volume_free(volume);
    return status;
}

iso_status iso_porous_write_stl(int64_t *triangles, iso_porous *porous, const char *path) {
    iso_volume *volume;
    float *triangle;
    ISO_TRY(build(&volume, porous, ISO_VOLUME_DISTANCE));
    porous->stage = "mesh";
    part_progress(porous, 1);
    iso_status status = volume_surface(&triangle, triangles, volume, 0);
    volume_free(volume);
    ISO_TRY(status);
    if (*triangles == 0)
        status = iso_fail(ISO_OUTSIDE, "nothing of the lattice is within the part");
    else
        status = stl_write(path, "lattice, made by isoslice", triangle, *triangles);
    iso_release(triangle);
    return status;
}

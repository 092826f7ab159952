/* The voxels of loose pieces: found again from a seed, within the piece's own box. The count keeps
 * no labels but a plane's, and pieces that hold to nothing are small. */
#include "lattice/analysis.h"

#include "base/memory.h"
#include "base/sort.h"

enum { VOID, MATERIAL, TAKEN };

typedef struct search {
    const iso_body *body;
    const iso_piece *piece;
    int32_t size[3];
    uint8_t *voxel;
    float *material, *part;
    int32_t *stack;
    iso_lattice_run *run;
    int64_t voxel_capacity, row_capacity, part_capacity, stack_capacity, run_capacity;
    int64_t stacked, run_count;
} search;

static int is_before(const iso_lattice_run *a, const iso_lattice_run *b) {
    if (a->z != b->z)
        return a->z < b->z;
    return a->y != b->y ? a->y < b->y : a->first < b->first;
}

ISO_SORT(sort_runs, iso_lattice_run, is_before)

static iso_status sample_box(search *s) {
    const iso_body *body = s->body;
    const int32_t *min = s->piece->min;
    ISO_TRY(ISO_GROW(s->material, s->row_capacity, s->size[0]));
    ISO_TRY(ISO_GROW(s->part, s->part_capacity, s->size[0]));
    for (int32_t k = 0; k < s->size[2]; k++)
        for (int32_t j = 0; j < s->size[1]; j++) {
            uint8_t *voxel = s->voxel + s->size[0] * ((int64_t)j + (int64_t)s->size[1] * k);
            iso_body_row row = {.first = {body->min.x + min[0] * body->voxel,
                                          body->min.y + (min[1] + j) * body->voxel,
                                          body->min.z + (min[2] + k) * body->voxel},
                                .step = body->voxel,
                                .count = s->size[0],
                                .j = -1,
                                .k = -1};
            ISO_TRY(body->sample(body->payload, s->material, s->part, &row, 0));
            for (int32_t i = 0; i < s->size[0]; i++)
                voxel[i] =
                    s->material[i] <= (float)body->swell && s->part[i] <= 0 ? MATERIAL : VOID;
        }
    return ISO_OK;
}

static iso_status take(search *s, int64_t at) {
    if (s->voxel[at] != MATERIAL)
        return ISO_OK;
    s->voxel[at] = TAKEN;
    ISO_TRY(ISO_GROW(s->stack, s->stack_capacity, s->stacked + 1));
    s->stack[s->stacked++] = (int32_t)at;
    return ISO_OK;
}

/* Those that share a face, within the box. */
static iso_status take_neighbours(search *s, int32_t at) {
    int32_t nx = s->size[0], ny = s->size[1];
    int32_t x = at % nx, y = at / nx % ny, z = at / nx / ny;
    int64_t plane = (int64_t)nx * ny;
    if (x > 0)
        ISO_TRY(take(s, at - 1));
    if (x + 1 < nx)
        ISO_TRY(take(s, at + 1));
    if (y > 0)
        ISO_TRY(take(s, at - nx));
    if (y + 1 < ny)
        ISO_TRY(take(s, at + nx));
    if (z > 0)
        ISO_TRY(take(s, at - plane));
    return z + 1 < s->size[2] ? take(s, at + plane) : ISO_OK;
}

static iso_status flood(search *s) {
    const iso_piece *piece = s->piece;
    int64_t seed = (int64_t)(piece->seed[0] - piece->min[0]) +
                   s->size[0] * ((int64_t)(piece->seed[1] - piece->min[1]) +
                                 (int64_t)s->size[1] * (piece->seed[2] - piece->min[2]));
    s->stacked = 0;
    ISO_TRY(take(s, seed));
    while (s->stacked > 0)
        ISO_TRY(take_neighbours(s, s->stack[--s->stacked]));
    return ISO_OK;
}

static iso_status add_runs(search *s) {
    const int32_t *min = s->piece->min;
    for (int32_t k = 0; k < s->size[2]; k++)
        for (int32_t j = 0; j < s->size[1]; j++) {
            const uint8_t *voxel = s->voxel + s->size[0] * ((int64_t)j + (int64_t)s->size[1] * k);
            for (int32_t i = 0; i < s->size[0]; i++) {
                if (voxel[i] != TAKEN)
                    continue;
                int32_t first = i;
                while (i < s->size[0] && voxel[i] == TAKEN)
                    i++;
                ISO_TRY(ISO_GROW(s->run, s->run_capacity, s->run_count + 1));
                s->run[s->run_count++] =
                    (iso_lattice_run){min[2] + k, min[1] + j, min[0] + first, min[0] + i};
            }
        }
    return ISO_OK;
}

static iso_status find_pieces(search *s, int64_t *left, const iso_body_counts *counts,
                              int64_t most) {
    for (int64_t i = 0; i < counts->loose_count; i++) {
        const iso_piece *piece = s->piece = &counts->loose[i];
        for (int axis = 0; axis < 3; axis++)
            s->size[axis] = piece->max[axis] - piece->min[axis] + 1;
        int64_t box = (int64_t)s->size[0] * s->size[1];
        box = box > most / s->size[2] ? most + 1 : box * s->size[2];
        if (box > most || box > INT32_MAX / 8) {
            ++*left;
            continue;
        }
        most -= box;
        ISO_TRY(ISO_GROW(s->voxel, s->voxel_capacity, box));
        ISO_TRY(sample_box(s));
        ISO_TRY(flood(s));
        ISO_TRY(add_runs(s));
    }
    return ISO_OK;
}

iso_status body_loose_runs(iso_lattice_run **run, int64_t *count, int64_t *left,
                           const iso_body *body, const iso_body_counts *counts, int64_t most) {
    search s = {.body = body};
    *left = counts->unlisted;
    iso_status status = find_pieces(&s, left, counts, most);
    sort_runs(s.run, s.run_count);
    iso_release(s.voxel);
    iso_release(s.material);
    iso_release(s.part);
    iso_release(s.stack);
    if (status != ISO_OK) {
        iso_release(s.run);
        return status;
    }
    *run = s.run;
    *count = s.run_count;
    return ISO_OK;
}

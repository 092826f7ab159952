#include "solid/volume.h"

#include "base/memory.h"
#include "base/output.h"
#include "solid/distance.h"
#include "solid/volume_table.h"

/* Indices stay well within 2^31 with it, and so does a box of blocks. */
#define VOXELS_MAX 1e8
#define BLOCKS_MAX 2e9

enum { BAND = 3 }; /* voxels, on both sides of a level set */

struct iso_volume {
    const volume_table *table;
    volume_grid *grid;
    volume_facts facts;
};

static iso_status failed(iso_status status, const char *message) {
    return iso_fail(status, "the volume: %s", message);
}

void volume_free(iso_volume *volume) {
    if (!volume)
        return;
    if (volume->grid)
        volume->table->grid_free(volume->grid);
    iso_release(volume);
}

static iso_status volume_new(iso_volume **volume) {
    *volume = NULL;
    const void *table;
    ISO_TRY(module_open(&table, ISO_MODULE_VOLUME));
    iso_volume *made = iso_allocate(sizeof *made);
    if (!made)
        return iso_no_memory(sizeof *made);
    *made = (iso_volume){.table = table};
    *volume = made;
    return ISO_OK;
}

/* Hand out what is ready, or take it apart. */
static iso_status deliver(iso_volume **volume, iso_volume *made, iso_status status) {
    char message[VOLUME_MESSAGE] = "";
    if (status == ISO_OK) {
        status = made->table->grid_facts(&made->facts, made->grid, message);
        if (status != ISO_OK)
            status = failed(status, message);
    }
    if (status == ISO_OK)
        *volume = made;
    else
        volume_free(made);
    return status;
}

void volume_info(iso_volume_info *info, const iso_volume *volume) {
    const volume_facts *facts = &volume->facts;
    double min[3], max[3];
    for (int i = 0; i < 3; i++) {
        min[i] = facts->origin[i] + facts->voxel * facts->min[i];
        max[i] = facts->origin[i] + facts->voxel * facts->max[i];
    }
    *info = (iso_volume_info){.min = {min[0], min[1], min[2]},
                              .max = {max[0], max[1], max[2]},
                              .voxel = facts->voxel,
                              .background = facts->background,
                              .active = facts->active,
                              .bytes = facts->bytes,
                              .is_distance = facts->is_distance};
}

/* The box in voxels, or ISO_BAD_CONFIG. */
static iso_status check_box(const iso_vec3 *min, const iso_vec3 *max, double voxel) {
    const double low[3] = {min->x, min->y, min->z}, high[3] = {max->x, max->y, max->z};
    if (!(voxel > 0 && voxel < 1e9))
        return iso_fail(ISO_BAD_CONFIG, "voxels of %g mm: their edge must be larger than 0", voxel);
    double blocks = 1;
    for (int i = 0; i < 3; i++) {
        if (!(low[i] <= high[i]))
            return iso_fail(ISO_BAD_CONFIG, "the box of a volume is empty");
        if (!(low[i] / voxel > -VOXELS_MAX && high[i] / voxel < VOXELS_MAX))
            return iso_fail(ISO_BAD_CONFIG,
                            "voxels of %g mm are too fine for a box from %g to %g mm", voxel,
                            low[i], high[i]);
        blocks *= (high[i] - low[i]) / voxel / VOLUME_EDGE + 1;
    }
    if (blocks > BLOCKS_MAX)
        return iso_fail(ISO_BAD_CONFIG,
                        "voxels of %g mm make %.3g of them; %.3g are the most: take larger ones",
                        voxel, blocks * VOLUME_CELLS, BLOCKS_MAX * VOLUME_CELLS);
    return ISO_OK;
}

// Distances of a surface

static iso_status put_block(void *payload, const int32_t first[3], const float *value) {
    const iso_volume *volume = payload;
    char message[VOLUME_MESSAGE] = "";
    iso_status status = volume->table->grid_block(volume->grid, first, value, message);
    return status == ISO_OK ? ISO_OK : failed(status, message);
}

static iso_status put_full(void *payload, const int32_t first[3]) {
    const iso_volume *volume = payload;
    char message[VOLUME_MESSAGE] = "";
    iso_status status = volume->table->grid_full(volume->grid, first, message);
    return status == ISO_OK ? ISO_OK : failed(status, message);
}

static iso_status start(iso_volume *volume, const volume_form *form) {
    char message[VOLUME_MESSAGE] = "";
    iso_status status = volume->table->grid_new(&volume->grid, form, message);
    return status == ISO_OK ? ISO_OK : failed(status, message);
}

static iso_status finish(iso_volume *volume) {
    char message[VOLUME_MESSAGE] = "";
    iso_status status = volume->table->grid_finish(volume->grid, message);
    return status == ISO_OK ? ISO_OK : failed(status, message);
}

static iso_status check_surface(const iso_volume_surface *surface) {
    if (!(surface->outer > 0 && surface->inner > 0))
        return iso_fail(ISO_BAD_CONFIG, "distances must be wanted for more than 0 mm");
    for (int64_t i = 0; i < 3 * surface->count; i++) {
        const iso_vec3 *c = &surface->corner[i];
        if (!(c->x - c->x == 0 && c->y - c->y == 0 && c->z - c->z == 0))
            return iso_fail(ISO_BAD_CONFIG, "corner %d of triangle %lld is nowhere", (int)(i % 3),
                            (long long)(i / 3));
    }
    iso_vec3 min = {0, 0, 0}, max = {0, 0, 0};
    distance_box(&min, &max, surface);
    return check_box(&min, &max, surface->voxel);
}

static iso_status fill_from_surface(iso_volume *volume, const iso_volume_surface *surface) {
    const volume_form form = {.voxel = surface->voxel,
                              .outside = (float)surface->outer,
                              .inside = (float)-surface->inner,
                              .is_distance = 1,
                              .name = "distance"};
    const distance_output output = {put_block, put_full, volume};
    ISO_TRY(start(volume, &form));
    ISO_TRY(distance_fill(surface, &output));
    return finish(volume);
}

iso_status volume_from_surface(iso_volume **volume, const iso_volume_surface *surface) {
    *volume = NULL;
    ISO_TRY(check_surface(surface));
    iso_volume *made;
    ISO_TRY(volume_new(&made));
    return deliver(volume, made, fill_from_surface(made, surface));
}

// A callback's values

/* Voxel middles this far beyond the box, in voxels, are still on its face: rounding. */
#define ON_FACE 1e-6

/* The larger of the value and the distance to the plan's box, which is exact beside its faces and
 * too small beyond its edges. */
static void cut_by_box(float *value, const iso_volume_plan *plan, iso_vec3 corner) {
    const double low[3] = {plan->min.x, plan->min.y, plan->min.z};
    const double high[3] = {plan->max.x, plan->max.y, plan->max.z};
    const double first[3] = {corner.x, corner.y, corner.z};
    double beyond[3][VOLUME_EDGE];
    for (int axis = 0; axis < 3; axis++)
        for (int i = 0; i < VOLUME_EDGE; i++) {
            double at = first[axis] + plan->voxel * i, below = low[axis] - at;
            double above = at - high[axis], most = above > below ? above : below;
            beyond[axis][i] = most > 0 && most < ON_FACE * plan->voxel ? 0 : most;
        }
    for (int z = 0; z < VOLUME_EDGE; z++)
        for (int y = 0; y < VOLUME_EDGE; y++) {
            double wall = beyond[1][y] > beyond[2][z] ? beyond[1][y] : beyond[2][z];
            float *row = value + VOLUME_EDGE * (y + VOLUME_EDGE * z);
            for (int x = 0; x < VOLUME_EDGE; x++) {
                float distance = (float)(beyond[0][x] > wall ? beyond[0][x] : wall);
                if (row[x] < distance)
                    row[x] = distance;
            }
        }
}

/* Blocks from 0 on along each axis; only those near the box's faces are cut. */
typedef struct block_range {
    int32_t count[3];
    int32_t clear; /* as many at each end are not clear of the faces */
} block_range;

static void find_range(block_range *range, const iso_volume_plan *plan) {
    const double span[3] = {plan->max.x - plan->min.x, plan->max.y - plan->min.y,
                            plan->max.z - plan->min.z};
    for (int i = 0; i < 3; i++)
        range->count[i] = (int32_t)((span[i] / plan->voxel + ON_FACE) / VOLUME_EDGE) + 1;
    /* the last block may have its face before its first voxel's band is over */
    range->clear = plan->kind == ISO_VOLUME_DISTANCE ? 2 : 1;
}

static iso_status build_block(iso_volume *volume, const iso_volume_plan *plan,
                              const block_range *range, const int32_t block[3]) {
    float value[VOLUME_CELLS];
    const int32_t first[3] = {VOLUME_EDGE * block[0], VOLUME_EDGE * block[1],
                              VOLUME_EDGE * block[2]};
    const iso_vec3 corner = {plan->min.x + plan->voxel * first[0],
                             plan->min.y + plan->voxel * first[1],
                             plan->min.z + plan->voxel * first[2]};
    ISO_TRY(plan->fill(plan->payload, value, corner));
    int clear = 1;
    for (int i = 0; i < 3; i++)
        clear &= block[i] >= range->clear && block[i] < range->count[i] - range->clear;
    if (!clear)
        cut_by_box(value, plan, corner);
    return put_block(volume, first, value);
}

static iso_status fill_from_plan(iso_volume *volume, const iso_volume_plan *plan) {
    float band = (float)(BAND * plan->voxel);
    const volume_form form = {.origin = {plan->min.x, plan->min.y, plan->min.z},
                              .voxel = plan->voxel,
                              .outside = band,
                              .inside = -band,
                              .is_mask = plan->kind == ISO_VOLUME_SOLID,
                              .is_distance = plan->kind == ISO_VOLUME_DISTANCE,
                              .name = plan->name};
    ISO_TRY(start(volume, &form));
    block_range range;
    find_range(&range, plan);
    int32_t block[3];
    for (block[2] = 0; block[2] < range.count[2]; block[2]++)
        for (block[1] = 0; block[1] < range.count[1]; block[1]++)
            for (block[0] = 0; block[0] < range.count[0]; block[0]++)
                ISO_TRY(build_block(volume, plan, &range, block));
    return finish(volume);
}

iso_status volume_build(iso_volume **volume, const iso_volume_plan *plan) {
    *volume = NULL;
    ISO_TRY(check_box(&plan->min, &plan->max, plan->voxel));
    iso_volume *made;
    ISO_TRY(volume_new(&made));
    return deliver(volume, made, fill_from_plan(made, plan));
}

// Files

iso_status volume_read(iso_volume **volume, const char *path, const char *name) {
    *volume = NULL;
    iso_volume *made;
    ISO_TRY(volume_new(&made));
    char message[VOLUME_MESSAGE] = "";
    iso_status status = made->table->grid_read(&made->grid, path, name, message);
    if (status != ISO_OK)
        status = iso_fail(status, "%s: %s", path, message);
    return deliver(volume, made, status);
}

static int write_bytes(void *payload, int64_t offset, const void *bytes, size_t size) {
    iso_output *output = payload;
    iso_status status = offset == iso_output_size(output)
                            ? iso_output_write(output, bytes, size)
                            : iso_output_patch(output, offset, bytes, size);
    return status != ISO_OK;
}

iso_status volume_write(const iso_volume *volume, const char *path) {
    iso_output *output;
    ISO_TRY(iso_output_open(&output, path));
    const volume_sink sink = {write_bytes, output};
    char message[VOLUME_MESSAGE] = "";
    iso_status status = volume->table->grid_write(volume->grid, &sink, message);
    if (status == ISO_OK)
        return iso_output_commit(output);
    if (message[0])
        status = iso_fail(status, "%s: can't be written: %s", path, message);
    iso_output_abandon(output);
    return status;
}

// Values and surface

iso_status volume_sample(double *value, const iso_volume *volume, const iso_vec3 *point,
                         int64_t count) {
    char message[VOLUME_MESSAGE] = "";
    iso_status status = volume->table->grid_sample(value, volume->grid, &point->x, count, message);
    return status == ISO_OK ? ISO_OK : failed(status, message);
}

iso_status volume_surface(float **triangle, int64_t *count, const iso_volume *volume,
                          double level) {
    *triangle = NULL;
    *count = 0;
    char message[VOLUME_MESSAGE] = "";
    volume_triangles triangles = {.allocate = iso_allocate};
    iso_status status = volume->table->grid_surface(&triangles, volume->grid, level, message);
    if (status != ISO_OK)
        return failed(status, message);
    *triangle = triangles.corner;
    *count = triangles.count;
    return ISO_OK;
}

#include <isoslice/solid.h>

#include "base/memory.h"
#include "base/random.h"
#include "solid/grid.h"
#include "solid/inside.h"
#include "solid/tree.h"

/* The tree works with floats: steps rounded to them, which keeps their order, and products with the
 * reciprocal of the ray's direction, 1 or about 1e18. Each of its roundings, and ours, shifts a
 * plane of a box by at most 2^-23 of a coordinate, which is 2^7 steps. Boxes that are larger by
 * 2^11 steps on all sides are therefore met by every ray that meets the triangle in truth: across
 * the ray the origin is at least a step within both planes, whose distances are then beyond 1e17 to
 * both sides, and along it the far plane is ahead of the origin. What else is met does no harm. */
enum { BOX_MARGIN = 1 << 11 };

enum { CHUNK = 128, FOUND_USUAL = 4096 };

struct iso_solid {
    const solid_table *table;
    solid_tree *tree; /* NULL if there are no triangles */
    solid_grid grid;
    int32_t count;
    int32_t
        *corner; /* [9 count]: a triangle is read whole or not at all, so it lies in one place */
};

static void copy_corners(iso_solid *solid, const iso_mesh *mesh, int32_t count) {
    int32_t *to = solid->corner;
    for (int32_t m = 0; m < count; m++)
        for (int64_t dart = 0; dart < 3 * (int64_t)mesh[m].triangle_count; dart++, to += 3)
            grid_round(to, &solid->grid, &mesh[m].position[mesh[m].origin[dart]]);
}

static void make_boxes(float *box, const int32_t *corner, int32_t count) {
    for (int64_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) {
            int32_t a = corner[9 * i + k], b = corner[9 * i + 3 + k], c = corner[9 * i + 6 + k];
            int32_t least = a < b ? a : b, most = a < b ? b : a;
            least = c < least ? c : least;
            most = c > most ? c : most;
            box[6 * i + k] = (float)(least - BOX_MARGIN);
            box[6 * i + 3 + k] = (float)(most + BOX_MARGIN);
        }
    }
}

static iso_status tree_failed(iso_status status) {
    if (status == ISO_NO_MEMORY)
        return iso_fail(status, "not enough memory for Embree's tree");
    if (status == ISO_BAD_CONFIG)
        return iso_fail(status, "Embree does not run on this processor");
    return iso_fail(ISO_BUG, "Embree refused a call");
}

static iso_status build(iso_solid *solid, const iso_mesh *mesh, int32_t count) {
    grid_choose(&solid->grid, mesh, count);
    ISO_TRY(ISO_ALLOCATE(solid->corner, 9 * (int64_t)solid->count));
    copy_corners(solid, mesh, count);
    if (solid->count == 0)
        return ISO_OK;
    float *box;
    ISO_TRY(ISO_ALLOCATE(box, 6 * (int64_t)solid->count));
    make_boxes(box, solid->corner, solid->count);
    iso_status status = solid->table->tree_new(&solid->tree, box, solid->count);
    iso_release(box);
    return status == ISO_OK ? ISO_OK : tree_failed(status);
}

iso_status iso_solid_new(iso_solid **solid, const iso_mesh *mesh, int32_t count) {
    *solid = NULL;
    const void *table;
    ISO_TRY(module_open(&table, ISO_MODULE_SOLID));
    int32_t triangles;
    ISO_TRY(grid_count(&triangles, mesh, count));
    iso_solid *made;
    ISO_TRY(ISO_ALLOCATE(made, 1));
    *made = (iso_solid){.table = table, .count = triangles};
    iso_status status = build(made, mesh, count);
    if (status != ISO_OK) {
        iso_solid_free(made);
        return status;
    }
    *solid = made;
    return ISO_OK;
}

void iso_solid_free(iso_solid *solid) {
    if (!solid)
        return;
    if (solid->tree)
        solid->table->tree_free(solid->tree);
    iso_release(solid->corner);
    iso_release(solid);
}

/* Points within the box on their way through the tree. `direction` is for the current turn. */
typedef struct point_chunk {
    int32_t count;
    int32_t index[CHUNK]; /* in the caller's arrays, from the chunk's first point on */
    int32_t point[CHUNK][3];
    float origin[3 * CHUNK];
    uint8_t direction[CHUNK];
    int32_t first[CHUNK + 1];
    int32_t *found;
    int32_t capacity;
    int32_t usual[FOUND_USUAL];
} point_chunk;

static void load(point_chunk *chunk, const iso_solid *solid, const iso_vec3 *point, int32_t count) {
    chunk->count = 0;
    for (int32_t i = 0; i < count; i++) {
        int32_t *p = chunk->point[chunk->count];
        if (!grid_place(p, &solid->grid, &point[i]))
            continue;
        for (int k = 0; k < 3; k++)
            chunk->origin[3 * chunk->count + k] = (float)p[k];
        chunk->index[chunk->count++] = i;
    }
}

/* Towards the nearest side of the box there is least to be met, mostly. */
static int shortest_way(const iso_solid *solid, const int32_t point[3]) {
    int best = 0;
    int64_t least = INT64_MAX;
    for (int k = 0; k < INSIDE_DIRECTIONS; k++) {
        int64_t way = k & 1 ? (int64_t)point[k >> 1] - solid->grid.min[k >> 1]
                            : (int64_t)solid->grid.max[k >> 1] - point[k >> 1];
        if (way < least) {
            least = way;
            best = k;
        }
    }
    return best;
}

/* Ask the tree for as many points from `from` on as it has room for; *done of them were answered.
 */
static iso_status find(point_chunk *chunk, int32_t *done, const iso_solid *solid, int32_t from) {
    for (;;) {
        solid_rays rays = {.origin = chunk->origin + 3 * from,
                           .direction = chunk->direction + from,
                           .count = chunk->count - from,
                           .capacity = chunk->capacity};
        iso_status status =
            solid->table->tree_rays(chunk->found, chunk->first, done, solid->tree, &rays);
        if (status != ISO_OK)
            return tree_failed(status);
        if (*done > 0)
            return ISO_OK;
        if (chunk->first[1] <= chunk->capacity)
            return tree_failed(ISO_BUG);
        int32_t *more;
        ISO_TRY(ISO_ALLOCATE(more, chunk->first[1]));
        if (chunk->found != chunk->usual)
            iso_release(chunk->found);
        chunk->found = more;
        chunk->capacity = chunk->first[1];
    }
}

/* Winding numbers of the chunk's points along their directions. */
static iso_status look(int32_t *winding, uint8_t *on_surface, const iso_solid *solid,
                       point_chunk *chunk) {
    for (int32_t from = 0, done; from < chunk->count; from += done) {
        ISO_TRY(find(chunk, &done, solid, from));
        for (int32_t i = 0; i < done; i++) {
            const int32_t *point = chunk->point[from + i], *found = chunk->found + chunk->first[i];
            int32_t count = chunk->first[i + 1] - chunk->first[i], sum = 0;
            int direction = chunk->direction[from + i], on = 0;
            for (int32_t j = 0; j < count; j++)
                sum += inside_crossing(&solid->corner[9 * (int64_t)found[j]], point, direction);
            for (int32_t j = 0; on_surface && !on && j < count; j++)
                on = inside_touches(&solid->corner[9 * (int64_t)found[j]], point);
            winding[from + i] = sum;
            if (on_surface)
                on_surface[from + i] = (uint8_t)on;
        }
    }
    return ISO_OK;
}

/* All six in an order that the seed gives (Fisher and Yates). */
static void shuffle(int directions[INSIDE_DIRECTIONS], uint64_t seed) {
    for (int k = 0; k < INSIDE_DIRECTIONS; k++)
        directions[k] = k;
    for (int k = INSIDE_DIRECTIONS - 1; k > 0; k--) {
        int other = (int)(random_next(&seed) % (uint64_t)(k + 1)), kept = directions[k];
        directions[k] = directions[other];
        directions[other] = kept;
    }
}

static iso_status disagree(const iso_vec3 *point, int32_t first, int32_t other) {
    return iso_fail(ISO_BUG,
                    "the surface winds %d or %d times around x %g y %g z %g, by the direction that "
                    "it is seen from: it is not closed",
                    first, other, point->x, point->y, point->z);
}

/* directions NULL: the shortest way of each point. */
static iso_status run(point_chunk *chunk, int32_t *winding, uint8_t *on_surface,
                      const iso_solid *solid, const iso_vec3 *point, const int *directions,
                      int32_t turns) {
    int32_t found[CHUNK];
    uint8_t on[CHUNK];
    for (int32_t turn = 0; turn < turns; turn++) {
        for (int32_t i = 0; i < chunk->count; i++)
            chunk->direction[i] =
                (uint8_t)(directions ? directions[turn] : shortest_way(solid, chunk->point[i]));
        ISO_TRY(look(found, on_surface && turn == 0 ? on : NULL, solid, chunk));
        for (int32_t i = 0; i < chunk->count; i++) {
            int32_t to = chunk->index[i];
            if (turn > 0 && winding[to] != found[i])
                return disagree(&point[to], winding[to], found[i]);
            winding[to] = found[i];
            if (on_surface && turn == 0)
                on_surface[to] = on[i];
        }
    }
    return ISO_OK;
}

iso_status iso_solid_winding(int32_t *winding, uint8_t *on_surface, const iso_solid *solid,
                             const iso_vec3 *point, int64_t count,
                             const iso_winding_options *options) {
    int directions[INSIDE_DIRECTIONS];
    int32_t turns = options ? options->directions : 1;
    if (turns < 1 || turns > INSIDE_DIRECTIONS)
        return iso_fail(ISO_USAGE, "%d directions asked for, not 1 to %d", turns,
                        INSIDE_DIRECTIONS);
    if (options)
        shuffle(directions, options->seed);
    memset(winding, 0, (size_t)count * sizeof *winding);
    if (on_surface)
        memset(on_surface, 0, (size_t)count);
    point_chunk chunk;
    chunk.found = chunk.usual;
    chunk.capacity = FOUND_USUAL;
    iso_status status = ISO_OK;
    for (int64_t from = 0; solid->tree && from < count && status == ISO_OK; from += CHUNK) {
        load(&chunk, solid, point + from, (int32_t)(count - from < CHUNK ? count - from : CHUNK));
        status = run(&chunk, winding + from, on_surface ? on_surface + from : NULL, solid,
                     point + from, options ? directions : NULL, turns);
    }
    if (chunk.found != chunk.usual)
        iso_release(chunk.found);
    return status;
}

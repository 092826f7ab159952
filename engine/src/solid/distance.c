/* From the box of everything down to one voxel, always in two, with the distance from the middle to
 * the nearest triangle: what is farther off than wanted is left at once, and along the voxels of a
 * block each one's nearest triangle is the next one's first guess.
 *
 * A box that the surface stays clear of is on one side of it, so one question tells the sign of
 * all. A block that it passes through is taken apart: no surface comes between two voxels whose
 * distances add up to more than what they are apart, and only one voxel is asked about of those
 * that hang together so. */
#include "solid/distance.h"

#include <math.h>
#include <stdbool.h>

#include "base/memory.h"
#include "solid/closest.h"
#include "solid/enclosed.h"
#include "solid/volume_table.h"

enum { EDGE = VOLUME_EDGE, CELLS = VOLUME_CELLS, WAITING_MAX = 64, FEW_MAX = 40 };

typedef enum side { UNKNOWN, OUTSIDE, INSIDE } side;

/* A block that the surface passes through; its signs wait for answers. */
typedef struct waiting_block {
    int32_t first[3];
    float value[CELLS];
    uint16_t root[CELLS];    /* of the voxels that it hangs together with */
    int32_t question[CELLS]; /* of roots */
} waiting_block;

typedef struct walk {
    const iso_volume_surface *surface;
    const distance_output *output;
    iso_arena *arena;
    iso_closest *tree;
    int32_t nearest;        /* triangle of the last point: the first guess at the next one */
    waiting_block *waiting; /* [WAITING_MAX] */
    iso_vec3 *question;     /* [WAITING_MAX CELLS] */
    uint8_t *answer;
    int32_t waiting_count, question_count;
    volume_inside *inside;
    void *payload;
} walk;

static double limit_of(const walk *w, side where) {
    double inner = w->surface->inner, outer = w->surface->outer;
    if (where == UNKNOWN)
        return inner > outer ? inner : outer;
    return where == INSIDE ? inner : outer;
}

/* A cube of voxels within a block; `limit`: no more is wanted. */
typedef struct cube {
    float *value; /* of the block */
    double limit;
    int32_t first[3], size;
} cube;

static float *place_of(const cube *c, int x, int y, int z) {
    return c->value + ((c->first[0] & 7) + x) +
           EDGE * (((c->first[1] & 7) + y) + EDGE * ((c->first[2] & 7) + z));
}

static iso_vec3 point_of(const walk *w, const cube *c, double x, double y, double z) {
    double voxel = w->surface->voxel;
    return (iso_vec3){voxel * (c->first[0] + x), voxel * (c->first[1] + y),
                      voxel * (c->first[2] + z)};
}

/* To and fro, so that every voxel lies beside the one before. count < 0: among all triangles. */
static void measure_each(walk *w, const cube *c, const int32_t *near, int count) {
    double most = c->limit * c->limit;
    for (int z = 0; z < c->size; z++)
        for (int j = 0; j < c->size; j++) {
            int y = z & 1 ? c->size - 1 - j : j;
            for (int i = 0; i < c->size; i++) {
                int x = j & 1 ? c->size - 1 - i : i;
                iso_vec3 p = point_of(w, c, x, y, z);
                double square = count < 0 ? closest_square(w->tree, p, most, &w->nearest)
                                          : closest_of_few(w->tree, near, count, p, most);
                *place_of(c, x, y, z) = (float)(square < most ? sqrt(square) : c->limit);
            }
        }
}

/* With so many triangles or fewer it's quicker to take them all than to search. */
static int few_in(int32_t size) {
    return size == EDGE ? 8 : size == EDGE / 2 ? 24 : FEW_MAX;
}

/* Where the nearest triangle is at d from the middle of voxels within r of it, only what is within
 * d + 2 r can be nearest to any of them. */
static void measure(walk *w, const cube *c) {
    int32_t near[FEW_MAX];
    double voxel = w->surface->voxel, half = (c->size - 1) * 0.5;
    double radius = voxel * half * 1.7320508075688774 * (1 + 1e-9), most = c->limit + radius;
    iso_vec3 middle = point_of(w, c, half, half, half);
    double square = closest_square(w->tree, middle, most * most, &w->nearest);
    double reach = (sqrt(square) + 2 * radius) * (1 + 1e-9) + 1e-12;
    int count = 0;
    if (square < most * most)
        count = closest_gather(near, few_in(c->size), w->tree, middle, reach);
    if (count <= few_in(c->size)) {
        measure_each(w, c, near, count);
    } else if (c->size == EDGE || (c->size > 2 && square < 16 * voxel * voxel)) {
        cube part = *c;
        part.size /= 2;
        for (int i = 0; i < 8; i++) {
            for (int axis = 0; axis < 3; axis++)
                part.first[axis] = c->first[axis] + (i >> axis & 1) * part.size;
            measure(w, &part);
        }
    } else {
        measure_each(w, c, NULL, -1);
    }
}

// Signs

static iso_vec3 voxel_middle(const walk *w, const int32_t first[3], int32_t cell) {
    double voxel = w->surface->voxel;
    return (iso_vec3){voxel * (first[0] + cell % EDGE), voxel * (first[1] + cell / EDGE % EDGE),
                      voxel * (first[2] + cell / (EDGE * EDGE))};
}

static iso_status ask(side *where, const walk *w, iso_vec3 point) {
    uint8_t inside;
    ISO_TRY(w->inside(w->payload, &inside, &point, 1));
    *where = inside ? INSIDE : OUTSIDE;
    return ISO_OK;
}

/* The sign to one value, cut to what is wanted on its side. */
static float give_sign(const walk *w, float distance, int inside) {
    float limit = (float)(inside ? w->surface->inner : w->surface->outer);
    float cut = distance < limit ? distance : limit;
    return inside ? -cut : cut;
}

static iso_status put_block(const walk *w, const int32_t first[3], const float *value) {
    return w->output->block(w->output->payload, first, value);
}

/* Ask what has been gathered, and hand out the blocks in the order they came. */
static iso_status settle(walk *w) {
    if (w->question_count > 0)
        ISO_TRY(w->inside(w->payload, w->answer, w->question, w->question_count));
    for (int32_t b = 0; b < w->waiting_count; b++) {
        waiting_block *block = &w->waiting[b];
        for (int cell = 0; cell < CELLS; cell++) {
            int32_t question = block->question[block->root[cell]];
            block->value[cell] = give_sign(w, block->value[cell], w->answer[question]);
        }
        ISO_TRY(put_block(w, block->first, block->value));
    }
    w->waiting_count = w->question_count = 0;
    return ISO_OK;
}

static uint16_t find_root(uint16_t *root, uint16_t cell) {
    while (root[cell] != cell)
        cell = root[cell] = root[root[cell]];
    return cell;
}

/* The larger distance leads, since it is the surest to be asked about; then the lower number. */
static void join(waiting_block *block, uint16_t a, uint16_t b) {
    a = find_root(block->root, a);
    b = find_root(block->root, b);
    bool b_leads =
        block->value[b] > block->value[a] || (block->value[b] == block->value[a] && b < a);
    if (b_leads)
        block->root[a] = b;
    else
        block->root[b] = a;
}

/* Half of the 26 neighbours; the other half has this voxel among its own. */
static const int8_t neighbour[13][3] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1},  {1, 1, 0},  {1, -1, 0},
                                        {1, 0, 1},  {-1, 0, 1}, {0, 1, 1},  {0, -1, 1}, {1, 1, 1},
                                        {-1, 1, 1}, {1, -1, 1}, {-1, -1, 1}};

static void hang_together(waiting_block *block, double voxel) {
    for (int cell = 0; cell < CELLS; cell++)
        block->root[cell] = (uint16_t)cell;
    for (int n = 0; n < 13; n++) {
        int dx = neighbour[n][0], dy = neighbour[n][1], dz = neighbour[n][2];
        /* a little farther than they are apart: distances are rounded */
        double apart = voxel * sqrt(dx * dx + dy * dy + dz * dz) * (1 + 1e-6);
        for (int cell = 0; cell < CELLS; cell++) {
            int x = cell % EDGE + dx, y = cell / EDGE % EDGE + dy, z = cell / (EDGE * EDGE) + dz;
            if (x < 0 || x >= EDGE || y < 0 || y >= EDGE || z >= EDGE)
                continue;
            int other = x + EDGE * (y + EDGE * z);
            if ((double)block->value[cell] + (double)block->value[other] > apart)
                join(block, (uint16_t)cell, (uint16_t)other);
        }
    }
}

static iso_status queue_block(walk *w, const int32_t first[3], const float *value) {
    waiting_block *block = &w->waiting[w->waiting_count++];
    memcpy(block->first, first, sizeof block->first);
    memcpy(block->value, value, sizeof block->value);
    hang_together(block, w->surface->voxel);
    for (int cell = 0; cell < CELLS; cell++) {
        block->root[cell] = find_root(block->root, (uint16_t)cell);
        if (block->root[cell] == cell) {
            block->question[cell] = w->question_count;
            w->question[w->question_count++] = voxel_middle(w, first, cell);
        }
    }
    return w->waiting_count == WAITING_MAX ? settle(w) : ISO_OK;
}

// The walk

typedef struct box {
    int32_t low[3], high[3]; /* blocks, low <= b < high */
} box;

static iso_status put_full(const walk *w, const box *b) {
    int32_t at[3];
    for (at[2] = b->low[2]; at[2] < b->high[2]; at[2]++)
        for (at[1] = b->low[1]; at[1] < b->high[1]; at[1]++)
            for (at[0] = b->low[0]; at[0] < b->high[0]; at[0]++) {
                int32_t first[3] = {EDGE * at[0], EDGE * at[1], EDGE * at[2]};
                ISO_TRY(w->output->full(w->output->payload, first));
            }
    return ISO_OK;
}

static iso_status visit_block(walk *w, const int32_t block[3], side where) {
    float value[CELLS];
    const int32_t first[3] = {EDGE * block[0], EDGE * block[1], EDGE * block[2]};
    const cube all = {value, limit_of(w, where), {first[0], first[1], first[2]}, EDGE};
    measure(w, &all);
    if (where == UNKNOWN)
        return queue_block(w, first, value);
    for (int cell = 0; cell < CELLS; cell++)
        value[cell] = give_sign(w, value[cell], where == INSIDE);
    return put_block(w, first, value);
}

static iso_status visit(walk *w, const box *b, side where);

static iso_status visit_halves(walk *w, const box *b, side where) {
    int axis = 0;
    for (int i = 1; i < 3; i++)
        if (b->high[i] - b->low[i] > b->high[axis] - b->low[axis])
            axis = i;
    if (b->high[axis] - b->low[axis] == 1)
        return visit_block(w, b->low, where);
    box half = *b;
    int32_t middle = b->low[axis] + (b->high[axis] - b->low[axis]) / 2;
    half.high[axis] = middle;
    ISO_TRY(visit(w, &half, where));
    half = *b;
    half.low[axis] = middle;
    return visit(w, &half, where);
}

static iso_status visit(walk *w, const box *b, side where) {
    double voxel = w->surface->voxel, middle[3], square = 0;
    for (int i = 0; i < 3; i++) {
        double low = EDGE * (double)b->low[i], high = EDGE * (double)b->high[i] - 1;
        middle[i] = voxel * 0.5 * (low + high);
        square += 0.25 * voxel * voxel * (high - low) * (high - low);
    }
    /* a little less than clear is not clear: rounding */
    double radius = sqrt(square) * (1 + 1e-9) + 1e-12, most = limit_of(w, where) + radius;
    iso_vec3 point = {middle[0], middle[1], middle[2]};
    /* no farther than it matters */
    double nearest = closest_square(w->tree, point, most * most * (1 + 1e-9), &w->nearest);
    if (where == UNKNOWN && nearest > radius * radius)
        ISO_TRY(ask(&where, w, point));
    most = limit_of(w, where) + radius;
    if (nearest > most * most)
        return where == INSIDE ? put_full(w, b) : ISO_OK;
    return visit_halves(w, b, where);
}

void distance_box(iso_vec3 *min, iso_vec3 *max, const iso_volume_surface *surface) {
    if (surface->count == 0)
        return;
    iso_vec3 low = surface->corner[0], high = low;
    for (int64_t i = 1; i < 3 * surface->count; i++) {
        const iso_vec3 *c = &surface->corner[i];
        low.x = c->x < low.x ? c->x : low.x;
        low.y = c->y < low.y ? c->y : low.y;
        low.z = c->z < low.z ? c->z : low.z;
        high.x = c->x > high.x ? c->x : high.x;
        high.y = c->y > high.y ? c->y : high.y;
        high.z = c->z > high.z ? c->z : high.z;
    }
    double outer = surface->outer + surface->voxel;
    *min = (iso_vec3){low.x - outer, low.y - outer, low.z - outer};
    *max = (iso_vec3){high.x + outer, high.y + outer, high.z + outer};
}

static iso_status walk_all(walk *w) {
    iso_vec3 min, max;
    distance_box(&min, &max, w->surface);
    const double low[3] = {min.x, min.y, min.z}, high[3] = {max.x, max.y, max.z};
    box all;
    for (int i = 0; i < 3; i++) {
        all.low[i] = (int32_t)floor(low[i] / w->surface->voxel / EDGE);
        all.high[i] = (int32_t)floor(high[i] / w->surface->voxel / EDGE) + 1;
    }
    ISO_TRY(visit(w, &all, UNKNOWN));
    return settle(w);
}

static iso_status start_walk(walk *w, enclosed_columns *columns) {
    const iso_volume_surface *surface = w->surface;
    ISO_TRY(ISO_PUSH(w->waiting, w->arena, WAITING_MAX));
    ISO_TRY(ISO_PUSH(w->question, w->arena, WAITING_MAX * CELLS));
    ISO_TRY(ISO_PUSH(w->answer, w->arena, WAITING_MAX * CELLS));
    ISO_TRY(closest_new(&w->tree, surface->corner, surface->count));
    if (surface->inside)
        return ISO_OK;
    ISO_TRY(enclosed_new(columns, surface->corner, surface->count));
    w->inside = enclosed_inside;
    w->payload = columns;
    return ISO_OK;
}

iso_status distance_fill(const iso_volume_surface *surface, const distance_output *output) {
    if (surface->count == 0)
        return ISO_OK;
    iso_arena arena = {0};
    enclosed_columns columns = {0};
    walk w = {.surface = surface,
              .output = output,
              .arena = &arena,
              .inside = surface->inside,
              .payload = surface->payload};
    iso_status status = start_walk(&w, &columns);
    if (status == ISO_OK)
        status = walk_all(&w);
    enclosed_free(&columns);
    closest_free(w.tree);
    iso_arena_free(&arena);
    return status;
}

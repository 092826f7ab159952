/* From the box of everything down to one voxel, always in two or in eight, with the list of
 * triangles that may still be nearest to some voxel in it: where the nearest one is at distance d
 * from the middle of voxels that lie within r of it, all at more than d + 2 r drop out. Beyond the
 * wanted distance nothing is looked at any more.
 *
 * A box that the surface stays clear of is on one side of it, so one question tells the sign of
 * all. A block that it passes through is taken apart: no surface comes between two voxels whose
 * distances add up to more than what they are apart, and only one voxel is asked about of those
 * that hang together so. */
#include "solid/distance.h"

#include <math.h>
#include <stdbool.h>

#include "base/memory.h"
#include "solid/enclosed.h"
#include "solid/volume_table.h"

enum { EDGE = VOLUME_EDGE, CELLS = VOLUME_CELLS, WAITING_MAX = 64 };

typedef enum side { UNKNOWN, OUTSIDE, INSIDE } side;

typedef struct ball {
    double x, y, z, radius; /* around a triangle */
} ball;

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
    ball *bound;
    waiting_block *waiting; /* [WAITING_MAX] */
    iso_vec3 *question;     /* [WAITING_MAX CELLS] */
    uint8_t *answer;
    int32_t waiting_count, question_count;
    volume_inside *inside;
    void *payload;
} walk;

/* A box of voxels, and the triangles that count there. */
typedef struct candidates {
    int32_t *triangle;
    double *square;
    int64_t count;
    double nearest; /* from the middle; infinite: none */
} candidates;

// One triangle

static iso_vec3 minus(iso_vec3 a, iso_vec3 b) {
    return (iso_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static double dot(iso_vec3 a, iso_vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static iso_vec3 cross(iso_vec3 a, iso_vec3 b) {
    return (iso_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* From a point at p (seen from one end) to an edge. */
static double to_edge(iso_vec3 p, iso_vec3 edge) {
    double along = dot(p, edge), length = dot(edge, edge);
    if (along <= 0 || length <= 0)
        return dot(p, p);
    double part = along >= length ? 1 : along / length;
    iso_vec3 rest = {p.x - part * edge.x, p.y - part * edge.y, p.z - part * edge.z};
    return dot(rest, rest);
}

/* A triangle whose height is less than this share of its sides has no plane to speak of; its edges
 * are as near as it is, within that. */
#define THINNEST 1e-11

double distance_to_triangle(iso_vec3 p, const iso_vec3 corner[3]) {
    iso_vec3 ab = minus(corner[1], corner[0]), bc = minus(corner[2], corner[1]);
    iso_vec3 ca = minus(corner[0], corner[2]);
    iso_vec3 pa = minus(p, corner[0]), pb = minus(p, corner[1]), pc = minus(p, corner[2]);
    iso_vec3 normal = cross(bc, ab);
    double square = dot(normal, normal);
    double sides = dot(ab, ab) + dot(bc, bc) + dot(ca, ca);
    if (square > THINNEST * THINNEST * sides * sides && dot(cross(ab, normal), pa) >= 0 &&
        dot(cross(bc, normal), pb) >= 0 && dot(cross(ca, normal), pc) >= 0) {
        double height = dot(normal, pa);
        return height * height / square;
    }
    double least = to_edge(pa, ab), other = to_edge(pb, bc);
    least = other < least ? other : least;
    other = to_edge(pc, ca);
    return other < least ? other : least;
}

static ball find_ball(const iso_vec3 *t) {
    iso_vec3 middle = {(t[0].x + t[1].x + t[2].x) / 3, (t[0].y + t[1].y + t[2].y) / 3,
                       (t[0].z + t[1].z + t[2].z) / 3};
    double square = 0;
    for (int i = 0; i < 3; i++) {
        iso_vec3 away = minus(t[i], middle);
        square = dot(away, away) > square ? dot(away, away) : square;
    }
    /* a little larger, so that rounding doesn't make it too small */
    return (ball){middle.x, middle.y, middle.z, sqrt(square) * (1 + 1e-12)};
}

// Lists of triangles

/* Those of `from` (NULL: all) that may be nearest to a point within `radius` of `middle`. Left on
 * the arena. */
static iso_status select_near(candidates *out, const walk *w, const candidates *from,
                              iso_vec3 middle, double radius) {
    *out = (candidates){.nearest = INFINITY};
    int64_t count = from ? from->count : w->surface->count;
    ISO_TRY(ISO_PUSH(out->triangle, w->arena, count));
    ISO_TRY(ISO_PUSH(out->square, w->arena, count));
    double reach = INFINITY; /* nearest + 2 radius, rounded up */
    int64_t kept = 0;
    for (int64_t i = 0; i < count; i++) {
        int32_t t = from ? from->triangle[i] : (int32_t)i;
        const ball *b = &w->bound[t];
        double x = middle.x - b->x, y = middle.y - b->y, z = middle.z - b->z;
        double clear = reach + b->radius;
        if (x * x + y * y + z * z > clear * clear)
            continue;
        double square = distance_to_triangle(middle, w->surface->corner + 3 * (int64_t)t);
        if (square > reach * reach)
            continue;
        out->triangle[kept] = t;
        out->square[kept++] = square;
        if (square < out->nearest * out->nearest) {
            out->nearest = sqrt(square);
            reach = (out->nearest + 2 * radius) * (1 + 1e-9) + 1e-12;
        }
    }
    for (int64_t i = 0; i < kept; i++)
        if (out->square[i] <= reach * reach) {
            out->triangle[out->count] = out->triangle[i];
            out->square[out->count++] = out->square[i];
        }
    return ISO_OK;
}

static double limit_of(const walk *w, side where) {
    double inner = w->surface->inner, outer = w->surface->outer;
    if (where == UNKNOWN)
        return inner > outer ? inner : outer;
    return where == INSIDE ? inner : outer;
}

/* One voxel: nothing is left to be chosen. */
static float measure_one(const walk *w, const candidates *from, const int32_t at[3], double limit) {
    double voxel = w->surface->voxel, least = limit * limit;
    iso_vec3 point = {voxel * at[0], voxel * at[1], voxel * at[2]};
    for (int64_t i = 0; i < from->count; i++) {
        double square =
            distance_to_triangle(point, w->surface->corner + 3 * (int64_t)from->triangle[i]);
        least = square < least ? square : least;
    }
    return (float)sqrt(least);
}

/* Unsigned distances of a cube of voxels within a block; `limit` where it is more. */
static iso_status measure(float *value, const walk *w, const candidates *from,
                          const int32_t first[3], const int32_t size, double limit) {
    int32_t at = (first[0] & 7) + EDGE * ((first[1] & 7) + EDGE * (first[2] & 7));
    if (size == 1) {
        value[at] = measure_one(w, from, first, limit);
        return ISO_OK;
    }
    double voxel = w->surface->voxel, half = (size - 1) * 0.5;
    iso_vec3 middle = {voxel * (first[0] + half), voxel * (first[1] + half),
                       voxel * (first[2] + half)};
    double radius = voxel * half * 1.7320508075688774;
    iso_arena_mark mark = iso_arena_get_mark(w->arena);
    candidates near;
    iso_status status = select_near(&near, w, from, middle, radius);
    if (status == ISO_OK && near.nearest > limit + radius) {
        for (int32_t i = 0; i < size * size * size; i++)
            value[at + i % size + EDGE * (i / size % size + EDGE * (i / (size * size)))] =
                (float)limit;
    } else {
        for (int part = 0; status == ISO_OK && part < 8; part++) {
            int32_t step = size / 2,
                    corner[3] = {first[0] + step * (part & 1), first[1] + step * (part >> 1 & 1),
                                 first[2] + step * (part >> 2)};
            status = measure(value, w, &near, corner, step, limit);
        }
    }
    iso_arena_pop(w->arena, mark);
    return status;
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

static iso_status visit_block(walk *w, const int32_t block[3], const candidates *near, side where) {
    float value[CELLS];
    const int32_t first[3] = {EDGE * block[0], EDGE * block[1], EDGE * block[2]};
    ISO_TRY(measure(value, w, near, first, EDGE, limit_of(w, where)));
    if (where == UNKNOWN)
        return queue_block(w, first, value);
    for (int cell = 0; cell < CELLS; cell++)
        value[cell] = give_sign(w, value[cell], where == INSIDE);
    return put_block(w, first, value);
}

static iso_status visit(walk *w, const box *b, const candidates *from, side where);

static iso_status visit_halves(walk *w, const box *b, const candidates *near, side where) {
    int axis = 0;
    for (int i = 1; i < 3; i++)
        if (b->high[i] - b->low[i] > b->high[axis] - b->low[axis])
            axis = i;
    box half = *b;
    int32_t middle = b->low[axis] + (b->high[axis] - b->low[axis]) / 2;
    half.high[axis] = middle;
    ISO_TRY(visit(w, &half, near, where));
    half = *b;
    half.low[axis] = middle;
    return visit(w, &half, near, where);
}

static iso_status visit_near(walk *w, const box *b, const candidates *near, iso_vec3 middle,
                             double radius, side where) {
    /* a little less than clear is not clear: rounding */
    if (where == UNKNOWN && near->nearest > radius * (1 + 1e-9) + 1e-12)
        ISO_TRY(ask(&where, w, middle));
    if (near->nearest > limit_of(w, where) + radius)
        return where == INSIDE ? put_full(w, b) : ISO_OK;
    for (int i = 0; i < 3; i++)
        if (b->high[i] - b->low[i] > 1)
            return visit_halves(w, b, near, where);
    return visit_block(w, b->low, near, where);
}

static iso_status visit(walk *w, const box *b, const candidates *from, side where) {
    double voxel = w->surface->voxel, middle[3], square = 0;
    for (int i = 0; i < 3; i++) {
        double low = EDGE * (double)b->low[i], high = EDGE * (double)b->high[i] - 1;
        middle[i] = voxel * 0.5 * (low + high);
        square += 0.25 * voxel * voxel * (high - low) * (high - low);
    }
    double radius = sqrt(square);
    iso_vec3 point = {middle[0], middle[1], middle[2]};
    iso_arena_mark mark = iso_arena_get_mark(w->arena);
    candidates near;
    iso_status status = select_near(&near, w, from, point, radius);
    if (status == ISO_OK)
        status = visit_near(w, b, &near, point, radius, where);
    iso_arena_pop(w->arena, mark);
    return status;
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
    ISO_TRY(visit(w, &all, NULL, UNKNOWN));
    return settle(w);
}

static iso_status start_walk(walk *w, enclosed_columns *columns) {
    const iso_volume_surface *surface = w->surface;
    ISO_TRY(ISO_PUSH(w->bound, w->arena, surface->count));
    ISO_TRY(ISO_PUSH(w->waiting, w->arena, WAITING_MAX));
    ISO_TRY(ISO_PUSH(w->question, w->arena, WAITING_MAX * CELLS));
    ISO_TRY(ISO_PUSH(w->answer, w->arena, WAITING_MAX * CELLS));
    for (int64_t i = 0; i < surface->count; i++)
        w->bound[i] = find_ball(surface->corner + 3 * i);
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
    iso_arena_free(&arena);
    return status;
}

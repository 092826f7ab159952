#include "mesh/builder.h"

#include "base/memory.h"
#include "mesh/repair.h"
#include "solid/remake.h"

enum {
    BATCH = 64,
    TABLE_LEAST = 1 << 10,
    CROWD_LEAST = 1 << 9,
    LIST_LONGEST = 48 /* edges; beyond, walking the list would make a fan quadratic */
};

/* Links of a list, while opposite[] holds them: never confused with a dart, which is >= 0. */
static inline int32_t link_to(int32_t dart) {
    return -2 - dart;
}

static inline int32_t link_target(int32_t link) {
    return -2 - link;
}

typedef struct corner {
    float x, y, z;
} corner;

static inline uint32_t bits_of(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static inline uint64_t hash_of(corner at) {
    uint64_t key = bits_of(at.x) | (uint64_t)bits_of(at.y) << 32;
    key = (key ^ bits_of(at.z) * 0x9E3779B97F4A7C15u) * 0xD6E8FEB86659FD93u;
    key = (key ^ key >> 32) * 0xD6E8FEB86659FD93u;
    return key ^ key >> 32;
}

static iso_status table_resize(iso_mesh_builder *b, int64_t size) {
    int32_t *table;
    ISO_TRY(ISO_ALLOCATE(table, size));
    memset(table, 0xff, (size_t)size * sizeof *table);
    for (int32_t v = 0; v < b->mesh.vertex_count; v++) {
        iso_vec3 p = b->mesh.position[v];
        uint64_t slot = hash_of((corner){(float)p.x, (float)p.y, (float)p.z});
        while (table[slot &= (uint64_t)size - 1] >= 0)
            slot++;
        table[slot] = v;
    }
    iso_release(b->table);
    b->table = table;
    b->table_size = size;
    return ISO_OK;
}

static inline uint64_t edge_hash(int32_t low, int32_t high) {
    uint64_t key = ((uint64_t)(uint32_t)low << 32 | (uint32_t)high) * 0x9E3779B97F4A7C15u;
    key = (key ^ key >> 32) * 0xD6E8FEB86659FD93u;
    return key ^ key >> 32;
}

/* The slot of the edge between two vertices, or the empty one where it belongs. */
static int32_t *crowd_slot(int32_t *crowd, int64_t size, const int32_t *origin, int32_t low,
                           int32_t high) {
    uint64_t mask = (uint64_t)size - 1;
    for (uint64_t slot = edge_hash(low, high) & mask;; slot = (slot + 1) & mask) {
        int32_t e = crowd[slot];
        if (e < 0)
            return &crowd[slot];
        int32_t u = origin[e], w = origin[iso_mesh_alpha(e)];
        if ((u == low && w == high) || (u == high && w == low))
            return &crowd[slot];
    }
}

static iso_status crowd_resize(iso_mesh_builder *b, int64_t size) {
    int32_t *crowd;
    const int32_t *origin = b->mesh.origin;
    ISO_TRY(ISO_ALLOCATE(crowd, size));
    memset(crowd, 0xff, (size_t)size * sizeof *crowd);
    for (int64_t i = 0; i < b->crowd_size; i++) {
        int32_t e = b->crowd[i];
        if (e < 0)
            continue;
        int32_t u = origin[e], w = origin[iso_mesh_alpha(e)];
        *crowd_slot(crowd, size, origin, u < w ? u : w, u < w ? w : u) = e;
    }
    iso_release(b->crowd);
    b->crowd = crowd;
    b->crowd_size = size;
    return ISO_OK;
}

/* Room for a batch, so that the loops over corners cannot fail. */
static iso_status reserve(iso_mesh_builder *b, int64_t triangles) {
    int64_t darts = 3 * (b->mesh.triangle_count + triangles);
    int64_t vertices = b->mesh.vertex_count + 3 * triangles;
    if (b->mesh.triangle_count + triangles > ISO_MESH_TRIANGLES_MAX)
        return iso_fail(ISO_UNREADABLE, "more than %d triangles", ISO_MESH_TRIANGLES_MAX);
    ISO_TRY(ISO_GROW(b->mesh.origin, b->origin_capacity, darts));
    ISO_TRY(ISO_GROW(b->mesh.opposite, b->opposite_capacity, darts));
    ISO_TRY(ISO_GROW(b->mesh.position, b->position_capacity, vertices));
    ISO_TRY(ISO_GROW(b->head, b->head_capacity, vertices));
    if (vertices > b->table_size / 4 * 3)
        ISO_TRY(table_resize(b, 2 * b->table_size));
    if (b->crowd_count + 3 * triangles > b->crowd_size / 2)
        ISO_TRY(crowd_resize(b, b->crowd_size ? 2 * b->crowd_size : CROWD_LEAST));
    return ISO_OK;
}

iso_status iso_mesh_builder_begin(iso_mesh_builder *b, int64_t expected) {
    *b = (iso_mesh_builder){0};
    if (expected > ISO_MESH_TRIANGLES_MAX)
        return iso_fail(ISO_UNREADABLE, "%lld triangles; at most %d can be handled",
                        (long long)expected, ISO_MESH_TRIANGLES_MAX);
    /* a closed mesh has half as many vertices as triangles, give or take its genus */
    int64_t vertices = expected / 2 + 4 * BATCH;
    int64_t size = TABLE_LEAST;
    while (size / 4 * 3 < vertices)
        size *= 2;
    iso_status status = table_resize(b, size);
    if (status == ISO_OK)
        status = ISO_GROW(b->mesh.origin, b->origin_capacity, 3 * expected);
    if (status == ISO_OK)
        status = ISO_GROW(b->mesh.opposite, b->opposite_capacity, 3 * expected);
    if (status == ISO_OK)
        status = ISO_GROW(b->mesh.position, b->position_capacity, vertices);
    if (status == ISO_OK)
        status = ISO_GROW(b->head, b->head_capacity, vertices);
    if (status != ISO_OK)
        iso_mesh_builder_discard(b);
    return status;
}

void iso_mesh_builder_discard(iso_mesh_builder *b) {
    iso_mesh_free(&b->mesh);
    iso_release(b->head);
    iso_release(b->table);
    iso_release(b->crowd);
    *b = (iso_mesh_builder){0};
}

int64_t iso_mesh_builder_find_absurd(const void *triangle, int64_t count, size_t stride) {
    const char *at = triangle;
    const uint32_t largest = bits_of(ISO_MESH_COORDINATE_MAX);
    for (int64_t t = 0; t < count; t++, at += stride) {
        uint32_t bits[9], over = 0;
        memcpy(bits, at, sizeof bits);
        for (int k = 0; k < 9; k++) /* NaN and infinity have the largest bits of all */
            over |= (bits[k] & 0x7fffffffu) > largest;
        if (over)
            return t;
    }
    return count;
}

static inline int32_t weld(iso_mesh_builder *b, corner at, uint64_t hash) {
    uint64_t mask = (uint64_t)b->table_size - 1;
    for (uint64_t slot = hash & mask;; slot = (slot + 1) & mask) {
        int32_t v = b->table[slot];
        if (v < 0) {
            v = b->mesh.vertex_count++;
            b->table[slot] = v;
            b->mesh.position[v] = (iso_vec3){at.x, at.y, at.z};
            b->head[v] = -1;
            return v;
        }
        const iso_vec3 *p = &b->mesh.position[v];
        if (p->x == at.x && p->y == at.y && p->z == at.z)
            return v;
    }
}

/* `dart` starts at u; `e` is the first dart of the same edge. A matched edge stays known, so that
 * further darts on it are noticed: opposite[first dart] is the second, and opposite[second] carries
 * the list on. */
static inline void match(iso_mesh_builder *b, int32_t dart, int32_t u, int32_t e) {
    int32_t *opposite = b->mesh.opposite;
    if (opposite[e] < 0 && b->mesh.origin[e] != u) {
        opposite[dart] = opposite[e];
        opposite[e] = dart;
        b->open--;
    } else {
        opposite[dart] = link_to(-1);
        b->excess++;
    }
}

static void link_in_crowd(iso_mesh_builder *b, int32_t dart, int32_t u, int32_t low, int32_t high) {
    int32_t *slot = crowd_slot(b->crowd, b->crowd_size, b->mesh.origin, low, high);
    if (*slot >= 0) {
        match(b, dart, u, *slot);
        return;
    }
    *slot = dart;
    b->crowd_count++;
    b->mesh.opposite[dart] = link_to(-1);
    b->open++;
}

/* Find the partner of `dart`, which runs from u to w, among the edges of the lower vertex. */
static inline void link_dart(iso_mesh_builder *b, int32_t dart, int32_t u, int32_t w) {
    int32_t *opposite = b->mesh.opposite;
    const int32_t *origin = b->mesh.origin;
    int32_t low = u < w ? u : w, high = u < w ? w : u;
    int length = 0;
    for (int32_t e = b->head[low]; e >= 0; length++) {
        int32_t mate = opposite[e], from = origin[e];
        int32_t far = from == low ? origin[iso_mesh_alpha(e)] : from;
        if (far == high) {
            match(b, dart, u, e);
            return;
        }
        e = link_target(mate >= 0 ? opposite[mate] : mate);
    }
    if (length == LIST_LONGEST) {
        link_in_crowd(b, dart, u, low, high);
        return;
    }
    opposite[dart] = link_to(b->head[low]);
    b->head[low] = dart;
    b->open++;
}

/* Where vertices and edges lie is as random as the file's order: each step asks the cache for what
 * the next one will read, for the whole batch. */
static void weld_batch(iso_mesh_builder *b, int32_t *v, const char *at, int count, size_t stride) {
    corner c[3 * BATCH];
    uint64_t hash[3 * BATCH], mask = (uint64_t)b->table_size - 1;
    for (int t = 0; t < count; t++)
        memcpy(c + 3 * t, at + (size_t)t * stride, 3 * sizeof *c);
    for (int i = 0; i < 3 * count; i++) {
        c[i] = (corner){c[i].x + 0.0f, c[i].y + 0.0f, c[i].z + 0.0f}; /* -0 + 0 = 0 */
        hash[i] = hash_of(c[i]);
        __builtin_prefetch(&b->table[hash[i] & mask]);
    }
    for (int i = 0; i < 3 * count; i++) {
        int32_t near = b->table[hash[i] & mask];
        if (near >= 0) {
            __builtin_prefetch(&b->mesh.position[near]);
            __builtin_prefetch(&b->head[near]);
        }
    }
    for (int i = 0; i < 3 * count; i++)
        v[i] = weld(b, c[i], hash[i]);
}

static void add_batch(iso_mesh_builder *b, const char *at, int count, size_t stride) {
    int32_t v[3 * BATCH];
    weld_batch(b, v, at, count, stride);
    for (int i = 0; i < 3 * count; i++) {
        int32_t e = b->head[v[i]];
        if (e >= 0) {
            __builtin_prefetch(&b->mesh.origin[e]);
            __builtin_prefetch(&b->mesh.opposite[e]);
        }
    }
    for (int t = 0; t < count; t++) {
        const int32_t *w = v + 3 * t;
        if (w[0] == w[1] || w[1] == w[2] || w[2] == w[0]) {
            b->mesh.defects.degenerate++;
            continue;
        }
        int32_t dart = 3 * b->mesh.triangle_count++;
        memcpy(b->mesh.origin + dart, w, 3 * sizeof *w);
        for (int k = 0; k < 3; k++)
            link_dart(b, dart + k, w[k], w[k == 2 ? 0 : k + 1]);
    }
}

iso_status iso_mesh_builder_add(iso_mesh_builder *b, const void *triangle, int64_t count,
                                size_t stride) {
    const char *at = triangle;
    for (int64_t done = 0; done < count; done += BATCH) {
        int64_t batch = count - done < BATCH ? count - done : BATCH;
        ISO_TRY(reserve(b, batch));
        add_batch(b, at + (size_t)done * stride, (int)batch, stride);
    }
    b->mesh.defects.triangles_read += count;
    return ISO_OK;
}

/* Replace the list links by the involution; -1 where an edge has no partner. */
static void resolve(iso_mesh *mesh) {
    int32_t darts = 3 * mesh->triangle_count, *opposite = mesh->opposite;
    for (int32_t a = 0; a < darts; a++) {
        if (opposite[a] > a)
            opposite[opposite[a]] = a;
        else if (opposite[a] < 0)
            opposite[a] = -1;
    }
}

static iso_status make_anew(iso_mesh *mesh, iso_mesh *soup, const iso_mesh_options *options) {
    if (soup->triangle_count == 0)
        return iso_fail(ISO_UNSLICEABLE, "nothing is left of %lld triangles without area",
                        (long long)soup->defects.triangles_read);
    iso_mesh_find_box(soup);
    return remake_surface(mesh, soup, options);
}

static double thickness_of(const iso_mesh_options *options) {
    return options ? options->sheet_thickness : 0;
}

iso_status iso_mesh_builder_finish(iso_mesh *mesh, iso_mesh_builder *b,
                                   const iso_mesh_options *options) {
    *mesh = (iso_mesh){0};
    resolve(&b->mesh);
    iso_release(b->head);
    iso_release(b->table);
    iso_release(b->crowd);
    b->head = b->table = b->crowd = NULL;
    if (options && options->volume) {
        iso_status remade = make_anew(mesh, &b->mesh, options);
        iso_mesh_builder_discard(b);
        return remade;
    }
    iso_status status = iso_mesh_repair(&b->mesh, b->open, b->excess, thickness_of(options));
    if (status == ISO_OK) {
        *mesh = b->mesh;
        b->mesh = (iso_mesh){0};
    }
    iso_mesh_builder_discard(b);
    return status;
}

iso_status iso_mesh_from_triangles(iso_mesh *mesh, const float *triangle, int64_t count) {
    return iso_mesh_from_triangles_with(mesh, triangle, count, NULL);
}

iso_status iso_mesh_from_triangles_with(iso_mesh *mesh, const float *triangle, int64_t count,
                                        const iso_mesh_options *options) {
    *mesh = (iso_mesh){0};
    if (count <= 0)
        return iso_fail(ISO_UNREADABLE, "no triangles");
    int64_t absurd = iso_mesh_builder_find_absurd(triangle, count, 9 * sizeof(float));
    if (absurd < count)
        return iso_fail(ISO_UNREADABLE,
                        "triangle %lld has a coordinate that is not finite or beyond 10 km",
                        (long long)absurd);
    iso_mesh_builder builder;
    ISO_TRY(iso_mesh_builder_begin(&builder, count));
    iso_status status = iso_mesh_builder_add(&builder, triangle, count, 9 * sizeof(float));
    if (status != ISO_OK) {
        iso_mesh_builder_discard(&builder);
        return status;
    }
    return iso_mesh_builder_finish(mesh, &builder, options);
}

#include "mesh/repair.h"

#include "base/memory.h"
#include "mesh/union_find.h"

/* Triangles on the same three vertices form a group, led by the first of them. Of p triangles that
 * turn one way and n the other, min(p, n) pairs enclose nothing and cancel, which leaves every edge
 * as balanced as it was. One of the rest is enough, if the further ones, taken together with their
 * neighbours of the kind, can go without unbalancing their edges: a shell that was exported twice
 * can, but where two sheets of a surface run through the same triangle both are needed. */
typedef struct group {
    int32_t same, other; /* as the leader turns, and the other way */
    int32_t kept;
    bool odd; /* the leader's */
} group;

typedef struct key {
    int32_t v[3]; /* ascending */
    bool odd;     /* the triangle turns against that order */
} key;

static key key_of(const int32_t *origin) {
    int32_t a = origin[0], b = origin[1], c = origin[2], swap;
    bool odd = false;
    if (a > b)
        swap = a, a = b, b = swap, odd = !odd;
    if (b > c)
        swap = b, b = c, c = swap, odd = !odd;
    if (a > b)
        swap = a, a = b, b = swap, odd = !odd;
    return (key){{a, b, c}, odd};
}

static uint64_t hash_of(const key *k) {
    uint64_t hash = (uint32_t)k->v[0] * 0x9E3779B97F4A7C15u;
    hash = (hash ^ (uint32_t)k->v[1]) * 0xD6E8FEB86659FD93u;
    hash = (hash ^ hash >> 32 ^ (uint32_t)k->v[2]) * 0xD6E8FEB86659FD93u;
    return hash ^ hash >> 32;
}

static void find_groups(group *groups, int32_t *leader, int32_t *table, uint64_t mask,
                        const iso_mesh *mesh) {
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        key k = key_of(mesh->origin + 3 * t), other = k;
        uint64_t slot = hash_of(&k) & mask;
        for (; table[slot] >= 0; slot = (slot + 1) & mask) {
            other = key_of(mesh->origin + 3 * table[slot]);
            if (memcmp(other.v, k.v, sizeof k.v) == 0)
                break;
        }
        if (table[slot] < 0) {
            table[slot] = t;
            other = k;
            groups[t] = (group){.odd = k.odd};
        }
        leader[t] = table[slot];
        if (other.odd == k.odd)
            groups[leader[t]].same++;
        else
            groups[leader[t]].other++;
    }
}

/* Drop the pairs; extra[t] marks what turns as an earlier triangle of its group does. */
static int32_t cancel(iso_mesh *mesh, bool *extra, group *groups, const int32_t *leader) {
    int32_t kept = 0, extras = 0;
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        group *g = &groups[leader[t]];
        int32_t left = g->same > g->other ? g->same - g->other : g->other - g->same;
        bool majority = (key_of(mesh->origin + 3 * t).odd == g->odd) == (g->same > g->other);
        if (!majority || g->kept == left)
            continue;
        extra[kept] = g->kept++ > 0;
        extras += extra[kept];
        memmove(mesh->origin + 3 * kept++, mesh->origin + 3 * t, 3 * sizeof *mesh->origin);
    }
    mesh->defects.cancelled += mesh->triangle_count - kept;
    mesh->triangle_count = kept;
    return extras;
}

static int32_t distance(int32_t a) {
    return a < 0 ? -a : a;
}

/* Extras that share an edge go or stay together: above[] joins them into clusters, and gain[root]
 * tells by how much the edges' balance improves without them. */
static void weigh(int32_t *above, int64_t *gain, const iso_mesh *mesh, const bool *extra,
                  const iso_mesh_edges *edges) {
    for (int32_t t = 0; t < mesh->triangle_count; t++)
        above[t] = t, gain[t] = 0;
    for (int pass = 0; pass < 2; pass++)
        for (int64_t e = 0; e < edges->count; e++) {
            const int32_t *dart = edges->dart + edges->first[e];
            int32_t count = edges->first[e + 1] - edges->first[e], balance = 0, without = 0;
            int32_t cluster = -1;
            for (int32_t i = 0; i < count; i++) {
                int32_t t = dart[i] / 3;
                int32_t sign = mesh->origin[dart[i]] == mesh->origin[dart[0]] ? 1 : -1;
                balance += sign;
                without += extra[t] ? 0 : sign;
                if (!extra[t])
                    continue;
                int32_t root = iso_root_of(above, t);
                cluster = cluster < 0 ? root : iso_join_roots(above, cluster, root);
            }
            if (pass == 1 && cluster >= 0)
                gain[cluster] += distance(balance) - distance(without);
        }
}

static iso_status drop_extras(iso_mesh *mesh, const bool *extra) {
    iso_mesh_edges edges;
    int32_t *above = NULL, kept = 0;
    int64_t *gain = NULL;
    ISO_TRY(iso_mesh_edges_new(&edges, mesh));
    iso_status status = ISO_ALLOCATE(above, mesh->triangle_count);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(gain, mesh->triangle_count);
    if (status == ISO_OK) {
        weigh(above, gain, mesh, extra, &edges);
        for (int32_t t = 0; t < mesh->triangle_count; t++)
            if (!extra[t] || gain[iso_root_of(above, t)] < 0)
                memmove(mesh->origin + 3 * kept++, mesh->origin + 3 * t, 3 * sizeof *mesh->origin);
        mesh->defects.duplicate += mesh->triangle_count - kept;
        mesh->triangle_count = kept;
    }
    iso_mesh_edges_free(&edges);
    iso_release(above);
    iso_release(gain);
    return status;
}

iso_status iso_mesh_drop_coincident(iso_mesh *mesh) {
    int64_t count = mesh->triangle_count, size = 16;
    while (size < count + count / 2)
        size *= 2;
    group *groups = NULL;
    int32_t *leader = NULL, *table = NULL, extras = 0;
    bool *extra = NULL;
    iso_status status = ISO_ALLOCATE(groups, count);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(leader, count);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(extra, count);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(table, size);
    if (status == ISO_OK) {
        memset(table, 0xff, (size_t)size * sizeof *table);
        find_groups(groups, leader, table, (uint64_t)size - 1, mesh);
        extras = cancel(mesh, extra, groups, leader);
    }
    iso_release(groups);
    iso_release(leader);
    iso_release(table);
    if (status == ISO_OK && extras > 0)
        status = drop_extras(mesh, extra);
    iso_release(extra);
    return status;
}

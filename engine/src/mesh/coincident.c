#include "mesh/repair.h"

#include "base/memory.h"

/* Triangles on the same three vertices form a group, led by the first of them. Of p triangles that
 * turn one way and n the other, min(p, n) pairs enclose nothing and cancel; of what is left, one is
 * enough. */
typedef struct group {
    int32_t same, other; /* as the leader turns, and the other way */
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
            groups[t] = (group){0, 0};
        }
        leader[t] = table[slot];
        if (other.odd == k.odd)
            groups[leader[t]].same++;
        else
            groups[leader[t]].other++;
    }
}

/* Keep the first triangle of a group that turns as its majority does. */
static void drop(iso_mesh *mesh, group *groups, const int32_t *leader) {
    int32_t kept = 0;
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        if (leader[t] != t)
            continue;
        int32_t same = groups[t].same, other = groups[t].other;
        int32_t pairs = same < other ? same : other, left = same + other - 2 * pairs;
        mesh->defects.cancelled += 2 * pairs;
        if (left == 0)
            continue;
        mesh->defects.duplicate += left - 1;
        int32_t v[3];
        memcpy(v, mesh->origin + 3 * t, sizeof v);
        int32_t *to = mesh->origin + 3 * kept++;
        to[0] = v[0];
        to[1] = v[same > other ? 1 : 2];
        to[2] = v[same > other ? 2 : 1];
    }
    mesh->triangle_count = kept;
}

iso_status iso_mesh_drop_coincident(iso_mesh *mesh) {
    int64_t count = mesh->triangle_count, size = 16;
    while (size < count + count / 2)
        size *= 2;
    group *groups = NULL;
    int32_t *leader = NULL, *table = NULL;
    iso_status status = ISO_ALLOCATE(groups, count);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(leader, count);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(table, size);
    if (status == ISO_OK) {
        memset(table, 0xff, (size_t)size * sizeof *table);
        find_groups(groups, leader, table, (uint64_t)size - 1, mesh);
        drop(mesh, groups, leader);
    }
    iso_release(groups);
    iso_release(leader);
    iso_release(table);
    return status;
}

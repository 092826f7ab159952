#include "mesh/repair.h"

#include "base/memory.h"

/* Vertices are taken in order; each goes to the nearest vertex kept so far within reach, or is
 * kept. Kept ones are further apart than the reach, so a cell of the grid holds few of them, and
 * none moves further than the reach however long a chain of near neighbours is. */
typedef struct grid {
    int32_t *slot; /* [size] first kept vertex with that hash, or -1 */
    int32_t *next; /* [vertex] */
    uint64_t mask;
    int32_t *beside[2]; /* [vertex] neighbours along an open edge: those are no seam */
} grid;

typedef struct cell {
    int64_t x, y, z;
} cell;

static int64_t floor_of(double value) {
    int64_t down = (int64_t)value;
    return down - ((double)down > value);
}

static cell cell_of(iso_vec3 p) {
    return (cell){floor_of(p.x / ISO_MESH_SEAM), floor_of(p.y / ISO_MESH_SEAM),
                  floor_of(p.z / ISO_MESH_SEAM)};
}

static uint64_t hash_of(cell c) {
    uint64_t hash = (uint64_t)c.x * 0x9E3779B97F4A7C15u;
    hash = (hash ^ (uint64_t)c.y ^ hash >> 29) * 0xD6E8FEB86659FD93u;
    hash = (hash ^ (uint64_t)c.z ^ hash >> 32) * 0xD6E8FEB86659FD93u;
    return hash ^ hash >> 32;
}

static int32_t nearest(const grid *g, const iso_mesh *mesh, int32_t vertex) {
    iso_vec3 p = mesh->position[vertex];
    cell c = cell_of(p);
    int32_t best = -1;
    double least = ISO_MESH_SEAM * ISO_MESH_SEAM;
    for (int i = 0; i < 27; i++) {
        cell near = {c.x + i % 3 - 1, c.y + i / 3 % 3 - 1, c.z + i / 9 - 1};
        for (int32_t v = g->slot[hash_of(near) & g->mask]; v >= 0; v = g->next[v]) {
            if (v == g->beside[0][vertex] || v == g->beside[1][vertex])
                continue;
            iso_vec3 q = mesh->position[v];
            double x = q.x - p.x, y = q.y - p.y, z = q.z - p.z, d = x * x + y * y + z * z;
            if (d < least || (d == least && (best < 0 || v < best))) {
                least = d;
                best = v;
            }
        }
    }
    return best;
}

/* name[v] = -1 where an open edge ends, v elsewhere. */
static int64_t mark_open(int32_t *name, grid *g, const iso_mesh *mesh) {
    int64_t marked = 0;
    for (int32_t v = 0; v < mesh->vertex_count; v++)
        name[v] = v;
    for (int32_t a = 0; a < 3 * mesh->triangle_count; a++) {
        if (mesh->opposite[a] >= 0)
            continue;
        int32_t end[2] = {mesh->origin[a], mesh->origin[iso_mesh_alpha(a)]};
        for (int k = 0; k < 2; k++) {
            marked += name[end[k]] >= 0;
            name[end[k]] = -1;
            g->beside[k][end[k]] = end[1 - k];
        }
    }
    return marked;
}

static iso_status merge(int64_t *merged, iso_mesh *mesh, int32_t *name, grid *g) {
    int64_t marked = mark_open(name, g, mesh), size = 16;
    while (size < 2 * marked)
        size *= 2;
    ISO_TRY(ISO_ALLOCATE(g->slot, size));
    memset(g->slot, 0xff, (size_t)size * sizeof *g->slot);
    g->mask = (uint64_t)size - 1;
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        if (name[v] >= 0)
            continue;
        int32_t near = nearest(g, mesh, v);
        if (near >= 0) {
            name[v] = near;
            ++*merged;
            continue;
        }
        uint64_t slot = hash_of(cell_of(mesh->position[v])) & g->mask;
        name[v] = v;
        g->next[v] = g->slot[slot];
        g->slot[slot] = v;
    }
    if (*merged > 0)
        for (int32_t a = 0; a < 3 * mesh->triangle_count; a++)
            mesh->origin[a] = name[mesh->origin[a]];
    return ISO_OK;
}

iso_status iso_mesh_weld_seams(int64_t *merged, iso_mesh *mesh) {
    int32_t *name = NULL;
    grid g = {0};
    *merged = 0;
    iso_status status = ISO_ALLOCATE(name, mesh->vertex_count);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(g.next, mesh->vertex_count);
    for (int k = 0; k < 2 && status == ISO_OK; k++)
        status = ISO_ALLOCATE(g.beside[k], mesh->vertex_count);
    if (status == ISO_OK)
        status = merge(merged, mesh, name, &g);
    iso_release(name);
    iso_release(g.slot);
    iso_release(g.next);
    iso_release(g.beside[0]);
    iso_release(g.beside[1]);
    return status;
}

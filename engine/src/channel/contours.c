/* The part cut at all levels, and which contours belong together: two of neighbouring levels are
 * one on top of the other if the piece of surface between the levels has no other border. */
#include <isoslice/link.h>

#include "channel/tower.h"
#include "mesh/union_find.h"

typedef struct cutter {
    contours *out;
    const iso_mesh *mesh;
    const double *height;     /* [vertex_count] */
    const iso_multilink *cut; /* the coloured link of crossings */
    const int32_t *dart;      /* [crossings] */
    int32_t *contour;         /* [crossings] */
    int32_t *above;           /* union-find of vertices, then of contours from below, from above */
} cutter;

/* Orbits one by one, in the order of the crossings. */
static iso_status collect(cutter *c, iso_arena *arena) {
    contours *out = c->out;
    const iso_map *next = &c->cut->map[0], *level = &c->cut->projection[0];
    int32_t size = c->cut->size, points = 0;
    ISO_TRY(ISO_PUSH(c->contour, arena, size));
    ISO_TRY(ISO_PUSH(out->point, arena, size));
    ISO_TRY(ISO_PUSH(out->face, arena, size));
    ISO_TRY(ISO_PUSH(out->first, arena, (int64_t)size + 1));
    ISO_TRY(ISO_PUSH(out->at, arena, size));
    ISO_TRY(ISO_PUSH(out->area, arena, size));
    for (int32_t a = 0; a < size; a++)
        c->contour[a] = -1;
    out->first[0] = 0;
    for (int32_t a = 0; a < size; a++) {
        double twice = 0;
        if (c->contour[a] >= 0)
            continue;
        int32_t first = points, n = out->count++;
        for (int32_t b = a; c->contour[b] < 0; b = iso_map_at(next, b)) {
            const double *g = c->cut->g + 3 * (int64_t)b;
            c->contour[b] = n;
            iso_vec3 p = {g[0], g[1], g[2]};
            if (points > first && vec3_distance(p, out->point[points - 1]) <= 1e-9)
                continue;
            out->face[points] = c->dart[b] / 3;
            out->point[points++] = p;
        }
        iso_vec3 o = out->point[first];
        for (int32_t i = first + 1; i + 1 < points; i++)
            twice += vec3_cross(vec3_minus(out->point[i], o), vec3_minus(out->point[i + 1], o)).z;
        out->at[n] = iso_map_at(level, a);
        out->area[n] = twice / 2;
        out->first[n + 1] = points;
    }
    return ISO_OK;
}

static void join(cutter *c, int32_t a, int32_t b) {
    a = iso_root_of(c->above, a);
    b = iso_root_of(c->above, b);
    if (a != b)
        iso_join_roots(c->above, a, b);
}

static int32_t count_levels_below(const contours *all, double z) {
    int32_t low = 0, high = all->level_count;
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (all->level[middle] < z)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* A dart that rises through levels joins its lower end to the first contour from below, each
 * contour from above to the next from below, the last from above to its upper end; one between two
 * levels joins its ends. */
static iso_status find_pieces(cutter *c, iso_arena *arena) {
    contours *out = c->out;
    int32_t vertices = c->mesh->vertex_count, roof = vertices, floor = vertices + out->count;
    int32_t darts = 3 * c->mesh->triangle_count, at = 0, *slab;
    ISO_TRY(ISO_PUSH(out->roof, arena, out->count));
    ISO_TRY(ISO_PUSH(out->floor, arena, out->count));
    ISO_TRY(ISO_PUSH(c->above, arena, (int64_t)vertices + 2 * (int64_t)out->count));
    ISO_TRY(ISO_PUSH(slab, arena, vertices));
    for (int32_t i = 0; i < vertices + 2 * out->count; i++)
        c->above[i] = i;
    for (int32_t v = 0; v < vertices; v++)
        slab[v] = count_levels_below(out, c->height[v]);
    for (int32_t a = 0; a < darts; a++) {
        int32_t from = c->mesh->origin[a], to = c->mesh->origin[iso_mesh_alpha(a)], node = from;
        if (slab[from] == slab[to])
            join(c, from, to);
        for (; at < c->cut->size && c->dart[at] == a; at++) {
            join(c, node, roof + c->contour[at]);
            node = floor + c->contour[at];
        }
        if (node != from)
            join(c, node, to);
    }
    for (int32_t i = 0; i < out->count; i++) {
        out->roof[i] = iso_root_of(c->above, roof + i);
        out->floor[i] = iso_root_of(c->above, floor + i);
    }
    return ISO_OK;
}

/* What is on top of what: pieces with one contour below and one above. */
static iso_status find_next(contours *out, int32_t pieces, iso_arena *arena) {
    int32_t *floors, *roofs, *lowest;
    ISO_TRY(ISO_PUSH(out->next, arena, out->count));
    ISO_TRY(ISO_PUSH(floors, arena, pieces));
    ISO_TRY(ISO_PUSH(roofs, arena, pieces));
    ISO_TRY(ISO_PUSH(lowest, arena, pieces));
    for (int32_t p = 0; p < pieces; p++)
        floors[p] = roofs[p] = 0, lowest[p] = -1;
    for (int32_t c = 0; c < out->count; c++) {
        floors[out->floor[c]]++;
        roofs[out->roof[c]]++;
        lowest[out->floor[c]] = c;
        out->next[c] = -1;
    }
    for (int32_t c = 0; c < out->count; c++)
        if (floors[out->roof[c]] == 1 && roofs[out->roof[c]] == 1)
            out->next[lowest[out->roof[c]]] = c;
    return ISO_OK;
}

static iso_status cut(cutter *c, const iso_double_link *surface, iso_arena *arena) {
    iso_coloured_link crossings;
    double *height;
    int32_t size = surface->link.size;
    ISO_TRY(ISO_ALLOCATE(height, size));
    for (int32_t a = 0; a < size; a++)
        height[a] = c->height[c->mesh->origin[a]];
    iso_status status =
        iso_slice_double_link(&crossings, surface, height, c->out->level, c->out->level_count);
    iso_release(height);
    ISO_TRY(status);
    c->cut = &crossings.link;
    c->dart = crossings.link.projection[1].image;
    status = collect(c, arena);
    if (status == ISO_OK)
        status = find_pieces(c, arena);
    if (status == ISO_OK)
        status = find_next(c->out, c->mesh->vertex_count + 2 * c->out->count, arena);
    iso_multilink_free(&crossings.link);
    return status;
}

iso_status contours_cut(contours *out, const iso_mesh *mesh, const double *height,
                        iso_arena *arena) {
    iso_double_link surface;
    cutter c = {.out = out, .mesh = mesh, .height = height};
    ISO_TRY(iso_double_link_from_mesh(&surface, mesh));
    iso_status status = cut(&c, &surface, arena);
    iso_multilink_free(&surface.link);
    return status;
}

iso_status contours_cut_flat(contours *out, const iso_mesh *mesh, int32_t levels,
                             iso_arena *arena) {
    double low = mesh->min.z, tall = mesh->max.z - low, inset = 1e-7 * tall, *z;
    *out = (contours){.level_count = levels};
    ISO_TRY(ISO_PUSH(out->level, arena, levels));
    ISO_TRY(ISO_PUSH(z, arena, mesh->vertex_count));
    for (int32_t i = 0; i < levels; i++) /* the outermost just within the part: they cut it */
        out->level[i] = low + inset + (tall - 2 * inset) * i / (levels - 1);
    for (int32_t v = 0; v < mesh->vertex_count; v++)
        z[v] = mesh->position[v].z;
    return contours_cut(out, mesh, z, arena);
}

#include <isoslice/mesh.h>

#include <math.h>

#include "base/memory.h"

void iso_mesh_free(iso_mesh *mesh) {
    iso_release(mesh->origin);
    iso_release(mesh->opposite);
    iso_release(mesh->position);
    *mesh = (iso_mesh){0};
}

static iso_vec3 moved(iso_vec3 p, iso_vec3 by) {
    return (iso_vec3){p.x + by.x, p.y + by.y, p.z + by.z};
}

void iso_mesh_translate(iso_mesh *mesh, iso_vec3 offset) {
    for (int32_t v = 0; v < mesh->vertex_count; v++)
        mesh->position[v] = moved(mesh->position[v], offset);
    mesh->min = moved(mesh->min, offset);
    mesh->max = moved(mesh->max, offset);
}

void iso_meshes_place(iso_mesh *mesh, int32_t count, iso_vec2 center) {
    if (count <= 0)
        return;
    iso_vec3 min = mesh[0].min, max = mesh[0].max;
    for (int32_t i = 1; i < count; i++) {
        iso_vec3 low = mesh[i].min, high = mesh[i].max;
        min = (iso_vec3){fmin(min.x, low.x), fmin(min.y, low.y), fmin(min.z, low.z)};
        max = (iso_vec3){fmax(max.x, high.x), fmax(max.y, high.y), fmax(max.z, high.z)};
    }
    iso_vec3 by = {center.x - (min.x + max.x) / 2, center.y - (min.y + max.y) / 2, -min.z};
    for (int32_t i = 0; i < count; i++)
        iso_mesh_translate(&mesh[i], by);
}

static int finite_point(iso_vec3 p) {
    return p.x - p.x == 0 && p.y - p.y == 0 && p.z - p.z == 0;
}

iso_status iso_mesh_validate(const iso_mesh *mesh) {
    int32_t darts = 3 * mesh->triangle_count;
    for (int32_t a = 0; a < darts; a++) {
        int32_t v = mesh->origin[a], b = mesh->opposite[a];
        if (v < 0 || v >= mesh->vertex_count)
            return iso_fail(ISO_BUG, "v(%d) = %d is not a vertex", a, v);
        if (b < 0 || b >= darts)
            return iso_fail(ISO_BUG, "opposite(%d) = %d is not a dart", a, b);
        if (b == a)
            return iso_fail(ISO_BUG, "beta alpha(%d) = %d: a fixed point", a, a);
        if (mesh->opposite[b] != a)
            return iso_fail(ISO_BUG, "(beta alpha)^2 = 1 fails at dart %d: opposite is %d, back %d",
                            a, b, mesh->opposite[b]);
    }
    for (int32_t a = 0; a < darts; a++) {
        int32_t beta = mesh->opposite[iso_mesh_alpha_inverse(a)];
        if (mesh->origin[beta] != mesh->origin[a])
            return iso_fail(ISO_BUG, "v beta = v fails at dart %d: vertex %d, not %d", a,
                            mesh->origin[beta], mesh->origin[a]);
        if (mesh->origin[iso_mesh_alpha(a)] == mesh->origin[a])
            return iso_fail(ISO_BUG, "dart %d starts and ends at vertex %d", a, mesh->origin[a]);
        iso_vec3 p = mesh->position[mesh->origin[a]];
        if (!finite_point(p))
            return iso_fail(ISO_BUG, "g(%d): vertex %d is not finite", a, mesh->origin[a]);
        if (p.x < mesh->min.x || p.y < mesh->min.y || p.z < mesh->min.z || p.x > mesh->max.x ||
            p.y > mesh->max.y || p.z > mesh->max.z)
            return iso_fail(ISO_BUG, "vertex %d lies outside the mesh's box", mesh->origin[a]);
    }
    return ISO_OK;
}

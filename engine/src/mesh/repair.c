#include "mesh/repair.h"

iso_status iso_mesh_repair(iso_mesh *mesh, bool closed) {
    if (mesh->triangle_count == 0)
        return iso_fail(ISO_UNREADABLE, "no triangle has an area");
    if (!closed)
        return iso_fail(ISO_UNSLICEABLE, "the surface is not closed");
    mesh->min = mesh->max = mesh->position[mesh->origin[0]];
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        iso_vec3 p = mesh->position[v];
        mesh->min.x = p.x < mesh->min.x ? p.x : mesh->min.x;
        mesh->min.y = p.y < mesh->min.y ? p.y : mesh->min.y;
        mesh->min.z = p.z < mesh->min.z ? p.z : mesh->min.z;
        mesh->max.x = p.x > mesh->max.x ? p.x : mesh->max.x;
        mesh->max.y = p.y > mesh->max.y ? p.y : mesh->max.y;
        mesh->max.z = p.z > mesh->max.z ? p.z : mesh->max.z;
    }
    return ISO_OK;
}

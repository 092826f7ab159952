#include <math.h>
#include <stddef.h>

#include "base/memory.h"
#include "base/vector.h"
#include "height/height.h"
#include "height/waves.h"
#include "mesh/union_find.h"

/* mm that lowest points may lie above each other. */
#define LEVEL 1e-6

/* distance[] holds what is given. */
static iso_status spread(double *distance, const iso_mesh *mesh) {
    double *length;
    int64_t darts = 3 * (int64_t)mesh->triangle_count;
    ISO_TRY(ISO_ALLOCATE(length, darts));
    for (int32_t a = 0; a < darts; a++)
        length[a] = vec3_distance(mesh->position[mesh->origin[a]],
                                  mesh->position[mesh->origin[iso_mesh_alpha(a)]]);
    const wave_surface surface = {.triangle_count = mesh->triangle_count,
                                  .vertex_count = mesh->vertex_count,
                                  .origin = mesh->origin,
                                  .opposite = mesh->opposite,
                                  .length = length};
    iso_status status = waves_spread(distance, &surface);
    iso_release(length);
    return status;
}

iso_status height_geodesic(double *distance, const iso_mesh *mesh, const int32_t *source,
                           int32_t source_count) {
    for (int32_t v = 0; v < mesh->vertex_count; v++)
        distance[v] = INFINITY;
    for (int32_t i = 0; i < source_count; i++) {
        if (source[i] < 0 || source[i] >= mesh->vertex_count)
            return iso_fail(ISO_USAGE, "source %d is no vertex: there are %d", source[i],
                            mesh->vertex_count);
        distance[source[i]] = 0;
    }
    return spread(distance, mesh);
}

iso_status height_geodesic_rise(double *distance, const iso_mesh *mesh, double foot) {
    int32_t *above;
    double *low;
    ISO_TRY(ISO_ALLOCATE(above, mesh->vertex_count));
    iso_status status = ISO_ALLOCATE(low, mesh->vertex_count);
    if (status != ISO_OK) {
        iso_release(above);
        return status;
    }
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        above[v] = v;
        low[v] = INFINITY;
    }
    for (int32_t a = 0; a < 3 * mesh->triangle_count; a++)
        iso_join_roots(above, iso_root_of(above, mesh->origin[a]),
                       iso_root_of(above, mesh->origin[iso_mesh_alpha(a)]));
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        int32_t root = iso_root_of(above, v);
        low[root] = fmin(low[root], mesh->position[v].z);
    }
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        double z = low[iso_root_of(above, v)];
        distance[v] = mesh->position[v].z <= z + LEVEL ? z - foot : INFINITY;
    }
    iso_release(above);
    iso_release(low);
    return spread(distance, mesh);
}

#include "mesh/repair.h"

#include "base/memory.h"
#include "mesh/nesting.h"
#include "mesh/union_find.h"

iso_status iso_mesh_find_shells(int32_t **shell, int32_t *count, const iso_mesh *mesh) {
    int32_t *above;
    ISO_TRY(ISO_ALLOCATE(above, mesh->triangle_count));
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        int32_t root = above[t] = t;
        for (int32_t a = 3 * t; a < 3 * t + 3; a++) {
            int32_t b = mesh->opposite[a];
            if (b < 0 || b / 3 >= t)
                continue;
            root = iso_join_roots(above, root, iso_root_of(above, b / 3));
        }
    }
    *count = 0;
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        /* roots come first, so what is above is a number already */
        above[t] = above[t] == t ? (*count)++ : above[above[t]];
    }
    *shell = above;
    return ISO_OK;
}

static void measure(double *volume, int32_t *triangles, int32_t shells, const iso_mesh *mesh,
                    const int32_t *shell) {
    memset(volume, 0, (size_t)shells * sizeof *volume);
    memset(triangles, 0, (size_t)shells * sizeof *triangles);
    iso_vec3 base = mesh->position[mesh->origin[0]];
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        iso_vec3 p = mesh->position[mesh->origin[3 * t]];
        iso_vec3 q = mesh->position[mesh->origin[3 * t + 1]];
        iso_vec3 r = mesh->position[mesh->origin[3 * t + 2]];
        double shadow = (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
        volume[shell[t]] += shadow * ((p.z - base.z) + (q.z - base.z) + (r.z - base.z));
        triangles[shell[t]]++;
    }
}

/* Two triangles that make up a shell lie back to back. Drop such shells. */
static iso_status drop_pillows(iso_mesh *mesh, int32_t *shell, int32_t *shells, double *volume,
                               const int32_t *triangles) {
    int32_t *name, *renamed, kept = 0, kept_shells = 0, darts = 3 * mesh->triangle_count;
    ISO_TRY(ISO_ALLOCATE(name, mesh->triangle_count));
    iso_status status = ISO_ALLOCATE(renamed, *shells);
    if (status != ISO_OK) {
        iso_release(name);
        return status;
    }
    for (int32_t i = 0; i < *shells; i++) {
        renamed[i] = triangles[i] == 2 ? -1 : kept_shells;
        if (renamed[i] >= 0)
            volume[kept_shells++] = volume[i];
    }
    for (int32_t t = 0; t < mesh->triangle_count; t++)
        name[t] = renamed[shell[t]] >= 0 ? kept++ : -1;
    for (int32_t a = 0; a < darts; a++) {
        int32_t to = name[a / 3], b = mesh->opposite[a];
        if (to < 0)
            continue;
        mesh->origin[3 * to + a % 3] = mesh->origin[a];
        mesh->opposite[3 * to + a % 3] = 3 * name[b / 3] + b % 3;
    }
    for (int32_t t = 0; t < mesh->triangle_count; t++)
        if (name[t] >= 0)
            shell[name[t]] = renamed[shell[t]];
    mesh->defects.cancelled += mesh->triangle_count - kept;
    mesh->triangle_count = kept;
    *shells = kept_shells;
    iso_release(name);
    iso_release(renamed);
    return ISO_OK;
}

/* Dart 3t + k runs the other way as dart 3t + 2 - k. */
static void turn(iso_mesh *mesh, const int32_t *shell, const bool *turned) {
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        if (!turned[shell[t]])
            continue;
        int32_t *v = mesh->origin + 3 * t, *o = mesh->opposite + 3 * t, swap;
        swap = v[1], v[1] = v[2], v[2] = swap;
        swap = o[0], o[0] = o[2], o[2] = swap;
        for (int k = 0; k < 3; k++)
            o[k] = 3 * (o[k] / 3) + 2 - o[k] % 3;
    }
}

static iso_status turn_shells(iso_mesh *mesh, int32_t *shell, int32_t shells, double *volume,
                              int32_t *triangles) {
    measure(volume, triangles, shells, mesh, shell);
    bool pillows = false, negative = false;
    for (int32_t i = 0; i < shells; i++)
        pillows |= triangles[i] == 2;
    if (pillows)
        ISO_TRY(drop_pillows(mesh, shell, &shells, volume, triangles));
    for (int32_t i = 0; i < shells; i++)
        negative |= volume[i] < 0;
    mesh->defects.shells = shells;
    if (!negative)
        return ISO_OK;
    bool *turned;
    ISO_TRY(ISO_ALLOCATE(turned, shells));
    iso_status status = iso_mesh_find_inverted(turned, mesh, shell, volume, shells);
    if (status == ISO_OK) {
        turn(mesh, shell, turned);
        for (int32_t i = 0; i < shells; i++)
            mesh->defects.inverted_shells += turned[i];
    }
    iso_release(turned);
    return status;
}

iso_status iso_mesh_turn_shells(iso_mesh *mesh) {
    int32_t *shell, shells, *triangles = NULL;
    double *volume = NULL;
    ISO_TRY(iso_mesh_find_shells(&shell, &shells, mesh));
    iso_status status = ISO_ALLOCATE(volume, shells);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(triangles, shells);
    if (status == ISO_OK)
        status = turn_shells(mesh, shell, shells, volume, triangles);
    iso_release(shell);
    iso_release(volume);
    iso_release(triangles);
    return status;
}

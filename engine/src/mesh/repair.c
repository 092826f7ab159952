#include "mesh/repair.h"

#include "base/memory.h"

void iso_mesh_drop_degenerate(iso_mesh *mesh) {
    int32_t kept = 0;
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        int32_t v[3];
        memcpy(v, mesh->origin + 3 * t, sizeof v);
        if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0])
            continue;
        memcpy(mesh->origin + 3 * kept++, v, sizeof v);
    }
    mesh->defects.degenerate += mesh->triangle_count - kept;
    mesh->triangle_count = kept;
}

static iso_status link_again(int64_t *open, iso_mesh *mesh, sheets *marks) {
    iso_mesh_edges edges;
    int64_t turned = 0;
    if (marks) {
        memset(marks->mark, 0, (size_t)mesh->triangle_count);
        marks->marked = 0;
    }
    ISO_TRY(iso_mesh_edges_new(&edges, mesh));
    iso_status status = iso_mesh_orient(&turned, mesh, &edges, marks);
    if (status == ISO_OK && turned > 0) {
        mesh->defects.flipped_triangles += turned;
        iso_mesh_edges_free(&edges);
        ISO_TRY(iso_mesh_edges_new(&edges, mesh));
    }
    if (status == ISO_OK)
        status = iso_mesh_edges_pair(open, mesh, &edges);
    iso_mesh_edges_free(&edges);
    return status;
}

static iso_status count_bad_edges(iso_mesh *mesh) {
    iso_mesh_edges edges;
    ISO_TRY(iso_mesh_edges_new(&edges, mesh));
    mesh->defects.bad_edges = iso_mesh_edges_bad(&edges, mesh);
    iso_mesh_edges_free(&edges);
    return ISO_OK;
}

static iso_status none_left(const iso_mesh *mesh) {
    if (mesh->triangle_count > 0)
        return ISO_OK;
    return iso_fail(ISO_UNSLICEABLE,
                    "nothing is left of %lld triangles: %lld have no area, %lld lie back to back",
                    (long long)mesh->defects.triangles_read, (long long)mesh->defects.degenerate,
                    (long long)mesh->defects.cancelled);
}

/* Weld the seams if that leaves fewer edges open, else let everything be. `saved` holds origin[].
 */
static iso_status try_seams(int64_t *open, iso_mesh *mesh, int32_t *saved, sheets *marks) {
    int32_t triangles = mesh->triangle_count;
    iso_mesh_defects before = mesh->defects;
    int64_t merged, left;
    ISO_TRY(iso_mesh_weld_seams(&merged, mesh));
    if (merged == 0)
        return ISO_OK;
    iso_mesh_drop_degenerate(mesh);
    ISO_TRY(iso_mesh_drop_coincident(mesh));
    iso_status status = mesh->triangle_count ? link_again(&left, mesh, marks) : ISO_UNSLICEABLE;
    if (status == ISO_OK && left < *open) {
        mesh->defects.welded_vertices = merged;
        *open = left;
        return ISO_OK;
    }
    if (status != ISO_OK && status != ISO_UNSLICEABLE)
        return status;
    mesh->triangle_count = triangles;
    mesh->defects = before;
    memcpy(mesh->origin, saved, 3 * (size_t)triangles * sizeof *saved);
    return link_again(open, mesh, marks);
}

static iso_status weld_seams(int64_t *open, iso_mesh *mesh, sheets *marks) {
    int32_t *saved;
    ISO_TRY(ISO_ALLOCATE(saved, 3 * (int64_t)mesh->triangle_count));
    memcpy(saved, mesh->origin, 3 * (size_t)mesh->triangle_count * sizeof *saved);
    iso_status status = try_seams(open, mesh, saved, marks);
    iso_release(saved);
    return status;
}

/* Forget vertices that no dart uses; keep the order of the rest. */
static iso_status drop_unused_vertices(iso_mesh *mesh) {
    int32_t *name;
    ISO_TRY(ISO_ALLOCATE(name, mesh->vertex_count));
    memset(name, 0, (size_t)mesh->vertex_count * sizeof *name);
    int32_t darts = 3 * mesh->triangle_count, kept = 0;
    for (int32_t a = 0; a < darts; a++)
        name[mesh->origin[a]] = 1;
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        if (!name[v])
            continue;
        mesh->position[kept] = mesh->position[v];
        name[v] = kept++;
    }
    if (kept < mesh->vertex_count)
        for (int32_t a = 0; a < darts; a++)
            mesh->origin[a] = name[mesh->origin[a]];
    mesh->vertex_count = kept;
    iso_release(name);
    return ISO_OK;
}

void iso_mesh_find_box(iso_mesh *mesh) {
    iso_vec3 min = mesh->position[0], max = min;
    for (int32_t v = 1; v < mesh->vertex_count; v++) {
        iso_vec3 p = mesh->position[v];
        min.x = p.x < min.x ? p.x : min.x;
        min.y = p.y < min.y ? p.y : min.y;
        min.z = p.z < min.z ? p.z : min.z;
        max.x = p.x > max.x ? p.x : max.x;
        max.y = p.y > max.y ? p.y : max.y;
        max.z = p.z > max.z ? p.z : max.z;
    }
    mesh->min = min;
    mesh->max = max;
}

/* What can't be closed is taken out. The rest is linked anew, which may open it. */
static iso_status close_or_take(iso_mesh *mesh, int64_t open, sheets *marks) {
    while (mesh->triangle_count > 0) {
        if (open > 0 && marks->marked == 0)
            ISO_TRY(iso_mesh_close_holes(mesh, open, marks));
        if (marks->marked == 0)
            return ISO_OK;
        ISO_TRY(sheets_take(marks, mesh));
        ISO_TRY(link_again(&open, mesh, marks));
    }
    return ISO_OK;
}

/* marks: NULL, or room for them. */
static iso_status mend_edges(iso_mesh *mesh, int64_t open, int64_t excess, sheets *marks) {
    if (excess > 0) {
        ISO_TRY(count_bad_edges(mesh));
        ISO_TRY(iso_mesh_drop_coincident(mesh));
        ISO_TRY(none_left(mesh));
        ISO_TRY(link_again(&open, mesh, marks));
    } else {
        mesh->defects.bad_edges = open;
    }
    if (open > 0)
        ISO_TRY(weld_seams(&open, mesh, marks));
    if (marks)
        return close_or_take(mesh, open, marks);
    return open > 0 ? iso_mesh_close_holes(mesh, open, NULL) : ISO_OK;
}

static iso_status mend_and_thicken(iso_mesh *mesh, int64_t open, int64_t excess, double thickness) {
    sheets taken = {.thickness = thickness};
    ISO_TRY(ISO_ALLOCATE(taken.mark, mesh->triangle_count));
    memset(taken.mark, 0, (size_t)mesh->triangle_count);
    iso_status status = mend_edges(mesh, open, excess, &taken);
    if (status == ISO_OK)
        status = sheets_thicken(mesh, &taken);
    sheets_free(&taken);
    return status;
}

iso_status iso_mesh_repair(iso_mesh *mesh, int64_t open, int64_t excess, double thickness) {
    const iso_mesh_defects *defects = &mesh->defects;
    ISO_TRY(none_left(mesh));
    if (open > 0 || excess > 0)
        ISO_TRY(thickness > 0 ? mend_and_thicken(mesh, open, excess, thickness)
                              : mend_edges(mesh, open, excess, NULL));
    ISO_TRY(iso_mesh_turn_shells(mesh));
    ISO_TRY(none_left(mesh));
    if (defects->degenerate || defects->duplicate || defects->cancelled ||
        defects->welded_vertices || defects->sheets)
        ISO_TRY(drop_unused_vertices(mesh));
    iso_mesh_find_box(mesh);
    return ISO_OK;
}

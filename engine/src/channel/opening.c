#include "channel/opening.h"

#include "planar/triangulation.h"

static iso_status list(iso_point **corner, int64_t *count, const iso_triangulation *mesh) {
    ISO_TRY(ISO_ALLOCATE(*corner, 3 * (int64_t)mesh->triangle_count));
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        if (!mesh->inside[t])
            continue;
        for (int k = 0; k < 3; k++)
            (*corner)[3 * *count + k] = mesh->vertex[mesh->origin[3 * t + k]];
        ++*count;
    }
    return ISO_OK;
}

static iso_status triangulate_clean(iso_point **corner, int64_t *count, const iso_region *raw,
                                    iso_planar_scratch *scratch) {
    iso_region region = {0};
    iso_arena arena = {0};
    iso_triangulation mesh;
    iso_status status = iso_region_clean(&region, raw, ISO_FILL_EVEN_ODD, scratch);
    if (status == ISO_OK &&
        (region.count != raw->count || region.first[region.count] != raw->first[raw->count]))
        status = iso_fail(ISO_NOT_VERIFIED, "inlets and outlets overlap on the mould's side, or "
                                            "are beyond it: a larger pitch or margin may do");
    if (status == ISO_OK)
        status = triangulate(&mesh, &region, &arena);
    if (status == ISO_OK)
        status = list(corner, count, &mesh);
    iso_arena_free(&arena);
    iso_region_free(&region);
    return status;
}

iso_status side_with_openings(iso_point **corner, int64_t *count, const iso_region *raw) {
    iso_planar_scratch *scratch;
    *corner = NULL;
    *count = 0;
    ISO_TRY(iso_planar_scratch_new(&scratch));
    iso_status status = triangulate_clean(corner, count, raw, scratch);
    iso_planar_scratch_free(scratch);
    return status;
}

#include "lattice/skin.h"

#include <isoslice/solid.h>

#include "base/memory.h"

typedef struct skin_sides {
    const iso_solid *solid;
    iso_vec3 origin;
} skin_sides;

enum { POINTS = 256 };

/* What overlaps is inside once, and hollows are outside: so by the winding number, not by what can
 * be reached from outside. */
static iso_status tell_inside(void *payload, uint8_t *inside, const iso_vec3 *point,
                              int64_t count) {
    const skin_sides *sides = payload;
    iso_vec3 at[POINTS];
    int32_t winding[POINTS];
    for (int64_t first = 0, n; first < count; first += n) {
        n = count - first < POINTS ? count - first : POINTS;
        for (int64_t i = 0; i < n; i++) {
            iso_vec3 p = point[first + i], origin = sides->origin;
            at[i] = (iso_vec3){p.x + origin.x, p.y + origin.y, p.z + origin.z};
        }
        ISO_TRY(iso_solid_winding(winding, NULL, sides->solid, at, n, NULL));
        for (int64_t i = 0; i < n; i++)
            inside[first + i] = winding[i] > 0;
    }
    return ISO_OK;
}

static iso_status collect(iso_vec3 **corner, int64_t *triangles, const iso_mesh *mesh,
                          int32_t count, iso_vec3 origin) {
    *triangles = 0;
    for (int32_t m = 0; m < count; m++)
        *triangles += mesh[m].triangle_count;
    ISO_TRY(ISO_ALLOCATE(*corner, 3 * *triangles));
    iso_vec3 *to = *corner;
    for (int32_t m = 0; m < count; m++) {
        for (int32_t i = 0; i < 3 * mesh[m].triangle_count; i++) {
            iso_vec3 p = mesh[m].position[mesh[m].origin[i]];
            *to++ = (iso_vec3){p.x - origin.x, p.y - origin.y, p.z - origin.z};
        }
    }
    return ISO_OK;
}

iso_status skin_make(iso_volume **skin, const iso_mesh *mesh, int32_t count,
                     const iso_skin_options *options) {
    *skin = NULL;
    iso_solid *solid;
    iso_vec3 *corner = NULL;
    ISO_TRY(iso_solid_new(&solid, mesh, count));
    skin_sides sides = {solid, options->origin};
    iso_volume_surface surface = {.voxel = options->voxel,
                                  .outer = options->outer > 0 ? options->outer : 4 * options->voxel,
                                  .inner = options->inner,
                                  .inside = tell_inside,
                                  .payload = &sides};
    iso_status status = collect(&corner, &surface.count, mesh, count, options->origin);
    surface.corner = corner;
    if (status == ISO_OK)
        status = volume_from_surface(skin, &surface);
    iso_release(corner);
    iso_solid_free(solid);
    return status;
}

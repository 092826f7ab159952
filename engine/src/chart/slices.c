/* Curves of all levels become slices of a chart. */
#include <string.h>

#include "chart/kind.h"

static iso_status allocate(iso_slices *slices, const iso_curves *curves) {
    *slices = (iso_slices){.level_count = curves->level_count,
                           .contour_count = curves->contour_count,
                           .crossing_count = curves->crossing_count};
    ISO_TRY(ISO_ALLOCATE(slices->level_first, (int64_t)curves->level_count + 1));
    ISO_TRY(ISO_ALLOCATE(slices->contour_first, (int64_t)curves->contour_count + 1));
    return ISO_ALLOCATE(slices->point, curves->crossing_count);
}

/* Contours become those of the map, one by one. */
static iso_status map_slices(iso_slices *slices, const chart *map, const iso_curves *curves) {
    iso_status status = allocate(slices, curves);
    if (status != ISO_OK) {
        iso_slices_free(slices);
        return status;
    }
    memcpy(slices->level_first, curves->level_first,
           ((size_t)curves->level_count + 1) * sizeof *slices->level_first);
    memcpy(slices->contour_first, curves->contour_first,
           ((size_t)curves->contour_count + 1) * sizeof *slices->contour_first);
    chart_down(slices->point, map, curves->point, curves->crossing_count);
    return ISO_OK;
}

/* The map of a sphere tears where it ends, straight down. */
static iso_status check_sphere(const chart *map, const iso_curves *curves) {
    for (int64_t i = 0; i < curves->crossing_count; i++) {
        iso_vec3 at = curves->point[i], c = map->center;
        double x = at.x - c.x, y = at.y - c.y, z = at.z - c.z;
        if (z < 0 && x * x + y * y < 0.25 * z * z)
            return iso_fail(ISO_OUTSIDE,
                            "at x %.3f y %.3f z %.3f mm (from the middle of the object and its "
                            "foot) the object reaches under the center of its spherical layers: "
                            "choose a center further below",
                            at.x, at.y, at.z);
    }
    return ISO_OK;
}

/* mm: nearer to a fan's axis its layers are too thin for anything. */
static const double axis_free = 0.1;

static iso_status check_fan(const iso_slices *slices, const iso_curves *curves) {
    for (int64_t i = 0; i < slices->crossing_count; i++) {
        iso_vec3 at = curves->point[i];
        if (slices->point[i].y < axis_free)
            return iso_fail(ISO_OUTSIDE,
                            "at x %.3f y %.3f z %.3f mm (from the middle of the object and its "
                            "foot) the object reaches to the axis of the fan, where all layers "
                            "meet: move the axis away from the object",
                            at.x, at.y, at.z);
    }
    return ISO_OK;
}

iso_status chart_slices(iso_slices *slices, const chart *map, const iso_curves *curves,
                        double margin) {
    *slices = (iso_slices){0};
    if (map->kind == CHART_GRAPH)
        ISO_TRY(graph_check(map, curves->point, curves->crossing_count));
    if (map->kind == CHART_SPHERE)
        ISO_TRY(check_sphere(map, curves));
    if (map->period > 0)
        return unroll_slices(slices, map, curves, margin);
    ISO_TRY(map_slices(slices, map, curves));
    iso_status status = map->kind == CHART_FAN ? check_fan(slices, curves) : ISO_OK;
    if (status != ISO_OK)
        iso_slices_free(slices);
    return status;
}

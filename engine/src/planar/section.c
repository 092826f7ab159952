#include "planar/section.h"

#include "planar/region.h"

static iso_status outside(int32_t level, iso_vec2 p) {
    return iso_fail(ISO_OUTSIDE,
                    "layer %d reaches to (%.3f, %.3f) mm, beyond the +-%.1f mm that can be sliced",
                    (int)level + 1, p.x, p.y, iso_mm(ISO_COORDINATE_MAX));
}

iso_status section_add(iso_region *raw, const iso_slices *slices, int32_t level) {
    const double limit = (double)ISO_COORDINATE_MAX / ISO_UNITS_PER_MM - 1;
    int32_t from = slices->level_first[level], to = slices->level_first[level + 1];
    int64_t used = raw->count ? raw->first[raw->count] : 0;
    int64_t points = slices->contour_first[to] - slices->contour_first[from];
    ISO_TRY(region_reserve(raw, (int64_t)raw->count + to - from, used + points));
    int32_t n = (int32_t)used;
    for (int32_t c = from; c < to; c++) {
        for (int64_t i = slices->contour_first[c]; i < slices->contour_first[c + 1]; i++) {
            iso_vec2 p = slices->point[i];
            if (!(p.x >= -limit && p.x <= limit && p.y >= -limit && p.y <= limit))
                return outside(level, p);
            raw->point[n++] = (iso_point){iso_units(p.x), iso_units(p.y)};
        }
        raw->parent[raw->count++] = -1;
        raw->first[raw->count] = n;
    }
    return ISO_OK;
}

double section_area(const iso_slices *slices, int32_t level) {
    double sum = 0;
    for (int32_t c = slices->level_first[level]; c < slices->level_first[level + 1]; c++) {
        int64_t first = slices->contour_first[c], end = slices->contour_first[c + 1];
        iso_vec2 base = slices->point[first];
        for (int64_t i = first; i < end; i++) {
            iso_vec2 a = slices->point[i], b = slices->point[i + 1 == end ? first : i + 1];
            sum += (a.x - base.x) * (b.y - base.y) - (b.x - base.x) * (a.y - base.y);
        }
    }
    return sum / 2;
}

#include <isoslice/slice.h>

#include "base/memory.h"

void iso_slices_free(iso_slices *slices) {
    iso_release(slices->level_first);
    iso_release(slices->contour_first);
    iso_release(slices->point);
    *slices = (iso_slices){0};
}

iso_status iso_slices_validate(const iso_slices *slices) {
    const int32_t *level = slices->level_first;
    const int64_t *contour = slices->contour_first;
    if (level[0] != 0 || level[slices->level_count] != slices->contour_count)
        return iso_fail(ISO_BUG, "the levels hold contours %d to %d, not 0 to %d", level[0],
                        level[slices->level_count], slices->contour_count);
    for (int32_t i = 0; i < slices->level_count; i++)
        if (level[i] > level[i + 1])
            return iso_fail(ISO_BUG, "level %d starts at contour %d and ends at %d", i, level[i],
                            level[i + 1]);
    if (contour[0] != 0 || contour[slices->contour_count] != slices->crossing_count)
        return iso_fail(ISO_BUG, "the contours hold crossings %lld to %lld, not 0 to %lld",
                        (long long)contour[0], (long long)contour[slices->contour_count],
                        (long long)slices->crossing_count);
    /* two, where two triangles back to back hang on a surface by one edge */
    for (int32_t c = 0; c < slices->contour_count; c++)
        if (contour[c + 1] < contour[c] + 2)
            return iso_fail(ISO_BUG, "contour %d has fewer than two crossings", c);
    for (int64_t i = 0; i < slices->crossing_count; i++) {
        iso_vec2 p = slices->point[i];
        if (p.x - p.x != 0 || p.y - p.y != 0)
            return iso_fail(ISO_BUG, "crossing %lld is not finite", (long long)i);
    }
    return ISO_OK;
}

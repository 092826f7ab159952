#include <isoslice/slice.h>

#include "base/memory.h"

void iso_slices_free(iso_slices *slices) {
    iso_release(slices->level_first);
    iso_release(slices->contour_first);
    iso_release(slices->point);
    *slices = (iso_slices){0};
}

static iso_status allocate_slices(iso_slices *s) {
    ISO_TRY(ISO_ALLOCATE(s->level_first, (int64_t)s->level_count + 1));
    ISO_TRY(ISO_ALLOCATE(s->contour_first, (int64_t)s->contour_count + 1));
    return ISO_ALLOCATE(s->point, s->crossing_count);
}

/* Append the contours that `from` has on a level. `contours` and `crossings` count what is there.
 */
static void copy_level(iso_slices *to, const iso_slices *from, int32_t level, int32_t *contours,
                       int64_t *crossings) {
    int32_t begin = from->level_first[level], end = from->level_first[level + 1];
    int64_t first = from->contour_first[begin], count = from->contour_first[end] - first;
    for (int32_t c = begin; c < end; c++)
        to->contour_first[(*contours)++] = *crossings + from->contour_first[c] - first;
    if (count > 0)
        memcpy(to->point + *crossings, from->point + first, (size_t)count * sizeof *to->point);
    *crossings += count;
}

iso_status iso_slices_join(iso_slices *joined, const iso_slices *slices, int32_t count) {
    iso_slices out = {.level_count = count > 0 ? slices[0].level_count : 0};
    int64_t all = 0, crossings = 0;
    int32_t contours = 0;
    *joined = (iso_slices){0};
    for (int32_t i = 0; i < count; i++) {
        if (slices[i].level_count != out.level_count)
            return iso_fail(ISO_USAGE, "model %d is cut at %d levels, the first one at %d", i + 1,
                            slices[i].level_count, out.level_count);
        all += slices[i].contour_count;
        out.crossing_count += slices[i].crossing_count;
    }
    if (all > INT32_MAX - 1)
        return iso_fail(ISO_UNSLICEABLE, "more than %d contours", INT32_MAX - 1);
    out.contour_count = (int32_t)all;
    iso_status status = allocate_slices(&out);
    if (status != ISO_OK) {
        iso_slices_free(&out);
        return status;
    }
    for (int32_t l = 0; l < out.level_count; l++) {
        out.level_first[l] = contours;
        for (int32_t i = 0; i < count; i++)
            copy_level(&out, &slices[i], l, &contours, &crossings);
    }
    out.level_first[out.level_count] = contours;
    out.contour_first[contours] = crossings;
    *joined = out;
    return ISO_OK;
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

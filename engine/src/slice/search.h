/* Which level comes first at or above a height? */
#ifndef ISO_SLICE_SEARCH_H
#define ISO_SLICE_SEARCH_H

#include <isoslice/slice.h>

/* Levels per mm, for levels_first_at. There is at least one level. */
static inline double levels_scale(const iso_levels *levels) {
    double span = levels->cut[levels->count - 1] - levels->cut[0];
    return span > 0 ? (levels->count - 1) / span : 0;
}

/* Guess by proportion, then step: right for levels of any spacing, quick for even ones. */
static inline int32_t levels_first_at(const iso_levels *levels, double scale, double z) {
    const double *cut = levels->cut;
    int32_t count = levels->count;
    double guess = (z - cut[0]) * scale;
    int32_t i = guess <= 0 ? 0 : guess >= count ? count : (int32_t)guess;
    while (i > 0 && cut[i - 1] >= z)
        i--;
    while (i < count && cut[i] < z)
        i++;
    return i;
}

#endif

/* Which level comes first at or above a height? */
#ifndef ISO_SLICE_SEARCH_H
#define ISO_SLICE_SEARCH_H

#include <stdint.h>

/* Levels per mm, for levels_first_at. `cut`: [count] ascending, one at least. */
static inline double levels_scale(const double *cut, int32_t count) {
    double span = cut[count - 1] - cut[0];
    return span > 0 ? (count - 1) / span : 0;
}

/* Guess by proportion, then step: right for levels of any spacing, quick for even ones. Levels that
 * are next to each other as doubles have no proportion: their guess is no number. */
static inline int32_t levels_first_at(const double *cut, int32_t count, double scale, double z) {
    double guess = (z - cut[0]) * scale;
    int32_t i = !(guess > 0) ? 0 : guess >= count ? count : (int32_t)guess;
    while (i > 0 && cut[i - 1] >= z)
        i--;
    while (i < count && cut[i] < z)
        i++;
    return i;
}

#endif

/* All levels at once, no search and no hash (paper, 5).
 *
 * A difference array counts the crossings of every level, a second pass over the darts deals them
 * out to their levels in the order of the darts, and each level's orbits are walked from there: the
 * successor of a dart is one of two darts of the neighbouring triangle. O(n + K + M) for n darts, K
 * levels and M crossings. */
#include "slice/orbits.h"

#include <stdbool.h>

/* The lb of a triangle's corners, the first one again at the end; false if it meets no level. */
static inline bool corners(int32_t l[4], const orbits *o, int32_t triangle) {
    for (int k = 0; k < 3; k++)
        l[k] = o->lb[o->origin[3 * triangle + k]];
    l[3] = l[0];
    return l[0] != l[1] || l[1] != l[2];
}

static void count_crossings(orbits *o) {
    int64_t *change = o->first + 1; /* change[i]: darts that begin to cross at level i, less ends */
    int32_t l[4];
    for (int32_t t = 0; t < o->triangle_count; t++)
        if (corners(l, o, t))
            for (int k = 0; k < 3; k++)
                if (l[k] < l[k + 1])
                    change[l[k]]++, change[l[k + 1]]--;
    for (int32_t i = 1; i < o->level_count; i++)
        change[i] += change[i - 1];
    for (int32_t i = 1; i < o->level_count; i++)
        change[i] += change[i - 1];
}

/* first[i] moves through its level and ends as the start of the next; shifting it back restores it.
 */
static void deal_darts(orbits *o) {
    int32_t l[4];
    for (int32_t t = 0; t < o->triangle_count; t++)
        if (corners(l, o, t))
            for (int k = 0; k < 3; k++)
                for (int32_t i = l[k]; i < l[k + 1]; i++)
                    o->dart[o->first[i]++] = 3 * t + k;
    for (int32_t i = o->level_count; i > 0; i--)
        o->first[i] = o->first[i - 1];
    o->first[0] = 0;
}

iso_status orbits_prepare(orbits *o) {
    ISO_TRY(ISO_ALLOCATE(o->level_first, (int64_t)o->level_count + 1));
    ISO_TRY(ISO_GROW(o->contour_first, o->contour_capacity, 1));
    ISO_TRY(ISO_ALLOCATE(o->first, (int64_t)o->level_count + 2));
    memset(o->first, 0, ((size_t)o->level_count + 2) * sizeof *o->first);
    o->level_first[0] = 0;
    o->contour_first[0] = 0;
    if (o->level_count > 0)
        count_crossings(o);
    o->crossing_count = o->first[o->level_count];
    ISO_TRY(ISO_ALLOCATE(o->dart, o->crossing_count));
    if (o->level_count > 0)
        deal_darts(o);
    return ISO_OK;
}

iso_status orbits_prepare_walk(orbits *o) {
    int64_t words = (3 * (int64_t)o->triangle_count + 63) / 64;
    ISO_TRY(ISO_ALLOCATE(o->passed, words));
    memset(o->passed, 0, (size_t)words * sizeof *o->passed);
    return ISO_OK;
}

iso_status orbits_add_contour(orbits *o, int64_t at) {
    if (o->contour_count == INT32_MAX - 1)
        return iso_fail(ISO_UNSLICEABLE, "more than %d contours", INT32_MAX - 1);
    ISO_TRY(ISO_GROW(o->contour_first, o->contour_capacity, o->contour_count + 2));
    o->contour_first[++o->contour_count] = at;
    return ISO_OK;
}

void orbits_release(orbits *o) {
    iso_release(o->first);
    iso_release(o->dart);
    iso_release(o->passed);
    o->first = NULL, o->dart = NULL, o->passed = NULL;
}

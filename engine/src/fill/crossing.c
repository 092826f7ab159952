#include "fill/crossing.h"

#include <stdbool.h>
#include <string.h>

#include "planar/predicate.h"

static iso_point edge_end(const iso_region *region, int32_t i) {
    int32_t low = 0, high = region->count; /* the contour with first[low] <= i < first[low + 1] */
    while (high - low > 1) {
        int32_t middle = low + (high - low) / 2;
        if (region->first[middle] <= i)
            low = middle;
        else
            high = middle;
    }
    return region->point[i + 1 < region->first[low + 1] ? i + 1 : region->first[low]];
}

/* Exactly: does a's edge pass left of b's on a line that crosses both? The edges of a region don't
 * cross, so the end that lies beside the other edge decides, by its orientation. Edges on top of
 * each other (no region has them) go by number. */
static bool edge_before(const iso_crossing *a, const iso_crossing *b, const iso_region *region,
                        const iso_sweep *sweep) {
    iso_point a0 = region->point[a->edge >> 1], a1 = edge_end(region, a->edge >> 1);
    iso_point b0 = region->point[b->edge >> 1], b1 = edge_end(region, b->edge >> 1);
    iso_point low_a = a->edge & 1 ? a0 : a1, high_a = a->edge & 1 ? a1 : a0;
    iso_point low_b = b->edge & 1 ? b0 : b1, high_b = b->edge & 1 ? b1 : b0;
    int64_t turn = iso_sweep_v(sweep, low_a) >= iso_sweep_v(sweep, low_b)
                       ? orient2d(low_b, high_b, low_a)
                       : -orient2d(low_a, high_a, low_b);
    if (turn == 0)
        turn = iso_sweep_v(sweep, high_a) <= iso_sweep_v(sweep, high_b)
                   ? orient2d(low_b, high_b, high_a)
                   : -orient2d(low_a, high_a, high_b);
    return turn ? turn > 0 : a->edge < b->edge;
}

/* Rounded points tell the order unless they are neighbours on the axis nearer to the line. */
static inline bool before(const iso_crossing *a, const iso_crossing *b, const iso_region *region,
                          const iso_sweep *sweep) {
    int32_t ahead = sweep->along_x * (b->at.x - a->at.x) + sweep->along_y * (b->at.y - a->at.y);
    if (ahead > 1 || ahead < -1)
        return ahead > 0;
    return edge_before(a, b, region, sweep);
}

enum { INSERTION_MAX = 16 };

static void insertion_sort(iso_crossing *crossing, int32_t count, const iso_region *region,
                           const iso_sweep *sweep) {
    for (int32_t i = 1; i < count; i++) {
        iso_crossing moving = crossing[i];
        int32_t j = i;
        for (; j > 0 && before(&moving, &crossing[j - 1], region, sweep); j--)
            crossing[j] = crossing[j - 1];
        crossing[j] = moving;
    }
}

static void merge(iso_crossing *to, const iso_crossing *from, int32_t middle, int32_t count,
                  const iso_region *region, const iso_sweep *sweep) {
    int32_t i = 0, j = middle;
    for (int32_t k = 0; k < count; k++) {
        bool second = i == middle || (j < count && before(&from[j], &from[i], region, sweep));
        to[k] = from[second ? j++ : i++];
    }
}

void iso_crossing_sort(iso_crossing *crossing, int32_t count, iso_crossing *spare,
                       const iso_region *region, const iso_sweep *sweep) {
    for (int32_t i = 0; i < count; i += INSERTION_MAX)
        insertion_sort(crossing + i, count - i < INSERTION_MAX ? count - i : INSERTION_MAX, region,
                       sweep);
    for (int32_t width = INSERTION_MAX; width < count; width *= 2) {
        for (int32_t i = 0; i + width < count; i += 2 * width) {
            int32_t both = count - i < 2 * width ? count - i : 2 * width;
            memcpy(spare, crossing + i, (size_t)both * sizeof *spare);
            merge(crossing + i, spare, width, both, region, sweep);
        }
    }
}

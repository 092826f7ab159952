/* Union-find in one array: above[i] <= i leads to the root of i's set, its least member. */
#ifndef ISO_MESH_UNION_FIND_H
#define ISO_MESH_UNION_FIND_H

#include <stdint.h>

static inline int32_t iso_root_of(int32_t *above, int32_t i) {
    while (above[i] != i) {
        above[i] = above[above[i]];
        i = above[i];
    }
    return i;
}

/* Join the sets of two roots; returns the root of both. */
static inline int32_t iso_join_roots(int32_t *above, int32_t a, int32_t b) {
    if (a < b)
        return above[b] = a;
    return above[a] = b;
}

#endif

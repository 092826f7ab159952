/* The table of isoslice-solid.so: which of many boxes does a ray along an axis, or a box, meet?
 *
 * What it answers decides nothing by itself: it says where to look. Every box that holds a point of
 * the ray or box, all closed, is among the answers; others may be. */
#ifndef ISO_SOLID_TREE_H
#define ISO_SOLID_TREE_H

#include <stdint.h>

#include "solid/module.h"

typedef struct solid_tree solid_tree;

typedef struct solid_rays {
    const float *origin;
    const uint8_t *direction;
    int32_t count;
    int32_t capacity;
} solid_rays;

typedef struct solid_boxes {
    const float *box; /* [6 count] as of tree_new */
    int32_t count;
} solid_boxes;

/* ISO_NO_MEMORY; ISO_BAD_CONFIG: no processor for Embree; ISO_BUG: Embree does not like a call. */
typedef struct solid_table {
    module_header header;

    /* box[6 i]: least x y z, largest x y z of box i; not kept. */
    iso_status (*tree_new)(solid_tree **tree, const float *box, int32_t count);
    void (*tree_free)(solid_tree *tree);

    /* Boxes that the ray from origin[3 i] in direction[i] = 2 axis + backward meets, in the tree's
     * order: found[first[i]] to found[first[i + 1] - 1]. Rays are taken until the next one's boxes
     * would go beyond `capacity`, and *done says how many were. *done = 0: `capacity` is less than
     * what the first ray needs, which is first[1]. Any number of threads at once. */
    iso_status (*tree_rays)(int32_t *found, int32_t *first, int32_t *done, const solid_tree *tree,
                            const solid_rays *rays);

    /* Pairs of a box of the tree, pair[2 i], and one of `boxes`, pair[2 i + 1], that meet, in any
     * order. *count says how many there are, also if that is more than `capacity`: then the rest is
     * left out. Any number of threads at once. */
    iso_status (*tree_boxes)(int32_t *pair, int64_t *count, int64_t capacity,
                             const solid_tree *tree, const solid_boxes *boxes);
} solid_table;

#endif

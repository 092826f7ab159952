/* Fuzzy skin: outer walls drawn with a jitter. */
#ifndef ISO_WALL_FUZZY_H
#define ISO_WALL_FUZZY_H

#include <stdbool.h>

#include <isoslice/path.h>

typedef struct iso_fuzzy_options {
    bool on;
    bool holes;        /* walls around holes as well */
    int32_t thickness; /* units that a point may be moved to either side */
    int32_t distance;  /* units between points, on average */
} iso_fuzzy_options;

/* Draw the outermost walls among the paths from `begin` on anew. The jitter depends on nothing but
 * the paths and `seed`. `spare` is room for them. */
iso_status fuzzy_skin(iso_paths *paths, iso_paths *spare, int32_t begin,
                      const iso_fuzzy_options *options, uint64_t seed) ISO_MUST_CHECK;

#endif

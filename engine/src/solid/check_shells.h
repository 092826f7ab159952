/* What kind of boundary each shell is, by the winding numbers in front of and behind it: of all its
 * triangles by rays through a tree, or of some of them in the planes of levels. */
#ifndef ISO_SOLID_CHECK_SHELLS_H
#define ISO_SOLID_CHECK_SHELLS_H

#include <isoslice/solid.h>

#include "solid/check.h"
#include "solid/planes.h"

typedef struct shell_kinds {
    int64_t shells;
    int64_t overlapping; /* bound material in some places and not in others */
    int64_t nested;      /* lie in material */
    int64_t hollow;      /* lie in none */
    int64_t cavities;    /* of the rest: of negative volume */
    int64_t points;
} shell_kinds;

/* All triangles. ISO_BAD_CONFIG: the module isoslice-solid is missing. */
iso_status shells_ask_rays(shell_kinds *kinds, const solid_subject *subject,
                           iso_pool *pool) ISO_MUST_CHECK;

typedef struct shell_place {
    iso_vec2 beside[2]; /* in front of a triangle and behind it, in the plane of the level */
    int32_t level, number;
    int32_t shell;
    uint8_t seen;
} shell_place;

typedef struct shell_places {
    shell_place *place; /* by level */
    int64_t *first;     /* [levels + 1]; NULL if there are no places */
    int64_t count;
    double *volume; /* [shells] */
    int32_t shells;
} shell_places;

/* A few of each shell that a level meets. */
iso_status shell_places_choose(shell_places *places, const solid_planes *planes) ISO_MUST_CHECK;
void shell_places_free(shell_places *places);

static inline int64_t shell_places_of(const shell_places *places, int32_t level) {
    return places->first ? places->first[level + 1] - places->first[level] : 0;
}

/* Two points a place of the level, which is at z, and their winding numbers. Any number of threads
 * at once, each at a level of its own. */
void shell_places_points(iso_vec3 *point, const shell_places *places, int32_t level, double z);
void shell_places_note(shell_places *places, const int32_t *winding, int32_t level);

iso_status shell_places_sort(shell_kinds *kinds, const shell_places *places) ISO_MUST_CHECK;

#endif

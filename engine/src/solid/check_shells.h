/* What kind of boundary each shell is, by the winding numbers in front of and behind it. */
#ifndef ISO_SOLID_CHECK_SHELLS_H
#define ISO_SOLID_CHECK_SHELLS_H

#include <isoslice/solid.h>

#include "solid/check.h"

typedef struct shell_kinds {
    int64_t shells;
    int64_t overlapping; /* bound material in some places and not in others */
    int64_t nested;      /* lie in material */
    int64_t hollow;      /* lie in none */
    int64_t cavities;    /* of the rest: of negative volume */
    int64_t points;
} shell_kinds;

/* All triangles are asked in full mode, else some of each shell. */
iso_status shells_sort_by_kind(shell_kinds *kinds, const solid_subject *subject,
                               const iso_solid *solid, iso_pool *pool) ISO_MUST_CHECK;

#endif

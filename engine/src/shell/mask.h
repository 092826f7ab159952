/* Regions as bits, for a quick look: most layers have nothing that hangs over air, and it takes
 * little to see that. A cell counts as inside if its middle is. */
#ifndef ISO_SHELL_MASK_H
#define ISO_SHELL_MASK_H

#include <stdbool.h>

#include <isoslice/planar.h>

#include "base/memory.h"

typedef struct iso_mask {
    iso_point origin; /* lower left corner of the lowest leftmost cell */
    int32_t cell;     /* units */
    double per_unit;  /* cells */
    int32_t columns, rows;
    int32_t words; /* of a row; cell (c, r) is bit c & 63 of bit[r * words + c / 64] */
    uint64_t *bit;
} iso_mask;

/* The cells of the region within the box and a cell around it; in the arena. Cells that would be
 * too many are made larger. */
iso_status mask_of(iso_mask *mask, const iso_region *region, const iso_box *box, int32_t cell,
                   iso_arena *arena) ISO_MUST_CHECK;

/* Each cell takes its four neighbours in. */
iso_status mask_grow(iso_mask *mask, iso_arena *arena) ISO_MUST_CHECK;

/* Do the masks, of the same box and cell, share a cell and its four neighbours? `core` is the box
 * of all such cells. */
bool masks_share_core(iso_box *core, const iso_mask *a, const iso_mask *b);

static inline bool mask_has(const iso_mask *mask, iso_point p) {
    if (p.x < mask->origin.x || p.y < mask->origin.y)
        return false;
    /* half a unit keeps the products off the whole numbers: these are quotients rounded down */
    int64_t c = (int64_t)((p.x - mask->origin.x + 0.5) * mask->per_unit);
    int64_t r = (int64_t)((p.y - mask->origin.y + 0.5) * mask->per_unit);
    if (c >= mask->columns || r >= mask->rows)
        return false;
    return mask->bit[r * mask->words + (c >> 6)] >> (c & 63) & 1;
}

/* The box of the region; false if there is nothing in it. */
bool region_box(iso_box *box, const iso_region *region);

#endif

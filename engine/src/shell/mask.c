#include "shell/mask.h"

#include <math.h>

#include "planar/predicate.h"

#define CELLS_MAX (1 << 24)

bool region_box(iso_box *box, const iso_region *region) {
    if (region->count == 0)
        return false;
    *box = (iso_box){region->point[0], region->point[0]};
    for (int32_t i = 1; i < region->first[region->count]; i++)
        box_add(box, region->point[i]);
    return true;
}

/* Cells whose middles lie right of an edge are toggled; to begin with, only the first of each row.
 */
static void toggle_edge(iso_mask *mask, iso_point a, iso_point b) {
    double cell = mask->cell, x = a.x - mask->origin.x, y = a.y - mask->origin.y;
    double slope = ((double)b.x - a.x) / ((double)b.y - a.y);
    double low = fmin(a.y, b.y) - mask->origin.y, high = fmax(a.y, b.y) - mask->origin.y;
    int32_t r = low / cell - 0.5 < 0 ? 0 : (int32_t)ceil(low / cell - 0.5);
    for (; r < mask->rows && (r + 0.5) * cell < high; r++) {
        double at = (x + ((r + 0.5) * cell - y) * slope) / cell - 0.5;
        int32_t c = at < 0 ? 0 : at > mask->columns ? mask->columns : (int32_t)ceil(at);
        mask->bit[(int64_t)r * mask->words + (c >> 6)] ^= (uint64_t)1 << (c & 63);
    }
}

/* From the first toggled cell of each stretch on to its end: sums modulo 2 along the rows. */
static void spread(iso_mask *mask) {
    for (int32_t r = 0; r < mask->rows; r++) {
        uint64_t *row = mask->bit + (int64_t)r * mask->words, carry = 0;
        for (int32_t w = 0; w < mask->words; w++) {
            uint64_t bits = row[w];
            if (bits == 0) {
                row[w] = carry;
                continue;
            }
            for (int shift = 1; shift < 64; shift *= 2)
                bits ^= bits << shift;
            row[w] = bits ^= carry;
            carry = bits >> 63 ? ~(uint64_t)0 : 0;
        }
    }
}

iso_status mask_of(iso_mask *mask, const iso_region *region, const iso_box *box, int32_t cell,
                   iso_arena *arena) {
    double width = (double)box->max.x - box->min.x, height = (double)box->max.y - box->min.y;
    while ((width / cell + 3) * (height / cell + 3) > CELLS_MAX)
        cell *= 2;
    *mask = (iso_mask){
        .origin = {box->min.x - cell, box->min.y - cell}, .cell = cell, .per_unit = 1.0 / cell};
    mask->columns = (int32_t)(width / cell) + 3;
    mask->rows = (int32_t)(height / cell) + 3;
    mask->words = mask->columns / 64 + 1;
    int64_t words = (int64_t)mask->words * mask->rows;
    ISO_TRY(ISO_PUSH(mask->bit, arena, words));
    memset(mask->bit, 0, (size_t)words * sizeof *mask->bit);
    for (int32_t c = 0; c < region->count; c++) {
        int32_t first = region->first[c], end = region->first[c + 1];
        for (int32_t i = first, before = end - 1; i < end; before = i++)
            if (region->point[before].y != region->point[i].y)
                toggle_edge(mask, region->point[before], region->point[i]);
    }
    spread(mask);
    return ISO_OK;
}

iso_status mask_grow(iso_mask *mask, iso_arena *arena) {
    uint64_t *grown;
    int32_t words = mask->words;
    ISO_TRY(ISO_PUSH(grown, arena, (int64_t)words * mask->rows));
    for (int32_t r = 0; r < mask->rows; r++)
        for (int32_t w = 0; w < words; w++) {
            const uint64_t *at = mask->bit + (int64_t)r * words + w;
            uint64_t bits = at[0] | at[0] << 1 | at[0] >> 1;
            bits |= (w > 0 ? at[-1] >> 63 : 0) | (w + 1 < words ? at[1] << 63 : 0);
            bits |= (r > 0 ? at[-words] : 0) | (r + 1 < mask->rows ? at[words] : 0);
            grown[(int64_t)r * words + w] = bits;
        }
    mask->bit = grown;
    return ISO_OK;
}

static int lowest_bit(uint64_t bits) {
    return __builtin_ctzll(bits);
}

static int highest_bit(uint64_t bits) {
    return 63 - __builtin_clzll(bits);
}

bool masks_share_core(iso_box *core, const iso_mask *a, const iso_mask *b) {
    int32_t words = a->words, left = INT32_MAX, right = -1, low = -1, high = -1;
    for (int32_t r = 1; r + 1 < a->rows; r++)
        for (int32_t w = 0; w < words; w++) {
            const uint64_t *p = a->bit + (int64_t)r * words + w;
            const uint64_t *q = b->bit + (int64_t)r * words + w;
            uint64_t both = p[0] & q[0];
            if (both == 0)
                continue;
            uint64_t before = w > 0 ? (p[-1] & q[-1]) >> 63 : 0;
            uint64_t after = w + 1 < words ? (p[1] & q[1]) << 63 : 0;
            both &= (both << 1 | before) & (both >> 1 | after);
            both &= p[-words] & q[-words] & p[words] & q[words];
            if (both == 0)
                continue;
            int32_t first = 64 * w + lowest_bit(both), last = 64 * w + highest_bit(both);
            left = first < left ? first : left;
            right = last > right ? last : right;
            low = low < 0 ? r : low;
            high = r;
        }
    iso_point origin = a->origin;
    if (high < 0)
        return false;
    *core = (iso_box){{origin.x + left * a->cell, origin.y + low * a->cell},
                      {origin.x + (right + 1) * a->cell, origin.y + (high + 1) * a->cell}};
    return true;
}

#include "planar/island.h"

#include "planar/region.h"

/* Parents come before their children, so one pass numbers them all: a contour is outer if it has no
 * parent or a hole for one. */
iso_status islands_of(iso_islands *islands, const iso_region *region, iso_arena *arena) {
    int32_t count = region->count, *island, *end;
    uint8_t *hole;
    ISO_TRY(ISO_PUSH(island, arena, count));
    ISO_TRY(ISO_PUSH(hole, arena, count));
    ISO_TRY(ISO_PUSH(islands->contour, arena, count));
    ISO_TRY(ISO_PUSH(islands->first, arena, count + 1));
    ISO_TRY(ISO_PUSH(end, arena, count + 1));
    islands->count = 0;
    for (int32_t c = 0; c < count; c++) {
        int32_t parent = region->parent[c];
        hole[c] = parent >= 0 && !hole[parent];
        island[c] = hole[c] ? island[parent] : islands->count++;
    }
    memset(end, 0, (size_t)(count + 1) * sizeof *end);
    for (int32_t c = 0; c < count; c++)
        end[island[c] + 1]++;
    for (int32_t i = 0; i < islands->count; i++)
        end[i + 1] += end[i];
    memcpy(islands->first, end, (size_t)(islands->count + 1) * sizeof *end);
    for (int32_t c = 0; c < count; c++)
        islands->contour[end[island[c]]++] = c;
    return ISO_OK;
}

iso_status island_copy(iso_region *out, const iso_region *region, const iso_islands *islands,
                       int32_t island) {
    iso_region_clear(out);
    for (int32_t i = islands->first[island]; i < islands->first[island + 1]; i++) {
        int32_t c = islands->contour[i];
        ISO_TRY(iso_region_add(out, region->point + region->first[c],
                               region->first[c + 1] - region->first[c]));
        out->parent[out->count - 1] = i == islands->first[island] ? -1 : 0;
    }
    return ISO_OK;
}

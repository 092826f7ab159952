#include "planar/island.h"

#include "base/sort.h"
#include "planar/predicate.h"
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

typedef struct iso_island_box {
    iso_box box;
    int32_t island;
    int32_t reach; /* how far right this box or one before it goes */
} iso_island_box;

static bool island_box_less(const iso_island_box *a, const iso_island_box *b) {
    return a->box.min.x != b->box.min.x ? a->box.min.x < b->box.min.x : a->island < b->island;
}
ISO_SORT(sort_island_boxes, iso_island_box, island_box_less)

iso_status island_search_new(iso_island_search *search, const iso_region *region,
                             const iso_islands *islands, iso_arena *arena) {
    *search = (iso_island_search){.region = region, .islands = islands};
    iso_island_box *box;
    ISO_TRY(ISO_PUSH(box, arena, islands->count));
    search->box = box;
    for (int32_t i = 0; i < islands->count; i++) {
        int32_t outer = islands->contour[islands->first[i]];
        const iso_point *point = region->point + region->first[outer];
        box[i] = (iso_island_box){.box = {point[0], point[0]}, .island = i};
        for (int32_t k = 1; k < region->first[outer + 1] - region->first[outer]; k++)
            box_add(&box[i].box, point[k]);
    }
    sort_island_boxes(box, islands->count);
    for (int32_t i = 0; i < islands->count; i++) {
        int32_t before = i > 0 ? box[i - 1].reach : box[i].box.max.x;
        box[i].reach = box[i].box.max.x > before ? box[i].box.max.x : before;
    }
    return ISO_OK;
}

/* Inside the outer contour or on it, and inside none of the holes. */
static bool island_holds(const iso_island_search *search, int32_t island, iso_point point) {
    const iso_region *region = search->region;
    const iso_islands *islands = search->islands;
    for (int32_t i = islands->first[island]; i < islands->first[island + 1]; i++) {
        int32_t c = islands->contour[i];
        int32_t first[2] = {0, region->first[c + 1] - region->first[c]};
        iso_region contour = {
            .count = 1, .first = first, .point = region->point + region->first[c]};
        int side = iso_region_locate(&contour, point);
        if (i == islands->first[island] ? side < 0 : side > 0)
            return false;
    }
    return true;
}

int32_t island_at(const iso_island_search *search, iso_point point) {
    const iso_island_box *box = search->box;
    int32_t low = 0, end = search->islands->count, only = -1, candidates = 0;
    while (low < end) { /* boxes from here on start to the right of the point */
        int32_t middle = low + (end - low) / 2;
        if (box[middle].box.min.x <= point.x)
            low = middle + 1;
        else
            end = middle;
    }
    for (int32_t i = end; i-- > 0 && box[i].reach >= point.x;)
        if (box_has(&box[i].box, point)) {
            only = box[i].island;
            candidates++;
        }
    if (candidates < 2)
        return only;
    for (int32_t i = end; i-- > 0 && box[i].reach >= point.x;)
        if (box_has(&box[i].box, point) && island_holds(search, box[i].island, point))
            return box[i].island;
    return -1;
}

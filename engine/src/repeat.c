#include "repeat.h"

#include "base/memory.h"
#include "planar/region.h"

void repeat_free(iso_repeat *repeat) {
    iso_region_free(&repeat->region);
    iso_region_free(&repeat->area);
    iso_release(repeat->group);
    iso_paths_free(&repeat->paths);
    *repeat = (iso_repeat){0};
}

static bool same_bead(const iso_bead *a, const iso_bead *b) {
    return a->width == b->width && a->height == b->height && a->area == b->area &&
           a->spacing == b->spacing;
}

static bool same_wall(const iso_wall_options *a, const iso_wall_options *b) {
    return a->count == b->count && same_bead(&a->external, &b->external) &&
           same_bead(&a->inner, &b->inner) && a->external_first == b->external_first &&
           a->small_length == b->small_length && a->fill_inset == b->fill_inset &&
           a->arc_tolerance == b->arc_tolerance && a->thin_least == b->thin_least &&
           a->gap_least == b->gap_least && a->like.object == b->like.object &&
           a->like.tool == b->like.tool;
}

bool repeat_has(const iso_repeat *repeat, const iso_region *region, const iso_wall_options *wall) {
    return repeat->kept && same_wall(&repeat->wall, wall) && region_same(&repeat->region, region);
}

static iso_status copy_area(iso_region *to, const iso_region *from) {
    iso_region_clear(to);
    for (int32_t c = 0; c < from->count; c++) {
        ISO_TRY(
            iso_region_add(to, from->point + from->first[c], from->first[c + 1] - from->first[c]));
        to->parent[c] = from->parent[c];
    }
    return ISO_OK;
}

static iso_status copy_walls(const iso_walled *to, const iso_walled *from, int32_t object) {
    int32_t count = from->area->count;
    ISO_TRY(copy_area(to->area, from->area));
    ISO_TRY(ISO_GROW(*to->group, *to->group_capacity, count));
    if (count > 0)
        memcpy(*to->group, *from->group, (size_t)count * sizeof **to->group);
    iso_paths_clear(to->paths);
    return iso_paths_append(to->paths, from->paths, (iso_point){0, 0}, object);
}

iso_status repeat_copy(iso_walled *to, const iso_repeat *repeat) {
    iso_repeat kept = *repeat; /* read only: a walled's members can't be const */
    iso_walled from = {&kept.paths, &kept.area, &kept.group, &kept.group_capacity, kept.cost};
    to->cost = kept.cost;
    return copy_walls(to, &from, repeat->wall.like.object);
}

/* Two outlines of the same one are no harm: what is kept is compared point by point. */
static uint64_t mark_of(const iso_region *region) {
    uint64_t mark = (uint64_t)region->count;
    int32_t points = region->count > 0 ? region->first[region->count] : 0;
    for (int32_t i = 0; i < points; i++) {
        uint64_t at = (uint64_t)(uint32_t)region->point[i].x << 32 | (uint32_t)region->point[i].y;
        mark = (mark ^ at) * 0x9E3779B97F4A7C15ull;
        mark ^= mark >> 29;
    }
    return mark;
}

iso_status repeat_keep(iso_repeat *repeat, const iso_region *region, const iso_wall_options *wall,
                       const iso_walled *from) {
    uint64_t mark = mark_of(region);
    bool again = mark == repeat->last;
    repeat->last = mark;
    if (!again)
        return ISO_OK;
    iso_walled to = {&repeat->paths, &repeat->area, &repeat->group, &repeat->group_capacity,
                     from->cost};
    repeat->kept = false;
    ISO_TRY(copy_area(&repeat->region, region));
    ISO_TRY(copy_walls(&to, from, wall->like.object));
    repeat->wall = *wall;
    repeat->cost = from->cost;
    repeat->kept = true;
    return ISO_OK;
}

void counts_add(iso_planar_counts *sum, const iso_planar_counts *more, int sign) {
    sum->operations += sign * more->operations;
    sum->untouched += sign * more->untouched;
    sum->arranged += sign * more->arranged;
    sum->edges += sign * more->edges;
    sum->collisions += sign * more->collisions;
}

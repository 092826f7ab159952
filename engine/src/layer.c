#include "layer.h"

#include <time.h>

#include "planar/island.h"
#include "planar/region.h"
#include "planar/scratch.h"
#include "planar/section.h"
#include "wall/compensation.h"
#include "wall/fuzzy.h"

double iso_stage_clock(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

iso_status hand_new(iso_hand *hand) {
    *hand = (iso_hand){0};
    return iso_planar_scratch_new(&hand->planar);
}

void hand_free(iso_hand *hand) {
    iso_planar_scratch_free(hand->planar);
    iso_arena_free(&hand->arena);
    iso_region_free(&hand->raw);
    iso_region_free(&hand->island);
    iso_region_free(&hand->inside);
    iso_region_free(&hand->part);
    iso_paths_free(&hand->paths);
    modified_free(&hand->modified);
    repeat_free(&hand->repeat);
}

iso_status layer_new(iso_layer *layer, int32_t levels) {
    ISO_TRY(ISO_ALLOCATE(layer->run, levels));
    memset(layer->run, 0, (size_t)levels * sizeof *layer->run);
    layer->levels = levels;
    return ISO_OK;
}

void layer_free(iso_layer *layer) {
    for (int32_t k = 0; k < layer->levels; k++)
        iso_region_free(&layer->run[k]);
    iso_release(layer->run);
    iso_region_free(&layer->region);
    iso_region_free(&layer->area);
    iso_shell_free(&layer->shell);
    iso_region_free(&layer->together);
    iso_region_free(&layer->alone);
    iso_paths_free(&layer->paths);
    iso_release(layer->group);
}

/* Builds that check themselves check every region between the stages. */
static iso_status check(const iso_region *region, iso_hand *hand) {
#ifndef NDEBUG
    return iso_region_validate(region, hand->planar);
#else
    return ISO_OK;
#endif
}

/* ---- outline ---- */

static iso_status make_region(iso_layer *layer, iso_hand *hand, const iso_slices *slices,
                              int32_t model_count, int32_t index) {
    iso_region_clear(&hand->raw);
    for (int32_t m = 0; m < model_count; m++)
        ISO_TRY(section_add(&hand->raw, &slices[m], index));
    ISO_TRY(
        iso_region_simplify(&layer->region, &hand->raw, layer->settings.thinning, hand->planar));
    layer->square_mm = (double)iso_region_double_area(&layer->region) / 2 /
                       ((double)ISO_UNITS_PER_MM * ISO_UNITS_PER_MM);
    if (compensates(&layer->settings.compensation))
        ISO_TRY(compensate(&layer->region, (iso_region *[2]){&hand->island, &hand->inside},
                           &layer->settings.compensation, hand->planar));
    if (layer->settings.drains.count > 0)
        ISO_TRY(drains_cut(&layer->region, (iso_region *[2]){&hand->island, &hand->inside},
                           &layer->settings.drains, hand->planar));
    ISO_TRY(check(&layer->region, hand));
    return iso_region_simplify(&layer->run[0], &layer->region, layer->settings.coarse,
                               hand->planar);
}

/* Is the island within the contour? Points where they touch don't tell. */
static bool is_within(const iso_region *island, const iso_region *contour) {
    int side = 0;
    for (int32_t i = 0; i < island->first[1] && side == 0; i++)
        side = iso_region_locate(contour, island->point[i]);
    return side > 0;
}

/* The innermost hole of the area so far that the island lies in, or -1. Islands come after those
 * around them, so it is the last one. */
static int32_t hole_around(const iso_region *area, const iso_region *island) {
    for (int32_t c = area->count; c-- > 0;) {
        int32_t first[2] = {0, area->first[c + 1] - area->first[c]};
        iso_region contour = {.count = 1, .first = first, .point = area->point + area->first[c]};
        if (contour_double_area(contour.point, first[1]) < 0 && is_within(island, &contour))
            return c;
    }
    return -1;
}

/* Append an island's area to the layer's, and note whose it is. */
static iso_status add_area(iso_layer *layer, const iso_region *inside, int32_t group, bool nested) {
    iso_region *area = &layer->area;
    int32_t base = area->count;
    if (inside->count == 0)
        return ISO_OK;
    int32_t around = nested ? hole_around(area, inside) : -1;
    ISO_TRY(ISO_GROW(layer->group, layer->group_capacity, (int64_t)base + inside->count));
    for (int32_t c = 0; c < inside->count; c++) {
        ISO_TRY(iso_region_add(area, inside->point + inside->first[c],
                               inside->first[c + 1] - inside->first[c]));
        area->parent[base + c] = inside->parent[c] < 0 ? around : base + inside->parent[c];
        layer->group[base + c] = group;
    }
    return ISO_OK;
}

static iso_status draw_walls(iso_layer *layer, iso_hand *hand) {
    iso_islands islands;
    ISO_TRY(islands_of(&islands, &layer->region, &hand->arena));
    for (int32_t i = 0; i < islands.count; i++) {
        iso_wall_options wall = layer->settings.wall;
        wall.like.group = i;
        ISO_TRY(island_copy(&hand->island, &layer->region, &islands, i));
        ISO_TRY(iso_walls(&layer->paths, &hand->inside, &hand->island, &wall, hand->planar));
        bool nested = layer->region.parent[islands.contour[islands.first[i]]] >= 0;
        ISO_TRY(add_area(layer, &hand->inside, i, nested));
    }
    return ISO_OK;
}

static iso_status make_walls(iso_layer *layer, iso_hand *hand, int32_t index) {
    const iso_wall_options *wall = &layer->settings.wall;
    iso_planar_counts *counts = &hand->planar->counts, before = *counts;
    iso_walled walled = {&layer->paths, &layer->area, &layer->group, &layer->group_capacity, {0}};
    if (repeat_has(&hand->repeat, &layer->region, wall)) {
        ISO_TRY(repeat_copy(&walled, &hand->repeat));
        counts_add(counts, &walled.cost, 1);
    } else {
        ISO_TRY(draw_walls(layer, hand));
        walled.cost = *counts;
        counts_add(&walled.cost, &before, -1);
        ISO_TRY(repeat_keep(&hand->repeat, &layer->region, wall, &walled));
    }
    if (layer->settings.fuzzy.on)
        ISO_TRY(
            fuzzy_skin(&layer->paths, &hand->paths, 0, &layer->settings.fuzzy, (uint64_t)index));
    return check(&layer->area, hand);
}

iso_status layer_outline(iso_layer *layer, iso_hand *hand, const iso_slices *slices,
                         int32_t model_count, int32_t index) {
    double begun = iso_stage_clock();
    memset(layer->seconds, 0, sizeof layer->seconds);
    iso_paths_clear(&layer->paths);
    iso_region_clear(&layer->area);
    ISO_TRY(make_region(layer, hand, slices, model_count, index));
    double outlined = iso_stage_clock();
    iso_arena_mark mark = iso_arena_get_mark(&hand->arena);
    iso_status status = make_walls(layer, hand, index);
    iso_arena_pop(&hand->arena, mark);
    layer->seconds[ISO_STAGE_REGIONS] = outlined - begun;
    layer->seconds[ISO_STAGE_WALLS] = iso_stage_clock() - outlined;
    return status;
}

/* ---- fill ---- */

typedef struct iso_filling {
    iso_layer *layer;
    iso_hand *hand;
    const iso_island_search *areas;
    const iso_region *beneath;  /* outline of the layer below; NULL: the bed */
    const iso_lattice *lattice; /* what fills sparse areas, or NULL */
} iso_filling;

/* Inset each part of the region by half a spacing, for the middles of the lines, and fill it. */
static iso_status fill_part(const iso_filling *f, const iso_region *part,
                            const iso_fill_options *fill, int32_t group) {
    iso_hand *hand = f->hand;
    iso_fill_options grouped = *fill;
    iso_offset_options inset = iso_offset_defaults(-f->layer->settings.fill_inset);
    if (fill->like.role == ISO_ROLE_IRONING)
        inset.distance = -f->layer->settings.ironing_inset;
    inset.join = ISO_JOIN_ROUND;
    ISO_TRY(iso_offset(&hand->inside, part, &inset, hand->planar));
    ISO_TRY(check(&hand->inside, hand));
    grouped.like.group = group;
    grouped.margin = f->layer->settings.fill_inset;
    if (fill->pattern >= ISO_PATTERN_LATTICE) {
        iso_lattice_slice slice = {.lattice = f->lattice, .z = iso_mm(fill->z)};
        return lattice_fill(&f->layer->paths, &hand->inside, &slice, &grouped, &hand->arena,
                            hand->planar);
    }
    if (f->layer->settings.gap.least > 0 && fill->like.role != ISO_ROLE_IRONING &&
        fill->like.role != ISO_ROLE_BRIDGE_INFILL) {
        iso_gap_options gap = f->layer->settings.gap;
        gap.like.group = group;
        iso_gap_reach reach = {f->layer->settings.fill_inset, -f->layer->settings.wall.fill_inset};
        ISO_TRY(
            iso_gap_fill_left(&f->layer->paths, part, &hand->inside, &reach, &gap, hand->planar));
    }
    return iso_fill(&f->layer->paths, &hand->inside, &grouped, &hand->arena, hand->planar);
}

/* The group of a part: that of the area it lies in, or one of its own if rounding has put it just
 * outside of all. */
static int32_t group_of(const iso_filling *f, const iso_region *region, const iso_islands *parts,
                        int32_t part) {
    int32_t outer = parts->contour[parts->first[part]];
    if (!f->areas)
        return f->layer->group[outer];
    const iso_islands *islands = f->areas->islands;
    int32_t area = island_at(f->areas, region->point[region->first[outer]]);
    return area < 0 ? f->layer->region.count + part
                    : f->layer->group[islands->contour[islands->first[area]]];
}

static iso_status fill_region(const iso_filling *f, const iso_region *region,
                              const iso_fill_options *fill) {
    iso_hand *hand = f->hand;
    iso_islands parts;
    if (region->count == 0)
        return ISO_OK;
    ISO_TRY(islands_of(&parts, region, &hand->arena));
    for (int32_t i = 0; i < parts.count; i++) {
        ISO_TRY(island_copy(&hand->part, region, &parts, i));
        ISO_TRY(fill_part(f, &hand->part, fill, group_of(f, region, &parts, i)));
    }
    return ISO_OK;
}

/* With the lattice of modifier k, if any. */
static iso_status fill_sparse(const iso_filling *f, int32_t k, const iso_region *region,
                              const iso_fill_options *fill) {
    iso_filling filling = *f;
    filling.lattice = f->layer->lattice ? f->layer->lattice[k] : NULL;
    return fill_region(&filling, region, fill);
}

/* Each bridge in the direction that suits it. */
static iso_status fill_bridges(const iso_filling *f) {
    const iso_layer_settings *s = &f->layer->settings;
    const iso_region *bridges = &f->layer->shell.bridge;
    iso_hand *hand = f->hand;
    iso_islands parts;
    if (bridges->count == 0)
        return ISO_OK;
    ISO_TRY(islands_of(&parts, bridges, &hand->arena));
    for (int32_t i = 0; i < parts.count; i++) {
        iso_fill_options fill = s->bridge;
        ISO_TRY(island_copy(&hand->part, bridges, &parts, i));
        if (!s->bridge_angle_given && f->beneath)
            ISO_TRY(
                iso_bridge_angle(&fill.angle, &hand->part, f->beneath, fill.angle, hand->planar));
        ISO_TRY(fill_part(f, &hand->part, &fill, group_of(f, bridges, &parts, i)));
    }
    return ISO_OK;
}

/* The sparse part, each piece with the fill of the modifier it lies in. */
static iso_status fill_modified(const iso_filling *f) {
    const iso_layer *layer = f->layer;
    const iso_layer_settings *s = &layer->settings;
    iso_modified *modified = &f->hand->modified;
    int32_t overlap = (int32_t)(s->solid.spacing / 2) - s->fill_inset;
    ISO_TRY(modifiers_split(modified, layer->modifiers, &layer->shell.sparse, layer->index,
                            overlap > 0 ? overlap : 0, f->hand->planar));
    for (int32_t k = 0; k <= layer->modifiers->count; k++) {
        iso_fill_options fill;
        ISO_TRY(check(modified_piece(modified, k), f->hand));
        if (modifiers_fill(&fill, layer->modifiers, k, layer->index))
            ISO_TRY(fill_sparse(f, k, modified_piece(modified, k), &fill));
    }
    return ISO_OK;
}

static iso_status fill_shelled(iso_layer *layer, iso_hand *hand, const iso_layer *beneath) {
    const iso_layer_settings *s = &layer->settings;
    const iso_shell *shell = &layer->shell;
    iso_islands areas;
    iso_island_search search;
    ISO_TRY(islands_of(&areas, &layer->area, &hand->arena));
    ISO_TRY(island_search_new(&search, &layer->area, &areas, &hand->arena));
    iso_filling filling = {layer, hand, &search, beneath ? &beneath->region : NULL, NULL};
    ISO_TRY(fill_bridges(&filling));
    ISO_TRY(fill_region(&filling, &shell->lid, &s->lid));
    ISO_TRY(fill_region(&filling, &shell->top, &s->top));
    ISO_TRY(fill_region(&filling, &shell->solid, &s->solid));
    if (layer->modifiers)
        ISO_TRY(fill_modified(&filling));
    else if (s->has_sparse)
        ISO_TRY(
            fill_sparse(&filling, 0, layer->combined ? &layer->alone : &shell->sparse, &s->sparse));
    if (layer->combined)
        ISO_TRY(fill_region(&filling, &layer->together, &s->together));
    if (s->irons > 0)
        ISO_TRY(fill_region(&filling, &shell->top, &s->ironing));
    return s->irons > 1 ? fill_region(&filling, &shell->solid, &s->ironing) : ISO_OK;
}

/* 10 um: no printer's fill ends that exactly, and each operation on it gets faster. */
enum { AREA_THINNING = 100 };

iso_status layer_split(iso_layer *layer, iso_hand *hand, const iso_shell_neighbours *around) {
    double begun = iso_stage_clock();
    iso_shell *shell = &layer->shell;
    ISO_TRY(iso_region_simplify(&hand->raw, &layer->area, AREA_THINNING, hand->planar));
    ISO_TRY(iso_shell_split(shell, &hand->raw, around, &layer->settings.shell, hand->planar));
    ISO_TRY(check(&shell->top, hand));
    ISO_TRY(check(&shell->bridge, hand));
    ISO_TRY(check(&shell->solid, hand));
    ISO_TRY(check(&shell->sparse, hand));
    layer->seconds[ISO_STAGE_SHELLS] += iso_stage_clock() - begun;
    return ISO_OK;
}

/* Walls run within their layer's outline, but for fuzzy ones; one like that below holds them all.
 */
static bool is_upright(const iso_layer *layer, const iso_layer *beneath) {
    return !layer->settings.fuzzy.on && region_same(&layer->region, &beneath->region);
}

/* What depends on the layer below, split. */
static iso_status lie_on(iso_layer *layer, iso_hand *hand, const iso_layer *beneath) {
    const iso_layer_settings *s = &layer->settings;
    iso_shell *shell = &layer->shell;
    const iso_region *open = &beneath->shell.sparse;
    if (s->lid_least > 0 && layer->modifiers)
        ISO_TRY(modifiers_open(&open, &hand->modified, layer->modifiers, open, beneath->index,
                               hand->planar));
    if (s->lid_least > 0)
        ISO_TRY(iso_shell_find_lids(shell, open, s->lid_least, s->lid_anchor, hand->planar));
    ISO_TRY(check(&shell->lid, hand));
    ISO_TRY(check(&shell->solid, hand));
    if (s->overhang.reach > 0 && !is_upright(layer, beneath))
        return iso_walls_find_overhangs(&layer->paths, &beneath->region, &s->overhang,
                                        hand->planar);
    return ISO_OK;
}

iso_status layer_fill(iso_layer *layer, iso_hand *hand, const iso_layer *beneath) {
    const iso_layer_settings *s = &layer->settings;
    const iso_shell *shell = &layer->shell;
    double begun = iso_stage_clock();
    if (beneath)
        ISO_TRY(lie_on(layer, hand, beneath));
    bool shelled = shell->top.count + shell->solid.count + shell->bridge.count + shell->lid.count +
                       layer->combined ||
                   layer->modifiers;
    double ready = iso_stage_clock();
    iso_arena_mark mark = iso_arena_get_mark(&hand->arena);
    iso_filling all = {.layer = layer, .hand = hand};
    iso_status status = ISO_OK;
    if (shelled)
        status = fill_shelled(layer, hand, beneath);
    else if (s->has_sparse)
        status = fill_sparse(&all, 0, &layer->area, &s->sparse);
    iso_arena_pop(&hand->arena, mark);
    layer->seconds[ISO_STAGE_SHELLS] += ready - begun;
    layer->seconds[ISO_STAGE_FILL] = iso_stage_clock() - ready;
    return status;
}

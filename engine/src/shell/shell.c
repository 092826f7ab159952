#include <isoslice/shell.h>

#include "planar/island.h"
#include "planar/region.h"
#include "planar/predicate.h"
#include "planar/scratch.h"
#include "shell/mask.h"

/* Operands of a cover's arrangement, and of the last one, which puts the shells together. */
enum { FILL, COVER };
enum { SHELL_TOP = 1, SHELL_ABOVE, SHELL_BELOW };

#define LID_CELLS 3.5 /* cells of a mask in the width of the narrowest lid */

enum { THINNING = 32 }; /* outlines that reach out are thinned by this part of how far they do */

static int32_t most(int32_t a, int32_t b) {
    return a > b ? a : b;
}

static int32_t fewest(int32_t a, int32_t b) {
    return a < b ? a : b;
}

void iso_shell_free(iso_shell *shell) {
    iso_region_free(&shell->top);
    iso_region_free(&shell->bridge);
    iso_region_free(&shell->lid);
    iso_region_free(&shell->solid);
    iso_region_free(&shell->sparse);
    iso_region_free(&shell->rest);
    iso_region_free(&shell->spare);
}

static iso_status copy_region(iso_region *out, const iso_region *in) {
    iso_region_clear(out);
    for (int32_t c = 0; c < in->count; c++) {
        ISO_TRY(iso_region_add(out, in->point + in->first[c], in->first[c + 1] - in->first[c]));
        out->parent[c] = in->parent[c];
    }
    return ISO_OK;
}

/* ---- runs ---- */

int32_t iso_shell_level(int32_t layers) {
    int32_t level = 0;
    while ((int64_t)2 << level <= layers)
        level++;
    return level;
}

/* Upright walls give the same outline again and again. */
iso_status iso_shell_widen(iso_region *out, const iso_region *low, const iso_region *high,
                           iso_planar_scratch *scratch) {
    if (region_same(low, high))
        return copy_region(out, low);
    return iso_boolean(out, ISO_INTERSECTION, low, high, scratch);
}

/* ---- exposure ---- */

/* Each cover adds one to the winding; covered is what all of them hold. */
static bool is_exposed(const iso_winding *w, const void *context) {
    const iso_shell_side *side = context;
    return w->of[FILL] > 0 && w->of[COVER] < side->count;
}

/* Grow the region. The shells are cut out of the fill, whose own edge stays: it is thinned first,
 * since long round offsets of fine outlines cross themselves again and again. */
static iso_status reach_out(iso_region *region, iso_region *spare, int32_t distance,
                            iso_planar_scratch *scratch) {
    iso_offset_options grow = iso_offset_defaults(distance);
    ISO_TRY(iso_region_simplify(spare, region, distance / THINNING, scratch));
    return iso_offset(region, spare, &grow, scratch);
}

/* Drop what is too narrow to print and let the rest reach out a little. */
static iso_status trim(iso_region *region, iso_region *spare, int32_t narrowest, int32_t anchor,
                       iso_planar_scratch *scratch) {
    iso_offset_options shrink = iso_offset_defaults(-narrowest / 2);
    if (region->count == 0)
        return ISO_OK;
    ISO_TRY(iso_offset(spare, region, &shrink, scratch));
    if (spare->count == 0)
        return copy_region(region, spare);
    ISO_TRY(reach_out(spare, region, narrowest / 2 + anchor, scratch));
    return copy_region(region, spare);
}

/* The part of the fill that one side leaves bare. One side at a time: its cover rarely comes near
 * the fill, while the covers of two sides cross each other all along a wall. */
static iso_status expose(iso_region *out, const iso_region *fill, const iso_shell_side *side,
                         iso_planar_scratch *scratch) {
    if (side->missing > 0)
        return copy_region(out, fill);
    if (side->count == 0 || fill->count == 0) {
        iso_region_clear(out);
        return ISO_OK;
    }
    scratch->edges.count = 0;
    ISO_TRY(edges_add(&scratch->edges, fill, FILL));
    for (int32_t i = 0; i < side->count; i++)
        ISO_TRY(edges_add(&scratch->edges, side->cover[i], COVER));
    return planar_resolve(&(iso_choice){out, is_exposed, side}, 1, scratch);
}

/* A cover like the layer's own outline, as on any upright wall, covers all of its fill. */
static iso_shell_side without_own(const iso_shell_side *side, const iso_region *own) {
    iso_shell_side rest = {.layers = side->layers, .missing = side->missing};
    for (int32_t i = 0; i < side->count; i++)
        if (!region_same(side->cover[i], own))
            rest.cover[rest.count++] = side->cover[i];
    return rest;
}

static iso_shell_side one_layer(const iso_region *outline, bool missing) {
    iso_shell_side side = {.layers = 1, .missing = missing};
    if (outline)
        side.cover[side.count++] = outline;
    return side;
}

/* What is bare of the next layer alone is bare of all of them together, so it is looked for in
 * that. At full density no layer below the next counts, and bridges are looked for everywhere. */
static iso_status expose_all(iso_shell *shell, const iso_region *fill,
                             const iso_shell_neighbours *around, const iso_shell_options *options,
                             iso_planar_scratch *scratch) {
    iso_shell_side above = without_own(&around->above, around->own);
    iso_shell_side below = without_own(&around->below, around->own);
    iso_shell_side next = one_layer(around->next, !around->next);
    iso_shell_side beneath = one_layer(around->beneath, false);
    next = without_own(&next, around->own);
    beneath = without_own(&beneath, around->own);
    bool alone = above.missing == 0 && around->above.layers == 1;
    ISO_TRY(expose(&shell->solid, fill, &above, scratch));
    ISO_TRY(expose(&shell->sparse, fill, &below, scratch));
    ISO_TRY(alone ? copy_region(&shell->top, &shell->solid)
                  : expose(&shell->top, &shell->solid, &next, scratch));
    ISO_TRY(expose(&shell->bridge, around->below.layers > 0 ? &shell->sparse : fill, &beneath,
                   scratch));
    iso_region *spare = &shell->spare;
    int32_t narrowest = options->narrowest, anchor = options->anchor;
    if (next.missing == 0 || above.missing == 0) /* else all of the fill */
        ISO_TRY(trim(&shell->top, spare, narrowest, options->top_anchor, scratch));
    if (above.missing == 0)
        ISO_TRY(trim(&shell->solid, spare, narrowest, anchor, scratch));
    if (below.missing == 0)
        ISO_TRY(trim(&shell->sparse, spare, narrowest, anchor, scratch));
    return trim(&shell->bridge, spare, options->bridge_least, options->bridge_anchor, scratch);
}

/* ---- the parts ---- */

static bool in_both(const iso_winding *w, const void *context) {
    return w->of[FILL] > 0 && w->of[COVER] > 0;
}

static bool in_rest(const iso_winding *w, const void *context) {
    return w->of[FILL] > 0 && w->of[COVER] <= 0;
}

static bool in_top(const iso_winding *w, const void *context) {
    return w->of[FILL] > 0 && w->of[SHELL_TOP] > 0;
}

static bool in_solid(const iso_winding *w, const void *context) {
    return w->of[FILL] > 0 && w->of[SHELL_TOP] <= 0 &&
           (w->of[SHELL_ABOVE] > 0 || w->of[SHELL_BELOW] > 0);
}

static bool in_sparse(const iso_winding *w, const void *context) {
    return w->of[FILL] > 0 && w->of[SHELL_TOP] <= 0 && w->of[SHELL_ABOVE] <= 0 &&
           w->of[SHELL_BELOW] <= 0;
}

/* `part` becomes what `whole` and it share, `rest` the rest of the whole. */
static iso_status cut(iso_region *part, iso_region *rest, const iso_region *whole,
                      iso_planar_scratch *scratch) {
    scratch->edges.count = 0;
    ISO_TRY(edges_add(&scratch->edges, whole, FILL));
    ISO_TRY(edges_add(&scratch->edges, part, COVER));
    iso_choice choice[] = {{part, in_both, NULL}, {rest, in_rest, NULL}};
    return planar_resolve(choice, 2, scratch);
}

/* Twice the area of each island of the region; in the scratch's arena. */
static iso_status island_areas(int64_t **area, iso_islands *islands, const iso_region *region,
                               iso_planar_scratch *scratch) {
    ISO_TRY(islands_of(islands, region, &scratch->arena));
    ISO_TRY(ISO_PUSH(*area, &scratch->arena, islands->count));
    for (int32_t i = 0; i < islands->count; i++) {
        (*area)[i] = 0;
        for (int32_t k = islands->first[i]; k < islands->first[i + 1]; k++) {
            int32_t c = islands->contour[k];
            (*area)[i] += contour_double_area(region->point + region->first[c],
                                              region->first[c + 1] - region->first[c]);
        }
    }
    return ISO_OK;
}

/* Move the small islands of the sparse part to the solid one, with which they then are one. */
static iso_status fill_small(iso_shell *shell, const iso_shell_options *options,
                             iso_planar_scratch *scratch) {
    iso_islands islands;
    int64_t *area;
    iso_region *sparse = &shell->sparse, *solid = &shell->solid;
    ISO_TRY(island_areas(&area, &islands, sparse, scratch));
    int32_t small = 0;
    for (int32_t i = 0; i < islands.count; i++)
        small += area[i] < options->sparse_least;
    if (small == 0)
        return ISO_OK;
    iso_region *raw = &shell->rest;
    const iso_region *from = &shell->spare;
    int32_t *place; /* in the new sparse part: of a contour, or of the one around it that stays */
    ISO_TRY(copy_region(raw, solid));
    ISO_TRY(copy_region(&shell->spare, sparse));
    ISO_TRY(ISO_PUSH(place, &scratch->arena, from->count));
    iso_region_clear(sparse);
    for (int32_t i = 0; i < islands.count; i++)
        for (int32_t k = islands.first[i]; k < islands.first[i + 1]; k++) {
            int32_t c = islands.contour[k];
            int32_t around = from->parent[c] < 0 ? -1 : place[from->parent[c]];
            iso_region *to = area[i] < options->sparse_least ? raw : sparse;
            ISO_TRY(iso_region_add(to, from->point + from->first[c],
                                   from->first[c + 1] - from->first[c]));
            place[c] = around;
            if (to == sparse) {
                sparse->parent[sparse->count - 1] = around;
                place[c] = sparse->count - 1;
            }
        }
    return iso_region_clean(solid, raw, ISO_FILL_POSITIVE, scratch);
}

/* Nothing sparse: the fill without its top. */
static iso_status make_whole(iso_shell *shell, const iso_region *fill,
                             iso_planar_scratch *scratch) {
    iso_region_clear(&shell->sparse);
    if (shell->top.count == 0)
        return copy_region(&shell->solid, fill);
    return cut(&shell->top, &shell->solid, fill, scratch);
}

/* Is every island of the fill so small that none of its parts would stay sparse? */
static iso_status is_all_small(bool *small, const iso_region *fill,
                               const iso_shell_options *options, iso_planar_scratch *scratch) {
    iso_islands islands;
    int64_t *area;
    ISO_TRY(island_areas(&area, &islands, fill, scratch));
    *small = true;
    for (int32_t i = 0; i < islands.count && *small; i++)
        *small = area[i] < options->sparse_least;
    return ISO_OK;
}

static iso_status assemble(iso_shell *shell, const iso_region *fill, iso_planar_scratch *scratch) {
    if (shell->top.count == 0 && shell->solid.count == 0 && shell->sparse.count == 0)
        return copy_region(&shell->sparse, fill);
    scratch->edges.count = 0;
    ISO_TRY(edges_add(&scratch->edges, fill, FILL));
    ISO_TRY(edges_add(&scratch->edges, &shell->top, SHELL_TOP));
    ISO_TRY(edges_add(&scratch->edges, &shell->solid, SHELL_ABOVE));
    ISO_TRY(edges_add(&scratch->edges, &shell->sparse, SHELL_BELOW));
    iso_choice choice[] = {{&shell->top, in_top, NULL},
                           {&shell->solid, in_solid, NULL},
                           {&shell->sparse, in_sparse, NULL}};
    return planar_resolve(choice, 3, scratch);
}

static iso_status split(iso_shell *shell, const iso_region *fill,
                        const iso_shell_neighbours *around, const iso_shell_options *options,
                        iso_planar_scratch *scratch) {
    iso_region_clear(&shell->lid);
    ISO_TRY(expose_all(shell, fill, around, options, scratch));
    if (shell->bridge.count > 0) {
        ISO_TRY(cut(&shell->bridge, &shell->rest, fill, scratch));
        fill = &shell->rest;
    }
    if (options->whole)
        return make_whole(shell, fill, scratch);
    bool small = false;
    if (options->sparse_least > 0)
        ISO_TRY(is_all_small(&small, fill, options, scratch));
    if (small)
        return make_whole(shell, fill, scratch);
    ISO_TRY(assemble(shell, fill, scratch));
    return options->sparse_least > 0 ? fill_small(shell, options, scratch) : ISO_OK;
}

iso_status iso_shell_split(iso_shell *shell, const iso_region *fill,
                           const iso_shell_neighbours *around, const iso_shell_options *options,
                           iso_planar_scratch *scratch) {
    iso_arena_mark mark = iso_arena_get_mark(&scratch->arena);
    iso_status status = split(shell, fill, around, options, scratch);
    iso_arena_pop(&scratch->arena, mark);
    if (status != ISO_OK) {
        scratch->edges.count = 0;
        iso_region_clear(&shell->top);
        iso_region_clear(&shell->bridge);
        iso_region_clear(&shell->lid);
        iso_region_clear(&shell->solid);
        iso_region_clear(&shell->sparse);
    }
    return status;
}

/* ---- lids ---- */

/* Is any of the solid part so far within the sparse fill that there may be a lid? On slopes the two
 * only overlap by a strip along their edges, which is nothing. A disc of radius `least` / 2 holds a
 * cell and its neighbours, wherever it lies. */
static iso_status may_be_lid(bool *may, iso_box *where, const iso_region *solid,
                             const iso_region *sparse, int32_t least, iso_arena *arena) {
    iso_box a, b;
    iso_mask mask[2];
    int32_t cell = (int32_t)(least / LID_CELLS) > 0 ? (int32_t)(least / LID_CELLS) : 1;
    *may = false;
    if (!region_box(&a, solid) || !region_box(&b, sparse) || !boxes_meet(&a, &b))
        return ISO_OK;
    *where = (iso_box){{most(a.min.x, b.min.x), most(a.min.y, b.min.y)},
                       {fewest(a.max.x, b.max.x), fewest(a.max.y, b.max.y)}};
    ISO_TRY(mask_of(&mask[0], solid, where, cell, arena));
    ISO_TRY(mask_of(&mask[1], sparse, where, cell, arena));
    *may = mask[0].cell > cell || masks_share_core(where, &mask[0], &mask[1]);
    return ISO_OK;
}

/* What of the region lies in the box or less than `margin` around it. */
static iso_status clip(iso_region *out, const iso_region *region, const iso_box *box,
                       int32_t margin, iso_planar_scratch *scratch) {
    iso_point low = {box->min.x - margin, box->min.y - margin};
    iso_point high = {box->max.x + margin, box->max.y + margin};
    iso_point corner[] = {low, {high.x, low.y}, high, {low.x, high.y}};
    int32_t first[] = {0, 4}, parent[] = {-1};
    iso_region frame = {.count = 1, .first = first, .point = corner, .parent = parent};
    return iso_boolean(out, ISO_INTERSECTION, region, &frame, scratch);
}

/* Where the sparse fill, shrunk, meets the solid part is well over it. */
static iso_status find_lids(iso_shell *shell, const iso_region *sparse_below, int32_t least,
                            int32_t anchor, iso_planar_scratch *scratch) {
    bool may;
    iso_box where;
    iso_offset_options shrink = iso_offset_defaults(-least);
    ISO_TRY(may_be_lid(&may, &where, &shell->solid, sparse_below, least, &scratch->arena));
    if (!may)
        return ISO_OK;
    ISO_TRY(clip(&shell->rest, sparse_below, &where, 3 * least, scratch));
    ISO_TRY(iso_offset(&shell->spare, &shell->rest, &shrink, scratch));
    ISO_TRY(iso_boolean(&shell->lid, ISO_INTERSECTION, &shell->solid, &shell->spare, scratch));
    if (shell->lid.count == 0)
        return ISO_OK;
    ISO_TRY(reach_out(&shell->lid, &shell->spare, least + anchor, scratch));
    ISO_TRY(cut(&shell->lid, &shell->rest, &shell->solid, scratch));
    return copy_region(&shell->solid, &shell->rest);
}

iso_status iso_shell_find_lids(iso_shell *shell, const iso_region *sparse_below, int32_t least,
                               int32_t anchor, iso_planar_scratch *scratch) {
    iso_region_clear(&shell->lid);
    if (!sparse_below || sparse_below->count == 0 || shell->solid.count == 0)
        return ISO_OK;
    iso_arena_mark mark = iso_arena_get_mark(&scratch->arena);
    iso_status status = find_lids(shell, sparse_below, least, anchor, scratch);
    iso_arena_pop(&scratch->arena, mark);
    if (status != ISO_OK) {
        iso_region_clear(&shell->lid);
        iso_region_clear(&shell->solid);
    }
    return status;
}

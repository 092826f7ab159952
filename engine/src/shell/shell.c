#include <isoslice/shell.h>

#include "planar/region.h"
#include "planar/scratch.h"

/* Operands of a cover's arrangement, and of the last one, which puts the shells together. */
enum { FILL, COVER };
enum { SHELL_TOP = 1, SHELL_ABOVE, SHELL_BELOW };

void iso_shell_free(iso_shell *shell) {
    iso_region_free(&shell->top);
    iso_region_free(&shell->solid);
    iso_region_free(&shell->sparse);
    iso_region_free(&shell->spare);
}

static bool same_region(const iso_region *a, const iso_region *b) {
    if (a->count != b->count || a->count == 0)
        return a->count == b->count;
    return memcmp(a->first, b->first, (size_t)(a->count + 1) * sizeof *a->first) == 0 &&
           memcmp(a->point, b->point, (size_t)a->first[a->count] * sizeof *a->point) == 0;
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
    if (same_region(low, high))
        return copy_region(out, low);
    return iso_boolean(out, ISO_INTERSECTION, low, high, scratch);
}

/* ---- exposure ---- */

/* Each cover adds one to the winding; covered is what all of them hold. */
static bool is_exposed(const iso_winding *w, const void *context) {
    const iso_shell_side *side = context;
    return w->of[FILL] > 0 && w->of[COVER] < side->count;
}

/* Drop what is too narrow to print and let the rest reach out a little. */
static iso_status trim(iso_region *region, iso_region *spare, const iso_shell_options *options,
                       iso_planar_scratch *scratch) {
    iso_offset_options shrink = iso_offset_defaults(-options->narrowest / 2);
    iso_offset_options grow = iso_offset_defaults(options->narrowest / 2 + options->anchor);
    if (region->count == 0)
        return ISO_OK;
    ISO_TRY(iso_offset(spare, region, &shrink, scratch));
    return iso_offset(region, spare, &grow, scratch);
}

/* The part of the fill that one side leaves bare, trimmed. One side at a time: its cover rarely
 * comes near the fill, while the covers of two sides cross each other all along a wall. */
static iso_status expose(iso_region *out, iso_region *spare, const iso_region *fill,
                         const iso_shell_side *side, const iso_shell_options *options,
                         iso_planar_scratch *scratch) {
    if (side->missing > 0)
        return copy_region(out, fill);
    if (side->count == 0) {
        iso_region_clear(out);
        return ISO_OK;
    }
    scratch->edges.count = 0;
    ISO_TRY(edges_add(&scratch->edges, fill, FILL));
    for (int32_t i = 0; i < side->count; i++)
        ISO_TRY(edges_add(&scratch->edges, side->cover[i], COVER));
    ISO_TRY(planar_resolve(&(iso_choice){out, is_exposed, side}, 1, scratch));
    return trim(out, spare, options, scratch);
}

/* A cover like the layer's own outline, as on any upright wall, covers all of its fill. */
static iso_shell_side without_own(const iso_shell_side *side, const iso_region *own) {
    iso_shell_side rest = {.layers = side->layers, .missing = side->missing};
    for (int32_t i = 0; i < side->count; i++)
        if (!same_region(side->cover[i], own))
            rest.cover[rest.count++] = side->cover[i];
    return rest;
}

static iso_shell_side next_side(const iso_shell_neighbours *around) {
    iso_shell_side side = {.layers = around->above.layers > 0};
    if (side.layers > 0 && around->next)
        side.cover[side.count++] = around->next;
    side.missing = side.layers - side.count;
    return side;
}

/* ---- the three parts ---- */

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

static iso_status split(iso_shell *shell, const iso_region *fill,
                        const iso_shell_neighbours *around, const iso_shell_options *options,
                        iso_planar_scratch *scratch) {
    iso_shell_side next = next_side(around);
    next = without_own(&next, around->own);
    iso_shell_side above = without_own(&around->above, around->own);
    iso_shell_side below = without_own(&around->below, around->own);
    iso_region *spare = &shell->spare;
    ISO_TRY(expose(&shell->top, spare, fill, &next, options, scratch));
    ISO_TRY(expose(&shell->solid, spare, fill, &above, options, scratch));
    ISO_TRY(expose(&shell->sparse, spare, fill, &below, options, scratch));
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

iso_status iso_shell_split(iso_shell *shell, const iso_region *fill,
                           const iso_shell_neighbours *around, const iso_shell_options *options,
                           iso_planar_scratch *scratch) {
    iso_status status = split(shell, fill, around, options, scratch);
    if (status != ISO_OK) {
        scratch->edges.count = 0;
        iso_region_clear(&shell->top);
        iso_region_clear(&shell->solid);
        iso_region_clear(&shell->sparse);
    }
    return status;
}

#include <isoslice/shell.h>

#include "planar/region.h"
#include "planar/scratch.h"

/* Operands of the first arrangement. */
enum { FILL, NEXT, ABOVE, BELOW };
/* Operands of the second: the shells, trimmed, within the fill. */
enum { SHELL_TOP = 1, SHELL_SOLID };

void iso_shell_free(iso_shell *shell) {
    iso_region_free(&shell->top);
    iso_region_free(&shell->solid);
    iso_region_free(&shell->sparse);
}

static bool covered(const iso_shell_side *side, int32_t winding) {
    return side->layers == 0 || (side->missing == 0 && winding >= side->count);
}

/* Each cover adds one to the winding of its operand. */
static bool is_top(const iso_winding *w, const void *context) {
    const iso_shell_neighbours *around = context;
    return w->of[FILL] > 0 && around->above.layers > 0 && w->of[NEXT] <= 0;
}

static bool is_solid(const iso_winding *w, const void *context) {
    const iso_shell_neighbours *around = context;
    return w->of[FILL] > 0 && (is_top(w, context) || !covered(&around->above, w->of[ABOVE]) ||
                               !covered(&around->below, w->of[BELOW]));
}

static iso_status add_side(iso_edges *edges, const iso_shell_side *side, int operand) {
    for (int32_t i = 0; side->layers > 0 && side->missing == 0 && i < side->count; i++)
        ISO_TRY(edges_add(edges, side->cover[i], operand));
    return ISO_OK;
}

static iso_status find_exposed(iso_shell *shell, const iso_region *fill,
                               const iso_shell_neighbours *around, iso_planar_scratch *scratch) {
    iso_edges *edges = &scratch->edges;
    edges->count = 0;
    ISO_TRY(edges_add(edges, fill, FILL));
    if (around->next)
        ISO_TRY(edges_add(edges, around->next, NEXT));
    ISO_TRY(add_side(edges, &around->above, ABOVE));
    ISO_TRY(add_side(edges, &around->below, BELOW));
    iso_choice choice[] = {{&shell->top, is_top, around}, {&shell->solid, is_solid, around}};
    return planar_resolve(choice, 2, scratch);
}

/* Drop what is too narrow to print and let the rest reach out a little. */
static iso_status trim(iso_region *region, const iso_shell_options *options,
                       iso_planar_scratch *scratch) {
    iso_region shrunk = {0};
    iso_offset_options shrink = iso_offset_defaults(-options->narrowest / 2);
    iso_offset_options grow = iso_offset_defaults(options->narrowest / 2 + options->anchor);
    iso_status status = iso_offset(&shrunk, region, &shrink, scratch);
    if (status == ISO_OK)
        status = iso_offset(region, &shrunk, &grow, scratch);
    iso_region_free(&shrunk);
    return status;
}

static bool in_top(const iso_winding *w, const void *context) {
    return w->of[FILL] > 0 && w->of[SHELL_TOP] > 0;
}

static bool in_solid(const iso_winding *w, const void *context) {
    return w->of[FILL] > 0 && w->of[SHELL_TOP] <= 0 && w->of[SHELL_SOLID] > 0;
}

static bool in_sparse(const iso_winding *w, const void *context) {
    return w->of[FILL] > 0 && w->of[SHELL_TOP] <= 0 && w->of[SHELL_SOLID] <= 0;
}

static iso_status split(iso_shell *shell, const iso_region *fill,
                        const iso_shell_neighbours *around, const iso_shell_options *options,
                        iso_planar_scratch *scratch) {
    ISO_TRY(find_exposed(shell, fill, around, scratch));
    ISO_TRY(trim(&shell->top, options, scratch));
    ISO_TRY(trim(&shell->solid, options, scratch));
    ISO_TRY(edges_add(&scratch->edges, fill, FILL));
    ISO_TRY(edges_add(&scratch->edges, &shell->top, SHELL_TOP));
    ISO_TRY(edges_add(&scratch->edges, &shell->solid, SHELL_SOLID));
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

int32_t iso_shell_level(int32_t layers) {
    int32_t level = 0;
    while ((int64_t)2 << level <= layers)
        level++;
    return level;
}

static bool same_outline(const iso_region *a, const iso_region *b) {
    if (a->count != b->count || a->count == 0)
        return a->count == b->count;
    return memcmp(a->first, b->first, (size_t)(a->count + 1) * sizeof *a->first) == 0 &&
           memcmp(a->point, b->point, (size_t)a->first[a->count] * sizeof *a->point) == 0;
}

/* Upright walls give the same outline again and again. */
iso_status iso_shell_widen(iso_region *out, const iso_region *low, const iso_region *high,
                           iso_planar_scratch *scratch) {
    if (!same_outline(low, high))
        return iso_boolean(out, ISO_INTERSECTION, low, high, scratch);
    iso_region_clear(out);
    for (int32_t c = 0; c < low->count; c++) {
        ISO_TRY(iso_region_add(out, low->point + low->first[c], low->first[c + 1] - low->first[c]));
        out->parent[c] = low->parent[c];
    }
    return ISO_OK;
}

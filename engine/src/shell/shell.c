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

/* Each outline adds one to the winding of its operand: covered is what all of them hold. */
static bool is_top(const iso_winding *w, const void *context) {
    const iso_shell_neighbours *around = context;
    return w->of[FILL] > 0 && around->top > 0 && w->of[NEXT] <= 0;
}

static bool is_solid(const iso_winding *w, const void *context) {
    const iso_shell_neighbours *around = context;
    if (w->of[FILL] <= 0)
        return false;
    return w->of[NEXT] + w->of[ABOVE] < around->top || w->of[BELOW] < around->bottom;
}

static iso_status find_exposed(iso_shell *shell, const iso_region *fill,
                               const iso_shell_neighbours *around, iso_planar_scratch *scratch) {
    scratch->edges.count = 0;
    ISO_TRY(edges_add(&scratch->edges, fill, FILL));
    for (int32_t i = 0; i < around->above_count; i++)
        ISO_TRY(edges_add(&scratch->edges, around->above[i], i == 0 ? NEXT : ABOVE));
    for (int32_t i = 0; i < around->below_count; i++)
        ISO_TRY(edges_add(&scratch->edges, around->below[i], BELOW));
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

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
typedef struct iso_cover {
    bool top, bottom;     /* is there a shell on that side at all? */
    int32_t above, below; /* outlines that have to hold a place, NEXT not counted */
} iso_cover;

static bool is_top(const iso_winding *w, const void *context) {
    const iso_cover *cover = context;
    return w->of[FILL] > 0 && cover->top && w->of[NEXT] <= 0;
}

static bool is_solid(const iso_winding *w, const void *context) {
    const iso_cover *cover = context;
    if (w->of[FILL] <= 0)
        return false;
    return (cover->top && (w->of[NEXT] <= 0 || w->of[ABOVE] < cover->above)) ||
           (cover->bottom && w->of[BELOW] < cover->below);
}

static bool same_outline(const iso_region *a, const iso_region *b) {
    if (a->count != b->count || a->count == 0)
        return a->count == b->count;
    return memcmp(a->first, b->first, (size_t)(a->count + 1) * sizeof *a->first) == 0 &&
           memcmp(a->point, b->point, (size_t)a->first[a->count] * sizeof *a->point) == 0;
}

/* Add the outlines of one side. One like the outline before it, as on any upright wall, tells
 * nothing new. Missing layers hold nothing: then more are needed than there are. */
static iso_status add_outlines(int32_t *needed, iso_edges *edges, const iso_region *const *outline,
                               int32_t count, int operand) {
    for (int32_t i = 0; i < count; i++) {
        bool next = operand == ABOVE && i == 0;
        if (i > 0 && same_outline(outline[i], outline[i - 1]))
            continue;
        ISO_TRY(edges_add(edges, outline[i], next ? NEXT : operand));
        *needed += !next;
    }
    return ISO_OK;
}

static iso_status find_exposed(iso_shell *shell, const iso_region *fill,
                               const iso_shell_neighbours *around, iso_planar_scratch *scratch) {
    iso_cover cover = {.top = around->top > 0,
                       .bottom = around->bottom > 0,
                       .above = around->above_count < around->top,
                       .below = around->below_count < around->bottom};
    iso_edges *edges = &scratch->edges;
    edges->count = 0;
    ISO_TRY(edges_add(edges, fill, FILL));
    ISO_TRY(add_outlines(&cover.above, edges, around->above, around->above_count, ABOVE));
    ISO_TRY(add_outlines(&cover.below, edges, around->below, around->below_count, BELOW));
    iso_choice choice[] = {{&shell->top, is_top, &cover}, {&shell->solid, is_solid, &cover}};
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

/* Modifiers: models that aren't printed. Where one of them is, the sparse infill is another; later
 * ones win over earlier ones. Walls and solid shells stay as they are.
 *
 *     parse -> load -> (plate: transform and move with the models) -> slice -> per layer: split */
#ifndef ISO_MODIFIER_H
#define ISO_MODIFIER_H

#include <isoslice/config.h>
#include <isoslice/report.h>
#include <isoslice/slice.h>

#include "config/settings.h"
#include "curved.h"

typedef struct iso_modifier {
    char *path;
    int32_t line;         /* of the option, from 1 */
    iso_options *options; /* the job's, with the modifier's keys */
    iso_mesh mesh;        /* until it is sliced */
    iso_slices slices;
} iso_modifier;

/* Zero-initialise; free in any case. */
typedef struct iso_modifiers {
    int32_t count;
    int64_t capacity;
    iso_modifier *modifier;
    const iso_options *options; /* the job's, for what is in no modifier */
    iso_options *shelled;       /* NULL, or what shells are to be made with; see below */
    const iso_levels *levels;
} iso_modifiers;

/* Read the option `modifiers`, not the files. ISO_BAD_CONFIG: a line that can't be followed, or an
 * option that doesn't go together with modifiers of a print of so many models. The options must
 * outlive the modifiers. */
iso_status modifiers_parse(iso_modifiers *modifiers, const iso_options *options,
                           int32_t model_count) ISO_MUST_CHECK;
void modifiers_free(iso_modifiers *modifiers);

/* Read the files into mesh[modifiers->count], zeroed; warn of what was mended. */
iso_status modifiers_load(iso_mesh *mesh, const iso_modifiers *modifiers,
                          iso_report *report) ISO_MUST_CHECK;

/* Slice the meshes at the object's levels, which must outlive the modifiers, and let them go. */
iso_status modifiers_slice(iso_modifiers *modifiers, const iso_levels *levels,
                           const iso_curved *curved) ISO_MUST_CHECK;

/* The options that shells follow: a full print with something sparse in it needs those of a sparse
 * one. */
const iso_options *modifiers_shell_options(const iso_modifiers *modifiers);

/* The options of modifier k; k = count: of what is in none. */
const iso_options *modifiers_options(const iso_modifiers *modifiers, int32_t k);

/* A layer's sparse area, shared out; one for each thread. Zero-initialise, free at the end. */
typedef struct iso_modified {
    int32_t count;
    iso_region *piece;      /* [count] of each modifier */
    const iso_region *rest; /* of none: one of the below, or the whole */
    bool *used;             /* [count] has a modifier ever got anything? */
    iso_region raw, section, edge, spare[2];
} iso_modified;

/* Between two sparse areas lines keep half a spacing from the border. Layers inset every area by
 * less, for the bond with the walls: by `overlap` units, which are taken off here. */
iso_status modifiers_split(iso_modified *out, const iso_modifiers *modifiers,
                           const iso_region *sparse, int32_t index, int32_t overlap,
                           iso_planar_scratch *scratch) ISO_MUST_CHECK;
void modified_free(iso_modified *modified);

static inline const iso_region *modified_piece(const iso_modified *modified, int32_t k) {
    return k < modified->count ? &modified->piece[k] : modified->rest;
}

/* Has modifier k anything to fill? With what, if so. k = count: what is in none. */
bool modifiers_fill(iso_fill_options *fill, const iso_modifiers *modifiers, int32_t k,
                    int32_t index);

/* *open = what of the layer's sparse area isn't filled solid all the same: `sparse` itself, or a
 * region of out. */
iso_status modifiers_open(const iso_region **open, iso_modified *out,
                          const iso_modifiers *modifiers, const iso_region *sparse, int32_t index,
                          iso_planar_scratch *scratch) ISO_MUST_CHECK;

#endif

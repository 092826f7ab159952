/* A stack: the layers of one object, from its meshes to the paths of each layer.
 *
 * Layers are made in blocks, in parallel, from the bed up; nothing but the slices outlives the
 * window around them (window.h). */
#ifndef ISO_STACK_H
#define ISO_STACK_H

#include <isoslice/object.h>

#include "base/parallel.h"
#include "combine.h"
#include "curved.h"
#include "modifier.h"
#include "window.h"

/* The threads, and what each of them needs for itself. */
typedef struct iso_crew {
    iso_pool *pool;
    int32_t count;
    iso_hand *hand; /* [count] */
} iso_crew;

iso_status crew_new(iso_crew *crew, int32_t threads) ISO_MUST_CHECK;
void crew_free(iso_crew *crew);

/* Zero-initialise but for what is said in the beginning. */
typedef struct iso_stack {
    iso_report *report;         /* of what the check of the slices finds */
    const iso_lattice_cut *cut; /* taken out of every lattice; or NULL */
    const iso_options *options;
    const iso_modifiers *modifiers; /* or NULL */
    const iso_crew *crew;
    int32_t model_count;
    iso_slices *slices; /* [model_count] */
    iso_levels levels;
    iso_curved curved;    /* what the levels are of, unless they are flat */
    double *level_volume; /* [levels.count] mm^3, of curved levels; else NULL */
    double mesh_volume;   /* mm^3 of the meshes up to the top of the last layer */
    double sliced_volume; /* mm^3 of their slices */
    double projected;     /* mm^2 of all triangles seen from above */
    iso_window window;
    iso_lattice **lattice; /* [modifiers + 1] of each modifier and, last, of the rest, where sparse
                            * fill is a lattice; or NULL */
    int32_t tools;         /* of its paths: 2 if a lattice has two materials, else 1 */
    iso_combination *combination; /* [levels.count] whose sparse fill is drawn at once; or NULL */
    int32_t block;                /* layers filled in one go */
    int32_t around;               /* layers whose shells each of them looks at, above and below */
    int32_t filled;               /* layers that are done, from the bed up */
    int32_t begin, level; /* of the parallel loop under way: first layer, level of its runs */
    int64_t mesh_bytes, slice_bytes;
} iso_stack;

/* Slice the object's meshes, and the modifiers in it, or NULL, and let each go. ISO_OUTSIDE: too
 * low for a layer; ISO_NOT_VERIFIED: the slices don't hold the meshes' volume. */
iso_status stack_slice(iso_stack *stack, iso_object *object, const iso_options *options,
                       iso_modifiers *modifiers, const iso_crew *crew) ISO_MUST_CHECK;
void stack_free(iso_stack *stack);

/* Layer `index` with its paths, made together with those of its block. Ask for one after the other:
 * the layers below are no longer there afterwards. */
iso_status stack_layer(iso_layer **layer, iso_stack *stack, int32_t index) ISO_MUST_CHECK;

/* Start from the bed again, for another copy. */
void stack_rewind(iso_stack *stack);

#endif

/* One layer on its way from slices to paths. Only the job calls these, in this order:
 *
 *     layer_outline   region, walls, and the area that is left for the fill    each layer by itself
 *     layer_split     the area's shells                            needs its neighbours' regions
 *     layer_fill      lids, overhangs and fill                     needs the layer below, split
 */
#ifndef ISO_LAYER_H
#define ISO_LAYER_H

#include <isoslice/shell.h>
#include <isoslice/slice.h>

#include "base/memory.h"
#include "config/settings.h"
#include "lattice/slice.h"
#include "modifier.h"
#include "repeat.h"

typedef enum iso_stage {
    ISO_STAGE_READ,
    ISO_STAGE_SLICE,
    ISO_STAGE_REGIONS,
    ISO_STAGE_WALLS,
    ISO_STAGE_SHELLS,
    ISO_STAGE_FILL,
    ISO_STAGE_ORDER,
    ISO_STAGE_WRITE,
    ISO_STAGE_COUNT
} iso_stage;

double iso_stage_clock(void); /* seconds, from some fixed time on */

typedef struct iso_layer {
    iso_layer_settings settings;
    int32_t index;                     /* counts from 0 */
    const iso_modifiers *modifiers;    /* or NULL */
    const iso_lattice *const *lattice; /* [modifiers + 1], or NULL: of each sparse fill */
    iso_region region;                 /* the outline */
    iso_region *run; /* [levels] what it shares with the layers above, coarsely (shell.h) */
    int32_t levels;
    iso_region area; /* within the walls, island by island */
    int32_t *group;  /* [area.count] island of `region` that each contour lies in */
    int64_t group_capacity;
    iso_shell shell;            /* the area, split */
    int32_t combined;           /* nonzero: its sparse part is split once more (combine.h) */
    iso_region together, alone; /* drawn for several layers, and for this one only */
    iso_paths paths;
    double square_mm; /* of the region */
    double seconds[ISO_STAGE_COUNT];
} iso_layer;

/* What each thread needs for itself. Zeroed but for `planar`. */
typedef struct iso_hand {
    iso_planar_scratch *planar;
    iso_arena arena;
    iso_region raw, island, inside, part;
    iso_paths paths;
    iso_modified modified;
    iso_repeat repeat;
} iso_hand;

iso_status hand_new(iso_hand *hand) ISO_MUST_CHECK;
void hand_free(iso_hand *hand);
void layer_free(iso_layer *layer);

/* Room for that many levels of runs in a zeroed layer. */
iso_status layer_new(iso_layer *layer, int32_t levels) ISO_MUST_CHECK;

/* Start the layer anew from level `index` of all models' slices. */
iso_status layer_outline(iso_layer *layer, iso_hand *hand, const iso_slices *slices,
                         int32_t model_count, int32_t index) ISO_MUST_CHECK;

/* Split the area into its shells. */
iso_status layer_split(iso_layer *layer, iso_hand *hand,
                       const iso_shell_neighbours *around) ISO_MUST_CHECK;

/* Add the fill. `beneath` is the layer below, split; NULL: the bed. */
iso_status layer_fill(iso_layer *layer, iso_hand *hand, const iso_layer *beneath) ISO_MUST_CHECK;

#endif

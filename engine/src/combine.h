/* Sparse fill of several layers, drawn at once on the last of them, as thick as all: where they are
 * sparse all of them. What else is sparse on a layer is drawn there as ever. */
#ifndef ISO_COMBINE_H
#define ISO_COMBINE_H

#include "window.h"

typedef struct iso_combination {
    int32_t first, last; /* layers */
    double height;       /* mm, of all of them */
} iso_combination;

static inline bool combine_is_asked_for(const iso_options *options) {
    return options->infill_every_layers > 1 && !settings_have_lattice(options) &&
           options->fill_density > 0 && options->fill_density < 100;
}

/* of[i] = what layer i belongs to: infill_every_layers at a time from the second layer on, or as
 * many as are no thicker than the nozzle is wide. */
void combine_plan(iso_combination *of, const iso_levels *levels, const iso_options *options);

/* Set the layer's `together` and `alone`. Needs all its layers split into shells. */
iso_status combine_layer(const iso_window *window, int32_t index, const iso_combination *of,
                         iso_hand *hand) ISO_MUST_CHECK;

#endif

/* The window of layers that a job holds at a time: it moves up through the print, and each layer
 * sees through it those its shells depend on. */
#ifndef ISO_WINDOW_H
#define ISO_WINDOW_H

#include <stdbool.h>

#include "layer.h"

enum { WINDOW_LEVELS_MAX = 32 };

typedef struct iso_window {
    int32_t count;          /* layers of the print */
    int32_t top, bottom;    /* layers of the thickest shells, at most count */
    int32_t *above, *below; /* [count] layers that each layer's shells count, at most top, bottom */
    bool bridges;
    int32_t ring;   /* layers held: layer i is layer[i % ring] */
    int32_t split;  /* layers split into their shells */
    int32_t levels; /* of runs, of each layer (shell.h) */
    iso_layer *layer;
    int32_t
        made[WINDOW_LEVELS_MAX]; /* layers whose runs of each level are made; level 0: outlined */
} iso_window;

/* Shells thicker than the print are cut down to it. `block` layers are filled at a time; each may
 * look at the shells of `around` layers above and below, at least one below. */
iso_status window_new(iso_window *window, const iso_levels *levels, const iso_shell_depth *shells,
                      int32_t block, int32_t around) ISO_MUST_CHECK;
void window_free(iso_window *window);

static inline iso_layer *window_layer(const iso_window *window, int32_t index) {
    return &window->layer[index % window->ring];
}

/* The layers from made[level] up to this one can be widened to `level` once all layers below
 * `outlined` are outlined; the result may be less than made[level]. */
static inline int32_t window_wide_end(int32_t level, int32_t outlined) {
    return outlined - (1 << level) + 1;
}

/* Make the run of that level, at least 1, from two of the level below. */
iso_status window_widen(const iso_window *window, int32_t index, int32_t level,
                        iso_planar_scratch *scratch) ISO_MUST_CHECK;

/* What a layer's shells look at. Needs the outlines up to index + top, and their runs. */
iso_shell_neighbours window_around(const iso_window *window, int32_t index);

#endif

#include "window.h"

static int32_t least(int32_t a, int32_t b) {
    return a < b ? a : b;
}

iso_status window_new(iso_window *window, int32_t count, int32_t top, int32_t bottom,
                      int32_t block) {
    *window =
        (iso_window){.count = count, .top = least(top, count), .bottom = least(bottom, count)};
    int32_t around = window->top + window->bottom;
    window->ring = least(block + around, count);
    window->levels =
        1 + iso_shell_level(window->top > window->bottom ? window->top : window->bottom);
    ISO_TRY(ISO_ALLOCATE(window->layer, window->ring));
    memset(window->layer, 0, (size_t)window->ring * sizeof *window->layer);
    for (int32_t i = 0; i < window->ring; i++)
        ISO_TRY(layer_new(&window->layer[i], window->levels));
    return ISO_OK;
}

void window_free(iso_window *window) {
    for (int32_t i = 0; window->layer && i < window->ring; i++)
        layer_free(&window->layer[i]);
    iso_release(window->layer);
    *window = (iso_window){0};
}

iso_status window_widen(const iso_window *window, int32_t index, int32_t level,
                        iso_planar_scratch *scratch) {
    iso_layer *layer = window_layer(window, index);
    const iso_layer *higher = window_layer(window, index + (1 << (level - 1)));
    double begun = iso_stage_clock();
    iso_status status = iso_shell_widen(&layer->run[level], &layer->run[level - 1],
                                        &higher->run[level - 1], scratch);
    layer->seconds[ISO_STAGE_SHELLS] += iso_stage_clock() - begun;
    return status;
}

/* The runs of the `layers` layers from `bottom` up: one if their number is a power of two, else two
 * that overlap. */
static iso_shell_side side_of(const iso_window *window, int32_t bottom, int32_t layers) {
    iso_shell_side side = {.layers = layers};
    int32_t level = iso_shell_level(layers), length = 1 << level;
    side.missing = bottom < 0 ? -bottom : 0;
    if (bottom + layers > window->count)
        side.missing = bottom + layers - window->count;
    if (layers == 0 || side.missing > 0)
        return side;
    side.cover[side.count++] = &window_layer(window, bottom)->run[level];
    if (length < layers)
        side.cover[side.count++] = &window_layer(window, bottom + layers - length)->run[level];
    return side;
}

iso_shell_neighbours window_around(const iso_window *window, int32_t index) {
    iso_shell_neighbours around = {.own = &window_layer(window, index)->run[0],
                                   .above = side_of(window, index + 1, window->top),
                                   .below =
                                       side_of(window, index - window->bottom, window->bottom)};
    if (window->top > 0 && index + 1 < window->count)
        around.next = &window_layer(window, index + 1)->run[0];
    return around;
}

#include "window.h"

static int32_t least(int32_t a, int32_t b) {
    return a < b ? a : b;
}

static int32_t most(int32_t a, int32_t b) {
    return a > b ? a : b;
}

/* Layers are counted as PrusaSlicer does: layer j belongs to the shell under the top of layer i if
 * fewer than so many layers lie between them, or if the top is less than the thickness above j's.
 * Heights that differ by less than this are the same. */
#define SAME_HEIGHT 1e-4

static double bottom_of(const iso_levels *levels, int32_t index) {
    return levels->top[index] - levels->height[index];
}

/* `end` and `begin`, the first layers beyond the thickness, only move up with the index. */
static iso_status count_shells(iso_window *window, const iso_levels *levels,
                               const iso_shell_depth *shells) {
    int32_t count = levels->count, end = 0, begin = 0;
    double top = shells->top_thickness - SAME_HEIGHT;
    double bottom = shells->bottom_thickness - SAME_HEIGHT;
    ISO_TRY(ISO_ALLOCATE(window->above, count));
    ISO_TRY(ISO_ALLOCATE(window->below, count));
    for (int32_t i = 0; i < count; i++) {
        while (end < count && (end <= i || levels->top[end] - levels->top[i] < top))
            end++;
        while (begin < i && bottom_of(levels, i) - bottom_of(levels, begin) >= bottom)
            begin++;
        int32_t above = most(shells->top_layers, end - i);
        int32_t below = most(shells->bottom_layers, i - begin + 1);
        window->above[i] = shells->top_layers > 0 ? least(above, count) : 0;
        window->below[i] = shells->bottom_layers > 0 ? least(below, count) : 0;
        window->top = most(window->top, window->above[i]);
        window->bottom = most(window->bottom, window->below[i]);
    }
    return ISO_OK;
}

iso_status window_new(iso_window *window, const iso_levels *levels, const iso_shell_depth *shells,
                      int32_t block, int32_t around) {
    *window = (iso_window){.count = levels->count, .bridges = shells->bridges};
    ISO_TRY(count_shells(window, levels, shells));
    int32_t behind = most(window->bottom, most(around, 1));
    window->ring = least(block + window->top + around + behind, window->count);
    window->levels = 1 + iso_shell_level(most(window->top, window->bottom));
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
    iso_release(window->above);
    iso_release(window->below);
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
    int32_t above = window->above[index], below = window->below[index];
    iso_shell_neighbours around = {.own = &window_layer(window, index)->run[0],
                                   .above = side_of(window, index + 1, above),
                                   .below = side_of(window, index - below, below)};
    if (above > 0 && index + 1 < window->count)
        around.next = &window_layer(window, index + 1)->run[0];
    if (window->bridges && index > 0)
        around.beneath = &window_layer(window, index - 1)->run[0];
    return around;
}

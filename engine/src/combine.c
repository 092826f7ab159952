#include "combine.h"

void combine_plan(iso_combination *of, const iso_levels *levels, const iso_options *options) {
    double most = options->nozzle_diameter + 1e-6;
    int32_t count = levels->count;
    for (int32_t first = 0, last; first < count; first = last + 1) {
        double height = levels->height[first];
        for (last = first; first > 0 && last + 1 < count; last++) {
            if (last + 1 - first == options->infill_every_layers ||
                height + levels->height[last + 1] > most)
                break;
            height += levels->height[last + 1];
        }
        for (int32_t i = first; i <= last; i++)
            of[i] = (iso_combination){.first = first, .last = last, .height = height};
    }
}

/* layer->together = what is sparse on all of them. */
static iso_status intersect(iso_layer *layer, const iso_window *window, const iso_combination *of,
                            iso_hand *hand) {
    const iso_region *common = &window_layer(window, of->first)->shell.sparse;
    for (int32_t i = of->first + 1; i <= of->last; i++) {
        const iso_region *sparse = &window_layer(window, i)->shell.sparse;
        ISO_TRY(iso_boolean(&layer->alone, ISO_INTERSECTION, common, sparse, hand->planar));
        iso_region swap = layer->alone;
        layer->alone = layer->together;
        layer->together = swap;
        common = &layer->together;
    }
    return ISO_OK;
}

iso_status combine_layer(const iso_window *window, int32_t index, const iso_combination *of,
                         iso_hand *hand) {
    iso_layer *layer = window_layer(window, index);
    iso_region_clear(&layer->together);
    layer->combined = of->last > of->first;
    if (!layer->combined)
        return ISO_OK;
    ISO_TRY(intersect(layer, window, of, hand));
    ISO_TRY(iso_boolean(&layer->alone, ISO_DIFFERENCE, &layer->shell.sparse, &layer->together,
                        hand->planar));
    if (index < of->last)
        iso_region_clear(&layer->together);
    return ISO_OK;
}

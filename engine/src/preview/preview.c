#include <isoslice/preview.h>

#include <math.h>
#include <stdbool.h>

#include "base/memory.h"
#include "base/output.h"
#include "preview/drawing.h"
#include "preview/reader.h"

iso_preview_options iso_preview_defaults(void) {
    return (iso_preview_options){
        .spread = 4, .columns = 4, .panel = 460, .travels = 1, .filament_diameter = 1.75};
}

static iso_status check_options(const iso_preview_options *options) {
    if (options->layer_count < 0 || (options->layer_count == 0 && options->spread < 1) ||
        options->columns < 1 || options->panel < 10 || options->panel > 100000 ||
        !(options->filament_diameter > 0))
        return iso_fail(ISO_USAGE, "the picture needs at least one layer, one column, 10 to 100000 "
                                   "pixels a panel and a filament");
    return ISO_OK;
}

/* Ascending and each once, so that one pass over the moves fills them. */
static void add_panel(iso_preview_drawing *drawing, int32_t layer) {
    int32_t at = drawing->panel_count;
    for (; at > 0 && drawing->panel[at - 1].layer >= layer; at--)
        if (drawing->panel[at - 1].layer == layer)
            return;
    memmove(&drawing->panel[at + 1], &drawing->panel[at],
            (size_t)(drawing->panel_count - at) * sizeof *drawing->panel);
    drawing->panel[at] = (iso_preview_panel){.layer = layer};
    drawing->panel_count++;
}

static iso_status choose_layers(iso_preview_drawing *drawing, const iso_preview_options *options) {
    int32_t spread = options->spread < drawing->layers ? options->spread : drawing->layers;
    int32_t count = options->layer_count > 0 ? options->layer_count : spread;
    ISO_TRY(ISO_ALLOCATE(drawing->panel, count));
    for (int32_t i = 0; i < count; i++) {
        if (options->layer_count == 0) {
            int64_t step = count > 1 ? count - 1 : 1;
            add_panel(drawing,
                      (int32_t)((2 * (int64_t)i * (drawing->layers - 1) + step) / (2 * step)));
            continue;
        }
        int64_t wanted = options->layer[i];
        int64_t layer = wanted < 0 ? drawing->layers + wanted : wanted - 1;
        if (layer < 0 || layer >= drawing->layers)
            return iso_fail(ISO_USAGE, "there is no layer %lld; the layers are 1 to %d",
                            (long long)wanted, drawing->layers);
        add_panel(drawing, (int32_t)layer);
    }
    return ISO_OK;
}

static iso_status count_only(void *payload, const iso_preview_move *move) {
    bool *prints = payload;
    *prints = *prints || (move->width > 0 && move->layer >= 0);
    return ISO_OK;
}

static int32_t units(double mm) {
    double u = mm * ISO_PREVIEW_UNITS;
    return (int32_t)(u < 0 ? u - 0.5 : u + 0.5);
}

static void grow_box(iso_box *box, iso_point at, int32_t reach) {
    box->min.x = at.x - reach < box->min.x ? at.x - reach : box->min.x;
    box->min.y = at.y - reach < box->min.y ? at.y - reach : box->min.y;
    box->max.x = at.x + reach > box->max.x ? at.x + reach : box->max.x;
    box->max.y = at.y + reach > box->max.y ? at.y + reach : box->max.y;
}

static double radius_of(const iso_preview_move *move) {
    double x = move->from.x - move->centre.x, y = move->from.y - move->centre.y;
    return sqrt(x * x + y * y);
}

static iso_preview_panel *find_panel(iso_preview_drawing *drawing, int32_t layer) {
    int32_t low = 0, high = drawing->panel_count;
    while (low < high) {
        int32_t middle = (low + high) / 2;
        if (drawing->panel[middle].layer < layer)
            low = middle + 1;
        else
            high = middle;
    }
    bool found = low < drawing->panel_count && drawing->panel[low].layer == layer;
    return found ? &drawing->panel[low] : NULL;
}

static iso_status keep_move(void *payload, const iso_preview_move *move) {
    iso_preview_drawing *drawing = payload;
    iso_preview_panel *panel = find_panel(drawing, move->layer);
    if (!panel)
        return ISO_OK;
    ISO_TRY(ISO_GROW(drawing->stroke, drawing->stroke_capacity, drawing->stroke_count + 1));
    if (panel->count++ == 0)
        panel->first = drawing->stroke_count;
    iso_preview_stroke *stroke = &drawing->stroke[drawing->stroke_count++];
    *stroke = (iso_preview_stroke){.from = {units(move->from.x), units(move->from.y)},
                                   .to = {units(move->to.x), units(move->to.y)},
                                   .centre = {units(move->centre.x), units(move->centre.y)},
                                   .width = units(move->width),
                                   .turn = move->turn,
                                   .role = move->role};
    if (move->width == 0)
        return ISO_OK;
    stroke->width = stroke->width > 0 ? stroke->width : 1;
    if (panel->z == 0)
        panel->z = units(move->z * 10);
    grow_box(&drawing->box, stroke->from, stroke->width / 2);
    grow_box(&drawing->box, stroke->to, stroke->width / 2);
    if (move->turn) /* the whole circle: more than the arc may need */
        grow_box(&drawing->box, stroke->centre, units(radius_of(move)) + stroke->width / 2);
    return ISO_OK;
}

static iso_status gather(iso_preview_drawing *drawing, const iso_preview_text *text,
                         const iso_preview_options *options) {
    bool prints = false;
    ISO_TRY(
        iso_preview_read(&drawing->layers, text, options->filament_diameter, count_only, &prints));
    if (!prints)
        return iso_fail(ISO_UNREADABLE, "%s: no layer with a move that extrudes; is this G-code?",
                        text->path);
    ISO_TRY(choose_layers(drawing, options));
    drawing->box = (iso_box){{INT32_MAX, INT32_MAX}, {INT32_MIN, INT32_MIN}};
    ISO_TRY(
        iso_preview_read(&drawing->layers, text, options->filament_diameter, keep_move, drawing));
    if (drawing->box.min.x > drawing->box.max.x)
        drawing->box = (iso_box){{0, 0}, {1000, 1000}};
    return ISO_OK;
}

iso_status iso_preview_svg(const char *svg_path, const char *gcode_path,
                           const iso_preview_options *options) {
    ISO_TRY(check_options(options));
    iso_preview_text text;
    ISO_TRY(iso_preview_text_read(&text, gcode_path));
    iso_preview_drawing drawing = {0};
    iso_output *output = NULL;
    iso_status status = gather(&drawing, &text, options);
    if (status == ISO_OK)
        status = iso_output_open(&output, svg_path);
    if (status == ISO_OK) {
        status = iso_preview_draw(output, &drawing, options);
        if (status == ISO_OK)
            status = iso_output_commit(output);
        else
            iso_output_abandon(output);
    }
    iso_release(drawing.panel);
    iso_release(drawing.stroke);
    iso_preview_text_free(&text);
    return status;
}

#include <isoslice/preview.h>

#include <math.h>
#include <stdbool.h>

#include "base/memory.h"
#include "base/output.h"
#include "base/series.h"
#include "base/vector.h"
#include "preview/drawing.h"
#include "preview/reader.h"

#define PI 3.14159265358979323846
#define ARC_STEP (PI / 24)

iso_preview_options iso_preview_defaults(void) {
    return (iso_preview_options){.spread = 4,
                                 .columns = 4,
                                 .panel = 460,
                                 .travels = 1,
                                 .filament_diameter = 1.75,
                                 .view = {-90, 90}};
}

static iso_status check_options(const iso_preview_options *options) {
    if (options->layer_count < 0 || (options->layer_count == 0 && options->spread < 1) ||
        options->columns < 1 || options->panel < 10 || options->panel > 100000 ||
        !(options->filament_diameter > 0) || !(options->view[1] >= -90 && options->view[1] <= 90) ||
        !(fabs(options->view[0]) <= 360))
        return iso_fail(ISO_USAGE, "the picture needs at least one layer, one column, 10 to 100000 "
                                   "pixels a panel, a filament and a "
                                   "view");
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

/* ---- seen from anywhere ---- */

typedef struct camera {
    iso_preview_drawing *drawing;
    bool above; /* straight from there, as a drawing has it: arcs stay arcs */
    iso_vec3 right, up;
    double sine; /* of its height above the ground: the share of a bead's width that is seen */
} camera;

static camera aim(iso_preview_drawing *drawing, const double view[2]) {
    const double degree = PI / 180;
    camera c = {drawing, view[0] == -90 && view[1] == 90, {1, 0, 0}, {0, 1, 0}, 1};
    double s, cosine, cos_up;
    if (c.above)
        return c;
    series_sine_cosine(&s, &cosine, view[0] * degree);
    series_sine_cosine(&c.sine, &cos_up, view[1] * degree);
    c.right = vec3(-s, cosine, 0);
    c.up = vec3(-cosine * c.sine, -s * c.sine, cos_up);
    return c;
}

static iso_vec2 seen(const camera *c, iso_vec2 at, double z) {
    iso_vec3 p = vec3(at.x, at.y, z);
    return c->above ? at : (iso_vec2){vec3_dot(p, c->right), vec3_dot(p, c->up)};
}

static double width_seen(const camera *c, const iso_preview_move *move) {
    double height = fmin(move->height, move->width);
    return height + (move->width - height) * fabs(c->sine);
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

static void see_height(iso_preview_panel *panel, double z) {
    int32_t um = units(z * 10);
    bool first = panel->z == 0 && panel->top == 0;
    panel->z = first || um < panel->z ? um : panel->z;
    panel->top = first || um > panel->top ? um : panel->top;
}

static int32_t length_of(const iso_preview_move *move) {
    double z = move->z - move->from_z;
    iso_vec2 way = {move->to.x - move->from.x, move->to.y - move->from.y};
    return units(sqrt(way.x * way.x + way.y * way.y + z * z));
}

static iso_point unit_point(iso_vec2 at) {
    return (iso_point){units(at.x), units(at.y)};
}

static iso_status keep_stroke(const camera *c, iso_preview_panel *panel,
                              const iso_preview_move *move) {
    iso_preview_drawing *drawing = c->drawing;
    ISO_TRY(ISO_GROW(drawing->stroke, drawing->stroke_capacity, drawing->stroke_count + 1));
    if (panel->count++ == 0)
        panel->first = drawing->stroke_count;
    iso_preview_stroke *stroke = &drawing->stroke[drawing->stroke_count++];
    *stroke = (iso_preview_stroke){.from = unit_point(seen(c, move->from, move->from_z)),
                                   .to = unit_point(seen(c, move->to, move->z)),
                                   .centre = unit_point(move->centre),
                                   .width = units(width_seen(c, move)),
                                   .length = length_of(move),
                                   .turn = move->turn,
                                   .role = move->role};
    if (move->width == 0)
        return ISO_OK;
    stroke->width = stroke->width > 0 ? stroke->width : 1;
    see_height(panel, move->from_z);
    see_height(panel, move->z);
    grow_box(&drawing->box, stroke->from, stroke->width / 2);
    grow_box(&drawing->box, stroke->to, stroke->width / 2);
    if (move->turn) /* the whole circle: more than the arc may need */
        grow_box(&drawing->box, stroke->centre, units(radius_of(move)) + stroke->width / 2);
    return ISO_OK;
}

/* Arcs seen from aside are ellipses: they become chords. */
static iso_status keep_chords(const camera *c, iso_preview_panel *panel,
                              const iso_preview_move *move) {
    iso_vec2 a = {move->from.x - move->centre.x, move->from.y - move->centre.y};
    iso_vec2 b = {move->to.x - move->centre.x, move->to.y - move->centre.y};
    double angle = atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y) * move->turn;
    angle = (angle <= 0 ? angle + 2 * PI : angle) * move->turn;
    int32_t count = (int32_t)(fabs(angle) / ARC_STEP) + 1;
    iso_preview_move chord = *move;
    chord.turn = 0;
    for (int32_t i = 1; i <= count; i++) {
        double s, cosine, share = (double)i / count;
        series_sine_cosine(&s, &cosine, angle * share);
        chord.to = (iso_vec2){move->centre.x + a.x * cosine - a.y * s,
                              move->centre.y + a.x * s + a.y * cosine};
        chord.z = move->from_z + (move->z - move->from_z) * share;
        ISO_TRY(keep_stroke(c, panel, &chord));
        chord.from = chord.to;
        chord.from_z = chord.z;
    }
    return ISO_OK;
}

static iso_status keep_move(void *payload, const iso_preview_move *move) {
    const camera *c = payload;
    iso_preview_panel *panel = find_panel(c->drawing, move->layer);
    if (!panel)
        return ISO_OK;
    return move->turn && !c->above ? keep_chords(c, panel, move) : keep_stroke(c, panel, move);
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
    camera c = aim(drawing, options->view);
    ISO_TRY(iso_preview_read(&drawing->layers, text, options->filament_diameter, keep_move, &c));
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

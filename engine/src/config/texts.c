#include "config/texts.h"

#include <math.h>
#include <stddef.h>

#include "base/memory.h"
#include "planar/hull.h"

#define PI 3.14159265358979323846

enum { EXPANDED_SIZE = 64 << 10 /* as the G-code writer has it */ };

/* ---- the place of the first layer ---- */

/* How far skirt and brim reach beyond the models, as PrusaSlicer counts it for these variables: to
 * the outer edge of the brim, or half a line beyond that of the skirt. */
static double widening(const iso_options *options) {
    double height = iso_options_first_height(options);
    double width = iso_options_width(options, ISO_ROLE_SKIRT, true, height);
    double spacing = width - height * (1 - PI / 4);
    double brim = options->brim_width;
    if (options->brim_type != ISO_BRIM_OUTER && options->brim_type != ISO_BRIM_BOTH)
        brim = 0;
    if (options->skirts == 0)
        return brim > 0 ? brim + options->brim_separation : 0;
    return brim + options->skirt_distance + (options->skirts + 0.5) * spacing;
}

/* Every edge of the hull moved outwards; corners are cut. */
static int32_t widen_hull(iso_vec2 *wide, const iso_vec2 *hull, int32_t count, double by) {
    int32_t n = 0;
    for (int32_t i = 0; i < count; i++) {
        iso_vec2 a = hull[i], b = hull[i + 1 == count ? 0 : i + 1];
        double x = b.x - a.x, y = b.y - a.y, length = sqrt(x * x + y * y);
        if (length == 0)
            continue;
        iso_vec2 out = {y / length * by, -x / length * by};
        wide[n++] = (iso_vec2){a.x + out.x, a.y + out.y};
        wide[n++] = (iso_vec2){b.x + out.x, b.y + out.y};
    }
    return n;
}

static iso_status set_hull(iso_texts *texts, const iso_vec2 *hull, int32_t corners) {
    iso_macro_job *job = &texts->job;
    double by = widening(texts->options);
    iso_vec2 low = hull[0], high = low;
    for (int32_t i = 0; i < corners; i++) {
        low = (iso_vec2){fmin(low.x, hull[i].x), fmin(low.y, hull[i].y)};
        high = (iso_vec2){fmax(high.x, hull[i].x), fmax(high.y, hull[i].y)};
    }
    job->print_min = (iso_vec2){low.x - by, low.y - by};
    job->print_max = (iso_vec2){high.x + by, high.y + by};
    ISO_TRY(ISO_ALLOCATE(texts->hull, 2 * (int64_t)corners));
    if (by > 0) {
        job->hull_count = widen_hull(texts->hull, hull, corners, by);
    } else {
        memcpy(texts->hull, hull, (size_t)corners * sizeof *hull);
        job->hull_count = corners;
    }
    job->hull = texts->hull;
    return ISO_OK;
}

iso_status texts_place(iso_texts *texts, const iso_region *first) {
    int32_t count = first->count ? first->first[first->count] : 0;
    iso_point *point;
    iso_vec2 *hull;
    if (count == 0)
        return ISO_OK;
    ISO_TRY(ISO_ALLOCATE(point, 2 * (int64_t)count + 1));
    memcpy(point, first->point, (size_t)count * sizeof *point);
    int32_t corners = hull_of(point + count, point, count);
    iso_status status = ISO_ALLOCATE(hull, corners);
    if (status == ISO_OK) {
        for (int32_t i = 0; i < corners; i++)
            hull[i] = (iso_vec2){iso_mm(point[count + i].x), iso_mm(point[count + i].y)};
        status = set_hull(texts, hull, corners);
        iso_release(hull);
    }
    iso_release(point);
    return status;
}

/* ---- expanding ---- */

static const struct {
    const char *name;
    size_t offset;
    bool of_layer; /* layer_num, layer_z and max_layer_z are known */
} table[ISO_TEXT_KIND_COUNT] = {
#define TEXT(kind, option, of_layer) [kind] = {#option, offsetof(iso_options, option), of_layer}
    TEXT(ISO_TEXT_START, start_gcode, false),
    TEXT(ISO_TEXT_END, end_gcode, true),
    TEXT(ISO_TEXT_START_FILAMENT, start_filament_gcode, false),
    TEXT(ISO_TEXT_END_FILAMENT, end_filament_gcode, true),
    TEXT(ISO_TEXT_BEFORE_LAYER, before_layer_gcode, true),
    TEXT(ISO_TEXT_LAYER, layer_gcode, true),
    TEXT(ISO_TEXT_BETWEEN_OBJECTS, between_objects_gcode, true),
    TEXT(ISO_TEXT_TOOLCHANGE, toolchange_gcode, true),
    TEXT(ISO_TEXT_COLOR_CHANGE, color_change_gcode, true),
    TEXT(ISO_TEXT_PAUSE, pause_print_gcode, true),
    TEXT(ISO_TEXT_TEMPLATE, template_custom_gcode, true),
    TEXT(ISO_TEXT_EVENT, events, true),
#undef TEXT
};

static const char *text_of(const iso_texts *texts, int kind) {
    return table[kind].name ? (const char *)texts->options + table[kind].offset : "";
}

iso_status texts_expand(char *text, size_t size, const iso_texts *texts, const char *from,
                        const char *name) {
    return iso_macro_expand(text, size, from, name, &texts->scope);
}

iso_status texts_write(char *text, size_t size, const void *payload, iso_gcode_text_kind kind,
                       const iso_gcode_place *place) {
    const iso_texts *texts = payload;
    const char *from = kind == ISO_TEXT_EVENT ? place->event : text_of(texts, (int)kind);
    if (*from == 0 && size > 0) {
        *text = 0;
        return ISO_OK;
    }
    const iso_macro_number number[] = {{"color_change_extruder", 0, true},
                                       {"layer_num", place->layer, true},
                                       {"layer_z", place->z, false},
                                       {"max_layer_z", place->max_z, false},
                                       {"previous_extruder", place->tool, true},
                                       {"next_extruder", place->next_tool, true},
                                       {"toolchange_z", place->z, false},
                                       {"toolchange_count", place->tool_changes, true}};
    iso_macro_scope scope = texts->scope;
    scope.number = number;
    scope.number_count = kind == ISO_TEXT_TOOLCHANGE ? 8 : table[kind].of_layer ? 4 : 0;
    return iso_macro_expand(text, size, from, table[kind].name, &scope);
}

void texts_begin(iso_texts *texts, const iso_options *options, const iso_macro_job *job) {
    texts->options = options;
    texts->scope = (iso_macro_scope){.options = options, .globals = &texts->globals};
    if (job) {
        texts->job = *job;
        texts->scope.job = &texts->job;
    }
}

iso_status texts_check(const iso_texts *texts, double top) {
    char *text = NULL;
    double first = iso_options_first_height(texts->options);
    const iso_gcode_place begin = {.layer = 0, .z = first, .max_z = first, .object = -1};
    const iso_gcode_place end = {
        .layer = texts->job.layer_count - 1, .z = top, .max_z = top, .object = -1};
    bool lasting = false;
    for (int kind = 0; kind < ISO_TEXT_KIND_COUNT; kind++) {
        if (table[kind].name)
            ISO_TRY(iso_macro_check(text_of(texts, kind), table[kind].name));
        lasting = lasting || strstr(text_of(texts, kind), "global");
    }
    if (lasting)
        return ISO_OK;
    ISO_TRY(ISO_ALLOCATE(text, EXPANDED_SIZE));
    iso_status status = ISO_OK;
    for (int kind = 0; kind < ISO_TEXT_BETWEEN_OBJECTS && status == ISO_OK; kind++) {
        bool at_end = kind == ISO_TEXT_END || kind == ISO_TEXT_END_FILAMENT;
        status = texts_write(text, EXPANDED_SIZE, texts, (iso_gcode_text_kind)kind,
                             at_end ? &end : &begin);
    }
    iso_release(text);
    return status;
}

void texts_free(iso_texts *texts) {
    iso_macro_globals_free(&texts->globals);
    iso_release(texts->hull);
    *texts = (iso_texts){0};
}

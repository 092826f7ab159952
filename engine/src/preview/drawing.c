#include "preview/drawing.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include <isoslice/path.h>

enum { GAP = 16, TITLE = 40, FOOT = 64, LEGEND_STEP = 210, LEGEND_LINE = 22, MARGIN = 100 };

/* The colours that users know from PrusaSlicer's G-code viewer. */
static const char *const colour[ISO_ROLE_COUNT] = {
    [ISO_ROLE_EXTERNAL_PERIMETER] = "#ff7d38",
    [ISO_ROLE_PERIMETER] = "#ffe64d",
    [ISO_ROLE_OVERHANG_PERIMETER] = "#1f1fff",
    [ISO_ROLE_INTERNAL_INFILL] = "#b03029",
    [ISO_ROLE_SOLID_INFILL] = "#9654cc",
    [ISO_ROLE_TOP_SOLID_INFILL] = "#f04040",
    [ISO_ROLE_IRONING] = "#ff8c69",
    [ISO_ROLE_BRIDGE_INFILL] = "#4d80ba",
    [ISO_ROLE_GAP_FILL] = "#ffffff",
    [ISO_ROLE_SKIRT] = "#00876e",
    [ISO_ROLE_SUPPORT] = "#00ff00",
    [ISO_ROLE_SUPPORT_INTERFACE] = "#008000",
    [ISO_ROLE_CUSTOM] = "#5ed194",
};

typedef struct layout {
    int32_t columns, rows;
    int32_t view_width, view_height; /* of a panel, in units of the drawing */
    int32_t panel_width, panel_height;
    int32_t width, height; /* px of the whole picture */
    int32_t legend_columns, legend_count;
    bool shown[ISO_ROLE_COUNT]; /* roles that occur */
    int64_t length[ISO_ROLE_COUNT];
} layout;

static int64_t root(int64_t square) {
    int64_t low = 0, high = 3037000499;
    while (low < high) {
        int64_t middle = (low + high + 1) / 2;
        if (middle <= square / middle)
            low = middle;
        else
            high = middle - 1;
    }
    return low;
}

static layout lay_out(const iso_preview_drawing *drawing, const iso_preview_options *options) {
    layout l = {.columns = drawing->panel_count};
    if (l.columns > options->columns)
        l.columns = options->columns;
    l.rows = (drawing->panel_count + l.columns - 1) / l.columns;
    l.columns = (drawing->panel_count + l.rows - 1) / l.rows; /* 6 as 3 and 3, not 4 and 2 */
    l.view_width = drawing->box.max.x - drawing->box.min.x + 2 * MARGIN;
    l.view_height = drawing->box.max.y - drawing->box.min.y + 2 * MARGIN;
    int64_t longer = l.view_width > l.view_height ? l.view_width : l.view_height;
    l.panel_width = (int32_t)(((int64_t)options->panel * l.view_width + longer - 1) / longer);
    l.panel_height = (int32_t)(((int64_t)options->panel * l.view_height + longer - 1) / longer);
    for (int64_t i = 0; i < drawing->stroke_count; i++)
        if (drawing->stroke[i].width > 0) {
            l.shown[drawing->stroke[i].role] = true;
            l.length[drawing->stroke[i].role] += drawing->stroke[i].length;
        }
    for (int role = 0; role < ISO_ROLE_COUNT; role++)
        l.legend_count += l.shown[role];
    l.legend_count += options->travels ? 1 : 0;
    l.width = GAP + l.columns * (l.panel_width + GAP);
    if (l.width < LEGEND_STEP + 2 * GAP)
        l.width = LEGEND_STEP + 2 * GAP;
    l.legend_columns = (l.width - 2 * GAP) / LEGEND_STEP;
    int32_t lines = (l.legend_count + l.legend_columns - 1) / l.legend_columns;
    l.height = l.rows * (l.panel_height + TITLE) + FOOT + lines * LEGEND_LINE + GAP;
    return l;
}

static void begin(iso_output *output, const layout *l) {
    iso_output_print(output,
                     "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" "
                     "viewBox=\"0 0 %d %d\" font-family=\"sans-serif\" font-size=\"14\">\n"
                     "<style>g,use{fill:none;stroke-linecap:round;stroke-linejoin:round}"
                     ".edge{stroke:#333}.travel{stroke:#3b6ea5;stroke-width:4}",
                     l->width, l->height, l->width, l->height);
    for (int role = 0; role < ISO_ROLE_COUNT; role++)
        if (l->shown[role])
            iso_output_print(output, ".role-%d{stroke:%s}", role, colour[role]);
    iso_output_print(output, "</style>\n<rect width=\"%d\" height=\"%d\" fill=\"#fff\"/>\n",
                     l->width, l->height);
}

static bool goes_on(const iso_preview_stroke *a, const iso_preview_stroke *b) {
    return a->to.x == b->from.x && a->to.y == b->from.y;
}

/* Relative coordinates halve the file. */
static void write_moves(iso_output *output, const iso_preview_stroke *stroke, int64_t count) {
    for (int64_t i = 0; i < count; i++) {
        const iso_preview_stroke *s = &stroke[i];
        if (i == 0 || !goes_on(s - 1, s))
            iso_output_print(output, "M%d %d", s->from.x, -s->from.y);
        int32_t dx = s->to.x - s->from.x, dy = s->from.y - s->to.y;
        if (!s->turn) {
            iso_output_print(output, "l%d %d", dx, dy);
            continue;
        }
        int64_t x = (int64_t)s->from.x - s->centre.x, y = (int64_t)s->from.y - s->centre.y;
        /* the centre lies left of the chord of a counter-clockwise arc, unless it is a large one */
        int64_t side = (x * -dy - y * dx) * s->turn;
        int64_t radius = root(x * x + y * y);
        iso_output_print(output, "a%lld %lld 0 %d %d %d %d", (long long)radius, (long long)radius,
                         side < 0, s->turn < 0, dx, dy);
    }
}

static bool alike(const iso_preview_stroke *a, const iso_preview_stroke *b) {
    return a->width == b->width && (a->width == 0 || a->role == b->role);
}

/* NULL where the layer has none */
static const iso_preview_stroke *strokes_of(const iso_preview_drawing *drawing,
                                            const iso_preview_panel *panel) {
    return panel->count > 0 ? drawing->stroke + panel->first : NULL;
}

/* Each bead is drawn twice, the second time a little narrower and brighter: its edge stays to be
 * seen where it lies against a neighbour. The first stroke has the true width. */
static void write_beads(iso_output *output, const iso_preview_drawing *drawing, int32_t index) {
    const iso_preview_panel *panel = &drawing->panel[index];
    const iso_preview_stroke *stroke = strokes_of(drawing, panel);
    for (int64_t i = 0, next; i < panel->count; i = next) {
        next = i + 1;
        while (next < panel->count && alike(&stroke[i], &stroke[next]))
            next++;
        int32_t width = stroke[i].width;
        if (width == 0)
            continue;
        iso_output_print(output, "<g class=\"edge\" stroke-width=\"%d\"><path id=\"b%d-%lld\" d=\"",
                         width, index, (long long)i);
        write_moves(output, stroke + i, next - i);
        int32_t edge = width / 8 > 6 ? 6 : width / 8;
        iso_output_print(
            output, "\"/></g><use class=\"role-%d\" stroke-width=\"%d\" href=\"#b%d-%lld\"/>\n",
            stroke[i].role, width - 2 * edge, index, (long long)i);
    }
}

static void write_travels(iso_output *output, const iso_preview_drawing *drawing, int32_t index) {
    const iso_preview_panel *panel = &drawing->panel[index];
    const iso_preview_stroke *stroke = strokes_of(drawing, panel);
    iso_output_print(output, "<g class=\"travel\"><path d=\"");
    for (int64_t i = 0, next; i < panel->count; i = next) {
        next = i + 1;
        while (next < panel->count && alike(&stroke[i], &stroke[next]))
            next++;
        if (stroke[i].width == 0)
            write_moves(output, stroke + i, next - i);
    }
    iso_output_print(output, "\"/></g>\n");
}

/* "0.2", "12.35", "7" */
static const char *format_mm(char text[32], int64_t um) {
    int length = snprintf(text, 32, "%s%lld.%03lld", um < 0 ? "-" : "", llabs((long long)um) / 1000,
                          llabs((long long)um) % 1000);
    while (text[length - 1] == '0')
        text[--length] = '\0';
    if (text[length - 1] == '.')
        text[--length] = '\0';
    return text;
}

static void write_panel(iso_output *output, const iso_preview_drawing *drawing, int32_t index,
                        const layout *l, bool travels) {
    const iso_preview_panel *panel = &drawing->panel[index];
    int32_t left = GAP + index % l->columns * (l->panel_width + GAP);
    int32_t top = TITLE + index / l->columns * (l->panel_height + TITLE);
    char z[32], high[32];
    bool level = panel->top == panel->z;
    iso_output_print(output,
                     "<text x=\"%d\" y=\"%d\"><tspan font-weight=\"bold\">Layer %d</tspan> of %d, "
                     "z = %s%s%s mm</text>\n",
                     left, top - 12, panel->layer + 1, drawing->layers, format_mm(z, panel->z),
                     level ? "" : " to ", level ? "" : format_mm(high, panel->top));
    iso_output_print(output,
                     "<svg x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" viewBox=\"%d %d %d %d\">\n"
                     "<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" fill=\"#f2f2f0\"/>\n",
                     left, top, l->panel_width, l->panel_height, drawing->box.min.x - MARGIN,
                     -drawing->box.max.y - MARGIN, l->view_width, l->view_height,
                     drawing->box.min.x - MARGIN, -drawing->box.max.y - MARGIN, l->view_width,
                     l->view_height);
    write_beads(output, drawing, index);
    if (travels)
        write_travels(output, drawing, index);
    iso_output_print(output, "</svg>\n");
}

/* 1, 2 or 5 times a power of ten, at most a third of a panel */
static int64_t scale_length(const layout *l) {
    int64_t limit = l->view_width / 3, length = ISO_PREVIEW_UNITS / 10;
    static const int step[3] = {2, 5, 10};
    for (int64_t decade = length;; decade *= 10)
        for (int k = 0; k < 3; k++) {
            if (decade * step[k] > limit)
                return length;
            length = decade * step[k];
        }
}

static void write_scale(iso_output *output, const layout *l, int32_t y) {
    int64_t length = scale_length(l);
    int64_t pixels = (length * l->panel_width + l->view_width / 2) / l->view_width;
    char mm[32];
    iso_output_print(output,
                     "<path d=\"M%d %dv-8m0 4h%lldm0 -4v8\" fill=\"none\" stroke=\"#000\"/>"
                     "<text x=\"%lld\" y=\"%d\">%s mm</text>\n",
                     GAP, y, (long long)pixels, GAP + (long long)pixels + 8, y,
                     format_mm(mm, length * 1000 / ISO_PREVIEW_UNITS));
}

static void write_legend(iso_output *output, const layout *l, bool travels) {
    int32_t top = l->rows * (l->panel_height + TITLE);
    write_scale(output, l, top + 26);
    int32_t place = 0;
    for (int role = 0; role <= ISO_ROLE_COUNT; role++) {
        bool travel = role == ISO_ROLE_COUNT;
        if (travel ? !travels : !l->shown[role])
            continue;
        int32_t x = GAP + place % l->legend_columns * LEGEND_STEP;
        int32_t y = top + FOOT + place / l->legend_columns * LEGEND_LINE;
        place++;
        if (travel) {
            iso_output_print(output,
                             "<path d=\"M%d %dh14\" stroke=\"#3b6ea5\"/>"
                             "<text x=\"%d\" y=\"%d\">Travel</text>\n",
                             x, y - 5, x + 22, y);
            continue;
        }
        char metres[32];
        iso_output_print(output,
                         "<rect x=\"%d\" y=\"%d\" width=\"14\" height=\"12\" fill=\"%s\" "
                         "stroke=\"#333\"/><text x=\"%d\" y=\"%d\">%s, %s m</text>\n",
                         x, y - 11, colour[role], x + 22, y, iso_role_name((iso_role)role),
                         format_mm(metres, (l->length[role] + 500) / 1000 * 10));
    }
}

iso_status iso_preview_draw(iso_output *output, const iso_preview_drawing *drawing,
                            const iso_preview_options *options) {
    layout l = lay_out(drawing, options);
    begin(output, &l);
    for (int32_t i = 0; i < drawing->panel_count; i++)
        write_panel(output, drawing, i, &l, options->travels != 0);
    write_legend(output, &l, options->travels != 0);
    return iso_output_print(output, "</svg>\n");
}

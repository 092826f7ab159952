#include "contour_map.h"

#include <stdio.h>

#include "config/value.h"

enum { PICTURE_WIDTH = 1600 /* px; it can be magnified at will */ };

/* All lengths in mm. */
typedef struct map {
    iso_vec2 min, max;    /* of all contours */
    double gap;           /* between layers */
    double letter;        /* height of the captions */
    double width, height; /* a layer's share of the sheet, gap and caption included */
    int32_t columns, rows;
} map;

static void find_box(map *m, const iso_slices *slices) {
    for (int64_t i = 0; i < slices->crossing_count; i++) {
        iso_vec2 p = slices->point[i];
        if (i == 0)
            m->min = m->max = p;
        m->min = (iso_vec2){p.x < m->min.x ? p.x : m->min.x, p.y < m->min.y ? p.y : m->min.y};
        m->max = (iso_vec2){p.x > m->max.x ? p.x : m->max.x, p.y > m->max.y ? p.y : m->max.y};
    }
}

/* As many columns as make the sheet about as wide as a screen. */
static map lay_out(const iso_slices *slices) {
    map m = {.columns = 1};
    int32_t count = slices->level_count > 0 ? slices->level_count : 1;
    find_box(&m, slices);
    double wide = m.max.x - m.min.x, high = m.max.y - m.min.y;
    double longer = wide > high ? wide : high;
    if (longer <= 0)
        longer = 1;
    m.gap = 0.1 * longer;
    m.letter = 0.09 * longer;
    m.width = (wide > 0.5 * longer ? wide : 0.5 * longer) + m.gap; /* room for the caption */
    m.height = high + m.gap + 1.5 * m.letter;
    m.rows = count;
    while (m.columns < count && 10 * m.columns * m.width < 16 * m.rows * m.height) {
        m.columns++;
        m.rows = (count + m.columns - 1) / m.columns;
    }
    return m;
}

void iso_contour_colour(char text[8], int32_t level, int32_t count) {
    int t = count > 1 ? (int)((int64_t)level * 510 / (count - 1)) : 0;
    int red = t > 255 ? t - 255 : 0, blue = t < 255 ? 255 - t : 0, green = 255 - red - blue;
    snprintf(text, 8, "#%02x%02x%02x", (80 + red * 5 / 8) & 255, (90 + green * 3 / 8) & 255,
             (80 + blue * 5 / 8) & 255);
}

/* To 100 nm, as fine as the print has it. */
static const char *number(char text[32], double mm) {
    double scaled = mm * ISO_UNITS_PER_MM;
    iso_number_write(text, (double)(int64_t)(scaled < 0 ? scaled - 0.5 : scaled + 0.5) /
                               ISO_UNITS_PER_MM);
    return text;
}

static void begin(iso_output *output, const map *m) {
    char width[32], height[32], pixels[32], line[32], letter[32];
    double wide = m->columns * m->width + m->gap, high = m->rows * m->height + m->gap;
    iso_output_print(output,
                     "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%s\" "
                     "viewBox=\"0 0 %s %s\" font-family=\"sans-serif\" font-size=\"%s\">\n"
                     "<style>path{fill-rule:nonzero;stroke:#222;stroke-width:%s}</style>\n"
                     "<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n",
                     PICTURE_WIDTH, number(pixels, PICTURE_WIDTH * high / wide),
                     number(width, wide), number(height, high), number(letter, m->letter),
                     number(line, 0.004 * m->width));
}

static void put_path(iso_output *output, const iso_slices *slices, int32_t level) {
    char x[32], y[32];
    iso_output_print(output, "<path d=\"");
    for (int32_t c = slices->level_first[level]; c < slices->level_first[level + 1]; c++) {
        int64_t first = slices->contour_first[c];
        for (int64_t i = first; i < slices->contour_first[c + 1]; i++)
            iso_output_print(output, "%c%s %s", i == first ? 'M' : 'L',
                             number(x, slices->point[i].x), number(y, slices->point[i].y));
        iso_output_print(output, "Z");
    }
    iso_output_print(output, "\"/>");
}

static void put_level(iso_output *output, const map *m, const iso_slices *slices,
                      const iso_levels *levels, int32_t level) {
    double left = m->gap + level % m->columns * m->width;
    double top = m->gap + level / m->columns * m->height;
    char colour[8], z[32], x[32], y[32];
    iso_contour_colour(colour, level, slices->level_count);
    number(z, levels->cut[level]);
    iso_output_print(output, "<text x=\"%s\" y=\"%s\"><tspan font-weight=\"bold\">%d</tspan> %s mm",
                     number(x, left), number(y, top + m->letter), level + 1, z);
    iso_output_print(output,
                     "</text>\n<g id=\"layer%d\" data-z=\"%s\" fill=\"%s\" "
                     "transform=\"translate(%s,%s) scale(1,-1)\">",
                     level + 1, z, colour, number(x, left - m->min.x),
                     number(y, top + 1.5 * m->letter + m->max.y));
    put_path(output, slices, level);
    iso_output_print(output, "</g>\n");
}

iso_status iso_contour_map(iso_output *output, const iso_slices *slices, const iso_levels *levels) {
    map m = lay_out(slices);
    begin(output, &m);
    for (int32_t l = 0; l < slices->level_count; l++)
        put_level(output, &m, slices, levels, l);
    return iso_output_print(output, "</svg>\n");
}

#include "channel_picture.h"

#include <stdbool.h>

#include "base/memory.h"
#include "base/output.h"
#include "base/sort.h"
#include "base/vector.h"

enum {
    PICTURE_WIDTH = 900, /* px */
    UNITS = 2000,        /* of the picture's width: coordinates are whole numbers */
    SHADES = 12,
    CORNERS_MAX = 64,
    PART_AROUND = 40, /* faces around a tower, and up */
    PART_UP = 24,
    SKIN_AROUND = 8,
    SKIN_ALL = 1100 /* faces of all channels, or so */
};

typedef struct face {
    double depth; /* towards the eye */
    int32_t number;
    int32_t count;
    bool part;
    int shade;
    int32_t at[CORNERS_MAX][2]; /* units, to the right and down */
} face;

typedef struct view {
    iso_vec3 right, up, eye; /* unit vectors */
    double left, top, scale, height;
    face *face;
    int64_t capacity;
    int32_t count;
} view;

static bool face_less(const face *a, const face *b) {
    return a->depth != b->depth ? a->depth < b->depth : a->number < b->number;
}
ISO_SORT(sort_faces, face, face_less)

static iso_vec3 box_corner(const iso_channel_figures *f, int i) {
    return vec3(i & 1 ? f->box_max.x : f->box_min.x, i & 2 ? f->box_max.y : f->box_min.y,
                i & 4 ? f->box_max.z : f->box_min.z);
}

static void aim(view *v, const iso_channel_figures *f) {
    double right = -INFINITY, bottom = INFINITY;
    v->eye = vec3_unit(vec3(0.5, -1, 0.55));
    v->right = vec3_unit(vec3_cross(vec3(0, 0, 1), v->eye));
    v->up = vec3_cross(v->eye, v->right);
    v->left = INFINITY;
    v->top = -INFINITY;
    for (int i = 0; i < 8; i++) {
        double x = vec3_dot(box_corner(f, i), v->right), y = vec3_dot(box_corner(f, i), v->up);
        v->left = fmin(v->left, x);
        right = fmax(right, x);
        v->top = fmax(v->top, y);
        bottom = fmin(bottom, y);
    }
    double edge = 0.02 * (right - v->left);
    v->left -= edge;
    v->top += edge;
    v->scale = UNITS / (right - v->left + edge);
    v->height = (v->top - bottom + edge) * v->scale;
}

static void place(int32_t at[2], const view *v, iso_vec3 p) {
    at[0] = (int32_t)floor((vec3_dot(p, v->right) - v->left) * v->scale + 0.5);
    at[1] = (int32_t)floor((v->top - vec3_dot(p, v->up)) * v->scale + 0.5);
}

/* What is turned away isn't seen. Lit from where the eye is, a little from above. */
static iso_status add_face(view *v, const iso_vec3 *corner, int32_t count, bool part) {
    iso_vec3 normal = {0, 0, 0}, middle = {0, 0, 0};
    for (int32_t i = 0; i < count; i++) {
        iso_vec3 a = vec3_minus(corner[i], corner[0]);
        iso_vec3 b = vec3_minus(corner[i + 1 < count ? i + 1 : 0], corner[0]);
        normal = vec3_plus(normal, vec3_cross(a, b));
        middle = vec3_along(middle, 1.0 / count, corner[i]);
    }
    normal = vec3_unit(normal);
    if (vec3_dot(normal, v->eye) <= 0)
        return ISO_OK;
    ISO_TRY(ISO_GROW(v->face, v->capacity, v->count + 1));
    face *made = &v->face[v->count];
    double light = vec3_dot(normal, vec3_unit(vec3(-0.2, -0.8, 0.9)));
    light = light < 0 ? 0 : light;
    *made = (face){.depth = vec3_dot(middle, v->eye),
                   .number = v->count++,
                   .count = count,
                   .part = part,
                   .shade = (int)(light * (SHADES - 1) + 0.5)};
    for (int32_t i = 0; i < count; i++)
        place(made->at[i], v, corner[i]);
    return ISO_OK;
}

// Square-links, seen coarsely

typedef struct grid {
    const double *g;
    int32_t width, height; /* index i + width j */
} grid;

static iso_vec3 corner_of(const grid *from, int32_t i, int32_t j) {
    const double *g = from->g + 3 * ((int64_t)(i % from->width) + (int64_t)from->width * j);
    return vec3(g[0], g[1], g[2]);
}

/* Faces around and along; `closed`: from the last row to the first. */
static iso_status add_grid(view *v, const grid *from, int32_t around, int32_t along, bool closed,
                           bool part) {
    int32_t rows = closed ? from->height : from->height - 1;
    around = around < from->width ? around : from->width;
    along = along < 1 ? 1 : along < rows ? along : rows;
    for (int32_t r = 0; r < along; r++)
        for (int32_t k = 0; k < around; k++) {
            int32_t i = (int32_t)((int64_t)from->width * k / around);
            int32_t m = (int32_t)((int64_t)from->width * (k + 1) / around);
            int32_t j = (int32_t)((int64_t)rows * r / along);
            int32_t n = (int32_t)((int64_t)rows * (r + 1) / along) % from->height;
            iso_vec3 corner[4] = {corner_of(from, i, j), corner_of(from, m, j),
                                  corner_of(from, m, n), corner_of(from, i, n)};
            ISO_TRY(add_face(v, corner, 4, part));
        }
    return ISO_OK;
}

/* What is beside it is below it, so it goes over all that is not nearer than its nearest corner. */
static iso_status add_lid(view *v, const grid *from) {
    iso_vec3 corner[CORNERS_MAX];
    int32_t before = v->count;
    for (int32_t k = 0; k < PART_AROUND; k++)
        corner[k] =
            corner_of(from, (int32_t)((int64_t)from->width * k / PART_AROUND), from->height - 1);
    ISO_TRY(add_face(v, corner, PART_AROUND, true));
    for (int32_t k = 0; k < PART_AROUND && v->count > before; k++)
        v->face[before].depth = fmax(v->face[before].depth, vec3_dot(corner[k], v->eye));
    return ISO_OK;
}

static iso_status add_towers(view *v, const iso_channels *channels, int32_t count) {
    for (int32_t t = 0; t < count; t++) {
        iso_square_link link;
        ISO_TRY(iso_channels_tower(&link, NULL, channels, t));
        grid from = {link.link.g, link.link.map[0].length, link.link.map[1].length};
        iso_status status = add_grid(v, &from, PART_AROUND, PART_UP, false, true);
        if (status == ISO_OK)
            status = add_lid(v, &from);
        iso_multilink_free(&link.link);
        ISO_TRY(status);
    }
    return ISO_OK;
}

/* The ends of an open channel, where it leaves the mould: facing out of it. */
static iso_status add_ends(view *v, const grid *from) {
    iso_vec3 first[SKIN_AROUND], last[SKIN_AROUND];
    for (int32_t k = 0; k < SKIN_AROUND; k++) {
        int32_t i = (int32_t)((int64_t)from->width * k / SKIN_AROUND);
        first[SKIN_AROUND - 1 - k] = corner_of(from, i, 0);
        last[k] = corner_of(from, i, from->height - 1);
    }
    ISO_TRY(add_face(v, first, SKIN_AROUND, false));
    return add_face(v, last, SKIN_AROUND, false);
}

static iso_status add_skins(view *v, const iso_channels *channels,
                            const iso_channel_figures *figures) {
    for (int32_t c = 0; c < figures->channel_count; c++) {
        iso_square_link link;
        ISO_TRY(iso_channels_skin(&link, channels, c));
        grid from = {link.link.g, link.link.map[0].length, link.link.map[1].length};
        bool closed = link.link.map[1].rule == ISO_MAP_CYCLIC;
        int32_t rows = 2 * SKIN_ALL / (SKIN_AROUND * figures->channel_count);
        iso_status status = add_grid(v, &from, SKIN_AROUND, rows, closed, false);
        if (status == ISO_OK && !closed)
            status = add_ends(v, &from);
        iso_multilink_free(&link.link);
        ISO_TRY(status);
    }
    return ISO_OK;
}

// SVG

/* The mould's edges behind everything, or before it: those of corner 2, which is the farthest from
 * the eye, are behind. */
static void put_edges(iso_output *output, const view *v, const iso_channel_figures *f,
                      bool behind) {
    iso_output_print(output, "<path class=\"%s\" d=\"", behind ? "b" : "e");
    for (int i = 0; i < 8; i++)
        for (int axis = 1; axis < 8; axis *= 2) {
            int32_t from[2], to[2], far = 2;
            if (i & axis || (i == far || (i | axis) == far) != behind)
                continue;
            place(from, v, box_corner(f, i));
            place(to, v, box_corner(f, i | axis));
            iso_output_print(output, "M%d %dL%d %d", from[0], from[1], to[0], to[1]);
        }
    iso_output_print(output, "\"/>\n");
}

static void put_style(iso_output *output) {
    iso_output_print(output, "<style>path{stroke-width:1;stroke-linejoin:round}"
                             ".e,.b{fill:none;stroke:#555;stroke-width:3}"
                             ".b{stroke:#aaa;stroke-dasharray:12 10}");
    for (int s = 0; s < SHADES; s++) {
        int grey = 130 + 115 * s / (SHADES - 1);
        int red = 20 + 90 * s / (SHADES - 1), green = 60 + 110 * s / (SHADES - 1);
        int blue = 120 + 125 * s / (SHADES - 1);
        iso_output_print(output,
                         ".p%d{fill:#%02x%02x%02x;stroke:#%02x%02x%02x}"
                         ".c%d{fill:#%02x%02x%02x;stroke:#%02x%02x%02x}",
                         s, grey, grey, grey - 8, grey, grey, grey - 8, s, red, green, blue, red,
                         green, blue);
    }
    iso_output_print(output, "</style>\n");
}

static void put_face(iso_output *output, const face *f) {
    iso_output_print(output, "<path class=\"%c%d\" d=\"", f->part ? 'p' : 'c', f->shade);
    for (int32_t i = 0; i < f->count; i++) {
        if (i == 0)
            iso_output_print(output, "M%d %dl", f->at[0][0], f->at[0][1]);
        else
            iso_output_print(output, "%s%d %d", i > 1 ? " " : "", f->at[i][0] - f->at[i - 1][0],
                             f->at[i][1] - f->at[i - 1][1]);
    }
    iso_output_print(output, "z\"/>\n");
}

static void put_all(iso_output *output, const view *v, const iso_channel_figures *f) {
    int32_t height = (int32_t)ceil(v->height);
    iso_output_print(output,
                     "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" "
                     "viewBox=\"0 0 %d %d\">\n",
                     PICTURE_WIDTH, height * PICTURE_WIDTH / UNITS, UNITS, height);
    put_style(output);
    iso_output_print(output, "<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n");
    put_edges(output, v, f, true);
    for (int32_t i = 0; i < v->count; i++)
        put_face(output, &v->face[i]);
    put_edges(output, v, f, false);
    iso_output_print(output, "</svg>\n");
}

iso_status iso_channel_picture(const char *path, const iso_channels *channels) {
    const iso_channel_figures *figures = iso_channels_figures(channels);
    view v = {0};
    iso_output *output;
    aim(&v, figures);
    iso_status status = add_towers(&v, channels, figures->tower_count);
    if (status == ISO_OK)
        status = add_skins(&v, channels, figures);
    if (status == ISO_OK)
        status = iso_output_open(&output, path);
    if (status == ISO_OK) {
        sort_faces(v.face, v.count);
        put_all(output, &v, figures);
        status = iso_output_commit(output);
    }
    iso_release(v.face);
    return status;
}

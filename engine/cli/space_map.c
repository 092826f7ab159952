/* What is hidden is found by a raster of depths, as fine as the picture: every triangle is drawn
 * into it, and a point of a contour is seen unless everything around its place is nearer to the
 * eye. */
#include "space_map.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>

#include "base/memory.h"
#include "base/series.h"
#include "base/vector.h"
#include "config/value.h"
#include "contour_map.h"

enum {
    WIDTH = 1200,     /* px of the picture, at most */
    HEIGHT = 1000,    /* at most, too */
    MARGIN = 30,      /* px around it */
    STEP = 3,         /* px: pieces of contours that are seen or hidden as a whole */
    ROW = 2,          /* px: of what is drawn of bodies */
    CAPTION_SIZE = 20 /* px */
};

#define TOLERANCE 0.2 /* px: what lines may be off */

typedef struct picture {
    iso_vec3 right, up, toward; /* of the eye */
    double scale;               /* px a mm */
    double left, top;           /* px */
    int32_t width, height;      /* px */
    float *depth;               /* [width * height] mm toward the eye, of what is nearest */
    iso_output *output;
} picture;

/* ---- projection ---- */

static void turn_to(picture *p, const iso_space_view *view) {
    double s, c, sin_up, cos_up;
    series_sine_cosine(&s, &c, view->azimuth * (3.14159265358979323846 / 180));
    series_sine_cosine(&sin_up, &cos_up, view->elevation * (3.14159265358979323846 / 180));
    p->right = vec3(-s, c, 0);
    p->up = vec3(-c * sin_up, -s * sin_up, cos_up);
    p->toward = vec3(c * cos_up, s * cos_up, sin_up);
}

/* x, y in px, z the depth in mm. */
static iso_vec3 project(const picture *p, iso_vec3 at) {
    return vec3(p->left + p->scale * vec3_dot(at, p->right),
                p->top - p->scale * vec3_dot(at, p->up), vec3_dot(at, p->toward));
}

static void fit(picture *p, const iso_space_body *body, int32_t count) {
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int32_t b = 0; b < count; b++)
        for (int64_t a = 0; a < 3 * (int64_t)body[b].mesh->triangle_count; a++) {
            iso_vec3 at = vec3_plus(body[b].mesh->position[body[b].mesh->origin[a]], body[b].by);
            double x = vec3_dot(at, p->right), y = vec3_dot(at, p->up);
            low[0] = fmin(low[0], x), high[0] = fmax(high[0], x);
            low[1] = fmin(low[1], y), high[1] = fmax(high[1], y);
        }
    double wide = fmax(high[0] - low[0], 1e-3), tall = fmax(high[1] - low[1], 1e-3);
    p->scale = fmin((WIDTH - 2 * MARGIN) / wide, (HEIGHT - 2 * MARGIN) / tall);
    p->width = (int32_t)(wide * p->scale) + 2 * MARGIN;
    p->height = (int32_t)(tall * p->scale) + 2 * MARGIN;
    p->left = MARGIN - low[0] * p->scale;
    p->top = MARGIN + high[1] * p->scale;
}

/* ---- depths ---- */

static double side(iso_vec3 a, iso_vec3 b, double x, double y) {
    return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

static int32_t clamped(double value, int32_t most) {
    return value < 0 ? 0 : value > most ? most : (int32_t)value;
}

static void draw_depth(picture *p, const iso_vec3 v[3]) {
    double area = side(v[0], v[1], v[2].x, v[2].y);
    if (area == 0)
        return;
    int32_t x0 = clamped(fmin(v[0].x, fmin(v[1].x, v[2].x)), p->width - 1);
    int32_t x1 = clamped(fmax(v[0].x, fmax(v[1].x, v[2].x)) + 1, p->width - 1);
    int32_t y0 = clamped(fmin(v[0].y, fmin(v[1].y, v[2].y)), p->height - 1);
    int32_t y1 = clamped(fmax(v[0].y, fmax(v[1].y, v[2].y)) + 1, p->height - 1);
    for (int32_t y = y0; y <= y1; y++)
        for (int32_t x = x0; x <= x1; x++) {
            double a = side(v[1], v[2], x, y) / area, b = side(v[2], v[0], x, y) / area;
            double c = 1 - a - b;
            if (a < 0 || b < 0 || c < 0)
                continue;
            float depth = (float)(a * v[0].z + b * v[1].z + c * v[2].z);
            float *nearest = &p->depth[(int64_t)y * p->width + x];
            *nearest = depth > *nearest ? depth : *nearest;
        }
}

static iso_status draw_depths(picture *p, const iso_space_body *body, int32_t count) {
    int64_t size = (int64_t)p->width * p->height;
    ISO_TRY(ISO_ALLOCATE(p->depth, size));
    for (int64_t i = 0; i < size; i++)
        p->depth[i] = -INFINITY;
    for (int32_t b = 0; b < count; b++) {
        const iso_mesh *mesh = body[b].mesh;
        for (int32_t t = 0; t < mesh->triangle_count; t++) {
            iso_vec3 v[3];
            for (int k = 0; k < 3; k++)
                v[k] = project(p, vec3_plus(mesh->position[mesh->origin[3 * t + k]], body[b].by));
            draw_depth(p, v);
        }
    }
    return ISO_OK;
}

/* One place around that isn't nearer will do: surfaces that are seen edge on, and the rims of
 * bodies, have such. */
static bool is_seen(const picture *p, iso_vec3 at) {
    int32_t x = clamped(at.x + 0.5, p->width - 1), y = clamped(at.y + 0.5, p->height - 1);
    double limit = at.z + 1.5 / p->scale;
    for (int32_t j = y - 1; j <= y + 1; j++)
        for (int32_t i = x - 1; i <= x + 1; i++)
            if (i >= 0 && j >= 0 && i < p->width && j < p->height &&
                p->depth[(int64_t)j * p->width + i] <= limit)
                return true;
    return false;
}

/* The bodies' shadow, row by row. */
static void draw_shadow(const picture *p) {
    iso_output_print(p->output, "<path class=\"body\" d=\"");
    for (int32_t y = 0; y < p->height; y += ROW) {
        const float *row = p->depth + (int64_t)y * p->width;
        for (int32_t x = 0, end; x < p->width; x = end + 1) {
            for (end = x; end < p->width && row[end] > -INFINITY;)
                end++;
            if (end > x)
                iso_output_print(p->output, "M%d %dh%dv%dh%dz", x, y, end - x, ROW, x - end);
        }
    }
    iso_output_print(p->output, "\"/>\n");
}

/* ---- contours ---- */

/* Draws lines that leave the points it is led along by TOLERANCE at most: from where it is, all
 * directions between `right` and `left` pass all of those since. */
typedef struct pen {
    const picture *picture;
    bool seen; /* which pieces are drawn */
    bool down, holds;
    iso_vec3 last, held; /* where it is, and the last point that it was led to */
    iso_vec3 left, right;
} pen;

static const char *pixels(char text[32], double value) {
    double scaled = value * 100;
    iso_number_write(text, (double)(int64_t)(scaled < 0 ? scaled - 0.5 : scaled + 0.5) / 100);
    return text;
}

static void move(pen *p, iso_vec3 at, char how) {
    char x[32], y[32];
    iso_output_print(p->picture->output, "%c%s %s", how, pixels(x, at.x), pixels(y, at.y));
    p->down = true;
    p->holds = false;
    p->last = at;
}

static double turn(iso_vec3 a, iso_vec3 b) {
    return a.x * b.y - a.y * b.x;
}

static bool is_on_the_way(const pen *p, iso_vec3 at) {
    iso_vec3 way = vec3_minus(at, p->last), before = vec3_minus(p->held, p->last);
    return turn(p->right, way) >= 0 && turn(way, p->left) >= 0 &&
           vec3_dot(way, before) >= vec3_dot(before, before);
}

static void lead(pen *p, iso_vec3 at) {
    at.z = 0;
    if (p->holds && !is_on_the_way(p, at))
        move(p, p->held, 'L');
    iso_vec3 way = vec3_minus(at, p->last);
    double length = vec3_length(way);
    if (length < TOLERANCE)
        return;
    iso_vec3 aside = vec3_times(vec3(-way.y, way.x, 0), TOLERANCE / length);
    iso_vec3 left = vec3_plus(way, aside), right = vec3_minus(way, aside);
    p->left = p->holds && turn(left, p->left) <= 0 ? p->left : left;
    p->right = p->holds && turn(p->right, right) <= 0 ? p->right : right;
    p->held = at;
    p->holds = true;
}

static void lift(pen *p) {
    if (p->holds)
        move(p, p->held, 'L');
    p->down = false;
}

/* From a to b, in pieces that are seen or not. */
static void draw_line(pen *p, iso_vec3 a, iso_vec3 b) {
    double dx = b.x - a.x, dy = b.y - a.y;
    int32_t count = (int32_t)(sqrt(dx * dx + dy * dy) / STEP) + 1;
    for (int32_t i = 0; i < count; i++) {
        iso_vec3 from = vec3_between(a, b, (double)i / count);
        iso_vec3 to = vec3_between(a, b, (double)(i + 1) / count);
        if (is_seen(p->picture, vec3_between(from, to, 0.5)) != p->seen) {
            lift(p);
            continue;
        }
        if (!p->down)
            move(p, vec3(from.x, from.y, 0), 'M');
        lead(p, to);
    }
}

static void draw_contours(const picture *p, const iso_curves *curves, int32_t level, bool seen) {
    for (int32_t c = curves->level_first[level]; c < curves->level_first[level + 1]; c++) {
        int64_t first = curves->contour_first[c], end = curves->contour_first[c + 1];
        pen line = {.picture = p, .seen = seen};
        for (int64_t i = first; i < end; i++)
            draw_line(&line, project(p, curves->point[i]),
                      project(p, curves->point[i + 1 < end ? i + 1 : first]));
        lift(&line);
    }
}

static void draw_levels(const picture *p, const iso_curves *curves, const iso_levels *levels,
                        bool seen) {
    char colour[8], r[32];
    iso_output_print(p->output, "<g class=\"%s\">\n", seen ? "seen" : "hidden");
    for (int32_t l = 0; l < curves->level_count; l++) {
        iso_contour_colour(colour, l, curves->level_count);
        iso_number_write(r, levels->cut[l]);
        iso_output_print(p->output, "<path data-r=\"%s\" stroke=\"%s\" d=\"", r, colour);
        draw_contours(p, curves, l, seen);
        iso_output_print(p->output, "\"/>\n");
    }
    iso_output_print(p->output, "</g>\n");
}

static void put_text(iso_output *output, const char *text) {
    for (; *text; text++)
        if (*text == '&' || *text == '<' || *text == '>')
            iso_output_print(output, "&#%d;", *text);
        else
            iso_output_write(output, text, 1);
}

static iso_status draw(picture *p, const iso_curves *curves, const iso_levels *levels,
                       const iso_space_view *view) {
    char line[32];
    int32_t foot = *view->caption ? 2 * CAPTION_SIZE : 0;
    iso_output_print(
        p->output,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" "
        "font-family=\"sans-serif\" font-size=\"%d\">\n"
        "<style>path{fill:none;stroke-linejoin:round;stroke-linecap:round}"
        ".body{fill:#f1f3f5}.seen{stroke-width:%s}.hidden{stroke-width:0.6;opacity:0.3}</style>\n"
        "<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n",
        p->width, p->height + foot, CAPTION_SIZE,
        pixels(line, curves->level_count > 60 ? 0.9 : 1.6));
    draw_shadow(p);
    draw_levels(p, curves, levels, false);
    draw_levels(p, curves, levels, true);
    if (foot) {
        iso_output_print(p->output, "<text x=\"%d\" y=\"%d\">", MARGIN,
                         p->height + CAPTION_SIZE / 2);
        put_text(p->output, view->caption);
        iso_output_print(p->output, "</text>\n");
    }
    return iso_output_print(p->output, "</svg>\n");
}

iso_status iso_space_map(iso_output *output, const iso_curves *curves, const iso_levels *levels,
                         const iso_space_body *body, int32_t body_count,
                         const iso_space_view *view) {
    picture p = {.output = output};
    turn_to(&p, view);
    fit(&p, body, body_count);
    iso_status status = draw_depths(&p, body, body_count);
    if (status == ISO_OK)
        status = draw(&p, curves, levels, view);
    iso_release(p.depth);
    return status;
}

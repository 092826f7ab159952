#include "lattice/bulk.h"

#include <isoslice/wall.h>

#include <math.h>

#include "lattice/portion.h"
#include "planar/island.h"

/* Of the volume that beads have at first: what it may be multiplied by to be that of the section.
 * Beyond that they don't suit the island, and a small one gets a dot instead. */
#define SCALE_LEAST 0.6
#define SCALE_MOST 1.6
/* Squares of a bead's width: smaller islands are lost in the rounding of what a printer can do,
 * and up to which a single short bead will do. */
#define AREA_LEAST 0.06
#define AREA_DOT 4
enum { LOOPS = 1000 };      /* one within another, as far as there is room */
#define DOT_LENGTH 0.5      /* of a dot at least, in bead widths */
#define MIDDLE_SHORTEST 0.3 /* of a bead in the middle, in its widths */

typedef struct bulk {
    iso_paths *out;
    const iso_fill_options *fill;
    sheet_bead bead;
    iso_arena *scratch;
    iso_planar_scratch *planar;
    iso_region island, inside, lines;
} bulk;

static double distance(iso_point a, iso_point b) {
    double dx = (double)b.x - a.x, dy = (double)b.y - a.y;
    return sqrt(dx * dx + dy * dy);
}

/* units^3 of the paths from `begin` on. */
static double volume_from(const iso_paths *paths, int32_t begin) {
    double sum = 0;
    for (int32_t p = begin; p < paths->count; p++) {
        const iso_path *path = &paths->path[p];
        const iso_path_vertex *v = paths->vertex + path->first;
        for (int32_t i = 0; i + 1 < path->count + path->closed; i++)
            sum += v[i].area * distance(v[i].at, v[i + 1 == path->count ? 0 : i + 1].at);
    }
    return sum;
}

/* Loops hold what is between their outline and the next bead, which is more than their round sides
 * would leave there: so they count as wide as their section is, and reach a little further out. */
static iso_wall_options walls_of(const bulk *b) {
    const iso_fill_options *fill = b->fill;
    int32_t height = (int32_t)(b->bead.height + 0.5), net = (int32_t)(b->bead.usual + 0.5);
    iso_bead bead = {net, height, fill->area, net};
    return (iso_wall_options){.count = 1,
                              .external = bead,
                              .inner = bead,
                              .arc_tolerance = 50,
                              .thin_least = (int32_t)(b->bead.least + b->bead.corners),
                              .gap_least = height,
                              .like = fill->like};
}

/* Lines within the outline's bead, and beads where they don't fit. */
static iso_status fill_inside(bulk *b, const iso_bead *bead) {
    int32_t inset = bead->spacing / 2;
    iso_offset_options offset = iso_offset_defaults(-inset);
    iso_gap_options gap = iso_gap_defaults(bead, bead->height / 2);
    iso_fill_options fill = *b->fill;
    if (b->inside.count == 0)
        return ISO_OK;
    offset.join = ISO_JOIN_ROUND;
    ISO_TRY(iso_offset(&b->lines, &b->inside, &offset, b->planar));
    gap.like = fill.like;
    gap.shortest = MIDDLE_SHORTEST;
    ISO_TRY(iso_gap_fill_left(b->out, &b->inside, &b->lines, &(iso_gap_reach){inset, 0}, &gap,
                              b->planar));
    fill.pattern = ISO_PATTERN_RECTILINEAR;
    fill.density = 1;
    fill.spacing = bead->spacing;
    fill.fit = 1;
    fill.margin = inset;
    fill.link_max = 5 * bead->spacing;
    fill.anchor = 0;
    fill.angle += 45;
    fill.shortest = 0;
    return iso_fill(b->out, &b->lines, &fill, b->scratch, b->planar);
}

/* Middle, and the longer axis of the ellipse with the same moments. */
typedef struct ellipse {
    double x, y, along[2], length, width; /* full axes */
} ellipse;

static ellipse ellipse_of(const iso_region *island) {
    double area = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
    iso_point o = island->point[0];
    for (int32_t m = 0; m < island->count; m++)
        for (int32_t i = island->first[m]; i < island->first[m + 1]; i++) {
            int32_t next = i + 1 < island->first[m + 1] ? i + 1 : island->first[m];
            double ax = (double)island->point[i].x - o.x, ay = (double)island->point[i].y - o.y;
            double bx = (double)island->point[next].x - o.x;
            double by = (double)island->point[next].y - o.y, turn = ax * by - ay * bx;
            area += turn / 2;
            x += turn * (ax + bx) / 6;
            y += turn * (ay + by) / 6;
            xx += turn * (ax * ax + ax * bx + bx * bx) / 12;
            yy += turn * (ay * ay + ay * by + by * by) / 12;
            xy += turn * (ax * ay + bx * by + (ax * by + bx * ay) / 2) / 12;
        }
    x /= area;
    y /= area;
    xx = xx / area - x * x;
    yy = yy / area - y * y;
    xy = xy / area - x * y;
    double mean = (xx + yy) / 2, half = (xx - yy) / 2, root = sqrt(half * half + xy * xy);
    double u = half + root, v = xy; /* eigenvector of the greater moment */
    if (half < 0) {
        u = xy;
        v = root - half;
    }
    double norm = sqrt(u * u + v * v), low = mean > root ? mean - root : 0;
    ellipse e = {o.x + x, o.y + y, {1, 0}, 4 * sqrt(mean + root), 4 * sqrt(low)};
    if (norm > 0) {
        e.along[0] = u / norm;
        e.along[1] = v / norm;
    }
    return e;
}

/* One short bead that holds the island. */
static iso_status draw_dot(const bulk *b, double area) {
    ellipse e = ellipse_of(&b->island);
    double least = DOT_LENGTH * b->bead.usual, length = e.length - e.width;
    length = length > least ? length : least;
    double dx = e.along[0] * length / 2, dy = e.along[1] * length / 2;
    iso_point end[2] = {{(int32_t)floor(e.x - dx + 0.5), (int32_t)floor(e.y - dy + 0.5)},
                        {(int32_t)floor(e.x + dx + 0.5), (int32_t)floor(e.y + dy + 0.5)}};
    iso_path like = b->fill->like;
    like.closed = 0;
    double drawn = distance(end[0], end[1]), section = area * b->bead.height / drawn;
    double width = section / b->bead.height + b->bead.corners;
    return iso_paths_add(b->out, &like, end, 2, (int32_t)(width + 0.5), (int32_t)(section + 0.5));
}

static void forget_from(iso_paths *paths, int32_t begin) {
    if (begin == paths->count)
        return;
    paths->vertex_count = paths->path[begin].first;
    paths->count = begin;
}

/* As the fill asks for, and of the volume that is wanted. */
static void settle(bulk *b, int32_t begin, double scale) {
    iso_paths *out = b->out;
    for (int32_t p = begin; p < out->count; p++) {
        iso_path *path = &out->path[p];
        path->role = b->fill->like.role;
        path->rank = b->fill->like.rank;
        path->speed_class = b->fill->like.speed_class;
        for (int32_t i = path->first; i < path->first + path->count; i++) {
            iso_path_vertex *v = &out->vertex[i];
            double area = v->area * scale;
            v->role = path->role;
            v->width = (int32_t)(area / b->bead.height + b->bead.corners + 0.5);
            v->area = (int32_t)(area + 0.5);
        }
    }
}

static iso_status draw_island(bulk *b, const iso_region *section, const iso_islands *islands,
                              int32_t i) {
    int32_t begin = b->out->count;
    double square = b->bead.usual * b->bead.usual;
    ISO_TRY(island_copy(&b->island, section, islands, i));
    double area = (double)iso_region_double_area(&b->island) / 2;
    if (area < AREA_LEAST * square)
        return ISO_OK;
    iso_wall_options wall = walls_of(b);
    if (area > 0.5 * square) { /* else no bead runs in it */
        ISO_TRY(iso_walls(b->out, &b->inside, &b->island, &wall, b->planar));
        ISO_TRY(fill_inside(b, &wall.inner));
    }
    double scale = area * b->bead.height / (volume_from(b->out, begin) + 1);
    int suits = scale >= SCALE_LEAST && scale <= SCALE_MOST;
    if (!suits && (area < AREA_DOT * square || b->out->count == begin)) {
        forget_from(b->out, begin);
        return draw_dot(b, area);
    }
    scale = scale < SCALE_LEAST ? SCALE_LEAST : scale < SCALE_MOST ? scale : SCALE_MOST;
    settle(b, begin, scale);
    return portion_out(b->out, begin, &b->island, &b->bead, b->scratch);
}

iso_status bulk_draw(iso_paths *out, const iso_region *section, const iso_fill_options *fill,
                     iso_arena *scratch, iso_planar_scratch *planar) {
    bulk b = {out, fill, sheet_bead_of(fill), scratch, planar, {0}, {0}, {0}};
    iso_islands islands;
    if (section->count == 0)
        return ISO_OK;
    iso_status status = islands_of(&islands, section, scratch);
    for (int32_t i = 0; status == ISO_OK && i < islands.count; i++)
        status = draw_island(&b, section, &islands, i);
    iso_region_free(&b.island);
    iso_region_free(&b.inside);
    iso_region_free(&b.lines);
    return status;
}

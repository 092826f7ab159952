#include <isoslice/wall.h>

#include <math.h>

#include "base/memory.h"
#include "planar/region.h"
#include "planar/scratch.h"
#include "wall/gap.h"
#include "wall/medial.h"
#include "wall/reach.h"

/* A bead keeps its width while the place's is within this share of it, and its direction while the
 * middle is within so many units. */
#define WIDTH_STEP 0.06
enum { DEVIATION = 40, RUN_MAX = 128 };

/* Of a bead seen from above, units^2: 0.02 mm^2 are not worth the travel. */
#define LEAST_AREA 2e6

/* How far from a blunt end a bead ends, in widths: half of one, and its round end would touch;
 * none, and it would hold the place's volume. */
#define END_SHARE 0.25

typedef struct iso_gapping {
    iso_paths *paths;
    const iso_gap_options *options;
    iso_medial medial;
} iso_gapping;

/* What of the place's width the bead has to fill. */
static double room_at(const iso_gapping *g, const iso_medial_point *p) {
    double room = 2 * p->half - g->options->border;
    return room > g->options->most ? g->options->most : room;
}

static double length_between(const iso_medial_point *a, const iso_medial_point *b) {
    double dx = b->x - a->x, dy = b->y - a->y;
    return sqrt(dx * dx + dy * dy);
}

static bool is_near(const iso_medial_point *p, const iso_medial_point *a,
                    const iso_medial_point *b) {
    double dx = b->x - a->x, dy = b->y - a->y, length = length_between(a, b);
    double off = dx * (p->y - a->y) - dy * (p->x - a->x);
    return fabs(off) <= DEVIATION * length;
}

/* The last point up to which one bead will do from point i on. */
static int32_t run_end(const iso_gapping *g, const iso_medial_point *point, int32_t count,
                       int32_t i) {
    double least = room_at(g, &point[i]), most = least;
    int32_t end = i + 1;
    for (int32_t j = i + 1; j < count && j - i <= RUN_MAX; j++) {
        double room = room_at(g, &point[j]);
        least = room < least ? room : least;
        most = room > most ? room : most;
        bool fits = most - least <= 2 * WIDTH_STEP * least;
        for (int32_t k = i + 1; k < j && fits; k++)
            fits = is_near(&point[k], &point[i], &point[j]);
        if (!fits)
            break;
        end = j;
    }
    return end;
}

/* The mean of what there is to fill between two points. */
static double mean_room(const iso_gapping *g, const iso_medial_point *point, int32_t from,
                        int32_t to) {
    double sum = 0, length = 0;
    for (int32_t k = from; k < to; k++) {
        double step = length_between(&point[k], &point[k + 1]);
        sum += step * (room_at(g, &point[k]) + room_at(g, &point[k + 1])) / 2;
        length += step;
    }
    return length > 0 ? sum / length : room_at(g, &point[from]);
}

static iso_path_vertex vertex_of(const iso_gapping *g, const iso_medial_point *p, double room) {
    int32_t height = g->options->height;
    iso_path_vertex v = {.at = {(int32_t)floor(p->x + 0.5), (int32_t)floor(p->y + 0.5)},
                         .role = g->options->like.role};
    if (g->options->outline) {
        iso_bead bead = iso_bead_of((int32_t)(room + 0.5), height);
        v.width = bead.width;
        v.area = bead.area;
    } else {
        double sides = iso_bead_of(2 * height, height).spacing;
        v.width = (int32_t)(room + 2 * height - sides + 0.5);
        v.area = (int32_t)(room * height + 0.5);
    }
    return v;
}

static iso_status put(iso_paths *paths, const iso_path_vertex *vertex) {
    ISO_TRY(ISO_GROW(paths->vertex, paths->vertex_capacity, (int64_t)paths->vertex_count + 1));
    paths->vertex[paths->vertex_count++] = *vertex;
    return ISO_OK;
}

/* Move an end on towards where the place ends. */
static void extend(const iso_gapping *g, iso_medial_point *point, int32_t count, int32_t end) {
    int32_t step = end == 0 ? 1 : -1, back = end;
    while (back + step >= 0 && back + step < count &&
           length_between(&point[end], &point[back]) < point[end].half)
        back += step;
    double length = length_between(&point[end], &point[back]);
    double reach = room_at(g, &point[end]) * (0.5 - END_SHARE);
    if (length < 1)
        return;
    point[end].x += (point[end].x - point[back].x) / length * reach;
    point[end].y += (point[end].y - point[back].y) / length * reach;
}

/* A place as long as it is wide: a bead of half its width, lying along x. */
static iso_status put_dot(iso_gapping *g, const iso_medial_point *middle) {
    double room = room_at(g, middle), reach = room * (0.5 - END_SHARE);
    iso_medial_point end[2] = {*middle, *middle};
    end[0].x -= reach;
    end[1].x += reach;
    for (int k = 0; k < 2; k++) {
        iso_path_vertex v = vertex_of(g, &end[k], room);
        ISO_TRY(put(g->paths, &v));
    }
    return ISO_OK;
}

static iso_status put_line(iso_gapping *g, const iso_medial_line *line) {
    iso_medial_point *point = g->medial.point + line->first;
    double room = room_at(g, point);
    int32_t i = 0;
    if (line->count == 1)
        return put_dot(g, point);
    if (!line->closed && line->blunt[0])
        extend(g, point, line->count, 0);
    if (!line->closed && line->blunt[1])
        extend(g, point, line->count, line->count - 1);
    while (i + 1 < line->count) {
        int32_t end = run_end(g, point, line->count, i);
        room = mean_room(g, point, i, end);
        iso_path_vertex v = vertex_of(g, &point[i], room);
        ISO_TRY(put(g->paths, &v));
        i = end;
    }
    iso_path_vertex last = vertex_of(g, &point[i], room);
    return put(g->paths, &last);
}

/* Is there enough of the line to print it? */
static bool is_worth(const iso_gapping *g, const iso_medial_line *line) {
    const iso_medial_point *point = g->medial.point + line->first;
    double length = 0, area = 0;
    for (int32_t k = 0; k + 1 < line->count; k++) {
        double step = length_between(&point[k], &point[k + 1]);
        length += step;
        area += step * (room_at(g, &point[k]) + room_at(g, &point[k + 1])) / 2;
    }
    if (g->options->outline && line->count == 1)
        return line->blunt[1];
    double ends = (line->blunt[0] + line->blunt[1]) * room_at(g, point) * (0.5 - END_SHARE);
    return area >= LEAST_AREA && (length + ends) * (length + ends) >= g->options->shortest * area;
}

static iso_status draw(iso_gapping *g) {
    for (int32_t i = 0; i < g->medial.count; i++) {
        const iso_medial_line *line = &g->medial.line[i];
        iso_path path = g->options->like;
        if (!is_worth(g, line))
            continue;
        path.first = g->paths->vertex_count;
        path.closed = line->closed;
        ISO_TRY(put_line(g, line));
        path.count = g->paths->vertex_count - path.first;
        ISO_TRY(ISO_GROW(g->paths->path, g->paths->path_capacity, (int64_t)g->paths->count + 1));
        g->paths->path[g->paths->count++] = path;
    }
    return ISO_OK;
}

iso_status iso_gap_fill(iso_paths *paths, const iso_region *gap, const iso_gap_options *options,
                        iso_planar_scratch *scratch) {
    iso_gapping g = {.paths = paths, .options = options};
    double least = (options->least + (double)options->border) / 2;
    int32_t count = paths->count, vertices = paths->vertex_count;
    iso_arena_mark mark = iso_arena_get_mark(&scratch->arena);
    iso_status status = medial_axis(&g.medial, gap, options->step, least, scratch);
    if (status == ISO_OK)
        status = draw(&g);
    iso_arena_pop(&scratch->arena, mark);
    if (status != ISO_OK) {
        paths->count = count;
        paths->vertex_count = vertices;
    }
    return status;
}

/* ---- what is left over ---- */

/* Rounding and the arcs' corners may leave a seam of this many units between what was shrunk and
 * grown again. */
enum { SEAM = 20 };

iso_status iso_gap_left(iso_region *left, const iso_region *region, const iso_region *reached,
                        int32_t radius, iso_planar_scratch *scratch) {
    iso_region grown = {0};
    iso_offset_options grow = iso_offset_defaults(radius + SEAM);
    grow.join = ISO_JOIN_ROUND;
    iso_status status = iso_offset(&grown, reached, &grow, scratch);
    if (status == ISO_OK)
        status = iso_boolean(left, ISO_DIFFERENCE, region, &grown, scratch);
    iso_region_free(&grown);
    return status;
}

void gap_drop_small(iso_region *region, double width) {
    int32_t count = 0, points = 0;
    for (int32_t c = 0; c < region->count; c++) {
        const iso_point *point = region->point + region->first[c];
        int32_t size = region->first[c + 1] - region->first[c];
        double area = (double)contour_double_area(point, size) / 2;
        if (area >= 0 && area < 0.785 * width * width)
            continue;
        memmove(region->point + points, point, (size_t)size * sizeof *point);
        points += size;
        region->parent[count++] = -1;
        region->first[count] = points;
    }
    region->count = count;
}

iso_gap_options iso_gap_defaults(const iso_bead *bead, int32_t least) {
    return (iso_gap_options){.height = bead->height,
                             .least = least,
                             .most = 2 * bead->spacing,
                             .step = 900,
                             .shortest = 1.5,
                             .like = {.role = ISO_ROLE_GAP_FILL}};
}

static iso_status fill_left(iso_paths *paths, iso_region *room, const iso_region *region,
                            const iso_region *reached, const iso_gap_reach *reach,
                            const iso_gap_options *options, iso_planar_scratch *scratch) {
    iso_region *inner = &room[0], *left = &room[1];
    iso_offset_options taken = iso_offset_defaults(-reach->taken);
    taken.join = ISO_JOIN_ROUND;
    if (reach->taken != 0)
        ISO_TRY(iso_offset(inner, region, &taken, scratch));
    ISO_TRY(iso_gap_left(left, reach->taken != 0 ? inner : region, reached,
                         reach->distance - reach->taken, scratch));
    gap_drop_small(left, options->least);
    return iso_gap_fill(paths, left, options, scratch);
}

iso_status iso_gap_fill_left(iso_paths *paths, const iso_region *region, const iso_region *reached,
                             const iso_gap_reach *reach, const iso_gap_options *options,
                             iso_planar_scratch *scratch) {
    iso_region room[2] = {0};
    bool missed;
    double shortest = options->shortest * options->least;
    ISO_TRY(reach_misses(&missed, region, reached, reach->distance, shortest, &scratch->arena));
    if (!missed)
        return ISO_OK;
    iso_status status = fill_left(paths, room, region, reached, reach, options, scratch);
    iso_region_free(&room[0]);
    iso_region_free(&room[1]);
    return status;
}

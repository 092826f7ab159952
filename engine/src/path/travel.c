#include "path/travel.h"

#include <math.h>

#include "path/ways.h"

/* Edges of walls are owned by -1, those of a top surface by the path they are of: so what is
 * already printed before path k are the owners 0 .. k - 1. */
enum { WALL = -1 };

/* Steps of a search for a way that nobody has asked for: enough for a few corners. */
enum { SHORT_SEARCH = 10000 };

typedef struct planning {
    iso_paths *paths;
    const iso_order_options *options;
    iso_arena *scratch;
    iso_edge_grid grid;
    iso_ways ways;
    double *squared; /* of speeds along a way */
    int built;
} planning;

static int is_boundary(const iso_path *path) {
    return path->role == ISO_ROLE_EXTERNAL_PERIMETER && path->closed && path->count > 2;
}

static int is_top(const iso_path *path) {
    return path->role == ISO_ROLE_TOP_SOLID_INFILL || path->role == ISO_ROLE_IRONING;
}

static iso_point vertex_at(const planning *p, const iso_path *path, int32_t i) {
    return p->paths->vertex[path->first + (i < path->count ? i : 0)].at;
}

static iso_status list_edges(planning *p) {
    int64_t n = 0, bends = 0;
    iso_path_edge *edge;
    for (int32_t k = 0; k < p->paths->count; k++) {
        const iso_path *path = &p->paths->path[k];
        bends += is_boundary(path) ? path->count : 0;
        n += is_boundary(path) || is_top(path) ? path->count : 0;
    }
    ISO_TRY(ISO_PUSH(edge, p->scratch, n));
    ISO_TRY(iso_ways_new(&p->ways, &p->grid, (int32_t)bends, p->scratch));
    ISO_TRY(ISO_PUSH(p->squared, p->scratch, bends + 2));
    p->ways.begin = WALL;
    p->ways.end = WALL + 1;
    if (!p->options->avoid_crossing)
        p->ways.patience = SHORT_SEARCH;
    n = 0;
    for (int32_t k = 0; k < p->paths->count; k++) {
        const iso_path *path = &p->paths->path[k];
        int32_t segments = path->closed ? path->count : path->count - 1;
        if (!is_boundary(path) && !is_top(path))
            continue;
        for (int32_t i = 0; i < segments; i++)
            edge[n++] = (iso_path_edge){vertex_at(p, path, i), vertex_at(p, path, i + 1),
                                        is_top(path) ? k : WALL};
        for (int32_t i = 0; i < segments && is_boundary(path); i++)
            iso_ways_add(&p->ways, vertex_at(p, path, i > 0 ? i - 1 : segments - 1),
                         vertex_at(p, path, i), vertex_at(p, path, i + 1));
    }
    return iso_edge_grid_build(&p->grid, edge, (int32_t)n, p->scratch);
}

/* Only layers that travel far enough need it. */
static iso_status build(planning *p) {
    if (p->built)
        return ISO_OK;
    p->built = 1;
    return list_edges(p);
}

static int spoils_top(const planning *p, iso_point a, iso_point b, int32_t k) {
    return iso_edge_grid_meets(&p->grid, a, b, 0, k);
}

static double distance(iso_point a, iso_point b) {
    return sqrt((double)iso_distance_squared(a, b));
}

/* Of a run of so many seconds. */
static double length_of_run(const iso_travel_cost *cost, double seconds) {
    double ramps = cost->speed / cost->acceleration;
    return seconds < 2 * ramps ? cost->acceleration * seconds * seconds / 4
                               : (seconds - ramps) * cost->speed;
}

/* As far as the options allow to go around, or else as far as pays: a retraction takes time, too.
 */
static double longest_way(const iso_order_options *options, iso_point from, iso_point to) {
    double straight = distance(from, to);
    if (!options->avoid_crossing)
        return length_of_run(&options->cost, iso_travel_seconds(&options->cost, from, to));
    if (options->max_detour > 0)
        return straight + options->max_detour;
    if (options->max_detour_share > 0)
        return straight * (1 + options->max_detour_share);
    return INFINITY;
}

/* Points of the way that was found last, its ends included. */
static iso_point way_at(const planning *p, int32_t i, iso_point from, iso_point to) {
    return i == 0 ? from : i <= p->ways.points ? p->ways.point[i - 1] : to;
}

/* Square of the speed at which the arc that stays so near to the bend can be taken, units^2/s^2; as
 * firmware has it. */
static double bend_squared(const iso_travel_cost *cost, iso_point a, iso_point b, iso_point c) {
    double x = (double)b.x - a.x, y = (double)b.y - a.y, most = cost->speed * cost->speed;
    double u = (double)c.x - b.x, v = (double)c.y - b.y;
    double lengths = sqrt(x * x + y * y) * sqrt(u * u + v * v);
    double cosine = lengths > 0 ? (x * u + y * v) / lengths : 1;
    double sine = cosine > -1 ? sqrt(0.5 * (1 + cosine)) : 0; /* of half the angle inside */
    double reached = cost->acceleration * cost->junction_deviation * sine;
    return reached >= most * (1 - sine) ? most : reached / (1 - sine);
}

/* Seconds for a piece of `length` units entered and left at the given speeds. */
static double seconds_of_piece(const iso_travel_cost *cost, double length, double in, double out) {
    double a = cost->acceleration, v = cost->speed;
    double peak = (2 * a * length + in * in + out * out) / 2;
    if (peak <= v * v)
        return (2 * sqrt(peak) - in - out) / a;
    return ((v - in) * (v - in) + (v - out) * (v - out) + 2 * a * length) / (2 * a * v);
}

/* Bends are taken as fast as they and the way to brake before the next one allow. */
static double seconds_of_way(const planning *p, iso_point from, iso_point to) {
    const iso_travel_cost *cost = &p->options->cost;
    int32_t last = p->ways.points + 1;
    double *squared = p->squared, sum = 0;
    squared[0] = squared[last] = 0;
    for (int32_t i = 1; i < last; i++)
        squared[i] = bend_squared(cost, way_at(p, i - 1, from, to), way_at(p, i, from, to),
                                  way_at(p, i + 1, from, to));
    for (int32_t i = last; i-- > 1;) {
        double length = distance(way_at(p, i, from, to), way_at(p, i + 1, from, to));
        squared[i] = fmin(squared[i], squared[i + 1] + 2 * cost->acceleration * length);
    }
    for (int32_t i = 0; i < last; i++) {
        double length = distance(way_at(p, i, from, to), way_at(p, i + 1, from, to));
        squared[i + 1] = fmin(squared[i + 1], squared[i] + 2 * cost->acceleration * length);
        sum += seconds_of_piece(cost, length, sqrt(squared[i]), sqrt(squared[i + 1]));
    }
    return sum;
}

static int way_is_hidden(const planning *p, iso_point from, iso_point to, int32_t k) {
    for (int32_t i = 0; i < p->ways.points; i++) {
        if (spoils_top(p, from, p->ways.point[i], k))
            return 0;
        from = p->ways.point[i];
    }
    return !spoils_top(p, from, to, k);
}

/* The straight way is not inside: take one that is. */
static iso_status go_around(planning *p, int32_t k, iso_point from, iso_point to, int *hidden) {
    iso_paths *paths = p->paths;
    iso_path *path = &paths->path[k];
    if (!iso_ways_find(&p->ways, from, to, longest_way(p->options, from, to)))
        return ISO_OK;
    *hidden = way_is_hidden(p, from, to, k);
    if (!p->options->avoid_crossing &&
        (!*hidden ||
         seconds_of_way(p, from, to) > iso_travel_seconds(&p->options->cost, from, to))) {
        *hidden = 0;
        return ISO_OK;
    }
    int32_t n = p->ways.points;
    ISO_TRY(ISO_GROW(paths->travel, paths->travel_capacity, (int64_t)paths->travel_count + n));
    path->travel_first = paths->travel_count;
    path->travel_count = n;
    for (int32_t i = 0; i < n; i++)
        paths->travel[paths->travel_count++] = p->ways.point[i];
    return ISO_OK;
}

/* Groups are islands, with nothing between them; what the layer below ended with may be anywhere.
 */
static int is_elsewhere(const iso_path *path, const iso_path *last) {
    return last && (last->group != path->group || last->object != path->object);
}

static iso_status plan(planning *p, int32_t k, iso_point from, const iso_path *last) {
    iso_path *path = &p->paths->path[k];
    iso_point to = vertex_at(p, path, 0);
    double limit = p->options->cost.retract_before;
    int hidden = 0;
    if ((double)iso_distance_squared(from, to) <= limit * limit || is_elsewhere(path, last))
        return ISO_OK;
    ISO_TRY(build(p));
    if (iso_ways_is_inside(&p->ways, from, to))
        hidden = !spoils_top(p, from, to, k);
    else
        ISO_TRY(go_around(p, k, from, to, &hidden));
    path->retract =
        hidden && p->options->retract_crossing_only ? ISO_RETRACT_NOT : ISO_RETRACT_IF_LONG;
    return ISO_OK;
}

iso_status iso_travel_plan(iso_paths *paths, iso_point from, const iso_order_options *options,
                           iso_arena *scratch) {
    planning p = {.paths = paths, .options = options, .scratch = scratch};
    iso_arena_mark mark = iso_arena_get_mark(scratch);
    iso_status status = ISO_OK;
    const iso_path *last = NULL;
    if (!options->retract_crossing_only && !options->avoid_crossing)
        return ISO_OK;
    for (int32_t k = 0; k < paths->count && status == ISO_OK; k++) {
        const iso_path *path = &paths->path[k];
        if (path->count < 2)
            continue; /* nothing is drawn, so the nozzle doesn't go there */
        status = plan(&p, k, from, last);
        last = path;
        from = vertex_at(&p, path, path->closed ? 0 : path->count - 1);
    }
    iso_arena_pop(scratch, mark);
    return status;
}

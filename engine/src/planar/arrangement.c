#include "planar/arrangement.h"

#include "base/sort.h"
#include "planar/face.h"
#include "planar/predicate.h"

/* A place where chains may end: a slot that starts at a shared vertex, or a lonely contour's start.
 */
typedef struct iso_stop {
    iso_point at;
    int32_t slot;
} iso_stop;

static bool stop_less(const iso_stop *a, const iso_stop *b) {
    return point_equal(a->at, b->at) ? a->slot < b->slot : point_less(a->at, b->at);
}
ISO_SORT(sort_stops, iso_stop, stop_less)

/* Contours without a shared vertex stop once, at their lexicographic least point. */
static int32_t mark_lonely_contours(iso_edges *edges) {
    int32_t lonely = 0;
    for (int32_t s = 0; s < edges->count; s++) {
        if (edges->flags[s] & (EDGE_DEAD | EDGE_VISITED))
            continue;
        int32_t least = s, at = s;
        bool shared = false;
        do {
            edges->flags[at] |= EDGE_VISITED;
            shared |= (edges->flags[at] & EDGE_SHARED_START) != 0;
            if (point_less(edges->from[at], edges->from[least]))
                least = at;
            at = edges_next(edges, at);
        } while (at != s);
        if (!shared) {
            edges->flags[least] |= EDGE_SHARED_START;
            lonely++;
        }
    }
    return lonely;
}

static iso_status collect_stops(iso_stop **out, int32_t *count, const iso_edges *edges,
                                iso_arena *arena) {
    int32_t n = 0;
    for (int32_t s = 0; s < edges->count; s++)
        n += (edges->flags[s] & (EDGE_DEAD | EDGE_SHARED_START)) == EDGE_SHARED_START;
    iso_stop *stop;
    ISO_TRY(ISO_PUSH(stop, arena, n));
    *out = stop;
    *count = n;
    for (int32_t s = 0; s < edges->count; s++)
        if ((edges->flags[s] & (EDGE_DEAD | EDGE_SHARED_START)) == EDGE_SHARED_START)
            *stop++ = (iso_stop){edges->from[s], s};
    sort_stops(*out, n);
    return ISO_OK;
}

/* One chain a stop: follow the contour to the next one. */
static int32_t trace_chain(iso_arrangement *a, int32_t c, const iso_edges *edges, int32_t slot) {
    int32_t n = a->chain_first[c], lowest = n;
    a->multiplicity[c] = (iso_winding){{0}};
    a->multiplicity[c].of[(edges->flags[slot] & EDGE_OPERAND) >> EDGE_OPERAND_SHIFT] = 1;
    a->point[n++] = edges->from[slot];
    int32_t at = slot;
    do {
        a->point[n] = edges->to[at];
        if (point_less(a->point[n], a->point[lowest]))
            lowest = n;
        n++;
        at = edges_next(edges, at);
    } while (!(edges->flags[at] & EDGE_SHARED_START));
    a->lowest[c] = lowest;
    a->chain_first[c + 1] = n;
    return at;
}

static iso_status trace_chains(iso_arrangement *a, iso_edges *edges, iso_arena *arena) {
    mark_lonely_contours(edges);
    iso_stop *stop;
    int32_t count, living = 0;
    ISO_TRY(collect_stops(&stop, &count, edges, arena));
    for (int32_t s = 0; s < edges->count; s++)
        living += !(edges->flags[s] & EDGE_DEAD);
    a->chain_count = count;
    ISO_TRY(ISO_PUSH(a->chain_first, arena, count + 1));
    ISO_TRY(ISO_PUSH(a->point, arena, (int64_t)living + count));
    ISO_TRY(ISO_PUSH(a->multiplicity, arena, count));
    ISO_TRY(ISO_PUSH(a->lowest, arena, count));
    ISO_TRY(ISO_PUSH(a->junction, arena, count));
    ISO_TRY(ISO_PUSH(a->origin, arena, 2 * count));
    int32_t *junction_of;
    ISO_TRY(ISO_PUSH(junction_of, arena, edges->count));
    a->junction_count = 0;
    for (int32_t i = 0; i < count; i++) {
        if (i == 0 || !point_equal(stop[i].at, stop[i - 1].at))
            a->junction[a->junction_count++] = stop[i].at;
        junction_of[stop[i].slot] = a->junction_count - 1;
    }
    a->chain_first[0] = 0;
    for (int32_t c = 0; c < count; c++) {
        int32_t end = trace_chain(a, c, edges, stop[c].slot);
        a->origin[2 * c] = junction_of[stop[c].slot];
        a->origin[2 * c + 1] = junction_of[end];
    }
    return ISO_OK;
}

/* Darts are sorted with their directions at hand. */
typedef struct iso_ray {
    int64_t x, y;
    int32_t dart;
} iso_ray;

static bool ray_less(const iso_ray *a, const iso_ray *b) {
    if (direction_less(a->x, a->y, b->x, b->y))
        return true;
    return !direction_less(b->x, b->y, a->x, a->y) && a->dart < b->dart;
}
ISO_SORT(sort_rays, iso_ray, ray_less)

static bool is_dead(iso_winding multiplicity) {
    int32_t any = 0;
    for (int k = 0; k < OPERANDS_MAX; k++)
        any |= multiplicity.of[k];
    return any == 0;
}

/* Darts of one direction from one junction are the same single edge (else the farther would have
 * been bent through the end of the nearer): the first one takes over what the others weigh. */
static void merge_coincident(iso_arrangement *a, const iso_ray *ray, int32_t count) {
    for (int32_t i = 0, end; i < count; i = end) {
        for (end = i + 1; end < count && !ray_less(&(iso_ray){ray[i].x, ray[i].y, INT32_MAX},
                                                   &(iso_ray){ray[end].x, ray[end].y, -1});)
            end++;
        iso_winding *sum = &a->multiplicity[ray[i].dart >> 1];
        for (int32_t k = i + 1; k < end; k++) {
            iso_winding *other = &a->multiplicity[ray[k].dart >> 1];
            int sign = (ray[k].dart ^ ray[i].dart) & 1 ? -1 : 1;
            for (int o = 0; o < OPERANDS_MAX; o++)
                sum->of[o] += sign * other->of[o];
            *other = (iso_winding){{0}};
        }
    }
}

/* Sort the darts around each junction and merge what coincides. A chain merged away at its first
 * end is dead at its second. */
static iso_status sort_around(iso_arrangement *a, iso_arena *arena) {
    int32_t darts = 2 * a->chain_count;
    iso_ray *ray;
    ISO_TRY(ISO_PUSH(a->around_first, arena, a->junction_count + 1));
    ISO_TRY(ISO_PUSH(a->around, arena, darts));
    memset(a->around_first, 0, (size_t)(a->junction_count + 1) * sizeof *a->around_first);
    int32_t most = 0;
    for (int32_t d = 0; d < darts; d++) {
        int32_t n = ++a->around_first[a->origin[d]];
        most = n > most ? n : most;
    }
    for (int32_t j = 0, sum = 0; j <= a->junction_count; j++)
        a->around_first[j] = sum += a->around_first[j];
    for (int32_t d = darts; d-- > 0;)
        a->around[--a->around_first[a->origin[d]]] = d;
    ISO_TRY(ISO_PUSH(ray, arena, most));
    for (int32_t j = 0; j < a->junction_count; j++) {
        int32_t n = 0, first = a->around_first[j];
        for (int32_t i = first; i < a->around_first[j + 1]; i++) {
            int32_t d = a->around[i];
            if (is_dead(a->multiplicity[d >> 1]))
                continue;
            iso_point from = dart_start(a, d), to = dart_second(a, d);
            ray[n++] = (iso_ray){(int64_t)to.x - from.x, (int64_t)to.y - from.y, d};
        }
        sort_rays(ray, n);
        merge_coincident(a, ray, n);
        for (int32_t i = 0; i < n; i++)
            a->around[first + i] = ray[i].dart;
        for (int32_t i = first + n; i < a->around_first[j + 1]; i++)
            a->around[i] = -1;
    }
    return ISO_OK;
}

/* Close up `around` over the living darts and set beta and its inverse. */
static iso_status link_around(iso_arrangement *a, iso_arena *arena) {
    int32_t darts = 2 * a->chain_count, n = 0;
    ISO_TRY(ISO_PUSH(a->ccw, arena, darts));
    ISO_TRY(ISO_PUSH(a->cw, arena, darts));
    for (int32_t j = 0; j < a->junction_count; j++) {
        int32_t from = a->around_first[j], end = a->around_first[j + 1], first = n;
        for (int32_t i = from; i < end; i++)
            if (a->around[i] >= 0 && !is_dead(a->multiplicity[a->around[i] >> 1]))
                a->around[n++] = a->around[i];
        a->around_first[j] = first;
        for (int32_t i = first; i < n; i++) {
            int32_t d = a->around[i], next = a->around[i + 1 < n ? i + 1 : first];
            a->ccw[d] = next;
            a->cw[next] = d;
        }
    }
    a->around_first[a->junction_count] = n;
    for (int32_t d = 0; d < darts; d++)
        if (is_dead(a->multiplicity[d >> 1]))
            a->origin[d] = a->ccw[d] = a->cw[d] = -1;
    return ISO_OK;
}

iso_status arrange(iso_arrangement *a, iso_edges *edges, int64_t *collisions, iso_snap_room *room,
                   iso_arena *arena) {
    *a = (iso_arrangement){0};
    ISO_TRY(snap_round(edges, collisions, room, arena));
    ISO_TRY(trace_chains(a, edges, arena));
    ISO_TRY(sort_around(a, arena));
    ISO_TRY(link_around(a, arena));
    return arrangement_find_faces(a, arena);
}

iso_status arrangement_validate(const iso_arrangement *a) {
    for (int32_t d = 0; d < 2 * a->chain_count; d++) {
        if (a->origin[d] < 0)
            continue;
        int32_t alpha = dart_alpha(a, d), beta = a->ccw[d];
        if (beta < 0 || a->cw[beta] != d)
            return iso_fail(ISO_BUG, "arrangement: beta is no bijection at dart %d", (int)d);
        int32_t once = dart_alpha(a, beta); /* alpha beta */
        if (dart_alpha(a, a->ccw[once]) != d)
            return iso_fail(ISO_BUG, "arrangement: alpha beta alpha beta = 1 fails at dart %d",
                            (int)d);
        if (a->face[alpha] != a->face[d])
            return iso_fail(ISO_BUG, "arrangement: f alpha = f fails at dart %d", (int)d);
        if (a->origin[beta] != a->origin[d])
            return iso_fail(ISO_BUG, "arrangement: v beta = v fails at dart %d", (int)d);
        if (!point_equal(dart_start(a, d), a->junction[a->origin[d]]))
            return iso_fail(ISO_BUG, "arrangement: g beta = g fails at dart %d", (int)d);
        iso_winding left = a->winding[a->face[d]], right = a->winding[a->face[d ^ 1]];
        int sign = d & 1 ? -1 : 1;
        for (int k = 0; k < OPERANDS_MAX; k++)
            if (left.of[k] - right.of[k] != sign * a->multiplicity[d >> 1].of[k])
                return iso_fail(ISO_BUG, "arrangement: winding jumps wrongly across dart %d",
                                (int)d);
    }
    return ISO_OK;
}

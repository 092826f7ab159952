#include "reachable.h"

#include <math.h>
#include <string.h>

#include "base/vector.h"
#include "clearance/reach.h"

enum { PLACES = 32 }; /* of an island, at most, that its box is made of */

typedef struct islands {
    const iso_paths *paths;
    int32_t count;
    int32_t *number; /* [most group + 1] of the island, or -1 */
    int32_t *size;   /* [count] vertices */
    int32_t *first;  /* [count + 1] of its places */
    iso_vec2 *flat;  /* [first[count]] */
    reach_group *box;
} islands;

/* Number the groups in the order of their first paths. */
static iso_status number_islands(islands *s, iso_arena *arena) {
    const iso_paths *paths = s->paths;
    int32_t most = 0;
    for (int32_t i = 0; i < paths->count; i++)
        most = paths->path[i].group > most ? paths->path[i].group : most;
    ISO_TRY(ISO_PUSH(s->number, arena, (int64_t)most + 1));
    ISO_TRY(ISO_PUSH(s->size, arena, (int64_t)paths->count + 1));
    for (int32_t g = 0; g <= most; g++)
        s->number[g] = -1;
    for (int32_t i = 0; i < paths->count; i++) {
        int32_t *number = &s->number[paths->path[i].group];
        if (*number < 0) {
            *number = s->count++;
            s->size[*number] = 0;
        }
        s->size[*number] += paths->path[i].count;
    }
    return ISO_OK;
}

/* Evenly from all vertices of an island. */
static iso_status gather_places(islands *s, iso_arena *arena) {
    int32_t *seen;
    ISO_TRY(ISO_PUSH(seen, arena, s->count));
    ISO_TRY(ISO_PUSH(s->first, arena, (int64_t)s->count + 1));
    s->first[0] = 0;
    for (int32_t i = 0; i < s->count; i++) {
        int32_t stride = (s->size[i] + PLACES - 1) / PLACES;
        seen[i] = 0;
        s->first[i + 1] = s->first[i] + (s->size[i] + stride - 1) / stride;
    }
    ISO_TRY(ISO_PUSH(s->flat, arena, s->first[s->count]));
    for (int32_t p = 0; p < s->paths->count; p++) {
        const iso_path *path = &s->paths->path[p];
        int32_t i = s->number[path->group], stride = (s->size[i] + PLACES - 1) / PLACES;
        for (int32_t v = 0; v < path->count; v++, seen[i]++) {
            iso_point at = s->paths->vertex[path->first + v].at;
            if (seen[i] % stride == 0)
                s->flat[s->first[i] + seen[i] / stride] = (iso_vec2){iso_mm(at.x), iso_mm(at.y)};
        }
    }
    return ISO_OK;
}

static iso_status find_boxes(islands *s, const iso_curved *curved, double r, iso_arena *arena) {
    chart_point *point;
    int32_t count = s->first[s->count];
    ISO_TRY(ISO_PUSH(s->box, arena, s->count));
    ISO_TRY(ISO_PUSH(point, arena, count));
    ISO_TRY(chart_lift(point, curved->chart, s->flat, r, count));
    for (int32_t i = 0; i < s->count; i++) {
        reach_group box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
        for (int32_t k = s->first[i]; k < s->first[i + 1]; k++) {
            iso_vec3 at = point[k].at;
            box.low = vec3(fmin(box.low.x, at.x), fmin(box.low.y, at.y), fmin(box.low.z, at.z));
            box.high = vec3(fmax(box.high.x, at.x), fmax(box.high.y, at.y), fmax(box.high.z, at.z));
        }
        s->box[i] = box;
    }
    return ISO_OK;
}

static bool keeps(const int32_t *order, int32_t count) {
    for (int32_t i = 0; i < count; i++)
        if (order[i] != i)
            return false;
    return true;
}

/* Does it matter in which order they are? It doesn't if they may stay both as they are and the
 * other way round. */
static iso_status find_order(int32_t *order, bool *matters, const islands *s,
                             const clearance_tool *tool, iso_arena *arena) {
    reach_group *turned;
    ISO_TRY(ISO_PUSH(turned, arena, s->count));
    for (int32_t i = 0; i < s->count; i++)
        turned[i] = s->box[s->count - 1 - i];
    ISO_TRY(reach_order(order, turned, s->count, tool, arena));
    *matters = !keeps(order, s->count);
    ISO_TRY(reach_order(order, s->box, s->count, tool, arena));
    *matters = *matters || !keeps(order, s->count);
    return ISO_OK;
}

static iso_status split(iso_sets *sets, const islands *s, const int32_t *order, iso_arena *arena) {
    int32_t *place;
    ISO_TRY(ISO_PUSH(sets->set, arena, s->count));
    ISO_TRY(ISO_PUSH(place, arena, s->count));
    for (int32_t i = 0; i < s->count; i++)
        place[order[i]] = i;
    for (int32_t i = 0; i < s->count; i++) {
        sets->set[i] =
            (iso_paths){.vertex = s->paths->vertex, .vertex_count = s->paths->vertex_count};
        ISO_TRY(ISO_PUSH(sets->set[i].path, arena, s->paths->count));
    }
    for (int32_t p = 0; p < s->paths->count; p++) {
        iso_paths *set = &sets->set[place[s->number[s->paths->path[p].group]]];
        set->path[set->count++] = s->paths->path[p];
    }
    sets->count = s->count;
    return ISO_OK;
}

iso_status reachable_sets(iso_sets *sets, const iso_paths *paths, const iso_curved *curved,
                          double r, const clearance_tool *tool, iso_arena *arena) {
    islands s = {.paths = paths};
    int32_t *order;
    bool matters = false;
    ISO_TRY(ISO_PUSH(sets->set, arena, 1));
    sets->count = 1;
    sets->set[0] = *paths;
    if (!tool || curved_is_flat(curved) || paths->count < 2)
        return ISO_OK;
    ISO_TRY(number_islands(&s, arena));
    if (s.count < 2)
        return ISO_OK;
    ISO_TRY(gather_places(&s, arena));
    ISO_TRY(find_boxes(&s, curved, r, arena));
    ISO_TRY(ISO_PUSH(order, arena, s.count));
    ISO_TRY(find_order(order, &matters, &s, tool, arena));
    return matters ? split(sets, &s, order, arena) : ISO_OK;
}

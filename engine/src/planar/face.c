#include "planar/face.h"

#include "base/sort.h"
#include "planar/predicate.h"

iso_status sets_new(int32_t **parent, int32_t count, iso_arena *arena) {
    ISO_TRY(ISO_PUSH(*parent, arena, count));
    for (int32_t i = 0; i < count; i++)
        (*parent)[i] = i;
    return ISO_OK;
}

/* A connected component: its lexicographic least point sees the face around it to its left. */
typedef struct iso_component {
    iso_point at;
    int32_t chain, index; /* at = point[index] on the chain */
    int32_t outside;      /* a dart whose face lies left of `at` */
    int32_t hit;          /* dart whose face the component lies in; -1: the unbounded one */
    iso_point low, high;  /* the edge that was hit */
} iso_component;

typedef struct iso_face_search {
    iso_arrangement *a;
    iso_component *component; /* ordered by `at` */
    int32_t component_count;
    int32_t *orbit_dart; /* [orbits] a dart of each alpha-orbit */
    int32_t orbit_count;
} iso_face_search;

/* Orbits of alpha, numbered by their lowest dart, into a->face. */
static iso_status label_orbits(iso_face_search *search, iso_arena *arena) {
    iso_arrangement *a = search->a;
    int32_t darts = 2 * a->chain_count;
    ISO_TRY(ISO_PUSH(a->face, arena, darts));
    ISO_TRY(ISO_PUSH(search->orbit_dart, arena, darts));
    for (int32_t d = 0; d < darts; d++)
        a->face[d] = -1;
    for (int32_t d = 0; d < darts; d++) {
        if (a->origin[d] < 0 || a->face[d] >= 0)
            continue;
        int32_t orbit = search->orbit_count++;
        search->orbit_dart[orbit] = d;
        for (int32_t e = d; a->face[e] < 0; e = dart_alpha(a, e))
            a->face[e] = orbit;
    }
    return ISO_OK;
}

static bool component_less(const iso_component *a, const iso_component *b) {
    return point_less(a->at, b->at);
}
ISO_SORT(sort_components, iso_component, component_less)

/* The dart on whose left the point just left of the component's least point lies. At a junction all
 * darts point right or straight up; the last of them counter-clockwise has that point on its left.
 */
static int32_t dart_outside(const iso_arrangement *a, int32_t chain, int32_t index) {
    int32_t first = a->chain_first[chain], last = a->chain_first[chain + 1] - 1;
    if (index == first || index == last) {
        int32_t junction = a->origin[2 * chain + (index == last && index != first)];
        return a->around[a->around_first[junction + 1] - 1];
    }
    const iso_point *p = a->point + index;
    return 2 * chain + (orient2d(p[-1], p[0], p[1]) > 0);
}

static iso_status find_components(iso_face_search *search, iso_arena *arena) {
    iso_arrangement *a = search->a;
    int32_t *set, *number;
    ISO_TRY(sets_new(&set, a->junction_count, arena));
    ISO_TRY(ISO_PUSH(number, arena, a->junction_count));
    for (int32_t c = 0; c < a->chain_count; c++)
        if (a->origin[2 * c] >= 0)
            set_unite(set, a->origin[2 * c], a->origin[2 * c + 1]);
    int32_t count = 0;
    for (int32_t j = 0; j < a->junction_count; j++)
        number[j] =
            set_find(set, j) == j && a->around_first[j] < a->around_first[j + 1] ? count++ : -1;
    iso_component *component;
    ISO_TRY(ISO_PUSH(component, arena, count));
    for (int32_t k = 0; k < count; k++)
        component[k].chain = -1;
    for (int32_t c = 0; c < a->chain_count; c++) {
        if (a->origin[2 * c] < 0)
            continue;
        iso_component *k = &component[number[set_find(set, a->origin[2 * c])]];
        iso_point lowest = a->point[a->lowest[c]];
        if (k->chain < 0 || point_less(lowest, k->at))
            *k = (iso_component){.at = lowest, .chain = c, .index = a->lowest[c], .hit = -1};
    }
    for (int32_t k = 0; k < count; k++)
        component[k].outside = dart_outside(a, component[k].chain, component[k].index);
    sort_components(component, count);
    search->component = component;
    search->component_count = count;
    return ISO_OK;
}

/* Rays run left from the components' least points. They are found from the edges' side: a table by
 * height leads from an edge to the first ray it could stop. */
typedef struct iso_ray_table {
    int32_t *by_height; /* components ordered by at.y */
    int32_t *first;     /* first[b]: the first ray of bucket b or a later one */
    int32_t buckets, low, shift;
} iso_ray_table;

typedef struct iso_height {
    int32_t y, component;
} iso_height;

static bool height_less(const iso_height *a, const iso_height *b) {
    return a->y != b->y ? a->y < b->y : a->component < b->component;
}
ISO_SORT(sort_heights, iso_height, height_less)

static iso_status build_ray_table(iso_ray_table *table, const iso_face_search *search,
                                  iso_arena *arena) {
    int32_t count = search->component_count;
    iso_height *height;
    ISO_TRY(ISO_PUSH(height, arena, count));
    for (int32_t k = 0; k < count; k++)
        height[k] = (iso_height){search->component[k].at.y, k};
    sort_heights(height, count);
    table->low = height[0].y;
    table->shift = 0;
    while (((height[count - 1].y - table->low) >> table->shift) >= 4 * count)
        table->shift++;
    table->buckets = ((height[count - 1].y - table->low) >> table->shift) + 1;
    ISO_TRY(ISO_PUSH(table->by_height, arena, count));
    ISO_TRY(ISO_PUSH(table->first, arena, table->buckets));
    int32_t b = 0;
    for (int32_t i = 0; i < count; i++) {
        table->by_height[i] = height[i].component;
        for (; b <= (height[i].y - table->low) >> table->shift; b++)
            table->first[b] = i;
    }
    return ISO_OK;
}

/* The edge low -> high spans the ray's height. If it lies left of the ray's start and is nearer
 * than what the ray has hit so far, it stops it. */
static void stop_ray(iso_component *ray, iso_point low, iso_point high, int32_t dart_east) {
    if ((low.x > ray->at.x && high.x > ray->at.x) || orient2d(low, high, ray->at) >= 0)
        return;
    if (ray->hit >= 0 && crosses_left_of(low, high, ray->low, ray->high, ray->at.y))
        return;
    ray->hit = dart_east;
    ray->low = low;
    ray->high = high;
}

static void shoot_rays(iso_face_search *search, const iso_ray_table *table) {
    const iso_arrangement *a = search->a;
    for (int32_t c = 0; c < a->chain_count; c++) {
        if (a->origin[2 * c] < 0)
            continue;
        for (int32_t i = a->chain_first[c]; i + 1 < a->chain_first[c + 1]; i++) {
            iso_point p = a->point[i], q = a->point[i + 1];
            bool rises = p.y < q.y;
            iso_point low = rises ? p : q, high = rises ? q : p;
            int32_t bucket = low.y <= table->low ? 0 : (low.y - table->low) >> table->shift;
            if (low.y == high.y || bucket >= table->buckets)
                continue;
            for (int32_t r = table->first[bucket]; r < search->component_count; r++) {
                iso_component *ray = &search->component[table->by_height[r]];
                if (ray->at.y >= high.y)
                    break;
                if (ray->at.y >= low.y)
                    stop_ray(ray, low, high, 2 * c + rises);
            }
        }
    }
}

/* Orbits become faces: the orbit outside a component bounds the same face as the orbit its ray hit.
 * Set `orbits` stands for the unbounded face. */
static iso_status unite_orbits(iso_face_search *search, iso_arena *arena) {
    iso_arrangement *a = search->a;
    int32_t *set, *number;
    ISO_TRY(sets_new(&set, search->orbit_count + 1, arena));
    ISO_TRY(ISO_PUSH(number, arena, search->orbit_count + 1));
    for (int32_t k = 0; k < search->component_count; k++) {
        const iso_component *c = &search->component[k];
        set_unite(set, a->face[c->outside], c->hit < 0 ? search->orbit_count : a->face[c->hit]);
    }
    for (int32_t o = 0; o <= search->orbit_count; o++)
        number[o] = -1;
    a->face_count = 0;
    number[set_find(set, search->orbit_count)] = a->face_count++;
    for (int32_t o = 0; o < search->orbit_count; o++) {
        int32_t root = set_find(set, o);
        if (number[root] < 0)
            number[root] = a->face_count++;
    }
    for (int32_t d = 0; d < 2 * a->chain_count; d++)
        if (a->face[d] >= 0)
            a->face[d] = number[set_find(set, a->face[d])];
    return ISO_OK;
}

/* Flood: across a chain the winding changes by its multiplicity. Components come in the order of
 * their least points, so the face around one is known when its turn comes. */
static iso_status flood_windings(iso_face_search *search, const int32_t *orbit, iso_arena *arena) {
    iso_arrangement *a = search->a;
    int32_t *stack;
    uint8_t *seen;
    ISO_TRY(ISO_PUSH(a->winding, arena, a->face_count));
    ISO_TRY(ISO_PUSH(stack, arena, search->orbit_count));
    ISO_TRY(ISO_PUSH(seen, arena, search->orbit_count));
    memset(seen, 0, (size_t)search->orbit_count);
    a->winding[0] = (iso_winding){{0}};
    for (int32_t k = 0; k < search->component_count; k++) {
        int32_t n = 0, outside = orbit[search->component[k].outside];
        seen[outside] = 1;
        stack[n++] = outside;
        while (n > 0) {
            int32_t start = search->orbit_dart[stack[--n]], d = start;
            iso_winding here = a->winding[a->face[start]];
            do {
                if (!seen[orbit[d ^ 1]]) {
                    seen[orbit[d ^ 1]] = 1;
                    stack[n++] = orbit[d ^ 1];
                    int sign = d & 1 ? -1 : 1;
                    const iso_winding *m = &a->multiplicity[d >> 1];
                    iso_winding *beyond = &a->winding[a->face[d ^ 1]];
                    for (int o = 0; o < OPERANDS_MAX; o++)
                        beyond->of[o] = here.of[o] - sign * m->of[o];
                }
                d = dart_alpha(a, d);
            } while (d != start);
        }
    }
    return ISO_OK;
}

iso_status arrangement_find_faces(iso_arrangement *a, iso_arena *arena) {
    iso_face_search search = {.a = a};
    int32_t *orbit;
    int32_t darts = 2 * a->chain_count;
    ISO_TRY(label_orbits(&search, arena));
    ISO_TRY(ISO_PUSH(orbit, arena, darts));
    memcpy(orbit, a->face, (size_t)darts * sizeof *orbit);
    ISO_TRY(find_components(&search, arena));
    if (search.component_count > 1) {
        iso_ray_table table;
        ISO_TRY(build_ray_table(&table, &search, arena));
        shoot_rays(&search, &table);
    }
    ISO_TRY(unite_orbits(&search, arena));
    return flood_windings(&search, orbit, arena);
}

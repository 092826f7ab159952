#include "solid/halves.h"

#include "base/memory.h"
#include "base/sort.h"

typedef struct place {
    double key;
    iso_vec3 middle;
    int32_t index;
} place;

static inline int place_less(const place *a, const place *b) {
    return a->key != b->key ? a->key < b->key : a->index < b->index;
}
ISO_SORT(sort_places, place, place_less)

/* Put the least `left` places first. Where pivots are bad for long, sorting is no worse. */
static void halve(place *places, int64_t count, int64_t left) {
    enum { PATIENCE = 64 };
    for (int turn = 0; turn < PATIENCE && count > 24; turn++) {
        place a = places[0], b = places[count / 2], c = places[count - 1];
        place pivot = place_less(&a, &b) ? (place_less(&b, &c)   ? b
                                            : place_less(&a, &c) ? c
                                                                 : a)
                                         : (place_less(&a, &c)   ? a
                                            : place_less(&b, &c) ? c
                                                                 : b);
        int64_t i = 0, j = count - 1;
        for (;;) {
            while (place_less(&places[i], &pivot))
                i++;
            while (place_less(&pivot, &places[j]))
                j--;
            if (i >= j)
                break;
            place kept = places[i];
            places[i++] = places[j];
            places[j--] = kept;
        }
        if (left <= j) {
            count = j + 1;
        } else {
            places += j + 1;
            count -= j + 1;
            left -= j + 1;
        }
    }
    sort_places(places, count);
}

static void split_node(place *places, int64_t count, int64_t left) {
    iso_vec3 min = places[0].middle, max = min;
    for (int64_t i = 1; i < count; i++) {
        const iso_vec3 *m = &places[i].middle;
        min.x = m->x < min.x ? m->x : min.x;
        min.y = m->y < min.y ? m->y : min.y;
        min.z = m->z < min.z ? m->z : min.z;
        max.x = m->x > max.x ? m->x : max.x;
        max.y = m->y > max.y ? m->y : max.y;
        max.z = m->z > max.z ? m->z : max.z;
    }
    iso_vec3 size = {max.x - min.x, max.y - min.y, max.z - min.z};
    int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    for (int64_t i = 0; i < count; i++) {
        const iso_vec3 *m = &places[i].middle;
        places[i].key = axis == 0 ? m->x : axis == 1 ? m->y : m->z;
    }
    halve(places, count, left);
}

iso_status halves_order(int32_t *order, const iso_vec3 *corner, int64_t count, int levels) {
    place *places;
    ISO_TRY(ISO_ALLOCATE(places, count));
    for (int64_t i = 0; i < count; i++) {
        const iso_vec3 *a = &corner[3 * i];
        places[i] = (place){.middle = {a[0].x + a[1].x + a[2].x, a[0].y + a[1].y + a[2].y,
                                       a[0].z + a[1].z + a[2].z},
                            .index = (int32_t)i};
    }
    for (int level = 0; level < levels; level++) {
        for (int64_t node = 0; node < (int64_t)1 << level; node++) {
            int64_t first = halves_first(count, level, node);
            int64_t end = halves_first(count, level, node + 1);
            if (end > first)
                split_node(&places[first], end - first,
                           halves_first(count, level + 1, 2 * node + 1) - first);
        }
    }
    for (int64_t i = 0; i < count; i++)
        order[i] = places[i].index;
    iso_release(places);
    return ISO_OK;
}

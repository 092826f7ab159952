/* Faces and winding numbers of an arrangement whose darts are linked. */
#ifndef ISO_PLANAR_FACE_H
#define ISO_PLANAR_FACE_H

#include "planar/arrangement.h"

/* Sets face, face_count and winding. */
iso_status arrangement_find_faces(iso_arrangement *arrangement, iso_arena *arena) ISO_MUST_CHECK;

/* Disjoint sets over [0, n): parent[i] = i to begin with; the least element names a set. */
static inline int32_t set_find(int32_t *parent, int32_t i) {
    while (parent[i] != i)
        i = parent[i] = parent[parent[i]];
    return i;
}

static inline void set_unite(int32_t *parent, int32_t a, int32_t b) {
    a = set_find(parent, a);
    b = set_find(parent, b);
    if (a < b)
        parent[b] = a;
    else
        parent[a] = b;
}

iso_status sets_new(int32_t **parent, int32_t count, iso_arena *arena) ISO_MUST_CHECK;

#endif

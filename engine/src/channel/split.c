#include "channel/split.h"

#include "base/memory.h"
#include "base/vector.h"

enum { TRIANGLES_MOST = 1 << 19, TURNS = 24 };

typedef struct triangles {
    float *corner; /* [9 count] */
    int64_t count, capacity;
} triangles;

static iso_vec3 corner_at(const float *triangle, int k) {
    return vec3(triangle[3 * k], triangle[3 * k + 1], triangle[3 * k + 2]);
}

static iso_status add(triangles *to, iso_vec3 a, iso_vec3 b, iso_vec3 c) {
    const float nine[9] = {(float)a.x, (float)a.y, (float)a.z, (float)b.x, (float)b.y,
                           (float)b.z, (float)c.x, (float)c.y, (float)c.z};
    ISO_TRY(ISO_GROW(to->corner, to->capacity, 9 * (to->count + 1)));
    memcpy(to->corner + 9 * to->count++, nine, sizeof nine);
    return ISO_OK;
}

/* The same from both of its triangles: a + b is b + a. */
static iso_vec3 middle(iso_vec3 a, iso_vec3 b) {
    return vec3_times(vec3_plus(a, b), 0.5);
}

/* Whether an edge is halved is told by its ends alone, so that neighbours agree. */
static iso_status split_one(triangles *to, const float *triangle, double longest, bool *all) {
    iso_vec3 p[3], m[3];
    bool cut[3];
    int cuts = 0, first = 0;
    for (int k = 0; k < 3; k++)
        p[k] = corner_at(triangle, k);
    for (int k = 0; k < 3; k++) {
        cut[k] = vec3_distance(p[k], p[(k + 1) % 3]) > longest;
        cuts += cut[k];
        m[k] = middle(p[k], p[(k + 1) % 3]);
    }
    *all &= cuts == 0;
    if (cuts == 0)
        return add(to, p[0], p[1], p[2]);
    while (cuts < 3 && !(cut[first] && !cut[(first + 2) % 3]))
        first++; /* the first of those that are cut, going around */
    iso_vec3 a = p[first], b = p[(first + 1) % 3], c = p[(first + 2) % 3];
    iso_vec3 ab = m[first], bc = m[(first + 1) % 3], ca = m[(first + 2) % 3];
    if (cuts == 1) {
        ISO_TRY(add(to, a, ab, c));
        return add(to, ab, b, c);
    }
    ISO_TRY(add(to, ab, b, bc));
    if (cuts == 2) {
        ISO_TRY(add(to, a, ab, bc));
        return add(to, a, bc, c);
    }
    ISO_TRY(add(to, a, ab, ca));
    ISO_TRY(add(to, ca, bc, c));
    return add(to, ab, bc, ca);
}

static iso_status split(triangles *t, double longest) {
    bool all = false;
    for (int turn = 0; turn < TURNS && !all && t->count < TRIANGLES_MOST; turn++) {
        triangles next = {0};
        iso_status status = ISO_OK;
        all = true;
        for (int64_t i = 0; i < t->count && status == ISO_OK; i++)
            status = split_one(&next, t->corner + 9 * i, longest, &all);
        iso_release(t->corner);
        *t = next;
        ISO_TRY(status);
    }
    return ISO_OK;
}

iso_status mesh_split(iso_mesh *out, const iso_mesh *mesh, double longest) {
    triangles t = {0};
    iso_status status = ISO_OK;
    *out = (iso_mesh){0};
    for (int64_t i = 0; i < mesh->triangle_count && status == ISO_OK; i++) {
        const int32_t *v = mesh->origin + 3 * i;
        status = add(&t, mesh->position[v[0]], mesh->position[v[1]], mesh->position[v[2]]);
    }
    if (status == ISO_OK)
        status = split(&t, longest);
    if (status == ISO_OK)
        status = iso_mesh_from_triangles(out, t.corner, t.count);
    iso_release(t.corner);
    return status;
}

#include "solid/check_shells.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "mesh/repair.h"

/* In auto mode a shell is asked in so many places, while all of them together come to no more than
 * one triangle in so many. */
enum { AUTO_PLACES = 16, AUTO_TRIANGLES = 100 };

/* mm to both sides of a triangle. */
#define ASIDE 1e-4

enum { TASK = 512 }; /* triangles asked in one go */

enum { BOUNDS = 1, BURIED = 2, EMPTY = 4 };

typedef struct asker {
    const iso_mesh *mesh;
    const iso_solid *solid;
    int32_t *chosen; /* [count] triangles */
    uint8_t *seen;   /* [count] */
    int64_t count;
} asker;

static iso_vec3 minus(iso_vec3 a, iso_vec3 b) {
    return (iso_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

/* In front of the middle of a triangle and behind it; false if it has no area. */
static bool look_across(iso_vec3 point[2], const iso_mesh *mesh, int32_t triangle) {
    iso_vec3 p = mesh->position[mesh->origin[3 * triangle]];
    iso_vec3 q = mesh->position[mesh->origin[3 * triangle + 1]];
    iso_vec3 r = mesh->position[mesh->origin[3 * triangle + 2]];
    iso_vec3 a = minus(q, p), b = minus(r, p);
    iso_vec3 n = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    double length = sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
    double by = length > 0 ? ASIDE / length : 0;
    iso_vec3 middle = {(p.x + q.x + r.x) / 3, (p.y + q.y + r.y) / 3, (p.z + q.z + r.z) / 3};
    point[0] = (iso_vec3){middle.x + by * n.x, middle.y + by * n.y, middle.z + by * n.z};
    point[1] = (iso_vec3){middle.x - by * n.x, middle.y - by * n.y, middle.z - by * n.z};
    return by > 0;
}

static iso_status ask(void *payload, int64_t number, int worker) {
    const asker *a = payload;
    iso_vec3 point[2 * TASK] = {{0, 0, 0}};
    int32_t winding[2 * TASK];
    int64_t first = number * TASK, left = a->count - first;
    int32_t count = left < TASK ? (int32_t)left : TASK;
    for (int32_t i = 0; i < count; i++)
        a->seen[first + i] = look_across(point + 2 * i, a->mesh, a->chosen[first + i]);
    ISO_TRY(iso_solid_winding(winding, NULL, a->solid, point, 2 * count, NULL));
    for (int32_t i = 0; i < count; i++) {
        bool front = winding[2 * i] >= 1, behind = winding[2 * i + 1] >= 1;
        if (a->seen[first + i])
            a->seen[first + i] = front != behind ? BOUNDS : front ? BURIED : EMPTY;
    }
    return ISO_OK;
}

/* Spread over the file's order of each shell's triangles. */
static iso_status choose(asker *a, const int32_t *shell, int32_t shells, bool all) {
    int32_t *size, *stride, triangles = a->mesh->triangle_count;
    int32_t places = triangles / AUTO_TRIANGLES / shells + 1;
    places = places < AUTO_PLACES ? places : AUTO_PLACES;
    ISO_TRY(ISO_ALLOCATE(size, 2 * (int64_t)shells));
    stride = size + shells;
    memset(size, 0, 2 * (size_t)shells * sizeof *size);
    for (int32_t t = 0; t < triangles; t++)
        size[shell[t]]++;
    for (int32_t i = 0; i < shells; i++)
        stride[i] = all || size[i] < places ? 1 : size[i] / places;
    memset(size, 0, (size_t)shells * sizeof *size);
    for (int32_t t = 0; t < triangles; t++)
        if (size[shell[t]]++ % stride[shell[t]] == 0)
            a->chosen[a->count++] = t;
    iso_release(size);
    return ISO_OK;
}

static void add_volumes(double *volume, const iso_mesh *mesh, const int32_t *shell) {
    iso_vec3 base = mesh->position[mesh->origin[0]];
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        iso_vec3 p = minus(mesh->position[mesh->origin[3 * t]], base);
        iso_vec3 q = minus(mesh->position[mesh->origin[3 * t + 1]], base);
        iso_vec3 r = minus(mesh->position[mesh->origin[3 * t + 2]], base);
        volume[shell[t]] += p.x * (q.y * r.z - q.z * r.y) + p.y * (q.z * r.x - q.x * r.z) +
                            p.z * (q.x * r.y - q.y * r.x);
    }
}

static iso_status sort_shells(shell_kinds *kinds, const asker *a, const int32_t *shell,
                              int32_t shells) {
    uint8_t *seen;
    double *volume;
    ISO_TRY(ISO_ALLOCATE(seen, shells));
    iso_status status = ISO_ALLOCATE(volume, shells);
    if (status == ISO_OK) {
        memset(seen, 0, (size_t)shells);
        memset(volume, 0, (size_t)shells * sizeof *volume);
        add_volumes(volume, a->mesh, shell);
        for (int64_t i = 0; i < a->count; i++)
            seen[shell[a->chosen[i]]] |= a->seen[i];
        for (int32_t i = 0; i < shells; i++) {
            kinds->overlapping += (seen[i] & BOUNDS) && seen[i] != BOUNDS;
            kinds->nested += seen[i] == BURIED;
            kinds->hollow += seen[i] == EMPTY;
            kinds->cavities += (seen[i] & BOUNDS) && volume[i] < 0;
        }
        kinds->shells += shells;
        kinds->points += 2 * a->count;
        iso_release(volume);
    }
    iso_release(seen);
    return status;
}

static iso_status sort_mesh(shell_kinds *kinds, asker *a, bool all, iso_pool *pool) {
    int32_t *shell, shells;
    ISO_TRY(iso_mesh_find_shells(&shell, &shells, a->mesh));
    iso_status status = ISO_ALLOCATE(a->chosen, a->mesh->triangle_count);
    if (status == ISO_OK)
        status = choose(a, shell, shells, all);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(a->seen, a->count);
    if (status == ISO_OK)
        status = iso_parallel_for(pool, (a->count + TASK - 1) / TASK, ask, a);
    if (status == ISO_OK)
        status = sort_shells(kinds, a, shell, shells);
    iso_release(shell);
    iso_release(a->chosen);
    iso_release(a->seen);
    return status;
}

iso_status shells_sort_by_kind(shell_kinds *kinds, const solid_subject *subject,
                               const iso_solid *solid, iso_pool *pool) {
    *kinds = (shell_kinds){0};
    for (int32_t m = 0; m < subject->count; m++) {
        asker a = {.mesh = &subject->mesh[m], .solid = solid};
        if (a.mesh->triangle_count > 0)
            ISO_TRY(sort_mesh(kinds, &a, subject->mode == ISO_CHECK_FULL, pool));
    }
    return ISO_OK;
}

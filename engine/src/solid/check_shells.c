#include "solid/check_shells.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/sort.h"
#include "mesh/repair.h"

/* Of some triangles: a shell is looked at in that many places at least, if it has them, and in more
 * while all of these come to no more than one triangle in so many. */
enum { PLACES_LEAST = 8, PLACES_MOST = 16, TRIANGLES = 100 };

/* Slope of triangles that lie too flat for a plane to cut them well. */
#define FLAT 0.01

/* mm to both sides of a triangle. */
#define ASIDE 1e-4

enum { TASK = 512 }; /* triangles asked in one go */

enum { BOUNDS = 1, BURIED = 2, EMPTY = 4 };

typedef struct asker {
    const iso_mesh *mesh;
    const iso_solid *solid;
    uint8_t *seen; /* [triangles] */
} asker;

static uint8_t kind_of(int32_t front, int32_t behind) {
    return (front >= 1) != (behind >= 1) ? BOUNDS : front >= 1 ? BURIED : EMPTY;
}

static iso_vec3 minus(iso_vec3 a, iso_vec3 b) {
    return (iso_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

/* ---- all triangles ---- */

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
    int64_t first = number * TASK, left = a->mesh->triangle_count - first;
    int32_t count = left < TASK ? (int32_t)left : TASK;
    for (int32_t i = 0; i < count; i++)
        a->seen[first + i] = look_across(point + 2 * i, a->mesh, (int32_t)first + i);
    ISO_TRY(iso_solid_winding(winding, NULL, a->solid, point, 2 * count, NULL));
    for (int32_t i = 0; i < count; i++)
        if (a->seen[first + i])
            a->seen[first + i] = kind_of(winding[2 * i], winding[2 * i + 1]);
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

static void sort_shells(shell_kinds *kinds, const uint8_t *seen, const double *volume,
                        int32_t shells) {
    for (int32_t i = 0; i < shells; i++) {
        kinds->overlapping += (seen[i] & BOUNDS) && seen[i] != BOUNDS;
        kinds->nested += seen[i] == BURIED;
        kinds->hollow += seen[i] == EMPTY;
        kinds->cavities += (seen[i] & BOUNDS) && volume[i] < 0;
    }
    kinds->shells += shells;
}

static iso_status gather(shell_kinds *kinds, const asker *a, const int32_t *shell, int32_t shells) {
    uint8_t *seen;
    double *volume;
    ISO_TRY(ISO_ALLOCATE(seen, shells));
    iso_status status = ISO_ALLOCATE(volume, shells);
    if (status == ISO_OK) {
        memset(seen, 0, (size_t)shells);
        memset(volume, 0, (size_t)shells * sizeof *volume);
        add_volumes(volume, a->mesh, shell);
        for (int32_t t = 0; t < a->mesh->triangle_count; t++)
            seen[shell[t]] |= a->seen[t];
        sort_shells(kinds, seen, volume, shells);
        kinds->points += 2 * (int64_t)a->mesh->triangle_count;
        iso_release(volume);
    }
    iso_release(seen);
    return status;
}

static iso_status ask_mesh(shell_kinds *kinds, asker *a, iso_pool *pool) {
    int32_t *shell, shells;
    ISO_TRY(ISO_ALLOCATE(a->seen, a->mesh->triangle_count));
    iso_status status = iso_parallel_for(pool, (a->mesh->triangle_count + TASK - 1) / TASK, ask, a);
    if (status == ISO_OK)
        status = iso_mesh_find_shells(&shell, &shells, a->mesh);
    if (status == ISO_OK) {
        status = gather(kinds, a, shell, shells);
        iso_release(shell);
    }
    iso_release(a->seen);
    return status;
}

iso_status shells_ask_rays(shell_kinds *kinds, const solid_subject *subject, iso_pool *pool) {
    iso_solid *solid;
    *kinds = (shell_kinds){0};
    ISO_TRY(iso_solid_new(&solid, subject->mesh, subject->count));
    iso_status status = ISO_OK;
    for (int32_t m = 0; m < subject->count && status == ISO_OK; m++) {
        asker a = {.mesh = &subject->mesh[m], .solid = solid};
        if (a.mesh->triangle_count > 0)
            status = ask_mesh(kinds, &a, pool);
    }
    iso_solid_free(solid);
    return status;
}

/* ---- some of them ---- */

/* Where the level cuts a triangle, in front of it and behind it; false if it doesn't, or hardly. */
static bool look_along(iso_vec2 beside[2], const iso_mesh *mesh, int32_t triangle, double z) {
    iso_vec3 p[3];
    iso_vec2 middle = {0, 0};
    int ends = 0;
    for (int k = 0; k < 3; k++)
        p[k] = mesh->position[mesh->origin[3 * triangle + k]];
    for (int k = 0; k < 3; k++) {
        iso_vec3 a = p[k], b = p[(k + 1) % 3];
        if ((a.z <= z) == (b.z <= z))
            continue;
        double part = (z - a.z) / (b.z - a.z) / 2;
        middle.x += a.x / 2 + part * (b.x - a.x);
        middle.y += a.y / 2 + part * (b.y - a.y);
        ends++;
    }
    iso_vec3 a = minus(p[1], p[0]), b = minus(p[2], p[0]);
    double x = a.y * b.z - a.z * b.y, y = a.z * b.x - a.x * b.z, up = a.x * b.y - a.y * b.x;
    double length = sqrt(x * x + y * y);
    if (ends != 2 || !(length > FLAT * fabs(up)))
        return false;
    double by = ASIDE / length;
    beside[0] = (iso_vec2){middle.x + by * x, middle.y + by * y};
    beside[1] = (iso_vec2){middle.x - by * x, middle.y - by * y};
    return true;
}

typedef struct chooser {
    shell_places *places;
    const iso_levels *levels;
    const iso_mesh *mesh;     /* at hand */
    const plane_range *range; /* [triangles] of it */
    int32_t *shell;           /* [triangles] */
    int32_t *passed;          /* [shells] triangles that levels meet */
    int32_t *every;           /* [shells] one of so many is wanted */
    int32_t *wanted;          /* [shells] that were not found yet */
    int64_t place_room, shell_room;
} chooser;

/* Spread over the file's order of each shell's triangles that levels meet. */
static void choose(chooser *c, int32_t shells) {
    shell_places *to = c->places;
    int32_t triangles = c->mesh->triangle_count, most = triangles / TRIANGLES / shells;
    most = most < PLACES_LEAST ? PLACES_LEAST : most < PLACES_MOST ? most : PLACES_MOST;
    for (int32_t t = 0; t < triangles; t++)
        c->every[c->shell[t]] += c->range[t].low < c->range[t].high;
    for (int32_t i = 0; i < shells; i++)
        c->every[i] = c->every[i] > most ? (c->every[i] + most - 1) / most : 1;
    for (int32_t t = 0; t < triangles; t++) {
        int32_t shell = c->shell[t], low = c->range[t].low, high = c->range[t].high;
        if (low == high)
            continue;
        int32_t number = c->passed[shell]++;
        if (number % c->every[shell] == 0)
            c->wanted[shell]++;
        shell_place *place = &to->place[to->count];
        place->level = low + (int32_t)((int64_t)(high - low) * (2 * (number % 4) + 1) / 8);
        if (c->wanted[shell] == 0 ||
            !look_along(place->beside, c->mesh, t, c->levels->cut[place->level]))
            continue;
        c->wanted[shell]--;
        place->number = (int32_t)to->count++;
        place->shell = to->shells + shell;
        place->seen = 0;
    }
}

static iso_status choose_with_shells(chooser *c, int32_t shells) {
    shell_places *to = c->places;
    int64_t room =
        to->count + c->mesh->triangle_count / TRIANGLES + PLACES_LEAST * (int64_t)shells + 1;
    ISO_TRY(ISO_GROW(to->place, c->place_room, room));
    ISO_TRY(ISO_GROW(to->volume, c->shell_room, (int64_t)to->shells + shells));
    ISO_TRY(ISO_ALLOCATE(c->passed, 3 * (int64_t)shells));
    memset(c->passed, 0, 3 * (size_t)shells * sizeof *c->passed);
    c->every = c->passed + shells;
    c->wanted = c->every + shells;
    memset(to->volume + to->shells, 0, (size_t)shells * sizeof *to->volume);
    add_volumes(to->volume + to->shells, c->mesh, c->shell);
    choose(c, shells);
    to->shells += shells;
    iso_release(c->passed);
    return ISO_OK;
}

static iso_status choose_all(chooser *c, const solid_planes *planes) {
    c->range = planes->range;
    for (int32_t m = 0; m < planes->count; m++) {
        int32_t shells;
        c->mesh = &planes->mesh[m];
        if (c->mesh->triangle_count == 0)
            continue;
        ISO_TRY(iso_mesh_find_shells(&c->shell, &shells, c->mesh));
        iso_status status = choose_with_shells(c, shells);
        iso_release(c->shell);
        ISO_TRY(status);
        c->range += c->mesh->triangle_count;
    }
    return ISO_OK;
}

static inline int place_before(const shell_place *a, const shell_place *b) {
    return a->level != b->level ? a->level < b->level : a->number < b->number;
}
ISO_SORT(sort_places, shell_place, place_before)

iso_status shell_places_choose(shell_places *places, const solid_planes *planes) {
    shell_places made = {0};
    chooser c = {.places = &made, .levels = planes->levels};
    int32_t levels = planes->levels->count;
    *places = made;
    iso_status status = choose_all(&c, planes);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(made.first, (int64_t)levels + 1);
    if (status != ISO_OK) {
        shell_places_free(&made);
        return status;
    }
    sort_places(made.place, made.count);
    int64_t at = 0;
    for (int32_t i = 0; i <= levels; i++) {
        while (at < made.count && made.place[at].level < i)
            at++;
        made.first[i] = at;
    }
    *places = made;
    return ISO_OK;
}

void shell_places_free(shell_places *places) {
    iso_release(places->place);
    iso_release(places->first);
    iso_release(places->volume);
    *places = (shell_places){0};
}

void shell_places_points(iso_vec3 *point, const shell_places *places, int32_t level, double z) {
    int64_t end = places->first ? places->first[level + 1] : 0;
    for (int64_t i = end - shell_places_of(places, level); i < end; i++)
        for (int k = 0; k < 2; k++)
            *point++ = (iso_vec3){places->place[i].beside[k].x, places->place[i].beside[k].y, z};
}

void shell_places_note(shell_places *places, const int32_t *winding, int32_t level) {
    int64_t end = places->first ? places->first[level + 1] : 0;
    for (int64_t i = end - shell_places_of(places, level); i < end; i++, winding += 2)
        places->place[i].seen = kind_of(winding[0], winding[1]);
}

iso_status shell_places_sort(shell_kinds *kinds, const shell_places *places) {
    uint8_t *seen;
    ISO_TRY(ISO_ALLOCATE(seen, places->shells));
    memset(seen, 0, (size_t)places->shells);
    for (int64_t i = 0; i < places->count; i++)
        seen[places->place[i].shell] |= places->place[i].seen;
    *kinds = (shell_kinds){.points = 0}; /* counted with the contours' */
    sort_shells(kinds, seen, places->volume, places->shells);
    iso_release(seen);
    return ISO_OK;
}

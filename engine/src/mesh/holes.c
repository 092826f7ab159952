#include "mesh/repair.h"

#include <math.h>

#include "base/memory.h"
#include "mesh/union_find.h"

/* A boundary loop, in the direction in which its cap's darts run: against the open darts.
 *
 * From an open dart the loop goes on around the material at its origin, which keeps it on one
 * shell. Where it comes back to a vertex it has passed, two holes touch there: they are split off
 * as loops of their own, so that every loop is simple. */
typedef struct closer {
    iso_mesh *mesh;
    int32_t *shell; /* [triangle] */
    int32_t *place; /* [vertex] where it starts a dart of the path at hand, or -1 */
    int32_t *path;  /* [open] open darts not yet split off */
    int32_t *dart;  /* [open] open darts, loop by loop */
    int32_t *first; /* [loops + 1] */
    iso_vec3 *apex; /* [loops] */
    int32_t loops;
    int64_t open;
    sheets *marks; /* or NULL */
    bool *torn;    /* [triangle], if there are marks: its shell has open edges */
} closer;

static int32_t start_of(const closer *c, int32_t open_dart) {
    return c->mesh->origin[iso_mesh_alpha(open_dart)];
}

static int32_t length_of(const closer *c, int32_t loop) {
    return c->first[loop + 1] - c->first[loop];
}

/* The open dart that ends where `dart` begins, in the same fan of triangles. */
static int32_t next_open(const iso_mesh *mesh, int32_t dart) {
    int32_t c = iso_mesh_alpha_inverse(dart);
    while (mesh->opposite[c] >= 0)
        c = iso_mesh_alpha_inverse(mesh->opposite[c]);
    return c;
}

static void split_off(closer *c, int32_t from, int32_t to) {
    int32_t at = c->first[c->loops];
    for (int32_t i = from; i < to; i++) {
        c->place[start_of(c, c->path[i])] = -1;
        c->dart[at++] = c->path[i];
    }
    c->first[++c->loops] = at;
}

/* A dart of the path is marked as passed by opposite = -2. */
static void trace(closer *c, int32_t start) {
    int32_t depth = 0, a = start;
    int32_t *opposite = c->mesh->opposite;
    do {
        int32_t next = next_open(c->mesh, a), end = c->mesh->origin[a];
        opposite[a] = -2;
        c->place[start_of(c, a)] = depth;
        c->path[depth++] = a;
        if (c->place[end] >= 0) {
            int32_t from = c->place[end];
            split_off(c, from, depth);
            depth = from;
        }
        a = next;
    } while (a != start);
}

static void find_loops(closer *c) {
    c->first[0] = 0;
    for (int32_t v = 0; v < c->mesh->vertex_count; v++)
        c->place[v] = -1;
    for (int32_t a = 0; a < 3 * c->mesh->triangle_count; a++)
        if (c->mesh->opposite[a] == -1)
            trace(c, a);
}

static iso_vec3 minus(iso_vec3 a, iso_vec3 b) {
    return (iso_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static double length(iso_vec3 a) {
    return sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
}

static double area(iso_vec3 p, iso_vec3 q, iso_vec3 r) {
    iso_vec3 a = minus(q, p), b = minus(r, p);
    iso_vec3 n = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    return 0.5 * length(n);
}

/* Where the loop's edges balance, however unevenly they are split. */
static iso_vec3 centroid(const closer *c, int32_t loop) {
    const iso_vec3 *position = c->mesh->position;
    iso_vec3 base = position[start_of(c, c->dart[c->first[loop]])], sum = {0, 0, 0};
    double weight = 0;
    for (int32_t i = c->first[loop]; i < c->first[loop + 1]; i++) {
        iso_vec3 p = minus(position[start_of(c, c->dart[i])], base);
        iso_vec3 q = minus(position[c->mesh->origin[c->dart[i]]], base);
        double w = length(minus(q, p));
        sum.x += w * (p.x + q.x);
        sum.y += w * (p.y + q.y);
        sum.z += w * (p.z + q.z);
        weight += 2 * w;
    }
    return (iso_vec3){base.x + sum.x / weight, base.y + sum.y / weight, base.z + sum.z / weight};
}

static double cap_area(const closer *c, int32_t loop) {
    const iso_vec3 *position = c->mesh->position;
    const int32_t *dart = c->dart + c->first[loop];
    if (length_of(c, loop) == 2)
        return 0;
    if (length_of(c, loop) == 3)
        return area(position[start_of(c, dart[0])], position[start_of(c, dart[1])],
                    position[start_of(c, dart[2])]);
    double sum = 0;
    for (int32_t i = 0; i < length_of(c, loop); i++)
        sum +=
            area(position[start_of(c, dart[i])], position[c->mesh->origin[dart[i]]], c->apex[loop]);
    return sum;
}

static iso_status find_torn(closer *c, int32_t shells) {
    const iso_mesh *mesh = c->mesh;
    bool *shell;
    ISO_TRY(ISO_ALLOCATE(c->torn, mesh->triangle_count));
    ISO_TRY(ISO_ALLOCATE(shell, shells));
    memset(shell, 0, (size_t)shells * sizeof *shell);
    for (int32_t a = 0; a < 3 * mesh->triangle_count; a++)
        shell[c->shell[a / 3]] |= mesh->opposite[a] < 0;
    for (int32_t t = 0; t < mesh->triangle_count; t++)
        c->torn[t] = shell[c->shell[t]];
    iso_release(shell);
    return ISO_OK;
}

/* Triangles that lost all their neighbours still hang on by their corners: for the share of the
 * caps, shells that have a vertex in common are one. */
static void join_at_vertices(closer *c, int32_t *part, int32_t shells) {
    const iso_mesh *mesh = c->mesh;
    for (int32_t i = 0; i < shells; i++)
        part[i] = i;
    for (int32_t v = 0; v < mesh->vertex_count; v++)
        c->place[v] = -1;
    for (int32_t a = 0; a < 3 * mesh->triangle_count; a++) {
        int32_t *owner = &c->place[mesh->origin[a]], shell = iso_root_of(part, c->shell[a / 3]);
        *owner = *owner < 0 ? shell : iso_join_roots(part, iso_root_of(part, *owner), shell);
    }
    for (int32_t t = 0; t < mesh->triangle_count; t++)
        c->shell[t] = iso_root_of(part, c->shell[t]);
}

typedef struct share {
    double area, caps;
    int64_t open;
} share;

static iso_status refuse(const closer *c, const share *s) {
    if (s->area > 0)
        return iso_fail(ISO_UNSLICEABLE,
                        "the surface is open: a shell has %lld open edges, and closing them would "
                        "add %.3g %% to its area (up to %g %% is mended); --sheet-thickness gives "
                        "it a thickness, --repair volume makes a new surface around what it "
                        "encloses, or close it in the program that made it",
                        (long long)s->open, 100 * s->caps / s->area, 100 * ISO_MESH_CAP_SHARE);
    return iso_fail(ISO_UNSLICEABLE,
                    "the surface is open: a shell without area has %lld open edges",
                    (long long)s->open);
}

static bool is_mendable(const share *s) {
    return s->caps <= ISO_MESH_CAP_SHARE * s->area && (s->area > 0 || s->open == 0);
}

/* Of shells that hang together by vertices alone, those that are closed stay. */
static void mark_sheets(closer *c, const share *shares) {
    for (int32_t t = 0; t < c->mesh->triangle_count; t++)
        if (c->torn[t] && !is_mendable(&shares[c->shell[t]])) {
            c->marks->mark[t] = 1;
            c->marks->marked++;
        }
}

static iso_status check_shares(closer *c, share *shares, int32_t shells) {
    iso_mesh *mesh = c->mesh;
    const iso_vec3 *position = mesh->position;
    mesh->defects.cap_area = 0;
    memset(shares, 0, (size_t)shells * sizeof *shares);
    for (int32_t t = 0; t < mesh->triangle_count; t++)
        shares[c->shell[t]].area +=
            area(position[mesh->origin[3 * t]], position[mesh->origin[3 * t + 1]],
                 position[mesh->origin[3 * t + 2]]);
    for (int32_t loop = 0; loop < c->loops; loop++) {
        share *s = &shares[c->shell[c->dart[c->first[loop]] / 3]];
        double caps = cap_area(c, loop);
        s->caps += caps;
        s->open += length_of(c, loop);
        mesh->defects.cap_area += caps;
    }
    const share *worst = NULL;
    for (int32_t i = 0; i < shells; i++) {
        const share *s = &shares[i];
        if (!is_mendable(s) && (!worst || s->open > worst->open))
            worst = s;
    }
    if (worst && c->marks) {
        mark_sheets(c, shares);
        mesh->defects.cap_area = 0;
    }
    return worst && !c->marks ? refuse(c, worst) : ISO_OK;
}

static void join(iso_mesh *mesh, int32_t a, int32_t b) {
    mesh->opposite[a] = b;
    mesh->opposite[b] = a;
}

static void close_loop(closer *c, int32_t loop) {
    iso_mesh *mesh = c->mesh;
    const int32_t *dart = c->dart + c->first[loop];
    int32_t count = length_of(c, loop), cap = 3 * mesh->triangle_count;
    if (count == 2) {
        join(mesh, dart[0], dart[1]);
        return;
    }
    mesh->defects.holes_closed++;
    if (count == 3) {
        for (int32_t k = 0; k < 3; k++) {
            mesh->origin[cap + k] = start_of(c, dart[k]);
            join(mesh, cap + k, dart[k]);
        }
        mesh->triangle_count++;
        return;
    }
    int32_t apex = mesh->vertex_count++;
    mesh->position[apex] = c->apex[loop];
    for (int32_t i = 0; i < count; i++) {
        int32_t a = cap + 3 * i, after = i + 1 < count ? a + 3 : cap;
        mesh->origin[a] = start_of(c, dart[i]);
        mesh->origin[a + 1] = mesh->origin[dart[i]];
        mesh->origin[a + 2] = apex;
        join(mesh, a, dart[i]);
        join(mesh, a + 1, after + 2);
    }
    mesh->triangle_count += count;
}

static iso_status close_loops(closer *c) {
    iso_mesh *mesh = c->mesh;
    int64_t darts = 3 * (mesh->triangle_count + c->open);
    int64_t vertices = (int64_t)mesh->vertex_count + c->loops;
    if (darts > INT32_MAX || vertices > INT32_MAX)
        return iso_fail(ISO_UNSLICEABLE, "the mesh is too large to close its %lld open edges",
                        (long long)c->open);
    int64_t room = 0;
    ISO_TRY(iso_grow((void **)&mesh->origin, &room, darts, sizeof *mesh->origin));
    room = 0;
    ISO_TRY(iso_grow((void **)&mesh->opposite, &room, darts, sizeof *mesh->opposite));
    room = 0;
    ISO_TRY(iso_grow((void **)&mesh->position, &room, vertices, sizeof *mesh->position));
    for (int32_t loop = 0; loop < c->loops; loop++)
        close_loop(c, loop);
    return ISO_OK;
}

static iso_status close_all(closer *c, share **shares) {
    int32_t shells, *part;
    ISO_TRY(ISO_ALLOCATE(c->place, c->mesh->vertex_count));
    ISO_TRY(ISO_ALLOCATE(c->path, c->open));
    ISO_TRY(ISO_ALLOCATE(c->dart, c->open));
    ISO_TRY(ISO_ALLOCATE(c->first, c->open + 1));
    ISO_TRY(iso_mesh_find_shells(&c->shell, &shells, c->mesh));
    if (c->marks)
        ISO_TRY(find_torn(c, shells));
    ISO_TRY(ISO_ALLOCATE(part, shells));
    join_at_vertices(c, part, shells);
    iso_release(part);
    find_loops(c);
    ISO_TRY(ISO_ALLOCATE(c->apex, c->loops));
    for (int32_t loop = 0; loop < c->loops; loop++)
        c->apex[loop] = centroid(c, loop);
    ISO_TRY(ISO_ALLOCATE(*shares, shells));
    ISO_TRY(check_shares(c, *shares, shells));
    return c->marks && c->marks->marked > 0 ? ISO_OK : close_loops(c);
}

iso_status iso_mesh_close_holes(iso_mesh *mesh, int64_t open, sheets *marks) {
    closer c = {.mesh = mesh, .open = open, .marks = marks};
    share *shares = NULL;
    iso_status status = close_all(&c, &shares);
    iso_release(c.shell);
    iso_release(c.torn);
    iso_release(c.place);
    iso_release(c.path);
    iso_release(c.dart);
    iso_release(c.first);
    iso_release(c.apex);
    iso_release(shares);
    return status;
}

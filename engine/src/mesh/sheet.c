#include "mesh/sheet.h"

#include <math.h>

#include "base/memory.h"
#include "mesh/repair.h"
#include "mesh/union_find.h"

/* Leaves of one edge that are compared with each other; beyond, which would take the square of
 * their number, all of them end there. */
enum { LEAVES_MOST = 16 };

/* Weight of the wish not to move along a face that has no say in it: what keeps the equations of a
 * flat corner soluble. The error of a mitre is of that order. */
#define STIFFNESS 1e-6

/* Cover darts are darts of cover triangles, 2 t + side for triangle t of the sheets: as it is, then
 * turned over. A fan is an orbit of darts around their vertex on the cover, broken at the rim: a
 * vertex of the result. */
typedef struct cover {
    const iso_vec3 *position;
    const int32_t *corner; /* [3 count] */
    int32_t count;         /* triangles of the sheets */
    int32_t *mate;         /* [3 count] the dart on whose triangle this one's goes on, or -1: rim */
    int32_t *fan;          /* [6 count] at the origin of each cover dart */
    int32_t fans, walls;
    iso_vec3 *apex;   /* [fans] */
    int32_t *upright; /* [fans] the dart of a wall that starts there and runs to the other side */
} cover;

void sheets_free(sheets *from) {
    iso_release(from->mark);
    iso_release(from->corner);
    *from = (sheets){0};
}

iso_status sheets_take(sheets *to, iso_mesh *mesh) {
    int32_t kept = 0;
    ISO_TRY(ISO_GROW(to->corner, to->capacity, 3 * (to->count + mesh->triangle_count)));
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        int32_t *into = to->mark[t] ? to->corner + 3 * to->count++ : mesh->origin + 3 * kept++;
        memmove(into, mesh->origin + 3 * t, 3 * sizeof *into);
    }
    memset(to->mark, 0, (size_t)mesh->triangle_count);
    to->marked = 0;
    mesh->triangle_count = kept;
    return ISO_OK;
}

/* ---- vectors ---- */

static iso_vec3 minus(iso_vec3 a, iso_vec3 b) {
    return (iso_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static double dot(iso_vec3 a, iso_vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static iso_vec3 along(iso_vec3 a, double by, iso_vec3 b) {
    return (iso_vec3){a.x + by * b.x, a.y + by * b.y, a.z + by * b.z};
}

/* Of length 1, or 0. */
static iso_vec3 unit(iso_vec3 a) {
    double length = sqrt(dot(a, a));
    return length > 0 ? (iso_vec3){a.x / length, a.y / length, a.z / length} : a;
}

static iso_vec3 cross(iso_vec3 a, iso_vec3 b) {
    return (iso_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* ---- which side continues which ---- */

/* Where the triangle of a dart leaves its edge, seen along it. */
static iso_vec3 leaf_of(const cover *c, int32_t dart) {
    int32_t next = iso_mesh_alpha(dart);
    iso_vec3 foot = c->position[c->corner[dart]];
    iso_vec3 axis = unit(minus(c->position[c->corner[next]], foot));
    iso_vec3 arm = minus(c->position[c->corner[iso_mesh_alpha(next)]], foot);
    return unit(along(arm, -dot(arm, axis), axis));
}

/* The pair of leaves that is nearest to a plane goes on into each other, then the next one. */
static void pair_straightest(cover *c, const int32_t *dart, int32_t count) {
    iso_vec3 leaf[LEAVES_MOST];
    for (int32_t i = 0; i < count; i++)
        leaf[i] = leaf_of(c, dart[i]);
    for (int32_t left = count; left >= 2; left -= 2) {
        double least = 2;
        int32_t a = -1, b = -1;
        for (int32_t i = 0; i < count; i++)
            for (int32_t k = i + 1; k < count && c->mate[dart[i]] < 0; k++)
                if (c->mate[dart[k]] < 0 && dot(leaf[i], leaf[k]) < least)
                    least = dot(leaf[i], leaf[k]), a = dart[i], b = dart[k];
        if (least > 0.5) /* sharper than 60 degrees: rather two ends than a spike */
            return;
        c->mate[a] = b;
        c->mate[b] = a;
    }
}

static void find_mates(cover *c, const iso_mesh_edges *edges) {
    for (int32_t a = 0; a < 3 * c->count; a++)
        c->mate[a] = -1;
    for (int64_t e = 0; e < edges->count; e++) {
        const int32_t *dart = edges->dart + edges->first[e];
        int32_t count = edges->first[e + 1] - edges->first[e];
        if (count == 2) {
            c->mate[dart[0]] = dart[1];
            c->mate[dart[1]] = dart[0];
        } else if (count > 2 && count <= LEAVES_MOST) {
            pair_straightest(c, dart, count);
        }
    }
    for (int32_t a = 0; a < 3 * c->count; a++)
        c->walls += c->mate[a] < 0;
}

/* Turned over, a triangle's dart k is the turned dart 2 - k. */
static int32_t cover_dart(int32_t dart, int32_t side) {
    return 6 * (dart / 3) + (side ? 5 - dart % 3 : dart % 3);
}

static int32_t sheet_dart(int32_t on_cover) {
    int32_t t = on_cover / 3, k = on_cover % 3;
    return 3 * (t / 2) + (t % 2 ? 2 - k : k);
}

static int32_t vertex_of(const cover *c, int32_t on_cover) {
    int32_t a = sheet_dart(on_cover);
    return c->corner[on_cover / 3 % 2 ? iso_mesh_alpha(a) : a];
}

/* -1 at the rim. Two darts that run the same way are of triangles that turn against each other. */
static int32_t opposite_of(const cover *c, int32_t on_cover) {
    int32_t a = sheet_dart(on_cover), b = c->mate[a], side = on_cover / 3 % 2;
    if (b < 0)
        return -1;
    return cover_dart(b, c->corner[a] == c->corner[b] ? 1 - side : side);
}

static void find_fans(cover *c) {
    for (int32_t d = 0; d < 6 * c->count; d++)
        c->fan[d] = -1;
    for (int32_t d = 0; d < 6 * c->count; d++) {
        if (c->fan[d] >= 0)
            continue;
        int32_t first = d, back;
        while ((back = opposite_of(c, first)) >= 0 && iso_mesh_alpha(back) != d)
            first = iso_mesh_alpha(back);
        for (int32_t at = first; at >= 0 && c->fan[at] < 0;
             at = opposite_of(c, iso_mesh_alpha_inverse(at)))
            c->fan[at] = c->fans;
        c->fans++;
    }
}

/* ---- how far a corner moves ---- */

/* Sums over the faces of a fan: n n^T, n, and the weights. */
typedef struct faces {
    double xx, xy, xz, yy, yz, zz, weight;
    iso_vec3 sum;
} faces;

static void add_face(faces *f, iso_vec3 n, double weight) {
    f->xx += weight * n.x * n.x;
    f->xy += weight * n.x * n.y;
    f->xz += weight * n.x * n.z;
    f->yy += weight * n.y * n.y;
    f->yz += weight * n.y * n.z;
    f->zz += weight * n.z * n.z;
    f->sum = along(f->sum, weight, n);
    f->weight += weight;
}

/* The move m for which n m = half on all faces as nearly as can be, and which differs least from
 * the move along the mean normal: the mitre, where there is one. By Cholesky's method. */
static iso_vec3 mitre(const faces *f, double half) {
    double stiff = STIFFNESS * f->weight;
    if (!(f->weight > 0))
        return (iso_vec3){0, 0, 0};
    double s = half * (1 + STIFFNESS), a = f->xx + stiff;
    double l10 = f->xy / a, l20 = f->xz / a;
    double b = f->yy + stiff - l10 * f->xy, yz = f->yz - l20 * f->xy, l21 = yz / b;
    double d = f->zz + stiff - l20 * f->xz - l21 * yz;
    double u = s * f->sum.x, v = s * f->sum.y - l10 * u, w = s * f->sum.z - l20 * u - l21 * v;
    iso_vec3 m = {u / a, v / b, w / d};
    m.y -= l21 * m.z;
    m.x -= l10 * m.y + l20 * m.z;
    double length = sqrt(dot(m, m)), most = SHEET_MITRE * half;
    return length <= most ? m : along((iso_vec3){0, 0, 0}, most / length, m);
}

/* Weights grow with the angle of the face in the corner, so that it hardly matters how a flat
 * polygon is split. */
static void weigh_triangle(faces *list, const cover *c, int32_t t) {
    iso_vec3 p[3], edge[3];
    for (int k = 0; k < 3; k++)
        p[k] = c->position[c->corner[3 * t + k]];
    for (int k = 0; k < 3; k++)
        edge[k] = unit(minus(p[(k + 1) % 3], p[k]));
    iso_vec3 n = unit(cross(edge[0], minus(p[2], p[0])));
    if (dot(n, n) == 0)
        return;
    for (int k = 0; k < 3; k++) {
        int32_t a = 3 * t + k;
        double weight = 1 + dot(edge[k], edge[(k + 2) % 3]);
        add_face(&list[c->fan[cover_dart(a, 0)]], n, weight);
        add_face(&list[c->fan[cover_dart(iso_mesh_alpha_inverse(a), 1)]],
                 (iso_vec3){-n.x, -n.y, -n.z}, weight);
    }
}

static iso_status move_fans(cover *c, double half) {
    faces *list;
    ISO_TRY(ISO_ALLOCATE(c->apex, c->fans));
    ISO_TRY(ISO_ALLOCATE(list, c->fans));
    memset(list, 0, (size_t)c->fans * sizeof *list);
    for (int32_t t = 0; t < c->count; t++)
        weigh_triangle(list, c, t);
    for (int32_t d = 0; d < 6 * c->count; d++)
        c->apex[c->fan[d]] = c->position[vertex_of(c, d)];
    for (int32_t i = 0; i < c->fans; i++)
        c->apex[i] = along(c->apex[i], 1, mitre(&list[i], half));
    iso_release(list);
    return ISO_OK;
}

/* ---- the result ---- */

static void join(iso_mesh *mesh, int32_t a, int32_t b) {
    mesh->opposite[a] = b;
    mesh->opposite[b] = a;
}

/* A wall of two triangles on the rim's dart from u to w: (w0, u0, u1) and (w0, u1, w1), 0 and 1 the
 * sides. */
static void add_wall(iso_mesh *mesh, cover *c, int32_t dart, int32_t at, int32_t triangle,
                     int32_t vertex) {
    int32_t front = cover_dart(dart, 0), back = cover_dart(dart, 1);
    int32_t u0 = c->fan[front], w1 = c->fan[back];
    int32_t w0 = c->fan[iso_mesh_alpha(front)], u1 = c->fan[iso_mesh_alpha(back)];
    const int32_t corner[6] = {w0, u0, u1, w0, u1, w1};
    for (int k = 0; k < 6; k++)
        mesh->origin[at + k] = vertex + corner[k];
    join(mesh, at, 3 * triangle + front);
    join(mesh, at + 2, at + 3);
    join(mesh, at + 4, 3 * triangle + back);
    /* around a corner of the rim there are two fans, one a side, and two walls between them */
    c->upright[u0] = at + 1;
    c->upright[w1] = at + 5;
}

static void add_cover(iso_mesh *mesh, cover *c) {
    int32_t triangle = mesh->triangle_count, vertex = mesh->vertex_count;
    int32_t first_wall = 3 * triangle + 6 * c->count, at = first_wall;
    memcpy(mesh->position + vertex, c->apex, (size_t)c->fans * sizeof *c->apex);
    for (int32_t d = 0; d < 6 * c->count; d++) {
        int32_t b = opposite_of(c, d);
        mesh->origin[3 * triangle + d] = vertex + c->fan[d];
        mesh->opposite[3 * triangle + d] = b < 0 ? -1 : 3 * triangle + b;
    }
    for (int32_t a = 0; a < 3 * c->count; a++)
        if (c->mate[a] < 0) {
            add_wall(mesh, c, a, at, triangle, vertex);
            at += 6;
        }
    for (int32_t w = first_wall; w < at; w += 6) {
        mesh->opposite[w + 1] = c->upright[mesh->origin[w + 2] - vertex];
        mesh->opposite[w + 5] = c->upright[mesh->origin[w] - vertex];
    }
    mesh->triangle_count += 2 * (c->count + c->walls);
    mesh->vertex_count += c->fans;
}

static iso_status reserve(iso_mesh *mesh, const cover *c) {
    int64_t darts = 3 * ((int64_t)mesh->triangle_count + 2 * ((int64_t)c->count + c->walls));
    int64_t vertices = (int64_t)mesh->vertex_count + c->fans, room = 0;
    if (darts > INT32_MAX || vertices > INT32_MAX)
        return iso_fail(ISO_UNSLICEABLE, "the mesh is too large to give its sheets a thickness");
    ISO_TRY(iso_grow((void **)&mesh->origin, &room, darts, sizeof *mesh->origin));
    room = 0;
    ISO_TRY(iso_grow((void **)&mesh->opposite, &room, darts, sizeof *mesh->opposite));
    room = 0;
    return iso_grow((void **)&mesh->position, &room, vertices, sizeof *mesh->position);
}

static iso_status count_sheets(int64_t *sum, const cover *c) {
    int32_t *above;
    ISO_TRY(ISO_ALLOCATE(above, c->count));
    for (int32_t t = 0; t < c->count; t++)
        above[t] = t;
    for (int32_t a = 0; a < 3 * c->count; a++)
        if (c->mate[a] > a)
            iso_join_roots(above, iso_root_of(above, a / 3), iso_root_of(above, c->mate[a] / 3));
    for (int32_t t = 0; t < c->count; t++)
        *sum += above[t] == t;
    iso_release(above);
    return ISO_OK;
}

static iso_status thicken(iso_mesh *mesh, cover *c, double thickness) {
    iso_mesh_edges edges;
    iso_mesh seen = {.triangle_count = c->count,
                     .vertex_count = mesh->vertex_count,
                     .origin = (int32_t *)c->corner};
    ISO_TRY(ISO_ALLOCATE(c->mate, 3 * (int64_t)c->count));
    ISO_TRY(ISO_ALLOCATE(c->fan, 6 * (int64_t)c->count));
    ISO_TRY(iso_mesh_edges_new(&edges, &seen));
    find_mates(c, &edges);
    iso_mesh_edges_free(&edges);
    find_fans(c);
    ISO_TRY(move_fans(c, thickness / 2));
    ISO_TRY(ISO_ALLOCATE(c->upright, c->fans));
    ISO_TRY(reserve(mesh, c));
    add_cover(mesh, c);
    mesh->defects.sheet_thickness = thickness;
    return count_sheets(&mesh->defects.sheets, c);
}

iso_status sheets_thicken(iso_mesh *mesh, const sheets *from) {
    if (from->count > INT32_MAX / 6)
        return iso_fail(ISO_UNSLICEABLE, "%lld triangles are too many to be given a thickness",
                        (long long)from->count);
    cover c = {.position = mesh->position, .corner = from->corner, .count = (int32_t)from->count};
    iso_status status = c.count > 0 ? thicken(mesh, &c, from->thickness) : ISO_OK;
    iso_release(c.mate);
    iso_release(c.fan);
    iso_release(c.apex);
    iso_release(c.upright);
    return status;
}

#include <isoslice/object.h>

#include <math.h>

#include "object/cap.h"

/* One half of a mesh. A vertex on the plane is on the other side of it, so that each half has only
 * what truly lies there: where a flat part of the surface lies in the plane, the half that it
 * bounds loses it and gets it back as part of the cap. An edge that is cut ends in one new vertex,
 * or in its end on the plane. */
typedef struct half {
    const iso_mesh *mesh;
    double z;
    bool lower;
    iso_growing_mesh to;
    int32_t *number; /* [vertex] in the half, or -1 */
    int32_t *end;    /* [dart] cut edges: their vertex on the plane; -1: none yet */
    int32_t *along;  /* [dart] that lies on it in the half, or -1 */
    int32_t *chord;  /* [triangle] the new dart in the plane, or -1 */
    iso_cap_side *side;
    int64_t sides, side_capacity;
    int32_t *first;
    int64_t loops, loop_capacity;
    iso_vec3 middle;
} half;

static bool is_kept(const half *h, int32_t v) {
    double z = h->mesh->position[v].z;
    return h->lower ? z < h->z : z > h->z;
}

static bool dart_starts_kept(const half *h, int32_t a) {
    return is_kept(h, h->mesh->origin[a]);
}

static bool dart_ends_kept(const half *h, int32_t a) {
    return is_kept(h, h->mesh->origin[iso_mesh_alpha(a)]);
}

static iso_status new_vertex(int32_t *vertex, half *h, iso_vec3 at) {
    iso_mesh *mesh = &h->to.mesh;
    ISO_TRY(ISO_GROW(mesh->position, h->to.position_capacity, (int64_t)mesh->vertex_count + 1));
    *vertex = mesh->vertex_count++;
    mesh->position[*vertex] = at;
    return ISO_OK;
}

static iso_status number_of(int32_t *vertex, half *h, int32_t v) {
    if (h->number[v] < 0)
        ISO_TRY(new_vertex(&h->number[v], h, h->mesh->position[v]));
    *vertex = h->number[v];
    return ISO_OK;
}

/* The vertex on the plane of an edge with one kept end; computed upwards, so that both triangles
 * and both halves have the same one. */
static iso_status end_of(int32_t *vertex, half *h, int32_t a) {
    const iso_mesh *mesh = h->mesh;
    int32_t u = mesh->origin[a], w = mesh->origin[iso_mesh_alpha(a)];
    int32_t other = is_kept(h, u) ? w : u;
    if (mesh->position[other].z == h->z)
        return number_of(vertex, h, other);
    if (h->end[a] < 0) {
        iso_vec3 p = mesh->position[u], q = mesh->position[w], swap;
        if (p.z > q.z)
            swap = p, p = q, q = swap;
        double t = (h->z - p.z) / (q.z - p.z);
        iso_vec3 at = {p.x + t * (q.x - p.x), p.y + t * (q.y - p.y), h->z};
        ISO_TRY(new_vertex(&h->end[a], h, at));
        h->end[mesh->opposite[a]] = h->end[a];
    }
    *vertex = h->end[a];
    return ISO_OK;
}

static iso_status add_triangle(half *h, int32_t a, int32_t b, int32_t c) {
    iso_mesh *mesh = &h->to.mesh;
    int32_t dart = 3 * mesh->triangle_count++;
    ISO_TRY(ISO_GROW(mesh->origin, h->to.origin_capacity, (int64_t)dart + 3));
    ISO_TRY(ISO_GROW(mesh->opposite, h->to.opposite_capacity, (int64_t)dart + 3));
    mesh->origin[dart] = a, mesh->origin[dart + 1] = b, mesh->origin[dart + 2] = c;
    mesh->opposite[dart] = mesh->opposite[dart + 1] = mesh->opposite[dart + 2] = -1;
    return ISO_OK;
}

/* Corner 0 is the kept one, or 0 and 1 are; d are the darts from the corners on. */
static iso_status cut_triangle(half *h, int32_t t, const int32_t *d, bool two) {
    int32_t u, v, p, q, dart = 3 * h->to.mesh.triangle_count;
    ISO_TRY(number_of(&u, h, h->mesh->origin[d[0]]));
    ISO_TRY(end_of(&q, h, d[2]));
    if (!two) {
        ISO_TRY(end_of(&p, h, d[0]));
        h->along[d[0]] = dart;
        h->chord[t] = dart + 1;
        h->along[d[2]] = dart + 2;
        return add_triangle(h, u, p, q);
    }
    ISO_TRY(number_of(&v, h, h->mesh->origin[d[1]]));
    ISO_TRY(end_of(&p, h, d[1]));
    h->along[d[0]] = dart;
    h->along[d[1]] = dart + 1;
    h->along[d[2]] = dart + 2;
    ISO_TRY(add_triangle(h, u, v, p));
    if (p == q)
        return ISO_OK;
    h->chord[t] = dart + 4;
    h->along[d[2]] = dart + 5;
    ISO_TRY(add_triangle(h, u, p, q));
    h->to.mesh.opposite[dart + 2] = dart + 3;
    h->to.mesh.opposite[dart + 3] = dart + 2;
    return ISO_OK;
}

static iso_status keep_triangle(half *h, int32_t t) {
    int32_t v[3];
    for (int k = 0; k < 3; k++) {
        ISO_TRY(number_of(&v[k], h, h->mesh->origin[3 * t + k]));
        h->along[3 * t + k] = 3 * h->to.mesh.triangle_count + k;
    }
    return add_triangle(h, v[0], v[1], v[2]);
}

static iso_status cut_triangles(half *h) {
    for (int32_t t = 0; t < h->mesh->triangle_count; t++) {
        int kept = 0;
        for (int k = 0; k < 3; k++)
            kept += dart_starts_kept(h, 3 * t + k);
        if (kept == 3)
            ISO_TRY(keep_triangle(h, t));
        if (kept == 0 || kept == 3)
            continue;
        int32_t a = 3 * t; /* the first kept corner behind one that isn't */
        while (!dart_starts_kept(h, a) || dart_starts_kept(h, iso_mesh_alpha_inverse(a)))
            a++;
        int32_t b = iso_mesh_alpha(a), d[3] = {a, b, iso_mesh_alpha(b)};
        ISO_TRY(cut_triangle(h, t, d, kept == 2));
    }
    for (int64_t a = 0; a < 3 * (int64_t)h->mesh->triangle_count; a++)
        if (h->along[a] >= 0)
            h->to.mesh.opposite[h->along[a]] = h->along[h->mesh->opposite[a]];
    return ISO_OK;
}

/* The lower half's cap is seen from above, the upper one's from below. */
static iso_status add_side(half *h, int32_t chord) {
    ISO_TRY(ISO_GROW(h->side, h->side_capacity, h->sides + 1));
    int32_t v = h->to.mesh.origin[iso_mesh_alpha(chord)];
    iso_vec3 p = h->to.mesh.position[v];
    int32_t x = iso_units(p.x - h->middle.x), y = iso_units(p.y - h->middle.y);
    h->side[h->sides++] = (iso_cap_side){v, chord, {x, h->lower ? y : -y}};
    return ISO_OK;
}

/* Chords run p q with the kept part on their left; a cap's sides run q p, and go on where the
 * triangle across the edge of p has its q. */
static iso_status trace(half *h, int32_t t) {
    ISO_TRY(ISO_GROW(h->first, h->loop_capacity, h->loops + 2));
    h->first[h->loops++] = (int32_t)h->sides;
    for (int32_t start = t;;) {
        int32_t a = 3 * t;
        while (!dart_starts_kept(h, a) || dart_ends_kept(h, a))
            a++;
        if (h->chord[t] >= 0)
            ISO_TRY(add_side(h, h->chord[t]));
        h->chord[t] = -1;
        t = h->mesh->opposite[a] / 3;
        if (t == start)
            break;
    }
    h->first[h->loops] = (int32_t)h->sides;
    return ISO_OK;
}

static iso_status close_cut(half *h) {
    for (int32_t t = 0; t < h->mesh->triangle_count; t++)
        if (h->chord[t] >= 0)
            ISO_TRY(trace(h, t));
    return h->loops > 0 ? cap_loops(&h->to, h->side, h->first, (int32_t)h->loops) : ISO_OK;
}

static void find_box(iso_mesh *mesh) {
    mesh->min = (iso_vec3){INFINITY, INFINITY, INFINITY};
    mesh->max = (iso_vec3){-INFINITY, -INFINITY, -INFINITY};
    for (int32_t v = 0; v < mesh->vertex_count; v++) {
        iso_vec3 p = mesh->position[v], low = mesh->min, high = mesh->max;
        mesh->min = (iso_vec3){fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z)};
        mesh->max = (iso_vec3){fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z)};
    }
}

static iso_status allocate(half *h) {
    int64_t darts = 3 * (int64_t)h->mesh->triangle_count;
    ISO_TRY(ISO_ALLOCATE(h->number, h->mesh->vertex_count));
    ISO_TRY(ISO_ALLOCATE(h->end, darts));
    ISO_TRY(ISO_ALLOCATE(h->along, darts));
    ISO_TRY(ISO_ALLOCATE(h->chord, h->mesh->triangle_count));
    memset(h->number, 0xff, (size_t)h->mesh->vertex_count * sizeof *h->number);
    memset(h->end, 0xff, (size_t)darts * sizeof *h->end);
    memset(h->along, 0xff, (size_t)darts * sizeof *h->along);
    memset(h->chord, 0xff, (size_t)h->mesh->triangle_count * sizeof *h->chord);
    return ISO_OK;
}

static iso_status make_half(iso_mesh *out, const iso_mesh *mesh, double z, bool lower) {
    half h = {.mesh = mesh, .z = z, .lower = lower};
    h.middle = (iso_vec3){(mesh->min.x + mesh->max.x) / 2, (mesh->min.y + mesh->max.y) / 2, 0};
    iso_status status = allocate(&h);
    if (status == ISO_OK)
        status = cut_triangles(&h);
    if (status == ISO_OK)
        status = close_cut(&h);
    iso_release(h.number);
    iso_release(h.end);
    iso_release(h.along);
    iso_release(h.chord);
    iso_release(h.side);
    iso_release(h.first);
    if (status == ISO_OK && h.to.mesh.triangle_count > 0) {
        *out = h.to.mesh;
        find_box(out);
        out->defects.triangles_read = out->triangle_count;
        return ISO_OK;
    }
    iso_mesh_free(&h.to.mesh);
    return status;
}

iso_status iso_mesh_cut(iso_mesh *lower, iso_mesh *upper, const iso_mesh *mesh, double z) {
    const double limit = 2 * (double)ISO_COORDINATE_MAX / ISO_UNITS_PER_MM - 1;
    if (lower)
        *lower = (iso_mesh){0};
    if (upper)
        *upper = (iso_mesh){0};
    if (z - z != 0)
        return iso_fail(ISO_USAGE, "a model can't be cut at a height that isn't finite");
    if (mesh->triangle_count == 0)
        return ISO_OK;
    if (mesh->max.x - mesh->min.x > limit || mesh->max.y - mesh->min.y > limit)
        return iso_fail(ISO_OUTSIDE, "the model is %g x %g mm, too large to be cut",
                        mesh->max.x - mesh->min.x, mesh->max.y - mesh->min.y);
    if (lower)
        ISO_TRY(make_half(lower, mesh, z, true));
    iso_status status = upper ? make_half(upper, mesh, z, false) : ISO_OK;
    if (status != ISO_OK && lower)
        iso_mesh_free(lower);
    return status;
}

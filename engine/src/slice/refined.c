#include "slice/refined.h"

#include "base/vector.h"

/* More faces than this, and than so many of each that there was, are a field that no print can
 * follow: 1 GB. */
enum { FACES_MAX = 10000000, FACES_A_FACE = 8 };

static int finite(double x) {
    return x - x == 0;
}

/* Values of the vertices from `first` on. */
static iso_status evaluate(refined *r, int32_t first) {
    int32_t count = r->vertex_count - first;
    ISO_TRY(ISO_GROW(r->value, r->vertex_capacity[1], r->vertex_count));
    ISO_TRY(ISO_GROW(r->gradient, r->vertex_capacity[2], r->vertex_count));
    iso_field_evaluate(r->value + first, r->gradient + first, r->field, r->position + first, count);
    for (int32_t v = first; v < r->vertex_count; v++)
        if (!finite(r->value[v])) {
            iso_vec3 p = r->position[v];
            return iso_fail(ISO_UNSLICEABLE,
                            "the field has no value at (%.4f, %.4f, %.4f) mm of the model", p.x,
                            p.y, p.z);
        }
    return ISO_OK;
}

iso_status refined_begin(refined *r, const iso_mesh *mesh, const iso_field *field) {
    *r = (refined){.mesh = mesh,
                   .field = field,
                   .triangle_count = mesh->triangle_count,
                   .vertex_count = mesh->vertex_count,
                   .origin = mesh->origin,
                   .opposite = mesh->opposite,
                   .position = mesh->position};
    ISO_TRY(evaluate(r, 0));
    ISO_TRY(ISO_GROW(r->settled, r->face_capacity[0], r->triangle_count));
    memset(r->settled, 0, (size_t)r->triangle_count);
    return ISO_OK;
}

void refined_free(refined *r) {
    iso_release(r->value);
    iso_release(r->gradient);
    iso_release(r->own_origin);
    iso_release(r->own_opposite);
    iso_release(r->middle);
    iso_release(r->parent_of);
    iso_release(r->settled);
    iso_release(r->own_position);
    iso_release(r->parent);
    *r = (refined){0};
}

/* ---- room ---- */

static iso_status grow_faces(refined *r, int64_t count) {
    int32_t before = r->own_origin ? r->triangle_count : 0;
    if (count > FACES_MAX &&
        (count > FACES_A_FACE * (int64_t)r->mesh->triangle_count || count > INT32_MAX / 3))
        return iso_fail(ISO_OUTSIDE,
                        "the field is too wild for the model: %lld faces are not enough",
                        (long long)r->triangle_count);
    ISO_TRY(ISO_GROW(r->own_origin, r->dart_capacity[0], 3 * count));
    ISO_TRY(ISO_GROW(r->own_opposite, r->dart_capacity[1], 3 * count));
    ISO_TRY(ISO_GROW(r->middle, r->dart_capacity[2], 3 * count));
    ISO_TRY(ISO_GROW(r->settled, r->face_capacity[0], count));
    ISO_TRY(ISO_GROW(r->parent_of, r->face_capacity[1], count));
    memset(r->middle + 3 * (int64_t)before, 0, (size_t)(3 * (count - before)) * sizeof *r->middle);
    memset(r->parent_of + before, 0, (size_t)(count - before) * sizeof *r->parent_of);
    return ISO_OK;
}

static void view_own(refined *r) {
    r->origin = r->own_origin;
    r->opposite = r->own_opposite;
    r->position = r->own_position;
}

/* The first edge is split: from here on the arrays are ours. */
static iso_status take_over(refined *r) {
    size_t darts = 3 * (size_t)r->triangle_count;
    ISO_TRY(grow_faces(r, r->triangle_count));
    ISO_TRY(ISO_GROW(r->own_position, r->vertex_capacity[0], r->vertex_count));
    memcpy(r->own_origin, r->mesh->origin, darts * sizeof *r->own_origin);
    memcpy(r->own_opposite, r->mesh->opposite, darts * sizeof *r->own_opposite);
    memcpy(r->own_position, r->mesh->position, (size_t)r->vertex_count * sizeof *r->own_position);
    view_own(r);
    return ISO_OK;
}

/* ---- marks ---- */

static iso_status add_parent(refined *r, int32_t face) {
    if (r->parent_of[face])
        return ISO_OK;
    ISO_TRY(ISO_GROW(r->parent, r->parent_capacity, (int64_t)r->parent_count + 1));
    refined_parent *p = &r->parent[r->parent_count++];
    p->face = face;
    for (int k = 0; k < 3; k++) {
        p->corner[k] = r->origin[3 * face + k];
        p->opposite[k] = r->opposite[3 * face + k];
    }
    r->parent_of[face] = r->parent_count;
    return ISO_OK;
}

iso_status refined_mark(refined *r, int32_t dart) {
    if (!r->own_origin)
        ISO_TRY(take_over(r));
    if (r->middle[dart])
        return ISO_OK;
    int32_t other = r->opposite[dart], vertex = r->vertex_count + r->new_vertices;
    iso_vec3 p = r->position[r->origin[dart]], q = r->position[r->origin[other]];
    ISO_TRY(add_parent(r, dart / 3));
    ISO_TRY(add_parent(r, other / 3));
    ISO_TRY(ISO_GROW(r->own_position, r->vertex_capacity[0], (int64_t)vertex + 1));
    r->position = r->own_position;
    r->own_position[vertex] = vec3_times(vec3_plus(p, q), 0.5);
    r->middle[dart] = r->middle[other] = vertex + 1;
    r->new_vertices++;
    return ISO_OK;
}

/* ---- splitting ---- */

static void set_face(refined *r, int32_t face, int32_t a, int32_t b, int32_t c) {
    r->own_origin[3 * face] = a;
    r->own_origin[3 * face + 1] = b;
    r->own_origin[3 * face + 2] = c;
}

static void glue(refined *r, int32_t a, int32_t b) {
    r->own_opposite[a] = b;
    r->own_opposite[b] = a;
}

static double distance(const refined *r, int32_t a, int32_t b) {
    return vec3_distance(r->position[a], r->position[b]);
}

/* Edge k: faces (A, M, C) and (M, B, C), in the parent's place f and in g. */
static void split_one(refined *r, refined_parent *p, int k, int32_t f, int32_t g) {
    int l = (k + 1) % 3, n = (k + 2) % 3;
    int32_t a = p->corner[k], b = p->corner[l], c = p->corner[n], m = p->middle[k];
    set_face(r, f, a, m, c);
    set_face(r, g, m, b, c);
    glue(r, 3 * f + 1, 3 * g + 2);
    p->half[k][0] = 3 * f, p->half[k][1] = 3 * g;
    p->half[l][0] = 3 * g + 1;
    p->half[n][0] = 3 * f + 2;
}

/* Edges k and the next one: the corner B between them is cut off, the square A, M, N, C that is
 * left is cut along its shorter diagonal. */
static void split_two(refined *r, refined_parent *p, int k, int32_t f, int32_t g) {
    int l = (k + 1) % 3, o = (k + 2) % 3;
    int32_t a = p->corner[k], b = p->corner[l], c = p->corner[o];
    int32_t m = p->middle[k], n = p->middle[l], h = g + 1;
    set_face(r, f, m, b, n);
    p->half[k][1] = 3 * f;
    p->half[l][0] = 3 * f + 1;
    p->half[k][0] = 3 * g;
    if (distance(r, a, n) <= distance(r, m, c)) {
        set_face(r, g, a, m, n);
        set_face(r, h, a, n, c);
        glue(r, 3 * f + 2, 3 * g + 1);
        glue(r, 3 * g + 2, 3 * h);
        p->half[l][1] = 3 * h + 1;
        p->half[o][0] = 3 * h + 2;
    } else {
        set_face(r, g, a, m, c);
        set_face(r, h, m, n, c);
        glue(r, 3 * f + 2, 3 * h);
        glue(r, 3 * g + 1, 3 * h + 2);
        p->half[l][1] = 3 * h + 1;
        p->half[o][0] = 3 * g + 2;
    }
}

/* All edges: the corners are cut off, the middle takes the parent's place. */
static void split_three(refined *r, refined_parent *p, int32_t f, int32_t g) {
    set_face(r, f, p->middle[0], p->middle[1], p->middle[2]);
    for (int k = 0; k < 3; k++) {
        int before = (k + 2) % 3;
        int32_t face = g + k;
        set_face(r, face, p->corner[k], p->middle[k], p->middle[before]);
        glue(r, 3 * face + 1, 3 * f + before);
        p->half[k][0] = 3 * face;
        p->half[before][1] = 3 * face + 2;
    }
}

/* Returns how many faces were appended. */
static int split_face(refined *r, refined_parent *p, int32_t next) {
    int count = 0, unsplit = 0, split = 0;
    for (int k = 0; k < 3; k++)
        if (p->middle[k] >= 0)
            count++, split = k;
        else
            unsplit = k;
    if (count == 1)
        split_one(r, p, split, p->face, next);
    else if (count == 2)
        split_two(r, p, (unsplit + 1) % 3, p->face, next);
    else
        split_three(r, p, p->face, next);
    return count;
}

/* What runs along the parent's edges meets what runs along them on their other sides. */
static void glue_parent(refined *r, const refined_parent *p) {
    for (int k = 0; k < 3; k++) {
        int32_t b = p->opposite[k], other = r->parent_of[b / 3];
        const refined_parent *q = other ? &r->parent[other - 1] : NULL;
        if (p->middle[k] >= 0) {
            r->own_opposite[p->half[k][0]] = q->half[b % 3][1];
            r->own_opposite[p->half[k][1]] = q->half[b % 3][0];
        } else if (q) {
            r->own_opposite[p->half[k][0]] = q->half[b % 3][0];
        } else {
            glue(r, p->half[k][0], b);
        }
    }
}

static iso_status queue_add(refined_queue *queue, int32_t face) {
    ISO_TRY(ISO_GROW(queue->face, queue->capacity, queue->count + 1));
    queue->face[queue->count++] = face;
    return ISO_OK;
}

/* Middles are read off the darts before any face changes. Returns how many faces there will be. */
static int64_t count_faces(refined *r) {
    int64_t faces = r->triangle_count;
    for (int32_t i = 0; i < r->parent_count; i++) {
        refined_parent *p = &r->parent[i];
        for (int k = 0; k < 3; k++) {
            int32_t *middle = &r->middle[3 * p->face + k];
            p->middle[k] = *middle - 1;
            faces += *middle > 0;
            *middle = 0;
        }
    }
    return faces;
}

iso_status refined_split(refined *r, refined_queue *queue) {
    int64_t faces = count_faces(r);
    int32_t next = r->triangle_count, vertices = r->vertex_count;
    ISO_TRY(grow_faces(r, faces));
    view_own(r);
    for (int32_t i = 0; i < r->parent_count; i++) {
        refined_parent *p = &r->parent[i];
        int added = split_face(r, p, next);
        memset(r->settled + next, r->settled[p->face], (size_t)added);
        if (!r->settled[p->face])
            ISO_TRY(queue_add(queue, p->face));
        for (int k = 0; k < added; k++)
            if (!r->settled[p->face])
                ISO_TRY(queue_add(queue, next + k));
        next += added;
    }
    for (int32_t i = 0; i < r->parent_count; i++)
        glue_parent(r, &r->parent[i]);
    for (int32_t i = 0; i < r->parent_count; i++)
        r->parent_of[r->parent[i].face] = 0;
    r->triangle_count = next;
    r->vertex_count += r->new_vertices;
    r->parent_count = r->new_vertices = 0;
    return evaluate(r, vertices);
}

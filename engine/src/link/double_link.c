/* Double-links from faces, meshes and square-links. */
#include "link/multilink.h"

#include "base/memory.h"

/* Scratch of one construction; everything is [darts] unless said. */
typedef struct builder {
    const iso_faces *faces;
    iso_arena arena;
    int32_t darts;
    int32_t rim, loops; /* boundary darts, and the loops they form */
    int32_t *face;
    int32_t *opposite; /* -1 - k at boundary dart k until the rim is closed; then [darts + 3 rim] */
    int32_t *order;    /* darts by edge */
    int32_t *loop;     /* [rim] */
    double *centre;    /* [loops * dimension] */
} builder;

static int32_t first_of(const iso_faces *faces, int32_t face) {
    return faces->first ? faces->first[face] : 3 * face;
}

static int32_t next_of(const builder *b, int32_t dart) {
    int32_t face = b->face[dart];
    return dart + 1 < first_of(b->faces, face + 1) ? dart + 1 : first_of(b->faces, face);
}

static int32_t previous_of(const builder *b, int32_t dart) {
    int32_t face = b->face[dart];
    return dart > first_of(b->faces, face) ? dart - 1 : first_of(b->faces, face + 1) - 1;
}

static int32_t end_of(const builder *b, int32_t dart) {
    return b->faces->vertex[next_of(b, dart)];
}

static iso_status check_counts(const iso_faces *faces) {
    if (faces->face_count < 0 || faces->vertex_count < 0 || faces->dimension < 0 ||
        faces->dimension > ISO_LINK_DIMENSION_MAX)
        return iso_fail(ISO_USAGE, "%d faces of %d vertices in dimension %d", faces->face_count,
                        faces->vertex_count, faces->dimension);
    if (faces->dimension > 0 && faces->vertex_count > 0 && !faces->position)
        return iso_fail(ISO_USAGE, "faces in dimension %d without positions", faces->dimension);
    if (!faces->first)
        return faces->face_count <= INT32_MAX / 3
                   ? ISO_OK
                   : iso_fail(ISO_OUTSIDE, "%d triangles have more than 2^31 - 1 corners",
                              faces->face_count);
    if (faces->first[0] != 0)
        return iso_fail(ISO_USAGE, "the first face begins at corner %d, not at 0", faces->first[0]);
    for (int32_t i = 0; i < faces->face_count; i++)
        if (faces->first[i + 1] < faces->first[i] || faces->first[i + 1] - faces->first[i] < 3)
            return iso_fail(ISO_USAGE, "face %d has %lld corners; a polygon has 3 or more", i,
                            (long long)faces->first[i + 1] - faces->first[i]);
    return ISO_OK;
}

static iso_status check_corners(const builder *b) {
    const iso_faces *faces = b->faces;
    for (int32_t a = 0; a < b->darts; a++)
        if (faces->vertex[a] < 0 || faces->vertex[a] >= faces->vertex_count)
            return iso_fail(ISO_USAGE, "face %d has vertex %d; vertices are 0 .. %d", b->face[a],
                            faces->vertex[a], faces->vertex_count - 1);
    for (int32_t a = 0; a < b->darts; a++)
        if (faces->vertex[a] == end_of(b, a))
            return iso_fail(ISO_USAGE, "face %d has vertex %d twice in a row", b->face[a],
                            faces->vertex[a]);
    return ISO_OK;
}

static int32_t key_of(const builder *b, int32_t dart, int upper) {
    int32_t x = b->faces->vertex[dart], y = end_of(b, dart);
    return (x > y) == upper ? x : y;
}

/* Stable counting sort of the darts in `from` by the lower or the upper vertex of their edge. */
static void sort_darts(int32_t *to, const int32_t *from, int32_t *count, const builder *b,
                       int upper) {
    memset(count, 0, ((size_t)b->faces->vertex_count + 1) * sizeof *count);
    for (int32_t a = 0; a < b->darts; a++)
        count[key_of(b, a, upper) + 1]++;
    for (int32_t v = 0; v < b->faces->vertex_count; v++)
        count[v + 1] += count[v];
    for (int32_t i = 0; i < b->darts; i++)
        to[count[key_of(b, from[i], upper)]++] = from[i];
}

static iso_status sort_by_edge(builder *b) {
    int32_t *count, *spare;
    ISO_TRY(ISO_PUSH(b->order, &b->arena, b->darts));
    iso_arena_mark mark = iso_arena_get_mark(&b->arena);
    ISO_TRY(ISO_PUSH(count, &b->arena, (int64_t)b->faces->vertex_count + 1));
    ISO_TRY(ISO_PUSH(spare, &b->arena, b->darts));
    for (int32_t a = 0; a < b->darts; a++)
        b->order[a] = a;
    sort_darts(spare, b->order, count, b, 1);
    sort_darts(b->order, spare, count, b, 0);
    iso_arena_pop(&b->arena, mark);
    return ISO_OK;
}

static int same_edge(const builder *b, int32_t x, int32_t y) {
    return key_of(b, x, 0) == key_of(b, y, 0) && key_of(b, x, 1) == key_of(b, y, 1);
}

/* Each edge has one dart either way, or is part of the boundary. More than two faces at an edge
 * need geometry to be paired: meshes are mended before they come here. */
static iso_status pair_darts(builder *b) {
    const int32_t *vertex = b->faces->vertex;
    for (int32_t i = 0, end; i < b->darts; i = end) {
        int32_t x = b->order[i];
        for (end = i + 1; end < b->darts && same_edge(b, x, b->order[end]);)
            end++;
        if (end - i == 1) {
            b->opposite[x] = -1;
            continue;
        }
        int32_t y = b->order[i + 1];
        if (end - i > 2 || vertex[x] == vertex[y])
            return iso_fail(ISO_USAGE,
                            "%d faces share the edge from vertex %d to %d, among them %d and %d%s",
                            end - i, vertex[x], end_of(b, x), b->face[x], b->face[y],
                            end - i == 2 ? " with the same direction: turn one" : "");
        b->opposite[x] = y;
        b->opposite[y] = x;
    }
    for (int32_t a = 0; a < b->darts; a++)
        if (b->opposite[a] < 0)
            b->opposite[a] = -1 - b->rim++;
    return ISO_OK;
}

static iso_status refuse_rim(const builder *b) {
    for (int32_t a = 0; a < b->darts; a++)
        if (b->opposite[a] < 0)
            return iso_fail(ISO_USAGE,
                            "face %d has no neighbour at its edge from vertex %d to %d (%d edges "
                            "are open): close the surface, or ask for ISO_BOUNDARY_FANNED",
                            b->face[a], b->faces->vertex[a], end_of(b, a), b->rim);
    return ISO_OK;
}

/* The boundary dart that ends where `dart` starts, around the same hole: turn about that vertex
 * through the faces between the two. */
static int32_t rim_before(const builder *b, int32_t dart) {
    int32_t before = previous_of(b, dart);
    while (b->opposite[before] >= 0)
        before = previous_of(b, b->opposite[before]);
    return before;
}

static iso_status find_loops(builder *b) {
    int n = b->faces->dimension;
    ISO_TRY(ISO_PUSH(b->loop, &b->arena, b->rim));
    ISO_TRY(ISO_PUSH(b->centre, &b->arena, (int64_t)b->rim * n));
    for (int32_t k = 0; k < b->rim; k++)
        b->loop[k] = -1;
    for (int32_t a = 0; a < b->darts; a++) {
        if (b->opposite[a] >= 0 || b->loop[-1 - b->opposite[a]] >= 0)
            continue;
        double *centre = b->centre + (int64_t)b->loops * n;
        int32_t count = 0;
        for (int k = 0; k < n; k++)
            centre[k] = 0;
        for (int32_t c = a; b->loop[-1 - b->opposite[c]] < 0; c = rim_before(b, c)) {
            b->loop[-1 - b->opposite[c]] = b->loops;
            const double *at = n ? b->faces->position + (int64_t)b->faces->vertex[c] * n : NULL;
            for (int k = 0; k < n; k++)
                centre[k] += at[k];
            count++;
        }
        for (int k = 0; k < n; k++)
            centre[k] /= count;
        b->loops++;
    }
    return ISO_OK;
}

/* Boundary dart k, from u to w, gets the triangle w u x with the darts e, e + 1, e + 2 for
 * e = darts + 3 k; its edge u x is shared with the triangle of the boundary dart before it. */
static iso_status fan_out(builder *b) {
    int32_t *opposite;
    ISO_TRY(ISO_PUSH(opposite, &b->arena, (int64_t)b->darts + 3 * (int64_t)b->rim));
    for (int32_t a = 0; a < b->darts; a++) {
        opposite[a] = b->opposite[a];
        if (opposite[a] >= 0)
            continue;
        int32_t e = b->darts + 3 * (-1 - b->opposite[a]);
        int32_t before = b->darts + 3 * (-1 - b->opposite[rim_before(b, a)]);
        opposite[a] = e;
        opposite[e] = a;
        opposite[e + 1] = before + 2;
        opposite[before + 2] = e + 1;
    }
    b->opposite = opposite;
    return ISO_OK;
}

static iso_status prepare(builder *b, iso_boundary boundary) {
    ISO_TRY(check_counts(b->faces));
    b->darts = first_of(b->faces, b->faces->face_count);
    ISO_TRY(ISO_PUSH(b->face, &b->arena, b->darts));
    for (int32_t i = 0; i < b->faces->face_count; i++)
        for (int32_t a = first_of(b->faces, i); a < first_of(b->faces, i + 1); a++)
            b->face[a] = i;
    ISO_TRY(check_corners(b));
    ISO_TRY(sort_by_edge(b));
    ISO_TRY(ISO_PUSH(b->opposite, &b->arena, b->darts));
    ISO_TRY(pair_darts(b));
    if (b->rim > 0 && boundary == ISO_BOUNDARY_REFUSED)
        return refuse_rim(b);
    if (b->darts + 3 * (int64_t)b->rim > INT32_MAX)
        return iso_fail(ISO_OUTSIDE, "a surface of more than 2^31 - 1 corners");
    ISO_TRY(find_loops(b));
    return b->rim > 0 ? fan_out(b) : ISO_OK;
}

static void fill_fans(const builder *b, int32_t *alpha, int32_t *f, int32_t *v) {
    for (int32_t a = 0; a < b->darts; a++) {
        int32_t e = b->opposite[a];
        if (e < b->darts)
            continue;
        int32_t k = (e - b->darts) / 3;
        for (int i = 0; i < 3; i++) {
            alpha[e + i] = i < 2 ? e + i + 1 : e;
            f[e + i] = b->faces->face_count + k;
        }
        v[e] = end_of(b, a);
        v[e + 1] = b->faces->vertex[a];
        v[e + 2] = b->faces->vertex_count + b->loop[k];
    }
}

static void fill_geometry(const builder *b, double *g, const int32_t *v, int32_t size) {
    int n = b->faces->dimension;
    if (n == 0)
        return;
    for (int32_t a = 0; a < size; a++) {
        int64_t beyond = (int64_t)v[a] - b->faces->vertex_count;
        const double *from =
            beyond < 0 ? b->faces->position + (int64_t)v[a] * n : b->centre + beyond * n;
        memcpy(g + (int64_t)a * n, from, (size_t)n * sizeof *g);
    }
}

/* Faces of one and the same degree need neither α nor f as arrays. */
static void make_implicit(iso_multilink *made, const iso_faces *faces, int has_fans) {
    int32_t degree = faces->face_count > 0 ? first_of(faces, 1) : 3;
    for (int32_t i = 0; i < faces->face_count; i++)
        if (first_of(faces, i + 1) - first_of(faces, i) != degree)
            return;
    if (made->size == 0 || (has_fans && degree != 3))
        return;
    iso_release((void *)made->map[0].image);
    iso_release((void *)made->projection[0].image);
    iso_map_step(&made->map[0], ISO_MAP_CYCLIC, 1, degree, made->size);
    iso_map_step(&made->projection[0], ISO_MAP_COORDINATE, degree, made->size / degree,
                 made->size / degree);
}

static iso_status assemble(iso_multilink *made, const builder *b) {
    int32_t *alpha = iso_map_allocate(&made->map[0], made->size, made->size);
    int32_t *beta = iso_map_allocate(&made->map[1], made->size, made->size);
    int32_t *f = iso_map_allocate(&made->projection[0], made->size, b->faces->face_count + b->rim);
    int32_t *v =
        iso_map_allocate(&made->projection[1], made->size, b->faces->vertex_count + b->loops);
    double *g = iso_multilink_allocate_g(made);
    if (!alpha || !beta || !f || !v || !g)
        return ISO_NO_MEMORY;
    for (int32_t a = 0; a < b->darts; a++) {
        alpha[a] = next_of(b, a);
        f[a] = b->face[a];
        v[a] = b->faces->vertex[a];
    }
    fill_fans(b, alpha, f, v);
    for (int32_t a = 0; a < made->size; a++)
        beta[alpha[a]] = b->opposite[a];
    fill_geometry(b, g, v, made->size);
    make_implicit(made, b->faces, b->rim > 0);
    return ISO_OK;
}

iso_status iso_double_link_from_faces(iso_double_link *out, const iso_faces *faces,
                                      iso_boundary boundary) {
    builder b = {.faces = faces};
    out->link = (iso_multilink){0};
    iso_status status = prepare(&b, boundary);
    if (status == ISO_OK) {
        iso_multilink made =
            iso_multilink_begin(ISO_KIND_DOUBLE_LINK, b.darts + 3 * b.rim, faces->dimension);
        status = iso_multilink_finish(&out->link, &made, assemble(&made, &b));
    }
    iso_arena_free(&b.arena);
    return status;
}

iso_status iso_double_link_from_mesh(iso_double_link *out, const iso_mesh *mesh) {
    out->link = (iso_multilink){0};
    int32_t size = 3 * mesh->triangle_count;
    iso_multilink made = iso_multilink_begin(ISO_KIND_DOUBLE_LINK, size, 3);
    iso_map_step(&made.map[0], ISO_MAP_CYCLIC, 1, 3, size);
    int32_t *beta = iso_map_allocate(&made.map[1], size, size);
    int32_t faces = mesh->triangle_count > 0 ? mesh->triangle_count : 1;
    iso_map_step(&made.projection[0], ISO_MAP_COORDINATE, 3, faces, faces);
    int32_t *v = iso_map_allocate(&made.projection[1], size, mesh->vertex_count);
    double *g = iso_multilink_allocate_g(&made);
    int complete = beta && v && g;
    for (int32_t a = 0; complete && a < size; a++) {
        beta[iso_mesh_alpha(a)] = mesh->opposite[a];
        v[a] = mesh->origin[a];
        const iso_vec3 *at = &mesh->position[v[a]];
        double place[3] = {at->x, at->y, at->z};
        memcpy(g + 3 * (int64_t)a, place, sizeof place);
    }
    return iso_multilink_finish(&out->link, &made, complete ? ISO_OK : ISO_NO_MEMORY);
}

/* The squares of a square-link as faces: first and vertex have room for all of them. */
static int32_t list_squares(int32_t *first, int32_t *vertex, const iso_multilink *from) {
    int32_t faces = 0;
    for (int32_t a = 0; a < from->size; a++) {
        int32_t right = iso_map_at(&from->map[0], a), up = iso_map_at(&from->map[1], a);
        if (right == a || up == a)
            continue;
        int32_t corner[4] = {a, right, iso_map_at(&from->map[0], up), up};
        memcpy(vertex + 4 * faces, corner, sizeof corner);
        first[faces] = 4 * faces;
        faces++;
    }
    first[faces] = 4 * faces;
    return faces;
}

iso_status iso_double_link_from_square_link(iso_double_link *out,
                                            const iso_square_link *square_link,
                                            iso_boundary boundary) {
    const iso_multilink *from = &square_link->link;
    int32_t *first = NULL, *vertex = NULL;
    out->link = (iso_multilink){0};
    ISO_TRY(iso_multilink_validate(from));
    if (from->size > INT32_MAX / 4)
        return iso_fail(ISO_OUTSIDE, "a surface of more than 2^31 - 1 corners");
    iso_status status = ISO_ALLOCATE(first, (int64_t)from->size + 1);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(vertex, 4 * (int64_t)from->size);
    if (status == ISO_OK) {
        iso_faces faces = {.vertex_count = from->size,
                           .first = first,
                           .vertex = vertex,
                           .dimension = from->dimension,
                           .position = from->g};
        faces.face_count = list_squares(first, vertex, from);
        status = iso_double_link_from_faces(out, &faces, boundary);
    }
    iso_release(first);
    iso_release(vertex);
    return status;
}

iso_status iso_double_link_count(iso_surface_counts *counts, const iso_double_link *surface) {
    int32_t *orbit;
    iso_surface_counts found = {0};
    struct {
        const char *words;
        int32_t *count;
    } row[] = {
        {"α", &found.faces}, {"β", &found.vertices}, {"βα", &found.edges}, {"α β", &found.parts}};
    ISO_TRY(ISO_ALLOCATE(orbit, surface->link.size));
    iso_status status = ISO_OK;
    for (int i = 0; status == ISO_OK && i < 4; i++)
        status = iso_multilink_orbits(orbit, row[i].count, &surface->link, row[i].words);
    iso_release(orbit);
    if (status != ISO_OK)
        return status;
    found.euler = found.vertices - found.edges + found.faces;
    *counts = found;
    return ISO_OK;
}

#include <isoslice/object.h>

#include <math.h>

#include "base/memory.h"
#include "mesh/nesting.h"
#include "mesh/repair.h"

void iso_meshes_free(iso_mesh *mesh, int32_t count) {
    for (int32_t i = 0; mesh && i < count; i++)
        iso_mesh_free(&mesh[i]);
    iso_release(mesh);
}

typedef struct splitter {
    const iso_mesh *mesh;
    int32_t *shell; /* [triangle], later the piece of each */
    int32_t shells;
    double *volume;    /* [shell] */
    int32_t *around;   /* [shell] the shell directly around it, or -1 */
    int32_t *piece_of; /* [shell] */
    int32_t pieces;
    int32_t *first;    /* [pieces + 1] into triangle */
    int32_t *triangle; /* by piece, ascending */
    int32_t *name;     /* [triangle] its number within its piece */
    int32_t *owner;    /* [vertex] the piece that numbered it last, or -1 */
    int32_t *number;   /* [vertex] within that piece */
} splitter;

static void find_volumes(splitter *s) {
    const iso_mesh *mesh = s->mesh;
    double base = (mesh->min.z + mesh->max.z) / 2;
    memset(s->volume, 0, (size_t)s->shells * sizeof *s->volume);
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        iso_vec3 p = mesh->position[mesh->origin[3 * t]];
        iso_vec3 q = mesh->position[mesh->origin[3 * t + 1]];
        iso_vec3 r = mesh->position[mesh->origin[3 * t + 2]];
        double shadow = (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
        s->volume[s->shell[t]] += shadow * ((p.z - base) + (q.z - base) + (r.z - base));
    }
}

/* A cavity belongs to the first shell outwards that isn't one; without any it stands alone. */
static void find_pieces(splitter *s) {
    for (int32_t i = 0; i < s->shells; i++)
        s->piece_of[i] = -1;
    for (int32_t i = 0; i < s->shells; i++) {
        int32_t body = i;
        while (s->volume[body] < 0 && s->around[body] >= 0)
            body = s->around[body];
        if (s->piece_of[body] < 0)
            s->piece_of[body] = s->pieces++;
        s->piece_of[i] = s->piece_of[body];
    }
}

static void sort_triangles(splitter *s) {
    int32_t count = s->mesh->triangle_count;
    memset(s->first, 0, ((size_t)s->pieces + 1) * sizeof *s->first);
    for (int32_t t = 0; t < count; t++) {
        s->shell[t] = s->piece_of[s->shell[t]];
        s->first[s->shell[t] + 1]++;
    }
    for (int32_t i = 0; i < s->pieces; i++)
        s->first[i + 1] += s->first[i];
    for (int32_t t = 0; t < count; t++) {
        int32_t piece = s->shell[t];
        s->triangle[s->first[piece]++] = t;
    }
    for (int32_t i = s->pieces; i > 0; i--)
        s->first[i] = s->first[i - 1];
    s->first[0] = 0;
    for (int32_t i = 0; i < s->pieces; i++)
        for (int32_t k = s->first[i]; k < s->first[i + 1]; k++)
            s->name[s->triangle[k]] = k - s->first[i];
}

/* Numbers the vertices of a piece as they first occur; returns how many there are. */
static int32_t number_vertices(splitter *s, int32_t piece) {
    int32_t count = 0;
    for (int32_t k = s->first[piece]; k < s->first[piece + 1]; k++)
        for (int j = 0; j < 3; j++) {
            int32_t v = s->mesh->origin[3 * s->triangle[k] + j];
            if (s->owner[v] == piece)
                continue;
            s->owner[v] = piece;
            s->number[v] = count++;
        }
    return count;
}

static iso_status copy_piece(iso_mesh *to, splitter *s, int32_t piece) {
    const iso_mesh *mesh = s->mesh;
    int32_t from = s->first[piece], count = s->first[piece + 1] - from;
    int32_t vertices = number_vertices(s, piece);
    ISO_TRY(ISO_ALLOCATE(to->origin, 3 * (int64_t)count));
    ISO_TRY(ISO_ALLOCATE(to->opposite, 3 * (int64_t)count));
    ISO_TRY(ISO_ALLOCATE(to->position, vertices));
    to->triangle_count = count;
    to->vertex_count = vertices;
    to->min = (iso_vec3){INFINITY, INFINITY, INFINITY};
    to->max = (iso_vec3){-INFINITY, -INFINITY, -INFINITY};
    for (int32_t k = 0; k < 3 * count; k++) {
        int32_t a = 3 * s->triangle[from + k / 3] + k % 3, b = mesh->opposite[a];
        iso_vec3 p = mesh->position[mesh->origin[a]];
        to->origin[k] = s->number[mesh->origin[a]];
        to->opposite[k] = 3 * s->name[b / 3] + b % 3;
        to->position[to->origin[k]] = p;
        to->min = (iso_vec3){fmin(to->min.x, p.x), fmin(to->min.y, p.y), fmin(to->min.z, p.z)};
        to->max = (iso_vec3){fmax(to->max.x, p.x), fmax(to->max.y, p.y), fmax(to->max.z, p.z)};
    }
    to->defects.triangles_read = count;
    return ISO_OK;
}

static iso_status split(iso_mesh **piece, splitter *s) {
    int32_t triangles = s->mesh->triangle_count, vertices = s->mesh->vertex_count;
    ISO_TRY(iso_mesh_find_shells(&s->shell, &s->shells, s->mesh));
    ISO_TRY(ISO_ALLOCATE(s->volume, s->shells));
    ISO_TRY(ISO_ALLOCATE(s->around, s->shells));
    ISO_TRY(ISO_ALLOCATE(s->piece_of, s->shells));
    find_volumes(s);
    ISO_TRY(iso_mesh_find_around(s->around, s->mesh, s->shell, s->volume, s->shells));
    find_pieces(s);
    ISO_TRY(ISO_ALLOCATE(s->first, (int64_t)s->pieces + 1));
    ISO_TRY(ISO_ALLOCATE(s->triangle, triangles));
    ISO_TRY(ISO_ALLOCATE(s->name, triangles));
    ISO_TRY(ISO_ALLOCATE(s->owner, vertices));
    ISO_TRY(ISO_ALLOCATE(s->number, vertices));
    for (int32_t v = 0; v < vertices; v++)
        s->owner[v] = -1;
    sort_triangles(s);
    ISO_TRY(ISO_ALLOCATE(*piece, s->pieces));
    memset(*piece, 0, (size_t)s->pieces * sizeof **piece);
    for (int32_t i = 0; i < s->pieces; i++)
        ISO_TRY(copy_piece(&(*piece)[i], s, i));
    for (int32_t i = 0; i < s->shells; i++)
        (*piece)[s->piece_of[i]].defects.shells++;
    return ISO_OK;
}

iso_status iso_mesh_split(iso_mesh **piece, int32_t *count, const iso_mesh *mesh) {
    splitter s = {.mesh = mesh};
    *piece = NULL;
    *count = 0;
    iso_status status = split(piece, &s);
    if (status == ISO_OK) {
        *count = s.pieces;
    } else {
        iso_meshes_free(*piece, *piece ? s.pieces : 0);
        *piece = NULL;
    }
    iso_release(s.shell);
    iso_release(s.volume);
    iso_release(s.around);
    iso_release(s.piece_of);
    iso_release(s.first);
    iso_release(s.triangle);
    iso_release(s.name);
    iso_release(s.owner);
    iso_release(s.number);
    return status;
}

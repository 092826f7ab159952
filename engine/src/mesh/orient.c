#include "mesh/repair.h"

#include "base/memory.h"

/* Across an edge of two darts that run the same way, one of the two triangles is turned. Walk each
 * patch of triangles that are joined by two-dart edges, and turn its minority. */
enum { UNSEEN, AS_IS, TURNED };

typedef struct walker {
    iso_mesh *mesh;
    uint8_t *state;
    int32_t *queue;
    int32_t count;  /* triangles of the queue so far */
    sheets *marks;  /* or NULL */
    bool one_sided; /* the patch at hand */
} walker;

/* opposite[] holds the other dart of each two-dart edge, whichever way it runs. */
static bool join(iso_mesh *mesh, const iso_mesh_edges *edges) {
    bool disagree = false;
    for (int64_t e = 0; e < edges->count; e++) {
        const int32_t *dart = edges->dart + edges->first[e];
        int32_t count = edges->first[e + 1] - edges->first[e];
        for (int32_t i = 0; i < count; i++)
            mesh->opposite[dart[i]] = count == 2 ? dart[1 - i] : -1;
        if (count == 2 && mesh->origin[dart[0]] == mesh->origin[dart[1]])
            disagree = true;
    }
    return disagree;
}

static iso_status visit(walker *w, int32_t triangle) {
    const iso_mesh *mesh = w->mesh;
    for (int32_t a = 3 * triangle; a < 3 * triangle + 3; a++) {
        int32_t b = mesh->opposite[a];
        if (b < 0)
            continue;
        bool turn = mesh->origin[a] == mesh->origin[b];
        uint8_t wanted = turn ? AS_IS + TURNED - w->state[triangle] : w->state[triangle];
        if (w->state[b / 3] == UNSEEN) {
            w->state[b / 3] = wanted;
            w->queue[w->count++] = b / 3;
        } else if (w->state[b / 3] != wanted) {
            iso_vec3 p = mesh->position[mesh->origin[a]];
            w->one_sided = true;
            if (!w->marks)
                return iso_fail(ISO_UNSLICEABLE,
                                "the surface has one side only, like a Moebius strip (seen near "
                                "%g, %g, %g): no orientation of its triangles agrees; "
                                "--sheet-thickness gives it a thickness",
                                p.x, p.y, p.z);
        }
    }
    return ISO_OK;
}

static void mark_patch(walker *w, int32_t begin) {
    for (int32_t i = begin; i < w->count; i++)
        w->marks->mark[w->queue[i]] = 1;
    w->marks->marked += w->count - begin;
}

static void turn(iso_mesh *mesh, int32_t triangle) {
    int32_t *v = mesh->origin + 3 * triangle, swap = v[1];
    v[1] = v[2];
    v[2] = swap;
}

/* The walk compares origins, so nothing is turned before all of the patch is known. */
static iso_status orient_patch(int64_t *turned, walker *w, int32_t first) {
    int32_t begin = w->count;
    w->state[first] = AS_IS;
    w->one_sided = false;
    w->queue[w->count++] = first;
    for (int32_t i = begin; i < w->count; i++)
        ISO_TRY(visit(w, w->queue[i]));
    if (w->one_sided) {
        mark_patch(w, begin);
        return ISO_OK;
    }
    int32_t minority = 0;
    for (int32_t i = begin; i < w->count; i++)
        minority += w->state[w->queue[i]] == TURNED;
    uint8_t state = TURNED;
    if (minority > (w->count - begin) / 2) {
        state = AS_IS;
        minority = w->count - begin - minority;
    }
    for (int32_t i = begin; i < w->count; i++)
        if (w->state[w->queue[i]] == state)
            turn(w->mesh, w->queue[i]);
    *turned += minority;
    return ISO_OK;
}

iso_status iso_mesh_orient(int64_t *turned, iso_mesh *mesh, const iso_mesh_edges *edges,
                           sheets *marks) {
    *turned = 0;
    if (!join(mesh, edges))
        return ISO_OK;
    walker w = {.mesh = mesh, .marks = marks};
    iso_status status = ISO_ALLOCATE(w.state, mesh->triangle_count);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(w.queue, mesh->triangle_count);
    if (status == ISO_OK) {
        memset(w.state, UNSEEN, (size_t)mesh->triangle_count);
        for (int32_t t = 0; t < mesh->triangle_count && status == ISO_OK; t++)
            if (w.state[t] == UNSEEN)
                status = orient_patch(turned, &w, t);
    }
    iso_release(w.state);
    iso_release(w.queue);
    return status;
}

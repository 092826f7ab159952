#include "object/outline.h"

#include "object/cap.h"
#include "planar/hull.h"
#include "planar/predicate.h"

/* Darts of silhouettes beyond which an outline isn't sought: a scan's folds. */
enum { SILHOUETTE_MOST = 20000 };

/* The turns of a thread lie upon each other but for rounding, and every side would cross its
 * likes of every other turn many times. On a grid of 10 um they are the same. */
enum { GRID = 100 };

/* ---- what is covered ---- */

typedef struct sketch {
    const iso_mesh *mesh;
    bool *up;   /* [triangle] seen from above, on the grid */
    bool *done; /* [dart] */
    iso_point *loop;
    int64_t count, capacity;
    int64_t darts; /* of silhouettes */
    iso_region raw;
} sketch;

static int32_t on_grid(double mm) {
    int32_t units = iso_units(mm);
    return (units + (units < 0 ? -GRID / 2 : GRID / 2)) / GRID * GRID;
}

static iso_point seen(const iso_mesh *mesh, int32_t dart) {
    const iso_vec3 *p = &mesh->position[mesh->origin[dart]];
    return (iso_point){on_grid(p->x), on_grid(p->y)};
}

static bool on_silhouette(const sketch *s, int32_t dart) {
    return s->up[dart / 3] && !s->up[s->mesh->opposite[dart] / 3];
}

/* From the end of a silhouette's dart around the vertex, through triangles that face up, to the
 * dart that leaves it. */
static int32_t next_dart(const sketch *s, int32_t dart) {
    int32_t next = iso_mesh_alpha(dart);
    while (!on_silhouette(s, next))
        next = iso_mesh_alpha(s->mesh->opposite[next]);
    return next;
}

/* The border of all triangles that face up winds around a point as often as there are such
 * triangles above it: what it winds around is what is covered, and nothing needs to be united but
 * the silhouettes. */
static iso_status add_silhouettes(sketch *s) {
    const iso_mesh *mesh = s->mesh;
    int64_t darts = 3 * (int64_t)mesh->triangle_count;
    ISO_TRY(ISO_ALLOCATE(s->up, mesh->triangle_count));
    ISO_TRY(ISO_ALLOCATE(s->done, darts));
    memset(s->done, 0, (size_t)darts * sizeof *s->done);
    for (int32_t t = 0; t < mesh->triangle_count; t++)
        s->up[t] = orient2d(seen(mesh, 3 * t), seen(mesh, 3 * t + 1), seen(mesh, 3 * t + 2)) > 0;
    for (int32_t a = 0; a < darts; a++) {
        if (s->done[a] || !on_silhouette(s, a))
            continue;
        s->count = 0;
        for (int32_t b = a; !s->done[b] && s->darts <= SILHOUETTE_MOST; b = next_dart(s, b)) {
            ISO_TRY(ISO_GROW(s->loop, s->capacity, s->count + 1));
            s->loop[s->count++] = seen(mesh, b);
            s->done[b] = true;
            s->darts++;
        }
        ISO_TRY(iso_region_add(&s->raw, s->loop, (int32_t)s->count));
    }
    iso_release(s->up);
    iso_release(s->done);
    s->up = s->done = NULL;
    return ISO_OK;
}

/* Only outer contours that lie in nothing. */
static iso_status drop_holes(iso_region *outline, const iso_region *covered) {
    iso_region_clear(outline);
    for (int32_t c = 0; c < covered->count; c++) {
        int32_t from = covered->first[c];
        if (covered->parent[c] < 0)
            ISO_TRY(iso_region_add(outline, covered->point + from, covered->first[c + 1] - from));
    }
    return ISO_OK;
}

iso_status outline_of(iso_region *outline, const iso_mesh *mesh, int32_t count,
                      iso_planar_scratch *scratch) {
    sketch s = {0};
    iso_region covered = {0};
    iso_status status = ISO_OK;
    iso_region_clear(outline);
    for (int32_t i = 0; i < count && status == ISO_OK; i++) {
        s.mesh = &mesh[i];
        status = add_silhouettes(&s);
    }
    if (status == ISO_OK && s.darts <= SILHOUETTE_MOST)
        status = iso_region_clean(&covered, &s.raw, ISO_FILL_POSITIVE, scratch);
    if (status == ISO_OK)
        status = drop_holes(outline, &covered);
    iso_release(s.up);
    iso_release(s.done);
    iso_release(s.loop);
    iso_region_free(&s.raw);
    iso_region_free(&covered);
    return status;
}

/* ---- convex pieces ---- */

/* Triangles of a polygon, joined while they stay convex (Hertel and Mehlhorn, 1983, in the order of
 * the triangles). */
typedef struct joiner {
    const iso_mesh *mesh;
    const iso_point *at; /* [vertex] */
    bool *taken;         /* [triangle] */
    int32_t *dart;       /* [corners] of the piece, each from one corner to the next */
    int32_t corners;
    bool folded; /* a triangle is turned over */
} joiner;

static iso_point corner(const joiner *j, int32_t i) {
    return j->at[j->mesh->origin[j->dart[(i + j->corners) % j->corners]]];
}

/* Take the triangle across side i in, if the piece stays convex. */
static bool join_across(joiner *j, int32_t i, int32_t least) {
    int32_t other = j->mesh->opposite[j->dart[i]];
    if (other < 3 * least || j->taken[other / 3])
        return false;
    int32_t second = iso_mesh_alpha(other), third = iso_mesh_alpha(second);
    iso_point tip = j->at[j->mesh->origin[third]];
    if (orient2d(corner(j, i - 1), corner(j, i), tip) <= 0 ||
        orient2d(tip, corner(j, i + 1), corner(j, i + 2)) <= 0)
        return false;
    memmove(j->dart + i + 2, j->dart + i + 1, (size_t)(j->corners - i - 1) * sizeof *j->dart);
    j->dart[i] = second;
    j->dart[i + 1] = third;
    j->corners++;
    j->taken[other / 3] = true;
    return true;
}

static iso_status add_hull(iso_region *all, const iso_point *point, int32_t count) {
    iso_point *room;
    ISO_TRY(ISO_ALLOCATE(room, 2 * (int64_t)count + 1));
    memcpy(room, point, (size_t)count * sizeof *point);
    iso_point *hull = room + count;
    iso_status status = iso_region_add(all, hull, hull_of(hull, room, count));
    iso_release(room);
    return status;
}

static iso_status add_piece(iso_region *all, joiner *j, int32_t triangle, int32_t least) {
    j->corners = 3;
    j->taken[triangle] = true;
    for (int k = 0; k < 3; k++)
        j->dart[k] = 3 * triangle + k;
    int64_t area = orient2d(corner(j, 0), corner(j, 1), corner(j, 2));
    j->folded |= area < 0;
    if (area <= 0)
        return ISO_OK;
    for (int32_t i = 0; i < j->corners;)
        i = join_across(j, i, least) ? 0 : i + 1;
    iso_point *point;
    ISO_TRY(ISO_ALLOCATE(point, j->corners));
    for (int32_t i = 0; i < j->corners; i++)
        point[i] = corner(j, i);
    iso_status status = add_hull(all, point, j->corners);
    iso_release(point);
    return status;
}

/* A polygon's sides get darts of triangles that aren't there, for the caps to lie across. */
static iso_status triangulate(iso_growing_mesh *to, const iso_point *point, int32_t count) {
    iso_cap_side *side;
    to->mesh.triangle_count = (count + 2) / 3;
    int64_t darts = 3 * (int64_t)to->mesh.triangle_count;
    ISO_TRY(ISO_GROW(to->mesh.origin, to->origin_capacity, darts));
    ISO_TRY(ISO_GROW(to->mesh.opposite, to->opposite_capacity, darts));
    ISO_TRY(ISO_ALLOCATE(side, count));
    for (int32_t i = 0; i < count; i++)
        side[i] = (iso_cap_side){i, i, point[i]};
    iso_status status = cap_loops(to, side, (int32_t[]){0, count}, 1);
    iso_release(side);
    return status;
}

/* If it can't be triangulated cleanly, its hull will do. */
static iso_status add_pieces(iso_region *all, iso_growing_mesh *room, const iso_point *point,
                             int32_t count) {
    ISO_TRY(triangulate(room, point, count));
    joiner j = {.mesh = &room->mesh, .at = point};
    int32_t least = (count + 2) / 3, before = all->count;
    ISO_TRY(ISO_ALLOCATE(j.taken, room->mesh.triangle_count));
    memset(j.taken, 0, (size_t)room->mesh.triangle_count * sizeof *j.taken);
    iso_status status = ISO_ALLOCATE(j.dart, (int64_t)count + 3);
    for (int32_t t = least; t < room->mesh.triangle_count && status == ISO_OK; t++)
        if (!j.taken[t])
            status = add_piece(all, &j, t, least);
    iso_release(j.taken);
    iso_release(j.dart);
    if (status != ISO_OK || !j.folded)
        return status;
    all->count = before;
    return add_hull(all, point, count);
}

iso_status outline_pieces(iso_pieces *pieces, const iso_region *region) {
    iso_region all = {0};
    iso_growing_mesh room = {0};
    iso_status status = ISO_OK;
    *pieces = (iso_pieces){0};
    for (int32_t c = 0; c < region->count && status == ISO_OK; c++) {
        int32_t from = region->first[c], count = region->first[c + 1] - from;
        if (region->parent[c] < 0)
            status = add_pieces(&all, &room, region->point + from, count);
    }
    iso_mesh_free(&room.mesh);
    iso_release(all.parent);
    if (status == ISO_OK)
        *pieces = (iso_pieces){all.count, all.first, all.point};
    else
        iso_release(all.first), iso_release(all.point);
    return status;
}

void outline_pieces_free(iso_pieces *pieces) {
    iso_release(pieces->first);
    iso_release(pieces->point);
    *pieces = (iso_pieces){0};
}

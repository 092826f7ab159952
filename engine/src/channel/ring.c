#include "channel/ring.h"

#include "base/series.h"

/* Corners of more than this are gone around in an arc with points so far apart, in degrees. */
#define ARC_STEP 6.0
#define RADIANS 0.017453292519943295

/* Of the depth: what may be missing of the distance to the part. More is where the offset meets
 * itself. Slopes are means over some of the surface, so that a little is missing at edges. */
#define MISSING 0.03
#define MISSING_AFTER 0.1 /* once it was pushed farther */
#define LIFTS 4

iso_status ring_of_tower(ring *r, const tower *t, double f, double reach, iso_arena *arena) {
    *r = (ring){.count = t->samples};
    ISO_TRY(ISO_PUSH(r->point, arena, r->count));
    ISO_TRY(ISO_PUSH(r->up, arena, r->count));
    for (int32_t i = 0; i < r->count; i++) {
        r->point[i] = tower_point(t, i, f);
        r->up[i] = vec3_minus(tower_point(t, i, f + reach), tower_point(t, i, f - reach));
    }
    return ISO_OK;
}

iso_status ring_of_contour(ring *r, const contours *all, int32_t contour, const iso_mesh *mesh,
                           iso_arena *arena) {
    int32_t first = all->first[contour];
    *r = (ring){.count = all->first[contour + 1] - first};
    ISO_TRY(ISO_PUSH(r->point, arena, r->count));
    ISO_TRY(ISO_PUSH(r->normal, arena, r->count));
    for (int32_t i = 0; i < r->count; i++) {
        int32_t face = all->face[first + (i + 1 < r->count ? i + 1 : 0)];
        const int32_t *v = mesh->origin + 3 * (int64_t)face;
        iso_vec3 a = mesh->position[v[0]];
        r->point[i] = all->point[first + i];
        r->normal[i] = vec3_unit(
            vec3_cross(vec3_minus(mesh->position[v[1]], a), vec3_minus(mesh->position[v[2]], a)));
    }
    return ISO_OK;
}

typedef struct pushing {
    const ring *ring;
    const ring_offset *offset;
    curve line, normal; /* points pushed off, and which way */
    int32_t guess;
} pushing;

static iso_vec3 edge_of(const ring *r, int32_t i) {
    return vec3_minus(r->point[i + 1 < r->count ? i + 1 : 0], r->point[i]);
}

/* Out of the part, at the edge from point i on. */
static iso_vec3 normal_of(const ring *r, int32_t i) {
    if (r->normal)
        return r->normal[i];
    return vec3_unit(
        vec3_cross(edge_of(r, i), vec3_plus(r->up[i], r->up[i + 1 < r->count ? i + 1 : 0])));
}

static iso_status put(pushing *p, iso_vec3 from, iso_vec3 normal) {
    ISO_TRY(curve_add(&p->line, vec3_along(from, p->offset->depth, normal)));
    return curve_add(&p->normal, normal);
}

/* Normals of two edges, `to` to the left of `from` or to the right. */
static iso_status put_corner(pushing *p, int32_t i, iso_vec3 from, iso_vec3 to) {
    const ring *r = p->ring;
    double cosine = vec3_dot(from, to), angle = series_arccosine(cosine < -1  ? -1
                                                                 : cosine > 1 ? 1
                                                                              : cosine);
    iso_vec3 at = r->point[i];
    bool opens = vec3_dot(vec3_minus(to, from), edge_of(r, i)) > 0;
    int32_t steps = (int32_t)(angle / (ARC_STEP * RADIANS)) + 1;
    if (steps == 1)
        return put(p, at, vec3_unit(vec3_plus(from, to)));
    if (!opens) {
        ISO_TRY(put(p, at, from));
        return put(p, at, to);
    }
    iso_vec3 side = vec3_unit(vec3_along(to, -cosine, from));
    for (int32_t k = 0; k <= steps; k++) {
        double sine, share;
        series_sine_cosine(&sine, &share, angle * k / steps);
        ISO_TRY(put(p, at, vec3_plus(vec3_times(from, share), vec3_times(side, sine))));
    }
    return ISO_OK;
}

/* Between corners, for some of an edge's points may turn out to be too near and others not. */
static iso_status put_edge(pushing *p, int32_t i, iso_vec3 normal) {
    iso_vec3 edge = edge_of(p->ring, i);
    double pieces = ceil(vec3_length(edge) / p->offset->step);
    for (double k = 1; k < pieces; k++)
        ISO_TRY(put(p, vec3_along(p->ring->point[i], k / pieces, edge), normal));
    return ISO_OK;
}

static iso_status put_all(pushing *p) {
    const ring *r = p->ring;
    iso_vec3 before = {0, 0, 0};
    for (int32_t i = r->count; i-- > 0 && vec3_dot(before, before) == 0;)
        before = normal_of(r, i);
    for (int32_t i = 0; i < r->count; i++) {
        iso_vec3 normal = normal_of(r, i);
        if (vec3_dot(normal, normal) == 0)
            continue; /* no edge at all */
        ISO_TRY(put_corner(p, i, before, normal));
        ISO_TRY(put_edge(p, i, normal));
        before = normal;
    }
    return ISO_OK;
}

static double distance(pushing *p, iso_vec3 at) {
    double most = 2 * p->offset->depth;
    return sqrt(closest_square(p->offset->part->tree, at, most * most, &p->guess));
}

/* Where the surface bends towards the ring from above or below, a little farther off is far enough.
 * Where a wall stands opposite it isn't. */
static bool lift(pushing *p, int32_t i) {
    double depth = p->offset->depth, missing = depth - distance(p, p->line.point[i]);
    if (missing <= MISSING * depth)
        return true;
    iso_vec3 at = p->line.point[i];
    for (int k = 0; k < LIFTS && missing > MISSING * depth; k++) {
        at = vec3_along(at, missing, p->normal.point[i]);
        missing = depth - distance(p, at);
    }
    if (missing > MISSING_AFTER * depth)
        return false;
    p->line.point[i] = at;
    return true;
}

/* A distance has no sign: beyond the wall opposite points may be far enough off, too. */
static iso_status keep_far_ones(curve *out, int32_t *folds, pushing *p) {
    bool before = true, first = true;
    uint8_t *inside;
    int32_t count = p->line.count;
    ISO_TRY(ISO_ALLOCATE(inside, 2 * (int64_t)count));
    uint8_t *far = inside + count;
    for (int32_t i = 0; i < count; i++)
        far[i] = lift(p, i);
    iso_status status =
        enclosed_inside((void *)&p->offset->part->columns, inside, p->line.point, count);
    *folds = 0;
    for (int32_t i = 0; i < count && status == ISO_OK; i++) {
        bool kept = far[i] && !inside[i];
        if (kept)
            status = curve_add(out, p->line.point[i]);
        first = i == 0 ? kept : first;
        *folds += before && !kept;
        before = kept;
    }
    *folds -= !before && !first && *folds > 1; /* one place, seen at both ends */
    iso_release(inside);
    return status;
}

static iso_status push_off(curve *out, int32_t *folds, pushing *p) {
    curve kept = {.closed = true};
    iso_vec3 at = p->ring->point[0];
    ISO_TRY(put_all(p));
    iso_status status = keep_far_ones(&kept, folds, p);
    if (status == ISO_OK &&
        (kept.count < 8 || kept.count < p->line.count / 4 || curve_length(&kept) == 0))
        status =
            iso_fail(ISO_NOT_VERIFIED,
                     "the channel around (%.2f, %.2f, %.2f) finds no place %g mm off the part, "
                     "for the part bends too narrowly there or another side of it is too "
                     "near: less depth, or another start or pitch, may do",
                     at.x, at.y, at.z, p->offset->depth);
    if (status == ISO_OK)
        status = curve_resample(out, &kept, p->offset->step);
    curve_free(&kept);
    return status;
}

/* The part's triangles make small corners. */
static void smooth(curve *c) {
    int32_t n = c->count;
    iso_vec3 first = c->point[0], before = c->point[n - 1];
    for (int32_t i = 0; i < n; i++) {
        iso_vec3 at = c->point[i], after = i + 1 < n ? c->point[i + 1] : first;
        c->point[i] = vec3_between(at, vec3_between(before, after, 0.5), 0.5);
        before = at;
    }
}

iso_status ring_push_off(curve *out, int32_t *folds, const ring *r, const ring_offset *offset) {
    pushing p = {.ring = r, .offset = offset};
    *out = (curve){.closed = true};
    iso_status status = push_off(out, folds, &p);
    curve_free(&p.line);
    curve_free(&p.normal);
    if (status == ISO_OK)
        smooth(out);
    return status;
}

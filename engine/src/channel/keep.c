#include "channel/keep.h"

/* Of the depth: what may be missing. Bends cut corners by so much. */
#define MISSING 0.03
enum { TURNS = 24 };

void part_space_free(part_space *part) {
    closest_free(part->tree);
    enclosed_free(&part->columns);
    iso_release(part->corner);
    *part = (part_space){0};
}

iso_status part_space_new(part_space *part, const iso_mesh *mesh) {
    int64_t darts = 3 * (int64_t)mesh->triangle_count;
    *part = (part_space){0};
    ISO_TRY(ISO_ALLOCATE(part->corner, darts));
    for (int64_t a = 0; a < darts; a++)
        part->corner[a] = mesh->position[mesh->origin[a]];
    iso_status status = closest_new(&part->tree, part->corner, mesh->triangle_count);
    if (status == ISO_OK)
        status = enclosed_new(&part->columns, part->corner, mesh->triangle_count);
    if (status != ISO_OK)
        part_space_free(part);
    return status;
}

static double distance(const part_space *part, iso_vec3 p, double most, int32_t *guess) {
    return sqrt(closest_square(part->tree, p, most * most, guess));
}

/* Away from the nearest point of the part: the gradient of the distance, by differences. */
static iso_vec3 away(const part_space *part, iso_vec3 p, double reach, int32_t *guess) {
    double h = 1e-3 * reach, far = 4 * reach;
    return vec3_unit(vec3(distance(part, vec3(p.x + h, p.y, p.z), far, guess) -
                              distance(part, vec3(p.x - h, p.y, p.z), far, guess),
                          distance(part, vec3(p.x, p.y + h, p.z), far, guess) -
                              distance(part, vec3(p.x, p.y - h, p.z), far, guess),
                          distance(part, vec3(p.x, p.y, p.z + h), far, guess) -
                              distance(part, vec3(p.x, p.y, p.z - h), far, guess)));
}

/* Inside the part the way out leads through its surface. Along the curve nothing is pushed: points
 * would only crowd. */
static bool push_all(curve *c, const part_space *part, const keeping *k, const uint8_t *inside) {
    int32_t guess = 0;
    bool all = true;
    for (int32_t i = 0; i < c->count; i++) {
        if (!c->closed && (i < k->fixed || i >= c->count - k->fixed))
            continue;
        iso_vec3 p = c->point[i];
        double depth = k->depth, missing = depth - distance(part, p, 4 * depth, &guess);
        if (inside[i])
            missing = 2 * depth - missing;
        if (missing <= MISSING * depth)
            continue;
        iso_vec3 out = away(part, p, depth, &guess);
        iso_vec3 along = vec3_unit(vec3_minus(c->point[i + 1 < c->count ? i + 1 : 0],
                                              c->point[i > 0 ? i - 1 : c->count - 1]));
        out = vec3_along(out, -0.9 * vec3_dot(out, along), along);
        c->point[i] = vec3_along(p, inside[i] ? -missing : missing, out);
        all = false;
    }
    return all;
}

static iso_status push(bool *settled, curve *c, const part_space *part, const keeping *k) {
    uint8_t *inside;
    ISO_TRY(ISO_ALLOCATE(inside, c->count));
    iso_status status = enclosed_inside((void *)&part->columns, inside, c->point, c->count);
    if (status == ISO_OK)
        *settled = push_all(c, part, k, inside);
    iso_release(inside);
    return status;
}

iso_status keep_off(curve *c, const part_space *part, const keeping *options) {
    bool settled = false;
    /* where the part is rugged pushing may tear a curve apart, longer and longer */
    double most = 1.5 * curve_length(c);
    ISO_TRY(curve_relax(c, options->radius, options->step, options->fixed));
    for (int turn = 0; turn < TURNS && !settled && curve_length(c) <= most; turn++) {
        ISO_TRY(push(&settled, c, part, options));
        if (!settled)
            ISO_TRY(curve_relax(c, options->radius, options->step, options->fixed));
    }
    return ISO_OK;
}

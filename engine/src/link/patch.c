/* Triangulations and square patches: faces that are orbits of θ, vertices that are orbits of φ. */
#include "link/multilink.h"

#include "base/memory.h"

static iso_status patch_new(iso_multilink *out, iso_multilink view, const int32_t *theta,
                            const int32_t *phi) {
    iso_map_store(&view.map[0], theta, view.size);
    iso_map_store(&view.map[1], phi, view.size);
    return iso_multilink_copy(out, &view);
}

iso_status iso_triangulation_new(iso_triangulation *out, int32_t size, const int32_t *theta,
                                 const int32_t *phi, int dimension, const double *g) {
    return patch_new(&out->link, iso_multilink_view(ISO_KIND_TRIANGULATION, size, 0, dimension, g),
                     theta, phi);
}

iso_status iso_square_patch_new(iso_square_patch *out, int32_t size, const int32_t *theta,
                                const int32_t *phi, int dimension, const double *g) {
    return patch_new(&out->link, iso_multilink_view(ISO_KIND_SQUARE_PATCH, size, 0, dimension, g),
                     theta, phi);
}

static void set_map(iso_map *to, const iso_map *from) {
    to->rule = from->rule;
    to->stride = from->stride;
    to->length = from->length;
    to->range = from->range;
    to->image = from->image;
}

static iso_status patch_from_double_link(iso_multilink *out, iso_link_kind kind,
                                         const iso_multilink *surface) {
    iso_multilink view = iso_multilink_view(kind, surface->size, 0, surface->dimension, surface->g);
    set_map(&view.map[0], &surface->map[0]);
    set_map(&view.map[1], &surface->map[1]);
    return iso_multilink_copy(out, &view);
}

iso_status iso_triangulation_from_double_link(iso_triangulation *out,
                                              const iso_double_link *surface) {
    return patch_from_double_link(&out->link, ISO_KIND_TRIANGULATION, &surface->link);
}

iso_status iso_square_patch_from_double_link(iso_square_patch *out,
                                             const iso_double_link *surface) {
    return patch_from_double_link(&out->link, ISO_KIND_SQUARE_PATCH, &surface->link);
}

static iso_status double_link_from_patch(iso_multilink *out, const iso_multilink *patch) {
    int32_t *face = NULL, *vertex = NULL, faces = 0, vertices = 0;
    *out = (iso_multilink){0};
    iso_status status = iso_multilink_validate(patch);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(face, patch->size);
    if (status == ISO_OK)
        status = ISO_ALLOCATE(vertex, patch->size);
    if (status == ISO_OK)
        status = iso_multilink_orbits(face, &faces, patch, "θ");
    if (status == ISO_OK)
        status = iso_multilink_orbits(vertex, &vertices, patch, "φ");
    if (status == ISO_OK) {
        iso_multilink view =
            iso_multilink_view(ISO_KIND_DOUBLE_LINK, patch->size, 0, patch->dimension, patch->g);
        set_map(&view.map[0], &patch->map[0]);
        set_map(&view.map[1], &patch->map[1]);
        iso_map_store(&view.projection[0], face, faces);
        iso_map_store(&view.projection[1], vertex, vertices);
        status = iso_multilink_copy(out, &view);
    }
    iso_release(face);
    iso_release(vertex);
    return status;
}

iso_status iso_double_link_from_triangulation(iso_double_link *out,
                                              const iso_triangulation *triangulation) {
    return double_link_from_patch(&out->link, &triangulation->link);
}

iso_status iso_double_link_from_square_patch(iso_double_link *out, const iso_square_patch *patch) {
    return double_link_from_patch(&out->link, &patch->link);
}

/* The square of a is a, α(a), αβ(a), β(a); turning about a corner leads into the next square:
 *     φ(a, 0) = (α⁻¹ a, 1)   φ(a, 1) = (β⁻¹ a, 2)   φ(a, 2) = (α a, 3)   φ(a, 3) = (β a, 0)
 * The inverses are written from their images, so that neither needs an array. */
static void fill_squares(int32_t *phi, double *g, const iso_multilink *square_link) {
    const iso_map *alpha = &square_link->map[0], *beta = &square_link->map[1];
    int n = square_link->dimension;
    for (int32_t a = 0; a < square_link->size; a++) {
        int32_t right = iso_map_at(alpha, a), up = iso_map_at(beta, a);
        int32_t corner[4] = {a, right, iso_map_at(alpha, up), up};
        phi[4 * right] = 4 * a + 1;
        phi[4 * up + 1] = 4 * a + 2;
        phi[4 * a + 2] = 4 * right + 3;
        phi[4 * a + 3] = 4 * up;
        for (int k = 0; n > 0 && k < 4; k++)
            memcpy(g + (4 * (int64_t)a + k) * n, square_link->g + (int64_t)corner[k] * n,
                   (size_t)n * sizeof *g);
    }
}

iso_status iso_square_patch_from_square_link(iso_square_patch *out,
                                             const iso_square_link *square_link) {
    const iso_multilink *from = &square_link->link;
    out->link = (iso_multilink){0};
    ISO_TRY(iso_multilink_validate(from));
    ISO_TRY(iso_multilink_check_bijective(from, "α"));
    ISO_TRY(iso_multilink_check_bijective(from, "β"));
    if (from->size > INT32_MAX / 4)
        return iso_fail(ISO_OUTSIDE, "a square patch of more than 2^31 - 1 corners");
    int32_t size = 4 * from->size;
    iso_multilink made = iso_multilink_begin(ISO_KIND_SQUARE_PATCH, size, from->dimension);
    iso_map_step(&made.map[0], ISO_MAP_CYCLIC, 1, 4, size);
    int32_t *phi = iso_map_allocate(&made.map[1], size, size);
    double *g = iso_multilink_allocate_g(&made);
    int complete = phi && g;
    if (complete)
        fill_squares(phi, g, from);
    return iso_multilink_finish(&out->link, &made, complete ? ISO_OK : ISO_NO_MEMORY);
}

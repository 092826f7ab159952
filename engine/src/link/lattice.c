/* Square-, cubic- and n-cube-links: maps that commute, mostly steps along the axes of a box. */
#include "link/multilink.h"

#include "base/memory.h"

iso_status iso_square_link_new(iso_square_link *out, int32_t size, const int32_t *alpha,
                               const int32_t *beta, int dimension, const double *g) {
    iso_multilink view = iso_multilink_view(ISO_KIND_SQUARE_LINK, size, 0, dimension, g);
    iso_map_store(&view.map[0], alpha, size);
    iso_map_store(&view.map[1], beta, size);
    return iso_multilink_copy(&out->link, &view);
}

static iso_status box_size(int32_t *size, int axis_count, const iso_axis *axis) {
    int64_t product = 1;
    if (axis_count < 1 || axis_count > ISO_LINK_MAPS_MAX)
        return iso_fail(ISO_USAGE, "a lattice of %d axes; 1 to %d are possible", axis_count,
                        ISO_LINK_MAPS_MAX);
    for (int i = 0; i < axis_count; i++) {
        if (axis[i].length < 1)
            return iso_fail(ISO_USAGE, "axis %d of the lattice has length %d", i, axis[i].length);
        product *= axis[i].length;
        if (product > INT32_MAX)
            return iso_fail(ISO_OUTSIDE, "a lattice of more than 2^31 - 1 indexes, at axis %d", i);
    }
    *size = (int32_t)product;
    return ISO_OK;
}

static iso_status add_material(iso_multilink *view, const int32_t *material) {
    int32_t most = -1;
    for (int32_t a = 0; a < view->size; a++) {
        if (material[a] < 0 || material[a] == INT32_MAX)
            return iso_fail(ISO_USAGE, "material %d at index %d of the lattice", material[a], a);
        most = material[a] > most ? material[a] : most;
    }
    iso_map_store(iso_multilink_add_projection(view, "p"), material, most + 1);
    return ISO_OK;
}

static iso_status box_new(iso_multilink *out, iso_multilink view, const iso_axis *axis,
                          const int32_t *material) {
    *out = (iso_multilink){0};
    ISO_TRY(box_size(&view.size, view.map_count, axis));
    for (int32_t i = 0, stride = 1; i < view.map_count; stride *= axis[i++].length)
        iso_map_step(&view.map[i], axis[i].wraps ? ISO_MAP_CYCLIC : ISO_MAP_CLAMPED, stride,
                     axis[i].length, view.size);
    if (material)
        ISO_TRY(add_material(&view, material));
    return iso_multilink_copy(out, &view);
}

iso_status iso_square_link_box(iso_square_link *out, const iso_axis axis[2], int dimension,
                               const double *g) {
    iso_multilink view = iso_multilink_view(ISO_KIND_SQUARE_LINK, 0, 0, dimension, g);
    return box_new(&out->link, view, axis, NULL);
}

iso_status iso_cubic_link_box(iso_cubic_link *out, const iso_axis axis[3], int dimension,
                              const double *g, const int32_t *material) {
    iso_multilink view = iso_multilink_view(ISO_KIND_CUBIC_LINK, 0, 0, dimension, g);
    return box_new(&out->link, view, axis, material);
}

iso_status iso_cube_link_box(iso_cube_link *out, int axis_count, const iso_axis *axis,
                             int dimension, const double *g, const int32_t *material) {
    iso_multilink view = iso_multilink_view(ISO_KIND_CUBE_LINK, 0, axis_count, dimension, g);
    return box_new(&out->link, view, axis, material);
}

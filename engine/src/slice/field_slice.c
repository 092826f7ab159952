/* Slices by fields: the mesh is refined until straight edges tell all, and sliced by the field's
 * values at its vertices, with every point put where the field has the level on the edge. */
#include <isoslice/slice.h>

#include <math.h>

#include "height/height.h"
#include "slice/curves.h"
#include "slice/refine.h"

iso_field_slicing iso_field_slicing_defaults(void) {
    return (iso_field_slicing){.tolerance = 0.01, .resolution = 0.002};
}

static iso_status check_options(const iso_field_slicing *options) {
    if (!(options->tolerance >= 0) || !isfinite(options->tolerance))
        return iso_fail(ISO_USAGE, "a chord can't be off its curve by %g mm", options->tolerance);
    if (!(options->resolution > 0) || !isfinite(options->resolution))
        return iso_fail(ISO_USAGE, "edges can't be split down to %g mm", options->resolution);
    return ISO_OK;
}

/* The same gradient all over the model: faces need no look, and edges no search. */
static int is_linear(const iso_field *field, const iso_mesh *mesh) {
    iso_field_bound b;
    iso_field_bound_over(&b, field, mesh->min, mesh->max);
    return isfinite(b.gradient_low.x + b.gradient_low.y + b.gradient_low.z) &&
           b.gradient_low.x == b.gradient_high.x && b.gradient_low.y == b.gradient_high.y &&
           b.gradient_low.z == b.gradient_high.z;
}

static iso_status slice(iso_curves *curves, refined *r, const double *level, int32_t count,
                        const iso_field_slicing *options) {
    int linear = is_linear(r->field, r->mesh);
    if (count > 0 && !linear)
        ISO_TRY(refine(r, level, count, options));
    curves_mesh view = {.triangle_count = r->triangle_count,
                        .vertex_count = r->vertex_count,
                        .origin = r->origin,
                        .opposite = r->opposite,
                        .position = r->position,
                        .height = r->value,
                        .field = linear ? NULL : r->field,
                        .gradient = r->gradient};
    return curves_slice(curves, &view, level, count);
}

/* What is measured along the mesh itself is linear in its triangles. */
static iso_status slice_geodesic(iso_curves *curves, const iso_mesh *mesh, const iso_field *field,
                                 const double *level, int32_t level_count) {
    double *height;
    ISO_TRY(ISO_ALLOCATE(height, mesh->vertex_count));
    height_of_vertices(height, field, mesh);
    iso_status status = iso_slice_heights(curves, mesh, height, level, level_count);
    iso_release(height);
    return status;
}

iso_status iso_slice_field(iso_curves *curves, const iso_mesh *mesh, const iso_field *field,
                           const double *level, int32_t level_count,
                           const iso_field_slicing *options) {
    iso_field_slicing usual = iso_field_slicing_defaults();
    refined r = {0};
    *curves = (iso_curves){0};
    if (!options)
        options = &usual;
    ISO_TRY(check_options(options));
    ISO_TRY(curves_check_levels(level, level_count));
    if (iso_field_kind_of(field) == ISO_FIELD_GEODESIC)
        return slice_geodesic(curves, mesh, field, level, level_count);
    iso_status status = refined_begin(&r, mesh, field);
    if (status == ISO_OK)
        status = slice(curves, &r, level, level_count, options);
    refined_free(&r);
    return status;
}

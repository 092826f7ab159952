#include "solid/grid.h"

#include <math.h>

#include "solid/inside.h"

static double axis_of(const iso_vec3 *v, int axis) {
    return axis == 0 ? v->x : axis == 1 ? v->y : v->z;
}

/* The finest grid whose steps across the box are still good for the predicates. Only a box that is
 * 2^20 times its size away from zero gets a coarser one. */
void grid_choose(solid_grid *grid, const iso_mesh *mesh, int32_t count) {
    double low[3] = {0}, high[3] = {0}, span = 0, far = 0;
    int first = 1;
    for (int32_t m = 0; m < count; m++) {
        if (mesh[m].triangle_count == 0)
            continue;
        for (int k = 0; k < 3; k++) {
            double least = axis_of(&mesh[m].min, k), most = axis_of(&mesh[m].max, k);
            low[k] = first || least < low[k] ? least : low[k];
            high[k] = first || most > high[k] ? most : high[k];
        }
        first = 0;
    }
    for (int k = 0; k < 3; k++) {
        span = fmax(span, high[k] - low[k]);
        far = fmax(far, fmax(fabs(low[k]), fabs(high[k])));
    }
    double scale = 0x1p60;
    while (span * scale > (double)INSIDE_SPAN_MAX - 4 || far * scale > 0x1p50)
        scale /= 2;
    grid->scale = scale;
    for (int k = 0; k < 3; k++) {
        grid->middle[k] = grid_steps(low[k] / 2 + high[k] / 2, scale);
        grid->min[k] = (int32_t)(grid_steps(low[k], scale) - grid->middle[k]);
        grid->max[k] = (int32_t)(grid_steps(high[k], scale) - grid->middle[k]);
    }
}

iso_status grid_count(int32_t *triangles, const iso_mesh *mesh, int32_t count) {
    int64_t sum = 0;
    for (int32_t m = 0; m < count; m++)
        sum += mesh[m].triangle_count;
    if (sum > INT32_MAX)
        return iso_fail(ISO_UNSLICEABLE, "more than %d triangles in one object", INT32_MAX);
    *triangles = (int32_t)sum;
    return ISO_OK;
}

int grid_place(int32_t out[3], const solid_grid *grid, const iso_vec3 *point) {
    for (int k = 0; k < 3; k++) {
        double mm = axis_of(point, k);
        if (!(fabs(mm * grid->scale) <= 0x1p51)) /* NaN too */
            return 0;
        int64_t s = grid_steps(mm, grid->scale) - grid->middle[k];
        if (s < grid->min[k] || s > grid->max[k])
            return 0;
        out[k] = (int32_t)s;
    }
    return 1;
}

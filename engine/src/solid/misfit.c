#include "solid/misfit.h"

#include <math.h>

#include "base/memory.h"
#include "solid/closest.h"

static iso_status tree_of(iso_closest **tree, const iso_mesh *mesh) {
    int64_t count = mesh->triangle_count;
    iso_vec3 *corner;
    *tree = NULL;
    ISO_TRY(ISO_ALLOCATE(corner, 3 * count));
    for (int64_t i = 0; i < 3 * count; i++)
        corner[i] = mesh->position[mesh->origin[i]];
    iso_status status = closest_new(tree, corner, count);
    iso_release(corner);
    return status;
}

typedef struct seeker {
    const iso_closest *tree;
    const iso_volume *whole;
    int32_t nearest;
    double half, voxel;
} seeker;

/* Negative: it doesn't count. */
static iso_status misfit_of(double *off, seeker *s, iso_vec3 p) {
    double reach = s->half + MISFIT_REACH * s->voxel, side = -1;
    double square = closest_square(s->tree, p, reach * reach, &s->nearest);
    if (square < reach * reach) {
        double beyond = sqrt(square) - s->half;
        *off = s->half > 0 && beyond > s->voxel ? -1 : fabs(beyond);
        return ISO_OK;
    }
    if (s->whole)
        ISO_TRY(volume_sample(&side, s->whole, &p, 1));
    *off = side > 0 ? MISFIT_REACH * s->voxel : -1;
    return ISO_OK;
}

iso_status misfit_measure(iso_mesh_defects *errors, const iso_mesh *made, const iso_mesh *soup,
                          const iso_volume *whole, double half, double voxel) {
    iso_closest *tree;
    double sum = 0, largest = 0;
    int64_t count = 0;
    ISO_TRY(tree_of(&tree, made));
    seeker s = {.tree = tree, .whole = whole, .half = half, .voxel = voxel};
    iso_status status = ISO_OK;
    for (int32_t v = 0; v < soup->vertex_count && status == ISO_OK; v++) {
        double off = -1;
        status = misfit_of(&off, &s, soup->position[v]);
        if (off < 0)
            continue;
        sum += off;
        largest = fmax(largest, off);
        count++;
    }
    closest_free(tree);
    errors->largest_error = largest;
    errors->mean_error = count > 0 ? sum / (double)count : 0;
    return status;
}

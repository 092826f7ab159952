/* The grid that isoslice/solid.h speaks of: coordinates as integers. */
#ifndef ISO_SOLID_GRID_H
#define ISO_SOLID_GRID_H

#include <isoslice/mesh.h>

typedef struct solid_grid {
    double scale; /* steps per mm, a power of two */
    int64_t middle[3];
    int32_t min[3], max[3]; /* of the corners; steps from the middle, as all int32_t here */
} solid_grid;

void grid_choose(solid_grid *grid, const iso_mesh *mesh, int32_t count);

/* Triangles of all meshes. ISO_UNSLICEABLE: more than can be numbered. */
iso_status grid_count(int32_t *triangles, const iso_mesh *mesh, int32_t count) ISO_MUST_CHECK;

/* To nearest, halves away from zero; |mm * scale| <= 2^51 keeps all of it exact. */
static inline int64_t grid_steps(double mm, double scale) {
    double s = mm * scale;
    return (int64_t)(s < 0 ? s - 0.5 : s + 0.5);
}

/* Of a corner, which is in the box. */
static inline void grid_round(int32_t out[3], const solid_grid *grid, const iso_vec3 *corner) {
    out[0] = (int32_t)(grid_steps(corner->x, grid->scale) - grid->middle[0]);
    out[1] = (int32_t)(grid_steps(corner->y, grid->scale) - grid->middle[1]);
    out[2] = (int32_t)(grid_steps(corner->z, grid->scale) - grid->middle[2]);
}

/* Of any point. 0: outside the surface's box, so that nothing winds around it. */
int grid_place(int32_t out[3], const solid_grid *grid, const iso_vec3 *point);

#endif

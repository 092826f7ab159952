/* Parts that lattices are tested in. */
#ifndef TESTS_LATTICE_PART_H
#define TESTS_LATTICE_PART_H

#include <math.h>
#include <stdlib.h>

#include <isoslice/mesh.h>

static inline void part_quad(float *to, const double *a, const double *b, const double *c,
                             const double *d) {
    const double *corner[6] = {a, b, c, a, c, d};
    for (int i = 0; i < 6; i++)
        for (int k = 0; k < 3; k++)
            to[3 * i + k] = (float)corner[i][k];
}

/* A box of these sides, from `at`. */
static inline iso_status part_box(iso_mesh *mesh, const double side[3], const double at[3]) {
    static const int face[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                   {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    double corner[8][3];
    float triangle[6 * 18];
    for (int i = 0; i < 8; i++)
        for (int k = 0; k < 3; k++)
            corner[i][k] = at[k] + (i >> k & 1 ? side[k] : 0);
    for (int i = 0; i < 6; i++)
        part_quad(triangle + 18 * i, corner[face[i][0]], corner[face[i][1]], corner[face[i][2]],
                  corner[face[i][3]]);
    return iso_mesh_from_triangles(mesh, triangle, 12);
}

/* The surface that a closed curve of r, z sweeps around the z axis through x, y. */
static inline iso_status part_turned(iso_mesh *mesh, const double (*curve)[2], int32_t points,
                                     int32_t around, double x, double y) {
    float *triangle = malloc(sizeof(float) * 18 * (size_t)points * (size_t)around);
    for (int32_t j = 0; j < around; j++) {
        double angle[2] = {6.283185307179586 * j / around,
                           6.283185307179586 * ((j + 1) % around) / around};
        for (int32_t i = 0; i < points; i++) {
            double corner[4][3];
            for (int k = 0; k < 4; k++) {
                const double *at = curve[(i + (k == 1 || k == 2)) % points];
                corner[k][0] = x + at[0] * cos(angle[k < 2]);
                corner[k][1] = y + at[0] * sin(angle[k < 2]);
                corner[k][2] = at[1];
            }
            part_quad(triangle + 18 * ((int64_t)j * points + i), corner[3], corner[2], corner[1],
                      corner[0]);
        }
    }
    iso_status status = iso_mesh_from_triangles(mesh, triangle, 2 * (int64_t)points * around);
    free(triangle);
    return status;
}

#endif

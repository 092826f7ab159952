/* Meshes for the tests of objects, and what must hold for every mesh. */
#ifndef TESTS_OBJECT_SOLID_H
#define TESTS_OBJECT_SOLID_H

#include "check.h"

#include "models/shapes.h"

#include <isoslice/object.h>

static inline int solid_made(iso_mesh *mesh, shape *s) {
    int good = CHECK_OK(iso_mesh_from_triangles(mesh, s->triangle, s->count));
    shape_free(s);
    return good;
}

static inline double solid_area(const iso_mesh *mesh) {
    double sum = 0;
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        iso_vec3 p = mesh->position[mesh->origin[3 * t]];
        iso_vec3 q = mesh->position[mesh->origin[3 * t + 1]];
        iso_vec3 r = mesh->position[mesh->origin[3 * t + 2]];
        double ux = q.x - p.x, uy = q.y - p.y, uz = q.z - p.z;
        double vx = r.x - p.x, vy = r.y - p.y, vz = r.z - p.z;
        double x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
        sum += sqrt(x * x + y * y + z * z) / 2;
    }
    return sum;
}

/* Area of the triangles that lie in the plane z and face up (1) or down (-1); their total, and of
 * that what faces the other way. */
static inline double solid_flat(const iso_mesh *mesh, double z, int up, double *wrong) {
    double sum = 0;
    *wrong = 0;
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        iso_vec3 p = mesh->position[mesh->origin[3 * t]];
        iso_vec3 q = mesh->position[mesh->origin[3 * t + 1]];
        iso_vec3 r = mesh->position[mesh->origin[3 * t + 2]];
        if (p.z != z || q.z != z || r.z != z)
            continue;
        double area = ((q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x)) / 2 * up;
        sum += area;
        *wrong += area < 0 ? -area : 0;
    }
    return sum;
}

#endif

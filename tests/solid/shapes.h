/* Surfaces for the tests of inside and outside, as triangle soups, and random numbers. */
#ifndef TESTS_SOLID_SHAPES_H
#define TESTS_SOLID_SHAPES_H

#include <stdint.h>

#include <isoslice/geometry.h>
#include <isoslice/mesh.h>

#define PI 3.14159265358979324

typedef struct test_shape {
    iso_vec3 *corner;        /* [3 count] */
    int64_t count, capacity; /* triangles */
} test_shape;

void shape_free(test_shape *shape);
void shape_triangle(test_shape *shape, iso_vec3 a, iso_vec3 b, iso_vec3 c);
/* Turned inside out if not `outward`. */
void shape_box(test_shape *shape, iso_vec3 min, iso_vec3 max, int outward);
void shape_sphere(test_shape *shape, iso_vec3 middle, double radius, int32_t stacks);
/* Around z. */
void shape_torus(test_shape *shape, iso_vec3 middle, double ring, double tube, int32_t segments);
/* Many teeth: thin needles of triangles around z, with corners in common at both ends. */
void shape_spindle(test_shape *shape, iso_vec3 middle, double radius, double height, int32_t sides);

/* A mesh whose corners are all its own, but which is good for being read by; free with
 * shape_mesh_free. */
void shape_mesh(iso_mesh *mesh, const test_shape *shape);
void shape_mesh_free(iso_mesh *mesh);

double shape_random(uint64_t *state); /* [0, 1) */

#endif

#include "solid/shapes.h"

#include <math.h>
#include <stdlib.h>

void shape_free(test_shape *shape) {
    free(shape->corner);
    *shape = (test_shape){0};
}

void shape_triangle(test_shape *shape, iso_vec3 a, iso_vec3 b, iso_vec3 c) {
    if (shape->count == shape->capacity) {
        shape->capacity = 2 * shape->capacity + 64;
        shape->corner = realloc(shape->corner, 3 * (size_t)shape->capacity * sizeof *shape->corner);
    }
    iso_vec3 *to = &shape->corner[3 * shape->count++];
    to[0] = a;
    to[1] = b;
    to[2] = c;
}

static void quad(test_shape *shape, iso_vec3 a, iso_vec3 b, iso_vec3 c, iso_vec3 d, int outward) {
    shape_triangle(shape, a, outward ? b : c, outward ? c : b);
    shape_triangle(shape, a, outward ? c : d, outward ? d : c);
}

void shape_box(test_shape *shape, iso_vec3 min, iso_vec3 max, int outward) {
    iso_vec3 p[8];
    for (int i = 0; i < 8; i++)
        p[i] = (iso_vec3){i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z};
    quad(shape, p[0], p[2], p[3], p[1], outward);
    quad(shape, p[4], p[5], p[7], p[6], outward);
    quad(shape, p[0], p[1], p[5], p[4], outward);
    quad(shape, p[2], p[6], p[7], p[3], outward);
    quad(shape, p[0], p[4], p[6], p[2], outward);
    quad(shape, p[1], p[3], p[7], p[5], outward);
}

static iso_vec3 on_sphere(iso_vec3 middle, double radius, int32_t i, int32_t j, int32_t stacks) {
    double polar = PI * i / stacks, around = PI * (j % (2 * stacks)) / stacks;
    double r = i == 0 || i == stacks ? 0 : radius * sin(polar);
    return (iso_vec3){middle.x + r * cos(around), middle.y + r * sin(around),
                      middle.z + radius * cos(polar)};
}

void shape_sphere(test_shape *shape, iso_vec3 middle, double radius, int32_t stacks) {
    for (int32_t i = 0; i < stacks; i++) {
        for (int32_t j = 0; j < 2 * stacks; j++) {
            iso_vec3 a = on_sphere(middle, radius, i, j, stacks);
            iso_vec3 b = on_sphere(middle, radius, i + 1, j, stacks);
            iso_vec3 c = on_sphere(middle, radius, i + 1, j + 1, stacks);
            iso_vec3 d = on_sphere(middle, radius, i, j + 1, stacks);
            if (i < stacks - 1)
                shape_triangle(shape, a, b, c);
            if (i > 0)
                shape_triangle(shape, a, c, d);
        }
    }
}

static iso_vec3 on_torus(iso_vec3 middle, double ring, double tube, int32_t i, int32_t j,
                         int32_t n) {
    double around = 2 * PI * (i % n) / n, across = 2 * PI * (j % n) / n;
    double r = ring + tube * cos(across);
    return (iso_vec3){middle.x + r * cos(around), middle.y + r * sin(around),
                      middle.z + tube * sin(across)};
}

void shape_torus(test_shape *shape, iso_vec3 middle, double ring, double tube, int32_t n) {
    for (int32_t i = 0; i < n; i++)
        for (int32_t j = 0; j < n; j++)
            quad(shape, on_torus(middle, ring, tube, i, j, n),
                 on_torus(middle, ring, tube, i + 1, j, n),
                 on_torus(middle, ring, tube, i + 1, j + 1, n),
                 on_torus(middle, ring, tube, i, j + 1, n), 1);
}

void shape_spindle(test_shape *shape, iso_vec3 middle, double radius, double height,
                   int32_t sides) {
    iso_vec3 top = middle, bottom = middle;
    top.z += height / 2;
    bottom.z -= height / 2;
    for (int32_t i = 0; i < sides; i++) {
        double from = 2 * PI * i / sides, to = 2 * PI * ((i + 1) % sides) / sides;
        iso_vec3 a = {middle.x + radius * cos(from), middle.y + radius * sin(from), middle.z};
        iso_vec3 b = {middle.x + radius * cos(to), middle.y + radius * sin(to), middle.z};
        shape_triangle(shape, a, b, top);
        shape_triangle(shape, b, a, bottom);
    }
}

void shape_mesh(iso_mesh *mesh, const test_shape *shape) {
    int64_t corners = 3 * shape->count;
    *mesh = (iso_mesh){.triangle_count = (int32_t)shape->count, .vertex_count = (int32_t)corners};
    mesh->origin = malloc((size_t)(corners + 1) * sizeof *mesh->origin);
    mesh->position = malloc((size_t)(corners + 1) * sizeof *mesh->position);
    for (int64_t i = 0; i < corners; i++) {
        iso_vec3 p = mesh->position[i] = shape->corner[i];
        mesh->origin[i] = (int32_t)i;
        mesh->min =
            i ? (iso_vec3){fmin(mesh->min.x, p.x), fmin(mesh->min.y, p.y), fmin(mesh->min.z, p.z)}
              : p;
        mesh->max =
            i ? (iso_vec3){fmax(mesh->max.x, p.x), fmax(mesh->max.y, p.y), fmax(mesh->max.z, p.z)}
              : p;
    }
}

void shape_mesh_free(iso_mesh *mesh) {
    free(mesh->origin);
    free(mesh->position);
}

double shape_random(uint64_t *state) {
    uint64_t z = *state += 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

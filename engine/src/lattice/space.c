#include "lattice/space.h"

#include <math.h>

static double lesser(double a, double b) {
    return a < b ? a : b;
}

static double greater(double a, double b) {
    return a > b ? a : b;
}

static void join_box(iso_vec3 *min, iso_vec3 *max, const iso_mesh *mesh) {
    *min = (iso_vec3){lesser(min->x, mesh->min.x), lesser(min->y, mesh->min.y),
                      lesser(min->z, mesh->min.z)};
    *max = (iso_vec3){greater(max->x, mesh->max.x), greater(max->y, mesh->max.y),
                      greater(max->z, mesh->max.z)};
}

/* Squared distance from the origin to a segment. */
static double square_to_segment(iso_vec2 a, iso_vec2 b) {
    double dx = b.x - a.x, dy = b.y - a.y, length = dx * dx + dy * dy;
    double t = length > 0 ? -(a.x * dx + a.y * dy) / length : 0;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    double x = a.x + t * dx, y = a.y + t * dy;
    return x * x + y * y;
}

/* The same to a triangle; 0 where it covers the origin. */
static double square_to_triangle(const iso_vec2 corner[3]) {
    double least = HUGE_VAL;
    int left = 0, right = 0;
    for (int k = 0; k < 3; k++) {
        iso_vec2 a = corner[k], b = corner[(k + 1) % 3];
        double side = a.x * b.y - a.y * b.x;
        left += side >= 0;
        right += side <= 0;
        least = lesser(least, square_to_segment(a, b));
    }
    return left == 3 || right == 3 ? 0 : least;
}

static void reach(iso_space *space, const iso_mesh *mesh) {
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        iso_vec2 corner[3];
        for (int k = 0; k < 3; k++) {
            iso_vec3 p = mesh->position[mesh->origin[3 * t + k]];
            corner[k] = (iso_vec2){p.x - space->origin.x, p.y - space->origin.y};
            double r = corner[k].x * corner[k].x + corner[k].y * corner[k].y;
            space->largest_r = greater(space->largest_r, r);
        }
        space->least_r = lesser(space->least_r, square_to_triangle(corner));
    }
}

iso_status space_make(iso_space *space, const iso_mesh *mesh, int32_t count) {
    iso_vec3 min = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, max = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    int64_t triangles = 0;
    for (int32_t i = 0; i < count; i++) {
        if (mesh[i].triangle_count == 0)
            continue;
        join_box(&min, &max, &mesh[i]);
        triangles += mesh[i].triangle_count;
    }
    if (triangles == 0)
        return iso_fail(ISO_UNSLICEABLE, "a lattice in no part: there are no triangles");
    iso_vec3 origin = {(min.x + max.x) / 2, (min.y + max.y) / 2, min.z};
    *space = (iso_space){.origin = origin,
                         .min = {min.x - origin.x, min.y - origin.y, 0},
                         .max = {max.x - origin.x, max.y - origin.y, max.z - origin.z},
                         .least_r = HUGE_VAL};
    for (int32_t i = 0; i < count; i++)
        reach(space, &mesh[i]);
    space->least_r = sqrt(space->least_r);
    space->largest_r = sqrt(space->largest_r);
    return ISO_OK;
}

void space_know(iso_places *places, const iso_space *space, uint32_t wanted, int32_t count) {
    for (int32_t k = 0; k < GRADING_VARIABLES; k++)
        places->variable[k] = places->value[k];
    const double *x = places->value[GRADING_X], *y = places->value[GRADING_Y];
    if (wanted >> GRADING_R & 1)
        for (int32_t i = 0; i < count; i++)
            places->value[GRADING_R][i] = sqrt(x[i] * x[i] + y[i] * y[i]);
}

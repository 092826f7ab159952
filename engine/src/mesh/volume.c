#include <isoslice/mesh.h>

/* Divergence theorem with the field (0, 0, G(z)): the volume is the sum over triangles of the
 * signed area of their shadow times the mean of G on them. G = z gives all of it; G(z) = z clamped
 * to [z0, z1] has G' = 1 just there and gives what lies between. G is piecewise linear, so its mean
 * on a triangle has a closed form, and nothing is sliced. */

/* Mean of max(0, z - c) on a triangle with heights a <= b <= d. */
static double mean_above(double a, double b, double d, double c) {
    if (c <= a)
        return (a + b + d) / 3 - c;
    if (c >= d)
        return 0;
    if (c >= b)
        return (d - c) * (d - c) * (d - c) / (3 * (d - a) * (d - b));
    return (a + b + d) / 3 - c + (c - a) * (c - a) * (c - a) / (3 * (b - a) * (d - a));
}

static double shadow(const iso_vec3 *p, const iso_vec3 *q, const iso_vec3 *r) {
    return 0.5 * ((q->x - p->x) * (r->y - p->y) - (q->y - p->y) * (r->x - p->x));
}

double iso_mesh_volume(const iso_mesh *mesh) {
    double sum = 0, middle = 0.5 * (mesh->min.z + mesh->max.z);
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        const iso_vec3 *p = &mesh->position[mesh->origin[3 * t]];
        const iso_vec3 *q = &mesh->position[mesh->origin[3 * t + 1]];
        const iso_vec3 *r = &mesh->position[mesh->origin[3 * t + 2]];
        sum += shadow(p, q, r) * ((p->z - middle) + (q->z - middle) + (r->z - middle));
    }
    return sum / 3;
}

double iso_mesh_volume_between(const iso_mesh *mesh, double z0, double z1) {
    double sum = 0;
    if (!(z0 < z1))
        return 0;
    for (int32_t t = 0; t < mesh->triangle_count; t++) {
        const iso_vec3 *p = &mesh->position[mesh->origin[3 * t]];
        const iso_vec3 *q = &mesh->position[mesh->origin[3 * t + 1]];
        const iso_vec3 *r = &mesh->position[mesh->origin[3 * t + 2]];
        double a = p->z, b = q->z, d = r->z, swap;
        if (a > b)
            swap = a, a = b, b = swap;
        if (b > d)
            swap = b, b = d, d = swap;
        if (a > b)
            swap = a, a = b, b = swap;
        if (d > z0) /* below, the mean of G is 0 */
            sum += shadow(p, q, r) * (mean_above(a, b, d, z0) - mean_above(a, b, d, z1));
    }
    return sum;
}

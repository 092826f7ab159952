/* Vectors in space, in mm or without a unit. */
#ifndef ISO_BASE_VECTOR_H
#define ISO_BASE_VECTOR_H

#include <math.h>

#include <isoslice/geometry.h>

static inline iso_vec3 vec3(double x, double y, double z) {
    return (iso_vec3){x, y, z};
}
static inline iso_vec3 vec3_plus(iso_vec3 a, iso_vec3 b) {
    return (iso_vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}
static inline iso_vec3 vec3_minus(iso_vec3 a, iso_vec3 b) {
    return (iso_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}
static inline iso_vec3 vec3_times(iso_vec3 a, double s) {
    return (iso_vec3){a.x * s, a.y * s, a.z * s};
}
/* a + s b */
static inline iso_vec3 vec3_along(iso_vec3 a, double s, iso_vec3 b) {
    return (iso_vec3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}
/* a + t (b - a): exactly a at t = 0 */
static inline iso_vec3 vec3_between(iso_vec3 a, iso_vec3 b, double t) {
    return vec3_along(a, t, vec3_minus(b, a));
}
static inline double vec3_dot(iso_vec3 a, iso_vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline iso_vec3 vec3_cross(iso_vec3 a, iso_vec3 b) {
    return (iso_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static inline double vec3_length(iso_vec3 a) {
    return sqrt(vec3_dot(a, a));
}
static inline double vec3_distance(iso_vec3 a, iso_vec3 b) {
    return vec3_length(vec3_minus(a, b));
}
/* Of length 1; the zero vector stays what it is. */
static inline iso_vec3 vec3_unit(iso_vec3 a) {
    double length = vec3_length(a);
    return length > 0 ? vec3_times(a, 1 / length) : a;
}

#endif

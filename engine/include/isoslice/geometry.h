/* The two kinds of coordinates, kept apart by type.
 *
 * iso_point   integers, 1 unit = 100 nm, |x|, |y| <= ISO_COORDINATE_MAX. Geometry decides here,
 * exactly. iso_vec2/3  doubles in mm. Where models, fields and users live. */
#ifndef ISOSLICE_GEOMETRY_H
#define ISOSLICE_GEOMETRY_H

#include <stdint.h>

#define ISO_UNITS_PER_MM 10000
#define ISO_COORDINATE_MAX                                                                         \
    (1 << 24) /* 1.68 m: orient2d then fits in 2^51, exact in int64 and double */

typedef struct iso_point {
    int32_t x, y;
} iso_point;

typedef struct iso_box { /* closed: both corners belong to it; empty if min > max */
    iso_point min, max;
} iso_box;

typedef struct iso_vec2 {
    double x, y;
} iso_vec2;

typedef struct iso_vec3 {
    double x, y, z;
} iso_vec3;

/* mm to units, to nearest, halves away from zero. The caller has checked the range. */
static inline int32_t iso_units(double mm) {
    double u = mm * ISO_UNITS_PER_MM;
    return (int32_t)(u < 0 ? u - 0.5 : u + 0.5);
}

static inline double iso_mm(int64_t units) {
    return (double)units / ISO_UNITS_PER_MM;
}

#endif

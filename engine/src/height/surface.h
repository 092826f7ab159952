/* The nearest point of a model's surface. */
#ifndef ISO_HEIGHT_SURFACE_H
#define ISO_HEIGHT_SURFACE_H

#include <stdbool.h>

#include <isoslice/mesh.h>

#include "solid/closest.h"

typedef struct surface {
    int32_t triangle_count, vertex_count;
    int32_t *origin;    /* [3 triangle_count] of all meshes, one behind the other */
    iso_vec3 *position; /* [vertex_count] */
    iso_closest *tree;
} surface;

/* Copies what it needs, moved by -`shift`. */
iso_status surface_new(surface *s, const iso_mesh *mesh, int32_t count,
                       iso_vec3 shift) ISO_MUST_CHECK;
void surface_free(surface *s); /* a zeroed one is empty */

/* Where the nearest point is. */
typedef struct foot {
    int32_t triangle;
    double share[3]; /* of its corners; exactly 0 for those of which the point has nothing */
    iso_vec3 point;
} foot;

/* The nearest point of all; *guess as closest_square has it. */
void surface_nearest(foot *f, const surface *s, iso_vec3 p, int32_t *guess);
/* The nearest point of one triangle. */
void surface_nearest_of(foot *f, const surface *s, int32_t triangle, iso_vec3 p);

/* Triangles that may be the nearest to some point of a box, triangle[SURFACE_MOST], and how far its
 * middle is from the surface. Returns their number, or SURFACE_MOST + 1: more. */
enum { SURFACE_MOST = 256 };
typedef struct surface_box {
    iso_vec3 middle;
    double radius, distance;
    foot nearest; /* of the middle */
} surface_box;
int surface_candidates(int32_t *triangle, surface_box *box, const surface *s, iso_vec3 low,
                       iso_vec3 high);

/* Toward the outside, as long as twice the area. */
iso_vec3 surface_area(const surface *s, int32_t triangle);

#endif

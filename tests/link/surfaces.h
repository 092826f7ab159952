/* Surfaces and lattices that the tests of multi-links share. */
#ifndef TESTS_LINK_SURFACES_H
#define TESTS_LINK_SURFACES_H

#include <isoslice/link.h>

enum { SURFACE_FACES_MAX = 1024, SURFACE_CORNERS_MAX = 4096, SURFACE_VERTICES_MAX = 1024 };

typedef struct polyhedron {
    int32_t first[SURFACE_FACES_MAX + 1], vertex[SURFACE_CORNERS_MAX];
    double position[3 * SURFACE_VERTICES_MAX];
    iso_faces faces; /* points into the above */
} polyhedron;

void make_tetrahedron(polyhedron *s);
void make_dodecahedron(polyhedron *s);        /* edge sqrt(5) - 1, centre 0 */
void make_torus(polyhedron *s, int n, int m); /* n m triangle pairs, radii 2 and 1, axis z */
void make_prism_box(polyhedron *s);           /* a hexagonal prism: faces of 6 and of 4 corners */
void drop_face(polyhedron *s, int32_t face);

/* The seed's cylinder: 720 indexes, two rings of 360, as arrays. */
typedef struct cylinder {
    int32_t alpha[720], beta[720];
    double g[3 * 720];
} cylinder;
void make_cylinder(cylinder *c);

/* A deterministic generator: the same numbers everywhere. */
uint32_t next_random(uint64_t *state);

#endif

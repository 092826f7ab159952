/* Parts made of rings, on which ways along the surface are known. */
#ifndef TESTS_CHANNEL_SHAPES_H
#define TESTS_CHANNEL_SHAPES_H

#include <isoslice/mesh.h>

/* A solid with elliptic sections: radius(z) times (stretch_x, stretch_y), moved by slant z in x. */
typedef struct shape {
    double (*radius)(double z);
    double low, high, stretch_x, stretch_y, slant;
    int sides, rings; /* rings evenly spaced in z */
} shape;

void shape_mesh(iso_mesh *mesh, const shape *s);
/* Ring j, side i, as in the mesh. */
iso_vec3 shape_point(const shape *s, int i, int j);

double cone_radius(double z);       /* 30 at 0, 10 at 40 */
double sphere_radius(double z);     /* 30, from -25 to 25 */
double paraboloid_radius(double z); /* z = r^2 / 20 */
double cylinder_radius(double z);   /* 20 */

/* mm along the surface from the one height to the other. */
double cone_way(double from, double to);
double sphere_way(double from, double to);
double paraboloid_way(double from, double to);

/* A box, by its corners. */
void box_mesh(iso_mesh *mesh, iso_vec3 low, iso_vec3 high);
/* A plate, box 0, and boxes that stand on its top, apart from each other. */
void plate_mesh(iso_mesh *mesh, const double (*low)[3], const double (*high)[3], int count);
/* A post of so large a radius, with `hole`, of straight sides and rings, through all of it. */
void ring_mesh(iso_mesh *mesh, double radius, const shape *hole);
/* Two arms of 70 x 25 mm, 60 mm tall, from (0, 0). */
void angle_mesh(iso_mesh *mesh);
/* A block of 70 x 50 mm with a slot from y = 15 to 50 between x = 30 and 40, 60 mm tall. */
void slot_mesh(iso_mesh *mesh);

#endif

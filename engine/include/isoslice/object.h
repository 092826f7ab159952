/* Objects: what is printed as one, made of meshes; and where its copies stand on the bed.
 *
 *     meshes -> iso_objects_make -> objects -> iso_objects_place -> instances
 *            -> iso_objects_sequence (one after the other only) -> printing order
 *
 * A job that prints layer by layer needs no sequence. Placing and sequence need the meshes, so they
 * come before slicing lets them go. */
#ifndef ISOSLICE_OBJECT_H
#define ISOSLICE_OBJECT_H

#include <stdbool.h>

#include <isoslice/mesh.h>
#include <isoslice/planar.h>
#include <isoslice/status.h>

/* ---- one mesh, or several that keep their places to each other ---- */

/* What is done to a model, in the order of the members. Zero-initialised it does nothing. */
typedef struct iso_transform {
    bool inches;      /* numbers are inches: 25.4 times as large */
    double scale;     /* factor; 0 counts as 1 */
    bool mirror[3];   /* by iso_axis; triangles are turned along */
    double rotate[3]; /* degrees counter-clockwise about X, then Y, then Z */
    iso_vec3 fit;     /* mm; scaled again so that the box just fits; 0: any size will do */
} iso_transform;

/* Transform meshes together about the middle of their common box, which stays where it is. Mirrors
 * and turns by 90 degrees only swap and negate coordinates. ISO_USAGE: a number that isn't finite
 * or is negative; ISO_OUTSIDE: the result is beyond 10 km. On failure the meshes are as before. */
ISO_API iso_status iso_meshes_transform(iso_mesh *mesh, int32_t count,
                                        const iso_transform *transform) ISO_MUST_CHECK;

/* Cut by the plane at z into two closed meshes, whose volumes add up; either destination may be
 * NULL. A corner on the plane is in both, if something of both hangs on it, and a flat face in the
 * plane in the half that it bounds. What has nothing on its side is an empty mesh (triangle_count
 * 0). `mesh` stays as it is. ISO_USAGE: z isn't finite. ISO_OUTSIDE: larger than 3.3 m. */
ISO_API iso_status iso_mesh_cut(iso_mesh *lower, iso_mesh *upper, const iso_mesh *mesh,
                                double z) ISO_MUST_CHECK;

/* Every connected piece as a mesh of its own, in the order of their first triangles; a cavity goes
 * with the piece directly around it. *piece is an array of *count meshes: free them, then it with
 * iso_meshes_free. */
ISO_API iso_status iso_mesh_split(iso_mesh **piece, int32_t *count,
                                  const iso_mesh *mesh) ISO_MUST_CHECK;

/* Free an array of meshes that this library allocated, and the meshes in it. */
ISO_API void iso_meshes_free(iso_mesh *mesh, int32_t count);

/* The convex hull of the meshes seen from above, counter-clockwise, no three points on a line,
 * rounded outwards to units; replaces what `hull` held. ISO_OUTSIDE: beyond the kernel's range. */
ISO_API iso_status iso_meshes_hull(iso_region *hull, const iso_mesh *mesh,
                                   int32_t count) ISO_MUST_CHECK;

/* The same of what is at z or below it; without contours if nothing is. */
ISO_API iso_status iso_meshes_hull_below(iso_region *hull, const iso_mesh *mesh, int32_t count,
                                         double z) ISO_MUST_CHECK;

/* ---- objects ---- */

enum { ISO_OBJECT_NAME_SIZE = 128 };

typedef struct iso_object {
    char name[ISO_OBJECT_NAME_SIZE]; /* the file's, without its directory; pieces add to it */
    int32_t mesh_count;
    iso_mesh *mesh;    /* [mesh_count], owned; what they overlap in counts once */
    iso_vec3 min, max; /* of all of them: min.x = -max.x, min.y = -max.y, about */
    iso_vec2 origin;   /* mm, where x = y = 0 was in the files, */
    double floor;      /* and z = 0 */
    iso_region hull;   /* seen from above; empty until iso_objects_find_hulls */
    iso_region foot;   /* of what is low; empty until iso_objects_find_feet */
} iso_object;

typedef struct iso_objects {
    int32_t count;
    iso_object *object;
} iso_objects;

typedef struct iso_object_options {
    iso_transform transform;
    double cut;      /* mm above the model's lowest point; 0 doesn't cut */
    bool drop_lower; /* of a cut model; not both of them */
    bool drop_upper;
    bool split;       /* every connected piece is an object */
    bool apart;       /* every model is an object; else all of them together are one */
    bool float_above; /* leave z as it is; else every object is set down at z = 0 */
} iso_object_options;

/* Transform, cut, split and group `count` meshes, whose files were called name[i]. Every object's
 * box is centred at x = y = 0. Takes the meshes over: they are empty afterwards, also on failure.
 * Statuses of the functions above; ISO_OUTSIDE: nothing is left of a cut model. */
ISO_API iso_status iso_objects_make(iso_objects *objects, iso_mesh *mesh, const char *const *name,
                                    int32_t count,
                                    const iso_object_options *options) ISO_MUST_CHECK;
ISO_API void iso_objects_free(iso_objects *objects);

/* Fill in the hulls that are missing; placing and sequence do it by themselves. */
ISO_API iso_status iso_objects_find_hulls(iso_objects *objects) ISO_MUST_CHECK;

/* Fill in the hulls of what is at z or below it; that of an object floating above stays empty. */
ISO_API iso_status iso_objects_find_feet(iso_objects *objects, double z) ISO_MUST_CHECK;

/* ---- places on the bed ---- */

typedef struct iso_instance {
    int32_t object; /* which one this is a copy of */
    int32_t copy;   /* counts from 0 within the object */
    iso_point by;   /* units, added to the object's coordinates */
} iso_instance;

typedef struct iso_instances {
    int32_t count;
    iso_instance *instance; /* [count] by object, then copy, until they are put into sequence */
} iso_instances;

typedef struct iso_placing {
    const iso_vec2 *bed; /* [bed_count] mm, a polygon of any shape around the bed */
    int32_t bed_count;
    bool by_hull;          /* nest convex hulls, as printing one by one needs, not outlines */
    bool keep;             /* single copies stay where the files have them, come what may */
    bool has_center;       /* else the middle of the bed's box */
    iso_vec2 center;       /* mm; where the middle of everything comes to lie if there is room */
    int32_t copies;        /* of each object; 0 counts as 1 */
    int32_t columns, rows; /* both above 0: copies in a grid, whatever `copies` says */
    double distance;       /* mm between two objects */
    double margin;         /* mm that stay free along the bed's edge, for a skirt */
} iso_placing;

/* Find a place for every copy: a single one and a grid are centred, wherever that reaches to;
 * several are nested so that all lie on the bed and their outlines, seen from above without holes,
 * are at least `distance` (less a micrometre) from each other, and around the centre if they fit
 * so. The same places every time. ISO_OUTSIDE: they don't fit; the message names the first object
 * left over and how many did fit.
 */
ISO_API iso_status iso_objects_place(iso_instances *instances, iso_objects *objects,
                                     const iso_placing *placing,
                                     iso_planar_scratch *scratch) ISO_MUST_CHECK;
ISO_API void iso_instances_free(iso_instances *instances);

/* ---- one after the other ---- */

typedef struct iso_clearance {
    double radius; /* mm around the nozzle's axis that the print head takes up */
    double height; /* mm from the nozzle's tip up to what moves across the whole bed */
} iso_clearance;

/* Put the instances into the order in which they are printed whole, one after the other: lower ones
 * first, else as they are. ISO_OUTSIDE: two of them are nearer than the radius, or one that isn't
 * the last is higher than the clearance; the message names them and the distance. */
ISO_API iso_status iso_objects_sequence(iso_instances *instances, iso_objects *objects,
                                        const iso_clearance *clearance) ISO_MUST_CHECK;

#endif

/* A triangle mesh as a double-link on its corners.
 *
 * Darts are corners: dart a = 3 t + k runs from corner k of triangle t to the next corner, its face
 * on the left seen from outside (counter-clockwise triangles). On the darts
 *
 *     alpha(a)     next corner of the same face; implicit: a + 1, or a - 2 at k = 2
 *     opposite(a)  the neighbour's dart on the same edge; stored; an involution that fixes none
 *     beta(a)      opposite(alpha^-1(a)): turns counter-clockwise about the vertex
 *     v(a)         origin vertex; stored
 *
 * so that beta alpha = opposite and (alpha beta)^2 = 1 (paper, 4.1.4). */
#ifndef ISOSLICE_MESH_H
#define ISOSLICE_MESH_H

#include <isoslice/geometry.h>
#include <isoslice/status.h>

/* What reading and mending found. Counts of the input and of what was done about it. */
typedef struct iso_mesh_defects {
    int64_t triangles_read;
    int64_t degenerate;        /* triangles with two equal corners; dropped */
    int64_t duplicate;         /* triangles that occur again and are not needed; dropped */
    int64_t cancelled;         /* coincident opposite triangles; dropped in pairs */
    int64_t welded_vertices;   /* merged across seams of at most 10 um */
    int64_t bad_edges;         /* edges without exactly two opposite darts, after exact welding */
    int64_t flipped_triangles; /* turned to agree with their shell */
    int64_t inverted_shells;   /* turned inside out */
    int64_t holes_closed;      /* boundary loops closed by caps */
    double cap_area;           /* mm^2 of those caps */
    int64_t sheets;            /* open surfaces that were given a thickness */
    double sheet_thickness;    /* mm, of those */
    double voxel;              /* mm; above 0: the surface was made anew on a grid so fine */
    double largest_error;      /* mm, of the new surface to the triangles that were read */
    double mean_error;         /* mm */
    int64_t shells;            /* connected components of the result */
} iso_mesh_defects;

typedef struct iso_mesh {
    int32_t triangle_count;
    int32_t vertex_count;
    int32_t *origin;    /* [3 triangle_count] v: vertex of each dart */
    int32_t *opposite;  /* [3 triangle_count] */
    iso_vec3 *position; /* [vertex_count] mm */
    iso_vec3 min, max;  /* bounding box of the vertices that darts use */
    iso_mesh_defects defects;
} iso_mesh;

static inline int32_t iso_mesh_alpha(int32_t dart) {
    return dart % 3 == 2 ? dart - 2 : dart + 1;
}

static inline int32_t iso_mesh_alpha_inverse(int32_t dart) {
    return dart % 3 == 0 ? dart + 2 : dart - 1;
}

/* Read an STL file, binary or ASCII by its content, weld it exactly, build the double-link and mend
 * or refuse its defects (docs/models.md has the rules). The mesh owns its arrays; free it with
 * iso_mesh_free. ISO_UNREADABLE: no file, not a model, truncated, NaN, infinite or absurd (beyond
 * 10 km) coordinates. ISO_UNSLICEABLE: open beyond mending, not orientable. */
ISO_API iso_status iso_mesh_read(iso_mesh *mesh, const char *path) ISO_MUST_CHECK;

/* The same from memory: `triangle` is [9 count] floats, x y z of three corners each. */
ISO_API iso_status iso_mesh_from_triangles(iso_mesh *mesh, const float *triangle,
                                           int64_t count) ISO_MUST_CHECK;

/* What becomes of surfaces that mending alone would refuse. Zeros: they are refused. */
typedef struct iso_mesh_options {
    int32_t volume; /* not 0: whatever was read is made anew, around what its triangles enclose; or,
                     * with a sheet_thickness, around all that is within half of it */
    double voxel;   /* mm, of the grid that this is done on; 0: 1/300 of the box's largest side */
    double sheet_thickness; /* mm, that open surfaces are given; 0: none */
} iso_mesh_options;

/* options may be NULL: zeros. ISO_BAD_CONFIG: a volume was asked for, and the module that makes it
 * is missing. */
ISO_API iso_status iso_mesh_read_with(iso_mesh *mesh, const char *path,
                                      const iso_mesh_options *options) ISO_MUST_CHECK;
ISO_API iso_status iso_mesh_from_triangles_with(iso_mesh *mesh, const float *triangle,
                                                int64_t count,
                                                const iso_mesh_options *options) ISO_MUST_CHECK;

ISO_API void iso_mesh_free(iso_mesh *mesh);

/* Move every vertex, and the box with them. */
ISO_API void iso_mesh_translate(iso_mesh *mesh, iso_vec3 offset);

/* Move meshes together, so that the middle of their common box comes to lie at `center` and its
 * floor at z = 0. */
ISO_API void iso_meshes_place(iso_mesh *mesh, int32_t count, iso_vec2 center);

/* Signed volume in mm^3, by the divergence theorem; exact up to rounding on a closed mesh. */
ISO_API double iso_mesh_volume(const iso_mesh *mesh);

/* Volume of the part with z0 <= z <= z1, in closed form: nothing is sliced. */
ISO_API double iso_mesh_volume_between(const iso_mesh *mesh, double z0, double z1);

/* Check every equation of the double-link; the message names the first that fails and the dart. */
ISO_API iso_status iso_mesh_validate(const iso_mesh *mesh) ISO_MUST_CHECK;

#endif

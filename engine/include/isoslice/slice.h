/* Iso-slicing: a mesh and a height become a coloured link, all levels at once (paper, 5).
 *
 * For level r the crossings are A_r = { a : h(a) <= r < h(alpha a) }. The successor of a crossing
 * is found by arithmetic alone: in the neighbour's triangle it is one of two darts. Orbits close:
 * outer contours run counter-clockwise and holes clockwise seen against the gradient, material on
 * the left. */
#ifndef ISOSLICE_SLICE_H
#define ISOSLICE_SLICE_H

#include <isoslice/field.h>
#include <isoslice/geometry.h>
#include <isoslice/mesh.h>
#include <isoslice/status.h>

/* Printed layers. Layer i is cut at `cut[i]` and printed with its top at `top[i]`, `height[i]`
 * thick. */
typedef struct iso_levels {
    int32_t count;
    double *cut;    /* [count] ascending, value of the field in mm */
    double *top;    /* [count] ascending */
    double *height; /* [count] */
} iso_levels;

/* One layer of thickness `first`, then layers of `height`, cut at their middles, as many as have
 * their middle below `object_height` (mm, all of them). */
ISO_API iso_status iso_levels_uniform(iso_levels *levels, double object_height, double first,
                                      double height) ISO_MUST_CHECK;
/* The same for any list of heights, bottom up; behind its end the last one goes on. Layers whose
 * middle is not below `object_height` are left out. ISO_USAGE: a height that is not above 0. */
ISO_API iso_status iso_levels_from_heights(iso_levels *levels, const double *height, int32_t count,
                                           double object_height) ISO_MUST_CHECK;
typedef struct iso_adaptive_options {
    double first;    /* mm, thickness of the first layer */
    double min, max; /* mm, of every other one */
    double cusp;     /* mm that a step may stand off the surface; min wins over it */
} iso_adaptive_options;

/* Layers as thick as the slope of the surface allows, `cusp` its largest distance from their edges
 * (Dolenc and Makela, Slicing procedures for layered manufacturing techniques, 1994). Thickness
 * changes from layer to layer by a fifth of the way between min and max at most, but that a layer
 * ends at a flat top where one is near. `mesh` are the models of one object, set down at z = 0.
 * ISO_USAGE: a number that isn't above 0, min above max. */
ISO_API iso_status iso_levels_adaptive(iso_levels *levels, const iso_mesh *mesh, int32_t count,
                                       const iso_adaptive_options *options) ISO_MUST_CHECK;
ISO_API void iso_levels_free(iso_levels *levels);

/* A coloured link in canonical order: contours by colour (the level's index), within a colour by
 * the lowest dart that starts them; a contour's crossings are consecutive, so successor(i) is i + 1
 * or, at its end, its start. The successor is stored all the same where the link leaves for a file
 * (link.h). */
typedef struct iso_slices {
    int32_t level_count;
    int32_t contour_count;
    int64_t crossing_count;
    int32_t *level_first;   /* [level_count + 1] contours of each level */
    int64_t *contour_first; /* [contour_count + 1] crossings of each contour */
    iso_vec2 *point;        /* [crossing_count] mm, in the chart of the level (planar: x, y) */
} iso_slices;

/* Cut by planes z = levels->cut[i]. The slices own their arrays. */
ISO_API iso_status iso_slice_planar(iso_slices *slices, const iso_mesh *mesh,
                                    const iso_levels *levels) ISO_MUST_CHECK;
/* Several models cut at the same levels as one: level by level the contours of the first, then
 * those of the next. Of coinciding material it has both outlines. `joined` owns its arrays. */
ISO_API iso_status iso_slices_join(iso_slices *joined, const iso_slices *slices,
                                   int32_t count) ISO_MUST_CHECK;
/* ---- by any field ---- */

/* Contours in space: a coloured link as iso_slices is, with its points where they are. */
typedef struct iso_curves {
    int32_t level_count;
    int32_t contour_count;
    int64_t crossing_count;
    int32_t *level_first;   /* [level_count + 1] contours of each level */
    int64_t *contour_first; /* [contour_count + 1] crossings of each contour */
    iso_vec3 *point;        /* [crossing_count] mm */
} iso_curves;

typedef struct iso_field_slicing {
    double tolerance;  /* mm that a chord may be off the curve it stands for; 0: any distance */
    double resolution; /* mm: shorter edges aren't split any more, whatever may lie between */
} iso_field_slicing;
ISO_API iso_field_slicing iso_field_slicing_defaults(void); /* 0.01, 0.002 */

/* Cut a mesh by F = level[i], ascending strictly. Faces are split, edge by edge so that neighbours
 * agree, until F is unimodal on them, or misses every level, for certain: loops inside one triangle
 * are found too. Points lie on the mesh, and on the level within 1 um (as far as the gradient
 * allows). Every contour of a closed mesh closes; seen against the gradient material is on the
 * left. ISO_UNSLICEABLE: F has no value at some point of the mesh, or jumps there; the message
 * names it. ISO_OUTSIDE: F is so wild that millions of faces aren't enough. `options` NULL: the
 * defaults. A field that is measured along the mesh itself is linear on its faces, which are not
 * split (iso_slice_heights). */
ISO_API iso_status iso_slice_field(iso_curves *curves, const iso_mesh *mesh, const iso_field *field,
                                   const double *level, int32_t level_count,
                                   const iso_field_slicing *options) ISO_MUST_CHECK;

/* Cut by heights given at the vertices ([vertex_count]), linear between them. */
ISO_API iso_status iso_slice_heights(iso_curves *curves, const iso_mesh *mesh, const double *height,
                                     const double *level, int32_t level_count) ISO_MUST_CHECK;
ISO_API void iso_curves_free(iso_curves *curves);

ISO_API void iso_slices_free(iso_slices *slices);
ISO_API iso_status iso_slices_validate(const iso_slices *slices) ISO_MUST_CHECK;

#endif

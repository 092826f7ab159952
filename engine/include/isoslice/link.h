/* Multi-links: the one data structure of the engine (paper, 4).
 *
 * A multi-link is a set of indexes A = {0 .. size - 1} with endomaps of A (logic), a realisation
 * g : A -> R^n (geometry) and projections of A (function: face, vertex, layer, colour, material).
 * The kinds differ in their maps and in the equations these satisfy (docs/multi-link.md has the
 * table). Every kind is a type of its own around one iso_multilink, so that what works on the
 * general structure - validator, orbits, copy, file - works on all of them:
 *
 *     iso_double_link surface;
 *     ISO_TRY(iso_double_link_from_faces(&surface, &faces, ISO_BOUNDARY_REFUSED));
 *     ISO_TRY(iso_multilink_orbits(edge, &edges, &surface.link, "βα"));
 *     iso_multilink_free(&surface.link);
 *
 * Composition is right to left: βα applies α first. Names of maps are UTF-8. */
#ifndef ISOSLICE_LINK_H
#define ISOSLICE_LINK_H

#include <stddef.h>
#include <stdint.h>

#include <isoslice/mesh.h>
#include <isoslice/slice.h>
#include <isoslice/status.h>

enum { ISO_LINK_MAPS_MAX = 8, ISO_LINK_DIMENSION_MAX = 16, ISO_LINK_NAME_SIZE = 16 };

/* The values are those of the file format. */
typedef enum iso_link_kind {
    ISO_KIND_LINK = 0,          /* φ */
    ISO_KIND_COLOURED_LINK = 1, /* φ; c */
    ISO_KIND_SQUARE_LINK = 2,   /* α, β */
    ISO_KIND_TRIANGULATION = 3, /* θ, φ */
    ISO_KIND_SQUARE_PATCH = 4,  /* θ, φ */
    ISO_KIND_DOUBLE_LINK = 5,   /* α, β; f, v */
    ISO_KIND_CUBIC_LINK = 6,    /* α, β, γ */
    ISO_KIND_CUBE_LINK = 7,     /* α₁ .. αₙ */
    ISO_KIND_FILLING_LINK = 8,  /* r, s, g; q, p */
    ISO_KIND_COUNT
} iso_link_kind;

/* Most maps of the engine are steps along an axis of some lattice, which no array need hold: the
 * place of a on the axis is a / stride % length. (Next corner of a triangle: cyclic, stride 1,
 * length 3. Other end of a fill segment, d ^ 2: cyclic, stride 2, length 2.) */
typedef enum iso_map_rule {
    ISO_MAP_STORED = 0,    /* image[a] */
    ISO_MAP_CYCLIC = 1,    /* a step along the axis, from its end to its start */
    ISO_MAP_CLAMPED = 2,   /* a step along the axis, staying at its end: not injective */
    ISO_MAP_COORDINATE = 3 /* the place on the axis itself; for projections alone */
} iso_map_rule;

typedef struct iso_map {
    char name[ISO_LINK_NAME_SIZE]; /* UTF-8, NUL-terminated */
    iso_map_rule rule;
    int32_t stride, length; /* of the axis; size is a multiple of stride * length in endomaps */
    int32_t range;          /* values are 0 .. range - 1; in endomaps range = size */
    const int32_t *image;   /* [size] if stored, else NULL */
} iso_map;

static inline int32_t iso_map_at(const iso_map *map, int32_t a) {
    if (map->rule == ISO_MAP_STORED)
        return map->image[a];
    int32_t place = a / map->stride % map->length;
    if (map->rule == ISO_MAP_COORDINATE)
        return place;
    if (place + 1 < map->length)
        return a + map->stride;
    return map->rule == ISO_MAP_CLAMPED ? a : a - place * map->stride;
}

typedef struct iso_multilink {
    iso_link_kind kind;
    int32_t size;
    int32_t map_count, projection_count;
    int32_t dimension; /* n of R^n; 0 is no geometry */
    int32_t owns;      /* whether the arrays are released with the link; a view borrows them */
    const double *g;   /* [size * dimension], index-major */
    iso_map map[ISO_LINK_MAPS_MAX];
    iso_map projection[ISO_LINK_MAPS_MAX]; /* those of the kind, then any others */
} iso_multilink;

typedef struct iso_link {
    iso_multilink link;
} iso_link;
typedef struct iso_coloured_link {
    iso_multilink link;
} iso_coloured_link;
typedef struct iso_square_link {
    iso_multilink link;
} iso_square_link;
typedef struct iso_triangulation {
    iso_multilink link;
} iso_triangulation;
typedef struct iso_square_patch {
    iso_multilink link;
} iso_square_patch;
typedef struct iso_double_link {
    iso_multilink link;
} iso_double_link;
typedef struct iso_cubic_link {
    iso_multilink link;
} iso_cubic_link;
typedef struct iso_cube_link {
    iso_multilink link;
} iso_cube_link;
typedef struct iso_filling_link {
    iso_multilink link;
} iso_filling_link;

/* ---- What every kind has ---- */

/* "double-link", "n-cube-link" ... */
ISO_API const char *iso_link_kind_name(iso_link_kind kind);

/* A view of the caller's arrays, with the maps and projections that the kind has under their
 * names, still without images. An n-cube-link gets map_count maps, other kinds ignore it. */
ISO_API iso_multilink iso_multilink_view(iso_link_kind kind, int32_t size, int map_count,
                                         int dimension, const double *g);
/* Set the image of a map or a projection of a view; names stay. */
ISO_API void iso_map_store(iso_map *map, const int32_t *image, int32_t range);
ISO_API void iso_map_step(iso_map *map, iso_map_rule rule, int32_t stride, int32_t length,
                          int32_t range);
/* Add a projection that the kind does not have, after those it has. No more than
 * ISO_LINK_MAPS_MAX in all: the validator says so. */
ISO_API iso_map *iso_multilink_add_projection(iso_multilink *view, const char *name);

/* A copy that owns its arrays, validated. */
ISO_API iso_status iso_multilink_copy(iso_multilink *out, const iso_multilink *link) ISO_MUST_CHECK;
ISO_API void iso_multilink_free(iso_multilink *link);

/* Shape, ranges of all values, finite geometry, and every equation of the kind at every index.
 * ISO_NOT_VERIFIED with a message such as "double-link: vβ = v fails at index 7: 3 and 2". */
ISO_API iso_status iso_multilink_validate(const iso_multilink *link) ISO_MUST_CHECK;

/* Label the orbits of a set of words in the maps, separated by spaces: "β" gives the vertices of a
 * double-link, "βα" its edges, "α β" its connected parts. Maps that are no bijections are followed
 * both ways. orbit[a] is 0 .. *count - 1, numbered by their lowest index. orbit: [size]. */
ISO_API iso_status iso_multilink_orbits(int32_t *orbit, int32_t *count, const iso_multilink *link,
                                        const char *words) ISO_MUST_CHECK;

/* Is the word a bijection? A link of closed curves is one whose φ is; the message names two
 * indexes with the same image. */
ISO_API iso_status iso_multilink_check_bijective(const iso_multilink *link,
                                                 const char *word) ISO_MUST_CHECK;

/* ---- Files (docs/link-file.md) ---- */

/* How the file keeps g. Four bytes round each coordinate to the nearest float. */
typedef enum iso_link_number { ISO_LINK_FLOAT32 = 4, ISO_LINK_FLOAT64 = 8 } iso_link_number;

/* Write to `path` ("-" is standard output), whole or not at all. */
ISO_API iso_status iso_multilink_write(const char *path, const iso_multilink *link,
                                       iso_link_number number) ISO_MUST_CHECK;

/* Read a file, or the bytes of one. Lengths, shape and the range of every value are checked, so
 * that maps can be followed safely; iso_multilink_validate checks the equations.
 * ISO_UNREADABLE if it is no such file. The link owns its arrays; once its kind is checked,
 * `iso_double_link surface = {link};` gives it its type. */
ISO_API iso_status iso_multilink_read(iso_multilink *link, const char *path) ISO_MUST_CHECK;
ISO_API iso_status iso_multilink_decode(iso_multilink *link, const void *bytes,
                                        size_t size) ISO_MUST_CHECK;

/* ---- Curves ---- */

/* Arrays are copied, here and below; `dimension` may be 0 with g NULL. The result is validated. */
ISO_API iso_status iso_link_new(iso_link *out, int32_t size, const int32_t *successor,
                                int dimension, const double *g) ISO_MUST_CHECK;
ISO_API iso_status iso_coloured_link_new(iso_coloured_link *out, int32_t size,
                                         const int32_t *successor, const int32_t *colour,
                                         int dimension, const double *g) ISO_MUST_CHECK;

/* Link a directed graph (paper, 5d): successor is a bijection of the edges with
 * domain[successor[e]] = codomain[e]. At each vertex the k-th edge that arrives is followed by the
 * k-th that leaves. ISO_USAGE, naming the vertex, if some vertex has not as many of the one as of
 * the other. successor: [edge_count]. */
ISO_API iso_status iso_link_digraph(int32_t *successor, int32_t edge_count, int32_t vertex_count,
                                    const int32_t *domain, const int32_t *codomain) ISO_MUST_CHECK;

/* The contours of a sliced mesh as a coloured link: successor stored, colour = level. With levels
 * g is (x, y, levels->cut[colour]), with NULL (x, y). */
ISO_API iso_status iso_slices_to_link(iso_coloured_link *out, const iso_slices *slices,
                                      const iso_levels *levels) ISO_MUST_CHECK;

/* Contours in space the same way, g = (x, y, z). */
ISO_API iso_status iso_curves_to_link(iso_coloured_link *out,
                                      const iso_curves *curves) ISO_MUST_CHECK;

/* ---- Lattices: square-link, cubic-link, n-cube-link ---- */

typedef struct iso_axis {
    int32_t length;
    int32_t wraps; /* the step from the end leads to the start; else it stays */
} iso_axis;

/* From stored maps, which must commute. */
ISO_API iso_status iso_square_link_new(iso_square_link *out, int32_t size, const int32_t *alpha,
                                       const int32_t *beta, int dimension,
                                       const double *g) ISO_MUST_CHECK;

/* The full box of the axes, maps implicit: index = i + length0 (j + length1 (k + ...)). material
 * ([size], values >= 0, or NULL) becomes the projection p; what is void is a material too, since
 * the maps of a box with voxels left out do not commute. */
ISO_API iso_status iso_square_link_box(iso_square_link *out, const iso_axis axis[2], int dimension,
                                       const double *g) ISO_MUST_CHECK;
ISO_API iso_status iso_cubic_link_box(iso_cubic_link *out, const iso_axis axis[3], int dimension,
                                      const double *g, const int32_t *material) ISO_MUST_CHECK;
ISO_API iso_status iso_cube_link_box(iso_cube_link *out, int axis_count, const iso_axis *axis,
                                     int dimension, const double *g,
                                     const int32_t *material) ISO_MUST_CHECK;

/* ---- Surfaces: double-link, triangulation, square patch ---- */

/* Polygons, counter-clockwise seen from outside: face i has the corners
 * vertex[first[i]] .. vertex[first[i + 1] - 1], three or more. */
typedef struct iso_faces {
    int32_t face_count, vertex_count;
    const int32_t *first;   /* [face_count + 1]; NULL: all are triangles */
    const int32_t *vertex;  /* [first[face_count]] */
    int32_t dimension;      /* of position; 0 is none */
    const double *position; /* [vertex_count * dimension] */
} iso_faces;

/* A boundary dart can't be its own opposite: that breaks vβ = v. Either there is none, or each
 * boundary loop is closed by a fan of triangles to a vertex of its own, the loop's mean. */
typedef enum iso_boundary { ISO_BOUNDARY_REFUSED, ISO_BOUNDARY_FANNED } iso_boundary;

/* Darts are corners in the order of `vertex`; fans follow (darts, faces and vertices alike).
 * ISO_USAGE, naming face and edge, if faces don't fit together in pairs. */
ISO_API iso_status iso_double_link_from_faces(iso_double_link *out, const iso_faces *faces,
                                              iso_boundary boundary) ISO_MUST_CHECK;
ISO_API iso_status iso_double_link_from_mesh(iso_double_link *out,
                                             const iso_mesh *mesh) ISO_MUST_CHECK;

/* The squares a, α(a), αβ(a), β(a); those with α(a) = a or β(a) = a are none and are left out. */
ISO_API iso_status iso_double_link_from_square_link(iso_double_link *out,
                                                    const iso_square_link *square_link,
                                                    iso_boundary boundary) ISO_MUST_CHECK;

static inline int32_t iso_double_link_alpha(const iso_double_link *surface, int32_t dart) {
    return iso_map_at(&surface->link.map[0], dart);
}
static inline int32_t iso_double_link_beta(const iso_double_link *surface, int32_t dart) {
    return iso_map_at(&surface->link.map[1], dart);
}
static inline int32_t iso_double_link_opposite(const iso_double_link *surface, int32_t dart) {
    return iso_double_link_beta(surface, iso_double_link_alpha(surface, dart));
}
static inline int32_t iso_double_link_face(const iso_double_link *surface, int32_t dart) {
    return iso_map_at(&surface->link.projection[0], dart);
}
static inline int32_t iso_double_link_vertex(const iso_double_link *surface, int32_t dart) {
    return iso_map_at(&surface->link.projection[1], dart);
}

/* Orbits of α, β, βα and of all; a bow-tie vertex counts once a fan. */
typedef struct iso_surface_counts {
    int32_t faces, vertices, edges, parts;
    int32_t euler; /* vertices - edges + faces; 2 parts - 2 handles */
} iso_surface_counts;
ISO_API iso_status iso_double_link_count(iso_surface_counts *counts,
                                         const iso_double_link *surface) ISO_MUST_CHECK;

ISO_API iso_status iso_triangulation_new(iso_triangulation *out, int32_t size, const int32_t *theta,
                                         const int32_t *phi, int dimension,
                                         const double *g) ISO_MUST_CHECK;
ISO_API iso_status iso_square_patch_new(iso_square_patch *out, int32_t size, const int32_t *theta,
                                        const int32_t *phi, int dimension,
                                        const double *g) ISO_MUST_CHECK;

/* Index 4 a + k is corner k of the square of a. Both maps must be bijections: else the patch has a
 * boundary and φ is not total (iso_double_link_from_square_link can close it). */
ISO_API iso_status iso_square_patch_from_square_link(
    iso_square_patch *out, const iso_square_link *square_link) ISO_MUST_CHECK;

/* θ = α, φ = β: a triangulation is a double-link of triangles that forgets f and v, which are the
 * orbits of θ and φ. The same with squares. */
ISO_API iso_status iso_triangulation_from_double_link(
    iso_triangulation *out, const iso_double_link *surface) ISO_MUST_CHECK;
ISO_API iso_status iso_square_patch_from_double_link(iso_square_patch *out,
                                                     const iso_double_link *surface) ISO_MUST_CHECK;
ISO_API iso_status iso_double_link_from_triangulation(
    iso_double_link *out, const iso_triangulation *triangulation) ISO_MUST_CHECK;
ISO_API iso_status iso_double_link_from_square_patch(iso_double_link *out,
                                                     const iso_square_patch *patch) ISO_MUST_CHECK;

/* Iso-slice any surface of convex faces by any heights (paper, 5): `height` is [size], one a dart,
 * the same around a vertex; `level` ascends strictly. The crossings { a : h(a) <= r < h(αa) } come
 * dart by dart, within a dart level by level; the colour c is the level's number, the projection
 * "dart" the dart, g lies on the edge in the surface's own R^n. Every contour closes; seen against
 * the gradient of h, material is on the left. */
ISO_API iso_status iso_slice_double_link(iso_coloured_link *out, const iso_double_link *surface,
                                         const double *height, const double *level,
                                         int32_t level_count) ISO_MUST_CHECK;

/* The same by a field, on a surface in R^3: heights are its values at the darts' places, and
 * crossings lie where it has the level on the edge, within 1 um. Darts stay what they are, so
 * nothing is split here: ISO_UNSLICEABLE, naming the face, where a level may cross a face in more
 * than one line (or an edge more than once) for all that the field's bounds tell. Finer faces help;
 * so does iso_slice_field, which splits them. */
ISO_API iso_status iso_slice_double_link_field(iso_coloured_link *out,
                                               const iso_double_link *surface,
                                               const iso_field *field, const double *level,
                                               int32_t level_count) ISO_MUST_CHECK;

/* ---- Contour filling (paper, 4.2) ---- */

/* Index d = 2 c + side: crossing c of a sweep line with the boundary, below or above the line.
 * r = d ^ 2, the other end of the inside interval, and s = d ^ 1, the other side, are implicit;
 * g = arc[d], the other end of the boundary's arc within the strip. Projections q = line[c],
 * p = contour[c]. arc: [2 crossing_count], line and contour: [crossing_count]. */
ISO_API iso_status iso_filling_link_new(iso_filling_link *out, int32_t crossing_count,
                                        const int32_t *arc, const int32_t *line,
                                        const int32_t *contour) ISO_MUST_CHECK;

#endif

/* The planar kernel: exact integer regions, booleans, offsets.
 *
 * Coordinates are iso_points (1 unit = 100 nm, |x|, |y| <= 2^24). No float decides anything. Every
 * operation builds an arrangement, a double-link whose faces carry winding numbers, unless it can
 * prove that nothing collides. Results are snap-rounded: a boundary moves by at most about a unit.
 */
#ifndef ISOSLICE_PLANAR_H
#define ISOSLICE_PLANAR_H

#include <isoslice/geometry.h>
#include <isoslice/status.h>

/* Closed contours, flat: contour i is point[first[i]] .. point[first[i + 1] - 1], the last point
 * joined to the first. Zero-initialise; keeps its capacity from use to use; iso_region_free at the
 * end.
 *
 * A *region* additionally is clean: contours don't cross or overlap (they may touch in points),
 * outer ones run counter-clockwise, holes clockwise, and parent[i] is the contour directly around
 * contour i, or -1. parent[i] < i. An island in a hole has the hole as its parent. */
typedef struct iso_region {
    int32_t count;    /* contours */
    int32_t *first;   /* [count + 1]; NULL only while count = 0 and nothing was ever added */
    iso_point *point; /* [first[count]] */
    int32_t *parent;  /* [count] */
    int64_t contour_capacity, point_capacity;
} iso_region;

/* Scratch memory for the operations; one per thread, reused. NULL-initialised handle. */
typedef struct iso_planar_scratch iso_planar_scratch;
ISO_API iso_status iso_planar_scratch_new(iso_planar_scratch **scratch) ISO_MUST_CHECK;
ISO_API void iso_planar_scratch_free(iso_planar_scratch *scratch);

ISO_API void iso_region_free(iso_region *region);
ISO_API void iso_region_clear(iso_region *region);
/* Append a contour of `count` points (copied), parent -1. Use to feed raw contours to the
 * operations. */
ISO_API iso_status iso_region_add(iso_region *region, const iso_point *point,
                                  int32_t count) ISO_MUST_CHECK;
ISO_API int64_t
iso_region_double_area(const iso_region *region); /* units^2, exact, holes subtract */

typedef enum iso_fill_rule {
    ISO_FILL_POSITIVE, /* winding >= 1 */
    ISO_FILL_NONZERO,
    ISO_FILL_EVEN_ODD
} iso_fill_rule;

/* Any closed contours, crossing, overlapping, repeated, become a region. out != in. */
ISO_API iso_status iso_region_clean(iso_region *out, const iso_region *in, iso_fill_rule rule,
                                    iso_planar_scratch *scratch) ISO_MUST_CHECK;

typedef enum iso_boolean_kind {
    ISO_UNION,
    ISO_INTERSECTION,
    ISO_DIFFERENCE, /* a without b */
    ISO_EXCLUSIVE   /* in one of them only */
} iso_boolean_kind;

/* Operands need not be clean; each counts where its own winding is nonzero. out is neither. */
ISO_API iso_status iso_boolean(iso_region *out, iso_boolean_kind kind, const iso_region *a,
                               const iso_region *b, iso_planar_scratch *scratch) ISO_MUST_CHECK;

typedef enum iso_join { ISO_JOIN_ROUND, ISO_JOIN_MITRE, ISO_JOIN_SQUARE } iso_join;

typedef struct iso_offset_options {
    int32_t distance;   /* units; > 0 grows, < 0 shrinks */
    iso_join join;      /* at corners that open up */
    double mitre_limit; /* longest mitre, in distances; beyond it the corner is squared. Usual 2 */
    int32_t arc_tolerance; /* units a round join may reach beyond the true arc. Usual 50 */
} iso_offset_options;

ISO_API iso_offset_options iso_offset_defaults(int32_t distance); /* mitre, 2, 50 */

/* All points within `distance` of the region (grow), or further than that inside it (shrink), up to
 * the shape of the joins. `in` must be a region. out != in. */
ISO_API iso_status iso_offset(iso_region *out, const iso_region *in,
                              const iso_offset_options *options,
                              iso_planar_scratch *scratch) ISO_MUST_CHECK;

/* Drop points that lie within `tolerance` units of the line through the points kept around them.
 * Topology is kept: if the thinned contours would collide, the result is cleaned. tolerance 0 only
 * merges collinear runs. */
ISO_API iso_status iso_region_simplify(iso_region *out, const iso_region *in, int32_t tolerance,
                                       iso_planar_scratch *scratch) ISO_MUST_CHECK;

/* 1 inside, 0 on the boundary, -1 outside; exact; linear in the region's points. */
ISO_API int iso_region_locate(const iso_region *region, iso_point point);

/* Clean, oriented, nested, in range? The message names contour and point. */
ISO_API iso_status iso_region_validate(const iso_region *region,
                                       iso_planar_scratch *scratch) ISO_MUST_CHECK;

/* How often the operations of this scratch needed what, since it was made. */
typedef struct iso_planar_counts {
    int64_t operations; /* calls of clean, boolean, offset, simplify */
    int64_t untouched;  /* of those, proved free of collisions */
    int64_t arranged;   /* of those, arranged */
    int64_t edges;      /* edges that were searched for collisions */
    int64_t collisions; /* pairs that crossed, touched or overlapped */
} iso_planar_counts;
ISO_API iso_planar_counts iso_planar_get_counts(const iso_planar_scratch *scratch);

#endif

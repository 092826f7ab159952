/* Paths: what the nozzle is to draw on one layer.
 *
 * A path is a run of vertices; the bead from vertex i to i + 1 has the width, area and role of
 * vertex i. Tool, object and speed class are projections of the path. */
#ifndef ISOSLICE_PATH_H
#define ISOSLICE_PATH_H

#include <isoslice/geometry.h>
#include <isoslice/status.h>

typedef enum iso_role {
    ISO_ROLE_EXTERNAL_PERIMETER,
    ISO_ROLE_PERIMETER,
    ISO_ROLE_OVERHANG_PERIMETER,
    ISO_ROLE_INTERNAL_INFILL,
    ISO_ROLE_SOLID_INFILL,
    ISO_ROLE_TOP_SOLID_INFILL,
    ISO_ROLE_IRONING,
    ISO_ROLE_BRIDGE_INFILL,
    ISO_ROLE_GAP_FILL,
    ISO_ROLE_SKIRT,
    ISO_ROLE_SUPPORT,
    ISO_ROLE_SUPPORT_INTERFACE,
    ISO_ROLE_CUSTOM,
    ISO_ROLE_COUNT
} iso_role;

/* PrusaSlicer's name of a role, as viewers read it behind ";TYPE:". */
ISO_API const char *iso_role_name(iso_role role);

typedef struct iso_path_vertex {
    iso_point at;
    int32_t z;     /* units above the layer's nominal top; 0 on planar layers */
    int32_t width; /* units: the bead's full width, rounded sides included */
    int32_t area;  /* units^2 of the bead's cross-section; E = area * length / filament section */
    int32_t role;  /* iso_role; the path's own but for pieces of it, as where a wall hangs over */
} iso_path_vertex;

/* Is the filament to be drawn back before the nozzle travels to a path? */
typedef enum iso_retraction {
    ISO_RETRACT_IF_LONG, /* if the way is longer than retract_before_travel */
    ISO_RETRACT_NOT      /* no: nothing that drips on this way is ever seen */
} iso_retraction;

typedef struct iso_path {
    int32_t first, count; /* vertices; a closed path does not repeat its first vertex */
    uint8_t role;         /* iso_role of the path as a whole, by which it is ordered */
    uint8_t closed;
    uint8_t tool;
    uint8_t speed_class; /* 0 usual, 1 small perimeter */
    int32_t object;
    int32_t group; /* paths of one group are printed together; groups in any order (an island) */
    int32_t rank;  /* within a group lower ranks first (walls before infill) */
    uint8_t
        follows; /* nonzero: right after the fill path before it, or all of such a chain backwards
                  */

    /* Of ordered layers only: how the nozzle comes here. */
    uint8_t retract;                    /* iso_retraction */
    int32_t travel_first, travel_count; /* points of `travel` to pass on the way */
} iso_path;

/* How a bead lies where layers aren't flat, at a vertex; or the nozzle, at a point of a travel. */
typedef struct iso_frame {
    iso_vec3 normal; /* unit: across the layer, which the tool points against */
    int32_t height;  /* units: the layer's thickness here; 0: the layer is flat here */
    int32_t z;       /* units above the layer's nominal top: of a travel; a vertex has its own */
} iso_frame;

/* The paths of one layer. Zero-initialise; keeps its capacity; iso_paths_free at the end. */
typedef struct iso_paths {
    int32_t count, vertex_count;
    iso_path *path;
    iso_path_vertex *vertex;
    int64_t path_capacity, vertex_capacity;
    int32_t travel_count; /* points that travels turn at */
    iso_point *travel;
    int64_t travel_capacity;
    iso_frame *frame;        /* [vertex_count]; NULL: the layer is flat; iso_paths_clear frees it */
    iso_frame *travel_frame; /* [travel_count], with `frame` */
    int64_t frame_capacity, travel_frame_capacity;
} iso_paths;

ISO_API void iso_paths_free(iso_paths *paths);
ISO_API void iso_paths_clear(iso_paths *paths);

/* Append a path of `count` vertices, all of the same width, area and role, copied from points.
 * `like` gives role, closed, tool, speed class, object, group and rank. */
ISO_API iso_status iso_paths_add(iso_paths *paths, const iso_path *like, const iso_point *point,
                                 int32_t count, int32_t width, int32_t area) ISO_MUST_CHECK;

/* Append copies of all of `more`, moved by `by`, as parts of `object`. */
ISO_API iso_status iso_paths_append(iso_paths *paths, const iso_paths *more, iso_point by,
                                    int32_t object) ISO_MUST_CHECK;

/* A bead is a stadium: a rectangle with half-round sides (docs/flow.md).
 * area = (w - h) h + pi (h/2)^2; neighbours at spacing = area / h fill the layer exactly. */
typedef struct iso_bead {
    int32_t width, height, area, spacing; /* units, units^2 */
} iso_bead;
ISO_API iso_bead iso_bead_of(int32_t width, int32_t height);

/* How high a bead of that width and area is, units; one that is too thick for a stadium is round.
 */
ISO_API double iso_bead_height(double width, double area);

#endif

/* Triangles in, a welded double-link out.
 *
 * Welding is exact, on the bits of the floats (-0 is 0), and vertices are numbered as they first
 * occur, so nothing depends on the hash. Opposite darts are found on the fly: each vertex keeps a
 * short list of the edges whose lower end it is, and the lists live in the opposite array itself.
 * Further edges of a hub, the middle of a fan, go to a hash table. */
#ifndef ISO_MESH_BUILDER_H
#define ISO_MESH_BUILDER_H

#include <isoslice/mesh.h>

#include <stddef.h>
#include <stdbool.h>

/* Coordinates beyond 10 km are no part: a file in the wrong format, mostly. mm. */
#define ISO_MESH_COORDINATE_MAX 1e7f
/* Darts are int32; the margin is for the triangles that close holes. */
#define ISO_MESH_TRIANGLES_MAX 700000000

typedef struct iso_mesh_builder {
    iso_mesh mesh; /* opposite[] holds list links until iso_mesh_builder_finish */
    int64_t origin_capacity, opposite_capacity; /* darts */
    int64_t position_capacity, head_capacity;   /* vertices */
    int32_t *head;                              /* [vertex] first edge of its list, or -1 */
    int32_t *table;                             /* [table_size] open addressing: vertex or -1 */
    int64_t table_size;                         /* a power of two */
    int32_t *crowd;                             /* [crowd_size] first darts of hubs' edges, or -1 */
    int64_t crowd_size, crowd_count;            /* a power of two, at least twice the count */
    int64_t open;                               /* edges with one dart */
    int64_t excess;                             /* darts whose edge had its pair already */
} iso_mesh_builder;

/* `expected` triangles, or a guess; more may come. */
iso_status iso_mesh_builder_begin(iso_mesh_builder *builder, int64_t expected) ISO_MUST_CHECK;

/* Add `count` triangles, nine floats each, `stride` bytes apart, of any alignment. The coordinates
 * must have passed iso_mesh_builder_find_absurd. */
iso_status iso_mesh_builder_add(iso_mesh_builder *builder, const void *triangle, int64_t count,
                                size_t stride) ISO_MUST_CHECK;

/* Index of the first triangle with a coordinate that is not finite or too large, or `count`. */
int64_t iso_mesh_builder_find_absurd(const void *triangle, int64_t count, size_t stride);

/* Hand the mesh over, mended, or say why not; discards the builder either way. options may be NULL.
 */
iso_status iso_mesh_builder_finish(iso_mesh *mesh, iso_mesh_builder *builder,
                                   const iso_mesh_options *options) ISO_MUST_CHECK;

void iso_mesh_builder_discard(iso_mesh_builder *builder);

#endif

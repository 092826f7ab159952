/* What is mended, and what is refused (docs/models.md). The steps, each a file:
 *
 *     coincident.c  exact duplicates and coincident opposite faces go
 *     edges.c       darts are paired edge by edge, by dihedral angle where more than two meet
 *     orient.c      triangles are turned to agree with their neighbours
 *     seams.c       vertices on open edges weld within 10 um
 *     holes.c       boundary loops are closed by fans
 *     sheet.c       what none of this closes is given a thickness, if there is to be one
 *     shells.c      shells inside out are turned
 *
 * A welded mesh whose edges all have exactly two opposite darts needs the last of them only. On
 * failure a mesh still belongs to the caller and is good for nothing but iso_mesh_free. */
#ifndef ISO_MESH_REPAIR_H
#define ISO_MESH_REPAIR_H

#include <isoslice/mesh.h>

#include <stdbool.h>

#include "mesh/sheet.h"

/* mm. Corners this close along open edges were meant to be one. */
#define ISO_MESH_SEAM 0.01
/* Share of a shell's area that may be invented to close it. A cube less one triangle needs 1/11, a
 * box without its lid 1/5. */
#define ISO_MESH_CAP_SHARE 0.1

/* The state that iso_mesh_builder leaves: `open` edges with one dart (opposite -1), and `excess`
 * darts beyond the first opposite pair of their edge (-1 too). thickness 0: sheets are refused. */
iso_status iso_mesh_repair(iso_mesh *mesh, int64_t open, int64_t excess,
                           double thickness) ISO_MUST_CHECK;

/* Drop triangles that occur again and pairs of opposite ones. Leaves opposite[] undefined. */
iso_status iso_mesh_drop_coincident(iso_mesh *mesh) ISO_MUST_CHECK;

/* Darts sorted by their edge; within an edge ascending. */
typedef struct iso_mesh_edges {
    int64_t count;
    int32_t *first; /* [count + 1] into dart */
    int32_t *dart;  /* [3 triangle_count] */
} iso_mesh_edges;

iso_status iso_mesh_edges_new(iso_mesh_edges *edges, const iso_mesh *mesh) ISO_MUST_CHECK;
void iso_mesh_edges_free(iso_mesh_edges *edges);

/* Edges that do not have exactly two opposite darts. */
int64_t iso_mesh_edges_bad(const iso_mesh_edges *edges, const iso_mesh *mesh);

/* Set opposite[] from the edges; -1 where a dart is left alone. Returns how many are. */
iso_status iso_mesh_edges_pair(int64_t *open, iso_mesh *mesh,
                               const iso_mesh_edges *edges) ISO_MUST_CHECK;

/* Turn triangles until neighbours agree; the edges stay valid as sets of vertices, but not their
 * darts: build them anew if *turned. Where this is impossible: ISO_UNSLICEABLE, or the patch is
 * marked in `marks`, unless that is NULL, and stays as it is. Overwrites opposite[]. */
iso_status iso_mesh_orient(int64_t *turned, iso_mesh *mesh, const iso_mesh_edges *edges,
                           sheets *marks) ISO_MUST_CHECK;

/* Merge vertices on open edges that are at most ISO_MESH_SEAM apart: origin[] is renamed, triangles
 * that lose a side stay. *merged vertices found their place. */
iso_status iso_mesh_weld_seams(int64_t *merged, iso_mesh *mesh) ISO_MUST_CHECK;

/* Drop triangles with two equal corners and count them. Leaves opposite[] undefined. */
void iso_mesh_drop_degenerate(iso_mesh *mesh);

/* Close what is open, or refuse; or, if `marks` isn't NULL, mark what is refused and close nothing,
 * which leaves opposite[] undefined. */
iso_status iso_mesh_close_holes(iso_mesh *mesh, int64_t open, sheets *marks) ISO_MUST_CHECK;

/* Number the shells, in the order of their first triangles: shell[t] for every triangle. Open edges
 * are allowed. */
iso_status iso_mesh_find_shells(int32_t **shell, int32_t *count,
                                const iso_mesh *mesh) ISO_MUST_CHECK;

/* Set min and max by the vertices, of which there is one at least. */
void iso_mesh_find_box(iso_mesh *mesh);

/* On a closed mesh: drop shells of two coincident triangles, turn shells that are inside out. */
iso_status iso_mesh_turn_shells(iso_mesh *mesh) ISO_MUST_CHECK;

#endif

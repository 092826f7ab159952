/* Connected pieces of a grid of voxels that is seen plane by plane, lowest first.
 *
 * Voxels of a row that follow each other are a run; runs that touch are joined (union-find). Only
 * two planes of runs are kept, and of the labels only those that the last plane has: a piece that
 * no run of it belongs to is complete, and is handed out. So memory grows with a plane, not with
 * the body, however high it is. */
#ifndef ISO_LATTICE_LABEL_H
#define ISO_LATTICE_LABEL_H

#include <stdint.h>

#include <isoslice/status.h>

/* Material and air are both joined by faces alone: what touches at an edge doesn't hold in a print
 * or a mesh, and lets no powder through. (Joining one of them by corners, so that a wall either
 * holds or leaks, would keep crumbs at the edges of cut walls.) */
typedef enum iso_joining {
    ISO_JOIN_FACES,  /* 6 neighbours */
    ISO_JOIN_CORNERS /* 26: bodies of the part, which are the user's */
} iso_joining;

typedef struct iso_piece {
    int64_t voxels;
    int32_t min[3], max[3]; /* box, voxels, both included */
    int32_t seed[3];        /* its first voxel: lowest z, then y, then x */
    int32_t owner;          /* what the caller gave with the run of the seed */
    int32_t on_border;      /* touches the border of the grid */
} iso_piece;

typedef struct iso_run {
    int32_t first, end; /* x, end excluded */
    int32_t label;
} iso_run;

typedef struct iso_run_plane {
    int32_t *row; /* [rows + 1] first run of each */
    iso_run *run;
    int64_t count, capacity;
} iso_run_plane;

typedef struct iso_labels {
    iso_joining joining;
    int32_t columns, rows, planes;
    int32_t keep_all; /* labels stay valid to the end; for bodies of few runs */
    int32_t next;     /* plane */
    iso_run_plane at, below;
    int32_t *parent, *renamed;
    iso_piece *piece, *spare;
    int64_t count, parent_capacity, renamed_capacity, piece_capacity, spare_capacity;
    iso_piece *done; /* complete pieces, in the order of their completion */
    int64_t done_count, done_capacity;
    int64_t done_most;                     /* so many are kept, the largest; 1,000,000 */
    int64_t smallest;                      /* those of fewer voxels no longer are */
    int64_t lost, lost_voxels;             /* of those, which are only counted */
    int64_t lost_inner, lost_inner_voxels; /* and of these, what isn't on the border */
} iso_labels;

iso_status labels_begin(iso_labels *labels, iso_joining joining, int32_t columns, int32_t rows,
                        int32_t planes) ISO_MUST_CHECK;
void labels_free(iso_labels *labels);

/* The next plane: voxel[i + columns j] belongs to the body where (voxel & mask) == wanted. `owner`
 * may be NULL; else a plane with runs that every run of this one lies within: their labels are the
 * pieces' owners. */
iso_status labels_plane(iso_labels *labels, const uint8_t *voxel, uint8_t mask, uint8_t wanted,
                        const iso_run_plane *owner) ISO_MUST_CHECK;

/* What is still open is complete now. */
iso_status labels_end(iso_labels *labels) ISO_MUST_CHECK;

/* The label that `label` has become; needs keep_all. */
int32_t labels_find(iso_labels *labels, int32_t label);

#endif

/* Seams: where closed walls begin and end. */
#ifndef ISO_PATH_SEAM_H
#define ISO_PATH_SEAM_H

#include <isoslice/config.h>
#include <isoslice/path.h>

#include "base/memory.h"

/* Where a closed path begins: at `at`, on the segment that leaves `vertex`. */
typedef struct iso_seam_place {
    int32_t vertex;
    iso_point at;
} iso_seam_place;

typedef struct iso_seam_mark {
    iso_point at;
    int32_t object;
    iso_box box; /* of its wall */
} iso_seam_mark;

/* The seams of the layer below and of this one, so that they run up the part in lines.
 * Zero-initialise; iso_seams_free at the end. */
typedef struct iso_seams {
    iso_seam_mark *below, *here;
    int32_t below_count, here_count;
    int64_t below_capacity, here_capacity;
    int32_t layer; /* so far: random seams depend on it */

    /* The seams below by square cells, in the scratch memory of this layer; or NULL. */
    int32_t *first, *in; /* [columns * rows + 2], [below_count] */
    int32_t columns, rows, size;
    iso_point origin;
} iso_seams;

void iso_seams_free(iso_seams *seams);

/* Another layer begins: this one's seams become those of the layer below. */
void iso_seams_next_layer(iso_seams *seams);

/* Sort the seams below into cells, so that a layer of many walls is soon done. They are good until
 * the caller pops the scratch memory or the next layer begins. */
iso_status iso_seams_index(iso_seams *seams, iso_arena *scratch) ISO_MUST_CHECK;

/* Choose the seam of a closed path, external wall `number` of its layer.
 *
 * Corners hide a seam: sharp concave ones best, convex ones less (the solid lies to the left of a
 * wall); beads over air are the last choice. ISO_SEAM_ALIGNED goes on from the nearest seam of the
 * layer below that lies within 3 mm of the wall, moving by at most 1 mm along it to a corner;
 * without one it takes the best corner, and the rearmost among equals. ISO_SEAM_NEAREST weighs
 * corners against the way from `from`. ISO_SEAM_REAR takes the largest y, ISO_SEAM_RANDOM any place
 * by layer and number. ISO_NO_MEMORY only. */
iso_status iso_seam_choose(iso_seam_place *place, iso_seams *seams, const iso_path *path,
                           const iso_path_vertex *vertex, int32_t number, iso_seam how,
                           iso_point from) ISO_MUST_CHECK;

/* How well the corner at vertex i of a closed path hides a seam: 0 none, up to 16 for the sharpest
 * convex one, 32 for the sharpest concave one. */
int32_t iso_seam_corner(const iso_path_vertex *vertex, int32_t count, int32_t i);

/* The place on a closed path nearest to a point; the first of equals. */
iso_seam_place iso_seam_beside(const iso_path *path, const iso_path_vertex *vertex, iso_point to);

#endif

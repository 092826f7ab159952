/* Towers: contours of a part at many heights, one on top of the other from branching to branching,
 * each tower a square-link. */
#ifndef ISO_CHANNEL_TOWER_H
#define ISO_CHANNEL_TOWER_H

#include <stdbool.h>

#include <isoslice/mesh.h>

#include "base/memory.h"
#include "base/vector.h"

/* Contours of all levels; each closed, its last point joined to its first. */
typedef struct contours {
    int32_t count, level_count;
    double *level;  /* [level_count] ascending */
    int32_t *first; /* [count + 1] */
    iso_vec3 *point;
    int32_t *face;         /* [points] triangle that the edge before the point is on */
    int32_t *at;           /* [count] level */
    double *area;          /* [count] mm^2 seen from above; below 0 around a hole */
    int32_t *roof, *floor; /* [count] number of the piece of surface right below, right above */
    int32_t *next; /* [count] the one on top of it, if the piece between has no more; or -1 */
} contours;

/* Cut by height[vertex_count] at out->level. The rest of *out, to be zeros, comes into the arena.
 * Pieces are what the levels cut the surface into. */
iso_status contours_cut(contours *out, const iso_mesh *mesh, const double *height,
                        iso_arena *arena) ISO_MUST_CHECK;
/* By planes, from the part's lowest point to its highest. */
iso_status contours_cut_flat(contours *out, const iso_mesh *mesh, int32_t levels,
                             iso_arena *arena) ISO_MUST_CHECK;

/* A square-link of rings: index i + samples j, alpha around a ring, beta upwards. */
typedef struct tower {
    int32_t samples, rings;
    iso_vec3 *g; /* [samples rings] */
    double *f;   /* [samples rings] mm along the surface; not falling along beta */
    bool hole;
} tower;

typedef struct tower_options {
    bool pointwise, holes;
    int32_t samples;
} tower_options;

/* In the arena; towers by their lowest level. Those of a single contour are left out. */
iso_status towers_build(tower **out, int32_t *count, const contours *all,
                        const tower_options *options, iso_arena *arena) ISO_MUST_CHECK;

/* Where column i has height f, of those that it has; below and above that, its ends. */
iso_vec3 tower_point(const tower *t, int32_t i, double f);
/* The heights that all columns have. */
void tower_range(double *low, double *high, const tower *t);

#endif
